// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/reduced_bulk.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    if (reduced->storage) {
        memory_free(reduced->storage);
    } else {
        memory_free(reduced->mass);
        memory_free(reduced->damping);
        memory_free(reduced->stiffness);
        memory_free(reduced->viscous);
        memory_free(reduced->load);
    }
    memory_free(reduced->modes);
    *reduced = (ReducedBulk){0};
}

void reduced_bulk_recover(const ReducedBulk *reduced, const double *state, double *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply(modes, state, 1, 0, full);
}

void reduced_bulk_recover_each(const ReducedBulk *reduced, int32_t count,
                               const double *const *states, double *const *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply_each(modes, count, states, full);
}

// Between two levels the error is not measured; it stays below the larger of theirs, or little
// above (a test asks at random: 1.2 times as large, of two materials).
static const double BETWEEN = 1.5;

double reduced_bulk_error(const ReducedBulk *reduced, double inertia)
{
    const ReductionErrors *errors = &reduced->errors;
    if (errors->count == 0) return 0;
    int32_t above = 0;
    while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
    double below = above > 0 ? errors->error[above - 1] : 0;
    return BETWEEN * fmax(below, errors->error[above]);
}
