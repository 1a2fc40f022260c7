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

// Finds the words for a key on an axis, with its symbol. A key that is not in the list is called by
// its last word.
static void key_words(const char *name, char words[QUANTITY_LABEL_SIZE], bool *is_length)
{
    static const struct {
        const char *key, *words;
        bool is_length;   // of a mesh's parameter; of the others the table of keys knows
    } known[] = {{"load.pressure", "pressure ~{P}_{ext}", false},
                 {"rod.velocity", "rod velocity ~{V}", false},
                 {"rod.height", "rod height ~{h}", false},
                 {"friction.critical_velocity", "critical velocity ~{v}_{c}", false},
                 {"friction.mu_static", "static friction ~{\u03bc}_{S}", false},
                 {"friction.mu_kinetic", "kinetic friction ~{\u03bc}_{K}", false},
                 {"material.young", "Young's modulus ~{E}", false},
                 {"material.poisson", "Poisson's ratio ~{\u03bd}", false},
                 {"material.eta1", "shear viscosity ~{\u03b7}_{1}", false},
                 {"material.eta2", "viscosity ~{\u03b7}_{2}", false},
                 {"mesh.set.length", "length ~{L}", true},
                 {"mesh.set.height", "height ~{H}", true},
                 {"mesh.set.pad_height", "pad height", true}};
    bool of_mesh = strncmp(name, "mesh.set.", 9) == 0;
    const char *last = label_last_word(name);
    snprintf(words, QUANTITY_LABEL_SIZE, of_mesh ? "~{%.60s}" : "%.60s", last);
    *is_length = false;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(name, known[k].key) != 0) continue;
        snprintf(words, QUANTITY_LABEL_SIZE, "%s", known[k].words);
        *is_length = known[k].is_length;
    }
}

void label_symbol(const char *key, char *symbol, size_t size)
{
    char words[QUANTITY_LABEL_SIZE];
    bool is_length = false;
    key_words(key, words, &is_length);
    const char *mark = strstr(words, "~{");
    bool known = mark && mark > words;   // of a mesh's parameter only the name is
    snprintf(symbol, size, "%.60s", known ? mark : label_last_word(key));
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
    char words[QUANTITY_LABEL_SIZE];
    bool is_length = false;
    key_words(name, words, &is_length);
    snprintf(label.words, QUANTITY_LABEL_SIZE, "%s", words);
    bool has_unit = index >= 0 && keys[index].type == KEY_NUMBER;
    if (!is_length && !has_unit) return label;
    const char *unit = is_length ? "length" : keys[index].unit;
    for (size_t k = 0; k < sizeof units / sizeof units[0]; k++) {
        if (strcmp(unit, units[k].dimension) != 0) continue;
        if (is_si)
            label.unit = units[k].si;
        else if (units[k].normalised)
            snprintf(label.words, QUANTITY_LABEL_SIZE, "%.60s / %s", words, units[k].normalised);
    }
    return label;
}
