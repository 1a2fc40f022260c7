// SPDX-License-Identifier: GPL-2.0-or-later
// Between l_sc and l_c slow slip swings: a disturbance of it grows until slip stops for a moment,
// so that the swing stays a few times as fast as the rod and ends and begins again, over and over,
// while the rod hardly moves. A slow rod meets the more swings the slower it is, all alike. They
// are therefore followed, with waves resolved, for a while at each slip set; once they have shown
// that they stay small they are stepped over until slip goes where it was not seen before.
//
// What was seen is kept per node: the largest weakening -mu'(|v|) r_n that it had while it moved.
// A state is borne when it moves only nodes that were seen to move, weakens nowhere more than it
// was seen to, and that picture has stood for `duration` of resolved time without a slip rate
// near v_c, where friction stops falling and a swing may run away. In units of time both duration
// and the swings are the block's own: what this costs does not depend on the rod.
// Called by stepping/step_control.
#ifndef AMONTONS_STEPPING_WATCH_H
#define AMONTONS_STEPPING_WATCH_H

#include "stepping/state.h"

typedef struct Watch {
    const Interface *interface;   // not owned, like the law
    const FrictionLaw *law;
    double duration;   // time; 0: nothing is ever borne
    double seen_for;   // resolved time since slip last did something new
    bool runs;   // slip was near v_c and is not certified since
    double *weakening;   // [contact_count + rod_count] largest seen, force * time / length; below
        // 0: it has not moved; owned
} Watch;

bool watch_create(const Block *block, double duration, Watch *watch, Error *err);
void watch_destroy(Watch *watch);
void watch_forget(Watch *watch);

// A step that resolved waves ended in `state`, `step` later. What runs fast, and what then slows
// down until it is certified, counts for nothing: a sliding block moves all its nodes.
void watch_see(Watch *watch, const State *state, double step, bool certified);

// `state` does nothing that was not seen for long enough.
bool watch_bears(const Watch *watch, const State *state);

#endif
