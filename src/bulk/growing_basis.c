// SPDX-License-Identifier: GPL-2.0-or-later
// Most of the work is products of matrices as long as the mesh: with V the modes and X new answers,
// four of them. V'KX says what of X lies in V,
//
//     Y = X - V q,   q = [ X on the interface; Phi' K X ];
//
// the others are V q, V'CY and V'MY. What belongs to Y alone is small beside them.
#include "bulk/growing_basis.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// The squared length of the part orthogonal to the others below which a new vector is rounding.
static const double DEPENDENT = 1e-12;

// The squared length of the part that lies in the others, of what is left, from which on rounding
// is taken out, too.
static const double TAKEN_MAX = 1e3;

void basis_destroy(GrowingBasis *basis)
{
    bulk_operator_destroy(&basis->full);
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

// With room for half as many again, so that modes are copied a few times only.
double *basis_make_room(GrowingBasis *basis, int32_t columns, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t dofs = reduced->full_dofs;
    if (reduced->count + columns > basis->modes_room) {
        int32_t room = 3 * (reduced->count + columns) / 2;
        double *modes = memory_resize(reduced->modes, dofs * basis->modes_room, dofs * room,
                                      sizeof(double), err);
        if (!modes) return NULL;
        reduced->modes = modes;
        basis->modes_room = room;
    }
    return reduced->modes + dofs * reduced->count;
}

static DenseView view_modes(const GrowingBasis *basis, int64_t first, int64_t columns)
{
    const ReducedBulk *reduced = basis->reduced;
    return (DenseView){reduced->modes + first * reduced->full_dofs, reduced->full_dofs,
                       (int32_t)columns};
}

// image = T times these
static DenseView apply_term(const GrowingBasis *basis, BulkTerm term, DenseView vectors,
                            double *image)
{
    for (int64_t j = 0; j < vectors.columns; j++)
        basis_apply_full(basis, term, vectors.values + j * vectors.rows, image + j * vectors.rows);
    return (DenseView){image, vectors.rows, vectors.columns};
}

// *matrix := V'TV, known up to `first`; product: its columns from there on.
static bool extend_square(double **matrix, int64_t first, int64_t count, const double *product,
                          Error *err)
{
    if (!grow_square(matrix, first, count, err)) return false;
    for (int64_t j = first; j < count; j++) {
        const double *column = product + (j - first) * count;
        for (int64_t i = 0; i <= j; i++)
            (*matrix)[j * count + i] = (*matrix)[i * count + j] = column[i];
    }
    return true;
}

// C, M and the load of the modes from `first` on, in one pass over all modes: to read them takes as
// long as to multiply by a few columns.
static bool project(const GrowingBasis *basis, int64_t first, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t dofs = reduced->full_dofs, count = reduced->count, added = count - first;
    DenseView added_modes = view_modes(basis, first, added);
    double *image = NEW_ARRAY(double, dofs * 2 * added, err);
    double *product = NEW_ARRAY(double, count * 2 * added, err);
    double *load = memory_resize(reduced->load, first, count, sizeof *load, err);
    if (load) reduced->load = load;
    if (!error_is_clean(err)) goto cleanup;
    apply_term(basis, BULK_DAMPING, added_modes, image);
    apply_term(basis, BULK_MASS, added_modes, image + dofs * added);
    dense_multiply_transposed(view_modes(basis, 0, count),
                              (DenseView){image, (int32_t)dofs, (int32_t)(2 * added)}, 1, 0,
                              product);
    TRY(extend_square(&reduced->damping, first, count, product, err));
    TRY(extend_square(&reduced->mass, first, count, product + count * added, err));
    dense_apply_transposed(added_modes, basis->unit_load, 1, 0, load + first);
cleanup:
    memory_free(image);
    memory_free(product);
    return error_is_clean(err);
}

typedef struct Extension {
    int64_t count, added;   // columns of V, of X
    double *vectors;   // [dofs * added] X, then Y, then the new modes; not owned
    double *image;   // [dofs * added] work
    double *parts;   // [count * added] q
    double *gram;   // [added^2] Y'KY, then R
    double *values, *eigen_work;   // [added] of Y'KY; [dense_eigen_work(added)]
} Extension;

static void extension_destroy(Extension *work)
{
    memory_free(work->image);
    memory_free(work->parts);
    memory_free(work->gram);
    memory_free(work->values);
    memory_free(work->eigen_work);
}

static bool extension_create(const GrowingBasis *basis, int32_t columns, Extension *work,
                             Error *err)
{
    int64_t dofs = basis->reduced->full_dofs, count = basis->reduced->count, added = columns;
    *work = (Extension){
        .count = count, .added = added, .vectors = basis->reduced->modes + dofs * count};
    work->image = NEW_ARRAY(double, dofs *added, err);
    work->parts = NEW_ARRAY(double, count *added, err);
    work->gram = NEW_ARRAY(double, added *added, err);
    work->values = NEW_ARRAY(double, added, err);
    work->eigen_work = NEW_ARRAY(double, dense_eigen_work(columns), err);
    return error_is_clean(err);
}

// X becomes Y, exactly 0 on the interface; leaves Y'KY.
static void take_parts(const GrowingBasis *basis, Extension *work)
{
    int64_t dofs = basis->reduced->full_dofs, m = basis->reduced->interface_count;
    int64_t count = work->count;
    const int32_t *border = basis->full.interface_dofs;
    DenseView modes = view_modes(basis, 0, count);
    DenseView vectors = view_modes(basis, count, work->added);
    DenseView image = apply_term(basis, BULK_STIFFNESS, vectors, work->image);
    dense_multiply_transposed(modes, image, 1, 0, work->parts);
    for (int64_t j = 0; j < work->added; j++)
        for (int64_t i = 0; i < m; i++)
            work->parts[j * count + i] = work->vectors[j * dofs + border[i]];
    dense_multiply(modes, (DenseView){work->parts, (int32_t)count, (int32_t)work->added}, -1, 1,
                   work->vectors);
    for (int64_t j = 0; j < work->added; j++)
        for (int64_t i = 0; i < m; i++) work->vectors[j * dofs + border[i]] = 0;
    apply_term(basis, BULK_STIFFNESS, vectors, work->image);
    dense_multiply_transposed(vectors, image, 1, 0, work->gram);
}

// Y becomes Y R, orthonormal in K, of *kept columns; *least: the smallest squared length kept.
static bool orthonormalise(const GrowingBasis *basis, Extension *work, int64_t *kept, double *least,
                           Error *err)
{
    int64_t added = work->added;
    double *gram = work->gram, *values = work->values;
    *kept = 0;
    if (!dense_eigen(gram, (int32_t)added, values, work->eigen_work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: the responses of the interior are not independent");
    for (int64_t j = added - 1; j >= 0; j--) {
        if (!(values[j] > DEPENDENT * values[added - 1])) break;
        for (int64_t i = 0; i < added; i++) gram[j * added + i] /= sqrt(values[j]);
        *least = values[j];
        ++*kept;
    }
    DenseView rotation = {gram + (added - *kept) * added, (int32_t)added, (int32_t)*kept};
    DenseView vectors = view_modes(basis, work->count, added);
    dense_multiply(vectors, rotation, 1, 0, work->image);
    memcpy(work->vectors, work->image, (size_t)(vectors.rows * *kept) * sizeof *work->image);
    work->added = *kept;
cleanup:
    return error_is_clean(err);
}

// The largest squared length that was taken out of a vector.
static double largest_part(const GrowingBasis *basis, const Extension *work)
{
    double largest = 0;
    for (int64_t j = 0; j < work->added; j++) {
        const double *q = work->parts + j * work->count + basis->reduced->interface_count;
        largest = fmax(largest, dense_dot(q, q, basis->reduced->interior_count));
    }
    return largest;
}

bool basis_extend(GrowingBasis *basis, int32_t columns, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t kept = 0;
    double taken = 0, least = 0;
    Extension work;
    TRY(extension_create(basis, columns, &work, err));
    for (int pass = 0; pass < 2; pass++) {
        take_parts(basis, &work);
        taken = largest_part(basis, &work);
        TRY(orthonormalise(basis, &work, &kept, &least, err));
        if (taken <= TAKEN_MAX * least) break;
    }
    reduced->interior_count += (int32_t)kept;
    reduced->count += (int32_t)kept;
    TRY(project(basis, work.count, err));
cleanup:
    extension_destroy(&work);
    return error_is_clean(err);
}

// Static constraint modes, S_K. statics: the full mesh at inertia and viscosity 0.
static bool start_motions(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t m = reduced->interface_count;
    double *motions = NEW_ARRAY(double, m *m, err);
    if (!motions) goto cleanup;
    for (int64_t j = 0; j < m; j++) motions[j * m + j] = 1;
    TRY(interface_operator_answer(statics, motions, (int32_t)m, reduced->modes, err));
    // Inside the block K Psi = 0, so that V'KV is the Schur complement of K.
    memcpy(reduced->stiffness, interface_operator_schur(statics), (size_t)(m * m) * sizeof(double));
    TRY(project(basis, 0, err));
cleanup:
    memory_free(motions);
    return error_is_clean(err);
}

// The static answer to the load, the interface held: exact from then on.
static bool start_load(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    double *x = basis_make_room(basis, 1, err);
    if (!x) goto cleanup;
    TRY(interface_operator_condense(statics, basis->unit_load, basis->border, err));
    TRY(interface_operator_expand(statics, basis->still, x, err));
    if (dense_max_abs(x, basis->full.dof_count) > 0) TRY(basis_extend(basis, 1, err));
cleanup:
    return error_is_clean(err);
}

bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    return start_motions(basis, statics, err) && start_load(basis, statics, err);
}

// Rows `first` to `first + rows` of a column of A, but for its part in K.
static void fill_column(const ReducedBulk *reduced, const double *factor, int64_t column,
                        int64_t first, int64_t rows, double *out)
{
    const double *mass = reduced->mass + column * reduced->count + first;
    const double *damping = reduced->damping + column * reduced->count + first;
    double i = factor[BULK_MASS], c = factor[BULK_DAMPING];
    for (int64_t row = 0; row < rows; row++) out[row] = i * mass[row] + c * damping[row];
}

// With A_qq = L L' and Z = L^-1 [A_qb  load_q]: S = A_bb - Z_b' Z_b, the energy is Z_f' Z_f.
bool basis_condense(const GrowingBasis *basis, const double *factor, double *schur, double *energy,
                    Error *err)
{
    const ReducedBulk *reduced = basis->reduced;
    int64_t m = reduced->interface_count, r = reduced->interior_count;
    double k = factor[BULK_STIFFNESS];
    double *interior = NEW_ARRAY(double, r *r, err), *z = NEW_ARRAY(double, r *(m + 1), err);
    if (!interior || !z) goto cleanup;
    for (int64_t j = 0; j < r; j++) {
        fill_column(reduced, factor, m + j, m, r, interior + j * r);
        interior[j * r + j] += k;
    }
    for (int64_t j = 0; j < m; j++) {
        fill_column(reduced, factor, j, m, r, z + j * r);
        fill_column(reduced, factor, j, 0, m, schur + j * m);
    }
    dense_add_scaled(k, reduced->stiffness, (int32_t)(m * m), schur);
    memcpy(z + m * r, reduced->load + m, (size_t)r * sizeof *z);
    if (!dense_cholesky(interior, (int32_t)r))
        FAIL(err, ERROR_COMPUTE, "the interior of the reduced bulk is not positive definite");
    dense_lower_divide(interior, (int32_t)r, (int32_t)(m + 1), z);
    DenseView motions = {z, (int32_t)r, (int32_t)m};
    dense_multiply_transposed(motions, motions, -1, 1, schur);
    *energy = dense_dot(z + m * r, z + m * r, (int32_t)r);
cleanup:
    memory_free(interior);
    memory_free(z);
    return error_is_clean(err);
}
