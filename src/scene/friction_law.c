// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/friction_law.h"

#include "friction/friction_make.h"
#include "scene/friction_file.h"
#include "scene/materials.h"

#include <math.h>
#include <string.h>

// Numbers of the map `friction` that a formula may name, and their symbols.
static const char *const NUMBER_NAMES[][2] = {{"mu_static", "mu_S"},
                                              {"mu_kinetic", "mu_K"},
                                              {"critical_velocity", "v_c"},
#define X(number, symbol) {#number, symbol},
                                              FRICTION_NUMBERS(X)
#undef X
};
enum { NUMBERS = sizeof NUMBER_NAMES / sizeof NUMBER_NAMES[0] };

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
    const FrictionLaw *given = context;
#define X(number, symbol) given->number,
    const double values[NUMBERS] = {given->mu_static, given->mu_kinetic, given->critical_velocity,
                                    FRICTION_NUMBERS(X)};
#undef X
    int32_t k = scene_friction_number(name);
    *value = k < 0 ? 0 : values[k];
    return *value > 0;
}

double scene_nominal_pressure(const Scene *scene)
{
    return scene->load.force > 0 ? (double)NAN : scene->load.pressure;
}

bool scene_law_waits(const Scene *scene)
{
    return scene->friction.feels_pressure && isnan(scene_nominal_pressure(scene));
}

bool scene_friction_law(const Scene *scene, const char *formula, double pressure, FrictionLaw *law,
                        const char **key, Error *err)
{
    const SceneFrictionKeys *own = &scene->friction_keys;
#define X(number, symbol) law->number = own->number;
    FRICTION_NUMBERS(X)
#undef X
    law->slip_law = own->evolution == EVOLUTION_SLIP;
    FrictionLaw given = *law;   // a formula may name its numbers
    double velocity[FRICTION_POINTS_MAX], mu[FRICTION_POINTS_MAX];
    int32_t points = 0;
    if (law->kind == FRICTION_TABLE && *own->file) {
        FrictionData data;
        bool done = friction_data_read(scene, &data, err) &&
                    friction_data_points(scene, &data, velocity, mu, &points, err);
        friction_data_destroy(&data);
        if (!ERROR_AT(key, "file", done)) return false;
    }

    // The slip rate up to which the law is asked: friction.velocity_max, or the speed of sound, the
    // fastest of all regions.
    double fastest = sqrt(scene->material.young / scene->material.density);
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        double young = scene_material_number(scene, region, MATERIAL_YOUNG);
        double density = scene_material_number(scene, region, MATERIAL_DENSITY);
        fastest = fmax(fastest, sqrt(young / density));
    }
    if (own->velocity_max > 0) fastest = own->velocity_max;
    FrictionSource source = {.velocity = points > 0 ? velocity : own->velocity.value,
                             .velocity_count = points > 0 ? points : own->velocity.count,
                             .mu = points > 0 ? mu : own->mu.value,
                             .mu_count = points > 0 ? points : own->mu.count,
                             .straight = own->interpolation == INTERPOLATION_LINEAR,
                             .by_log = own->interpolation == INTERPOLATION_LOG,
                             .formula = formula,
                             .file = own->file,
                             .trusted = scene->trusted,
                             .look_up = find_number,
                             .context = &given,
                             .state = own->states.state,
                             .state_count = own->states.count,
                             .rod_velocity = scene->rod.velocity,
                             .rest = own->rest,
                             .pressure = pressure,
                             .parameters = own->parameters.value,
                             .parameter_count = own->parameters.count,
                             .end = fastest};
    return friction_make(&source, law, key, err);
}

bool scene_law_at(const Scene *scene, double pressure, FrictionLaw *law, const char **key,
                  Error *err)
{
    FrictionLaw plain = {.kind = scene->friction.kind,
                         .mu_static = scene->friction.mu_static,
                         .mu_kinetic = scene->friction.mu_kinetic,
                         .critical_velocity = scene->friction.critical_velocity};
    *law = scene->friction;
    if (!scene_law_waits(scene)) return true;
    *law = plain;
    return scene_friction_law(scene, scene->friction_keys.formula, pressure, law, key, err);
}
