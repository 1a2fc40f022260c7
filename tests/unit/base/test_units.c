// SPDX-License-Identifier: GPL-2.0-or-later
// Conversions worked out by hand; equality is exact, because powers of ten are kept whole.
#include "base/units.h"

#include "cases.h"

#include <stdint.h>
#include <string.h>

TEST(test_conversions)
{
    static const struct {
        double given;
        const char *suffix, *dimension;
        double si;
    } cases[] = {
        {10, "um/s", "velocity", 1e-5},
        {3, "kPa", "stress", 3000},
        {0.3, "mm", "length", 3e-4},
        {7, "m", "length", 7},
        {5, "cm", "length", 0.05},
        {2, "km", "length", 2000},
        {3, "\xC2\xB5m", "length", 3e-6},
        {3, "\xCE\xBCm", "length", 3e-6},
        {20, "nm", "length", 2e-8},
        {2, "ms", "time", 2e-3},
        {2, "us", "time", 2e-6},
        {1.5, "GPa", "stress", 1.5e9},
        {2, "N/m2", "stress", 2},
        {2, "N/mm^2", "stress", 2e6},
        {1200, "kg/m3", "density", 1200},
        {1.2, "g/cm3", "density", 1200},
        {1.2, "g / cm^3", "density", 1200},
        {1200, "kg m-3", "density", 1200},
        {4, "Pa s", "viscosity", 4},
        {4, "kPa.s", "viscosity", 4000},
        {4, "MPa*s", "viscosity", 4e6},
        {4, "mPa s", "viscosity", 4e-3},
        {6, "mm/ms", "velocity", 6},
        {6, "m s-1", "velocity", 6},
        {2, "J/m3", "stress", 2},
        {9, "s/s", "1", 9},
        {2, "min", "time", 120},
        {6, "m/min", "velocity", 0.1},
        {36, "km/h", "velocity", 10},
        {2, "h", "time", 7200},
        {3, "\xB5m", "length", 3e-6},   // Latin-1
        {5, "kHz", "frequency", 5000},
        {5, "rad/s", "frequency", 5},
        {5, "1/s", "frequency", 5},
        {2, "bar", "stress", 2e5},
        {4e6, "N/m", "force/length", 4e6},
        {6, "kN", "force", 6000},
        {4, "-", "1", 4},
        {4, "1", "1", 4},
        {4, "%", "1", 0.04},
        {2, "N/mm\xC2\xB2", "stress", 2e6},
        {6, "m s\xE2\x81\xBB\xC2\xB9", "velocity", 6},
        {4, "Pa\xC2\xB7s", "viscosity", 4},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        double value = cases[k].given;
        if (!unit_to_si(cases[k].suffix, cases[k].dimension, &value))
            fail_msg("%s is no %s", cases[k].suffix, cases[k].dimension);
        if (value != cases[k].si) fail_msg("%s: %.17g", cases[k].suffix, value);
    }
}

TEST(test_refusals)
{
    static const char *const cases[][2] = {
        {"", "length"},     {"foo", "length"},       {"Mm/s", "length"},     {"m/s/s", "velocity"},
        {"m0", "length"},   {"m99", "length"},       {"m^", "velocity"},     {"/s", "1"},
        {"m/", "length"},   {"m s", "velocity"},     {"1/", "velocity"},     {"pa", "stress"},
        {"Pa", "length"},   {"kk", "length"},        {"k", "length"},        {"m!", "length"},
        {"m m0", "length"}, {"kg/m/m/m", "density"}, {"\xC2\xB5", "length"}, {"m", "1"},
        {"m..", "length"},  {"mm2", "length"},       {"m^-", "length"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        double value = 1;
        if (unit_to_si(cases[k][0], cases[k][1], &value))
            fail_msg("`%s` passes as %s", cases[k][0], cases[k][1]);
        assert_true(value == 1);
    }
}

TEST(what_to_divide_by)
{
    static const struct {
        const char *unit, *dimension, *by;   // by NULL: nothing that is known
        bool times;
    } cases[] = {{"kN", "stress", "area", false},    {"N/m", "stress", "length", false},
                 {"kPa", "force", "area", true},     {"mm", "velocity", "time", false},
                 {"MPa", "viscosity", "time", true}, {"kg", "stress", NULL, false},
                 {"quux", "stress", NULL, false}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        bool times = false;
        const char *by = unit_quotient(cases[k].unit, cases[k].dimension, &times);
        if (!cases[k].by != !by) fail_msg("%s: %s", cases[k].unit, by ? by : "none");
        if (!by) continue;
        assert_string_equal(by, cases[k].by);
        assert_true(times == cases[k].times);
    }
}

// The examples in errors must be accepted.
TEST(test_examples_are_units)
{
    static const char *const dimensions[] = {"length",  "time",      "velocity", "stress",
                                             "density", "viscosity", "force",    "force/length",
                                             "area",    "frequency"};
    for (size_t k = 0; k < sizeof dimensions / sizeof dimensions[0]; k++) {
        char text[100];
        assert_true(strlen(unit_examples(dimensions[k])) < sizeof text);
        strcpy(text, unit_examples(dimensions[k]));
        int32_t count = 0;
        char *rest = NULL;
        for (char *unit = strtok_r(text, ",", &rest); unit; unit = strtok_r(NULL, ",", &rest)) {
            double value = 1;
            assert_true(unit_to_si(unit + strspn(unit, " "), dimensions[k], &value));
            count++;
        }
        assert_true(count >= 2);
    }
    assert_string_equal(unit_examples("1"), "");
}
