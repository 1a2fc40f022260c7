// SPDX-License-Identifier: GPL-2.0-or-later
// The header has the laws, each a row of two functions here; what follows after them is the same
// for all. tests/unit/friction/test_friction_memory.c compares derivatives with differences and
// states with their equation.
#include "friction/friction_memory.h"

#include "algebra/dense.h"

#include <math.h>
#include <string.h>

static const double EXPONENT_MAX = 690;   // exp of it is finite
// ln of it is finite: at rest the slip law keeps its state.
static const double LEAST_SPEED = 1e-300;

// --- the laws -----------------------------------------------------------------------------------

// Where a step that is too long would leave theta below 0 the law is that of a fresh contact; such
// a step's error is large, and it is taken shorter (stepping/sdirk).
static void ageing_mu(const FrictionMemory *memory, double speed, const double *state,
                      FrictionRates *rates)
{
    double drop = memory->mu_static - memory->mu_kinetic, base = memory->mu_kinetic, slope = 0;
    bool weakens = speed<memory->critical_velocity, aged = *state> 0;
    if (weakens) {
        base = memory->mu_static - drop * speed / memory->critical_velocity;
        slope = -drop / memory->critical_velocity;
    }
    double strength = aged ? 1 + memory->healing * log1p(*state / memory->healing_time) : 1;
    double gain = aged ? memory->healing / (memory->healing_time + *state) : 0;
    rates->mu = base * strength;
    rates->mu_speed = slope * strength;
    rates->mu_state[0] = base * gain;
}

static void ageing_rate(const FrictionMemory *memory, double speed, const double *state,
                        FrictionRates *rates)
{
    rates->rate[0] = 1 - speed * *state / memory->slip_distance;
    rates->rate_speed[0] = -*state / memory->slip_distance;
    rates->rate_state[0][0] = -speed / memory->slip_distance;
}

static void weakening_mu(const FrictionMemory *memory, double speed, const double *state,
                         FrictionRates *rates)
{
    (void)speed;
    double drop = memory->mu_static - memory->mu_kinetic;
    rates->mu = memory->mu_kinetic + drop * fmax(*state, 0);
    rates->mu_speed = 0;
    rates->mu_state[0] = *state > 0 ? drop : 0;
}

static void weakening_rate(const FrictionMemory *memory, double speed, const double *state,
                           FrictionRates *rates)
{
    double heals = 1 / memory->healing_time, slips = 1 / memory->slip_distance;
    rates->rate[0] = (1 - *state) * heals - speed * *state * slips;
    rates->rate_speed[0] = -*state * slips;
    rates->rate_state[0][0] = -heals - speed * slips;
}

// mu = a asinh(v/v_s), v_s = 2 V_0 exp(-(f_0 + b psi)/a).
static void rate_state_mu(const FrictionMemory *memory, double speed, const double *state,
                          FrictionRates *rates)
{
    double exponent = (memory->reference + memory->healing * *state) / memory->direct;
    double scale = 2 * memory->reference_velocity *
                   exp(-fmin(fmax(exponent, -EXPONENT_MAX), EXPONENT_MAX));
    double root = hypot(speed, scale);
    rates->mu = memory->direct * asinh(speed / scale);
    rates->mu_speed = memory->direct / root;
    rates->mu_state[0] = memory->healing * (speed / root);
}

static void rate_state_rate(const FrictionMemory *memory, double speed, const double *state,
                            FrictionRates *rates)
{
    double slips = 1 / memory->slip_distance;
    if (memory->slip_law) {
        double off = *state +
                     log(fmax(speed, LEAST_SPEED) / memory->reference_velocity);   // ln(v theta/
        // D_c)
        rates->rate[0] = -speed * slips * off;
        rates->rate_speed[0] = -slips * (off + 1);
        rates->rate_state[0][0] = -speed * slips;
    } else {
        double heals = memory->reference_velocity * slips * exp(fmin(-*state, EXPONENT_MAX));
        rates->rate[0] = heals - speed * slips;
        rates->rate_speed[0] = -slips;
        rates->rate_state[0][0] = -heals;
    }
}

// The formula's arguments are v, the states and p, in this order. slope: the derivatives by the
// first [wanted] of them; none: the value alone.
static double formula_of(const FrictionMemory *memory, int32_t k, double speed, const double *state,
                         int32_t wanted, double *slope)
{
    double x[FORMULA_VARIABLES_MAX] = {speed};
    memcpy(x + 1, state, (size_t)memory->states * sizeof(double));
    x[1 + memory->states] = memory->pressure;
    return formula_partials(&memory->formula, memory->ends + k, x, wanted, slope);
}

