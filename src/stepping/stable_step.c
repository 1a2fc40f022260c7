// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/stable_step.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

// Keeps steps away from the limit itself, where the fastest mode would grow linearly.
static const double SAFETY = 0.98;

// The circles are those of M^-1/2 A M^-1/2, which has the same eigenvalues.
double rate_bound(const Bulk *bulk, const double *values)
{
    const SparsePattern *pattern = &bulk->pattern;
    double largest = 0;
    for (int32_t row = 0; row < bulk->dof_count; row++) {
        double sum = 0;
        for (int32_t k = pattern->start[row]; k < pattern->start[row + 1]; k++)
            sum += fabs(values[k]) / sqrt(bulk->mass[row] * bulk->mass[pattern->index[k]]);
        largest = fmax(largest, sum);
    }
    return largest;
}

bool stable_step(const Bulk *bulk, double *step, Error *err)
{
    double *at_once = NULL;
    const Spectrum *spectrum = &bulk->spectrum;
    const double *stiffest = bulk->stiffness;
    int64_t entries = bulk->pattern.start[bulk->dof_count];
    *step = 0;
    if (spectrum->count > 0) {   // K and all branches, as they are at once
        TRY((at_once = NEW_ARRAY(double, entries, err)));
        memcpy(at_once, bulk->stiffness, (size_t)entries * sizeof *at_once);
        stiffest = at_once;
    }
    for (int32_t j = 0; j < spectrum->shape_count; j++)
        for (int32_t k = 0; k < spectrum->count; k++)
            for (int64_t i = 0; spectrum->share[k][j] != 0 && i < entries; i++)
                at_once[i] += spectrum->share[k][j] *
                              (j < spectrum->matrix_count ? bulk->shape[j] : bulk->stiffness)[i];
    double viscous = rate_bound(bulk, bulk->damping), elastic = rate_bound(bulk, stiffest);
    *step = SAFETY * 4 / (viscous + sqrt(viscous * viscous + 4 * elastic));
    if (!(*step > 0 && isfinite(*step)))
        FAIL(err, ERROR_COMPUTE, "no stable explicit step: the largest rates are %g and %g",
             viscous, sqrt(elastic));
cleanup:
    memory_free(at_once);
    return error_is_clean(err);
}
