// SPDX-License-Identifier: GPL-2.0-or-later
// Formulas against values worked out by C itself; what is wrong in one, and where.
#include "base/formula.h"

#include "cases.h"

#include <math.h>
#include <string.h>

static bool look_up(const void *context, const char *name, double *value)
{
    (void)context;
    if (strcmp(name, "mesh.set.length") == 0) *value = 4;
    if (strcmp(name, "load.pressure") == 0) *value = 3e-3;
    return strcmp(name, "mesh.set.length") == 0 || strcmp(name, "load.pressure") == 0;
}

TEST(test_values)
{
    static const struct {
        const char *text;
        double value;
    } known[] = {{" 0.5 * mesh.set.length", 2},
                 {"12*load.pressure*mesh.set.length", 12 * 3e-3 * 4},
                 {"1 + 2 * 3 - 4", 1 + 2 * 3 - 4},
                 {"8 / 4 / 2", 1},
                 {"10 - 4 - 3", 3},
                 {"(1 + 2) * 3", 9},
                 {"-2 ^ 2", -4},
                 {"2 ^ 3 ^ 2", 512},
                 {"2 ^ -1", 0.5},
                 {"--3", 3},
                 {"sqrt(mesh.set.length) + 1e-3", 2.001},
                 {".5e1", 5},
                 {"points(0.5, 0, 1, 1, 3)", 2},
                 {"points(-1, 0, 1, 1, 3) + points(5, 0, 1, 1, 3, 2, 7)", 8},
                 {"exp(1) * log(2)", 2.718281828459045 * 0.6931471805599453},
                 {"tanh (0.5)", 0.46211715726000979},
                 {"abs(-3) + min(2, 1) * max(2, 1)", 5},
                 {"round(2.4) + 10 * round(2.5) + 100 * round(-1.6)", -168},
                 {"min(4, 3, 1, 2) + 10 * max(4, 7, 1, 5)", 71},
                 {"points(1, 0, 5, 1, 5, 1, 3, 2, 4)", 5},   // a jump: the first value holds there
                 {"points(1.5, 0, 5, 1, 5, 1, 3, 2, 4) + points(0, 0, 1, 0, 2)", 4.5},
                 {"2.3e-6 / mesh.set.length", 2.3e-6 / 4}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        double value = NAN;
        if (!formula_value(known[k].text, look_up, NULL, &value, &err))
            fail_msg("%s: %s", known[k].text, err.message);
        assert_true(fabs(value - known[k].value) <= 1e-15 * fabs(known[k].value));
    }
}

TEST(test_refusals)
{
    static const struct {
        const char *text, *message;
    } known[] = {{"", "ends where"},
                 {"2 *", "ends where"},
                 {"(1 + 2", "ends where a closing bracket"},
                 {"1 2", "`2`: expected an operator"},
                 {"mesh.set.lenght", "`mesh.set.lenght` is no number"},
                 {"1 / 0", "not finite"},
                 {"sqrt(-1)", "not finite"},
                 {"sqrt", "`sqrt` is no number"},
                 {"exp(1, 2)", "`, 2)`: expected a closing bracket"},
                 {"points(1, 2, 3)", "`)`: expected x and two points"},
                 {"points(1, 0, 1, -1, 1)", "not finite"},
                 {"min(1)", "`)`: expected a comma"},
                 {"2 * 1 ms", "`ms`: expected an operator (numbers in a formula have no unit"},
                 {"3 $ 4", "`$ 4`: expected an operator"},
                 {"0x10", "`0x10`: expected a decimal number"},
                 {"2 * 0X1p3", "`0X1p3`: expected a decimal number"}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        double value = 0;
        assert_false(formula_value(known[k].text, look_up, NULL, &value, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, known[k].message))
            fail_msg("%s: \"%s\" lacks \"%s\"", known[k].text, err.message, known[k].message);
    }
}

