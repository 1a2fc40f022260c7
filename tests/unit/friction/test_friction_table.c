// SPDX-License-Identifier: GPL-2.0-or-later
// Tables against the curve whose points they are: errors fall with the order, nothing overshoots,
// slopes are those of differences.
#include "own_laws.h"

static double curve(double v)
{
    return 0.1 + 0.28 * exp(-v / 3.4e-4);
}

// The largest error of a table of `count` points of the exponential law.
static double error_of(int32_t count, bool straight)
{
    double velocity[FRICTION_POINTS_MAX], mu[FRICTION_POINTS_MAX], worst = 0, end = 2e-3;
    for (int32_t k = 0; k < count; k++) {
        velocity[k] = end * k / (count - 1);
        mu[k] = curve(velocity[k]);
    }
    FrictionLaw law = own_table(count, velocity, mu, straight);
    for (int32_t k = 0; k < count; k++)
        assert_near("a point", friction_coefficient(NODE_OF(&law), velocity[k]), mu[k], 1e-15);
    for (double v = 0; v < end; v += end / 3000)
        worst = fmax(worst, fabs(friction_coefficient(NODE_OF(&law), v) - curve(v)));
    return worst;
}

TEST(test_orders)
{
    for (int32_t straight = 0; straight < 2; straight++) {
        double order = log2(error_of(32, straight) / error_of(63, straight));
        assert_in_range((int)(100 * order), straight ? 185 : 280, straight ? 205 : 320);
    }
    assert_true(error_of(63, false) < 2e-4 * 0.28);
}

// A law that falls, rises again and has steps of very different size: monotone between points, and
// the slope is that of mu.
TEST(test_monotone)
{
    enum { COUNT = 8 };
    const double velocity[COUNT] = {0, 1e-4, 1.5e-4, 1e-3, 1.1e-3, 4e-3, 1e-2, 3e-2};
    const double mu[COUNT] = {0.5, 0.499, 0.3, 0.12, 0.12, 0.119, 0.2, 0.35};
    for (int32_t straight = 0; straight < 2; straight++) {
        FrictionLaw law = own_table(COUNT, velocity, mu, straight);
        for (int32_t k = 0; k + 1 < COUNT; k++) {
            double width = velocity[k + 1] - velocity[k], h = 1e-6 * width;
            for (double s = 0.01; s < 1; s += 0.01) {
                double v = velocity[k] + s * width, slope = friction_slope(NODE_OF(&law), v);
                double rise = mu[k + 1] - mu[k], here = friction_coefficient(NODE_OF(&law), v);
                assert_true(slope * rise >= -1e-12);
                assert_true((here - mu[k]) * rise >= 0 && (mu[k + 1] - here) * rise >= 0);
                double difference = (friction_coefficient(NODE_OF(&law), v + h) -
                                     friction_coefficient(NODE_OF(&law), v - h)) /
                                    (2 * h);
                assert_near("slope", slope, difference, 1e-7 * law.steepest);
            }
        }
        assert_near("beyond", friction_coefficient(NODE_OF(&law), 1), 0.35, 1e-15);
        assert_near("beyond", friction_slope(NODE_OF(&law), 0.03), 0, 0);
    }
}

// Two points are a line for both kinds; straight tables are lines between their points.
TEST(test_pieces)
{
    const double velocity[] = {0, 1, 3}, mu[] = {0.5, 0.2, 0.4};
    FrictionLaw two = own_table(2, velocity, mu, false), law = own_table(3, velocity, mu, true);
    assert_near("two", friction_coefficient(NODE_OF(&two), 0.25), 0.425, 1e-15);
    assert_near("first", friction_slope(NODE_OF(&law), 0.5), -0.3, 1e-12);
    assert_near("at a point", friction_slope(NODE_OF(&law), 1), 0.1, 1e-12);
    assert_near("second", friction_coefficient(NODE_OF(&law), 2), 0.3, 1e-12);
    assert_near("beyond", friction_slope(NODE_OF(&law), 7), 0, 0);
}

static void check_refused(int32_t count, const double *velocity, const double *mu, int32_t mu_count,
                          const char *key, const char *words)
{
    Error err = {0};
    FrictionLaw law = {.kind = FRICTION_TABLE};
    FrictionSource source = {
        .velocity = velocity, .velocity_count = count, .mu = mu, .mu_count = mu_count};
    const char *found = NULL;
    assert_false(friction_make(&source, &law, &found, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(found, key);
    if (!strstr(err.message, words)) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
}

TEST(test_refusals)
{
    const double up[] = {0, 1, 2}, back[] = {0, 2, 1};
    const double fine[] = {0.4, 0.2, 0.3};
    check_refused(1, up, fine, 1, "velocity", "2 to 255");
    check_refused(3, back, fine, 3, "velocity", "1 stands after 2");
    check_refused(3, up, fine, 2, "mu", "has 2 numbers, friction.velocity has 3");
}

// mu = 0.3 - 0.02 ln(v/v_0) is a line over ln v: over five decades it is met to rounding, which
// cubics over v do not come near.
TEST(test_over_decades)
{
    enum { COUNT = 6 };
    double velocity[COUNT], mu[COUNT];
    for (int32_t k = 0; k < COUNT; k++) {
        velocity[k] = 1e-6 * pow(10, k);
        mu[k] = 0.3 - 0.02 * log(velocity[k] / 1e-6);
    }
    FrictionLaw law = own_log_table(COUNT, velocity, mu, 0);
    for (double v = 1e-6; v < 0.1; v *= 1.3) {
        assert_near("mu", friction_coefficient(NODE_OF(&law), v), 0.3 - 0.02 * log(v / 1e-6),
                    1e-14);
        assert_near("slope", friction_slope(NODE_OF(&law), v) * v, -0.02, 1e-12);
    }
    assert_near("at rest", friction_coefficient(NODE_OF(&law), 0), 0.3, 0);
    assert_near("slower", friction_coefficient(NODE_OF(&law), 5e-7), 0.3, 0);
    assert_near("faster", friction_coefficient(NODE_OF(&law), 3), mu[COUNT - 1], 1e-15);
    assert_near("lowest", law.mu_kinetic, mu[COUNT - 1], 1e-15);
}

// A table that begins above v = 0: at rest mu_static, else the first value.
TEST(test_at_rest)
{
    const double velocity[] = {1e-4, 1e-3, 1e-2}, mu[] = {0.4, 0.3, 0.2};
    FrictionLaw by_log = own_log_table(3, velocity, mu, 0.5),
                plain = own_table(3, velocity, mu, true);
    assert_near("mu_static", friction_coefficient(NODE_OF(&by_log), 0), 0.5, 0);
    assert_near("half way", friction_coefficient(NODE_OF(&by_log), 0.5e-4), 0.45, 1e-15);
    assert_near("first", friction_coefficient(NODE_OF(&plain), 0), 0.4, 0);
    assert_near("first", friction_coefficient(NODE_OF(&plain), 0.5e-4), 0.4, 1e-15);
    assert_near("slope", friction_slope(NODE_OF(&by_log), 0.5e-4), -0.1 / 1e-4, 1e-9);
    const double from_rest[] = {0, 1e-3, 1e-2};
    FrictionLaw rests = own_log_table(3, from_rest, mu, 0);
    assert_near("at 0", friction_coefficient(NODE_OF(&rests), 0), 0.4, 0);
    assert_near("below the first", friction_coefficient(NODE_OF(&rests), 0.5e-3), 0.35, 1e-15);
}
