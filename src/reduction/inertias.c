// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/inertias.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>

enum { SLOWEST_ITERATIONS = 4 };

// Inverse iteration, x'M x = 1 before each.
bool inertia_slowest(const BulkOperator *full, const BulkScales *scales, InterfaceOperator *statics,
                     double *slowest, Error *err)
{
    int32_t dofs = full->dof_count;
    double *x = NEW_ARRAY(double, dofs, err), *rhs = NEW_ARRAY(double, dofs, err);
    double *pull = NEW_ARRAY(double, full->interface_count, err);
    if (!x || !rhs || !pull) goto cleanup;
    for (int32_t k = 0; k < dofs; k++) x[k] = 1;
    for (int32_t j = 0; j < full->interface_count; j++) x[full->interface_dofs[j]] = 0;
    for (int32_t round = 0; round < SLOWEST_ITERATIONS; round++) {
        bulk_operator_apply(full, BULK_MASS, x, rhs);
        for (int32_t k = 0; k < dofs; k++) rhs[k] /= scales->mass;
        double size = sqrt(dense_dot(x, rhs, dofs));
        for (int32_t k = 0; k < dofs; k++) rhs[k] /= size;
        TRY(interface_operator_respond_held(statics, rhs, x, pull, err));
        *slowest = 1 / dense_dot(x, rhs, dofs);
    }
cleanup:
    memory_free(x);
    memory_free(rhs);
    memory_free(pull);
    return error_is_clean(err);
}

double inertia_element(const Bulk *bulk, const BulkScales *scales, const int32_t *interface_dofs,
                       int32_t interface_count)
{
    double largest = 0;
    for (int32_t j = 0; j < interface_count; j++) {
        int32_t dof = interface_dofs[j];
        double stiffness = bulk->stiffness[sparse_entry(&bulk->pattern, dof, dof)];
        largest = fmax(largest, stiffness / bulk->mass[dof] * scales->mass / scales->stiffness);
    }
    return largest;
}
