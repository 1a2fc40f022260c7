// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/friction_make.h"

#include <string.h>

// The columns stand in the order of the kinds.
FrictionUse friction_use(const FrictionLaw *law, const char *key)
{
    enum { KINDS = 9, NO = FRICTION_UNUSED, MAY = FRICTION_MAY, MUST = FRICTION_MUST };
    static const struct {
        const char *key;
        uint8_t use[KINDS];
    } table[] = {{"law", {MAY, MAY, MAY, MAY, MAY, MAY, MAY, MAY, MAY}},
                 {"mu_static", {MUST, MUST, MUST, MAY, MAY, MAY, MUST, MUST, NO}},
                 {"mu_kinetic", {MUST, MUST, MAY, MAY, MAY, MAY, MUST, MUST, NO}},
                 {"critical_velocity", {MUST, MUST, MAY, MAY, MAY, MAY, MUST, NO, NO}},
                 {"velocity", {NO, NO, NO, MUST, NO, NO, NO, NO, NO}},
                 {"mu", {NO, NO, NO, MUST, NO, NO, NO, NO, NO}},
                 {"interpolation", {NO, NO, NO, MAY, NO, NO, NO, NO, NO}},
                 {"formula", {NO, NO, NO, NO, MUST, NO, NO, NO, NO}},
                 {"file", {NO, NO, NO, NO, NO, MUST, NO, NO, NO}},
                 {"parameters", {NO, NO, NO, NO, NO, MAY, NO, NO, NO}},
                 {"velocity_max", {NO, NO, NO, NO, MAY, MAY, NO, NO, NO}},
                 {"slip_distance", {NO, NO, NO, NO, NO, NO, MUST, MUST, MUST}},
                 {"healing_time", {NO, NO, NO, NO, NO, NO, MUST, MUST, NO}},
                 {"healing", {NO, NO, NO, NO, NO, NO, MUST, NO, NO}},
                 {"direct_effect", {NO, NO, NO, NO, NO, NO, NO, NO, MUST}},
                 {"evolution_effect", {NO, NO, NO, NO, NO, NO, NO, NO, MUST}},
                 {"mu_reference", {NO, NO, NO, NO, NO, NO, NO, NO, MUST}},
                 {"reference_velocity", {NO, NO, NO, NO, NO, NO, NO, NO, MUST}},
                 {"evolution", {NO, NO, NO, NO, NO, NO, NO, NO, MAY}},
                 {"rest", {NO, NO, NO, NO, NO, NO, MAY, MAY, MAY}},
                 {"along", {MAY, MAY, MAY, MAY, MAY, MAY, MAY, MAY, MAY}},
                 {"contacts", {MAY, MAY, MAY, MAY, MAY, MAY, MAY, MAY, MAY}}};
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++)
        if (strcmp(table[k].key, key) == 0) return (FrictionUse)table[k].use[law->kind];
    return FRICTION_UNUSED;
}

static bool read_table(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    FrictionTable *table = &law->own.table;
    int32_t count = source->velocity_count;
    *key = "velocity";
    if (count < 2 || count > FRICTION_POINTS_MAX)
        FAIL(err, ERROR_INPUT, "has %d numbers; a table has 2 to %d", count, FRICTION_POINTS_MAX);
    if (source->velocity[0] != 0)
        FAIL(err, ERROR_INPUT, "begins with %g; the first is 0, where mu holds at rest",
             source->velocity[0]);
    *table = (FrictionTable){.count = count, .straight = source->straight};
    for (int32_t k = 0; k < count; k++) {
        table->speed[k] = source->velocity[k];
        if (k > 0 && !(table->speed[k] > table->speed[k - 1]))
            FAIL(err, ERROR_INPUT, "%g stands after %g; velocities ascend", table->speed[k],
                 table->speed[k - 1]);
    }
    *key = "mu";
    if (source->mu_count != count)
        FAIL(err, ERROR_INPUT, "has %d numbers, friction.velocity has %d", source->mu_count, count);
    memcpy(table->mu, source->mu, (size_t)count * sizeof(double));
    friction_table_slopes(table);
    law->end = table->speed[count - 1];
cleanup:
    return error_is_clean(err);
}

// Of a formula: what the scene gives besides.
static bool given_number(const void *context, const char *name, double *value)
{
    const FrictionLaw *law = context;
    *value = strcmp(name, "mu_static") == 0           ? law->mu_static
             : strcmp(name, "mu_kinetic") == 0        ? law->mu_kinetic
             : strcmp(name, "critical_velocity") == 0 ? law->critical_velocity
                                                      : 0;
    return *value > 0;
}

static bool read_plugin(const FrictionSource *source, FrictionLaw *law, Error *err)
{
    AmontonsFriction *given = &law->own.plugin.given;
    if (source->parameter_count > AMONTONS_FRICTION_PARAMETERS_MAX)
        FAIL(err, ERROR_INPUT, "takes at most %d friction.parameters, not %d",
             AMONTONS_FRICTION_PARAMETERS_MAX, source->parameter_count);
    *given = (AmontonsFriction){.mu_static = law->mu_static,
                                .mu_kinetic = law->mu_kinetic,
                                .critical_velocity = law->critical_velocity,
                                .parameter_count = source->parameter_count};
    for (int32_t k = 0; k < source->parameter_count; k++)
        given->parameters[k] = source->parameters[k];
    TRY(friction_plugin_open(source->file, &law->own.plugin, err));
cleanup:
    return error_is_clean(err);
}

bool friction_own_law(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    FormulaNames names = {given_number, law, "v",
                          "is no number here: v, and mu_static, mu_kinetic, critical_velocity "
                          "where friction gives them"};
    law->end = source->end;
    law->factor = 1;
    switch (law->kind) {
    case FRICTION_TABLE:
        return read_table(source, law, key, err);
    case FRICTION_FORMULA:
        *key = "formula";
        return formula_read(source->formula, &names, &law->own.formula, err);
    case FRICTION_PLUGIN:
        *key = "file";
        return read_plugin(source, law, err);
    case FRICTION_LINEAR_WEAKENING:
    case FRICTION_EXPONENTIAL_WEAKENING:
    case FRICTION_COULOMB:
    case FRICTION_AGEING:
    case FRICTION_SLIP_WEAKENING:
    case FRICTION_RATE_STATE:
        break;
    }
    *key = "law";
    return true;
}

void friction_make_memory(const FrictionMemory *memory, FrictionLaw *law)
{
    law->own.memory = *memory;
    law->mu_static = memory->mu_static;
    law->mu_kinetic = memory->mu_kinetic;
    law->critical_velocity = memory->critical_velocity;
    law->strengthens = law->kind == FRICTION_RATE_STATE;
}
