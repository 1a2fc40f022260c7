// SPDX-License-Identifier: GPL-2.0-or-later
// Laws with memory: derivatives against differences, the state of a stage against its equation,
// steps of the states against closed forms at constant slip and at rest, limits.
#include "own_laws.h"

enum { LAWS = 4 };

static const FrictionLaw GIVEN[LAWS] = {{.kind = FRICTION_AGEING,
                                         .mu_static = 0.4,
                                         .mu_kinetic = 0.1,
                                         .critical_velocity = 0.05,
                                         .slip_distance = 0.02,
                                         .healing_time = 3,
                                         .healing = 0.2},
                                        {.kind = FRICTION_SLIP_WEAKENING,
                                         .mu_static = 0.4,
                                         .mu_kinetic = 0.1,
                                         .slip_distance = 0.02,
                                         .healing_time = 3},
                                        {.kind = FRICTION_RATE_STATE,
                                         .slip_distance = 0.02,
                                         .evolution_effect = 0.03,
                                         .direct_effect = 0.02,
                                         .mu_reference = 0.5,
                                         .reference_velocity = 0.01},
                                        {.kind = FRICTION_RATE_STATE,
                                         .slip_distance = 0.02,
                                         .evolution_effect = 0.03,
                                         .direct_effect = 0.02,
                                         .mu_reference = 0.5,
                                         .reference_velocity = 0.01,
                                         .slip_law = true}};
static const double STATES[LAWS] = {2, 0.6, -0.7, 1.3};

static FrictionNode law_of(int k)
{
    static FrictionLaw laws[LAWS];
    laws[k] = law_with_state(GIVEN[k]);
    return friction_node(&laws[k], 1);
}

static FrictionRates rates_at(const FrictionNode *law, double speed, double theta)
{
    FrictionRates rates;
    friction_rates(law, speed, &theta, &rates);
    return rates;
}

static double state_at(const FrictionNode *law, double speed)
{
    double theta = NAN;
    friction_state(law, speed, &theta);
    return theta;
}

// A difference of order 4; h is small beside what the function varies over.
static double difference(double (*f)(const FrictionNode *, double, double), const FrictionNode *law,
                         double at, double other, double h)
{
    return (8 * (f(law, at + h, other) - f(law, at - h, other)) -
            (f(law, at + 2 * h, other) - f(law, at - 2 * h, other))) /
           (12 * h);
}

static double mu_of_speed(const FrictionNode *law, double speed, double theta)
{
    return rates_at(law, speed, theta).mu;
}
static double mu_of_state(const FrictionNode *law, double theta, double speed)
{
    return rates_at(law, speed, theta).mu;
}
static double rate_of_speed(const FrictionNode *law, double speed, double theta)
{
    return rates_at(law, speed, theta).rate[0];
}
static double rate_of_state(const FrictionNode *law, double theta, double speed)
{
    return rates_at(law, speed, theta).rate[0];
}
static double stage_of_speed(const FrictionNode *law, double speed, double unused)
{
    (void)unused;
    return friction_coefficient(law, speed);
}

TEST(test_derivatives)
{
    const double speeds[] = {1e-4, 0.01, 0.03, 0.2};
    for (int k = 0; k < LAWS; k++) {
        FrictionNode law = law_of(k);
        for (size_t s = 0; s < sizeof speeds / sizeof *speeds; s++) {
            double v = speeds[s], theta = STATES[k], h = 1e-3 * v;
            FrictionRates rates = rates_at(&law, v, theta);
            double scale = 0.1 / v;   // mu over its speed
            assert_near("mu_v", rates.mu_speed, difference(mu_of_speed, &law, v, theta, h),
                        1e-8 * scale);
            assert_near("mu_theta", rates.mu_state[0],
                        difference(mu_of_state, &law, theta, v, 1e-3), 1e-9);
            assert_near("g_v", rates.rate_speed[0], difference(rate_of_speed, &law, v, theta, h),
                        1e-8 * fabs(rates.rate_speed[0]) + 1e-9 / v);
            assert_near("g_theta", rates.rate_state[0][0],
                        difference(rate_of_state, &law, theta, v, 1e-3),
                        1e-8 * fabs(rates.rate_state[0][0]) + 1e-9);
        }
    }
}

