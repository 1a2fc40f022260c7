// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/interface_operator.h"

#include "base/memory.h"

#include <string.h>

struct InterfaceOperator {
    BulkOperator *system;   // not owned
    SparseFactor *factor;   // owned
    double *schur;   // [interface_count^2] S without the shift; owned
};

bool bulk_operator_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                          BulkOperator *system, Error *err)
{
    *system = (BulkOperator){
        .dof_count = bulk->dof_count, .interface_count = interface_count, .bulk = bulk};
    system->interface_dofs = NEW_ARRAY(int32_t, interface_count, err);
    system->values = NEW_ARRAY(double, bulk->pattern.start[bulk->dof_count], err);
    if (!system->interface_dofs || !system->values) goto cleanup;
    memcpy(system->interface_dofs, interface_dofs, (size_t)interface_count * sizeof(int32_t));
    system->analysis = sparse_analyse(&bulk->pattern, interface_dofs, interface_count, err);
cleanup:
    return error_is_clean(err);
}

void bulk_operator_destroy(BulkOperator *system)
{
    memory_free(system->interface_dofs);
    memory_free(system->values);
    sparse_analysis_destroy(system->analysis);
    *system = (BulkOperator){0};
}

void bulk_operator_apply(const BulkOperator *system, BulkTerm term, const double *x, double *y)
{
    const Bulk *bulk = system->bulk;
    sparse_apply(&bulk->pattern, term == BULK_STIFFNESS ? bulk->stiffness : bulk->damping, x, y);
}

// A = m M + c C + k K + shift on the interface's diagonal.
static void combine_terms(BulkOperator *system, OperatorTerms terms)
{
    const Bulk *bulk = system->bulk;
    const int32_t *start = bulk->pattern.start, *index = bulk->pattern.index;
    double *values = system->values;
    for (int32_t column = 0; column < bulk->dof_count; column++) {
        for (int32_t k = start[column]; k < start[column + 1]; k++) {
            values[k] = terms.damping * bulk->damping[k] + terms.stiffness * bulk->stiffness[k];
            if (index[k] == column) values[k] += terms.mass * bulk->mass[column];
        }
    }
    for (int32_t j = 0; terms.shift != 0 && j < system->interface_count; j++) {
        int32_t column = system->interface_dofs[j];
        for (int32_t k = start[column]; k < start[column + 1]; k++) {
            if (index[k] == column) values[k] += terms.shift;
        }
    }
}

InterfaceOperator *interface_operator_create(BulkOperator *system, OperatorTerms terms, Error *err)
{
    int64_t count = system->interface_count;
    InterfaceOperator *condensed = NEW_ARRAY(InterfaceOperator, 1, err);
    if (!condensed) goto cleanup;
    condensed->system = system;
    condensed->schur = NEW_ARRAY(double, count *count, err);
    if (!condensed->schur) goto cleanup;
    combine_terms(system, terms);
    condensed->factor = sparse_factorise(system->analysis, system->values, err);
    if (!condensed->factor) goto cleanup;
    system->factorisations++;
    memcpy(condensed->schur, sparse_schur(condensed->factor),
           (size_t)(count * count) * sizeof(double));
    for (int64_t j = 0; j < count; j++) condensed->schur[j * count + j] -= terms.shift;
cleanup:
    if (error_is_clean(err)) return condensed;
    interface_operator_destroy(condensed);
    return NULL;
}

void interface_operator_destroy(InterfaceOperator *condensed)
{
    if (!condensed) return;
    sparse_factor_destroy(condensed->factor);
    memory_free(condensed->schur);
    memory_free(condensed);
}

const double *interface_operator_schur(const InterfaceOperator *condensed)
{
    return condensed->schur;
}

bool interface_operator_condense(InterfaceOperator *condensed, const double *rhs, double *g,
                                 Error *err)
{
    return sparse_condense(condensed->factor, rhs, g, err);
}

bool interface_operator_expand(InterfaceOperator *condensed, const double *interface, double *v,
                               Error *err)
{
    condensed->system->solves++;
    return sparse_expand(condensed->factor, interface, v, err);
}
