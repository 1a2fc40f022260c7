// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/reduction.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// Shifts s, in units of E/eta, at which the interior is asked for its response. Between them slow
// loading, waves and the thin layers of very short steps must be covered: from a tenth of the
// slowest rate of the block (viscous or wave) to the fastest.
static const double SHIFT_LOW = 0.1, SHIFT_HIGH = 1e3, SHIFT_RATIO = 10;

static const double DECOMPOSE_AGAIN = 1e-4;   // lambda over the largest: 1e-12 of orthonormality

// Work of one build.
typedef struct Reducer {
    const Bulk *bulk;
    const ReductionDef *def;
    const int32_t *interface_dofs;   // [m]
    SparseAnalysis *analysis;
    double *values;   // [entries] of a shifted matrix
    double *statics;   // [dofs * m] constraint modes, unit interface rows included
    double *responses;   // [dofs * (m + 1)] of one shift
    double *forces;   // [dofs * (m + 1)] K times those
    double *gram;   // [(m + 1)^2]
    double *eigenvalues;   // [m + 1]
    double *eigen_work;
    double *overlap;   // [room * (m + 1)]
    double *unit_load;   // [dofs]
    double *is_border;   // [dofs] 1 on the interface, 0 inside
    double *border;   // [m]
    double *interior;   // [dofs * room] Phi
    int32_t dofs, m, r, room;
    double largest;   // singular value seen so far
} Reducer;

void reduction_destroy(ReducedBulk *reduced)
{
    memory_free(reduced->mass);
    memory_free(reduced->damping);
    memory_free(reduced->stiffness);
    memory_free(reduced->load);
    memory_free(reduced->modes);
    *reduced = (ReducedBulk){0};
}

void reduction_recover(const ReducedBulk *reduced, const double *state, double *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply(modes, state, 1, 0, full);
}

static void reducer_destroy(Reducer *work)
{
    sparse_analysis_destroy(work->analysis);
    memory_free(work->values);
    memory_free(work->statics);
    memory_free(work->responses);
    memory_free(work->forces);
    memory_free(work->gram);
    memory_free(work->eigenvalues);
    memory_free(work->eigen_work);
    memory_free(work->overlap);
    memory_free(work->unit_load);
    memory_free(work->is_border);
    memory_free(work->border);
    memory_free(work->interior);
}

static bool reducer_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t m,
                           const ReductionDef *def, Reducer *work, Error *err)
{
    int64_t dofs = bulk->dof_count, columns = (int64_t)m + 1;
    *work = (Reducer){.bulk = bulk,
                      .def = def,
                      .interface_dofs = interface_dofs,
                      .dofs = bulk->dof_count,
                      .m = m};
    work->room = 2 * m + 64;
    work->analysis = sparse_analyse(&bulk->pattern, interface_dofs, m, err);
    work->values = NEW_ARRAY(double, bulk->pattern.start[dofs], err);
    work->statics = NEW_ARRAY(double, dofs *m, err);
    work->responses = NEW_ARRAY(double, dofs *columns, err);
    work->forces = NEW_ARRAY(double, dofs *columns, err);
    work->gram = NEW_ARRAY(double, columns *columns, err);
    work->eigenvalues = NEW_ARRAY(double, columns, err);
    work->eigen_work = NEW_ARRAY(double, dense_eigen_work(m + 1), err);
    work->overlap = NEW_ARRAY(double, work->room *columns, err);
    work->unit_load = NEW_ARRAY(double, dofs, err);
    work->is_border = NEW_ARRAY(double, dofs, err);
    work->border = NEW_ARRAY(double, m, err);
    work->interior = NEW_ARRAY(double, dofs * work->room, err);
    if (!error_is_clean(err)) return false;
    for (int32_t j = 0; j < m; j++) work->is_border[interface_dofs[j]] = 1;
    double scale = def->scales.load > 0 ? def->scales.load : 1;
    for (int64_t k = 0; k < dofs; k++) work->unit_load[k] = bulk->load[k] / scale;
    return true;
}

