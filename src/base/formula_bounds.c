// SPDX-License-Identifier: GPL-2.0-or-later
// Interval arithmetic (Moore, Kearfott and Cloud, Introduction to Interval Analysis, 2009, ch. 5),
// without rounding outwards.
#include "base/formula.h"
#include "base/formula_steps.h"

#include <math.h>

typedef struct Range {
    double low, high;
} Range;

static const Range ANYTHING = {-INFINITY, INFINITY};

// Range of a quantity that rises or falls all the way from a to b.
static Range between(double a, double b)
{
    return isnan(a) || isnan(b) ? ANYTHING : (Range){fmin(a, b), fmax(a, b)};
}

// 0 times infinity is 0: what is 0 stays so.
static double times(double a, double b)
{
    return a == 0 || b == 0 ? 0 : a * b;
}

static Range product(Range a, Range b)
{
    Range one = between(times(a.low, b.low), times(a.high, b.high));
    Range other = between(times(a.low, b.high), times(a.high, b.low));
    return (Range){fmin(one.low, other.low), fmax(one.high, other.high)};
}

static bool has_zero(Range a)
{
    return a.low <= 0 && a.high >= 0;
}

static Range power_range(Range a, Range b)
{
    bool whole = b.low == b.high && b.low == rint(b.low);
    if (whole && b.low == 0) return (Range){1, 1};
    if (whole && (b.low > 0 || !has_zero(a))) {
        Range ends = between(pow(a.low, b.low), pow(a.high, b.low));
        bool even = fmod(b.low, 2) == 0;
        return even && has_zero(a) ? (Range){0, ends.high} : ends;
    }
    if (b.low == b.high && (a.low > 0 || (a.low == 0 && b.low > 0)))
        return between(pow(a.low, b.low), pow(a.high, b.low));
    if (!(a.low > 0)) return ANYTHING;
    Range exponent = product(b, (Range){log(a.low), log(a.high)});
    return between(exp(exponent.low), exp(exponent.high));
}

// From a to b on a line through (x[0], y[0]) and (x[1], y[1]), which may be a jump.
static void widen(Range *range, const double x[2], const double y[2], Range within)
{
    double a = fmax(within.low, x[0]), b = fmin(within.high, x[1]), width = x[1] - x[0];
    if (a > b) return;
    double from = width > 0 ? (a - x[0]) / width : 0, to = width > 0 ? (b - x[0]) / width : 1;
    Range piece = between(y[0] + from * (y[1] - y[0]), y[0] + to * (y[1] - y[0]));
    *range = (Range){fmin(range->low, piece.low), fmax(range->high, piece.high)};
}

// Range of the lines through points that do not vary, level before the first point and behind the
// last.
static Range points_range(Range x, const Range *point, int32_t count)
{
    Range range = {INFINITY, -INFINITY};
    for (int32_t k = 0; k < count; k++)
        if (!(point[k].low == point[k].high)) return ANYTHING;
    for (int32_t k = 0; k <= count; k += 2) {
        const Range *before = &point[k > 0 ? k - 2 : 0], *next = &point[k < count ? k : k - 2];
        const double place[2] = {k > 0 ? before->low : -INFINITY, k < count ? next->low : INFINITY};
        const double value[2] = {before[1].low, next[1].low};
        if (!(place[0] <= place[1])) return ANYTHING;
        if (k > 0 && k < count)
            widen(&range, place, value, x);
        else if (x.low <= place[1] && x.high >= place[0])
            range = (Range){fmin(range.low, value[0]), fmax(range.high, value[0])};
    }
    return range;
}

// b: of a function of one argument not used.
static Range apply_range(Operation operation, Range a, Range b)
{
    switch (operation) {
    case STEP_SQRT:
        return a.low >= 0 ? (Range){sqrt(a.low), sqrt(a.high)} : ANYTHING;
    case STEP_EXP:
        return (Range){exp(a.low), exp(a.high)};
    case STEP_LOG:
        return a.low >= 0 ? (Range){log(a.low), log(a.high)} : ANYTHING;
    case STEP_TANH:
        return (Range){tanh(a.low), tanh(a.high)};
    case STEP_ASINH:
        return (Range){asinh(a.low), asinh(a.high)};
    case STEP_ABS:
        return (Range){has_zero(a) ? 0 : fmin(fabs(a.low), fabs(a.high)),
                       fmax(fabs(a.low), fabs(a.high))};
    case STEP_ROUND:
        return (Range){round(a.low), round(a.high)};
    case STEP_MIN:
        return (Range){fmin(a.low, b.low), fmin(a.high, b.high)};
    case STEP_MAX:
        return (Range){fmax(a.low, b.low), fmax(a.high, b.high)};
    case STEP_NEGATE:
        return (Range){-a.high, -a.low};
    case STEP_ADD:
        return (Range){a.low + b.low, a.high + b.high};
    case STEP_SUBTRACT:
        return (Range){a.low - b.high, a.high - b.low};
    case STEP_MULTIPLY:
        return product(a, b);
    case STEP_DIVIDE:
        return has_zero(b) ? ANYTHING : product(a, (Range){1 / b.high, 1 / b.low});
    case STEP_POWER:
        return power_range(a, b);
    case STEP_POINTS:
    case STEP_NUMBER:
    case STEP_VARIABLE:
        break;
    }
    return a;
}

// The same walk over the stack as formula_at.
void formula_bounds(const Formula *formula, const double x[2], double bounds[2])
{
    Range stack[FORMULA_STEPS_MAX];
    int32_t top = -1;
    for (int32_t k = 0; k < formula->count; k++) {
        Operation operation = (Operation)formula->step[k].operation;
        double number = formula->step[k].number;
        if (operation == STEP_NUMBER) {
            stack[++top] = (Range){number, number};
        } else if (operation == STEP_VARIABLE) {
            stack[++top] = (Range){x[0], x[1]};
        } else if (operation == STEP_POINTS) {
            int32_t count = (int32_t)number;
            top -= count - 1;
            stack[top] = points_range(stack[top], &stack[top + 1], count - 1);
        } else {
            Range last = stack[top];
            if (formula_takes_two(operation)) top--;
            stack[top] = apply_range(operation, stack[top], last);
        }
        if (!(stack[top].low < INFINITY && stack[top].high > -INFINITY)) stack[top] = ANYTHING;
    }
    bounds[0] = stack[top].low;
    bounds[1] = stack[top].high;
}
