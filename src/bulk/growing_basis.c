// SPDX-License-Identifier: GPL-2.0-or-later
// Modes are combinations V = X T of answers X of the full mesh, and only T is made orthogonal: from
// products of answers, columns as long as the mesh are multiplied once. What of an answer is
// orthogonal to the others is a difference of nearly equal energies: where too many digits are lost
// new modes are multiplied by the mesh, and all of them where such losses have added up.
#include "bulk/growing_basis.h"

#include "base/dense_halves.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// The squared length of what is left of an answer below which it is rounding.
static const double DEPENDENT = 1e-12;

void basis_destroy(GrowingBasis *basis)
{
    answers_destroy(&basis->answers);
    memory_free(basis->mix);
    *basis = (GrowingBasis){0};
}

bool basis_create(const BulkOperator *full, ReducedBulk *reduced, GrowingBasis *basis, Error *err)
{
    int64_t m = full->interface_count;
    *basis = (GrowingBasis){.reduced = reduced};
    *reduced = (ReducedBulk){.full_dofs = full->dof_count,
                             .interface_count = full->interface_count,
                             .scales = reduced->scales};
    reduced->stiffness = NEW_ARRAY(double, m *m, err);
    return reduced->stiffness && answers_create(full, &reduced->scales, &basis->answers, err);
}

// a [rows * columns] into the upper left corner of a new one, [new_rows * new_columns], zero below;
// the new columns are left to be filled.
static bool grow_matrix(double **a, int64_t rows, int64_t columns, int64_t new_rows,
                        int64_t new_columns, Error *err)
{
    double *grown = memory_bytes(new_rows * new_columns * (int64_t)sizeof *grown, err);
    if (!grown) return false;
    for (int64_t j = 0; j < columns; j++) {
        double *column = grown + j * new_rows;
        memcpy(column, *a + j * rows, (size_t)rows * sizeof *column);
        memset(column + rows, 0, (size_t)(new_rows - rows) * sizeof *column);
    }
    memory_free(*a);
    *a = grown;
    return true;
}

// Work of one extension of V, of `count` columns, by others: the next block of answers, or at a
// renewal modes that were there.
typedef struct Extension {
    const AnswerBlock *next;
    int64_t count, added;   // columns of V, of X_new
    double *gram[BULK_TERMS];   // [answers * added] X' (K, C, M) X_new, then work
    double *old[BULK_TERMS];   // [count * added] V' (K, C, M) X_new
    double *parts;   // [count * added] what of X_new is in V
    double *left[BULK_TERMS];   // [added^2] of Y = X_new - V parts: Y' (K, C, M) Y
    double *lacking;   // [added] f'Y
    double largest;   // energy in K of a column of X_new
    double loss;   // how much larger that is than the energy of what is left of one
    double *rotation;   // [added^2], its last `kept` columns: new modes are Y times these
    int64_t kept;
    double *values, *work;   // [added]; [largest of what follows]
} Extension;

static void extension_destroy(Extension *x)
{
    for (int term = 0; term < BULK_TERMS; term++) {
        memory_free(x->gram[term]);
        memory_free(x->old[term]);
        memory_free(x->left[term]);
    }
    memory_free(x->parts);
    memory_free(x->lacking);
    memory_free(x->rotation);
    memory_free(x->values);
    memory_free(x->work);
}

// answers: with those of the next block.
static bool extension_create(int64_t answers, int64_t count, int64_t added, Extension *x,
                             Error *err)
{
    int64_t eigen_work = dense_eigen_work((int32_t)added);
    *x = (Extension){.count = count, .added = added};
    for (int term = 0; term < BULK_TERMS; term++) {
        x->gram[term] = NEW_ARRAY(double, answers *added, err);
        x->old[term] = NEW_ARRAY(double, count *added, err);
        x->left[term] = NEW_ARRAY(double, added *added, err);
    }
    x->parts = NEW_ARRAY(double, count *added, err);
    x->lacking = NEW_ARRAY(double, added, err);
    x->rotation = NEW_ARRAY(double, added *added, err);
    x->values = NEW_ARRAY(double, added, err);
    x->work = NEW_ARRAY(double, answers *added > eigen_work ? answers * added : eigen_work, err);
    return error_is_clean(err);
}

// That by the next block.
static bool extension_begin(const GrowingBasis *basis, Extension *x, Error *err)
{
    const AnswerBlock *next = &basis->answers.blocks[basis->answers.block_count];
    bool done =
        extension_create(next->first + next->count, basis->reduced->count, next->count, x, err);
    x->next = next;
    return done;
}

