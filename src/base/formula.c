// SPDX-License-Identifier: GPL-2.0-or-later
// Reading: one function a rule of the grammar in formula.h, each adds its steps behind those of its
// parts. Evaluating: steps take numbers off a stack and put one on it, each with its derivative
// (forward differentiation: Griewank and Walther, Evaluating Derivatives, 2008, ch. 3).
#include "base/formula.h"

#include "base/formula_steps.h"
#include "base/text.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

enum { NAME_SIZE = 96, DEPTH_MAX = 50 };

static const struct {
    const char *name;
    int32_t arguments;
} functions[] = {
#define X(symbol, name, arguments) [symbol] = {name, arguments},
    FUNCTIONS(X)
#undef X
};

// --- reading ------------------------------------------------------------------------------------

typedef struct Reading {
    const char *at;   // not read yet
    const FormulaNames *names;
    Formula *formula;
    int32_t depth;   // of brackets
    Error *err;
} Reading;

static void read_sum(Reading *reading);

// The next character that is no blank, where reading goes on.
static char next_of(Reading *reading)
{
    reading->at += strspn(reading->at, " \t");
    return *reading->at;
}

static bool take(Reading *reading, char wanted)
{
    if (next_of(reading) != wanted) return false;
    reading->at++;
    return true;
}

// Says what is wanted at this place. The first fault counts.
static void refuse(Reading *reading, const char *wanted)
{
    if (next_of(reading))
        error_set(reading->err, ERROR_INPUT, __FILE__, __LINE__,
                  "`%.40s`: expected %s in its place", reading->at, wanted);
    else
        error_set(reading->err, ERROR_INPUT, __FILE__, __LINE__,
                  "the formula ends where %s is wanted", wanted);
}

static void add(Reading *reading, Operation operation, double number)
{
    Formula *formula = reading->formula;
    if (formula->count == FORMULA_STEPS_MAX)
        refuse(reading, "the end of a shorter formula");
    else
        formula->step[formula->count++] = (FormulaStep){operation, number};
}

static void close_bracket(Reading *reading)
{
    if (error_is_clean(reading->err) && !take(reading, ')')) refuse(reading, "a closing bracket");
}

// min and max take their arguments two at a time: min(a, b, c) is min(min(a, b), c).
static void read_function(Reading *reading, int32_t function)
{
    int32_t wanted = functions[function].arguments, count = 1;
    read_sum(reading);
    if (wanted == 2 && next_of(reading) != ',') refuse(reading, "a comma");
    while (wanted != 1 && error_is_clean(reading->err) && take(reading, ',')) {
        read_sum(reading);
        count++;
        if (wanted == 2) add(reading, (Operation)function, 0);
    }
    if (wanted == MANY && (count < 5 || count % 2 == 0) && error_is_clean(reading->err))
        refuse(reading, "x and two points or more, each of two numbers,");
    close_bracket(reading);
    if (wanted != 2) add(reading, (Operation)function, count);
}

// The variable, a number that has a name, or a function with its bracket.
static void read_name(Reading *reading)
{
    char name[NAME_SIZE] = "";
    int32_t length = 0;
    const char *at = reading->at;
    while (isalnum((unsigned char)at[length]) || at[length] == '.' || at[length] == '_') length++;
    if (length >= NAME_SIZE) {
        refuse(reading, "a shorter name");
        return;
    }
    memcpy(name, at, (size_t)length);
    reading->at += length;
    for (int32_t k = 0; k < STEP_FUNCTIONS; k++) {
        if (strcmp(name, functions[k].name) != 0 || !take(reading, '(')) continue;
        read_function(reading, k);
        return;
    }
    double value = NAN;
    const FormulaNames *names = reading->names;
    if (names->variable && strcmp(name, names->variable) == 0)
        add(reading, STEP_VARIABLE, 0);
    else if (names->look_up(names->context, name, &value))
        add(reading, STEP_NUMBER, value);
    else
        error_set(reading->err, ERROR_INPUT, __FILE__, __LINE__, "`%s` %s", name, names->unknown);
}

// depth bounds the recursion: a text of a thousand brackets must not overflow the stack.
static void read_unit(Reading *reading)
{
    char next = next_of(reading);
    if (isdigit((unsigned char)next) || next == '.') {
        double value = 0;
        int32_t length = text_number(reading->at, &value);
        if (length == 0) refuse(reading, "a decimal number");
        reading->at += length;
        add(reading, STEP_NUMBER, value);
    } else if (isalpha((unsigned char)next)) {
        read_name(reading);
    } else if (take(reading, '(')) {
        reading->depth++;
        read_sum(reading);
        close_bracket(reading);
        reading->depth--;
    } else {
        refuse(reading, "a number, a name or a bracket");
    }
}

// To the right: 2^3^2 is 2^9; and -2^2 is -4, as in mathematics.
static void read_power(Reading *reading)
{
    if (++reading->depth > DEPTH_MAX) {
        refuse(reading, "a formula of fewer signs and powers");
    } else if (take(reading, '-')) {
        read_power(reading);
        add(reading, STEP_NEGATE, 0);
    } else {
        read_unit(reading);
        if (error_is_clean(reading->err) && take(reading, '^')) {
            read_power(reading);
            add(reading, STEP_POWER, 0);
        }
    }
    reading->depth--;
}

static void read_product(Reading *reading)
{
    read_power(reading);
    while (error_is_clean(reading->err)) {
        bool times = take(reading, '*');
        if (!times && !take(reading, '/')) break;
        read_power(reading);
        add(reading, times ? STEP_MULTIPLY : STEP_DIVIDE, 0);
    }
}

