// SPDX-License-Identifier: GPL-2.0-or-later
// The questions that every law answers, by its table of operations. Newton's derivative
// (contact/contact_equations) and the certificate's W (stepping/certificate) need slopes. A node's
// factor multiplies mu_S and mu_K of the built-in laws of speed alone, mu of all others.
#include "friction/friction.h"

#include "algebra/dense.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

// --- laws ---------------------------------------------------------------------------------------

const FrictionOperations *const FRICTION_OPERATIONS[] = {
#define X(symbol, name, operations) [symbol] = &operations,
    FRICTION_LAWS(X)
#undef X
};

static const char *const NAMES[] = {
#define X(symbol, name, operations) name,
    FRICTION_LAWS(X)
#undef X
};

static bool is_known(const FrictionLaw *law)
{
    return (size_t)law->kind < sizeof NAMES / sizeof NAMES[0];
}

const char *friction_law_name(const FrictionLaw *law)
{
    return is_known(law) ? NAMES[law->kind] : "unknown";
}

bool friction_is_own(const FrictionLaw *law)
{
    return is_known(law) && friction_operations(law)->own;
}

bool friction_has_drop(const FrictionLaw *law)
{
    return is_known(law) && friction_operations(law)->has_drop;
}

bool friction_is_convex(const FrictionLaw *law)
{
    return friction_operations(law)->is_convex;
}

double friction_rested(const FrictionLaw *law, double rest)
{
    return friction_operations(law)->rested(law, rest);
}

const char *friction_state_name(const FrictionLaw *law)
{
    const char *name = friction_operations(law)->state_name;
    return name ? name : "theta";
}

const char *friction_state_unit(const FrictionLaw *law)
{
    const char *unit = friction_operations(law)->state_unit;
    return unit ? unit : "time";
}

// --- nodes and contacts -------------------------------------------------------------------------

FrictionNode friction_node(const FrictionLaw *law, double factor)
{
    FrictionNode node = {.law = law, .factor = factor, .pressure = law->pressure};
    memcpy(node.from, law->start, sizeof node.from);
    return node;
}

FrictionNode friction_constant(double mu)
{
    static const FrictionLaw unit = {.kind = FRICTION_COULOMB, .mu_static = 1, .mu_kinetic = 1};
    return friction_node(&unit, mu);
}

Friction friction_everywhere(FrictionNode node)
{
    return (Friction){.whole = node,
                      .mu_static = node.factor * node.law->mu_static,
                      .mu_kinetic = friction_kinetic(&node),
                      .critical_velocity = node.law->critical_velocity,
                      .drop = friction_drop(&node)};
}

// The node with the largest drop stands for all, with the largest mu_S and the least v_c.
Friction friction_of_nodes(FrictionNode *node, int32_t count)
{
    double largest = 0, critical = INFINITY;
    Friction friction = friction_everywhere(node[0]);
    for (int32_t i = 0; i < count; i++) {
        double drop = friction_drop(&node[i]);
        if (drop > friction.drop) friction = friction_everywhere(node[i]);
        largest = fmax(largest, node[i].factor * node[i].law->mu_static);
        if (drop > 0) critical = fmin(critical, node[i].law->critical_velocity);
    }
    bool falls = friction_has_drop(friction.whole.law);
    friction.mu_static = largest;
    friction.mu_kinetic = falls ? largest - friction.drop : largest;
    if (falls && !friction.whole.law->remembers)
        friction.drop = fmax(friction.mu_static - friction.mu_kinetic,
                             friction.whole.factor * friction.whole.law->fall);
    if (isfinite(critical)) friction.critical_velocity = critical;
    friction.node = node;
    return friction;
}

bool friction_remembers(const Friction *friction, int32_t count)
{
    for (int32_t i = 0; friction->node && i < count; i++)
        if (friction->node[i].law->remembers) return true;
    return friction->whole.law->remembers;
}

bool friction_creeps(const Friction *friction, int32_t count)
{
    for (int32_t i = 0; friction->node && i < count; i++)
        if (friction->node[i].law->creeps) return true;
    return friction->whole.law->creeps;
}

