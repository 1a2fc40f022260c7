// SPDX-License-Identifier: GPL-2.0-or-later
// One function a rule of the grammar in formula.h.
#include "study/sweep/formula.h"

#include "base/text.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

enum { NAME_SIZE = 96, DEPTH_MAX = 50 };

typedef struct Formula {
    const char *at;   // not read yet
    FormulaLookUp look_up;
    const void *context;
    int32_t depth;   // of brackets
    Error *err;
} Formula;

static double read_sum(Formula *formula);

// The next character that is no blank, where reading goes on.
static char next_of(Formula *formula)
{
    formula->at += strspn(formula->at, " \t");
    return *formula->at;
}

static bool take(Formula *formula, char wanted)
{
    if (next_of(formula) != wanted) return false;
    formula->at++;
    return true;
}

// Says what is wanted at this place; NaN, so that it can be returned as a value. The first fault
// counts.
static double refuse(Formula *formula, const char *wanted)
{
    if (next_of(formula))
        error_set(formula->err, ERROR_INPUT, __FILE__, __LINE__,
                  "`%.40s`: expected %s in its place", formula->at, wanted);
    else
        error_set(formula->err, ERROR_INPUT, __FILE__, __LINE__,
                  "the formula ends where %s is "
                  "wanted",
                  wanted);
    return NAN;
}

// A key of the scene, or sqrt with its bracket.
static double read_name(Formula *formula)
{
    char name[NAME_SIZE] = "";
    int32_t length = 0;
    const char *at = formula->at;
    while (isalnum((unsigned char)at[length]) || at[length] == '.' || at[length] == '_') length++;
    if (length >= NAME_SIZE) return refuse(formula, "a shorter name");
    memcpy(name, at, (size_t)length);
    formula->at += length;
    if (strcmp(name, "sqrt") == 0 && next_of(formula) == '(') {
        formula->at++;
        double value = read_sum(formula);
        return take(formula, ')') ? sqrt(value) : refuse(formula, "a closing bracket");
    }
    double value = NAN;
    if (!formula->look_up(formula->context, name, &value))
        error_set(formula->err, ERROR_INPUT, __FILE__, __LINE__,
                  "`%s` is no number that the scene has", name);
    return value;
}

// depth bounds the recursion: a text of a thousand brackets must not overflow the stack.
static double read_unit(Formula *formula)
{
    char next = next_of(formula);
    if (formula->depth > DEPTH_MAX) return refuse(formula, "a formula of fewer brackets");
    if (isdigit((unsigned char)next) || next == '.') {
        double value = 0;
        int32_t length = text_number(formula->at, &value);
        if (length == 0) return refuse(formula, "a decimal number");
        formula->at += length;
        return value;
    }
    if (isalpha((unsigned char)next)) return read_name(formula);
    formula->depth++;
    double value = NAN;
    if (take(formula, '(')) {
        value = read_sum(formula);
        if (!take(formula, ')')) value = refuse(formula, "a closing bracket");
    } else {
        value = refuse(formula, "a number, a key of the scene or a bracket");
    }
    formula->depth--;
    return value;
}

// To the right: 2^3^2 is 2^9; and -2^2 is -4, as in mathematics.
static double read_power(Formula *formula)
{
    if (++formula->depth > DEPTH_MAX) return refuse(formula, "a formula of fewer signs and powers");
    double value = NAN;
    if (take(formula, '-')) {
        value = -read_power(formula);
    } else {
        value = read_unit(formula);
        if (error_is_clean(formula->err) && take(formula, '^'))
            value = pow(value, read_power(formula));
    }
    formula->depth--;
    return value;
}

static double read_product(Formula *formula)
{
    double value = read_power(formula);
    while (error_is_clean(formula->err)) {
        if (take(formula, '*'))
            value *= read_power(formula);
        else if (take(formula, '/'))
            value /= read_power(formula);
        else
            break;
    }
    return value;
}

// To the left: 1-2-3 is -4.
static double read_sum(Formula *formula)
{
    if (++formula->depth > DEPTH_MAX) return refuse(formula, "a formula of fewer brackets");
    double value = read_product(formula);
    while (error_is_clean(formula->err)) {
        if (take(formula, '+'))
            value += read_product(formula);
        else if (take(formula, '-'))
            value -= read_product(formula);
        else
            break;
    }
    formula->depth--;
    return value;
}

bool formula_value(const char *text, FormulaLookUp look_up, const void *context, double *value,
                   Error *err)
{
    Formula formula = {.at = text, .look_up = look_up, .context = context, .err = err};
    *value = read_sum(&formula);
    if (error_is_clean(err) && next_of(&formula)) refuse(&formula, "an operator");
    if (error_is_clean(err) && !isfinite(*value))
        FAIL(err, ERROR_INPUT, "the value of the formula is not finite");
cleanup:
    return error_is_clean(err);
}
