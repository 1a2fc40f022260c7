// SPDX-License-Identifier: GPL-2.0-or-later
// Which steps a window hands on, by U and by time.
#include "record/window.h"

#include "seen_by_hand.h"

#include <math.h>

enum { STEPS = 10 };

typedef struct Rig {
    HandSeen hand;
    Window window;
    int32_t inside[STEPS], inside_count;
} Rig;

static bool note_inside(void *self, const Observation *seen, Error *err)
{
    (void)err;
    Rig *rig = self;
    rig->inside[rig->inside_count++] = (int32_t)lround(seen->t);
    return true;
}

// Steps 0 to 9; U is a tenth of the time.
static void expect_inside(WindowDef def, int32_t first, int32_t last)
{
    Rig rig = {0};
    Error err = {0};
    hand_seen_init(&rig.hand);
    if (def.to_U == 0) def.to_U = INFINITY;
    if (def.to_t == 0) def.to_t = INFINITY;
    rig.window.def = def;
    recorders_add(&rig.window.inside, &rig, note_inside);
    for (int32_t t = 0; t < STEPS; t++) {
        rig.hand.seen.t = t;
        rig.hand.seen.U = 0.1 * t;
        assert_true(window_record(&rig.window, &rig.hand.seen, &err));
    }
    assert_int_equal(rig.inside_count, last - first + 1);
    for (int32_t k = 0; k < rig.inside_count; k++) assert_int_equal(rig.inside[k], first + k);
    assert_int_equal(rig.window.steps, rig.inside_count);
}

TEST(test_from_one_place_to_another)
{
    expect_inside((WindowDef){.from_U = 0.25, .to_U = 0.65}, 3, 6);
    expect_inside((WindowDef){.from_t = 4, .to_t = 8}, 4, 8);
    expect_inside((WindowDef){.from_U = 0.5}, 5, 9);
}