int32_t friction_states(const Friction *friction, int32_t count)
{
    int32_t most = friction->whole.law->states;
    for (int32_t i = 0; friction->node && i < count; i++)
        if (friction->node[i].law->states > most) most = friction->node[i].law->states;
    return most;
}

double friction_slip(const Friction *friction, double pressure, double height, double young)
{
    double drop = friction->drop;
    if (drop <= 0) drop = friction->mu_static > 0 ? friction->mu_static : 1;
    return drop * pressure * height / young;
}

// --- mu and the rates of a law that remembers: its factor and its clock are applied here alone ---

static void find_mu(const FrictionNode *node, double speed, const double *state,
                    FrictionRates *rates)
{
    const FrictionLaw *law = node->law;
    double factor = node->factor;
    bool is_paced = node->pace > 0;
    rates->states = law->states;
    rates->mu_pressure = 0;
    friction_operations(law)->mu(law, is_paced ? speed / node->mu_pace : speed, node->pressure,
                                 state, rates);
    if (is_paced) rates->mu_speed /= node->mu_pace;
    rates->mu *= factor;
    rates->mu_speed *= factor;
    rates->mu_pressure *= factor;
    for (int32_t k = 0; k < law->states; k++) rates->mu_state[k] *= factor;
}

static void find_rate(const FrictionNode *node, double speed, const double *state,
                      FrictionRates *rates)
{
    const FrictionLaw *law = node->law;
    double pace = node->pace;
    rates->states = law->states;
    friction_operations(law)->rate(law, pace > 0 ? speed / pace : speed, node->pressure, state,
                                   rates);
    for (int32_t k = 0; pace > 0 && k < law->states; k++) {
        rates->rate[k] *= pace;
        for (int32_t j = 0; j < law->states; j++) rates->rate_state[k][j] *= pace;
    }
}

// Where the state has a clock of its own a function that fills both parts would fill one of them
// for the wrong speed: that part goes into a place of its own.
void friction_rates(const FrictionNode *node, double speed, const double *state,
                    FrictionRates *rates)
{
    const FrictionLaw *law = node->law;
    const FrictionOperations *operations = friction_operations(law);
    if (!law->remembers) {
        rates->states = 0;
        rates->mu = friction_coefficient(node, speed);
        rates->mu_speed = friction_slope(node, speed);
        rates->mu_pressure = 0;
    } else if (operations->mu != operations->rate) {
        find_rate(node, speed, state, rates);
        find_mu(node, speed, state, rates);
    } else if (node->pace > 0) {
        FrictionRates of_mu;
        find_rate(node, speed, state, rates);
        find_mu(node, speed, state, &of_mu);
        rates->mu = of_mu.mu;
        rates->mu_speed = of_mu.mu_speed;
        rates->mu_pressure = of_mu.mu_pressure;
        memcpy(rates->mu_state, of_mu.mu_state, (size_t)law->states * sizeof(double));
    } else {
        find_mu(node, speed, state, rates);
    }
}

// --- the states at the end of the stage ---------------------------------------------------------

// Such a function is compiled a second time for the single state that most laws have (n = 1).
#define INLINED static inline __attribute__((always_inline))

// x becomes (1 - reach g_theta)^-1 x. Returns false where that is singular.
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

// The equation of a stage while it is solved.
typedef struct Elimination {
    const FrictionNode *node;
    double speed;
    double off[STATES_MAX], scale[STATES_MAX];   // residual of each state, and its size
    FrictionRates rates;
} Elimination;

// Fills the residual of each state, state - from - reach g.
INLINED void find_off(Elimination *at, int32_t n, const double *state)
{
    const FrictionNode *node = at->node;
    find_rate(node, at->speed, state, &at->rates);
    for (int32_t k = 0; k < n; k++)
        at->off[k] = state[k] - node->from[k] - node->reach * at->rates.rate[k];
}

// The largest residual over its size; NaN where one is.
INLINED double largest_off(const Elimination *at, int32_t n)
{
    double largest = 0;
    for (int32_t k = 0; k < n; k++) {
        double part = fabs(at->off[k]);
        if (part != 0 && !(part <= largest * at->scale[k])) largest = part / at->scale[k];
    }
    return largest;
}