// State and slope of a stage, short and long beside D_c/v.
TEST(test_stage)
{
    const double speeds[] = {0, 1e-9, 1e-3, 0.03, 0.4}, reaches[] = {1e-6, 0.1, 3, 1e4};
    for (int k = 0; k < LAWS; k++) {
        for (int r = 0; r < 4; r++) {
            FrictionNode law = law_of(k);
            friction_set_stage(&law, &STATES[k], reaches[r]);
            for (int s = 0; s < 5; s++) {
                double v = speeds[s], theta = state_at(&law, v);
                FrictionRates rates = rates_at(&law, v, theta);
                double left = theta - STATES[k] - reaches[r] * rates.rate[0];
                double scale = fabs(theta) + fabs(STATES[k]) + reaches[r] * (1 + v / 0.02);
                assert_near("equation of the state", left, 0, 1e-13 * scale);
                assert_near("mu", friction_coefficient(&law, v), rates.mu, 0);
                double slope = friction_slope(&law, v), h = 1e-3 * v;
                if (v > 0)
                    assert_near("slope", slope, difference(stage_of_speed, &law, v, 0, h),
                                1e-7 * fabs(slope) + 1e-10 / v);
            }
        }
    }
}

// Many short stages of backward Euler at a constant slip rate, extrapolated, against the exact
// course: theta = D_c/v + (theta_0 - D_c/v) exp(-v t/D_c); phi likewise; slip law: ln(v theta/D_c)
// fades as exp(-v t/D_c).
static double stepped(int k, double speed, double time, int32_t steps)
{
    FrictionNode law = law_of(k);
    double theta = STATES[k];
    for (int32_t n = 0; n < steps; n++) {
        friction_set_stage(&law, &theta, time / steps);
        theta = state_at(&law, speed);
    }
    return theta;
}

static double steady_of(int k, double speed)
{
    return friction_operations(&GIVEN[k])->steady(&GIVEN[k], speed);
}

TEST(test_constant_slip)
{
    double v = 0.03, t = 1.1, fades = exp(-v * t / 0.02);
    double theta[LAWS];
    for (int k = 0; k < LAWS; k++) theta[k] = 2 * stepped(k, v, t, 20000) - stepped(k, v, t, 10000);
    double steady = 0.02 / v;
    assert_near("ageing", theta[0], steady + (2 - steady) * fades, 1e-7);
    double heals = exp(-t * (1 / 3.0 + v / 0.02)), mean = 1 / (1 + v * 3 / 0.02);
    assert_near("slip-weakening", theta[1], mean + (0.6 - mean) * heals, 1e-7);
    double began = 2 * exp(-0.7);   // D_c/V_0 = 2
    assert_near("rate and state", 2 * exp(theta[2]), steady + (began - steady) * fades, 1e-7);
    assert_near("slip law", theta[3], -log(3) + (1.3 + log(3)) * fades, 1e-7);
    for (int k = 0; k < LAWS; k++) {
        FrictionNode law = law_of(k);
        assert_near("steady", steady_of(k, v), stepped(k, v, 1e4, 100), 1e-9);
        double rested = stepped(k, 0, 10, 10000);
        if (k == 3) assert_near("slip law rests", rested, 1.3, 0);   // not without slip
        if (k == 0) assert_near("rested", rested, 12, 1e-9);
        double fresh = rates_at(&law, v, steady_of(k, v)).rate[0];
        assert_near("rate at steady slip", fresh, 0, 1e-12);
    }
}