// V' (K, C, M) X_new, X_new' (K, C, M) X_new, f'X_new, and of what is in V the static modes' part.
static void project(const GrowingBasis *basis, Extension *x)
{
    int64_t m = basis->reduced->interface_count, added = x->added, count = x->count;
    int64_t first = x->next->first, answers = first + added;
    const double *motion = x->next->motion;
    for (int term = 0; term < BULK_TERMS; term++) {
        for (int64_t j = 0; j < added; j++) {
            const double *column = x->gram[term] + j * answers;
            memcpy(x->work + j * first, column, (size_t)first * sizeof *column);
            memcpy(x->left[term] + j * added, column + first, (size_t)added * sizeof *column);
        }
        dense_multiply_transposed_halves(dense_view(basis->mix, first, count),
                                         dense_view(x->work, first, added), 1, 0, x->old[term]);
    }
    for (int64_t j = 0; j < added; j++) {
        memcpy(x->parts + j * count, motion + j * (m + 1), (size_t)m * sizeof *motion);
        x->lacking[j] = motion[j * (m + 1) + m];
    }
}

// Y = X - V parts instead of X, in old, left and lacking. The static modes' parts are there; those
// of Phi, which is orthonormal in K, are its products.
static void take_out(const GrowingBasis *basis, Extension *x)
{
    const ReducedBulk *reduced = basis->reduced;
    const double *projected[BULK_TERMS] = {
        [BULK_DAMPING] = reduced->damping, [BULK_MASS] = reduced->mass};
    int64_t added = x->added, count = x->count, m = reduced->interface_count;
    DenseView parts = dense_view(x->parts, count, added);
    for (int64_t j = 0; j < added; j++) {
        x->largest = fmax(x->largest, x->left[BULK_STIFFNESS][j * added + j]);
        memcpy(x->parts + j * count + m, x->old[BULK_STIFFNESS] + j * count + m,
               (size_t)(count - m) * sizeof(double));
    }
    for (int term = 0; term < BULK_TERMS; term++) {
        DenseView old = dense_view(x->old[term], count, added);
        dense_multiply_transposed_halves(parts, old, -1, 1, x->left[term]);
        if (!projected[term]) continue;
        dense_multiply_halves(dense_view(projected[term], count, count), parts, -1, 1,
                              x->old[term]);
        dense_multiply_transposed_halves(old, parts, -1, 1, x->left[term]);
    }
    dense_apply_transposed(parts, reduced->load, -1, 1, x->lacking);
}