// y = K x / E
static void apply_stiffness(const Reducer *work, const double *x, double *y)
{
    sparse_apply(&work->bulk->pattern, work->bulk->stiffness, x, y);
    for (int32_t k = 0; k < work->dofs; k++) y[k] /= work->def->scales.stiffness;
}

// Factors mass M + damping C + stiffness K, normalised, with 1 added on the interface's diagonal:
// keeps a K or C that lets the block move freely definite, and leaves interior responses as they
// are.
static SparseFactor *factor_terms(Reducer *work, const double terms[3], Error *err)
{
    const Bulk *bulk = work->bulk;
    const int32_t *start = bulk->pattern.start, *index = bulk->pattern.index;
    const BulkScales *scales = &work->def->scales;
    double m = terms[0] / scales->mass, c = terms[1] / scales->damping;
    double k = terms[2] / scales->stiffness;
    for (int32_t column = 0; column < bulk->dof_count; column++) {
        for (int32_t e = start[column]; e < start[column + 1]; e++) {
            work->values[e] = c * bulk->damping[e] + k * bulk->stiffness[e];
            if (index[e] == column)
                work->values[e] += m * bulk->mass[column] + work->is_border[column];
        }
    }
    return sparse_factorise(work->analysis, work->values, err);
}

// Responses of the whole bulk to unit motions of the interface [dofs * m], and in one more column
// to the unit load with the interface held.
static bool respond(Reducer *work, const double terms[3], double *responses, Error *err)
{
    SparseFactor *factor = factor_terms(work, terms, err);
    if (!factor) goto cleanup;
    TRY(sparse_border_responses(factor, responses, err));
    for (int64_t j = 0; j < work->m; j++) {   // exact where it is known, so that no rounding grows
        for (int32_t i = 0; i < work->m; i++)
            responses[j * work->dofs + work->interface_dofs[i]] = i == j;
    }
    double *last = responses + (int64_t)work->dofs * work->m;
    TRY(sparse_condense(factor, work->unit_load, work->border, err));
    memset(work->border, 0, (size_t)work->m * sizeof(double));
    TRY(sparse_expand(factor, work->border, last, err));
    for (int32_t i = 0; i < work->m; i++) last[work->interface_dofs[i]] = 0;
cleanup:
    sparse_factor_destroy(factor);
    return error_is_clean(err);
}

// responses -= Phi (Phi' K responses), twice for rounding; leaves K times the result in `forces`.
static void project_out(Reducer *work, int32_t columns)
{
    int64_t dofs = work->dofs;
    DenseView phi = {work->interior, work->dofs, work->r};
    DenseView forces = {work->forces, work->dofs, columns};
    DenseView overlap = {work->overlap, work->r, columns};
    for (int pass = 0; pass < 3; pass++) {
        for (int64_t j = 0; j < columns; j++)
            apply_stiffness(work, work->responses + j * dofs, work->forces + j * dofs);
        if (pass == 2 || work->r == 0) break;
        dense_multiply_transposed(phi, forces, 1, 0, work->overlap);
        dense_multiply(phi, overlap, -1, 1, work->responses);
    }
}

static bool make_room(Reducer *work, int32_t columns, Error *err)
{
    if (work->r + columns <= work->room) return true;
    int32_t room = 2 * (work->r + columns);
    double *interior = memory_resize(work->interior, (int64_t)work->dofs * work->room,
                                     (int64_t)work->dofs * room, sizeof(double), err);
    if (!interior) return false;
    work->interior = interior;
    memory_free(work->overlap);
    work->overlap = NEW_ARRAY(double, (int64_t)room *(work->m + 1), err);
    work->room = room;
    return work->overlap != NULL;
}

