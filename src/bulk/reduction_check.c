// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/reduction_check.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>

// Work of one comparison, m = interface_count.
typedef struct Comparison {
    double *exact;   // [m^2] S, then its Cholesky factor
    double *excess;   // [m^2] S_reduced - S
    double *eigenvalues;   // [m]
    double *work;   // [dense_eigen_work(m)]
} Comparison;

static bool compare(BulkOperator *full, BulkOperator *reduced, double shift, Comparison *work,
                    double *error, Error *err)
{
    int32_t m = full->interface_count;
    OperatorTerms terms = {.mass = shift, .damping = 1, .stiffness = 1 / shift};
    InterfaceOperator *exact = interface_operator_create(full, terms, err);
    InterfaceOperator *tried = exact ? interface_operator_create(reduced, terms, err) : NULL;
    if (!tried) goto cleanup;
    const double *schur = interface_operator_schur(exact);
    const double *reduced_schur = interface_operator_schur(tried);
    for (int64_t k = 0; k < (int64_t)m * m; k++) {
        work->exact[k] = schur[k];
        work->excess[k] = reduced_schur[k] - schur[k];
    }
    if (!dense_cholesky(work->exact, m))
        FAIL(err, ERROR_COMPUTE, "the interface operator at s = %g is not positive definite",
             shift);
    dense_divide_both_sides(work->exact, m, work->excess);
    if (!dense_eigen(work->excess, m, work->eigenvalues, work->work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: no eigenvalues of the reduction's error");
    *error = fmax(*error, work->eigenvalues[m - 1]);
cleanup:
    interface_operator_destroy(exact);
    interface_operator_destroy(tried);
    return error_is_clean(err);
}

bool reduction_check(BulkOperator *full, BulkOperator *reduced, double *error, Error *err)
{
    double shifts[REDUCTION_SHIFTS_MAX];
    int64_t m = full->interface_count;
    const BulkScales *scales = &reduced->reduced->scales;
    Comparison work = {.exact = NEW_ARRAY(double, m *m, err),
                       .excess = NEW_ARRAY(double, m *m, err),
                       .eigenvalues = NEW_ARRAY(double, m, err),
                       .work = NEW_ARRAY(double, dense_eigen_work((int32_t)m), err)};
    *error = 0;
    if (!error_is_clean(err)) goto cleanup;
    // Half way, on a logarithmic scale, between the shifts of the build.
    int32_t count = reduction_shifts(scales, shifts);
    for (int32_t k = 0; k + 1 < count; k++) {
        double between = sqrt(shifts[k] * shifts[k + 1]) * scales->stiffness / scales->damping;
        TRY(compare(full, reduced, between, &work, error, err));
    }
cleanup:
    memory_free(work.exact);
    memory_free(work.excess);
    memory_free(work.eigenvalues);
    memory_free(work.work);
    return error_is_clean(err);
}
