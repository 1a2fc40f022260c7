// SPDX-License-Identifier: GPL-2.0-or-later
// A greedy basis whose error is known where it is built. At a point (viscosity, inertia) of the
// strip, with S of the full mesh from its factor and S_r of what the basis holds so far, the
// eigenvectors of
//
//     (S_r - S) y = mu S y,    y_j' S y_k = 1 if j = k, else 0,
//
// are the motions of the interface that the basis answers worst, mu the relative error of each. The
// difference of responses e = R_r y - R y, with R y the answer of the full mesh, vanishes on the
// interface, has the energy e'A e = mu and is A-orthogonal to Phi and to the other e. So adding
// exactly the e with mu above the tolerance leaves no error above it at this point, with the
// smallest number of new vectors.
#include "bulk/reduction.h"

#include "base/dense.h"
#include "base/memory.h"
#include "bulk/interface_operator.h"

#include <math.h>
#include <string.h>

// Levels of inertia that the basis is built at, a factor of about LEVEL_RATIO apart, from
// LEVEL_LOWEST times the slowest mode of the interior, below which it follows like a spring, to
// that of one element; between two of them, and LEVEL_BEYOND above, the error is only checked.
static const double LEVEL_RATIO = 10, LEVEL_LOWEST = 0.1, LEVEL_BEYOND = 1e3;
enum { SLOWEST_ITERATIONS = 10 };

// Where inertia acts within an element the mesh is off itself, by about a quarter of its share
// (a thin layer in linear elements with lumped mass). A tolerance of 0.01 allows a tenth of that.
static const double MESH_SHARE = 2.5;

// Errors of S below this are its rounding.
static const double ERROR_LEAST = 1e-10;

// New vectors whose part orthogonal to the others is smaller than this, squared, are rounding.
static const double DEPENDENT = 1e-12;

typedef struct Point {
    double viscosity, inertia;
} Point;

// Work of one build.
typedef struct Builder {
    const Bulk *bulk;
    const ReductionDef *def;
    ReducedBulk *reduced;
    BulkOperator full, tried;   // of `bulk`, and of what `reduced` holds so far
    double element_inertia;   // where mass takes over within an element
    int32_t modes_room;   // columns that reduced->modes has room for
    double *exact, *excess;   // [m^2] S, then its Cholesky factor; S_r - S
    double *values;   // [m] eigenvalues
    double *eigen_work;   // [dense_eigen_work(m)]
    double *border;   // [m]
    double *still;   // [m] zeros: the interface at rest
    double *zeros, *unit_load;   // [dofs]
} Builder;

void reduction_destroy(ReducedBulk *reduced)
{
    if (reduced->storage) {
        memory_free(reduced->storage);
    } else {
        memory_free(reduced->mass);
        memory_free(reduced->damping);
        memory_free(reduced->stiffness);
        memory_free(reduced->viscous);
        memory_free(reduced->load);
    }
    memory_free(reduced->modes);
    *reduced = (ReducedBulk){0};
}

void reduction_recover(const ReducedBulk *reduced, const double *state, double *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply(modes, state, 1, 0, full);
}

// Between two levels the error is not known; it was found to stay below the larger of theirs (a
// test asks at random).
double reduction_error(const ReducedBulk *reduced, double inertia)
{
    const ReductionErrors *errors = &reduced->errors;
    if (errors->count == 0) return 0;
    int32_t above = 0;
    while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
    double below = above > 0 ? errors->error[above - 1] : 0;
    return fmax(below, errors->error[above]);
}

// All but `reduced`, which is what was asked for.
static void builder_destroy(Builder *work)
{
    bulk_operator_destroy(&work->full);
    bulk_operator_destroy(&work->tried);
    memory_free(work->exact);
    memory_free(work->excess);
    memory_free(work->values);
    memory_free(work->eigen_work);
    memory_free(work->border);
    memory_free(work->still);
    memory_free(work->zeros);
    memory_free(work->unit_load);
}

