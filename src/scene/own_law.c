// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/own_law.h"

#include "contact/friction_look.h"
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

bool scene_own_law(Scene *scene, const char **key, Error *err)
{
    *key = "law";
    if (!friction_is_own(&scene->friction)) return true;
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
