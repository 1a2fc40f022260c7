// SPDX-License-Identifier: GPL-2.0-or-later
// Which states are covered? States written down by hand, shown for known times.
#include "stepping/oscillation_record.h"

#include "block_rig.h"
#include "own_laws.h"
#include "plane.h"

static const double LONG = 20, PRESSURE = 1e-3;

typedef struct Fixture {
    BlockRig rig;
    OscillationRecord record;
    State seen;
} Fixture;

static void fixture_build(double duration, Fixture *fixture)
{
    Error err = {0};
    RigDef def = rig_def();
    rig_build(&def, &fixture->rig);
    assert_true(oscillation_record_create(&fixture->rig.block, duration, &fixture->record, &err));
    assert_true(state_create(&fixture->rig.system, &fixture->rig.interface, &fixture->seen, &err));
    memset(fixture->seen.rod_touches, 1, (size_t)fixture->seen.rod_count);
}

static void fixture_destroy(Fixture *fixture)
{
    state_destroy(&fixture->seen);
    oscillation_record_destroy(&fixture->record);
    rig_destroy(&fixture->rig);
}

// Node i slips at `part` of v_c under `pressing`.
static void slip(Fixture *fixture, int32_t i, double part, double pressing)
{
    fixture->seen.status[i] = CONTACT_SLIP_FORWARD;
    fixture->seen.slip_rate[plane_tangent(i)] = part * fixture->rig.law.critical_velocity;
    fixture->seen.reaction[plane_normal(i)] = pressing;
}

static void see(Fixture *fixture, double time)
{
    for (int32_t k = 0; k < 10; k++)
        oscillation_record_add(&fixture->record, &fixture->seen, time / 10, false);
}

static bool covered(const Fixture *fixture)
{
    return oscillation_record_covers(&fixture->record, &fixture->seen);
}

// Covered after `duration`, counted from the last time something new was seen; the first look does
// not count.
TEST(test_duration)
{
    Fixture fixture;
    fixture_build(LONG, &fixture);
    assert_false(covered(&fixture));
    slip(&fixture, 1, 0.05, PRESSURE);
    see(&fixture, 0.99 * LONG);
    assert_false(covered(&fixture));
    see(&fixture, 0.12 * LONG);
    assert_true(covered(&fixture));
    slip(&fixture, 2, 0.05, PRESSURE);   // a node that was not seen to move
    assert_false(covered(&fixture));
    see(&fixture, LONG);
    assert_false(covered(&fixture));
    see(&fixture, 0.12 * LONG);
    assert_true(covered(&fixture));
    fixture.seen.status[1] = CONTACT_STICK;   // less than was seen is covered too
    assert_true(covered(&fixture));
    fixture_destroy(&fixture);

    fixture_build(0, &fixture);
    slip(&fixture, 1, 0.05, PRESSURE);
    see(&fixture, LONG);
    assert_false(covered(&fixture));
    fixture_destroy(&fixture);
}

// Weakening goes with pressure on the linear law's slope. What weakens a fifth more than was seen
// is not covered, and slow growth, of a hundredth at a time, is noticed.
TEST(test_weakening)
{
    Fixture fixture;
    fixture_build(LONG, &fixture);
    slip(&fixture, 3, 0.05, PRESSURE);
    see(&fixture, 2 * LONG);
    slip(&fixture, 3, 0.05, 0.8 * PRESSURE);
    assert_true(covered(&fixture));
    slip(&fixture, 3, 0.05, 1.2 * PRESSURE);
    assert_false(covered(&fixture));
    double pressing = PRESSURE;
    for (int32_t k = 0; k < 100; k++) {   // to 2.7 times as much
        pressing *= 1.01;
        slip(&fixture, 3, 0.05, pressing);
        see(&fixture, 0.1 * LONG);
        assert_false(covered(&fixture) && k > 2);
    }
    fixture_destroy(&fixture);
}

