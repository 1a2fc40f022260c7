// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/growing_basis.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// The squared length of the part orthogonal to the others below which a new vector is rounding.
static const double DEPENDENT = 1e-12;

void basis_destroy(GrowingBasis *basis)
{
    bulk_operator_destroy(&basis->full);
    bulk_operator_destroy(&basis->tried);
    memory_free(basis->border);
    memory_free(basis->still);
    memory_free(basis->zeros);
    memory_free(basis->unit_load);
    *basis = (GrowingBasis){0};
}

bool basis_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                  ReducedBulk *reduced, GrowingBasis *basis, Error *err)
{
    int64_t m = interface_count, dofs = bulk->dof_count;
    *basis = (GrowingBasis){.reduced = reduced, .modes_room = 4 * interface_count + 64};
    *reduced = (ReducedBulk){.full_dofs = bulk->dof_count,
                             .interface_count = interface_count,
                             .count = interface_count,
                             .scales = reduced->scales};
    TRY(bulk_operator_create(bulk, NULL, interface_dofs, interface_count, &basis->full, err));
    basis->border = NEW_ARRAY(double, m, err);
    basis->still = NEW_ARRAY(double, m, err);
    basis->zeros = NEW_ARRAY(double, dofs, err);
    basis->unit_load = NEW_ARRAY(double, dofs, err);
    reduced->modes = NEW_ARRAY(double, dofs * basis->modes_room, err);
    reduced->stiffness = NEW_ARRAY(double, m *m, err);
    if (!error_is_clean(err)) goto cleanup;
    // Without a load every answer to it is 0, in any unit.
    double scale = reduced->scales.load > 0 ? reduced->scales.load : 1;
    for (int64_t k = 0; k < dofs; k++) basis->unit_load[k] = bulk->load[k] / scale;
cleanup:
    return error_is_clean(err);
}

void basis_apply_full(const GrowingBasis *basis, BulkTerm term, const double *x, double *y)
{
    const BulkScales *scales = &basis->reduced->scales;
    double scale = term == BULK_STIFFNESS ? scales->stiffness
                   : term == BULK_DAMPING ? scales->damping
                                          : scales->mass;
    bulk_operator_apply(&basis->full, term, x, y);
    for (int32_t k = 0; k < basis->full.dof_count; k++) y[k] /= scale;
}

// a [old^2] into the upper left corner of a new one, [size^2], zero elsewhere.
static bool grow_square(double **a, int64_t old, int64_t size, Error *err)
{
    double *grown = NEW_ARRAY(double, size *size, err);
    if (!grown) return false;
    for (int64_t j = 0; j < old; j++)
        memcpy(grown + j * size, *a + j * old, (size_t)old * sizeof(double));
    memory_free(*a);
    *a = grown;
    return true;
}

// Fills the rows and columns `first` ... count - 1 of a matrix V' (image of the new modes).
static void fill_square(const ReducedBulk *reduced, int64_t first, const double *product, double *a)
{
    int64_t count = reduced->count;
    for (int64_t j = first; j < count; j++) {
        const double *column = product + (j - first) * count;
        for (int64_t i = 0; i <= j; i++) a[j * count + i] = a[i * count + j] = column[i];
    }
}

// M, C and the load of the modes from `first` on, which stand in reduced->modes; `tried` anew.
static bool project(GrowingBasis *basis, int32_t first, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t dofs = reduced->full_dofs, count = reduced->count, added = count - first;
    double *image = NEW_ARRAY(double, dofs *added, err);
    double *product = NEW_ARRAY(double, count *added, err);
    double *load = NEW_ARRAY(double, count, err);
    if (!image || !product || !load) goto cleanup;
    TRY(grow_square(&reduced->mass, first, count, err));
    TRY(grow_square(&reduced->damping, first, count, err));
    DenseView modes = {reduced->modes, (int32_t)dofs, (int32_t)count};
    DenseView images = {image, (int32_t)dofs, (int32_t)added};
    for (int term = BULK_DAMPING; term <= BULK_MASS; term++) {
        for (int64_t j = 0; j < added; j++)
            basis_apply_full(basis, (BulkTerm)term, reduced->modes + (first + j) * dofs,
                             image + j * dofs);
        dense_multiply_transposed(modes, images, 1, 0, product);
        fill_square(reduced, first, product, term == BULK_MASS ? reduced->mass : reduced->damping);
    }
    dense_apply_transposed(modes, basis->unit_load, 1, 0, load);
    memory_free(reduced->load);
    reduced->load = load;
    load = NULL;
    bulk_operator_destroy(&basis->tried);
    TRY(bulk_operator_reduce(reduced, basis->still, 1, &basis->tried, err));
cleanup:
    memory_free(image);
    memory_free(product);
    memory_free(load);
    return error_is_clean(err);
}