// Part of a state: what is left after so short a step of Newton's method is its square.
static const double NEAR = 1e-9;
// Part of what slip alone would do to a state: so short a step is noise.
static const double ROUNDING = 1e-14;

// Newton's method from `from`.
INLINED void eliminate(const FrictionNode *node, double speed, int32_t n, double *state)
{
    enum { STEPS = 60, HALVINGS = 60 };
    Elimination at;
    double step[STATES_MAX], from[STATES_MAX];
    for (int32_t k = 0; k < n; k++) state[k] = node->from[k];
    if (node->reach == 0) return;
    at.node = node;
    at.speed = speed;
    at.rates.states = n;
    find_off(&at, n, state);
    for (int32_t k = 0; k < n; k++) at.scale[k] = fabs(state[k]) + fabs(at.off[k]);
    double left = largest_off(&at, n);
    bool is_linear = friction_operations(node->law)->rate_is_linear && !(node->pace > 0);
    for (int32_t trial = 0; trial < STEPS && left != 0; trial++) {
        for (int32_t k = 0; k < n; k++) step[k] = at.off[k];
        if (!solve_states(&at.rates, node->reach, n, step)) break;

        // The last step: where g is linear, or it is short.
        bool is_last = true;
        for (int32_t k = 0; !is_linear && is_last && k < n; k++) {
            double size = fabs(step[k]), slips = node->reach * at.rates.rate_speed[k] * speed;
            double yields = 1 + node->reach * fabs(at.rates.rate_state[k][k]);
            is_last = size <= NEAR * (fabs(state[k]) + fabs(node->from[k])) ||
                      size * yields <= ROUNDING * fabs(slips);
        }
        if (is_last) {
            for (int32_t k = 0; k < n; k++) state[k] -= step[k];
            return;
        }

        // Halved while it leaves more than there was.
        double before = left, part = 1;
        bool leaves_less = false;
        for (int32_t k = 0; k < n; k++) from[k] = state[k];
        for (int32_t halved = 0; !leaves_less && halved < HALVINGS; halved++, part *= 0.5) {
            for (int32_t k = 0; k < n; k++) state[k] = from[k] - part * step[k];
            find_off(&at, n, state);
            left = largest_off(&at, n);
            leaves_less = left < before;
        }
        if (!leaves_less) break;
    }
    for (int32_t k = 0; k < n && left != 0; k++) state[k] = NAN;
}

void friction_state(const FrictionNode *node, double speed, double *state)
{
    if (node->law->states == 1)
        eliminate(node, speed, 1, state);
    else
        eliminate(node, speed, node->law->states, state);
}

bool friction_solve_states(const FrictionRates *rates, double reach, double *x)
{
    return solve_states(rates, reach, rates->states, x);
}

double friction_feedback(const FrictionRates *rates, double reach)
{
    double x[STATES_MAX], sum = 0;
    for (int32_t k = 0; k < rates->states; k++) x[k] = reach * rates->rate_speed[k];
    if (!solve_states(rates, reach, rates->states, x)) return NAN;
    for (int32_t k = 0; k < rates->states; k++) sum += rates->mu_state[k] * x[k];
    return sum;
}

// mu, and d mu/d speed, with the states that the stage ends with at this speed.
static double stage_coefficient(const FrictionNode *node, double speed)
{
    double state[STATES_MAX];
    FrictionRates rates;
    friction_state(node, speed, state);
    const FrictionOperations *operations = friction_operations(node->law);
    if (operations->mu_alone && !(node->pace > 0))
        return node->factor * operations->mu_alone(node->law, speed, node->pressure, state);
    find_mu(node, speed, state, &rates);
    return rates.mu;
}

static __attribute__((noinline)) double stage_slope(const FrictionNode *node, double speed)
{
    double state[STATES_MAX];
    FrictionRates rates;
    friction_state(node, speed, state);
    friction_rates(node, speed, state, &rates);
    return rates.mu_speed + friction_feedback(&rates, node->reach);
}

// --- the coefficient ----------------------------------------------------------------------------

