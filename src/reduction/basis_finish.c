// SPDX-License-Identifier: GPL-2.0-or-later
// M w = masses K w of Phi: Phi W has the unit matrix as K and diag(masses) as M.
#include "reduction/basis.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

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

// C or S_j of all; what is beside the border's in `beside` [r * m], of the interior W'C W [r^2].
static void put_together(const Basis *basis, BulkTerm term, const double *beside,
                         const double *interior, double *out)
{
    int64_t m = basis->interface_count, r = basis->interior_count, all = m + r;
    for (int64_t j = 0; j < m; j++) {
        memcpy(out + j * all, basis->statics[term] + j * m, (size_t)m * sizeof *out);
        memcpy(out + j * all + m, beside + j * r, (size_t)r * sizeof *out);
    }
    for (int64_t j = 0; j < r; j++)
        memcpy(out + (m + j) * all + m, interior + j * r, (size_t)r * sizeof *out);
    dense_mirror(out, all);
}

// out [(m + r)^2]: C or S_j in the coordinates of the part. beside [r * m], half [r^2]: work.
static bool finish_square(const Basis *basis, BulkTerm term, const double *w, double *beside,
                          double *half, double *out, Error *err)
{
    int64_t r = basis->interior_count;
    double *interior = basis->interior[term];
    if (!out || !turn_beside(basis, term, w, beside, err)) return false;
    dense_multiply(dense_view(interior, r, r), dense_view(w, r, r), 1, 0, half);
    dense_multiply_transposed(dense_view(w, r, r), dense_view(half, r, r), 1, 0, interior);
    put_together(basis, term, beside, interior, out);
    return true;
}

// Psi, and Phi W.
static bool write_modes(const Basis *basis, const double *w, ReducedPart *part, Error *err)
{
    int64_t dofs = basis->full_dofs, m = basis->interface_count, r = basis->interior_count;
    const Responses *responses = &basis->responses;
    double *modes = part->modes = NEW_ARRAY(double, dofs *(m + r), err), *phi = modes + dofs * m;
    double *statics = NEW_ARRAY(double, m *r, err), *mixed = NEW_ARRAY(double, (m + r) * r, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(modes, responses->blocks[0].field, (size_t)(dofs * m) * sizeof *modes);
    dense_multiply(dense_view(basis->parts, m, r), dense_view(w, r, r), -1, 0, statics);
    for (int64_t j = 0; j < r; j++) {
        memcpy(mixed + j * (m + r), statics + j * m, (size_t)m * sizeof *mixed);
        memcpy(mixed + j * (m + r) + m, w + j * r, (size_t)r * sizeof *mixed);
    }
    responses_combine(responses, mixed, r, phi);
cleanup:
    memory_free_all(statics, mixed);
    return error_is_clean(err);
}

bool basis_finish(Basis *basis, bool modes, ReducedPart *part, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count, all = m + r;
    // In the place of M and of K (which is done with).
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
