// SPDX-License-Identifier: GPL-2.0-or-later
// Between l_sc and l_c slow slip oscillates: a disturbance grows until slip stops for a moment, so
// that the slip rate stays within a few times the rod's velocity, ends, and begins again, while the
// rod hardly moves. The slower the rod, the more of these oscillations it meets, all alike. They
// are resolved for a while at each set of slipping nodes; once they were seen to stay small they
// are stepped over, until slip does something that was not seen before.
//
// Recorded for each node is the largest weakening that it had while it moved: -mu'(|v|) r_n; where
// friction remembers W(s) (stepping/moving_set) at s = 1/duration, the slowest that can be seen. A
// state is covered when it moves only nodes that were seen to move, none with more weakening than
// was seen, and nothing new was seen for `duration` of resolved time in which no slip rate came
// near v_c, where friction stops falling and an oscillation may run away. Both duration and
// oscillations scale with the block's own times: what this costs does not depend on the rod's
// velocity. Called by stepping/step_control.
#ifndef AMONTONS_STEPPING_OSCILLATION_RECORD_H
#define AMONTONS_STEPPING_OSCILLATION_RECORD_H

#include "stepping/state.h"

typedef struct OscillationRecord {
    const Interface *interface;   // not owned, like friction
    const Friction *friction;
    double duration;   // time; 0: nothing is ever covered
    double seen_for;   // resolved time since slip last did something new; while it runs, since it
        // was near v_c
    bool runs;   // slip was near v_c, and has neither been certified nor slow for `duration` since
    double *weakening;   // [contact_count + rod_count] largest seen, force * time / length; below
        // 0: it has not moved; owned
} OscillationRecord;

bool oscillation_record_create(const Block *block, double duration, OscillationRecord *record,
                               Error *err);
void oscillation_record_destroy(OscillationRecord *record);
void oscillation_record_clear(OscillationRecord *record);

// Is called after every accepted step that resolves waves: it ended in `state`. While slip is near
// v_c, and then until it is certified or was slow for `duration`, nothing is recorded: a sliding
// block moves all its nodes.
void oscillation_record_add(OscillationRecord *record, const State *state, double step,
                            bool certified);

// `state` does nothing that was not seen, for long enough.
bool oscillation_record_covers(const OscillationRecord *record, const State *state);

void oscillation_record_archive(OscillationRecord *record, Archive *archive);

#endif
