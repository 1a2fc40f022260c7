// SPDX-License-Identifier: GPL-2.0-or-later
// Reading: one function a rule of the grammar in formula.h, each adds its steps behind those of its
// parts. Evaluating: steps take numbers off a stack and put one on it, each with its derivative
// (forward differentiation: Griewank and Walther, Evaluating Derivatives, 2008, ch. 3).
#include "base/formula.h"

#include "base/text.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

enum { NAME_SIZE = 96, DEPTH_MAX = 50, MANY = -1 };

// Functions. X(symbol of the step, name in a formula, arguments)
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
        formula->step[formula->count++] = (FormulaStep){(int32_t)operation, number};
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

// A variable, a number that has a name, or a function with its bracket.
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
    int32_t variable = names->variable && strcmp(name, names->variable) == 0 ? 0 : -1;
    for (int32_t k = 0; k < names->more_count && variable < 0; k++)
        if (strcmp(name, names->more[k]) == 0) variable = k + 1;
    if (variable >= 0)
        add(reading, STEP_VARIABLE, variable);
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

// Powers are read to the right: 2^3^2 is 2^9; and -2^2 is -4, as in mathematics.
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

// Sums are read to the left: 1-2-3 is -4.
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
    formula->count = 0;
    return formula_append(text, names, formula, err);
}

bool formula_append(const char *text, const FormulaNames *names, Formula *formula, Error *err)
{
    Reading reading = {.at = text, .names = names, .formula = formula, .err = err};
    read_sum(&reading);
    if (error_is_clean(err) && next_of(&reading))
        refuse(&reading, isalpha((unsigned char)next_of(&reading))
                             ? "an operator (numbers in a formula have no unit: SI base units)"
                             : "an operator");
    return error_is_clean(err);
}

bool formula_has(const Formula *formula, int32_t variable)
{
    for (int32_t k = 0; k < formula->count; k++)
        if (formula->step[k].operation == STEP_VARIABLE && formula->step[k].number == variable)
            return true;
    return false;
}

// --- evaluating ---------------------------------------------------------------------------------

// Result of an operation on a and b, and its derivatives by them.
typedef struct Applied {
    double value, by_a, by_b;
} Applied;

// factor * slope; 0 for what does not depend on the variable, also where the factor is infinite.
static double chain(double factor, double slope)
{
    return slope == 0 ? 0 : factor * slope;
}

// b: of a function of one argument not used.
static Applied apply(Operation operation, double a, double b)
{
    double value;
    switch (operation) {
    case STEP_SQRT:
        value = sqrt(a);
        return (Applied){value, 0.5 / value, 0};
    case STEP_EXP:
        value = exp(a);
        return (Applied){value, value, 0};
    case STEP_LOG:
        return (Applied){log(a), 1 / a, 0};
    case STEP_TANH:
        value = tanh(a);
        return (Applied){value, 1 - value * value, 0};
    case STEP_ASINH:
        return (Applied){asinh(a), 1 / hypot(1, a), 0};
    case STEP_ABS:
        return (Applied){fabs(a), a < 0 ? -1 : 1, 0};
    case STEP_ROUND:
        return (Applied){round(a), 0, 0};
    case STEP_NEGATE:
        return (Applied){-a, -1, 0};
    case STEP_ADD:
        return (Applied){a + b, 1, 1};
    case STEP_SUBTRACT:
        return (Applied){a - b, 1, -1};
    case STEP_MULTIPLY:
        return (Applied){a * b, b, a};
    case STEP_DIVIDE:
        return (Applied){a / b, 1 / b, -(a / (b * b))};
    case STEP_POWER:
        value = pow(a, b);
        return (Applied){value, b * pow(a, b - 1), value * log(a)};
    case STEP_MIN:
    case STEP_MAX:
    case STEP_POINTS:
    case STEP_NUMBER:
    case STEP_VARIABLE:
        break;
    }
    return (Applied){a, 1, 0};
}

