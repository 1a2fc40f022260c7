// SPDX-License-Identifier: GPL-2.0-or-later
// Steady slip is where an implicit step of any length leads: stages of a growing reach, each from
// where the last one ended. Rest is stepped by the midpoint rule, in steps that grow with time.
#include "friction/friction_start.h"

#include "friction/friction_response.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SLIGHT = 1e-6;   // part of mu_S that a formula may be below 0
static const double LEFT = 0.36787944117144233;   // 1/e
enum { DECADES = 12, DECADE = 10 };   // speeds that are looked at

static double look_speed(const FrictionSource *source, int32_t k)
{
    return k == 0 ? 0 : source->end * pow(10, (double)(k - DECADES * DECADE) / DECADE);
}

// Finds mu and the rates at node->from, and refuses values that no law may have.
static bool look_at(const FrictionSource *source, const FrictionNode *node, double speed,
                    FrictionRates *rates, const char **key, Error *err)
{
    char place[300];   // "velocity 0.1, theta 2"
    double finite = 0;
    const FrictionOperations *operations = friction_operations(node->law);
    friction_rates(node, speed, node->from, rates);
    int used = snprintf(place, sizeof place, "velocity %g", speed);
    for (int32_t k = 0; k < node->law->states && used > 0 && (size_t)used < sizeof place; k++)
        used += snprintf(place + used, sizeof place - (size_t)used, ", %s %g",
                         k < source->state_count ? source->state[k].name : "state", node->from[k]);
    for (int32_t k = 0; k < node->law->states; k++) {
        if (!isfinite(rates->rate[k]))
            return REFUSE_AT(
                err, key, operations->state_key, "at %s the rate of %s is %g: not a finite number",
                place, k < source->state_count ? source->state[k].name : "a state", rates->rate[k]);
        finite += rates->mu_state[k] + rates->rate_speed[k];
        for (int32_t j = 0; j < node->law->states; j++) finite += rates->rate_state[k][j];
    }
    if (!isfinite(rates->mu))
        return REFUSE_AT(err, key, operations->mu_key,
                         "at %s the coefficient is %g: not a finite number", place, rates->mu);
    if (!isfinite(finite + rates->mu_speed))
        return REFUSE_AT(err, key, operations->mu_key,
                         "at %s a derivative of the coefficient or of a rate is not finite", place);
    if (rates->mu < -SLIGHT)
        return REFUSE_AT(err, key, operations->mu_key,
                         "at %s the coefficient is %g: it must not be negative", place, rates->mu);
    return true;
}

bool friction_find_steady(FrictionNode *node, double speed)
{
    static const double STAYS = 1e-6;   // of a state: what the last, longest stage may change
    double state[STATES_MAX], began[STATES_MAX];
    bool found = true;
    memcpy(began, node->from, sizeof began);
    for (node->reach = 1e-12; node->reach < 1e30; node->reach *= 10) {
        friction_state(node, speed, state);
        found = true;
        for (int32_t k = 0; k < node->law->states; k++) {
            double change = fabs(state[k] - node->from[k]);
            found = found && change <= STAYS * fmax(fabs(state[k]), STAYS);
            if (!isfinite(state[k])) node->reach = INFINITY;
        }
        memcpy(node->from, state, sizeof state);
    }
    node->reach = 0;
    if (!found) memcpy(node->from, began, sizeof began);
    return found;
}

FrictionRates friction_steady_rates(const FrictionNode *node, double speed, double *state)
{
    FrictionNode steady = *node;
    FrictionRates rates;
    friction_start_state(&steady, state);
    if (steady.law->remembers) {
        memcpy(steady.from, steady.law->start, sizeof steady.from);
        friction_find_steady(&steady, speed);
        memcpy(state, steady.from, (size_t)steady.law->states * sizeof(double));
    }
    friction_rates(&steady, speed, state, &rates);
    return rates;
}

