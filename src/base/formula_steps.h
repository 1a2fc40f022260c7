// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a formula, shared by formula.c and formula_bounds.c; no other file includes this one.
#ifndef AMONTONS_BASE_FORMULA_STEPS_H
#define AMONTONS_BASE_FORMULA_STEPS_H

#include <stdbool.h>

enum { MANY = -1 };

// symbol, name in a formula, arguments
#define FUNCTIONS(X)                                                                               \
    X(STEP_SQRT, "sqrt", 1)                                                                        \
    X(STEP_EXP, "exp", 1)                                                                          \
    X(STEP_LOG, "log", 1)                                                                          \
    X(STEP_TANH, "tanh", 1)                                                                        \
    X(STEP_ASINH, "asinh", 1)                                                                      \
    X(STEP_ABS, "abs", 1)                                                                          \
    X(STEP_ROUND, "round", 1)                                                                      \
    X(STEP_MIN, "min", 2)                                                                          \
    X(STEP_MAX, "max", 2)                                                                          \
    X(STEP_POINTS, "points", MANY)

typedef enum Operation {
#define X(symbol, name, arguments) symbol,
    FUNCTIONS(X)
#undef X
        STEP_FUNCTIONS,   // how many
    STEP_NUMBER = STEP_FUNCTIONS,
    STEP_VARIABLE,
    STEP_NEGATE,
    STEP_ADD,
    STEP_SUBTRACT,
    STEP_MULTIPLY,
    STEP_DIVIDE,
    STEP_POWER
} Operation;

bool formula_takes_two(Operation operation);   // off the stack, for the one that it puts there

#endif