// One's own law is the same at every speed beyond its end. Two functions that are not inlined: the
// built-in laws, asked some million times in a run, need no stack.
static __attribute__((noinline)) double own_coefficient(const FrictionNode *node, double speed)
{
    double ignored;
    const FrictionLaw *law = node->law;
    return node->factor * friction_operations(law)->value(law, fmin(speed, law->end), &ignored);
}

static __attribute__((noinline)) double own_slope(const FrictionNode *node, double speed)
{
    double slope;
    const FrictionLaw *law = node->law;
    if (!(speed < law->end)) return 0;
    friction_operations(law)->value(law, speed, &slope);
    return node->factor * slope;
}

double friction_coefficient(const FrictionNode *node, double speed)
{
    const FrictionLaw *law = node->law;
    if (law->remembers) return stage_coefficient(node, speed);
    const FrictionOperations *operations = friction_operations(law);
    return operations->coefficient ? operations->coefficient(law, node->factor, speed)
                                   : own_coefficient(node, speed);
}

double friction_slope(const FrictionNode *node, double speed)
{
    const FrictionLaw *law = node->law;
    if (law->remembers) return stage_slope(node, speed);
    const FrictionOperations *operations = friction_operations(law);
    return operations->slope ? operations->slope(law, node->factor, speed) : own_slope(node, speed);
}

// mu_S - mu_K there; with states that of the law's numbers, whatever the states are.
static double lasting_drop(const FrictionNode *node)
{
    const FrictionLaw *law = node->law;
    return law->remembers ? node->factor * (law->mu_static - law->mu_kinetic)
                          : node->factor * law->mu_static - friction_kinetic(node);
}

double friction_drop(const FrictionNode *node)
{
    double fall = node->factor * node->law->fall;
    return friction_has_drop(node->law) ? fmax(lasting_drop(node), fall) : 0;
}

double friction_law_drop(const FrictionLaw *law)
{
    FrictionNode node = friction_node(law, 1);
    return friction_drop(&node);
}

double friction_steepest(const FrictionNode *node)
{
    const FrictionLaw *law = node->law;
    double steepest = node->factor * law->steepest;
    bool known = law->remembers ? law->creeps : friction_is_own(law);
    return known ? steepest : fmax(-friction_slope(node, 0), steepest);
}

bool friction_weakens(const FrictionNode *node, double speed)
{
    if (!node->law->remembers) return friction_slope(node, speed) < 0.0;
    double state[STATES_MAX], falls = 0;
    FrictionRates rates;
    friction_state(node, speed, state);
    friction_rates(node, speed, state, &rates);
    for (int32_t k = 0; k < rates.states; k++) falls += rates.mu_state[k] * rates.rate[k];
    return rates.mu_speed < 0 || falls < 0;
}

bool friction_weakens_at_once(const FrictionNode *node)
{
    return node->law->remembers && !node->law->creeps && node->law->steepest > 0;
}

double friction_spent_speed(const FrictionNode *node)
{
    static const double MANY = 20;   // D_c that are slipped in the stage
    const FrictionLaw *law = node->law;
    double times = friction_operations(law)->spent;
    if (!law->remembers) return friction_is_own(law) ? law->spent : times * law->critical_velocity;
    double speed = law->creeps ? 0 : times * law->critical_velocity;
    return node->reach > 0 ? speed + MANY * law->slip_distance / node->reach : speed;
}

// Solves mu = mu_K + (mu_S - mu_K) phi for phi <= 1: 1 at rest, 0 from v_c on, and for the linear
// law just the paper's 1 - |v|/v_c.
double friction_contact_density(const FrictionNode *node, double speed)
{
    double drop = friction_has_drop(node->law) ? lasting_drop(node) : 0;
    double left = drop > 0 ? (friction_coefficient(node, speed) - friction_kinetic(node)) / drop
                           : 1.0;
    return fmin(fmax(left, 0), 1);
}

bool friction_has_area(const FrictionNode *node)
{
    return friction_operations(node->law)->area != NULL;
}

double friction_contact_area(const FrictionNode *node, double speed, const double *state)
{
    if (!friction_has_area(node)) return friction_contact_density(node, speed);
    const FrictionOperations *operations = friction_operations(node->law);
    double start[STATES_MAX] = {0};
    friction_start_state(node, start);
    return operations->area(node->law, state) / operations->area(node->law, start);
}

