// SPDX-License-Identifier: GPL-2.0-or-later
// Laws of one's own that remember: steady slip, rest and scales against closed forms; which of them
// creep; what is refused.
#include "friction/friction_start.h"
#include "own_laws.h"

static const FrictionStateText AGE = {.name = "theta", .rate = "1 - v * theta / 1e-3"};
static const char AGED[] = "(0.1 + 0.3 * exp(-v / 1e-2)) * (1 + 0.02 * log(1 + theta / 10))";

static FrictionSource source_of(const char *formula, const FrictionStateText *state, int32_t count)
{
    return (FrictionSource){.formula = formula,
                            .state = state,
                            .state_count = count,
                            .rod_velocity = 1e-4,
                            .pressure = 0.01,
                            .end = 1};
}

static FrictionLaw made(const FrictionSource *source)
{
    return own_law((FrictionLaw){.kind = FRICTION_FORMULA}, source);
}

TEST(test_start)
{
    double now[STATES_MAX];
    FrictionSource source = source_of(AGED, &AGE, 1);
    FrictionLaw law = made(&source);
    friction_start_state(NODE_OF(&law), now);
    assert_near("steady slip at the rod's velocity", now[0], 10, 1e-9);
    assert_near("mu_S", law.mu_static, 0.4 * (1 + 0.02 * log(2)), 1e-10);
    assert_false(law.creeps);
    source.rest = 500;
    law = made(&source);
    friction_start_state(NODE_OF(&law), now);
    assert_near("and then at rest", now[0], 510, 1e-7);
    FrictionStateText given = AGE, heals = {.name = "phi", .rate = "(1 - phi) / 200", .start = "0"};
    snprintf(given.start, sizeof given.start, "2 + 3");
    source.state = &given;
    source.rest = 0;
    law = made(&source);
    friction_start_state(NODE_OF(&law), now);
    assert_near("given", now[0], 5, 0);
    source = source_of("0.2 + 0.1 * phi", &heals, 1);
    source.rest = 300;
    law = made(&source);
    friction_start_state(NODE_OF(&law), now);
    assert_near("exponentially", now[0], -expm1(-1.5), 1e-5);   // steps of 1 % of the time gone
}

TEST(test_scales)
{
    // mu of steady slip falls by 0.02 in each e-fold of v, from the least speed looked at, 1e-12.
    FrictionStateText psi = {.name = "psi", .rate = "(1e-4 * exp(-psi) - v) / 1e-3"};
    FrictionSource source =
        source_of("0.01 * asinh(v / 2e-4 * exp((0.6 + 0.03 * psi) / 0.01))", &psi, 1);
    FrictionLaw law = made(&source);
    assert_true(law.creeps && law.strengthens);
    assert_near("mu_K", law.mu_kinetic, 0.6 - 0.02 * log(1e4), 1e-9);
    assert_near("drop", friction_law_drop(&law), 0.02 * log(1e12) * 11.9 / 12, 1e-9);
    FrictionRates rates;
    double start = 0;
    friction_start_state(NODE_OF(&law), &start);
    assert_near("psi at V_0", start, 0, 1e-12);
    friction_rates(NODE_OF(&law), 1e-4, &start, &rates);
    assert_near("f_0", rates.mu, 0.6, 1e-12);
}

static void check_refused(FrictionSource source, const char *key_wanted, const char *words)
{
    Error err = {0};
    const char *key = NULL;
    FrictionLaw law = {.kind = FRICTION_FORMULA};
    assert_false(friction_make(&source, &law, &key, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, words)) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
    assert_string_equal(key, key_wanted);
}

TEST(test_refusals)
{
    static const FrictionStateText grows = {.name = "x", .rate = "1"},
                                   root = {.name = "x", .rate = "sqrt(-1 - x)"},
                                   steep = {.name = "x", .rate = "sqrt(x) - v", .start = "0"},
                                   other = {.name = "x", .rate = "y - v"};
    check_refused(source_of("0.3 - 0.1 * theta", &AGE, 1), "formula",
                  "at velocity 0.0001, theta 10 the coefficient is -0.7: it must not be negative");
    check_refused(source_of("0.3", &grows, 1), "state", "no state of steady slip is found");
    check_refused(source_of("0.3", &root, 1), "state", "nan: not a finite number");
    check_refused(source_of("0.3", &steep, 1), "formula", "derivative");
    check_refused(source_of("0.3", &other, 1), "state", "`y` is no number here");
    check_refused(source_of("0.3 + 0.01 * round(theta / 20)", &AGE, 1), "formula",
                  "at theta 10 the coefficient jumps");
    check_refused(source_of("0.3 + 0.01 * round(v / 1e-3)", &AGE, 1), "formula", "at velocity ");
    FrictionSource pressed = source_of("0.3 + 0.01 * round(p / 0.2)", &AGE, 1);
    pressed.pressure = 0.05;
    check_refused(pressed, "formula", "at pressure 0.1 the coefficient jumps");
    FrictionSource without = source_of(AGED, &AGE, 1);
    without.rod_velocity = 0;
    check_refused(without, "state", "a state needs its `start`");
}

// A state of steady slip, and none.
TEST(test_steady_states)
{
    static const char *const rates[] = {"1 - v * x", "v"};
    for (int32_t k = 0; k < 2; k++) {
        FrictionStateText text = {.name = "x", .start = "0.1"};
        snprintf(text.rate, sizeof text.rate, "%s", rates[k]);
        FrictionSource source = source_of("0.3", &text, 1);
        FrictionLaw law = made(&source);
        FrictionNode node = friction_node(&law, 1);
        assert_int_equal(friction_find_steady(&node, 1e-3), k == 0);
        if (k == 0) assert_near("1 / v", node.from[0], 1e3, 1e-6);
    }
}