// The rotation that makes Y orthonormal in K, of those columns that are not rounding.
static bool orthonormalise(Extension *x, Error *err)
{
    int64_t added = x->added;
    memcpy(x->rotation, x->left[BULK_STIFFNESS], (size_t)(added * added) * sizeof(double));
    if (!dense_eigen(x->rotation, (int32_t)added, x->values, x->work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: the responses of the interior are not independent");
    for (x->kept = 0; x->kept < added; x->kept++) {
        int64_t j = added - 1 - x->kept;
        if (!(x->values[j] > DEPENDENT * x->largest)) break;
        for (int64_t i = 0; i < added; i++) x->rotation[j * added + i] /= sqrt(x->values[j]);
        x->loss = x->largest / x->values[j];
    }
cleanup:
    return error_is_clean(err);
}

static DenseView rotation_kept(const Extension *x)
{
    return dense_view(x->rotation + (x->added - x->kept) * x->added, x->added, x->kept);
}

// *matrix := V'TV with the modes that were added.
static bool extend_square(BulkTerm term, double **matrix, Extension *x, Error *err)
{
    int64_t count = x->count, added = x->added, kept = x->kept, size = count + kept;
    DenseView rotation = rotation_kept(x);
    if (!grow_matrix(matrix, count, count, size, size, err)) return false;
    dense_multiply_halves(dense_view(x->old[term], count, added), rotation, 1, 0, x->work);
    for (int64_t j = 0; j < kept; j++)
        for (int64_t i = 0; i < count; i++)
            (*matrix)[(count + j) * size + i] = (*matrix)[i * size + count + j] =
                x->work[j * count + i];
    // R' (left R), in the memory of `gram`, which is done with.
    double *half = x->gram[0], *square = x->gram[1];
    dense_multiply_halves(dense_view(x->left[term], added, added), rotation, 1, 0, half);
    dense_multiply_transposed_halves(rotation, dense_view(half, added, kept), 1, 0, square);
    for (int64_t j = 0; j < kept; j++)
        for (int64_t i = 0; i <= j; i++)
            (*matrix)[(count + j) * size + count + i] = (*matrix)[(count + i) * size + count + j] =
                (square[j * kept + i] + square[i * kept + j]) / 2;
    return true;
}

static bool extend_load(ReducedBulk *reduced, const Extension *x, Error *err)
{
    int64_t count = x->count;
    double *load = memory_resize(reduced->load, count, count + x->kept, sizeof *load, err);
    if (!load) return false;
    reduced->load = load;
    dense_apply_transposed(rotation_kept(x), x->lacking, 1, 0, load + count);
    return true;
}

// New columns of T: [-T parts; 1] R.
static bool extend_mix(GrowingBasis *basis, Extension *x, Error *err)
{
    int64_t added = x->added, count = x->count, kept = x->kept, first = x->next->first;
    int64_t answers = first + added;
    DenseView rotation = rotation_kept(x);
    dense_multiply_halves(dense_view(x->parts, count, added), rotation, 1, 0, x->work);
    double *taken = x->gram[0];
    dense_multiply_halves(dense_view(basis->mix, first, count), dense_view(x->work, count, kept), 1,
                          0, taken);
    TRY(grow_matrix(&basis->mix, first, count, answers, count + kept, err));
    for (int64_t j = 0; j < kept; j++) {
        double *column = basis->mix + (count + j) * answers;
        for (int64_t i = 0; i < first; i++) column[i] = -taken[j * first + i];
        memcpy(column + first, rotation.values + j * added, (size_t)added * sizeof *column);
    }
cleanup:
    return error_is_clean(err);
}

static bool take_up(GrowingBasis *basis, Extension *x, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    TRY(orthonormalise(x, err));
    TRY(extend_square(BULK_DAMPING, &reduced->damping, x, err));
    TRY(extend_square(BULK_MASS, &reduced->mass, x, err));
    TRY(extend_load(reduced, x, err));
    reduced->count += (int32_t)x->kept;
    reduced->interior_count = reduced->count - reduced->interface_count;
cleanup:
    return error_is_clean(err);
}

// Columns of V, from `first` on, into `field` [dofs * columns], zero before. The interface's part
// is 0, to the last bit.
static void form_modes(const GrowingBasis *basis, int64_t first, int64_t columns, double *field)
{
    const Answers *answers = &basis->answers;
    int64_t dofs = basis->reduced->full_dofs, m = basis->reduced->interface_count;
    answers_combine(answers, 1, basis->mix + first * answers->count, columns, field);
    for (int64_t j = 0; j < columns; j++)
        for (int64_t i = 0; i < m; i++) field[j * dofs + answers->full->interface_dofs[i]] = 0;
}

// Products by the mesh of some of the modes from V on, with all: columns of old, left and lacking.
static bool multiply_modes(const GrowingBasis *basis, int64_t from, int64_t columns, Extension *x,
                           Error *err)
{
    const Answers *answers = &basis->answers;
    int64_t dofs = basis->reduced->full_dofs, count = x->count, size = count + x->added;
    double *field = NEW_ARRAY(double, dofs *columns, err);
    double *image = NEW_ARRAY(double, dofs *columns, err);
    if (!field || !image) goto cleanup;
    form_modes(basis, count + from, columns, field);
    for (int term = 0; term < BULK_TERMS; term++) {
        double *product = x->gram[0], *of_modes = x->gram[1];
        answers_project(answers, (BulkTerm)term, field, columns, image, product);
        dense_multiply_transposed_halves(dense_view(basis->mix, answers->count, size),
                                         dense_view(product, answers->count, columns), 1, 0,
                                         of_modes);
        for (int64_t j = 0; j < columns; j++) {
            const double *column = of_modes + j * size;
            memcpy(x->old[term] + (from + j) * count, column, (size_t)count * sizeof *column);
            memcpy(x->left[term] + (from + j) * x->added, column + count,
                   (size_t)x->added * sizeof *column);
        }
    }
    dense_apply_transposed(dense_view(field, dofs, columns), answers->unit_load, 1, 0,
                           x->lacking + from);
cleanup:
    memory_free(field);
    memory_free(image);
    return error_is_clean(err);
}

// Rows and columns beyond the first `kept` go.
static void cut_square(double *matrix, int64_t size, int64_t kept)
{
    for (int64_t j = 1; j < kept; j++)
        memmove(matrix + j * kept, matrix + j * size, (size_t)kept * sizeof *matrix);
}

bool basis_renew(GrowingBasis *basis, int32_t first, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t count = first, answers = basis->answers.count, added = reduced->count - count;
    Extension x = {0};
    TRY(extension_create(answers, count, added, &x, err));
    for (int64_t from = 0, columns = 0; from < added; from += columns) {
        columns = added - from < ANSWERS_TOGETHER ? added - from : ANSWERS_TOGETHER;
        TRY(multiply_modes(basis, from, columns, &x, err));
    }
    cut_square(reduced->damping, reduced->count, count);
    cut_square(reduced->mass, reduced->count, count);
    reduced->count = first;
    take_out(basis, &x);
    TRY(take_up(basis, &x, err));
    double *modes = basis->mix + count * answers;
    dense_multiply_halves(dense_view(basis->mix, answers, count), dense_view(x.parts, count, added),
                          -1, 1, modes);
    dense_multiply_halves(dense_view(modes, answers, added), rotation_kept(&x), 1, 0, x.work);
    memcpy(modes, x.work, (size_t)(answers * x.kept) * sizeof *modes);
cleanup:
    extension_destroy(&x);
    return error_is_clean(err);
}

bool basis_extend(GrowingBasis *basis, Error *err)
{
    Extension x = {0};
    TRY(extension_begin(basis, &x, err));
    TRY(answers_multiply(&basis->answers, x.gram, err));
    project(basis, &x);
    take_out(basis, &x);
    TRY(take_up(basis, &x, err));
    TRY(extend_mix(basis, &x, err));
    answers_keep(&basis->answers);
    if (x.loss > basis->loss_max) TRY(basis_renew(basis, (int32_t)x.count, err));
cleanup:
    extension_destroy(&x);
    return error_is_clean(err);
}

// Takes the static modes as they are: inside the block K Psi = 0, so that Psi'K Psi is S_K.
static bool take_motions(GrowingBasis *basis, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t m = reduced->interface_count;
    Extension x = {0};
    TRY(extension_begin(basis, &x, err));
    TRY(answers_multiply(&basis->answers, x.gram, err));
    reduced->mass = NEW_ARRAY(double, m *m, err);
    reduced->damping = NEW_ARRAY(double, m *m, err);
    reduced->load = NEW_ARRAY(double, m, err);
    basis->mix = NEW_ARRAY(double, m *m, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t j = 0; j < m; j++) {
        for (int64_t i = 0; i < m; i++) {
            int64_t low = i > j ? j * m + i : i * m + j;
            reduced->mass[j * m + i] = x.gram[BULK_MASS][low];
            reduced->damping[j * m + i] = x.gram[BULK_DAMPING][low];
        }
        reduced->load[j] = x.next->motion[j * (m + 1) + m];
        basis->mix[j * m + j] = 1;
    }
    reduced->count = reduced->interface_count;
    answers_keep(&basis->answers);
cleanup:
    extension_destroy(&x);
    return error_is_clean(err);
}

bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    int64_t m = reduced->interface_count;
    const double *schur = interface_operator_schur(statics);
    double *motions = NEW_ARRAY(double, m *m, err);
    AnswerBlock *next = answers_next(&basis->answers, (StripPoint){0, 0}, m, err);
    if (!motions || !next) goto cleanup;
    memcpy(reduced->stiffness, schur, (size_t)(m * m) * sizeof *schur);
    for (int64_t j = 0; j < m; j++) {
        motions[j * m + j] = next->motion[j * (m + 1) + j] = 1;
        memcpy(next->reaction + j * (m + 1), schur + j * m, (size_t)m * sizeof *schur);
    }
    TRY(interface_operator_answer(statics, motions, (int32_t)m, next->field, err));
    TRY(take_motions(basis, err));
    next = answers_next(&basis->answers, (StripPoint){0, 0}, 1, err);
    if (!next) goto cleanup;
    TRY(interface_operator_answer_held(statics, basis->answers.unit_load, next->field,
                                       next->reaction, err));
    for (int64_t i = 0; i < m; i++) next->reaction[i] = -next->reaction[i];
    next->reaction[m] = 1;
    if (dense_max_abs(next->field, reduced->full_dofs) > 0) TRY(basis_extend(basis, err));
cleanup:
    memory_free(motions);
    return error_is_clean(err);
}

// The static modes are answers.
bool basis_write_modes(GrowingBasis *basis, Error *err)
{
    ReducedBulk *reduced = basis->reduced;
    const Answers *answers = &basis->answers;
    int64_t dofs = reduced->full_dofs, m = reduced->interface_count;
    double *modes = reduced->modes = NEW_ARRAY(double, dofs * reduced->count, err);
    if (!modes) return false;
    memcpy(modes, answers->blocks[0].field, (size_t)(dofs * m) * sizeof *modes);
    form_modes(basis, m, reduced->interior_count, modes + dofs * m);
    return true;
}
