// SPDX-License-Identifier: GPL-2.0-or-later
// The shipped example as a law: the same bits as the built-in one; what is no plug-in is refused.
#include "own_laws.h"

// A file of the build, as seen from the program's folder.
static const char *built(const char *name, char *path, size_t size)
{
    const char *bin = getenv("AMONTONS_BIN");
    snprintf(path, size, "%s/%s", bin ? bin : "build/bin", name);
    return path;
}

static const char *example(char *path, size_t size)
{
    return built("../tests/stribeck.so", path, size);
}

TEST(test_same_bits)
{
    char path[1000];
    FrictionLaw known = {.kind = FRICTION_EXPONENTIAL_WEAKENING,
                         .mu_static = 0.38,
                         .mu_kinetic = 0.1,
                         .critical_velocity = 3.4e-4};
    FrictionLaw own = known;
    FrictionSource source = {.trusted = true, .file = example(path, sizeof path), .end = 1};
    own.kind = FRICTION_PLUGIN;
    own = own_law(own, &source);
    for (double v = 0; v < 1e-2; v += 1.23e-6) {
        assert_true(friction_coefficient(NODE_OF(&own), v) ==
                    friction_coefficient(NODE_OF(&known), v));
        assert_true(friction_slope(NODE_OF(&own), v) == friction_slope(NODE_OF(&known), v));
    }
    assert_true(friction_spent_speed(NODE_OF(&own)) == friction_spent_speed(NODE_OF(&known)));
    assert_true(own.critical_velocity == known.critical_velocity);
    assert_true(own.mu_kinetic == known.mu_kinetic);
}

// Parameters reach it: mu rises again by a log(1 + v/v_a).
TEST(test_parameters)
{
    char path[1000];
    const double parameters[] = {0.02, 1e-3};
    FrictionLaw own = {
        .kind = FRICTION_PLUGIN, .mu_static = 0.38, .mu_kinetic = 0.1, .critical_velocity = 3.4e-4};
    FrictionSource source = {.trusted = true,
                             .file = example(path, sizeof path),
                             .parameters = parameters,
                             .parameter_count = 2,
                             .end = 0.1};
    own = own_law(own, &source);
    assert_near("mu", friction_coefficient(NODE_OF(&own), 0.05), 0.1 + 0.02 * log(51), 1e-15);
    assert_near("slope", friction_slope(NODE_OF(&own), 0.05), 0.02 / 0.051, 1e-14);
}

// Built for the first version of amontons_friction.h.
TEST(test_first_interface)
{
    char path[1000];
    const double parameters[] = {0.4};
    FrictionSource source = {.trusted = true,
                             .file = built("../tests/friction_interface_1.so", path, sizeof path),
                             .parameters = parameters,
                             .parameter_count = 1,
                             .end = 0.1};
    FrictionLaw own =
        own_law((FrictionLaw){.kind = FRICTION_PLUGIN, .critical_velocity = 1e-3}, &source);
    assert_false(own.remembers);
    assert_near("mu", friction_coefficient(NODE_OF(&own), 3e-3), 0.1, 1e-15);
    assert_near("slope", friction_slope(NODE_OF(&own), 1e-3), -100, 1e-11);
}

// The shipped law with two states against the same by formulas: start, mu of a stage and its slope.
TEST(test_states)
{
    char path[1000];
    const double parameters[] = {0.3, 1e-5, 0.01, 0.016, 1e-4, 0.004, 1e-3};
    static const FrictionStateText states[] = {
        {.name = "psi", .rate = "(1e-5 * exp(-psi) - v) / 1e-4", .start = "log(1e-5 * 50 / 1e-4)"},
        {.name = "chi", .rate = "(1e-5 * exp(-chi) - v) / 1e-3", .start = "log(1e-5 * 50 / 1e-3)"}};
    FrictionSource source = {.trusted = true,
                             .file = built("../tests/two_states.so", path, sizeof path),
                             .parameters = parameters,
                             .parameter_count = 7,
                             .rod_velocity = 1e-5,
                             .rest = 50,
                             .pressure = 3e-3,
                             .end = 1};
    FrictionSource text = {
        .formula = "0.01 * asinh(v / 2e-5 * exp((0.3 + 0.016 * psi + 0.004 * chi) / 0.01))",
        .state = states,
        .state_count = 2,
        .rod_velocity = 1e-5,
        .pressure = 3e-3,
        .end = 1};
    FrictionLaw own = own_law((FrictionLaw){.kind = FRICTION_PLUGIN}, &source);
    FrictionLaw known = own_law((FrictionLaw){.kind = FRICTION_FORMULA}, &text);
    assert_true(own.creeps && known.creeps);
    assert_int_equal(own.states, 2);
    assert_near("v_c", own.critical_velocity, known.critical_velocity, 1e-12);
    assert_near("mu_K", own.mu_kinetic, known.mu_kinetic, 1e-12);
    double start[STATES_MAX], other[STATES_MAX];
    FrictionNode node = friction_node(&own, 1), known_node = friction_node(&known, 1);
    friction_start_state(&node, start);
    friction_start_state(&known_node, other);
    for (int k = 0; k < 2; k++) assert_near("start", start[k], other[k], 1e-14);
    friction_set_stage(&node, start, 3);
    friction_set_stage(&known_node, other, 3);
    for (double v = 1e-12; v < 1; v *= 7) {
        double slope = friction_slope(&known_node, v);
        assert_near("mu", friction_coefficient(&node, v), friction_coefficient(&known_node, v),
                    1e-13);
        assert_near("slope", friction_slope(&node, v) / slope, 1, 1e-10);
    }
}

static void check_refused_of(bool trusted, const char *file, int32_t parameters, const char *words)
{
    static const double numbers[AMONTONS_FRICTION_PARAMETERS_MAX + 1] = {0};
    Error err = {0};
    const char *key = NULL;
    FrictionLaw law = {.kind = FRICTION_PLUGIN};
    FrictionSource source = {.trusted = trusted,
                             .file = file,
                             .parameters = numbers,
                             .parameter_count = parameters,
                             .end = 1};
    assert_false(friction_make(&source, &law, &key, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(key, "file");
    if (!strstr(err.message, words)) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
}

static void check_refused(const char *file, int32_t parameters, const char *words)
{
    check_refused_of(true, file, parameters, words);
}

TEST(test_refusals)
{
    char path[1000];
    check_refused("/proc/none.so", 0, "cannot read /proc/none.so: No such file");
    check_refused("libm.so.6", 0, "cannot read libm.so.6");   // not from the system's folders
    check_refused(built("amontons_hdf5.so", path, sizeof path), 0, "has no function");
    check_refused(built("../tests/two_states.so", path, sizeof path), 3, "has 0 states");
    check_refused(example(path, sizeof path), AMONTONS_FRICTION_PARAMETERS_MAX + 1, "at most 16");
    check_refused_of(false, example(path, sizeof path), 0, "--trust");
}
