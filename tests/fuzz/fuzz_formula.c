// SPDX-License-Identifier: GPL-2.0-or-later
// A formula of two variables: what is read can be evaluated, with derivatives and without, to the
// same value.
#include "base/formula.h"
#include "tests/fuzz/fuzz.h"

#include <math.h>
#include <string.h>

static bool look_up(const void *context, const char *name, double *value)
{
    (void)context;
    *value = 0.38;
    return strcmp(name, "mu") == 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const more[] = {"p"};
    static const double places[] = {-2.5, -1, 0, 1e-3, 1, 40};
    const FormulaNames one = {look_up, NULL, "v", "is not known", NULL, 0};
    const FormulaNames two = {look_up, NULL, "v", "is not known", more, 1};
    static Formula formula;
    Error err = {0}, other = {0};
    char *text = malloc(size + 1);
    if (!text) return 0;
    memcpy(text, data, size);
    text[size] = 0;
    if (formula_read(text, &two, &formula, &err))
        for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
            double x[2] = {places[k], 0.003}, slope[2];
            const int32_t all[2] = {0, formula.count};
            double value = formula_partials(&formula, all, x, 2, slope);
            double alone = formula_partials(&formula, all, x, 0, NULL);
            if (memcmp(&value, &alone, sizeof value) != 0) abort();
        }
    if (formula_read(text, &one, &formula, &other) && !error_is_clean(&err))
        abort();   // fewer variables know fewer formulas
    free(text);
    return 0;
}