// What the first `columns` responses hold beyond Phi: responses' K responses = Q lambda Q', with Q
// in `gram`.
static bool decompose(Reducer *work, int32_t columns, Error *err)
{
    DenseView responses = {work->responses, work->dofs, columns};
    DenseView forces = {work->forces, work->dofs, columns};
    project_out(work, columns);
    dense_multiply_transposed(responses, forces, 1, 0, work->gram);
    if (!dense_eigen(work->gram, columns, work->eigenvalues, work->eigen_work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: the responses of the interior could not be compressed");
cleanup:
    return error_is_clean(err);
}

// The `kept` last singular vectors, responses Q / sqrt(lambda), behind Phi's columns.
static void place_vectors(Reducer *work, int32_t columns, int32_t kept)
{
    DenseView responses = {work->responses, work->dofs, columns};
    for (int32_t k = 0; k < kept; k++) {
        const double *vector = work->gram + (int64_t)(columns - 1 - k) * columns;
        double scale = 1 / sqrt(work->eigenvalues[columns - 1 - k]);
        dense_apply(responses, vector, scale, 0,
                    work->interior + (int64_t)work->dofs * (work->r + k));
    }
}

// The `kept` vectors just placed, decomposed once more. Forming responses' K responses squares
// rounding: a vector with singular value s of the largest came out orthonormal to 1e-16 / s^2 only.
// Now it is to 1e-16, and those that were nothing but rounding show (eigenvalues 1 and 0). How many
// are left.
static bool place_again(Reducer *work, int32_t *kept, Error *err)
{
    int64_t dofs = work->dofs;
    memcpy(work->responses, work->interior + dofs * work->r,
           (size_t)(dofs * *kept) * sizeof(double));
    TRY(decompose(work, *kept, err));
    int32_t placed = *kept, left = 0;
    while (left < placed && work->eigenvalues[placed - 1 - left] > 0.5) left++;
    place_vectors(work, placed, left);
    *kept = left;
cleanup:
    return error_is_clean(err);
}

// Adds to Phi what the responses hold beyond it: left singular vectors in the energy norm.
static bool compress(Reducer *work, double *dropped, Error *err)
{
    int32_t columns = work->m + 1;
    TRY(decompose(work, columns, err));
    double top = sqrt(fmax(work->eigenvalues[columns - 1], 0));
    work->largest = fmax(work->largest, top);
    int32_t kept = 0;
    while (kept < columns && work->eigenvalues[columns - 1 - kept] > 0 &&
           sqrt(work->eigenvalues[columns - 1 - kept]) > work->def->tolerance * work->largest)
        kept++;
    if (kept < columns)
        *dropped = fmax(*dropped, sqrt(fmax(work->eigenvalues[columns - 1 - kept], 0)));
    TRY(make_room(work, kept, err));
    place_vectors(work, columns, kept);
    double least = kept > 0 ? work->eigenvalues[columns - kept] : INFINITY;
    if (least < DECOMPOSE_AGAIN * top * top) TRY(place_again(work, &kept, err));
    work->r += kept;
cleanup:
    return error_is_clean(err);
}

// Shifts from SHIFT_LOW times the slowest to SHIFT_HIGH times the fastest of the block's two rates,
// E/eta and c/L, in units of E/eta; lambda^2 = rho L^2 E / eta^2.
int32_t reduction_shifts(const BulkScales *scales, double shifts[REDUCTION_SHIFTS_MAX])
{
    double lambda = sqrt(scales->mass * scales->stiffness) / scales->damping;
    double low = SHIFT_LOW * fmin(1, 1 / lambda), high = SHIFT_HIGH * fmax(1, 1 / lambda);
    int32_t count = (int32_t)ceil(log(high / low) / log(SHIFT_RATIO) - 1e-9) + 1;
    if (count > REDUCTION_SHIFTS_MAX) count = REDUCTION_SHIFTS_MAX;
    for (int32_t k = 0; k < count; k++) shifts[k] = low * pow(high / low, (double)k / (count - 1));
    return count;
}

static bool collect_interior(Reducer *work, ReducedBulk *reduced, Error *err)
{
    const BulkScales *scales = &work->def->scales;
    double shifts[REDUCTION_SHIFTS_MAX], dropped = 0;
    double lambda_square = scales->mass * scales->stiffness / (scales->damping * scales->damping);
    int64_t entries = (int64_t)work->dofs * work->m;
    double statics[3] = {0, 0, 1};
    TRY(respond(work, statics, work->responses, err));
    memcpy(work->statics, work->responses, (size_t)entries * sizeof(double));
    // The first interior mode is the static answer to the load alone.
    memset(work->responses, 0, (size_t)entries * sizeof(double));
    TRY(compress(work, &dropped, err));
    work->largest = 0;
    int32_t count = reduction_shifts(scales, shifts);
    for (int32_t k = 0; k < count; k++) {
        double terms[3] = {shifts[k] * lambda_square, 1, 1 / shifts[k]};
        TRY(respond(work, terms, work->responses, err));
        for (int64_t e = 0; e < entries; e++) work->responses[e] -= work->statics[e];
        TRY(compress(work, &dropped, err));
    }
    reduced->factorisations = count + 1;
    reduced->dropped = work->largest > 0 ? dropped / work->largest : 0;
cleanup:
    return error_is_clean(err);
}

// modes = [statics, interior], then V' M V, V' C V and S_K.
static bool project_matrices(Reducer *work, ReducedBulk *reduced, Error *err)
{
    const Bulk *bulk = work->bulk;
    int64_t dofs = work->dofs, count = work->m + work->r, m = work->m;
    double *product = NEW_ARRAY(double, dofs *count, err);
    reduced->modes = NEW_ARRAY(double, dofs *count, err);
    reduced->mass = NEW_ARRAY(double, count *count, err);
    reduced->damping = NEW_ARRAY(double, count *count, err);
    reduced->stiffness = NEW_ARRAY(double, m *m, err);
    reduced->load = NEW_ARRAY(double, count, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(reduced->modes, work->statics, (size_t)(dofs * m) * sizeof(double));
    memcpy(reduced->modes + dofs * m, work->interior, (size_t)(dofs * work->r) * sizeof(double));
    DenseView modes = {reduced->modes, work->dofs, (int32_t)count};
    DenseView statics = {reduced->modes, work->dofs, work->m};
    DenseView image = {product, work->dofs, (int32_t)count};
    DenseView static_image = {product, work->dofs, work->m};
    for (int64_t j = 0; j < count; j++) {
        for (int64_t k = 0; k < dofs; k++)
            product[j * dofs + k] = bulk->mass[k] * reduced->modes[j * dofs + k] /
                                    work->def->scales.mass;
    }
    dense_multiply_transposed(modes, image, 1, 0, reduced->mass);
    for (int64_t j = 0; j < count; j++)
        sparse_apply(&bulk->pattern, bulk->damping, reduced->modes + j * dofs, product + j * dofs);
    dense_multiply_transposed(modes, image, 1 / work->def->scales.damping, 0, reduced->damping);
    for (int64_t j = 0; j < m; j++)
        apply_stiffness(work, reduced->modes + j * dofs, product + j * dofs);
    dense_multiply_transposed(statics, static_image, 1, 0, reduced->stiffness);
    dense_apply_transposed(modes, work->unit_load, 1, 0, reduced->load);
    reduced->full_dofs = work->dofs;
    reduced->interface_count = work->m;
    reduced->interior_count = work->r;
    reduced->count = (int32_t)count;
    reduced->scales = work->def->scales;
cleanup:
    memory_free(product);
    return error_is_clean(err);
}

bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err)
{
    *reduced = (ReducedBulk){0};
    Reducer work = {0};
    TRY(reducer_create(bulk, interface_dofs, interface_count, def, &work, err));
    TRY(collect_interior(&work, reduced, err));
    TRY(project_matrices(&work, reduced, err));
cleanup:
    reducer_destroy(&work);
    if (!error_is_clean(err)) error_context(err, "while reducing the bulk");
    return error_is_clean(err);
}
