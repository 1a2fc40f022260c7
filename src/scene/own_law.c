// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/own_law.h"

#include "friction/friction_look.h"
#include "friction/friction_make.h"
#include "friction/friction_state.h"
#include "scene/materials.h"

#include <math.h>
#include <string.h>

// The speed of sound, the fastest of all regions.
double scene_fastest_slip(const Scene *scene)
{
    double given = scene->own_friction.velocity_max;
    double fastest = sqrt(scene->material.young / scene->material.density);
    if (given > 0) return given;
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        double young = scene_material_number(scene, region, MATERIAL_YOUNG);
        double density = scene_material_number(scene, region, MATERIAL_DENSITY);
        fastest = fmax(fastest, sqrt(young / density));
    }
    return fastest;
}

// Scales for a law without a coefficient at rest and without a limit velocity: mu at the reference
// velocity, raised by the healing that the contacts have at the start, and mu of steady slip at the
// fastest slip rate.
static void set_scales(const Scene *scene, FrictionMemory *memory)
{
    double fastest = scene_fastest_slip(scene);
    double weakens = memory->healing - memory->direct;
    double fast = log(fmax(fastest / memory->reference_velocity, 1));
    memory->critical_velocity = memory->reference_velocity;
    memory->mu_static = memory->reference + fmax(memory->healing * memory->start[0], 0);
    memory->mu_kinetic = fmax(memory->reference - fmax(weakens, 0) * fast, 0);
}

bool scene_remember(const Scene *scene, FrictionLaw *law, const char **key, Error *err)
{
    const SceneOwnFriction *own = &scene->own_friction;
    bool creeps = law->kind == FRICTION_RATE_STATE;
    FrictionMemory memory = {.kind = friction_memory_kind(law->kind),
                             .mu_static = law->mu_static,
                             .mu_kinetic = law->mu_kinetic,
                             .critical_velocity = law->critical_velocity,
                             .slip_distance = own->slip_distance,
                             .healing_time = own->healing_time,
                             .healing = creeps ? own->evolution_effect : own->healing,
                             .direct = own->direct_effect,
                             .reference = own->mu_reference,
                             .reference_velocity = own->reference_velocity,
                             .slip_law = creeps && own->evolution == EVOLUTION_SLIP};
    if (memory.kind == MEMORY_FORMULAS) return true;
    *key = "rest";
    if (!(own->rest > 0) && !(scene->rod.velocity > 0))
        return REFUSE(err, "missing: without a rod that moves nothing says what the contacts "
                           "remember; allowed: a number > 0");
    memory.start[0] = own->rest > 0 ? memory_rested(&memory, own->rest)
                                    : memory_steady(&memory, scene->rod.velocity);
    if (creeps) set_scales(scene, &memory);
    if (law->kind == FRICTION_SLIP_WEAKENING)
        memory.critical_velocity = memory.slip_distance / memory.healing_time;
    friction_make_memory(&memory, law);
    return true;
}

// Numbers of the map `friction` that a formula may name, and their symbols.
enum { NUMBERS = 10 };
static const char *const NUMBER_NAMES[NUMBERS][2] = {
    {"mu_static", "mu_S"},        {"mu_kinetic", "mu_K"},      {"critical_velocity", "v_c"},
    {"slip_distance", "D_c"},     {"healing_time", "theta_0"}, {"healing", "beta"},
    {"direct_effect", "a"},       {"evolution_effect", "b"},   {"mu_reference", "f_0"},
    {"reference_velocity", "V_0"}};

int32_t scene_friction_number(const char *name)
{
    int32_t k = 0;
    while (k < NUMBERS && strcmp(name, NUMBER_NAMES[k][0]) != 0 &&
           strcmp(name, NUMBER_NAMES[k][1]) != 0)
        k++;
    return k < NUMBERS ? k : -1;
}

static bool find_number(const void *context, const char *name, double *value)
{
    const SceneNumbersOf *of = context;
    const FrictionLaw *law = of->law;
    const SceneOwnFriction *own = &of->scene->own_friction;
    const double values[NUMBERS] = {
        law->mu_static,    law->mu_kinetic,        law->critical_velocity, own->slip_distance,
        own->healing_time, own->healing,           own->direct_effect,     own->evolution_effect,
        own->mu_reference, own->reference_velocity};
    int32_t k = scene_friction_number(name);
    *value = k < 0 ? 0 : values[k];
    return *value > 0;
}

FrictionSource scene_friction_source(const SceneNumbersOf *of)
{
    const Scene *scene = of->scene;
    const SceneOwnFriction *own = &scene->own_friction;
    return (FrictionSource){.velocity = own->velocity.value,
                            .velocity_count = own->velocity.count,
                            .mu = own->mu.value,
                            .mu_count = own->mu.count,
                            .straight = own->interpolation == INTERPOLATION_LINEAR,
                            .formula = own->formula,
                            .file = own->file,
                            .trusted = scene->trusted,
                            .look_up = find_number,
                            .context = of,
                            .state = own->states.state,
                            .state_count = own->states.count,
                            .rod_velocity = scene->rod.velocity,
                            .rest = own->rest,
                            .pressure = scene->load.pressure,
                            .slip_distance = own->slip_distance,
                            .parameters = own->parameters.value,
                            .parameter_count = own->parameters.count,
                            .end = scene_fastest_slip(scene)};
}

bool scene_own_law(Scene *scene, const char **key, Error *err)
{
    *key = "law";
    if (!friction_is_own(&scene->friction))
        return scene_remember(scene, &scene->friction, key, err);
    FrictionLaw given = scene->friction;
    SceneNumbersOf of = {.scene = scene, .law = &given};
    FrictionSource source = scene_friction_source(&of);
    return friction_own_law(&source, &scene->friction, key, err) &&
           friction_look(&scene->friction, err);
}