// work: bulk, def and reduced are set, the latter's sizes and scales too.
static bool builder_create(const int32_t *interface_dofs, Builder *work, Error *err)
{
    const Bulk *bulk = work->bulk;
    const ReductionDef *def = work->def;
    ReducedBulk *reduced = work->reduced;
    int32_t m = reduced->interface_count;
    int64_t dofs = bulk->dof_count, square = (int64_t)m * m;
    work->modes_room = 4 * m + 64;
    TRY(bulk_operator_create(bulk, NULL, interface_dofs, m, &work->full, err));
    work->exact = NEW_ARRAY(double, square, err);
    work->excess = NEW_ARRAY(double, square, err);
    work->values = NEW_ARRAY(double, m, err);
    work->eigen_work = NEW_ARRAY(double, dense_eigen_work(m), err);
    work->border = NEW_ARRAY(double, m, err);
    work->still = NEW_ARRAY(double, m, err);
    work->zeros = NEW_ARRAY(double, dofs, err);
    work->unit_load = NEW_ARRAY(double, dofs, err);
    reduced->modes = NEW_ARRAY(double, dofs * work->modes_room, err);
    reduced->stiffness = NEW_ARRAY(double, square, err);
    if (!error_is_clean(err)) goto cleanup;
    // Without a load every answer to it is 0, and 1 as good a unit as any.
    double scale = def->scales.load > 0 ? def->scales.load : 1;
    for (int64_t k = 0; k < dofs; k++) work->unit_load[k] = bulk->load[k] / scale;
cleanup:
    return error_is_clean(err);
}

// y = K x / E, C x / eta or M x / (rho L^2) on the full mesh.
static void apply_normalised(const Builder *work, BulkTerm term, const double *x, double *y)
{
    const BulkScales *scales = &work->def->scales;
    double scale = term == BULK_STIFFNESS ? scales->stiffness
                   : term == BULK_DAMPING ? scales->damping
                                          : scales->mass;
    bulk_operator_apply(&work->full, term, x, y);
    for (int32_t k = 0; k < work->full.dof_count; k++) y[k] /= scale;
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
static bool project(Builder *work, int32_t first, Error *err)
{
    ReducedBulk *reduced = work->reduced;
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
            apply_normalised(work, (BulkTerm)term, reduced->modes + (first + j) * dofs,
                             image + j * dofs);
        dense_multiply_transposed(modes, images, 1, 0, product);
        fill_square(reduced, first, product, term == BULK_MASS ? reduced->mass : reduced->damping);
    }
    dense_apply_transposed(modes, work->unit_load, 1, 0, load);
    memory_free(reduced->load);
    reduced->load = load;
    load = NULL;
    bulk_operator_destroy(&work->tried);
    TRY(bulk_operator_reduce(reduced, work->still, 1, &work->tried, err));
cleanup:
    memory_free(image);
    memory_free(product);
    memory_free(load);
    return error_is_clean(err);
}

// Static constraint modes, S_K. statics: the full mesh at inertia and viscosity 0.
static bool start_motions(Builder *work, InterfaceOperator *statics, Error *err)
{
    ReducedBulk *reduced = work->reduced;
    int64_t dofs = reduced->full_dofs, m = reduced->interface_count;
    TRY(interface_operator_condense(statics, work->zeros, work->border, err));
    for (int64_t j = 0; j < m; j++) {
        double *mode = reduced->modes + j * dofs;
        memset(work->border, 0, (size_t)m * sizeof(double));
        work->border[j] = 1;
        TRY(interface_operator_expand(statics, work->border, mode, err));
        for (int64_t i = 0; i < m; i++) mode[work->full.interface_dofs[i]] = i == j;   // exactly
    }
    // The modes do K-work on nothing inside, so V'KV is the Schur complement of K itself.
    memcpy(reduced->stiffness, interface_operator_schur(statics), (size_t)(m * m) * sizeof(double));
    TRY(project(work, 0, err));
cleanup:
    return error_is_clean(err);
}

// vectors -= Phi (Phi' K vectors), twice for rounding; leaves K times the result in `forces`.
static bool project_out(Builder *work, int32_t columns, double *vectors, double *forces, Error *err)
{
    const ReducedBulk *reduced = work->reduced;
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
            apply_normalised(work, BULK_STIFFNESS, vectors + j * dofs, forces + j * dofs);
        if (pass == 2 || reduced->interior_count == 0) break;
        dense_multiply_transposed(phi, force, 1, 0, overlap);
        dense_multiply(phi, parts, -1, 1, vectors);
    }
    memory_free(overlap);
    return true;
}

// Room for `columns` more modes. Half as many again are taken at once, so that a basis which grows
// level by level is copied a few times only.
static bool make_room(Builder *work, int32_t columns, Error *err)
{
    ReducedBulk *reduced = work->reduced;
    if (reduced->count + columns <= work->modes_room) return true;
    int32_t room = 3 * (reduced->count + columns) / 2;
    double *modes = memory_resize(reduced->modes, (int64_t)reduced->full_dofs * work->modes_room,
                                  (int64_t)reduced->full_dofs * room, sizeof(double), err);
    if (!modes) return false;
    reduced->modes = modes;
    work->modes_room = room;
    return true;
}

