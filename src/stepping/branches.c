// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/branches.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

bool branches_create(const BulkOperator *system, Branches *branches, Error *err)
{
    const Spectrum *spectrum = bulk_operator_spectrum(system);
    int64_t size = (int64_t)(SDIRK_STAGES - 1) * spectrum->count * system->dof_count;
    *branches = (Branches){.system = system, .spectrum = spectrum};
    branches->stretch_rate = NEW_ARRAY(double, size, err);
    branches->pull_rate = NEW_ARRAY(double, size, err);
    branches->image = NEW_ARRAY(double, (int64_t)spectrum->shape_count * system->dof_count, err);
    branches->work = NEW_ARRAY(double, spectrum->count > 0 ? system->dof_count : 0, err);
    return error_is_clean(err);
}

void branches_destroy(Branches *branches)
{
    memory_free_all(branches->stretch_rate, branches->pull_rate, branches->image, branches->work);
    *branches = (Branches){0};
}

// Offset of the rates of branch k in stage i.
static int64_t rate_at(const Branches *branches, int32_t i, int32_t k)
{
    return ((int64_t)i * branches->spectrum->count + k) * branches->system->dof_count;
}

void branches_start_stage(const Branches *branches, double step, int32_t i, const State *from,
                          State *to, double *restrict rhs)
{
    int32_t dofs = branches->system->dof_count;
    for (int32_t k = 0; k < branches->spectrum->count; k++) {
        int64_t at = (int64_t)k * dofs;
        double *restrict stretch = to->stretch + at, *restrict pull = to->pull + at;
        double left = 1 / (1 + SDIRK2.gamma * step / branches->spectrum->time[k]);
        memcpy(stretch, from->stretch + at, (size_t)dofs * sizeof *stretch);
        memcpy(pull, from->pull + at, (size_t)dofs * sizeof *pull);
        for (int32_t j = 0; j < i; j++) {
            double weight = step * SDIRK2.a[i][j];
            const double *restrict stretch_rate = branches->stretch_rate + rate_at(branches, j, k);
            const double *restrict pull_rate = branches->pull_rate + rate_at(branches, j, k);
            for (int32_t d = 0; d < dofs; d++) {
                stretch[d] += weight * stretch_rate[d];
                pull[d] += weight * pull_rate[d];
            }
        }
        for (int32_t d = 0; d < dofs; d++) rhs[d] -= left * pull[d];
    }
}

double branches_end_stage(Branches *branches, double step, int32_t i,
                          const double *restrict velocity, const double *elastic, State *to,
                          double *restrict force, double *dissipated)
{
    const BulkOperator *system = branches->system;
    const Spectrum *spectrum = branches->spectrum;
    int32_t dofs = system->dof_count;
    double scaled = SDIRK2.gamma * step, power = 0;
    double weight = step * SDIRK2.a[SDIRK_STAGES - 1][i];
    bool last = i + 1 == SDIRK_STAGES;
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        double *image = branches->image + (int64_t)j * dofs;
        if (j < spectrum->matrix_count)
            bulk_operator_apply(system, bulk_shape(j), velocity, image);
        else
            memcpy(image, elastic, (size_t)dofs * sizeof *image);
    }
    for (int32_t k = 0; k < spectrum->count; k++) {
        double left = 1 / (1 + scaled / spectrum->time[k]), rate = 1 / spectrum->time[k];
        double *restrict stretch = to->stretch + (int64_t)k * dofs;
        double *restrict pull = to->pull + (int64_t)k * dofs, *restrict image = branches->work;

        // image := K_k v of the S_j v.
        memset(image, 0, (size_t)dofs * sizeof *image);
        for (int32_t j = 0; j < spectrum->shape_count; j++) {
            double share = spectrum->share[k][j];
            const double *restrict one = branches->image + (int64_t)j * dofs;
            if (share == 0) continue;
            for (int32_t d = 0; d < dofs; d++) image[d] += share * one[d];
        }

        for (int32_t d = 0; d < dofs; d++) {
            force[d] -= scaled * left * image[d];
            stretch[d] = left * (stretch[d] + scaled * velocity[d]);
            pull[d] = left * (pull[d] + scaled * image[d]);
        }
        double own = rate * dense_dot(stretch, pull, dofs);
        power += own;
        dissipated[k] += weight * own;
        if (last) continue;
        double *restrict stretch_rate = branches->stretch_rate + rate_at(branches, i, k);
        double *restrict pull_rate = branches->pull_rate + rate_at(branches, i, k);
        for (int32_t d = 0; d < dofs; d++) {
            stretch_rate[d] = velocity[d] - rate * stretch[d];
            pull_rate[d] = image[d] - rate * pull[d];
        }
    }
    return power;
}

void branches_add_force(Branches *branches, const State *state, double *force)
{
    const Spectrum *spectrum = branches->spectrum;
    int32_t dofs = branches->system->dof_count;
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        double *sum = branches->work;
        memset(sum, 0, (size_t)dofs * sizeof *sum);
        for (int32_t k = 0; k < spectrum->count; k++)
            for (int32_t d = 0; d < dofs; d++)
                sum[d] += spectrum->share[k][j] * state->stretch[(int64_t)k * dofs + d];
        bulk_operator_apply(branches->system, bulk_shape(j), sum, branches->image);
        for (int32_t d = 0; d < dofs; d++) force[d] += branches->image[d];
    }
}
