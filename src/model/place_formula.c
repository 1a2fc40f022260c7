// SPDX-License-Identifier: GPL-2.0-or-later
// A formula has one variable, x; y is a number in it, and it is read anew at each y.
#include "model/place_formula.h"

#include <string.h>

static bool look_up(const void *context, const char *name, double *value)
{
    const double *y = context;
    if (!y || strcmp(name, "y") != 0) return false;
    *value = *y;
    return true;
}

bool place_formula_read(const char *text, const double *y, Formula *formula, Error *err)
{
    FormulaNames names = {.look_up = look_up,
                          .context = y,
                          .variable = "x",
                          .unknown = y ? "is no number here: x and y alone"
                                       : "is no number here: x alone"};
    return formula_read(text, &names, formula, err);
}