// With memory what counts is -r_n (mu_v + mu_theta g_v/(s - g_theta)) at s = 1/LONG, here by hand:
// a contact that is older weakens more by the slip that it forgets.
TEST(test_memory)
{
    Fixture fixture;
    fixture_build(LONG, &fixture);
    fixture.rig.law = law_with_state((FrictionLaw){.kind = FRICTION_AGEING,
                                                   .mu_static = 0.38,
                                                   .mu_kinetic = 0.1,
                                                   .critical_velocity = 3.4e-4,
                                                   .slip_distance = 1e-4,
                                                   .healing_time = 10,
                                                   .healing = 0.1});
    double theta = 2, speed = 0.05 * 3.4e-4, fades = speed / 1e-4, age = 1.02 * (theta + 1e-3);
    double mu = 0.38 - 0.05 * 0.28;
    for (int32_t k = 0; k < 2; k++) {   // W(1/LONG) of the age seen, and of one 2 % older
        double at = k == 0 ? theta : age, gain = mu * 0.1 / (10 + at);
        double strength = 1 + 0.1 * log1p(at / 10);
        double weakening = PRESSURE *
                           (0.28 / 3.4e-4 * strength + gain * at / 1e-4 / (1 / LONG + fades));
        slip(&fixture, 3, 0.05, PRESSURE);
        fixture.seen.theta[3 * STATES_MAX] = at;
        if (k == 0) see(&fixture, 2 * LONG);
        assert_true(covered(&fixture));
        if (k == 0) assert_near("W", fixture.record.weakening[3], weakening, 1e-12);
    }
    fixture.seen.theta[3 * STATES_MAX] = 2 * theta;
    assert_false(covered(&fixture));
    fixture_destroy(&fixture);
}

// Near v_c nothing is covered, all is forgotten, and what slows down from there does not count
// until it was certified or has been slow for as long as oscillations are watched: a pad that slips
// on slowly after a sliding, never certified, is not watched for ever.
TEST(test_running)
{
    Fixture fixture;
    fixture_build(LONG, &fixture);
    slip(&fixture, 0, 0.05, PRESSURE);
    see(&fixture, 2 * LONG);
    assert_true(covered(&fixture));
    slip(&fixture, 0, 0.9, PRESSURE);
    assert_false(covered(&fixture));
    see(&fixture, 1);
    slip(&fixture, 0, 0.05, PRESSURE);
    assert_false(covered(&fixture));
    see(&fixture, 0.8 * LONG);
    oscillation_record_add(&fixture.record, &fixture.seen, 1, true);
    see(&fixture, 1.1 * LONG);
    assert_true(covered(&fixture));
    fixture_destroy(&fixture);
}

// Slow for `duration`, and watched for another one from there; a fast moment begins anew.
TEST(test_slow_again)
{
    Fixture fixture;
    fixture_build(LONG, &fixture);
    for (int32_t turn = 0; turn < 2; turn++) {
        slip(&fixture, 0, 0.9, PRESSURE);
        see(&fixture, 5 * LONG);
        slip(&fixture, 0, 0.05, PRESSURE);
        see(&fixture, 0.99 * LONG);
        assert_true(fixture.record.runs);
    }
    slip(&fixture, 1, 0.05, PRESSURE);   // moved before it counts
    see(&fixture, 0.99 * LONG);
    assert_false(covered(&fixture));
    see(&fixture, 0.12 * LONG);
    assert_true(covered(&fixture));
    fixture_destroy(&fixture);
}

// A node that opens, and a rod node that lets go, are new too.
TEST(test_open_and_rod)
{
    Fixture fixture;
    fixture_build(LONG, &fixture);
    assert_true(fixture.seen.rod_count > 0);
    see(&fixture, 2 * LONG);
    assert_true(covered(&fixture));
    fixture.seen.status[2] = CONTACT_OPEN;
    assert_false(covered(&fixture));
    see(&fixture, 2 * LONG);
    assert_true(covered(&fixture));
    fixture.seen.rod_touches[0] = 0;
    assert_false(covered(&fixture));
    see(&fixture, 2 * LONG);
    assert_true(covered(&fixture));
    oscillation_record_clear(&fixture.record);
    assert_false(covered(&fixture));
    fixture_destroy(&fixture);
}
