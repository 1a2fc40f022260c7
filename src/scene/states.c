// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/states.h"

#include "scene/own_law.h"

#include <ctype.h>
#include <string.h>

// Of scene/own_law, and what a formula has without it.
static bool is_taken(const char *name)
{
    static const char *const taken[] = {"v",     "p",   "sqrt", "exp", "log",   "tanh",
                                        "asinh", "abs", "min",  "max", "round", "points"};
    for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
        if (strcmp(name, taken[k]) == 0) return true;
    return false;
}

static bool is_name(const char *name)
{
    if (!isalpha((unsigned char)*name) || strlen(name) >= STATE_NAME_SIZE) return false;
    for (; *name; name++)
        if (!isalnum((unsigned char)*name) && *name != '_') return false;
    return true;
}

static bool set_part(const SceneValue *value, FrictionStateText *state, Error *err)
{
    const char *part = yaml_key(value->document, value->node);
    const char *text = yaml_text(value->document, value->node);
    bool rate = strcmp(part, "rate") == 0;
    if (!rate && strcmp(part, "start") != 0)
        return yaml_key_error(value->document, value->node, err,
                              "friction.state.%s: unknown key `%.60s`; allowed: rate, start",
                              state->name, part);
    bool scalar = yaml_kind(value->document, value->node) == YAML_SCALAR;
    if (!scalar || !*text || strlen(text) >= STATE_TEXT_SIZE)
        return yaml_refuse(value->document, value->node, "friction.state",
                           "a formula of at most 511 bytes", err);
    memcpy(rate ? state->rate : state->start, text, strlen(text) + 1);
    return true;
}

static bool add_state(const SceneValue *value, SceneStates *states, Error *err)
{
    const YamlDocument *document = value->document;
    const char *name = yaml_key(document, value->node);
    FrictionStateText *state = &states->state[states->count];
    *state = (FrictionStateText){0};
    if (!is_name(name) || is_taken(name) || scene_friction_number(name) >= 0)
        return yaml_key_error(document, value->node, err,
                              "friction.state: `%.40s` cannot be the name of a state; allowed: "
                              "letters, digits and _, at most 31, and not v, p, a function or a "
                              "number of friction (mu_S, D_c, a, b, ...)",
                              name);
    memcpy(state->name, name, strlen(name) + 1);
    if (yaml_kind(document, value->node) != YAML_MAP)
        return yaml_refuse(document, value->node, "friction.state",
                           "a map {rate: FORMULA, start: FORMULA}", err);
    YAML_EACH (part, document, value->node) {
        SceneValue one = {.document = document, .node = part};
        if (!set_part(&one, state, err)) return false;
    }
    states->count++;
    return *state->rate || yaml_key_error(document, value->node, err,
                                          "friction.state: `%s` needs its `rate`", name);
}

bool scene_states_set(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    char allowed[160];
    SceneStates *states = &scene->own_friction.states;
    const YamlDocument *document = value->document;
    scene_key_allowed(key, allowed, sizeof allowed);
    if (yaml_kind(document, value->node) != YAML_MAP ||
        yaml_count(document, value->node) > STATES_MAX)
        return yaml_refuse(document, value->node, key->name, allowed, err);
    *states = (SceneStates){0};
    YAML_EACH (item, document, value->node) {
        SceneValue one = {.document = document, .node = item};
        if (!add_state(&one, states, err)) return false;
    }
    return true;
}
