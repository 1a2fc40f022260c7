// SPDX-License-Identifier: GPL-2.0-or-later
// Which steps a window hands on, by U, by time, and by slidings that are known only afterwards.
#include "record/window.h"

#include "seen_by_hand.h"

#include <math.h>

enum { STEPS = 12 };

typedef struct Rig {
    HandSeen hand;
    Events events;
    Window window;
    int32_t inside[STEPS], outside[STEPS], inside_count, outside_count;
} Rig;

static bool note(int32_t *list, int32_t *count, const Observation *seen)
{
    list[(*count)++] = (int32_t)lround(seen->t);
    return true;
}

static bool note_inside(void *self, const Observation *seen, Error *err)
{
    (void)err;
    return note(((Rig *)self)->inside, &((Rig *)self)->inside_count, seen);
}

static bool note_outside(void *self, const Observation *seen, Error *err)
{
    (void)err;
    return note(((Rig *)self)->outside, &((Rig *)self)->outside_count, seen);
}

static void start(Rig *rig, WindowDef def)
{
    memset(rig, 0, sizeof *rig);
    hand_seen_init(&rig->hand);
    def.given = true;
    if (def.to_U == 0) def.to_U = INFINITY;
    if (def.to_t == 0) def.to_t = INFINITY;
    rig->window = window_of(&def, &rig->events);
    recorders_add(&rig->window.inside, rig, note_inside);
    recorders_add(&rig->window.outside, rig, note_outside);
}

// Step `t`: U is a tenth of it. A letter: the rapid event (b)egan, became a (s)liding, (e)nded.
static void step(Rig *rig, int32_t t, const char *what)
{
    Error err = {0};
    rig->hand.seen.t = t;
    rig->hand.seen.U = 0.1 * t;
    rig->events.began = strchr(what, 'b') != NULL;
    rig->events.crossed = strchr(what, 's') != NULL;
    rig->events.ended = strchr(what, 'e') != NULL;
    assert_true(window_record(&rig->window, &rig->hand.seen, &err));
}

// Slidings in the steps 2 to 4 and 6 to 7, and a rapid event that is none in step 9. Ends where the
// window is found, as a run does, which is then taken back.
static void run(Rig *rig)
{
    static const char *const what[STEPS - 2] = {"", "", "b", "s", "e", "", "bs", "e", "", "be"};
    for (int32_t t = 0; t < STEPS - 2 && !rig->window.found; t++) step(rig, t, what[t]);
}

static void expect_inside(const Rig *rig, int32_t first, int32_t last)
{
    assert_int_equal(rig->inside_count, last - first + 1);
    for (int32_t k = 0; k < rig->inside_count; k++) assert_int_equal(rig->inside[k], first + k);
    assert_int_equal(rig->window.steps, rig->inside_count);
}

TEST(test_from_one_place_to_another)
{
    Rig rig;
    start(&rig, (WindowDef){.from_U = 0.25, .to_U = 0.65});
    run(&rig);
    expect_inside(&rig, 3, 6);
    assert_int_equal(rig.outside_count, STEPS - 2);   // each step once
    start(&rig, (WindowDef){.from_t = 4, .to_t = 8});
    run(&rig);
    expect_inside(&rig, 4, 8);
    start(&rig, (WindowDef){.from_U = 0.5});
    run(&rig);
    expect_inside(&rig, 5, 9);
    assert_false(window_is_sought(&rig.window));
}

// The second one, from the step before its rapid event; the run is taken back to step 3, and its
// steps go to the recorders outside of the window once only.
TEST(test_around_a_sliding)
{
    Rig rig;
    Error err = {0};
    start(&rig, (WindowDef){.around = 2});
    assert_true(window_is_sought(&rig.window));
    run(&rig);
    assert_int_equal(rig.inside_count, 0);
    assert_true(rig.window.found && rig.window.begin == 5 && rig.window.end == 7);
    window_close(&rig.window, 0);   // found before: it stays
    assert_true(rig.window.begin == 5 && rig.window.end == 7);
    assert_int_equal(rig.outside_count, 8);
    rig.hand.seen.t = 3;
    assert_true(window_take_back(&rig.window, &rig.hand.seen, &err));
    for (int32_t t = 4; t < STEPS; t++) step(&rig, t, "");
    expect_inside(&rig, 5, 7);
    assert_int_equal(rig.outside_count, STEPS);
    for (int32_t t = 0; t < STEPS; t++) assert_int_equal(rig.outside[t], t);
}

TEST(test_run_that_ends_within_it)
{
    Rig rig;
    start(&rig, (WindowDef){.around = 2});
    for (int32_t t = 0; t < 7; t++)
        step(&rig, t, (const char *const[]){"", "bs", "", "e", "", "b", "s"}[t]);
    window_close(&rig.window, -1);
    assert_true(rig.window.found && rig.window.begin == 4 && isinf(rig.window.end));
    start(&rig, (WindowDef){.around = 3});
    run(&rig);
    window_close(&rig.window, -1);   // there were two
    assert_false(rig.window.found);
    start(&rig, (WindowDef){.around = 3});
    run(&rig);
    step(&rig, 10, "bs");   // the third is under way
    window_close(&rig.window, -1);
    assert_true(rig.window.found && rig.window.begin == 9);
    start(&rig, (WindowDef){.around = 4});
    run(&rig);
    step(&rig, 10, "bs");   // another than the one asked for is
    window_close(&rig.window, -1);
    assert_false(rig.window.found);
}

TEST(test_last_slidings)
{
    Rig rig;
    start(&rig, (WindowDef){.last = 2});
    run(&rig);
    window_close(&rig.window, 1);
    assert_true(rig.window.found && rig.window.begin == 1 && isinf(rig.window.end));
    start(&rig, (WindowDef){.last = 3});
    run(&rig);
    window_close(&rig.window, 1);
    assert_false(rig.window.found);
}
