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
    FrictionSource source = {.file = example(path, sizeof path), .end = 1};
    own.kind = FRICTION_PLUGIN;
    assert_int_equal(setenv("AMONTONS_TRUST", "yes", 1), 0);
    own = own_law(own, &source);
    for (double v = 0; v < 1e-2; v += 1.23e-6) {
        assert_true(friction_coefficient(&own, v) == friction_coefficient(&known, v));
        assert_true(friction_slope(&own, v) == friction_slope(&known, v));
    }
    assert_true(friction_spent_speed(&own) == friction_spent_speed(&known));
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
    FrictionSource source = {.file = example(path, sizeof path),
                             .parameters = parameters,
                             .parameter_count = 2,
                             .end = 0.1};
    own = own_law(own, &source);
    assert_near("mu", friction_coefficient(&own, 0.05), 0.1 + 0.02 * log(51), 1e-15);
    assert_near("slope", friction_slope(&own, 0.05), 0.02 / 0.051, 1e-14);
}

static void check_refused(const char *file, int32_t parameters, const char *words)
{
    static const double numbers[AMONTONS_FRICTION_PARAMETERS_MAX + 1] = {0};
    Error err = {0};
    const char *key = NULL;
    FrictionLaw law = {.kind = FRICTION_PLUGIN};
    FrictionSource source = {
        .file = file, .parameters = numbers, .parameter_count = parameters, .end = 1};
    assert_false(friction_own_law(&source, &law, &key, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(key, "file");
    if (!strstr(err.message, words)) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
}

TEST(test_refusals)
{
    char path[1000];
    check_refused("/no/such.so", 0, "cannot read /no/such.so: No such file");
    check_refused("libm.so.6", 0, "cannot read libm.so.6");   // not from the system's folders
    check_refused(built("amontons_hdf5.so", path, sizeof path), 0, "has no function");
    check_refused(example(path, sizeof path), AMONTONS_FRICTION_PARAMETERS_MAX + 1, "at most 16");
    assert_int_equal(unsetenv("AMONTONS_TRUST"), 0);
    check_refused(example(path, sizeof path), 0, "--trust");
}
