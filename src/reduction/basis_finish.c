// SPDX-License-Identifier: GPL-2.0-or-later
// With K = L L' and L^-1 M L^-T = Q T Q' of Phi (Householder: LAPACK Users' Guide, 3rd ed., 2.4.4),
// Phi W, W = L^-T Q, has the unit matrix as K and the tridiagonal T as M.
#include "reduction/basis.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

typedef struct Turn {
    double *w;   // [r^2]
    double *diagonal, *beside;   // [r] of T
    double *damping;   // [r^2] W'C W
} Turn;

static void turn_destroy(Turn *turn)
{
    memory_free_all(turn->w, turn->diagonal, turn->beside, turn->damping);
}

static bool turn_create(const Basis *basis, Turn *turn, Error *err)
{
    int64_t r = basis->interior_count;
    double *work = NEW_ARRAY(double, dense_eigen_work((int32_t)r), err);
    turn->w = NEW_ARRAY(double, r *r, err);
    turn->diagonal = NEW_ARRAY(double, r, err);
    turn->beside = NEW_ARRAY(double, r, err);
    turn->damping = NEW_ARRAY(double, r *r, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(turn->w, basis->interior[BULK_MASS], (size_t)(r * r) * sizeof *turn->w);
    dense_divide_both_sides(basis->lower, (int32_t)r, turn->w);
    dense_mirror(turn->w, r);
    if (!dense_tridiagonalise(turn->w, (int32_t)r, turn->diagonal, turn->beside, work))
        FAIL(err, ERROR_LIBRARY, "the reduced mass cannot be made tridiagonal");
    dense_lower_divide_transposed(basis->lower, (int32_t)r, (int32_t)r, turn->w);
    // K and M of the interior are done with.
    DenseView w = dense_view(turn->w, r, r), half = dense_view(basis->interior[BULK_MASS], r, r);
    dense_multiply(dense_view(basis->interior[BULK_DAMPING], r, r), w, 1, 0,
                   basis->interior[BULK_MASS]);
    dense_multiply_transposed(w, half, 1, 0, turn->damping);
cleanup:
    memory_free(work);
    return error_is_clean(err);
}

// [count^2] of [m^2] and [m * r] and, transposed, their mirror image; the interior's part is 0.
static double *put_together(const Basis *basis, BulkTerm term, const Turn *turn, Error *err)
{
    int64_t m = basis->interface_count, r = basis->interior_count, all = m + r;
    double *square = NEW_ARRAY(double, all *all, err), *beside = NEW_ARRAY(double, m *r, err);
    if (!square || !beside) goto cleanup;
    dense_multiply(dense_view(basis->beside[term], m, r), dense_view(turn->w, r, r), 1, 0, beside);
    for (int64_t j = 0; j < m; j++)
        memcpy(square + j * all, basis->statics[term] + j * m, (size_t)m * sizeof *square);
    for (int64_t j = 0; j < r; j++)
        memcpy(square + (m + j) * all, beside + j * m, (size_t)m * sizeof *square);
    dense_transpose(dense_view(beside, m, r), square + m, all);
cleanup:
    memory_free(beside);
    return square;
}

// Psi, and Phi W.
static bool write_modes(const Basis *basis, const Turn *turn, ReducedPart *part, Error *err)
{
    int64_t dofs = basis->full_dofs, m = basis->interface_count, r = basis->interior_count;
    const Responses *responses = &basis->responses;
    double *modes = part->modes = NEW_ARRAY(double, dofs *(m + r), err), *phi = modes + dofs * m;
    double *statics = NEW_ARRAY(double, m *r, err), *mixed = NEW_ARRAY(double, (m + r) * r, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(modes, responses->blocks[0].field, (size_t)(dofs * m) * sizeof *modes);
    dense_multiply(dense_view(basis->parts, m, r), dense_view(turn->w, r, r), -1, 0, statics);
    for (int64_t j = 0; j < r; j++) {
        memcpy(mixed + j * (m + r), statics + j * m, (size_t)m * sizeof *mixed);
        memcpy(mixed + j * (m + r) + m, turn->w + j * r, (size_t)r * sizeof *mixed);
    }
    responses_combine(responses, mixed, r, phi);
cleanup:
    memory_free_all(statics, mixed);
    return error_is_clean(err);
}

bool basis_finish(Basis *basis, bool modes, ReducedPart *part, Error *err)
{
    Turn turn = {0};
    int64_t m = basis->interface_count, r = basis->interior_count, all = m + r;
    TRY(turn_create(basis, &turn, err));
    part->full_dofs = basis->full_dofs;
    part->border_count = (int32_t)m;
    part->interior_count = (int32_t)r;
    part->count = (int32_t)all;
    part->mass = put_together(basis, BULK_MASS, &turn, err);
    part->damping = put_together(basis, BULK_DAMPING, &turn, err);
    part->load = NEW_ARRAY(double, all, err);
    part->stiffness = NEW_ARRAY(double, m *m, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(part->stiffness, basis->statics[BULK_STIFFNESS], (size_t)(m * m) * sizeof(double));
    memcpy(part->load, basis->load, (size_t)m * sizeof(double));
    dense_apply_transposed(dense_view(turn.w, r, r), basis->load + m, 1, 0, part->load + m);
    double *mass = part->mass + m * (all + 1), *damping = part->damping + m * (all + 1);
    for (int64_t j = 0; j < r; j++) {
        mass[j * (all + 1)] = turn.diagonal[j];
        if (j + 1 < r) mass[j * (all + 1) + 1] = mass[(j + 1) * (all + 1) - 1] = turn.beside[j];
        for (int64_t i = 0; i < r; i++)
            damping[j * all + i] = (turn.damping[j * r + i] + turn.damping[i * r + j]) / 2;
    }
    if (modes) TRY(write_modes(basis, &turn, part, err));
cleanup:
    turn_destroy(&turn);
    return error_is_clean(err);
}
