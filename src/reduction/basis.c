// SPDX-License-Identifier: GPL-2.0-or-later
// The remainder of a response is a difference of nearly equal energies. Its products come from
// those of the responses, so that columns as long as the mesh are multiplied once. Where too many
// digits are lost, or some of what is new depends on the rest, the block itself becomes what is new
// of it, orthonormal in K, and is multiplied by the mesh.
//
// At a point, with A_qq = L L' and Z = L^-1 [A_qb  load_q]: S = A_bb - Z_b' Z_b, the energy is
// Z_f' Z_f. At the end M w = masses K w of Phi: Phi W has the unit matrix as K and diag(masses) as
// M.
#include "reduction/basis.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>
#include <string.h>

// The squared length of what is left of a response below which it is rounding.
static const double DEPENDENT_LIMIT = 1e-12;

enum { INVERSE_STEPS = 8 };   // to the smallest eigenvalue, within some per cent

// The extension by the next block, as small matrices.
typedef struct Extension {
    int64_t m, count, added;   // count: columns of Phi before
    double *gram[BULK_TERMS_MAX];   // [(m + count + added) * added] X' (K, C, M, S_j) X_next
    double *statics;   // [m * added] rows of one of these
    double *parts;   // [m * added] X_b of the next
    double *beside[BULK_TERMS_MAX];   // [m * added] Psi' (C, M, S_j) Y, Y the new columns of Phi
    double *old[BULK_TERMS_MAX];   // [count * added] Phi' (K, C, M, S_j) Y
    double *own[BULK_TERMS_MAX];   // [added^2] Y' (K, C, M, S_j) Y
    double *load;   // [added] f'Y
    double *lower;   // [added^2] of the factor of K
    double *along;   // [count * added] L^-1 Phi'K Y
    double largest;   // energy in K of a response
} Extension;

void basis_destroy(Basis *basis)
{
    responses_destroy(&basis->responses);
    for (int term = 0; term < BULK_TERMS_MAX; term++) {
        memory_free_all(basis->statics[term], basis->beside[term], basis->interior[term]);
    }
    memory_free_all(basis->lower, basis->load, basis->parts);
    *basis = (Basis){0};
}

bool basis_create(const BulkOperator *full, const BulkScales *scales, Basis *basis, Error *err)
{
    int64_t m = full->interface_count;
    *basis = (Basis){.full_dofs = full->dof_count, .interface_count = full->interface_count};
    for (int term = 0; term < BULK_TERMS + full->bulk->spectrum.matrix_count; term++)
        basis->statics[term] = NEW_ARRAY(double, m *m, err);
    basis->load = NEW_ARRAY(double, m, err);
    return error_is_clean(err) && responses_create(full, scales, &basis->responses, err);
}

static void extension_destroy(Extension *x)
{
    for (int term = 0; term < BULK_TERMS_MAX; term++) {
        memory_free_all(x->gram[term], x->beside[term], x->old[term], x->own[term]);
    }
    double *const owned[] = {x->statics, x->parts, x->load, x->lower, x->along};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) memory_free(owned[k]);
    *x = (Extension){0};
}

static bool extension_create(const Basis *basis, int64_t added, Extension *x, Error *err)
{
    int64_t m = basis->interface_count, count = basis->interior_count;
    *x = (Extension){.m = m, .count = count, .added = added};
    for (int term = 0; term < basis->responses.term_count; term++) {
        x->gram[term] = NEW_ARRAY(double, (m + count + added) * added, err);
        if (term != BULK_STIFFNESS) x->beside[term] = NEW_ARRAY(double, m *added, err);
        x->old[term] = NEW_ARRAY(double, count *added, err);
        x->own[term] = NEW_ARRAY(double, added *added, err);
    }
    x->statics = NEW_ARRAY(double, m *added, err);
    x->parts = NEW_ARRAY(double, m *added, err);
    x->load = NEW_ARRAY(double, added, err);
    x->lower = NEW_ARRAY(double, added *added, err);
    x->along = NEW_ARRAY(double, count *added, err);
    return error_is_clean(err);
}

