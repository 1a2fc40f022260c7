// SPDX-License-Identifier: GPL-2.0-or-later
// Sums and products of numbers and of named quantities, so that a study can say
// `mesh.set.height: = 0.5 * mesh.set.length`. Called by study/sweep/study.
//
//     sum = product {(+|-) product}     product = power {(*|/) power}
//     power = - power | unit [^ power]
//     unit = number | name | sqrt(sum) | (sum)
#ifndef AMONTONS_STUDY_SWEEP_FORMULA_H
#define AMONTONS_STUDY_SWEEP_FORMULA_H

#include "base/error.h"

// Gives the number called `name`; false: there is none.
typedef bool (*FormulaLookUp)(const void *context, const char *name, double *value);

// ERROR_INPUT, without a place: what in `text` is wrong, or that the value is not finite.
bool formula_value(const char *text, FormulaLookUp look_up, const void *context, double *value,
                   Error *err);

#endif
