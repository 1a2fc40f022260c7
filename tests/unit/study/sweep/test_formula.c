// SPDX-License-Identifier: GPL-2.0-or-later
// Formulas against values worked out by C itself; what is wrong in one, and where.
#include "study/sweep/formula.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static bool look_up(const void *context, const char *name, double *value)
{
    (void)context;
    if (strcmp(name, "mesh.set.length") == 0) *value = 4;
    if (strcmp(name, "load.pressure") == 0) *value = 3e-3;
    return strcmp(name, "mesh.set.length") == 0 || strcmp(name, "load.pressure") == 0;
}

static void test_values(void **state)
{
    (void)state;
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
                 {"2.3e-6 / mesh.set.length", 2.3e-6 / 4}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        Error err = {0};
        double value = NAN;
        if (!formula_value(known[k].text, look_up, NULL, &value, &err))
            fail_msg("%s: %s", known[k].text, err.message);
        assert_true(fabs(value - known[k].value) <= 1e-15 * fabs(known[k].value));
    }
}

static void test_refusals(void **state)
{
    (void)state;
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

// Neither brackets, nor signs, nor powers without end run the stack over.
static void test_depth(void **state)
{
    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_values),
                                       cmocka_unit_test(test_refusals),
                                       cmocka_unit_test(test_depth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