// Makes `vectors` [dofs * columns], zero on the interface, part of Phi: what they hold beyond it,
// orthonormal in K. They are changed.
static bool extend(Builder *work, int32_t columns, double *vectors, Error *err)
{
    ReducedBulk *reduced = work->reduced;
    int64_t dofs = reduced->full_dofs;
    int32_t first = reduced->count, kept = 0;
    double *forces = NEW_ARRAY(double, dofs *columns, err);
    double *gram = NEW_ARRAY(double, (int64_t)columns *columns, err);
    double *values = NEW_ARRAY(double, columns, err);
    double *eigen_work = NEW_ARRAY(double, dense_eigen_work(columns), err);
    if (!error_is_clean(err)) goto cleanup;
    TRY(make_room(work, columns, err));
    TRY(project_out(work, columns, vectors, forces, err));
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
    TRY(project(work, first, err));
cleanup:
    memory_free(forces);
    memory_free(gram);
    memory_free(values);
    memory_free(eigen_work);
    return error_is_clean(err);
}

// The static answer to the load, the interface held: exact from then on.
static bool start_load(Builder *work, InterfaceOperator *statics, Error *err)
{
    double *x = NEW_ARRAY(double, work->full.dof_count, err);
    if (!x) goto cleanup;
    TRY(interface_operator_condense(statics, work->unit_load, work->border, err));
    TRY(interface_operator_expand(statics, work->still, x, err));
    if (dense_max_abs(x, work->full.dof_count) > 0) TRY(extend(work, 1, x, err));
cleanup:
    memory_free(x);
    return error_is_clean(err);
}

// The inertia at which the slowest mode of the interior is in balance, K x = slowest M x: inverse
// iteration, x'M x = 1 before each.
static bool find_slowest(Builder *work, InterfaceOperator *statics, double *slowest, Error *err)
{
    int32_t dofs = work->full.dof_count;
    double *x = NEW_ARRAY(double, dofs, err), *rhs = NEW_ARRAY(double, dofs, err);
    if (!x || !rhs) goto cleanup;
    for (int32_t k = 0; k < dofs; k++) x[k] = 1;
    for (int32_t j = 0; j < work->full.interface_count; j++) x[work->full.interface_dofs[j]] = 0;
    for (int32_t round = 0; round < SLOWEST_ITERATIONS; round++) {
        apply_normalised(work, BULK_MASS, x, rhs);
        double size = sqrt(dense_dot(x, rhs, dofs));
        for (int32_t k = 0; k < dofs; k++) rhs[k] /= size;
        TRY(interface_operator_condense(statics, rhs, work->border, err));
        TRY(interface_operator_expand(statics, work->still, x, err));
        *slowest = 1 / dense_dot(x, rhs, dofs);
    }
cleanup:
    memory_free(x);
    memory_free(rhs);
    return error_is_clean(err);
}

// The largest K_jj / M_jj of the interface.
static double find_element_inertia(const Builder *work)
{
    const Bulk *bulk = work->bulk;
    const BulkScales *scales = &work->def->scales;
    double largest = 0;
    for (int32_t j = 0; j < work->full.interface_count; j++) {
        int32_t dof = work->full.interface_dofs[j];
        double stiffness = bulk->stiffness[sparse_entry(&bulk->pattern, dof, dof)];
        largest = fmax(largest, stiffness / bulk->mass[dof] * scales->mass / scales->stiffness);
    }
    return largest;
}

static double allowed_error(const Builder *work, Point point)
{
    double tolerance = work->def->tolerance, share = point.inertia / work->element_inertia;
    return fmax(tolerance * (tolerance + MESH_SHARE * share), ERROR_LEAST);
}

// The point as factors of the scene's own M, C and K, with which both operators are made.
static OperatorTerms point_terms(const Builder *work, Point point)
{
    const BulkScales *scales = &work->def->scales;
    return (OperatorTerms){.mass = point.inertia / scales->mass,
                           .damping = point.viscosity / scales->damping,
                           .stiffness = (1 - point.viscosity) / scales->stiffness};
}

