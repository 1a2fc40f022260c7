// SPDX-License-Identifier: GPL-2.0-or-later
// Scales and faults of one's own law: the built-in laws written as formulas have their scales; what
// cannot be a law is refused, with the velocity.
#include "own_laws.h"

static const FrictionLaw EXPONENTIAL = {.kind = FRICTION_EXPONENTIAL_WEAKENING,
                                        .mu_static = 0.38,
                                        .mu_kinetic = 0.1,
                                        .critical_velocity = 3.4e-4};

static void assert_same(const FrictionLaw *own, const FrictionLaw *known, double tolerance)
{
    double v_c = known->critical_velocity, steep = friction_steepest(NODE_OF(known));
    assert_near("mu_S", own->mu_static, known->mu_static, tolerance);
    assert_near("mu_K", own->mu_kinetic, known->mu_kinetic, tolerance);
    assert_near("v_c", own->critical_velocity, v_c, 1e-9 * v_c);
    assert_near("spent", friction_spent_speed(NODE_OF(own)), friction_spent_speed(NODE_OF(known)),
                1e-8 * v_c);
    assert_near("steepest", friction_steepest(NODE_OF(own)), steep, 1e-12 * steep);
    for (double v = 0; v < 8 * v_c; v += 0.037 * v_c) {
        assert_near("mu", friction_coefficient(NODE_OF(own), v),
                    friction_coefficient(NODE_OF(known), v), tolerance);
        assert_near("slope", friction_slope(NODE_OF(own), v), friction_slope(NODE_OF(known), v),
                    1e-14 * steep);
        assert_near("phi", friction_contact_density(NODE_OF(own), v),
                    friction_contact_density(NODE_OF(known), v), 1e-14);
    }
}

TEST(test_known_laws)
{
    FrictionLaw law = own_formula("0.1 + 0.28 * exp(-v / 3.4e-4)", 1);
    assert_same(&law, &EXPONENTIAL, 1e-16);
    FrictionLaw linear = EXPONENTIAL;
    linear.kind = FRICTION_LINEAR_WEAKENING;
    law = own_formula("max(0.38 - 0.28 * v / 3.4e-4, 0.1)", 1);
    assert_same(&law, &linear, 2e-16);
    const double velocity[] = {0, 3.4e-4, 1}, mu[] = {0.38, 0.1, 0.1};
    law = own_table(3, velocity, mu, true);
    assert_same(&law, &linear, 2e-16);
}

// Numbers that the scene gives stay, to the bit.
TEST(test_given)
{
    FrictionLaw given = EXPONENTIAL;
    FrictionSource source = {
        .end = 0.02,
        .formula = "mu_kinetic + (mu_static - mu_kinetic) * exp(-v / critical_velocity)"};
    given.kind = FRICTION_FORMULA;
    FrictionLaw law = own_law(given, &source);
    assert_near("mu_K", law.mu_kinetic, 0.1, 0);
    assert_near("v_c", law.critical_velocity, 3.4e-4, 0);
    assert_near("spent", law.spent, 5 * 3.4e-4, 0);
    assert_near("end", friction_slope(NODE_OF(&law), 0.02), 0, 0);
}

// Falls to its lowest at sqrt(a/b) - 1, rises to the end: closed form.
TEST(test_strengthening)
{
    FrictionLaw law = own_formula("0.3 / (1 + v) + 0.01 * (1 + v)", 20);
    double lowest_at = sqrt(30) - 1, lowest = 2 * sqrt(0.003);
    assert_near("mu_S", law.mu_static, 0.31, 1e-15);
    assert_near("mu_K", law.mu_kinetic, lowest, 1e-4);
    assert_true(friction_weakens(NODE_OF(&law), 0.99 * lowest_at));
    assert_false(friction_weakens(NODE_OF(&law), 1.01 * lowest_at));
    assert_true(friction_slope(NODE_OF(&law), 10) > 0);
    // w = 0.3/(1 + v)^2 - 0.01: 1 - 1/e of 0.29 lost.
    assert_near("v_c", law.critical_velocity, sqrt(0.3 / (0.29 / M_E + 0.01)) - 1, 1e-9);
    FrictionLaw flat = own_formula("0.4", 1);
    assert_near("no drop", friction_law_drop(&flat), 0, 0);
    assert_near("no v_c", flat.critical_velocity, 0, 0);
}

