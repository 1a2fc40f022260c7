// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/own_law.h"

#include "contact/friction_look.h"
#include "contact/friction_make.h"
#include "contact/friction_state.h"
#include "scene/materials.h"

#include <math.h>

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

static const MemoryKind MEMORIES[] = {[FRICTION_AGEING] = MEMORY_AGEING,
                                      [FRICTION_SLIP_WEAKENING] = MEMORY_SLIP_WEAKENING,
                                      [FRICTION_RATE_STATE] = MEMORY_RATE_STATE};

// What measures things where nothing holds at rest and nothing ends: mu of steady slip at the
// slowest rate that the start knows of, plus what it has rested beyond that, and at that of sound.
static void set_scales(const Scene *scene, FrictionMemory *memory)
{
    double fastest = scene_fastest_slip(scene);
    double weakens = memory->healing - memory->direct;
    double fast = log(fmax(fastest / memory->reference_velocity, 1));
    memory->critical_velocity = memory->reference_velocity;
    memory->mu_static = memory->reference + fmax(memory->healing * memory->start, 0);
    memory->mu_kinetic = fmax(memory->reference - fmax(weakens, 0) * fast, 0);
}

bool scene_remember(const Scene *scene, FrictionLaw *law, const char **key, Error *err)
{
    const SceneOwnFriction *own = &scene->own_friction;
    if (!friction_remembers(law, 0)) return true;
    bool creeps = law->kind == FRICTION_RATE_STATE;
    FrictionMemory memory = {.kind = MEMORIES[law->kind],
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
    *key = "rest";
    if (!(own->rest > 0) && !(scene->rod.velocity > 0))
        FAIL(err, ERROR_INPUT,
             "missing: without a rod that moves nothing says what the contacts remember; allowed: "
             "a number > 0");
    memory.start = own->rest > 0 ? memory_rested(&memory, own->rest)
                                 : memory_steady(&memory, scene->rod.velocity);
    if (creeps) set_scales(scene, &memory);
    if (law->kind == FRICTION_SLIP_WEAKENING)
        memory.critical_velocity = memory.slip_distance / memory.healing_time;
    friction_make_memory(&memory, law);
cleanup:
    return error_is_clean(err);
}

bool scene_own_law(Scene *scene, const char **key, Error *err)
{
    *key = "law";
    if (!friction_is_own(&scene->friction))
        return scene_remember(scene, &scene->friction, key, err);
    const SceneNumbers *velocity = &scene->own_friction.velocity, *mu = &scene->own_friction.mu;
    FrictionSource source = {.velocity = velocity->value,
                             .velocity_count = velocity->count,
                             .mu = mu->value,
                             .mu_count = mu->count,
                             .straight = scene->own_friction.interpolation == INTERPOLATION_LINEAR,
                             .formula = scene->own_friction.formula,
                             .file = scene->own_friction.file,
                             .parameters = scene->own_friction.parameters.value,
                             .parameter_count = scene->own_friction.parameters.count,
                             .end = scene_fastest_slip(scene)};
    return friction_own_law(&source, &scene->friction, key, err) &&
           friction_look(&scene->friction, err);
}