// To the left: 1-2-3 is -4.
static void read_sum(Reading *reading)
{
    if (++reading->depth > DEPTH_MAX) refuse(reading, "a formula of fewer brackets");
    if (error_is_clean(reading->err)) read_product(reading);
    while (error_is_clean(reading->err)) {
        bool plus = take(reading, '+');
        if (!plus && !take(reading, '-')) break;
        read_product(reading);
        add(reading, plus ? STEP_ADD : STEP_SUBTRACT, 0);
    }
    reading->depth--;
}

bool formula_read(const char *text, const FormulaNames *names, Formula *formula, Error *err)
{
    Reading reading = {.at = text, .names = names, .formula = formula, .err = err};
    formula->count = 0;
    read_sum(&reading);
    if (error_is_clean(err) && next_of(&reading)) refuse(&reading, "an operator");
    return error_is_clean(err);
}

// --- evaluating ---------------------------------------------------------------------------------

// A number and its derivative by the variable.
typedef struct Dual {
    double value, slope;
} Dual;

// factor * slope; 0 for what does not depend on the variable, also where the factor is infinite.
static double chain(double factor, double slope)
{
    return slope == 0 ? 0 : factor * slope;
}

static Dual power(Dual a, Dual b)
{
    double value = pow(a.value, b.value);
    double by_base = chain(b.value * pow(a.value, b.value - 1), a.slope);
    return (Dual){value, by_base + chain(value * log(a.value), b.slope)};
}

// The line through the points [x, y, ...] [count] next to x. The same x twice is a jump, where the
// first of its values holds. NaN where they descend.
static Dual along_points(Dual x, const Dual *point, int32_t count)
{
    for (int32_t k = 2; k < count; k += 2)
        if (!(point[k].value >= point[k - 2].value)) return (Dual){NAN, NAN};
    if (x.value <= point[0].value) return (Dual){point[1].value, 0};
    for (int32_t k = 2; k < count; k += 2) {
        if (x.value > point[k].value) continue;
        double width = point[k].value - point[k - 2].value;
        double slope = (point[k + 1].value - point[k - 1].value) / width;
        return (Dual){point[k - 1].value + slope * (x.value - point[k - 2].value), slope * x.slope};
    }
    return (Dual){point[count - 1].value, 0};
}

// b: of a function of one argument not used.
static Dual apply(Operation operation, Dual a, Dual b)
{
    double root;
    switch (operation) {
    case STEP_SQRT:
        root = sqrt(a.value);
        return (Dual){root, chain(0.5 / root, a.slope)};
    case STEP_EXP:
        return (Dual){exp(a.value), chain(exp(a.value), a.slope)};
    case STEP_LOG:
        return (Dual){log(a.value), chain(1 / a.value, a.slope)};
    case STEP_TANH:
        root = tanh(a.value);
        return (Dual){root, chain(1 - root * root, a.slope)};
    case STEP_ABS:
        return (Dual){fabs(a.value), a.value < 0 ? -a.slope : a.slope};
    case STEP_ROUND:
        return (Dual){round(a.value), 0};
    case STEP_MIN:
        return b.value < a.value ? b : a;
    case STEP_MAX:
        return b.value > a.value ? b : a;
    case STEP_NEGATE:
        return (Dual){-a.value, -a.slope};
    case STEP_ADD:
        return (Dual){a.value + b.value, a.slope + b.slope};
    case STEP_SUBTRACT:
        return (Dual){a.value - b.value, a.slope - b.slope};
    case STEP_MULTIPLY:
        return (Dual){a.value * b.value, chain(b.value, a.slope) + chain(a.value, b.slope)};
    case STEP_DIVIDE:
        return (Dual){a.value / b.value,
                      chain(1 / b.value, a.slope) - chain(a.value / (b.value * b.value), b.slope)};
    case STEP_POWER:
        return power(a, b);
    case STEP_POINTS:
    case STEP_NUMBER:
    case STEP_VARIABLE:
        break;
    }
    return a;
}

bool formula_takes_two(Operation operation)
{
    if (operation < STEP_FUNCTIONS) return functions[operation].arguments == 2;
    return operation >= STEP_ADD;
}

// Each step but a number and the variable takes one or two off the stack for the one that it puts
// there, so the stack is never higher than there are steps.
double formula_at(const Formula *formula, double x, double *slope)
{
    Dual stack[FORMULA_STEPS_MAX];
    int32_t top = -1;
    for (int32_t k = 0; k < formula->count; k++) {
        Operation operation = (Operation)formula->step[k].operation;
        if (operation == STEP_NUMBER) {
            stack[++top] = (Dual){formula->step[k].number, 0};
        } else if (operation == STEP_VARIABLE) {
            stack[++top] = (Dual){x, 1};
        } else if (operation == STEP_POINTS) {
            int32_t count = (int32_t)formula->step[k].number;
            top -= count - 1;
            stack[top] = along_points(stack[top], &stack[top + 1], count - 1);
        } else {
            Dual last = stack[top];
            if (formula_takes_two(operation)) top--;
            stack[top] = apply(operation, stack[top], last);
        }
    }
    *slope = stack[top].slope;
    return stack[top].value;
}

bool formula_value(const char *text, FormulaLookUp look_up, const void *context, double *value,
                   Error *err)
{
    Formula formula;
    FormulaNames names = {look_up, context, NULL, "is no number that the scene has"};
    double slope;
    TRY(formula_read(text, &names, &formula, err));
    *value = formula_at(&formula, 0, &slope);
    if (!isfinite(*value)) FAIL(err, ERROR_INPUT, "the value of the formula is not finite");
cleanup:
    return error_is_clean(err);
}