// Static constraint modes, S_K. statics: the full mesh at inertia and viscosity 0.
static bool start_motions(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t dofs = reduced->full_dofs, m = reduced->interface_count;
    TRY(interface_operator_condense(statics, basis->zeros, basis->border, err));
    for (int64_t j = 0; j < m; j++) {
        double *mode = reduced->modes + j * dofs;
        memset(basis->border, 0, (size_t)m * sizeof(double));
        basis->border[j] = 1;
        TRY(interface_operator_expand(statics, basis->border, mode, err));
        for (int64_t i = 0; i < m; i++) mode[basis->full.interface_dofs[i]] = i == j;   // exactly
    }
    // Inside the block K Psi = 0, so that V'KV is the Schur complement of K.
    memcpy(reduced->stiffness, interface_operator_schur(statics), (size_t)(m * m) * sizeof(double));
    TRY(project(basis, 0, err));
cleanup:
    return error_is_clean(err);
}

// vectors -= Phi (Phi' K vectors), twice for rounding; leaves K times the result in `forces`.
static bool project_out(GrowingBasis *basis, int32_t columns, double *vectors, double *forces,
                        Error *err)
{
    const ReducedBulk *reduced = basis->reduced;
    int64_t dofs = reduced->full_dofs;
    double *overlap = NEW_ARRAY(double, (int64_t)reduced->interior_count *columns, err);
    if (!overlap) return false;
    DenseView phi = {reduced->modes + dofs * reduced->interface_count, (int32_t)dofs,
                     reduced->interior_count};
    DenseView force = {forces, (int32_t)dofs, columns};
    DenseView parts = {overlap, reduced->interior_count, columns};
    // Psi needs no such pass: static modes are K-orthogonal to all that rests on the interface.
    for (int pass = 0; pass < 3; pass++) {
        for (int64_t j = 0; j < columns; j++)
            basis_apply_full(basis, BULK_STIFFNESS, vectors + j * dofs, forces + j * dofs);
        if (pass == 2 || reduced->interior_count == 0) break;
        dense_multiply_transposed(phi, force, 1, 0, overlap);
        dense_multiply(phi, parts, -1, 1, vectors);
    }
    memory_free(overlap);
    return true;
}

// Room for `columns` more modes and half as many again, so that it is copied a few times only.
static bool make_room(GrowingBasis *basis, int32_t columns, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    if (reduced->count + columns <= basis->modes_room) return true;
    int32_t room = 3 * (reduced->count + columns) / 2;
    double *modes = memory_resize(reduced->modes, (int64_t)reduced->full_dofs * basis->modes_room,
                                  (int64_t)reduced->full_dofs * room, sizeof(double), err);
    if (!modes) return false;
    reduced->modes = modes;
    basis->modes_room = room;
    return true;
}

bool basis_extend(GrowingBasis *basis, int32_t columns, double *vectors, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t dofs = reduced->full_dofs;
    int32_t first = reduced->count, kept = 0;
    double *forces = NEW_ARRAY(double, dofs *columns, err);
    double *gram = NEW_ARRAY(double, (int64_t)columns *columns, err);
    double *values = NEW_ARRAY(double, columns, err);
    double *eigen_work = NEW_ARRAY(double, dense_eigen_work(columns), err);
    if (!error_is_clean(err)) goto cleanup;
    TRY(make_room(basis, columns, err));
    TRY(project_out(basis, columns, vectors, forces, err));
    DenseView old = {vectors, (int32_t)dofs, columns}, force = {forces, (int32_t)dofs, columns};
    dense_multiply_transposed(old, force, 1, 0, gram);
    if (!dense_eigen(gram, columns, values, eigen_work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: the responses of the interior are not independent");
    for (int64_t j = columns - 1; j >= 0; j--) {
        if (!(values[j] > DEPENDENT * values[columns - 1])) break;
        for (int32_t i = 0; i < columns; i++) gram[j * columns + i] /= sqrt(values[j]);
        kept++;
    }
    DenseView rotation = {gram + (int64_t)(columns - kept) * columns, columns, kept};
    dense_multiply(old, rotation, 1, 0, reduced->modes + dofs * first);
    reduced->interior_count += kept;
    reduced->count += kept;
    TRY(project(basis, first, err));
cleanup:
    memory_free(forces);
    memory_free(gram);
    memory_free(values);
    memory_free(eigen_work);
    return error_is_clean(err);
}

// The static answer to the load, the interface held: exact from then on.
static bool start_load(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    double *x = NEW_ARRAY(double, basis->full.dof_count, err);
    if (!x) goto cleanup;
    TRY(interface_operator_condense(statics, basis->unit_load, basis->border, err));
    TRY(interface_operator_expand(statics, basis->still, x, err));
    if (dense_max_abs(x, basis->full.dof_count) > 0) TRY(basis_extend(basis, 1, x, err));
cleanup:
    memory_free(x);
    return error_is_clean(err);
}

bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    return start_motions(basis, statics, err) && start_load(basis, statics, err);
}
