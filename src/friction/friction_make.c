// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_make.h"

#include "friction/friction_start.h"

#include <string.h>

// The columns stand in the order of the kinds.
FrictionUse friction_use(const FrictionLaw *law, const char *key)
{
#define X(symbol, name, own, drops, memory) +1
    enum {
        KINDS = FRICTION_LAWS(X),
        NO = FRICTION_UNUSED,
        MAY = FRICTION_MAY,
        MUST = FRICTION_MUST
    };
#undef X
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
                 {"state", {NO, NO, NO, NO, MAY, NO, NO, NO, NO}},
                 {"file", {NO, NO, NO, NO, NO, MUST, NO, NO, NO}},
                 {"parameters", {NO, NO, NO, NO, NO, MAY, NO, NO, NO}},
                 {"velocity_max", {NO, NO, NO, NO, MAY, MAY, NO, NO, NO}},
                 {"slip_distance", {NO, NO, NO, NO, MAY, NO, MUST, MUST, MUST}},
                 {"healing_time", {NO, NO, NO, NO, MAY, NO, MUST, MUST, NO}},
                 {"healing", {NO, NO, NO, NO, MAY, NO, MUST, NO, NO}},
                 {"direct_effect", {NO, NO, NO, NO, MAY, NO, NO, NO, MUST}},
                 {"evolution_effect", {NO, NO, NO, NO, MAY, NO, NO, NO, MUST}},
                 {"mu_reference", {NO, NO, NO, NO, MAY, NO, NO, NO, MUST}},
                 {"reference_velocity", {NO, NO, NO, NO, MAY, NO, NO, NO, MUST}},
                 {"evolution", {NO, NO, NO, NO, NO, NO, NO, NO, MAY}},
                 {"rest", {NO, NO, NO, NO, MAY, MAY, MAY, MAY, MAY}},
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
        return REFUSE(err, "has %d numbers; a table has 2 to %d", count, FRICTION_POINTS_MAX);
    if (source->velocity[0] != 0)
        return REFUSE(err, "begins with %g; the first is 0, where mu holds at rest",
                      source->velocity[0]);
    *table = (FrictionTable){.count = count, .straight = source->straight};
    for (int32_t k = 0; k < count; k++) {
        table->speed[k] = source->velocity[k];
        if (k > 0 && !(table->speed[k] > table->speed[k - 1]))
            return REFUSE(err, "%g stands after %g; velocities ascend", table->speed[k],
                          table->speed[k - 1]);
    }
    *key = "mu";
    if (source->mu_count != count)
        return REFUSE(err, "has %d numbers, friction.velocity has %d", source->mu_count, count);
    memcpy(table->mu, source->mu, (size_t)count * sizeof(double));
    friction_table_slopes(table);
    law->end = table->speed[count - 1];
    return true;
}

static bool make_own_memory(const FrictionSource *source, FrictionMemory *memory, FrictionLaw *law,
                            const char **key, Error *err)
{
    memory->mu_static = law->mu_static;
    memory->mu_kinetic = law->mu_kinetic;
    memory->critical_velocity = law->critical_velocity;
    if (!friction_start(source, memory, law, key, err)) return false;
    friction_make_memory(memory, law);
    return true;
}

static bool no_number(const void *context, const char *name, double *value)
{
    (void)context, (void)name, (void)value;
    return false;
}

// mu, and the rates of the states behind it. What has no state, and no pressure in it, is a law of
// speed alone.
static bool read_formulas(const FrictionSource *source, FrictionLaw *law, const char **key,
                          Error *err)
{
    const char *more[1 + STATES_MAX];
    FrictionMemory memory = {.kind = MEMORY_FORMULAS, .states = source->state_count, .factor = 1};
    FormulaNames names = {.look_up = source->look_up ? source->look_up : no_number,
                          .context = source->context,
                          .variable = "v",
                          .more = more,
                          .more_count = 1 + source->state_count,
                          .unknown = "is no number here: v, p, the states, and numbers that "
                                     "friction gives, such as mu_static or slip_distance"};
    *key = "state";
    if (source->state_count > STATES_MAX) return REFUSE(err, "at most %d states", STATES_MAX);
    for (int32_t k = 0; k < source->state_count; k++) more[k] = source->state[k].name;
    more[source->state_count] = "p";
    for (int32_t k = 0; k <= source->state_count; k++) {
        if (k == 0) *key = "formula";
        if (!formula_append(k == 0 ? source->formula : source->state[k - 1].rate, &names,
                            &memory.formula, err)) {
            if (k > 0) error_context(err, "%s, its rate", source->state[k - 1].name);
            return false;
        }
        *key = "state";
        memory.ends[k + 1] = memory.formula.count;
    }
    *key = "formula";
    memory.feels_pressure = formula_has(&memory.formula, 1 + memory.states);
    if (memory.states == 0 && !memory.feels_pressure) {
        law->own.formula = memory.formula;
        return true;
    }
    return make_own_memory(source, &memory, law, key, err);
}

static bool read_plugin(const FrictionSource *source, FrictionLaw *law, const char **key,
                        Error *err)
{
    FrictionMemory memory = {.kind = MEMORY_PLUGIN, .factor = 1, .feels_pressure = true};
    FrictionPlugin *plugin = &memory.plugin;
    AmontonsFriction *given = &plugin->given;
    *key = "file";
    if (source->parameter_count > AMONTONS_FRICTION_PARAMETERS_MAX)
        return REFUSE(err, "takes at most %d friction.parameters, not %d",
                      AMONTONS_FRICTION_PARAMETERS_MAX, source->parameter_count);
    *given = (AmontonsFriction){.mu_static = law->mu_static,
                                .mu_kinetic = law->mu_kinetic,
                                .critical_velocity = law->critical_velocity,
                                .parameter_count = source->parameter_count};
    for (int32_t k = 0; k < source->parameter_count; k++)
        given->parameters[k] = source->parameters[k];
    if (!source->trusted)
        return REFUSE(
            err,
            "%s is a program that would be run: give --trust (in Python trust=True) if you "
            "know where it comes from",
            source->file);
    if (!friction_plugin_open(source->file, plugin, err)) return false;
    law->own.plugin = *plugin;
    if (!plugin->rates) return true;
    memory.states = plugin->states(given);
    if (memory.states < 1 || memory.states > STATES_MAX)
        return REFUSE(err, "%s has %d states; allowed: 1 to %d", source->file, memory.states,
                      STATES_MAX);
    return make_own_memory(source, &memory, law, key, err);
}

bool friction_own_law(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    law->end = source->end;
    law->factor = 1;
    *key = "law";
    if (law->kind == FRICTION_TABLE) return read_table(source, law, key, err);
    if (law->kind == FRICTION_FORMULA) return read_formulas(source, law, key, err);
    return law->kind != FRICTION_PLUGIN || read_plugin(source, law, key, err);
}

void friction_make_memory(const FrictionMemory *memory, FrictionLaw *law)
{
    FrictionMemory *own = &law->own.memory;
    *own = *memory;
    if (own->factor == 0) own->factor = 1;
    if (memory->kind < MEMORY_FORMULAS) {   // built in
        own->states = 1;
        own->creeps = memory->kind == MEMORY_RATE_STATE;
    }
    law->remembers = true;
    law->mu_static = memory->mu_static;
    law->mu_kinetic = memory->mu_kinetic;
    law->critical_velocity = memory->critical_velocity;
    law->strengthens = own->creeps;
}
