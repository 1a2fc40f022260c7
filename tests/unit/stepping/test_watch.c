// SPDX-License-Identifier: GPL-2.0-or-later
// When is a state borne? States written down by hand, shown for known times.
#include "stepping/watch.h"

#include "block_rig.h"

static const double LONG = 20, PRESSURE = 1e-3;

typedef struct Fixture {
    BlockRig rig;
    Watch watch;
    State seen;
} Fixture;

static void fixture_build(double duration, Fixture *fixture)
{
    Error err = {0};
    RigDef def = rig_def();
    rig_build(&def, &fixture->rig);
    assert_true(watch_create(&fixture->rig.block, duration, &fixture->watch, &err));
    assert_true(state_create(&fixture->rig.system, &fixture->rig.interface, &fixture->seen, &err));
    memset(fixture->seen.rod_touches, 1, (size_t)fixture->seen.rod_count);
}

static void fixture_destroy(Fixture *fixture)
{
    state_destroy(&fixture->seen);
    watch_destroy(&fixture->watch);
    rig_destroy(&fixture->rig);
}

// Node i slips at `part` of v_c under `pressing`.
static void slip(Fixture *fixture, int32_t i, double part, double pressing)
{
    fixture->seen.status[i] = CONTACT_SLIP_FORWARD;
    fixture->seen.slip_rate[interface_tangent(i)] = part * fixture->rig.law.critical_velocity;
    fixture->seen.reaction[interface_normal(i)] = pressing;
}

static void see(Fixture *fixture, double time)
{
    for (int32_t k = 0; k < 10; k++) watch_see(&fixture->watch, &fixture->seen, time / 10, false);
}

static bool borne(const Fixture *fixture)
{
    return watch_bears(&fixture->watch, &fixture->seen);
}

// Borne after `duration`, counted from the last time something new was seen; the first look does
// not count.
static void test_duration(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(LONG, &fixture);
    assert_false(borne(&fixture));
    slip(&fixture, 1, 0.05, PRESSURE);
    see(&fixture, 0.99 * LONG);
    assert_false(borne(&fixture));
    see(&fixture, 0.12 * LONG);
    assert_true(borne(&fixture));
    slip(&fixture, 2, 0.05, PRESSURE);   // a node that was not seen to move
    assert_false(borne(&fixture));
    see(&fixture, LONG);
    assert_false(borne(&fixture));
    see(&fixture, 0.12 * LONG);
    assert_true(borne(&fixture));
    fixture.seen.status[1] = CONTACT_STICK;   // less than was seen is borne too
    assert_true(borne(&fixture));
    fixture_destroy(&fixture);

    fixture_build(0, &fixture);
    slip(&fixture, 1, 0.05, PRESSURE);
    see(&fixture, LONG);
    assert_false(borne(&fixture));
    fixture_destroy(&fixture);
}

// Weakening goes with pressure on the linear law's slope; two parts in a hundred are let pass, and
// slow growth beyond them is seen.
static void test_weakening(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(LONG, &fixture);
    slip(&fixture, 3, 0.05, PRESSURE);
    see(&fixture, 2 * LONG);
    slip(&fixture, 3, 0.05, 1.019 * PRESSURE);
    assert_true(borne(&fixture));
    slip(&fixture, 3, 0.05, 1.021 * PRESSURE);
    assert_false(borne(&fixture));
    double pressing = PRESSURE;
    for (int32_t k = 0; k < 100; k++) {   // to 2.7 times as much
        pressing *= 1.01;
        slip(&fixture, 3, 0.05, pressing);
        see(&fixture, 0.1 * LONG);
        assert_false(borne(&fixture) && k > 2);
    }
    fixture_destroy(&fixture);
}

// Near v_c nothing is borne, all is forgotten, and what slows down from there does not count until
// it was certified.
static void test_running(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(LONG, &fixture);
    slip(&fixture, 0, 0.05, PRESSURE);
    see(&fixture, 2 * LONG);
    assert_true(borne(&fixture));
    slip(&fixture, 0, 0.9, PRESSURE);
    assert_false(borne(&fixture));
    see(&fixture, 1);
    slip(&fixture, 0, 0.05, PRESSURE);
    assert_false(borne(&fixture));
    see(&fixture, 5 * LONG);
    assert_false(borne(&fixture));
    watch_see(&fixture.watch, &fixture.seen, 1, true);
    see(&fixture, 2 * LONG);
    assert_true(borne(&fixture));
    fixture_destroy(&fixture);
}

// What opens, and a rod node that lets go, are new too.
static void test_open_and_rod(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(LONG, &fixture);
    assert_true(fixture.seen.rod_count > 0);
    see(&fixture, 2 * LONG);
    assert_true(borne(&fixture));
    fixture.seen.status[2] = CONTACT_OPEN;
    assert_false(borne(&fixture));
    see(&fixture, 2 * LONG);
    assert_true(borne(&fixture));
    fixture.seen.rod_touches[0] = 0;
    assert_false(borne(&fixture));
    see(&fixture, 2 * LONG);
    assert_true(borne(&fixture));
    watch_forget(&fixture.watch);
    assert_false(borne(&fixture));
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_duration),
        cmocka_unit_test(test_weakening),
        cmocka_unit_test(test_running),
        cmocka_unit_test(test_open_and_rod),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
