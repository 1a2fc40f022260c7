// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/contact_laws.h"

#include "friction/friction_make.h"
#include "scene/friction_law.h"

#include <string.h>

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