// The state of contacts that have rested for so long changes as the law says at rest; the slip law
// changes nothing there, and takes the ageing law's state.
TEST(test_rested)
{
    for (int k = 0; k < LAWS; k++) {
        FrictionNode law = law_of(k);
        for (double t = 0.5; t < 20; t *= 2) {
            double h = 1e-5 * t, rested = friction_rested(&GIVEN[k], t);
            double change = friction_rested(&GIVEN[k], t + h) - friction_rested(&GIVEN[k], t - h);
            double rate = rates_at(&law, 0, rested).rate[0];
            if (!GIVEN[k].slip_law) assert_near("change", change / (2 * h), rate, 1e-8);
            if (k > 1) assert_near("theta", friction_shown_state(&law, 0, rested), t, 1e-12 * t);
        }
    }
    assert_near("at first", friction_rested(&GIVEN[0], 0), 0, 0);
    assert_near("at first", friction_rested(&GIVEN[1], 0), 0, 0);
}

TEST(test_limits)
{
    FrictionLaw linear = {.kind = FRICTION_LINEAR_WEAKENING,
                          .mu_static = 0.4,
                          .mu_kinetic = 0.1,
                          .critical_velocity = 0.05};
    FrictionLaw ageless = GIVEN[0];
    ageless.healing = 0;
    ageless = law_with_state(ageless);
    FrictionNode law = friction_node(&ageless, 1);
    friction_set_stage(&law, (const double[]){5}, 0.1);
    for (double v = 0; v < 0.1; v += 0.0037) {
        assert_near("beta = 0", friction_coefficient(&law, v),
                    friction_coefficient(NODE_OF(&linear), v), 0);
        assert_near("beta = 0", friction_slope(&law, v), friction_slope(NODE_OF(&linear), v), 0);
    }
    for (int k = 0; k < LAWS; k++) {
        FrictionNode frozen = law_of(k), half = frozen;
        friction_set_stage(&frozen, &STATES[k], 0);
        half.factor = 0.5;
        friction_set_stage(&half, &STATES[k], 0);
        for (double v = 1e-3; v < 0.1; v += 0.0037) {
            FrictionRates rates = rates_at(&frozen, v, STATES[k]);
            assert_near("frozen", friction_coefficient(&frozen, v), rates.mu, 0);
            assert_near("frozen", friction_slope(&frozen, v), rates.mu_speed, 0);
            assert_near("half", friction_coefficient(&half, v), 0.5 * rates.mu, 1e-15);
        }
    }
    FrictionNode asinh_law = law_of(2);
    double v = 0.004, psi = 0.4;
    assert_near("the law as it is written", rates_at(&asinh_law, v, psi).mu,
                0.02 * asinh(v / 0.02 * exp((0.5 + 0.03 * psi) / 0.02)), 1e-15);
}

// A step in mu: forward and back leads to where it began, over many decades, and through 0.
TEST(test_follow)
{
    FrictionNode law = law_of(2);
    friction_set_stage(&law, (const double[]){0.3}, 0);
    for (double v = 1e-14; v < 1; v *= 31) {
        double slope = friction_slope(&law, v), mu = friction_coefficient(&law, v);
        double to, through, step = 0.05 / slope, back = -2 * mu / slope;
        friction_follow(&law, 1, &v, &step, &to);
        friction_follow(&law, 1, &v, &back, &through);
        assert_near("mu", friction_coefficient(&law, to), mu + 0.05, 1e-12);
        assert_near("through 0", through / -v, 1, 1e-9);
    }
}

// Over that at the start, whose states are those of GIVEN: of ageing 1 + beta ln(1 +
// theta/theta_0), of rate and state likewise with beta = b/f_0 and theta_0 = D_c/V_0.
TEST(test_contact_area)
{
    for (int32_t k = 0; k < LAWS; k++) {
        FrictionNode law = law_of(k);
        double start = NAN, other = STATES[k];
        friction_start_state(&law, &start);
        assert_true(friction_has_area(&law));
        assert_near("at rest", friction_contact_area(&law, 0, &start), 1, 1e-14);
        double area = k == 0   ? 1 + 0.2 * log(1 + other / 3)
                      : k == 1 ? other
                               : 1 + 0.03 / 0.5 * log(1 + exp(other));
        double rested = k == 0   ? 1 + 0.2 * log(1 + start / 3)
                        : k == 1 ? start
                                 : 1 + 0.03 / 0.5 * log(1 + exp(start));
        assert_near("area", friction_contact_area(&law, 1, &other), area / rested, 1e-13);
    }
}
