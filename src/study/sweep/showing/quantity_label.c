// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/showing/quantity_label.h"

#include "scene/items.h"
#include "scene/keys.h"

#include <stdio.h>
#include <string.h>

const char *label_last_word(const char *key)
{
    const char *dot = strrchr(key, '.');
    return dot ? dot + 1 : key;
}

QuantityLabel quantity_label(const char *name, bool is_si)
{
    static const struct {
        const char *name, *path, *words;   // path: of a result, in run.json
    } known[] = {
        {"mu_M", "results.mu_M", "~{\u03bc}_{M}"},
        {"mu_max", "results.mu_max", "largest ~{\u03bc}"},
        {"mu_hold", "results.mu_hold", "~{\u03bc}_{hold}"},
        {"first_mu", "results.peaks.0.mu", "first peak of ~{\u03bc}"},
        {"l_c", "results.l_c_over_L", "~{l}_{c} / ~{L}"},
        {"l_sc", "results.l_sc_over_L", "~{l}_{sc} / ~{L}"},
        {"load.pressure", "", "pressure ~{P}_{ext}"},
        {"rod.velocity", "", "rod velocity ~{V}"},
        {"rod.height", "", "rod height ~{h}"},
        {"friction.critical_velocity", "", "critical velocity ~{v}_{c}"},
        {"friction.mu_static", "", "static friction ~{\u03bc}_{S}"},
        {"friction.mu_kinetic", "", "kinetic friction ~{\u03bc}_{K}"},
        {"material.young", "", "Young's modulus ~{E}"},
        {"material.poisson", "", "Poisson's ratio ~{\u03bd}"},
        {"material.eta1", "", "shear viscosity ~{\u03b7}_{1}"},
        {"material.eta2", "", "viscosity ~{\u03b7}_{2}"},
        {"mesh.set.length", "", "length ~{L}"},
        {"mesh.set.height", "", "height ~{H}"},
        {"mesh.set.pad_height", "", "pad height"},
    };
    static const struct {
        const char *dimension, *si, *normalised;
    } units[] = {{"length", "m", "~{L}_{0}"},
                 {"time", "s", "~{t}_{0}"},
                 {"velocity", "m/s", "(~{L}_{0} / ~{t}_{0})"},
                 {"stress", "Pa", "~{E}"},
                 {"density", "kg/m^{3}", NULL},
                 {"viscosity", "Pa s", NULL}};
    QuantityLabel label = {0};
    const char *part, *total, *dimension = scene_dimension(name, &total), *words = NULL;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(name, known[k].name) == 0 || strcmp(name, known[k].path) == 0)
            words = known[k].words;

    // A result without a row is its whole name, a key its last word. A parameter of a mesh without
    // a row may be a number of cells: it has no unit.
    bool is_key = scene_key_index(name) >= 0 || scene_key_above(name, &part) >= 0;
    bool of_mesh = strncmp(name, "mesh.set.", 9) == 0;
    if (of_mesh && !words) dimension = NULL;
    snprintf(label.words, sizeof label.words, of_mesh && !words ? "~{%.60s}" : "%.80s",
             words    ? words
             : is_key ? label_last_word(name)
                      : name);
    for (size_t k = 0; dimension && k < sizeof units / sizeof units[0]; k++) {
        if (strcmp(dimension, units[k].dimension) != 0) continue;
        size_t used = strlen(label.words);
        if (is_si)
            label.unit = units[k].si;
        else if (units[k].normalised)
            snprintf(label.words + used, sizeof label.words - used, " / %s", units[k].normalised);
    }
    return label;
}