static void formula_mu(const FrictionMemory *memory, double speed, const double *state,
                       FrictionRates *rates)
{
    double slope[FORMULA_VARIABLES_MAX];
    int32_t n = memory->states;
    rates->mu = formula_of(memory, 0, speed, state, 1 + n + memory->feels_pressure, slope);
    rates->mu_speed = slope[0];
    if (memory->feels_pressure) rates->mu_pressure = slope[1 + n];
    memcpy(rates->mu_state, slope + 1, (size_t)n * sizeof(double));
}

static void formula_rate(const FrictionMemory *memory, double speed, const double *state,
                         FrictionRates *rates)
{
    double slope[FORMULA_VARIABLES_MAX];
    int32_t n = memory->states;
    for (int32_t k = 0; k < n; k++) {
        rates->rate[k] = formula_of(memory, k + 1, speed, state, 1 + n, slope);
        rates->rate_speed[k] = slope[0];
        memcpy(rates->rate_state[k], slope + 1, (size_t)n * sizeof(double));
    }
}

static void plugin_rates(const FrictionMemory *memory, double speed, const double *state,
                         FrictionRates *rates)
{
    memory->plugin.rates(&memory->plugin.given, speed, memory->pressure, state, rates);
}

typedef void MemoryPart(const FrictionMemory *memory, double speed, const double *state,
                        FrictionRates *rates);

static MemoryPart paced_mu, paced_rate;

// mu and g, each with its derivatives; one function: it fills both. straight: g is linear in the
// state.
static const struct {
    MemoryPart *mu, *rate;
    bool straight;
} LAWS[] = {[MEMORY_AGEING] = {ageing_mu, ageing_rate, true},
            [MEMORY_SLIP_WEAKENING] = {weakening_mu, weakening_rate, true},
            [MEMORY_RATE_STATE] = {rate_state_mu, rate_state_rate, false},
            [MEMORY_FORMULAS] = {formula_mu, formula_rate, false},
            [MEMORY_PLUGIN] = {plugin_rates, plugin_rates, false},
            [MEMORY_PACED] = {paced_mu, paced_rate, false}};

static void paced_mu(const FrictionMemory *memory, double speed, const double *state,
                     FrictionRates *rates)
{
    FrictionRates own = {.mu_pressure = 0};
    LAWS[memory->paced].mu(memory, speed / memory->mu_pace, state, &own);
    rates->mu = own.mu;
    rates->mu_speed = own.mu_speed / memory->mu_pace;
    rates->mu_pressure = own.mu_pressure;
    memcpy(rates->mu_state, own.mu_state, (size_t)memory->states * sizeof(double));
}

static void paced_rate(const FrictionMemory *memory, double speed, const double *state,
                       FrictionRates *rates)
{
    FrictionRates own;
    LAWS[memory->paced].rate(memory, speed / memory->pace, state, &own);
    for (int32_t k = 0; k < memory->states; k++) {
        rates->rate[k] = memory->pace * own.rate[k];
        rates->rate_speed[k] = own.rate_speed[k];
        for (int32_t j = 0; j < memory->states; j++)
            rates->rate_state[k][j] = memory->pace * own.rate_state[k][j];
    }
}

static void find_mu(const FrictionMemory *memory, double speed, const double *state,
                    FrictionRates *rates)
{
    double factor = memory->factor;
    rates->mu_pressure = 0;
    LAWS[memory->kind].mu(memory, speed, state, rates);
    rates->mu *= factor;
    rates->mu_speed *= factor;
    rates->mu_pressure *= factor;
    for (int32_t k = 0; k < memory->states; k++) rates->mu_state[k] *= factor;
}

void memory_rates(const FrictionMemory *memory, double speed, const double *state,
                  FrictionRates *rates)
{
    rates->states = memory->states;
    if (LAWS[memory->kind].rate != LAWS[memory->kind].mu)
        LAWS[memory->kind].rate(memory, speed, state, rates);
    find_mu(memory, speed, state, rates);
}

// --- a stage ------------------------------------------------------------------------------------

// Such a function is compiled a second time for the single state that most laws have (n = 1).
#define INLINED static inline __attribute__((always_inline))