// Off the stack, for the one that it puts there.
static bool takes_two(Operation operation)
{
    if (operation < STEP_FUNCTIONS) return functions[operation].arguments == 2;
    return operation >= STEP_ADD;
}

// Numbers on the stack, with their derivatives by the variables; of one that does not vary `slope`
// means nothing.
typedef struct Entry {
    bool varies;
    double value, slope[FORMULA_VARIABLES_MAX];
} Entry;

// The result takes the place of a. b is NULL for a function of one argument.
static inline void put(Applied applied, int32_t count, Entry *a, const Entry *b)
{
    bool too = b && b->varies;
    a->value = applied.value;
    for (int32_t k = 0; k < count && (a->varies || too); k++) {
        a->slope[k] = a->varies ? chain(applied.by_a, a->slope[k]) : 0;
        if (too) a->slope[k] += chain(applied.by_b, b->slope[k]);
    }
    a->varies = a->varies || too;
}

// The line through the points [x, y, ...] [count], behind x on the stack, next to x. The same x
// twice is a jump, where the first of its values holds. NaN where they descend.
static Applied along_points(const Entry *stack, int32_t count)
{
    const Entry *point = stack + 1;
    double x = stack->value;
    for (int32_t k = 2; k < count; k += 2)
        if (!(point[k].value >= point[k - 2].value)) return (Applied){NAN, NAN, 0};
    if (x <= point[0].value) return (Applied){point[1].value, 0, 0};
    for (int32_t k = 2; k < count; k += 2) {
        if (x > point[k].value) continue;
        double width = point[k].value - point[k - 2].value;
        double slope = (point[k + 1].value - point[k - 1].value) / width;
        return (Applied){point[k - 1].value + slope * (x - point[k - 2].value), slope, 0};
    }
    return (Applied){point[count - 1].value, 0, 0};
}

// Each step but a number and a variable takes one or two off the stack for the one that it puts
// there, so the stack is never higher than there are steps.
double formula_partials(const Formula *formula, const int32_t part[2], const double *x,
                        int32_t count, double *slope)
{
    Entry stack[FORMULA_STEPS_MAX];
    int32_t top = -1;
    for (int32_t k = part[0]; k < part[1]; k++) {
        Operation operation = (Operation)formula->step[k].operation;
        double number = formula->step[k].number;
        if (operation == STEP_NUMBER || operation == STEP_VARIABLE) {
            Entry *entry = &stack[++top];
            entry->varies = operation == STEP_VARIABLE;
            entry->value = entry->varies ? x[(int32_t)number] : number;
            for (int32_t j = 0; j < count && entry->varies; j++)
                entry->slope[j] = j == (int32_t)number;
        } else if (operation == STEP_POINTS) {
            int32_t points = (int32_t)number - 1;
            top -= points;
            put(along_points(&stack[top], points), count, &stack[top], NULL);
        } else if (operation == STEP_MIN || operation == STEP_MAX) {
            Entry *a = &stack[--top], *b = a + 1;
            if (operation == STEP_MIN ? b->value < a->value : b->value > a->value) *a = *b;
        } else {
            Entry *last = &stack[top];
            bool two = takes_two(operation);
            if (two) top--;
            put(apply(operation, stack[top].value, last->value), count, &stack[top],
                two ? last : NULL);
        }
    }
    for (int32_t k = 0; k < count; k++) slope[k] = stack[top].varies ? stack[top].slope[k] : 0;
    return stack[top].value;
}

double formula_at(const Formula *formula, double x, double *slope)
{
    return formula_partials(formula, (const int32_t[]){0, formula->count}, &x, 1, slope);
}

bool formula_value(const char *text, FormulaLookUp look_up, const void *context, double *value,
                   Error *err)
{
    Formula formula;
    FormulaNames names = {
        .look_up = look_up, .context = context, .unknown = "is no number that the scene has"};
    double slope;
    if (!formula_read(text, &names, &formula, err)) return false;
    *value = formula_at(&formula, 0, &slope);
    if (!isfinite(*value)) return REFUSE(err, "the value of the formula is not finite");
    return true;
}
