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

// --- the items of friction.contacts -------------------------------------------------------------

bool scene_has_contact_law(const SceneContactLaw *item)
{
    return item->has_law || item->has_static || item->has_kinetic || item->has_critical ||
           *item->formula;
}

bool scene_contact_law(const Scene *scene, const SceneContactLaw *item, double pressure,
                       FrictionLaw *law, Error *err)
{
    const char *key = NULL;
    *law = scene->friction;
    if (!scene_has_contact_law(item)) return true;
    *law = (FrictionLaw){.kind = item->kind,
                         .mu_static = item->mu_static,
                         .mu_kinetic = item->mu_kinetic,
                         .critical_velocity = item->critical_velocity};
    if (!friction_has_drop(law)) law->mu_kinetic = law->mu_static;

    // A law that is not the scene's law must be one of the built-in laws, or a formula of its own.
    bool own = friction_is_own(law), formula = friction_use(law, "formula") == FRICTION_MUST;
    bool has_numbers = friction_use(law, "mu_static") != FRICTION_UNUSED;
    if (friction_use(law, "slip_distance") == FRICTION_MUST && law->kind != scene->friction.kind)
        return REFUSE(err,
                      "`%s` takes numbers that friction gives, so friction.law has to be the same",
                      friction_law_name(law));
    if (!has_numbers && (item->has_static || item->has_kinetic || item->has_critical))
        return REFUSE(err, "`%s` can be scaled here (along), or replaced by another law",
                      friction_law_name(law));
    if (own && !formula)
        return REFUSE(err,
                      "a %s is for the whole contact; here it can be scaled (along), or replaced "
                      "by another law",
                      friction_law_name(law));
    if (formula != (*item->formula != 0))
        return REFUSE(err, "the law `%s` %s a formula", friction_law_name(law),
                      formula ? "needs" : "does not read");
    if (!own && law->mu_kinetic > law->mu_static)
        return REFUSE(err, "mu_kinetic: %g is more than mu_static (%g)", law->mu_kinetic,
                      law->mu_static);
    bool fades = friction_use(law, "critical_velocity") == FRICTION_MUST;
    if (!own && fades && !(law->critical_velocity > 0))
        return REFUSE(err, "critical_velocity: a weakening law needs it");
    return scene_friction_law(scene, item->formula, pressure, law, &key, err);
}

bool scene_contact_laws(const SceneValue *value, Scene *scene, Error *err)
{
    SceneContactLaw *item = scene->contact_laws.item, *first = item;
    if (!value->document) return true;
    YAML_EACH (node, value->document, value->node) {
        FrictionLaw law;
        Error found = {0};

        // Numbers that the item does not give are those of the scene; for another formula they are
        // 0, as the numbers of the scene's law do not belong to it.
        const FrictionLaw *general = &scene->friction;
        bool formula = *item->formula != 0;
        if (!item->has_law) item->kind = general->kind;
        if (!item->has_static) item->mu_static = formula ? 0 : general->mu_static;
        if (!item->has_kinetic) item->mu_kinetic = formula ? 0 : general->mu_kinetic;
        if (!item->has_critical) item->critical_velocity = formula ? 0 : general->critical_velocity;
        if (!scene_contact_law(scene, item, scene_nominal_pressure(scene), &law, &found))
            return yaml_error(value->document, node, err, "friction.contacts: %s: %s", item->group,
                              found.message);
        for (const SceneContactLaw *other = first; other < item; other++)
            if (strcmp(other->group, item->group) == 0)
                return yaml_error(
                    value->document, node, err,
                    "friction.contacts: the group `%s` is named twice: by item %d and by item %d",
                    item->group, (int)(other - first) + 1, (int)(item - first) + 1);
        item++;
    }
    return true;
}