// Laws that rise above what holds at rest. One that only rises: no drop, v_c where its slope has
// fallen to 1/e. One that falls again, by 0.3 from its top: the drop is that, spent where 1 % of it
// is left.
TEST(test_above_rest)
{
    FrictionLaw law = own_formula("0.3 + 0.4 * (1 - exp(-v / 2))", 100);
    assert_near("mu_S", law.mu_static, 0.3, 1e-16);
    assert_near("mu_K", law.mu_kinetic, 0.3, 1e-16);
    assert_near("drop", friction_law_drop(&law), 0, 0);
    assert_near("steepest", friction_steepest(NODE_OF(&law)), 0, 0);
    assert_near("v_c", law.critical_velocity, 2, 1e-9);
    assert_near("spent", friction_spent_speed(NODE_OF(&law)), 0, 0);
    assert_near("phi", friction_contact_density(NODE_OF(&law), 5), 1, 0);
    assert_true(law.strengthens);
    law = own_formula("0.2 + 0.5 * v * exp(1 - v)", 50);   // to 0.7 at v = 1, down to 0.2
    assert_near("drop", friction_law_drop(&law), 0.5, 1e-3);
    double spent = friction_spent_speed(NODE_OF(&law));
    assert_near("left", spent * exp(1 - spent), 0.01, 1e-3);
    FrictionNode half = friction_node(&law, 0.5);
    assert_near("drop of half", friction_drop(&half), 0.5 * friction_law_drop(&law), 1e-15);
    law = own_formula("0.4 * tanh(v)", 20);   // no friction at rest: lubricated
    assert_near("mu_S", law.mu_static, 0, 0);
}

TEST(test_refusals)
{
    static const struct {
        const char *formula, *words;
    } known[] = {{"0.4 - 0.1 * v", "is -"},
                 {"0.4 - 0.1 * v", "must not be negative"},
                 {"0.3 - 0.1 * sqrt(v)", "at velocity 0 the slope"},
                 {"0.3 + 0.1 * log(v)", "at velocity 0 the coefficient is -inf"},
                 {"0.3 - 0.1 * (v - 2) / abs(v - 2)", "at velocity 2 the coefficient jumps"},
                 {"0.3 + 0 * exp(v * 300)", "not a finite number"},
                 {"0.3 - 0.1 * abs(v) / v", "at velocity 0 the coefficient is"}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        const char *key = NULL;
        FrictionLaw law = {.kind = FRICTION_FORMULA};
        FrictionSource source = {.formula = known[k].formula, .end = 10};
        assert_false(friction_make(&source, &law, &key, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, known[k].words))
            fail_msg("%s: \"%s\" lacks \"%s\"", known[k].formula, err.message, known[k].words);
    }
}

// Laws that touch their limits, or come close to them, are not refused.
TEST(test_at_the_limits)
{
    static const char *const formulas[] = {"0.3 - 0.2 * v + v^2 / 30",   // 0.3 (1 - v/3)^2
                                           "0.3 - 0.29999 * exp(-((v - 3.1234567) / 0.01)^2)",
                                           "0.3 * (1 - tanh(v)) + 0 * v",
                                           "0.3 - 0.1 * v * exp(-v) + 0.1 * v * exp(-v)",
                                           "max(0, 0.3 - v)",
                                           "points(v, 0, 0.3, 1, 0, 2, 0, 5, 0.3)"};
    for (size_t k = 0; k < sizeof formulas / sizeof formulas[0]; k++) own_formula(formulas[k], 5);
}

// mu_static and mu_kinetic that are not those of the law.
TEST(test_contradictions)
{
    for (int32_t k = 0; k < 2; k++) {
        Error err = {0};
        const char *key = NULL;
        FrictionLaw law = {.kind = FRICTION_FORMULA, .mu_static = k ? 0 : 0.5, .mu_kinetic = 0.2};
        FrictionSource source = {.formula = "0.1 + 0.3 * exp(-v)", .end = 10};
        assert_false(friction_make(&source, &law, &key, &err));
        assert_non_null(strstr(err.message, k ? "mu_kinetic" : "mu_static is given as 0.5"));
    }
}

// A law of speed alone that is 0 at rest and rises never holds, as the same law with a pressure
// that it does not feel; one that is 0 and level there, or holds a little, does not creep.
TEST(test_creeps)
{
    FrictionLaw law = own_formula("0.3 * tanh(v / 1e-3)", 0.1);
    FrictionLaw pressed = own_formula("0.3 * tanh(v / 1e-3) + 0 * p", 0.1);
    assert_true(law.creeps && pressed.creeps);
    assert_near("mu at the rod's V, here the end", law.mu_reference, pressed.mu_reference, 1e-15);
    const double velocity[] = {0, 1e-3, 1}, rises[] = {0, 0.3, 0.2}, level[] = {0, 0, 0};
    law = own_table(3, velocity, rises, true);
    assert_true(law.creeps);
    law = own_table(3, velocity, level, true);
    assert_false(law.creeps);
    law = own_formula("0.01 + 0.3 * tanh(v / 1e-3)", 0.1);
    assert_false(law.creeps);
}
