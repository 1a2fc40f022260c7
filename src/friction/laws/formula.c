// SPDX-License-Identifier: GPL-2.0-or-later
// A law written as formulas: mu, and the rate of each state, of v, p and all states. Without states
// and pressure it is a law of speed alone.
#include "friction/laws/law.h"

#include <math.h>
#include <string.h>

static bool no_number(const void *context, const char *name, double *value)
{
    (void)context, (void)name, (void)value;
    return false;
}

static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    const char *more[1 + STATES_MAX];
    FrictionFormula *formula = &law->formula;
    FormulaNames names = {.look_up = source->look_up ? source->look_up : no_number,
                          .context = source->context,
                          .variable = "v",
                          .more = more,
                          .more_count = 1 + source->state_count,
                          .unknown = "is no number here: v, p, the states, and numbers that "
                                     "friction gives, such as mu_static or slip_distance"};
    *formula = (FrictionFormula){0};
    if (source->state_count > STATES_MAX)
        return REFUSE_AT(err, key, "state", "at most %d states", STATES_MAX);
    for (int32_t k = 0; k < source->state_count; k++) more[k] = source->state[k].name;
    more[source->state_count] = "p";
    for (int32_t k = 0; k <= source->state_count; k++) {
        if (!formula_append(k == 0 ? source->formula : source->state[k - 1].rate, &names,
                            &formula->text, err)) {
            if (k > 0) error_context(err, "%s, its rate", source->state[k - 1].name);
            return ERROR_AT(key, k > 0 ? "state" : "formula", false);
        }
        formula->ends[k + 1] = formula->text.count;
    }
    law->states = source->state_count;
    law->feels_pressure = formula_has(&formula->text, 1 + law->states);
    law->remembers = law->states > 0 || law->feels_pressure;
    return true;
}

static double value(const FrictionLaw *law, double speed, double *slope)
{
    return formula_at(&law->formula.text, speed, slope);
}

// Expression k, 0 for mu, of v, the states and p in this order. slope: the derivatives by the first
// [wanted] of them; wanted 0: the value alone.
static double expression(const FrictionLaw *law, int32_t k, double speed, double pressure,
                         const double *state, int32_t wanted, double *slope)
{
    double x[FORMULA_VARIABLES_MAX] = {speed};
    memcpy(x + 1, state, (size_t)law->states * sizeof(double));
    x[1 + law->states] = pressure;
    return formula_partials(&law->formula.text, law->formula.ends + k, x, wanted, slope);
}

static void find_mu(const FrictionLaw *law, double speed, double pressure, const double *state,
                    FrictionRates *rates)
{
    double slope[FORMULA_VARIABLES_MAX];
    int32_t n = law->states;
    rates->mu = expression(law, 0, speed, pressure, state, 1 + n + law->feels_pressure, slope);
    rates->mu_speed = slope[0];
    if (law->feels_pressure) rates->mu_pressure = slope[1 + n];
    memcpy(rates->mu_state, slope + 1, (size_t)n * sizeof(double));
}

static double mu_alone(const FrictionLaw *law, double speed, double pressure, const double *state)
{
    return expression(law, 0, speed, pressure, state, 0, NULL);
}

static void find_rate(const FrictionLaw *law, double speed, double pressure, const double *state,
                      FrictionRates *rates)
{
    double slope[FORMULA_VARIABLES_MAX];
    int32_t n = law->states;
    for (int32_t k = 0; k < n; k++) {
        rates->rate[k] = expression(law, k + 1, speed, pressure, state, 1 + n, slope);
        rates->rate_speed[k] = slope[0];
        memcpy(rates->rate_state[k], slope + 1, (size_t)n * sizeof(double));
    }
}

const FrictionOperations friction_formula = {
    .must = "formula",
    .may = "mu_static mu_kinetic critical_velocity state velocity_max slip_distance healing_time "
           "healing direct_effect evolution_effect mu_reference reference_velocity rest",
    .own = true,
    .has_drop = true,
    .spent = 1,
    .make = make,
    .value = value,
    .mu = find_mu,
    .rate = find_rate,
    .mu_alone = mu_alone,
    .state_key = "state",
    .mu_key = "formula",
    .state_unit = "its own"};