double friction_forgets(const FrictionNode *node, double speed)
{
    double state[STATES_MAX], re[STATES_MAX], im[STATES_MAX], slowest = INFINITY;
    FrictionRates rates = friction_steady_rates(node, speed, state);
    friction_own_rates(&rates, re, im);
    for (int32_t k = 0; k < rates.states; k++)
        if (re[k] < 0) slowest = fmin(slowest, -re[k]);
    return slowest;
}

// mu over one of its arguments: speed (0), pressure (1), state k (2 + k), the others as they are.
typedef struct Course {
    FrictionNode node;
    double speed;
    int32_t argument;
} Course;

static double course_at(Course *course, double value)
{
    FrictionRates rates;
    double speed = course->argument == 0 ? value : course->speed;
    if (course->argument == 1) course->node.pressure = value;
    if (course->argument >= 2) course->node.from[course->argument - 2] = value;
    friction_rates(&course->node, speed, course->node.from, &rates);
    return rates.mu;
}

// Where mu changes between two values, the interval is halved towards the larger change until
// nothing but rounding is left of it: what is steep shrinks, a jump stays. True: there is none.
static bool is_continuous(Course *course, double low, double high, double jump[3])
{
    static const double JUMP = 1e-6;   // of mu
    double from = course_at(course, low), to = course_at(course, high);
    double least = JUMP * fmax(fabs(from), fabs(to));
    while (high - low > 1e-13 * high && fabs(to - from) > least) {
        double middle = 0.5 * (low + high), mu = course_at(course, middle);
        bool left = fabs(mu - from) > fabs(to - mu);
        *(left ? &high : &low) = middle;
        *(left ? &to : &from) = mu;
    }
    jump[0] = high, jump[1] = from, jump[2] = to;
    return !(fabs(to - from) > least);
}

// Around the states and the pressure of the start, and at all speeds that are looked at.
static bool check_continuous(const FrictionSource *source, const FrictionNode *node,
                             const char **key, Error *err)
{
    static const double REACH = 1e3;   // times pressure and states at the start, and over it
    Course course = {.node = *node, .speed = fmax(source->rod_velocity, 1e-3 * source->end)};
    for (int32_t argument = 0; argument < 2 + node->law->states; argument++) {
        double middle = argument == 0   ? source->end / REACH
                        : argument == 1 ? source->pressure
                                        : fabs(node->law->start[argument - 2]);
        int32_t points = argument == 0 ? DECADES * DECADE : 6 * DECADE;
        double jump[3], value = 0, next;
        if (!(middle > 0)) continue;
        for (int32_t k = 0; k < points; k++, value = next) {
            course.node = *node;
            course.argument = argument;
            next = middle * REACH * pow(10, (double)(k + 1 - points) / DECADE);
            if (k == 0 || is_continuous(&course, value, next, jump)) continue;
            return REFUSE_AT(err, key, friction_operations(node->law)->mu_key,
                             "at %s %g the coefficient jumps from %g to %g: it must be continuous",
                             argument == 0                        ? "velocity"
                             : argument == 1                      ? "pressure"
                             : argument - 2 < source->state_count ? source->state[argument - 2].name
                                                                  : "a state of",
                             jump[0], jump[1], jump[2]);
        }
    }
    return true;
}

static void rest_for(FrictionNode *node, double rest)
{
    static const double FIRST = 1e-9, GROWTH = 1.01;   // of the rest; from step to step
    double middle[STATES_MAX], step = FIRST * rest;
    for (double time = 0; time < rest; time += step, step *= GROWTH) {
        step = fmin(step, rest - time);
        node->reach = 0.5 * step;
        friction_state(node, 0, middle);
        for (int32_t k = 0; k < node->law->states; k++)
            node->from[k] = 2 * middle[k] - node->from[k];
    }
    node->reach = 0;
}

