// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/extremes.h"

#include <math.h>
#include <stdio.h>

// Below this a quotient is nothing unusual, and what failed is not its fault.
static const double USUAL = 1e4;

typedef struct Extreme {
    const char *key, *what;
    double quotient;
} Extreme;

static void compare(Extreme *extreme, const char *key, const char *what, double quotient)
{
    if (quotient > extreme->quotient) *extreme = (Extreme){key, what, quotient};
}

bool model_blame_extremes(Model *model, Error *err)
{
    // The largest quotient of numbers of the scene, by its key.
    Extreme largest = {"reduction.use", "", USUAL};
    const Materials *materials = &model->materials;
    bool regions = model->scene->materials.count > 0;
    double softest = INFINITY, stiffest = 0;
    for (int32_t k = 0; k < materials->count; k++) {
        const Material *one = &materials->list[k];
        double viscosities = one->eta1 / one->eta2;
        if (one->plane_strain)
            compare(&largest, regions ? "materials" : "material.poisson",
                    "stiffness of volume over that of shear in plane strain",
                    2 * (1 - one->poisson) / (1 - 2 * one->poisson));
        compare(&largest, regions ? "materials" : "material.eta2", "one viscosity over the other",
                fmax(viscosities, 1 / viscosities));
        softest = fmin(softest, one->young);
        stiffest = fmax(stiffest, one->young);
    }
    double slender = model->height / model->length;
    compare(&largest, "materials", "Young's modulus of one region over another's",
            stiffest / softest);
    bool given = model->scene->mesh.parameter_count > 0;
    compare(&largest, given ? "mesh.set" : "mesh.file", "one side of the block over the other",
            fmax(slender, 1 / slender));

    if (err->code != ERROR_COMPUTE && err->code != ERROR_LIBRARY) return false;
    if (largest.quotient > USUAL)
        snprintf(model->not_reduced, NOT_REDUCED_SIZE,
                 "%s is %.3g, too much for the rounding of a reduction", largest.what,
                 largest.quotient);
    else
        snprintf(model->not_reduced, NOT_REDUCED_SIZE, "%.*s", NOT_REDUCED_SIZE - 1, err->message);
    if (model->scene->reduction.use == REDUCE_AUTO) {
        error_clear(err);
        return true;
    }
    if (largest.quotient > USUAL)
        error_context(err, "%s (reduction.use: auto steps on the whole mesh)", model->not_reduced);
    else
        error_context(err, "reduction.use: auto steps on the whole mesh");
    err->code = ERROR_INPUT;
    return scene_blame(model->scene, largest.key, false, err);
}
