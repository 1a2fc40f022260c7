// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/showing/quantity_label.h"

#include "scene/keys.h"

#include <stdio.h>
#include <string.h>

const char *label_last_word(const char *key)
{
    const char *dot = strrchr(key, '.');
    return dot ? dot + 1 : key;
}

QuantityLabel label_of_record(const char *name)
{
    static const struct {
        const char *name, *path, *label;
    } known[] = {
        {"mu_M", "results.mu_M", "~{\u03bc}_{M}"},
        {"mu_max", "results.mu_max", "largest ~{\u03bc}"},
        {"mu_hold", "results.mu_hold", "~{\u03bc}_{hold}"},
        {"first_mu", "results.peaks.0.mu", "first peak of ~{\u03bc}"},
        {"l_c", "results.l_c_over_L", "~{l}_{c} / ~{L}"},
        {"l_sc", "results.l_sc_over_L", "~{l}_{sc} / ~{L}"},
    };
    QuantityLabel label = {0};
    snprintf(label.words, QUANTITY_LABEL_SIZE, "%.80s", name);
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(name, known[k].name) == 0 || strcmp(name, known[k].path) == 0)
            snprintf(label.words, QUANTITY_LABEL_SIZE, "%s", known[k].label);
    return label;
}

QuantityLabel label_of_key(const char *name, bool is_si)
{
    static const struct {
        const char *dimension, *si, *normalised;
    } units[] = {{"length", "m", "~{L}_{0}"},
                 {"time", "s", "~{t}_{0}"},
                 {"velocity", "m/s", "(~{L}_{0} / ~{t}_{0})"},
                 {"stress", "Pa", "~{E}"},
                 {"density", "kg/m^{3}", NULL},
                 {"viscosity", "Pa s", NULL}};
    QuantityLabel label = {0};
    int32_t count = 0, index = scene_key_index(name);
    const SceneKey *keys = scene_keys(&count);
    snprintf(label.words, QUANTITY_LABEL_SIZE, "%.60s", label_last_word(name));
    if (index < 0 || keys[index].type != KEY_NUMBER) return label;
    for (size_t k = 0; k < sizeof units / sizeof units[0]; k++) {
        if (strcmp(keys[index].unit, units[k].dimension) != 0) continue;
        if (is_si)
            label.unit = units[k].si;
        else if (units[k].normalised)
            snprintf(label.words, QUANTITY_LABEL_SIZE, "%.60s / %s", label_last_word(name),
                     units[k].normalised);
    }
    return label;
}