// out [count * columns] := rows `first` on of a [rows * columns].
static void take_rows(DenseView a, int64_t first, int64_t count, double *out)
{
    for (int64_t j = 0; j < a.columns; j++)
        memcpy(out + j * count, a.values + j * a.rows + first, (size_t)count * sizeof *out);
}

// Products of Y = X_next - Psi parts.
static void take_out_statics(const Basis *basis, const ResponseBlock *next, Extension *x)
{
    int64_t m = x->m, added = x->added, count = x->count;
    take_rows(dense_view(next->boundary, m + 1, added), 0, m, x->parts);
    DenseView parts = dense_view(x->parts, m, added), statics = dense_view(x->statics, m, added);
    DenseView before = dense_view(basis->parts, m, count);
    for (int term = 0; term < basis->responses.term_count; term++) {
        DenseView known = dense_view(basis->statics[term], m, m);
        DenseView gram = dense_view(x->gram[term], m + count + added, added);
        take_rows(gram, m, count, x->old[term]);
        take_rows(gram, m + count, added, x->own[term]);
        for (int64_t j = 0; term == BULK_STIFFNESS && j < added; j++)
            x->largest = fmax(x->largest, x->own[term][j * (added + 1)]);
        if (term == BULK_STIFFNESS)
            dense_multiply(known, parts, 1, 0, x->statics);
        else
            take_rows(gram, 0, m, x->statics);
        dense_multiply_transposed(before, statics, -1, 1, x->old[term]);
        dense_multiply_transposed(parts, statics, -1, 1, x->own[term]);
        if (term == BULK_STIFFNESS) continue;
        double *beside = x->beside[term];
        memcpy(beside, x->statics, (size_t)(m * added) * sizeof *beside);
        dense_multiply(known, parts, -1, 1, beside);
        dense_multiply_transposed(dense_view(basis->beside[term], m, count), parts, -1, 1,
                                  x->old[term]);
        dense_multiply_transposed(dense_view(beside, m, added), parts, -1, 1, x->own[term]);
    }
    for (int64_t j = 0; j < added; j++) x->load[j] = next->boundary[j * (m + 1) + m];
    dense_apply_transposed(parts, basis->load, -1, 1, x->load);
}

// Rows of the factor of K that belong to the new columns. Returns how much larger the energy of a
// response is than what is left of one; INFINITY: they are not independent but for rounding.
static double factor_energy(const Basis *basis, Extension *x)
{
    int64_t count = x->count, added = x->added;
    memcpy(x->along, x->old[BULK_STIFFNESS], (size_t)(count * added) * sizeof(double));
    memcpy(x->lower, x->own[BULK_STIFFNESS], (size_t)(added * added) * sizeof(double));
    if (count > 0) {
        dense_lower_divide(basis->lower, (int32_t)count, (int32_t)added, x->along);
        DenseView along = dense_view(x->along, count, added);
        dense_multiply_transposed(along, along, -1, 1, x->lower);
    }
    if (!dense_cholesky(x->lower, (int32_t)added)) return INFINITY;

    // An upper bound of the smallest eigenvalue of L L', by inverse iteration. `gram` is done with.
    int32_t n = (int32_t)added;
    double *work = x->gram[0], least = 0;
    for (int32_t k = 0; k < n; k++) work[k] = fmod(0.6180339887498949 * (k + 1.0), 1) - 0.5;
    for (int32_t step = 0; step < INVERSE_STEPS; step++) {
        double before = sqrt(dense_dot(work, work, n));
        dense_lower_solve(x->lower, n, work);
        dense_lower_solve_transposed(x->lower, n, work);
        least = before / sqrt(dense_dot(work, work, n));
        for (int32_t k = 0; k < n; k++) work[k] *= least / before;
    }
    return least > DEPENDENT_LIMIT * x->largest ? x->largest / least : INFINITY;
}

