// SPDX-License-Identifier: GPL-2.0-or-later
// An item's values are set, by their keys of the map `friction`, in a copy of the scene: units,
// ranges and messages are those of these keys.
#include "scene/contact_laws.h"

#include "base/memory.h"
#include "friction/friction_look.h"
#include "friction/friction_make.h"
#include "friction/friction_state.h"
#include "scene/own_law.h"

#include <stdio.h>
#include <string.h>

// Of the item at `node`.
static bool copy_word(const SceneValue *value, char *out, size_t size, Error *err)
{
    const char *text = yaml_text(value->document, value->node);
    if (!*text || strlen(text) >= size)
        return yaml_refuse(value->document, value->node, "friction.contacts", "a text", err);
    memcpy(memset(out, 0, size), text, strlen(text) + 1);
    return true;
}

static bool set_part(const SceneValue *value, Scene *own, SceneContactLaw *item, Error *err)
{
    static const char *const words[] = {"law", "mu_static", "mu_kinetic", "critical_velocity",
                                        "formula"};
    const char *name = yaml_key(value->document, value->node);
    bool *given[] = {&item->has_law, &item->has_static, &item->has_kinetic, &item->has_critical,
                     NULL};
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    char key[40];
    if (strcmp(name, "group") == 0) return copy_word(value, item->group, GROUP_NAME_SIZE, err);
    if (strcmp(name, "along") == 0) return copy_word(value, item->along, SCENE_TEXT_SIZE, err);
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        if (strcmp(name, words[k]) != 0) continue;
        if (!given[k] && !copy_word(value, item->formula, SCENE_TEXT_SIZE, err)) return false;
        if (given[k]) *given[k] = true;
        snprintf(key, sizeof key, "friction.%s", name);
        return scene_value_set(&keys[scene_key_index(key)], value, own, err);
    }
    return yaml_key_error(value->document, value->node, err,
                          "friction.contacts: unknown key `%.60s`; allowed: group, law, mu_static, "
                          "mu_kinetic, critical_velocity, formula, along",
                          name);
}

// What is not the scene's law must be one of the built-in laws, or a formula of its own.
static bool check_item(const SceneContactLaw *item, const FrictionLaw *scene_law,
                       const FrictionLaw *law, Error *err)
{
    bool own = friction_is_own(law), formula = friction_use(law, "formula") == FRICTION_MUST;
    bool creeps = law->kind == FRICTION_RATE_STATE;
    if (friction_use(law, "slip_distance") == FRICTION_MUST && law->kind != scene_law->kind)
        return REFUSE(err,
                      "`%s` takes numbers that friction gives, so friction.law has to be the same",
                      friction_law_name(law));
    if (creeps && (item->has_static || item->has_kinetic || item->has_critical))
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
    return true;
}

bool scene_contact_law(const Scene *scene, const SceneContactLaw *item, FrictionLaw *law,
                       Error *err)
{
    bool numbers = item->has_static || item->has_kinetic || item->has_critical;
    FrictionLaw given = {.mu_static = item->mu_static,
                         .mu_kinetic = item->mu_kinetic,
                         .critical_velocity = item->critical_velocity};
    SceneNumbersOf of = {.scene = scene, .law = &given};
    FrictionSource source = scene_friction_source(&of);
    source.formula = item->formula;
    const char *key = NULL;
    *law = scene->friction;
    if (!item->has_law && !numbers && !*item->formula) return true;
    *law = (FrictionLaw){.kind = item->kind,
                         .mu_static = item->mu_static,
                         .mu_kinetic = item->mu_kinetic,
                         .critical_velocity = item->critical_velocity};
    if (!friction_has_drop(law)) law->mu_kinetic = law->mu_static;
    return check_item(item, &scene->friction, law, err) &&
           (!friction_is_own(law) ||
            (friction_own_law(&source, law, &key, err) && friction_look(law, err))) &&
           scene_remember(scene, law, &key, err);
}

static bool read_item(const SceneValue *value, const Scene *scene, Scene *own,
                      SceneContactLaw *item, Error *err)
{
    const YamlDocument *document = value->document;
    if (yaml_kind(document, value->node) != YAML_MAP)
        return yaml_refuse(document, value->node, "friction.contacts", "a map {group: NAME, ...}",
                           err);
    *own = *scene;
    YAML_EACH (part, document, value->node) {
        // Numbers of another formula are not those of the scene's law.
        if (strcmp(yaml_key(document, part), "formula") == 0)
            own->friction.mu_static = own->friction.mu_kinetic = own->friction.critical_velocity =
                0;
    }
    YAML_EACH (part, document, value->node) {
        SceneValue one = {.document = document, .node = part};
        if (!set_part(&one, own, item, err)) return false;
    }
    FrictionLaw law;
    item->kind = own->friction.kind;
    item->mu_static = own->friction.mu_static;
    item->mu_kinetic = own->friction.mu_kinetic;
    item->critical_velocity = own->friction.critical_velocity;
    Error found = {0};
    if (!*item->group)
        return yaml_error(document, value->node, err,
                          "friction.contacts: an item needs its `group`");
    return scene_contact_law(scene, item, &law, &found) ||
           yaml_error(document, value->node, err, "friction.contacts: %s: %s", item->group,
                      found.message);
}

bool scene_contact_laws(const SceneValue *value, Scene *scene, Error *err)
{
    SceneContactLaws *laws = &scene->contact_laws;
    Scene *own = NULL;
    laws->count = 0;
    if (!value->document) return true;
    TRY((own = NEW_ARRAY(Scene, 1, err)));
    YAML_EACH (node, value->document, value->node) {
        SceneValue one = {.document = value->document, .node = node};
        SceneContactLaw *item = &laws->item[laws->count];
        if (laws->count == SCENE_CONTACT_LAWS_MAX) {
            yaml_error(value->document, node, err, "friction.contacts: at most %d items",
                       SCENE_CONTACT_LAWS_MAX);
            goto cleanup;
        }
        *item = (SceneContactLaw){0};
        TRY(read_item(&one, scene, own, item, err));
        for (int32_t k = 0; k < laws->count; k++) {
            if (strcmp(laws->item[k].group, item->group) != 0) continue;
            yaml_error(
                value->document, node, err,
                "friction.contacts: the group `%s` is named twice: by item %d and by item %d",
                item->group, k + 1, laws->count + 1);
            goto cleanup;
        }
        laws->count++;
    }
cleanup:
    memory_free(own);
    return error_is_clean(err);
}