// Derivatives against central differences of the values, at several places each.
TEST(test_derivatives)
{
    static const char *const texts[] = {"v",
                                        "load.pressure",
                                        "2 - 3 * v + v * v",
                                        "v / (1 + v)",
                                        "(1 + v) ^ -0.3",
                                        "2 ^ v",
                                        "(1 + v) ^ (v / 2)",
                                        "sqrt(1 + v)",
                                        "exp(-v / 0.3)",
                                        "log(1 + v / 0.1)",
                                        "tanh(2 * v)",
                                        "0.01 * asinh(300 * v)",
                                        "abs(v - 0.5) + abs(v)",
                                        "min(v, 0.4)",
                                        "max(v ^ 2, v)",
                                        "min(v ^ 2, v, 0.9)",
                                        "points(v, 0, 1, 0.4, 3, 0.4, 2, 2, 0.5)",
                                        "points(v ^ 2, 0, 1, 0.4, 3, 2, 0.5)",
                                        "-v ^ 3"};
    FormulaNames names = {.look_up = look_up, .variable = "v", .unknown = "is unknown"};
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
        for (double v = 0.05; v < 2; v += 0.1701) {
            Error err = {0};
            Formula formula;
            double slope, ignored, h = 1e-6;
            assert_true(formula_read(texts[k], &names, &formula, &err));
            formula_at(&formula, v, &slope);
            double difference =
                (formula_at(&formula, v + h, &ignored) - formula_at(&formula, v - h, &ignored)) /
                (2 * h);
            if (!(fabs(slope - difference) <= 1e-8 * (1 + fabs(slope))))
                fail_msg("%s at %g: %.12g, differences %.12g", texts[k], v, slope, difference);
        }
    }
    Error err = {0};
    Formula formula;
    assert_false(formula_read("w", &names, &formula, &err));
    assert_string_equal(err.message, "`w` is unknown");
}

// Two formulas in one list, of three variables: all derivatives, each of its own part.
TEST(test_partials)
{
    static const char *const more[] = {"theta", "p"};
    static const char *const texts[] = {"0.3 + 0.01 * asinh(v * exp(theta)) / (1 + p)",
                                        "1 - v * theta / 0.2 + min(p, theta ^ 2)"};
    FormulaNames names = {.look_up = look_up, .variable = "v", .more = more, .more_count = 2};
    Error err = {0};
    Formula formula = {0};
    int32_t ends[] = {0, 0, 0};
    for (int k = 0; k < 2; k++) {
        assert_true(formula_append(texts[k], &names, &formula, &err));
        ends[k + 1] = formula.count;
    }
    const double x[] = {0.7, 1.3, 0.4}, h = 1e-6;
    double slope[3], ignored[3];
    double value = formula_partials(&formula, ends, x, 3, slope);
    assert_true(fabs(value - (0.3 + 0.01 * asinh(0.7 * exp(1.3)) / 1.4)) < 1e-15);
    for (int part = 0; part < 2; part++) {
        formula_partials(&formula, ends + part, x, 3, slope);
        for (int k = 0; k < 3; k++) {
            double up[] = {x[0], x[1], x[2]}, down[] = {x[0], x[1], x[2]};
            up[k] += h;
            down[k] -= h;
            double difference = (formula_partials(&formula, ends + part, up, 3, ignored) -
                                 formula_partials(&formula, ends + part, down, 3, ignored)) /
                                (2 * h);
            assert_true(fabs(slope[k] - difference) < 1e-8 * (1 + fabs(difference)));
        }
    }
    assert_false(formula_append("theta * phi", &names, &formula, &err));
}

// A formula of more steps than there is room for is refused.
TEST(test_length)
{
    char text[2 * FORMULA_STEPS_MAX + 2] = "1";
    for (int32_t k = 0; k < FORMULA_STEPS_MAX; k++) strcat(text, "+1");
    Error err = {0};
    double value = 0;
    assert_false(formula_value(text, look_up, NULL, &value, &err));
    assert_non_null(strstr(err.message, "a shorter formula"));
    err = (Error){0};
    memset(text, 'a', 300);
    text[300] = 0;
    assert_false(formula_value(text, look_up, NULL, &value, &err));
    assert_non_null(strstr(err.message, "a shorter name"));
}

// Neither brackets, nor signs, nor powers without end run the stack over.
TEST(test_depth)
{
    for (const char *sign = "(-^"; *sign; sign++) {
        char text[20001];
        double value = 0;
        Error err = {0};
        for (size_t k = 0; k + 1 < sizeof text; k++)
            text[k] = *sign == '^' && k % 2 == 0 ? '1' : *sign;
        text[sizeof text - 1] = 0;
        assert_false(formula_value(text, look_up, NULL, &value, &err));
        assert_non_null(strstr(err.message, "fewer"));
    }
}