// The next block becomes what is new of it, above rounding and orthonormal in K: along eigenvectors
// of the remaining energy of the new columns.
static bool make_orthonormal(Basis *basis, Extension *x, Error *err)
{
    ResponseBlock *next = responses_last(&basis->responses);
    int64_t dofs = basis->full_dofs, m = x->m, count = x->count, added = x->added, kept = 0;
    double *formed = NULL, *phi = NULL, *psi = NULL, *all = NULL;
    double *turn = NEW_ARRAY(double, added *added, err);
    double *values = NEW_ARRAY(double, added, err);
    double *work = NEW_ARRAY(double, DENSE_EIGEN_WORK(added), err);
    if (!error_is_clean(err)) goto cleanup;

    // The eigenvectors, ascending; those that are kept are the last ones.
    DenseView along = dense_view(x->along, count, added);
    memcpy(turn, x->own[BULK_STIFFNESS], (size_t)(added * added) * sizeof *turn);
    if (count > 0) dense_multiply_transposed(along, along, -1, 1, turn);
    if (!dense_eigen(turn, (int32_t)added, values, work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: no energies of what is new of the responses");
    for (; kept < added; kept++) {
        int64_t j = added - 1 - kept;
        if (!(values[j] > DEPENDENT_LIMIT * x->largest)) break;
        for (int64_t i = 0; i < added; i++) turn[j * added + i] /= sqrt(values[j]);
    }
    DenseView by = dense_view(turn + (added - kept) * added, added, kept);

    // (X_next - Psi parts - Phi L^-T along) turn in the place of the next block.
    formed = NEW_ARRAY(double, dofs *kept, err);
    phi = NEW_ARRAY(double, count *kept, err);
    psi = NEW_ARRAY(double, m *kept, err);
    all = NEW_ARRAY(double, (m + count) * kept, err);
    if (!error_is_clean(err)) goto cleanup;
    dense_lower_divide_transposed(basis->lower, (int32_t)count, (int32_t)added, x->along);
    dense_multiply(along, by, -1, 0, phi);
    dense_multiply(dense_view(x->parts, m, added), by, -1, 0, psi);
    dense_multiply(dense_view(basis->parts, m, count), dense_view(phi, count, kept), -1, 1, psi);
    for (int64_t j = 0; j < kept; j++) {
        memcpy(all + j * (m + count), psi + j * m, (size_t)m * sizeof *all);
        memcpy(all + j * (m + count) + m, phi + j * count, (size_t)count * sizeof *all);
    }
    dense_multiply(dense_view(next->field, dofs, added), by, 1, 0, formed);
    TRY(responses_combine(&basis->responses, all, kept, formed, err));
    responses_replace(&basis->responses, kept, formed);
cleanup:
    memory_free_all(turn, values, work, formed, phi, psi, all);
    return error_is_clean(err);
}

// Puts a [size^2] into the upper left corner of a new one, [new_size^2], zero elsewhere.
static bool grow(double **a, int64_t size, int64_t new_size, Error *err)
{
    double *grown = NEW_ARRAY(double, new_size *new_size, err);
    if (!grown) return false;
    for (int64_t j = 0; j < size; j++)
        memcpy(grown + j * new_size, *a + j * size, (size_t)size * sizeof *grown);
    memory_free(*a);
    *a = grown;
    return true;
}

// Columns behind those that are there.
static bool append(double **a, int64_t rows, int64_t count, const double *columns, int64_t added,
                   Error *err)
{
    if (!memory_resize(a, rows * count, rows * (count + added), sizeof **a, err)) return false;
    memcpy(*a + rows * count, columns, (size_t)(rows * added) * sizeof **a);
    return true;
}

// The new columns join the basis: its matrices with both triangles, the factor of K below the
// diagonal only, as its upper triangle has no meaning.
static bool take_up(Basis *basis, const Extension *x, Error *err)
{
    int64_t m = x->m, count = x->count, added = x->added, size = count + added;
    for (int term = 0; term < basis->responses.term_count; term++) {
        double **square = &basis->interior[term];
        const double *own = x->own[term];
        if (!grow(square, count, size, err)) return false;
        for (int64_t j = 0; j < added; j++) {
            double *column = *square + (count + j) * size;
            memcpy(column, x->old[term] + j * count, (size_t)count * sizeof *column);
            for (int64_t i = 0; i < count; i++) (*square)[i * size + count + j] = column[i];
            for (int64_t i = 0; i < added; i++)
                column[count + i] = (own[j * added + i] + own[i * added + j]) / 2;
        }
        if (term != BULK_STIFFNESS &&
            !append(&basis->beside[term], m, count, x->beside[term], added, err))
            return false;
    }
    if (!grow(&basis->lower, count, size, err)) return false;
    for (int64_t i = 0; i < count; i++)
        for (int64_t j = 0; j < added; j++)
            basis->lower[i * size + count + j] = x->along[j * count + i];
    for (int64_t j = 0; j < added; j++)
        memcpy(basis->lower + (count + j) * (size + 1), x->lower + j * (added + 1),
               (size_t)(added - j) * sizeof(double));
    if (!append(&basis->parts, m, count, x->parts, added, err)) return false;
    if (!append(&basis->load, 1, m + count, x->load, added, err)) return false;
    responses_keep(&basis->responses);
    basis->interior_count = (int32_t)size;
    return true;
}

bool basis_extend(Basis *basis, Error *err)
{
    ResponseBlock *next = responses_last(&basis->responses);
    Extension x = {0};
    while (next->count > 0) {
        extension_destroy(&x);
        TRY(extension_create(basis, next->count, &x, err));
        TRY(responses_multiply(&basis->responses, x.gram, err));
        take_out_statics(basis, next, &x);
        double loss = factor_energy(basis, &x);
        if (loss <= basis->loss_max || (next->formed && isfinite(loss))) break;
        if (next->formed) FAIL(err, ERROR_COMPUTE, "the interior's responses are not independent");
        TRY(make_orthonormal(basis, &x, err));
    }
    if (next->count > 0) TRY(take_up(basis, &x, err));
cleanup:
    extension_destroy(&x);
    return error_is_clean(err);
}

bool basis_start(Basis *basis, InterfaceOperator *statics, Error *err)
{
    int64_t m = basis->interface_count;
    const double *schur = interface_operator_schur(statics);
    Responses *responses = &basis->responses;
    double *boundary = NEW_ARRAY(double, m *m, err);
    ResponseBlock *next = responses_next(responses, (ParameterPoint){0, 0}, m, err);
    if (!boundary || !next) goto cleanup;
    for (int64_t j = 0; j < m; j++) {
        boundary[j * m + j] = next->boundary[j * (m + 1) + j] = 1;
        memcpy(next->reaction + j * (m + 1), schur + j * m, (size_t)m * sizeof *schur);
    }
    TRY(interface_operator_respond(statics, boundary, (int32_t)m, next->field, err));
    TRY(responses_multiply(responses, basis->statics, err));
    // Inside the block K Psi = 0, so that Psi'K Psi is S_K.
    memcpy(basis->statics[BULK_STIFFNESS], schur, (size_t)(m * m) * sizeof *schur);
    for (int64_t j = 0; j < m; j++) basis->load[j] = next->boundary[j * (m + 1) + m];
    responses_keep(responses);
    responses_release_statics(responses, statics);
    next = responses_next(responses, (ParameterPoint){0, 0}, 1, err);
    if (!next) goto cleanup;
    TRY(interface_operator_respond_held(statics, responses->unit_load, next->field, next->reaction,
                                        err));
    for (int64_t i = 0; i < m; i++) next->reaction[i] = -next->reaction[i];
    next->reaction[m] = 1;
    if (dense_max_abs(next->field, basis->full_dofs) > 0) TRY(basis_extend(basis, err));
cleanup:
    memory_free(boundary);
    return error_is_clean(err);
}

// --- at a point ----------------------------------------------------------------------------------

enum {
    WIDE = 64,   // columns of a product
    STRETCH = 1024   // numbers that are added up at once
};

typedef struct Condensation {
    int64_t m, r;
    const double *lower;   // [r^2] L
    double *z;   // [r * (m + 1)]
    double *schur;   // [m^2]
} Condensation;

static void divide_columns(void *context, int32_t k, int32_t worker)
{
    const Condensation *all = context;
    int64_t from = (int64_t)k * WIDE, left = all->m + 1 - from;
    (void)worker;
    dense_lower_divide(all->lower, (int32_t)all->r, (int32_t)(left < WIDE ? left : WIDE),
                       all->z + from * all->r);
}

// Rows from a block's first column down.
static void square_columns(void *context, int32_t k, int32_t worker)
{
    const Condensation *all = context;
    int64_t from = (int64_t)k * WIDE, left = all->m - from, r = all->r;
    const double *z = all->z + from * r;
    (void)worker;
    dense_multiply_transposed_rows(dense_view(z, r, left),
                                   dense_view(z, r, left < WIDE ? left : WIDE), -1, 1,
                                   all->schur + from * (all->m + 1), all->m);
}

// out := sum of factor * term, those that are there, stretch by stretch in the cache.
static void combine(double *const *terms, int32_t term_count, const double *factor, int64_t count,
                    double *out)
{
    for (int64_t from = 0; from < count; from += STRETCH) {
        int64_t end = from + STRETCH < count ? from + STRETCH : count;
        memset(out + from, 0, (size_t)(end - from) * sizeof *out);
        for (int term = 0; term < term_count; term++) {
            const double *values = terms[term];
            double share = factor[term];
            for (int64_t i = from; values && share != 0 && i < end; i++)
                out[i] += share * values[i];
        }
    }
}

bool basis_condense(const Basis *basis, const double *factor, double *schur, double *energy,
                    bool *definite, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count;
    int32_t terms = basis->responses.term_count;
    double *interior = NEW_ARRAY(double, r *r, err), *z = NEW_ARRAY(double, r *(m + 1), err);
    double *beside = NEW_ARRAY(double, m *r, err);
    if (!interior || !z || !beside) goto cleanup;
    combine(basis->interior, terms, factor, r * r, interior);
    combine(basis->beside, terms, factor, m * r, beside);
    combine(basis->statics, terms, factor, m * m, schur);
    dense_transpose(dense_view(beside, m, r), z, r);
    memcpy(z + m * r, basis->load + m, (size_t)r * sizeof *z);
    if (!(*definite = dense_cholesky(interior, (int32_t)r))) goto cleanup;
    Condensation all = {m, r, interior, z, schur};
    parallel_for((int32_t)((m + WIDE) / WIDE), divide_columns, &all);
    parallel_for((int32_t)((m + WIDE - 1) / WIDE), square_columns, &all);
    dense_mirror(schur, m);
    *energy = dense_dot(z + m * r, z + m * r, (int32_t)r);
cleanup:
    memory_free_all(interior, z, beside);
    return error_is_clean(err);
}

// --- the part that is made of it -----------------------------------------------------------------

// out [r * m] := W' of what of C, M or S_j lies beside the border's.
static bool turn_beside(const Basis *basis, BulkTerm term, const double *w, double *out, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count;
    double *turned = NEW_ARRAY(double, m *r, err);
    if (!turned) return false;
    dense_multiply(dense_view(basis->beside[term], m, r), dense_view(w, r, r), 1, 0, turned);
    dense_transpose(dense_view(turned, m, r), out, r);
    memory_free(turned);
    return true;
}

// out [(m + r)^2]: C or S_j in the coordinates of the part. beside [r * m], half [r^2]: work.
static bool finish_square(const Basis *basis, BulkTerm term, const double *w, double *beside,
                          double *half, double *out, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count, all = m + r;
    double *interior = basis->interior[term];
    if (!out || !turn_beside(basis, term, w, beside, err)) return false;
    dense_multiply(dense_view(interior, r, r), dense_view(w, r, r), 1, 0, half);
    dense_multiply_transposed(dense_view(w, r, r), dense_view(half, r, r), 1, 0, interior);
    for (int64_t j = 0; j < m; j++) {
        memcpy(out + j * all, basis->statics[term] + j * m, (size_t)m * sizeof *out);
        memcpy(out + j * all + m, beside + j * r, (size_t)r * sizeof *out);
    }
    for (int64_t j = 0; j < r; j++)
        memcpy(out + (m + j) * all + m, interior + j * r, (size_t)r * sizeof *out);
    dense_mirror(out, all);
    return true;
}

// Psi, and Phi W.
static bool write_modes(const Basis *basis, const double *w, ReducedPart *part, Error *err)
{
    int64_t dofs = basis->full_dofs, m = basis->interface_count, r = basis->interior_count;
    const Responses *responses = &basis->responses;
    double *modes = part->modes = NEW_ARRAY(double, dofs *(m + r), err), *phi = modes + dofs * m;
    double *statics = NEW_ARRAY(double, m *r, err), *mixed = NEW_ARRAY(double, (m + r) * r, err);
    double *motions = NEW_ARRAY(double, m *m, err);   // one each
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t j = 0; j < m; j++) motions[j * (m + 1)] = 1;
    TRY(interface_operator_respond(responses->statics, motions, (int32_t)m, modes, err));
    dense_multiply(dense_view(basis->parts, m, r), dense_view(w, r, r), -1, 0, statics);
    for (int64_t j = 0; j < r; j++) {
        memcpy(mixed + j * (m + r), statics + j * m, (size_t)m * sizeof *mixed);
        memcpy(mixed + j * (m + r) + m, w + j * r, (size_t)r * sizeof *mixed);
    }
    TRY(responses_combine(responses, mixed, r, phi, err));
cleanup:
    memory_free_all(statics, mixed, motions);
    return error_is_clean(err);
}

bool basis_finish(Basis *basis, bool modes, ReducedPart *part, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count, all = m + r;
    // They take the place of M and of K (which is done with).
    double *w = basis->interior[BULK_MASS], *half = basis->interior[BULK_STIFFNESS];
    DenseView turn = dense_view(w, r, r);
    double *work = NEW_ARRAY(double, DENSE_EIGEN_WORK(r), err);
    double *beside = NEW_ARRAY(double, r *m, err);
    part->full_dofs = basis->full_dofs;
    part->border_count = (int32_t)m;
    part->interior_count = (int32_t)r;
    part->count = (int32_t)all;
    part->stiffness = NEW_ARRAY(double, m *m, err);
    part->mass = NEW_ARRAY(double, m *m, err);
    part->coupling = NEW_ARRAY(double, r *m, err);
    part->masses = NEW_ARRAY(double, r, err);
    part->damping = NEW_ARRAY(double, all *all, err);
    part->load = NEW_ARRAY(double, all, err);
    if (!error_is_clean(err)) goto cleanup;
    if (!dense_eigen_pair(w, half, (int32_t)r, part->masses, work))
        FAIL(err, ERROR_COMPUTE, "the reduced mass cannot be made diagonal");
    memcpy(part->stiffness, basis->statics[BULK_STIFFNESS], (size_t)(m * m) * sizeof(double));
    memcpy(part->mass, basis->statics[BULK_MASS], (size_t)(m * m) * sizeof(double));
    memcpy(part->load, basis->load, (size_t)m * sizeof(double));
    dense_apply_transposed(turn, basis->load + m, 1, 0, part->load + m);
    TRY(turn_beside(basis, BULK_MASS, w, part->coupling, err));
    TRY(finish_square(basis, BULK_DAMPING, w, beside, half, part->damping, err));
    for (int32_t j = 0; BULK_SHAPE + j < basis->responses.term_count; j++) {
        part->shape[j] = NEW_ARRAY(double, all *all, err);
        part->shape_count = j + 1;
        TRY(finish_square(basis, bulk_shape(j), w, beside, half, part->shape[j], err));
    }
    if (modes) TRY(write_modes(basis, w, part, err));
cleanup:
    memory_free_all(work, beside);
    return error_is_clean(err);
}
