// SPDX-License-Identifier: GPL-2.0-or-later
// Sums and products of numbers, of named quantities and of variables, so that a study can say
// `mesh.set.height: = 0.5 * mesh.set.length` and a scene its own friction law. Called by
// scene/formulas and friction/laws.
//
//     sum = product {(+|-) product}     product = power {(*|/) power}
//     power = - power | unit [^ power]
//     unit = number | name | function(sum {, sum}) | (sum)
//     function = sqrt, exp, log, tanh, asinh, abs, round (to a whole number); of two or more: min,
//                max
//     points(x, x_1, y_1, x_2, y_2, ...): lines through points of ascending x, level beyond; the
//     same x twice is a jump
#ifndef AMONTONS_BASE_FORMULA_H
#define AMONTONS_BASE_FORMULA_H

#include "base/error.h"

#include <stdint.h>

enum { FORMULA_STEPS_MAX = 256, FORMULA_VARIABLES_MAX = 10 };

// Gives the number called `name`; false: there is none.
typedef bool (*FormulaLookUp)(const void *context, const char *name, double *value);

typedef struct FormulaNames {
    FormulaLookUp look_up;
    const void *context;
    const char *variable;   // NULL: none
    const char *unknown;   // what is said of any other name, after it
    const char *const *more;   // [more_count] variables behind the first
    int32_t more_count;
} FormulaNames;

typedef struct FormulaStep {
    int32_t operation;
    double number;   // of a step that is a number; of points, how many it takes off the stack; of a
        // variable, which it is
} FormulaStep;

// A formula is a list of steps on a stack: nothing is owned, and copies are as good.
typedef struct Formula {
    int32_t count;
    FormulaStep step[FORMULA_STEPS_MAX];
} Formula;

// ERROR_INPUT, without a place: what in `text` is wrong.
bool formula_read(const char *text, const FormulaNames *names, Formula *formula, Error *err);

// Puts the steps of `text` behind those that are there: several formulas may share a list.
bool formula_append(const char *text, const FormulaNames *names, Formula *formula, Error *err);

// The formula depends on this variable, or seems to.
bool formula_has(const Formula *formula, int32_t variable);

// Value at the variables x of the steps part[0] to part[1] - 1, which are a formula, and its
// derivatives by the first `count` variables, slope [count]; if count is 0, the value alone.
double formula_partials(const Formula *formula, const int32_t part[2], const double *x,
                        int32_t count, double *slope);

// Value at x of a formula of one variable, and through *slope its derivative, exact but for
// rounding. At a kink of abs, min or max the derivative is that of one side; at a jump of round it
// is 0.
double formula_at(const Formula *formula, double x, double *slope);

// The value of a formula without a variable. ERROR_INPUT as above, or that it is not finite.
bool formula_value(const char *text, FormulaLookUp look_up, const void *context, double *value,
                   Error *err);

#endif