// x becomes (1 - reach g_theta)^-1 x. false: singular.
INLINED bool solve_states(const FrictionRates *rates, double reach, int32_t n, double *x)
{
    double matrix[STATES_MAX * STATES_MAX];
    int32_t pivots[STATES_MAX];
    if (n == 1) {
        x[0] /= 1 - reach * rates->rate_state[0][0];
        return true;
    }
    for (int32_t b = 0; b < n; b++)
        for (int32_t a = 0; a < n; a++)
            matrix[b * n + a] = (a == b) - reach * rates->rate_state[a][b];
    if (!dense_lu(matrix, n, pivots)) return false;
    dense_lu_solve(matrix, n, pivots, x);
    return true;
}

// A stage's equation on its way: by how much each state is off, and in which size that is measured.
typedef struct Elimination {
    const FrictionMemory *memory;
    double speed;
    double off[STATES_MAX], scale[STATES_MAX];
    FrictionRates rates;
} Elimination;

// Fills what each state is off, state - from - reach g.
INLINED void find_off(Elimination *at, int32_t n, const double *state)
{
    const FrictionMemory *memory = at->memory;
    LAWS[memory->kind].rate(memory, at->speed, state, &at->rates);
    for (int32_t k = 0; k < n; k++)
        at->off[k] = state[k] - memory->from[k] - memory->reach * at->rates.rate[k];
}

// The largest of them; NaN where one is.
INLINED double largest_off(const Elimination *at, int32_t n)
{
    double largest = 0;
    for (int32_t k = 0; k < n; k++) {
        double part = fabs(at->off[k]);
        if (part != 0 && !(part <= largest * at->scale[k])) largest = part / at->scale[k];
    }
    return largest;
}

static const double NEAR = 1e-9;   // of a state: what is left after such a step of Newton's method
    // is its square
static const double ROUNDING =
    1e-14;   // of what slip alone would do to a state: such a step is noise

INLINED bool is_near(const Elimination *at, int32_t n, const double *state, const double *step)
{
    const FrictionMemory *memory = at->memory;
    for (int32_t k = 0; k < n; k++) {
        double size = fabs(step[k]), slips = memory->reach * at->rates.rate_speed[k] * at->speed;
        if (size <= NEAR * (fabs(state[k]) + fabs(memory->from[k]))) continue;
        double yields = 1 + memory->reach * fabs(at->rates.rate_state[k][k]);
        if (!(size * yields <= ROUNDING * fabs(slips))) return false;
    }
    return true;
}

// One step of Newton's method, halved while it leaves more than there was; `step` comes in whole.
// false: it cannot leave less.
INLINED bool take_step(Elimination *at, int32_t n, const double *step, double *left, double *state)
{
    enum { HALVINGS = 60 };
    double from[STATES_MAX], before = *left, part = 1;
    for (int32_t k = 0; k < n; k++) from[k] = state[k];
    for (int32_t halved = 0; halved < HALVINGS; halved++, part *= 0.5) {
        for (int32_t k = 0; k < n; k++) state[k] = from[k] - part * step[k];
        find_off(at, n, state);
        *left = largest_off(at, n);
        if (*left < before) return true;
    }
    return false;
}

// Newton's method from `from`.
INLINED void eliminate(const FrictionMemory *memory, double speed, int32_t n, double *state)
{
    enum { STEPS = 60 };
    Elimination at;
    double step[STATES_MAX];
    for (int32_t k = 0; k < n; k++) state[k] = memory->from[k];
    if (memory->reach == 0) return;
    at.memory = memory;
    at.speed = speed;
    at.rates.states = n;
    find_off(&at, n, state);
    for (int32_t k = 0; k < n; k++) at.scale[k] = fabs(state[k]) + fabs(at.off[k]);
    double left = largest_off(&at, n);
    for (int32_t trial = 0; trial < STEPS && left != 0; trial++) {
        for (int32_t k = 0; k < n; k++) step[k] = at.off[k];
        if (!solve_states(&at.rates, memory->reach, n, step)) break;
        if (LAWS[memory->kind].straight || is_near(&at, n, state, step)) {
            for (int32_t k = 0; k < n; k++) state[k] -= step[k];
            return;
        }
        if (!take_step(&at, n, step, &left, state)) break;
    }
    for (int32_t k = 0; k < n && left != 0; k++) state[k] = NAN;
}

void memory_state(const FrictionMemory *memory, double speed, double *state)
{
    if (memory->states == 1)
        eliminate(memory, speed, 1, state);
    else
        eliminate(memory, speed, memory->states, state);
}

bool memory_solve_states(const FrictionRates *rates, double reach, double *x)
{
    return solve_states(rates, reach, rates->states, x);
}