// Finds the states at the start, node->from.
static bool find_start(const FrictionSource *source, FrictionNode *node, const char **key,
                       Error *err)
{
    FrictionRates rates;
    bool all = true;
    const FrictionOperations *operations = friction_operations(node->law);
    if (operations->start) {
        operations->start(node->law, source, node->from);
        return true;
    }
    for (int32_t k = 0; k < node->law->states; k++) {
        const FrictionStateText *state = &source->state[k];
        node->from[k] = 1;
        all = all && *state->start;
        if (!*state->start) continue;
        if (!formula_value(state->start, source->look_up, source->context, &node->from[k], err)) {
            error_context(err, "%s, its start", state->name);
            return ERROR_AT(key, "state", false);
        }
    }
    if (!all) {
        if (!(source->rod_velocity > 0))
            return REFUSE_AT(err, key, "state",
                             "a state needs its `start`: without a rod that moves nothing says "
                             "what the contacts remember");
        if (!look_at(source, node, source->rod_velocity, &rates, key, err)) return false;
        if (!friction_find_steady(node, source->rod_velocity))
            return REFUSE_AT(err, key, "state",
                             "no state of steady slip is found at velocity %g: a `start` is needed",
                             source->rod_velocity);
    }
    if (source->rest > 0) rest_for(node, source->rest);
    return true;
}

bool friction_start(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    enum { LAST = DECADES * DECADE };
    double steady[LAST + 1];   // mu of steady slip at the speeds looked at; NaN: none is found
    double lost = 0, lowest = INFINITY, highest = 0;
    FrictionRates rates;
    law->pressure = source->pressure;
    FrictionNode node = friction_node(law, 1);
    TRY(find_start(source, &node, key, err));
    memcpy(law->start, node.from, sizeof law->start);
    TRY(look_at(source, &node, source->rod_velocity, &rates, key, err));

    // The law is looked at in the states of the start and in steady slip at all speeds. lost: the
    // most that mu loses in a unit of slip by its states.
    for (int32_t k = 0; k <= LAST; k++) {
        double speed = look_speed(source, k), now = 0;
        memcpy(node.from, law->start, sizeof node.from);
        TRY(look_at(source, &node, speed, &rates, key, err));
        law->steepest = fmax(law->steepest, -rates.mu_speed);
        for (int32_t j = 0; j < law->states; j++)
            now += fabs(rates.mu_state[j] * rates.rate_speed[j]);
        lost = fmax(lost, now);
        steady[k] = k == 0 ? NAN : rates.mu;
        if (law->states == 0 || k == 0) continue;
        steady[k] = NAN;
        if (!friction_find_steady(&node, speed)) continue;
        TRY(look_at(source, &node, speed, &rates, key, err));
        steady[k] = rates.mu;
        law->steepest = fmax(law->steepest, -rates.mu_speed);
    }
    memcpy(node.from, law->start, sizeof node.from);
    TRY(check_continuous(source, &node, key, err));

    // The scales.
    friction_rates(&node, 0, law->start, &rates);
    double rests = rates.mu, rises = rates.mu_speed;
    friction_rates(&node, source->rod_velocity > 0 ? source->rod_velocity : source->end, law->start,
                   &rates);
    law->creeps = law->strengthens = friction_never_holds(rests, rises, rates.mu);
    law->mu_reference = rates.mu;
    for (int32_t k = 1; k <= LAST; k++) {
        lowest = fmin(lowest, steady[k]);   // fmin and fmax pass a NaN over
        highest = fmax(highest, steady[k]);
    }
    if (!(law->mu_static > 0)) law->mu_static = law->creeps ? highest : rests;
    if (!(law->mu_kinetic > 0)) law->mu_kinetic = fmin(lowest, law->mu_static);
    double drop = law->mu_static - law->mu_kinetic;
    int32_t last = LAST;
    while (last > 1 && !(steady[last - 1] - law->mu_kinetic > LEFT * drop)) last--;
    if (!(law->critical_velocity > 0)) law->critical_velocity = look_speed(source, last);
    if (!(law->slip_distance > 0)) law->slip_distance = lost > 0 ? 1 / lost * drop : 0;
cleanup:
    return error_is_clean(err);
}