// --- states -------------------------------------------------------------------------------------

void friction_set_stage(FrictionNode *node, const double *from, double reach)
{
    if (!node->law->remembers) return;
    memcpy(node->from, from, (size_t)node->law->states * sizeof(double));
    node->reach = reach;
}

double friction_set_pressure(FrictionNode *node, double pressure, double speed)
{
    if (!node->law->feels_pressure) return 0;
    double before = stage_coefficient(node, speed);
    node->pressure = pressure;
    return stage_coefficient(node, speed) - before;
}

void friction_rates_pressed(const FrictionNode *node, double pressure, double speed,
                            const double *state, FrictionRates *rates)
{
    FrictionNode other = *node;
    if (node->law->feels_pressure) other.pressure = pressure;
    friction_rates(&other, speed, state, rates);
}

double friction_direct_slope(const FrictionNode *node, double speed)
{
    double state[STATES_MAX];
    FrictionRates rates;
    friction_state(node, speed, state);
    friction_rates(node, speed, state, &rates);
    return rates.mu_speed;
}

void friction_start_state(const FrictionNode *node, double *state)
{
    memcpy(state, node->law->start, (size_t)node->law->states * sizeof(double));
}

double friction_shown_state(const FrictionNode *node, int32_t k, double state)
{
    const FrictionLaw *law = node->law;
    if (k >= law->states) return 0;
    const FrictionOperations *operations = friction_operations(law);
    return operations->shown ? operations->shown(law, state) : state;
}

FrictionNode friction_paced(const FrictionNode *node, double pace)
{
    FrictionNode paced = *node;
    if (!node->law->remembers) return paced;
    paced.pace = pace;
    paced.mu_pace = friction_weakens_at_once(node) ? 1 : pace;
    return paced;
}

// --- a step in friction -------------------------------------------------------------------------

static const double EXPONENT_MAX = 690;   // exp of it is finite

// y = asinh(|v|/v_s) v/|v| answers to a step along v by 1/hypot(v, v_s), across it by |y|/|v|.
void friction_follow(const FrictionNode *node, int32_t count, const double *velocity,
                     const double *step, double *next)
{
    enum { STEPS = 30 };
    double speed = count == 1 ? fabs(velocity[0]) : hypot(velocity[0], velocity[1]);
    double state[STATES_MAX], y[2] = {0}, along = 0;
    FrictionRates rates;
    for (int32_t c = 0; c < count; c++) {
        next[c] = velocity[c] + step[c];
        if (speed > 0) along += step[c] * (velocity[c] / speed);
    }

    // v_s, where friction is not as good as linear: sinh(x) = v/v_s for mu = a asinh(v/v_s), so
    // mu/(mu_v v) = x/tanh(x). Newton's method from the right, where it cannot overshoot.
    friction_state(node, speed, state);
    double at = speed == 0 ? node->law->critical_velocity : speed;
    friction_rates(node, at, state, &rates);
    double ratio = rates.mu / (rates.mu_speed * at), x = fmin(ratio, EXPONENT_MAX);
    if (!(ratio > 1)) return;
    for (int32_t k = 0; k < STEPS; k++) {
        double t = tanh(x), nearer = x - (x - ratio * t) / (1 - ratio * (1 - t * t));
        if (!(nearer < x && nearer > 0)) break;
        x = nearer;
    }
    double scale = at / sinh(x);
    if (!isfinite(scale)) return;
    double root = hypot(speed, scale), part = asinh(speed / scale);
    for (int32_t c = 0; c < count; c++) {
        double d = speed > 0 ? velocity[c] / speed : 0;
        double across = speed > 0 ? (step[c] - along * d) * (part / speed) : step[c] / scale;
        y[c] = part * d + along * d / root + across;
    }
    double size = count == 1 ? fabs(y[0]) : hypot(y[0], y[1]);
    double way = scale * sinh(fmin(size, EXPONENT_MAX));
    for (int32_t c = 0; c < count; c++) next[c] = size > 0 ? way * (y[c] / size) : 0;
}