// Solves (S_r - S) y = mu S y: mu ascending in `values`, y in the columns of `excess`.
static bool compare(Builder *work, const InterfaceOperator *full, const InterfaceOperator *tried,
                    Error *err)
{
    int32_t m = work->reduced->interface_count;
    const double *schur = interface_operator_schur(full);
    const double *reduced_schur = interface_operator_schur(tried);
    for (int64_t k = 0; k < (int64_t)m * m; k++) {
        work->exact[k] = schur[k];
        work->excess[k] = reduced_schur[k] - schur[k];
    }
    if (!dense_cholesky(work->exact, m))
        FAIL(err, ERROR_COMPUTE, "the interface operator is not positive definite");
    dense_divide_both_sides(work->exact, m, work->excess);
    if (!dense_eigen(work->excess, m, work->values, work->eigen_work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: no eigenvalues of the reduction's error");
cleanup:
    return error_is_clean(err);
}

// What one point asks for: columns of the full mesh's answers, and of the reduced unknowns of the
// basis's answers to the same.
typedef struct Answers {
    int32_t count;
    double *full;   // [dofs * count]; in the end the differences
    double *state;   // [reduced->count * count]
} Answers;

// Answers to the last `wanted` columns of `excess`, scaled so that their difference has energy 1.
static bool answer_motions(Builder *work, InterfaceOperator *full, InterfaceOperator *tried,
                           int32_t wanted, Answers *answers, Error *err)
{
    int64_t m = work->reduced->interface_count;
    // No load inside: what expand then gives is the answer to the interface's motion alone.
    TRY(interface_operator_condense(full, work->zeros, work->border, err));
    TRY(interface_operator_condense(tried, work->zeros, work->border, err));
    for (int32_t k = 0; k < wanted; k++) {
        double *y = work->excess + (m - 1 - k) * m;
        double scale = 1 / sqrt(work->values[m - 1 - k]);
        dense_lower_solve_transposed(work->exact, (int32_t)m, y);
        for (int32_t i = 0; i < m; i++) y[i] *= scale;
        int64_t column = answers->count++;
        TRY(interface_operator_expand(full, y, answers->full + column * work->full.dof_count, err));
        TRY(interface_operator_expand(tried, y, answers->state + column * work->tried.dof_count,
                                      err));
    }
cleanup:
    return error_is_clean(err);
}

// Answers to the load, the interface held, where their difference has more than `allowed` of the
// energy; scaled likewise.
static bool answer_load(Builder *work, InterfaceOperator *full, InterfaceOperator *tried,
                        double allowed, Answers *answers, Error *err)
{
    int32_t dofs = work->full.dof_count, count = work->tried.dof_count;
    const double *load = work->reduced->load;
    double *x = answers->full + (int64_t)answers->count * dofs;
    double *state = answers->state + (int64_t)answers->count * count;
    TRY(interface_operator_condense(full, work->unit_load, work->border, err));
    TRY(interface_operator_expand(full, work->still, x, err));
    TRY(interface_operator_condense(tried, load, work->border, err));
    TRY(interface_operator_expand(tried, work->still, state, err));
    // A Galerkin answer takes up less work than the exact one, by the energy of the difference.
    double energy = dense_dot(x, work->unit_load, dofs);
    double missing = energy - dense_dot(state, load, count);
    if (!(missing > allowed * energy)) goto cleanup;
    for (int32_t k = 0; k < dofs; k++) x[k] /= sqrt(missing);
    for (int32_t k = 0; k < count; k++) state[k] /= sqrt(missing);
    answers->count++;
cleanup:
    return error_is_clean(err);
}

// full := modes state - full, zero on the interface.
static void subtract_answers(const Builder *work, Answers *answers)
{
    const ReducedBulk *reduced = work->reduced;
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    DenseView states = {answers->state, reduced->count, answers->count};
    dense_multiply(modes, states, 1, -1, answers->full);
    for (int64_t k = 0; k < answers->count; k++) {
        for (int32_t j = 0; j < reduced->interface_count; j++)
            answers->full[k * reduced->full_dofs + work->full.interface_dofs[j]] = 0;
    }
}

// Adds what the basis lacks at `point`, and says how far S is off there then.
static bool visit(Builder *work, Point point, double *left, Error *err)
{
    int32_t m = work->reduced->interface_count, wanted = 0;
    double allowed = allowed_error(work, point);
    Answers answers = {0};
    OperatorTerms terms = point_terms(work, point);
    InterfaceOperator *full = interface_operator_create(&work->full, terms, err), *tried = NULL;
    if (full) tried = interface_operator_create(&work->tried, terms, err);
    if (!tried) goto cleanup;
    TRY(compare(work, full, tried, err));
    // What is added leaves nothing of its error here; the first that is not added is what is left.
    while (wanted < m && work->values[m - 1 - wanted] > allowed) wanted++;
    *left = wanted < m ? fmax(work->values[m - 1 - wanted], 0) : 0;
    answers.full = NEW_ARRAY(double, (int64_t)work->full.dof_count *(wanted + 1), err);
    answers.state = NEW_ARRAY(double, (int64_t)work->tried.dof_count *(wanted + 1), err);
    if (!error_is_clean(err)) goto cleanup;
    TRY(answer_motions(work, full, tried, wanted, &answers, err));
    TRY(answer_load(work, full, tried, allowed, &answers, err));
    if (answers.count == 0) goto cleanup;
    subtract_answers(work, &answers);
    TRY(extend(work, answers.count, answers.full, err));
cleanup:
    interface_operator_destroy(full);
    interface_operator_destroy(tried);
    memory_free(answers.full);
    memory_free(answers.state);
    if (!error_is_clean(err)) error_context(err, "at inertia %g", point.inertia);
    return error_is_clean(err);
}

// The levels, ascending: even ones are built at, odd ones lie between, the last beyond.
static void list_levels(double slowest, double element_inertia, ReductionErrors *errors)
{
    // A mesh of a few elements has hardly anything between its slowest mode and one element.
    double lowest = fmin(LEVEL_LOWEST * slowest, element_inertia / LEVEL_RATIO);
    double decades = log(element_inertia / lowest) / log(LEVEL_RATIO);
    int32_t steps = (int32_t)fmin(ceil(decades), (REDUCTION_LEVELS_MAX - 2) / 2);
    for (int32_t k = 0; k <= 2 * steps; k++)
        errors->inertia[k] = lowest * pow(element_inertia / lowest, k / (2.0 * steps));
    errors->inertia[2 * steps + 1] = LEVEL_BEYOND * element_inertia;
    errors->count = 2 * steps + 2;
}

// Levels first, then what lies between them. Viscosity in between is not visited: the error there
// is no larger than at the ends (tested).
static bool visit_levels(Builder *work, Error *err)
{
    ReductionErrors *errors = &work->reduced->errors;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = pass; k < errors->count; k += 2) {
            for (int end = pass; end < 2; end++) {
                Point point = {.viscosity = end, .inertia = errors->inertia[k]};
                double left = 0;
                TRY(visit(work, point, &left, err));
                errors->error[k] = fmax(errors->error[k], left);
            }
        }
    }
cleanup:
    return error_is_clean(err);
}