double memory_feedback(const FrictionRates *rates, double reach)
{
    double x[STATES_MAX], sum = 0;
    for (int32_t k = 0; k < rates->states; k++) x[k] = reach * rates->rate_speed[k];
    if (!solve_states(rates, reach, rates->states, x)) return NAN;
    for (int32_t k = 0; k < rates->states; k++) sum += rates->mu_state[k] * x[k];
    return sum;
}

double memory_coefficient(const FrictionMemory *memory, double speed, double *slope)
{
    double state[STATES_MAX];
    FrictionRates rates;
    memory_state(memory, speed, state);
    if (!slope && memory->kind == MEMORY_FORMULAS)
        return memory->factor * formula_of(memory, 0, speed, state, 0, NULL);
    if (!slope) {
        find_mu(memory, speed, state, &rates);
        return rates.mu;
    }
    memory_rates(memory, speed, state, &rates);
    *slope = rates.mu_speed + memory_feedback(&rates, memory->reach);
    return rates.mu;
}

// x of sinh(x) = v/v_s for mu = a asinh(v/v_s): mu/(mu_v v) = x/tanh(x). Newton's method from the
// right, where it cannot overshoot.
static double argument_of(double ratio)
{
    enum { STEPS = 30 };
    double x = fmin(ratio, EXPONENT_MAX);
    for (int32_t k = 0; k < STEPS; k++) {
        double t = tanh(x), next = x - (x - ratio * t) / (1 - ratio * (1 - t * t));
        if (!(next < x && next > 0)) break;
        x = next;
    }
    return x;
}

// v_s; INFINITY: friction is as good as linear.
static double creep_scale(const FrictionMemory *memory, double speed)
{
    double state[STATES_MAX];
    FrictionRates rates;
    memory_state(memory, speed, state);
    if (speed == 0) speed = memory->critical_velocity;
    find_mu(memory, speed, state, &rates);
    double ratio = rates.mu / (rates.mu_speed * speed);
    return ratio > 1 ? speed / sinh(argument_of(ratio)) : INFINITY;
}

// y = asinh(|v|/v_s) v/|v| answers to a step along v by 1/hypot(v, v_s), across it by |y|/|v|.
void memory_follow(const FrictionMemory *memory, int32_t count, const double *velocity,
                   const double *step, double *next)
{
    double speed = count == 1 ? fabs(velocity[0]) : hypot(velocity[0], velocity[1]);
    double scale = creep_scale(memory, speed), y[2] = {0}, along = 0;
    double root = hypot(speed, scale), part = asinh(speed / scale);
    for (int32_t c = 0; c < count; c++) {
        next[c] = velocity[c] + step[c];
        if (speed > 0) along += step[c] * (velocity[c] / speed);
    }
    if (!isfinite(scale)) return;
    for (int32_t c = 0; c < count; c++) {
        double d = speed > 0 ? velocity[c] / speed : 0;
        double across = speed > 0 ? (step[c] - along * d) * (part / speed) : step[c] / scale;
        y[c] = part * d + along * d / root + across;
    }
    double size = count == 1 ? fabs(y[0]) : hypot(y[0], y[1]);
    double way = scale * sinh(fmin(size, EXPONENT_MAX));
    for (int32_t c = 0; c < count; c++) next[c] = size > 0 ? way * (y[c] / size) : 0;
}

double memory_rested(const FrictionMemory *memory, double rest)
{
    if (memory->kind == MEMORY_AGEING) return rest;
    if (memory->kind == MEMORY_SLIP_WEAKENING) return -expm1(-rest / memory->healing_time);
    return log(memory->reference_velocity * rest / memory->slip_distance);
}

double memory_steady(const FrictionMemory *memory, double speed)
{
    if (memory->kind == MEMORY_AGEING) return memory->slip_distance / speed;
    if (memory->kind == MEMORY_SLIP_WEAKENING)
        return 1 / (1 + speed * memory->healing_time / memory->slip_distance);
    return log(memory->reference_velocity / speed);
}

double memory_shown(const FrictionMemory *memory, double state)
{
    if (memory->kind != MEMORY_RATE_STATE) return state;
    return memory->slip_distance / memory->reference_velocity * exp(state);
}

double memory_spent_speed(const FrictionMemory *memory)
{
    static const double MANY = 20;   // of D_c that are slipped in the stage
    MemoryKind kind = memory->kind == MEMORY_PACED ? memory->paced : memory->kind;
    bool fades = kind != MEMORY_SLIP_WEAKENING && !memory->creeps;
    double speed = fades ? memory->critical_velocity : 0;
    return memory->reach > 0 ? speed + MANY * memory->slip_distance / memory->reach : speed;
}
