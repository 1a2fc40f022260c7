// SPDX-License-Identifier: GPL-2.0-or-later
// Readings of velocity steps and holds from steps written by hand: mu jumps by A ln(V2/V1) and goes
// on to its new level over D, and heals by H in each decade of a hold.
#include "answers/program_results.h"

#include "seen_by_hand.h"

static const double V = 1e-3, A = 0.01, CHANGE = -0.004, D = 0.02, HEALING = 0.03;

typedef struct Fixture {
    HandSeen hand;
    RodCourse course;
    ProgramReadings readings;
    double slip;
} Fixture;

static void begin(Fixture *fixture, int32_t count, const double *at, const double *factor)
{
    Schedule table = {.count = count};
    memcpy(table.at, at, (size_t)count * sizeof *at);
    memcpy(table.factor, factor, (size_t)count * sizeof *factor);
    *fixture = (Fixture){0};
    hand_seen_init(&fixture->hand);
    fixture->course = rod_course(&table, false, V);
    fixture->readings = (ProgramReadings){.course = &fixture->course};
    assert_true(program_jumps(&fixture->course));
}

// A step that ends at `time`; every node at `rate` and as far as the contact.
static void see(Fixture *fixture, double time, double step, double rate, double mu)
{
    Error err = {0};
    HandSeen *hand = &fixture->hand;
    double rates[SEEN_NODES];
    fixture->slip += rate * step;
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        rates[i] = rate;
        hand->reaction[plane_normal(i)] = 2;
        hand->reaction[plane_tangent(i)] = -2 * mu;
    }
    const Observation *seen = hand_seen(hand, time, rates);
    for (int32_t i = 0; i < SEEN_NODES; i++) hand->displacement[plane_tangent(i)] = fixture->slip;
    assert_true(program_readings_record(&fixture->readings, seen, &err));
}

// Level 0.4 until t = 100, then ten times as fast: steps of `step` after the jump.
static void step_up(Fixture *fixture, double step, double level_error)
{
    begin(fixture, 4, (double[]){0, 100, 100, 200}, (double[]){1, 1, 10, 10});
    for (double t = 1; t <= 100; t++)
        see(fixture, t, 1, V, 0.4 + level_error * ((int32_t)t % 2 ? 1 : -1));
    double ln = log(10);
    for (double t = 100 + step; t < 200 + 0.5 * step; t += step)
        see(fixture, t, step, 10 * V,
            0.4 + CHANGE * ln + (A - CHANGE) * ln * exp(-10 * V * (t - 100) / D));
}

TEST(test_velocity_step)
{
    Fixture fixture;
    step_up(&fixture, 0.01, 0);
    ProgramSums sums = program_results_sum(&fixture.readings);
    assert_int_equal(sums.steps, 1);
    assert_int_equal(sums.holds, 0);
    assert_true(fabs(sums.direct.value - A) <= 1.01 * sums.direct.error &&
                sums.direct.error < 1e-3);
    assert_true(fabs(sums.change.value - CHANGE) <= sums.change.error + 1e-12);
    assert_true(sums.change.error < 1e-5);
    assert_true(fabs(sums.distance.value - D) <= sums.distance.error);
    assert_true(sums.distance.error < 0.1 * D);
    assert_true(isnan(sums.healing.value));
}

// Steps of 0.2 D are seen in the errors, which still hold; a level that moves is none.
TEST(test_errors)
{
    Fixture fixture;
    step_up(&fixture, 0.4, 0);
    ProgramSums sums = program_results_sum(&fixture.readings);
    assert_true(fabs(sums.direct.value - A) <= 1.01 * sums.direct.error &&
                sums.direct.error > 1e-3);
    assert_true(fabs(sums.distance.value - D) <= sums.distance.error);
    step_up(&fixture, 0.01, 0.002);   // more than 2e-3 of mu
    sums = program_results_sum(&fixture.readings);
    assert_int_equal(sums.steps, 1);
    assert_true(isnan(sums.direct.value) && isnan(sums.change.value));
}

// Holds of 10, 100 and 1000: a peak of HEALING log10(duration) over the level, gone after D.
TEST(test_holds)
{
    Fixture fixture;
    double at[] = {0, 100, 100, 110, 110, 210, 210, 310, 310, 410, 410, 1410, 1410, 1510};
    double factor[] = {1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1}, time = 0, peak = 0;
    begin(&fixture, 14, at, factor);
    for (int32_t k = 0; k + 1 < 14; k += 2) {
        double length = at[k + 1] - at[k], step = factor[k] > 0 ? 0.1 : length / 10;
        for (int32_t s = 1; s <= lround(length / step); s++) {
            double mu = 0.4 + peak * exp(-V * (s - 1) * step / (0.1 * D));
            see(&fixture, time + s * step, step, factor[k] * V, factor[k] > 0 ? mu : 0.39);
        }
        time = at[k + 1];
        peak = factor[k] > 0 ? 0 : HEALING * log10(length);
    }
    ProgramSums sums = program_results_sum(&fixture.readings);
    assert_int_equal(sums.holds, 3);
    assert_int_equal(sums.steps, 0);
    assert_near("healing per decade", sums.healing.value, HEALING, fmax(sums.healing.error, 1e-9));
    assert_true(sums.healing.error < 0.25 * HEALING);
}