// S of C alone.
static bool find_viscous(Builder *work, Error *err)
{
    int64_t m = work->reduced->interface_count;
    OperatorTerms terms = {.damping = 1 / work->def->scales.damping, .lift = true};
    InterfaceOperator *viscous = interface_operator_create(&work->tried, terms, err);
    double *schur = viscous ? NEW_ARRAY(double, m *m, err) : NULL;
    if (schur) memcpy(schur, interface_operator_schur(viscous), (size_t)(m * m) * sizeof(double));
    work->reduced->viscous = schur;
    interface_operator_destroy(viscous);
    return error_is_clean(err);
}

bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err)
{
    Builder work = {.bulk = bulk, .def = def, .reduced = reduced};
    InterfaceOperator *statics = NULL;
    OperatorTerms terms = {.stiffness = 1 / def->scales.stiffness, .lift = true};
    double slowest = 0;
    *reduced = (ReducedBulk){.full_dofs = bulk->dof_count,
                             .interface_count = interface_count,
                             .count = interface_count,
                             .scales = def->scales};
    TRY(builder_create(interface_dofs, &work, err));
    if (!(statics = interface_operator_create(&work.full, terms, err))) goto cleanup;
    TRY(start_motions(&work, statics, err));
    TRY(start_load(&work, statics, err));
    TRY(find_slowest(&work, statics, &slowest, err));
    work.element_inertia = find_element_inertia(&work);
    list_levels(slowest, work.element_inertia, &reduced->errors);
    TRY(visit_levels(&work, err));
    TRY(find_viscous(&work, err));
cleanup:
    interface_operator_destroy(statics);
    builder_destroy(&work);
    if (!error_is_clean(err)) error_context(err, "while reducing the bulk");
    return error_is_clean(err);
}
