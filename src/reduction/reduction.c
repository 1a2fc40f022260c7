// SPDX-License-Identifier: GPL-2.0-or-later
// A greedy basis whose error is known where it is built. At each training point (viscosity,
// inertia), with S of the full mesh from its factor and S_r of what the basis holds so far, the
// eigenvectors of
//
//     (S_r - S) y = mu S y,    y_j' S y_k = 1 if j = k, else 0,
//
// are the boundary motions (of the interface) with the largest errors, mu the relative error of
// each. The difference of responses e = R_r y - R y, with R y the response of the full mesh,
// vanishes on the interface, has the energy e'A e = mu and is A-orthogonal to Phi and to the other
// e. So adding exactly the e with mu above the tolerance leaves no error above it at this point,
// with the smallest number of new vectors.
#include "reduction/reduction.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "reduction/basis.h"
#include "reduction/factored_points.h"
#include "reduction/far_field.h"
#include "reduction/mirror.h"
#include "reduction/training_points.h"

#include <math.h>
#include <string.h>

// A new mode is what is left of a response when the others are taken out. If its energy is smaller
// than the response's by more than this, it is formed by the mesh, which takes three times as long
// as all else: rounding of the reduced matrices stays below some 4e-14 of this. At a tolerance of
// 2e-2 the factor is 3e4 at most, at 2e-3 1e7.
static const double LOSS_LIMIT = 5e4;

// S_r - S has no negative eigenvalue but for rounding. From this part of the allowed error on the
// basis has lost too many digits, as by materials of unlike energies: then all modes are formed.
static const double NEGATIVE_LIMIT = 1e-3;

// Work of one build.
typedef struct Builder {
    BulkOperator *full;   // what is reduced: the mesh, or what the far field leaves of it
    InterfaceOperator *statics;   // it at K alone
    const ReductionDef *def;
    Basis basis;
    bool spoiled;   // by rounding: S_r is below S
    ReducedPart *part;   // not owned
    TrainingPoints training;
    OperatorTerms terms[TRAINING_POINTS_MAX];   // [training.count] of its points
    double load_energy;   // at a point, of the basis's response to the unit load
    const double *lower;   // [m^2] Cholesky factor of S at a point; not owned
    double *excess;   // [m^2] S_r - S
    double *values;   // [m] eigenvalues
    double *eigen_work;   // [DENSE_EIGEN_WORK(m)]
    BulkOperator mesh;   // the whole, where nothing is replaced
    FarField far;
} Builder;

static double allowed_error(const Builder *work, ParameterPoint point)
{
    return parameter_error_allowed(&work->training, point, work->def->tolerance);
}

// Compares S_r of the basis with `schur`, S = L L' at the point: solves (S_r - S) y = mu S y, mu
// ascending in `values`, L'y of those above what is allowed in the last columns of `excess`. A
// Galerkin projection is too stiff, never too soft: where this one is it is none any more.
static bool compare_at(Builder *work, ParameterPoint point, const double *schur, Error *err)
{
    double allowed = allowed_error(work, point), factor[BULK_TERMS_MAX];
    double least = -NEGATIVE_LIMIT * allowed - parameter_error_allowed(&work->training, point, 0);
    int32_t m = work->basis.interface_count;
    bool definite = false;
    parameter_factors(point, &work->def->scales, &work->full->bulk->spectrum, factor);
    if (!basis_condense(&work->basis, factor, work->excess, &work->load_energy, &definite, err))
        return false;
    if (definite) {
        dense_add_scaled(-1, schur, m * m, work->excess);
        dense_divide_both_sides(work->lower, m, work->excess);
        if (!dense_eigen_above(work->excess, m, allowed, work->values, work->eigen_work))
            return FAULT(err, ERROR_LIBRARY, "LAPACK: no eigenvalues of the reduction's error");
    }
    work->spoiled = !definite || work->values[0] < least;
    if (work->spoiled) return FAULT(err, ERROR_COMPUTE, "the reduced bulk is softer than the mesh");
    return true;
}

// Adds what the basis lacks at `point`; *left: the error of S there afterwards.
static bool train_at(Builder *work, ParameterPoint point, const FactoredPoint *full, double *left,
                     Error *err)
{
    int64_t m = work->basis.interface_count, dofs = work->full->dof_count, wanted = 0;
    double allowed = allowed_error(work, point), *pushed = NULL;
    work->lower = interface_operator_schur_lower(full->full);
    TRY(compare_at(work, point, interface_operator_schur(full->full), err));
    // The error of what is added becomes 0; what is left is that of the first boundary motion not
    // added.
    while (wanted < m && work->values[m - 1 - wanted] > allowed) wanted++;
    *left = wanted < m ? fmax(work->values[m - 1 - wanted], 0) : 0;
    ResponseBlock *next = responses_next(&work->basis.responses, point, wanted + 1, err);
    if (!next) goto cleanup;

    // Responses of the full mesh to the last `wanted` columns of `excess`, scaled so that what they
    // differ by from the basis's has energy 1.
    double *first = work->excess + (m - wanted) * m;
    TRY((pushed = NEW_ARRAY(double, m *wanted, err)));
    for (int64_t k = 0; k < wanted; k++)
        for (int64_t i = 0; i < m; i++) first[k * m + i] /= sqrt(work->values[m - wanted + k]);
    memcpy(pushed, first, (size_t)(m * wanted) * sizeof *pushed);
    dense_lower_multiply(work->lower, (int32_t)m, (int32_t)wanted,
                         pushed);   // S y = L L' (L^-T z) = L z
    dense_lower_divide_transposed(work->lower, (int32_t)m, (int32_t)wanted, first);
    for (int64_t k = 0; k < wanted; k++) {
        memcpy(next->reaction + k * (m + 1), pushed + k * m, (size_t)m * sizeof *pushed);
        memcpy(next->boundary + k * (m + 1), first + k * m, (size_t)m * sizeof *pushed);
    }
    TRY(interface_operator_respond(full->full, first, (int32_t)wanted, next->field, err));

    // The response to the load as the block's last column, scaled likewise: dropped unless the
    // basis lacks more than `allowed` of its energy. The load does less work on a Galerkin response
    // than on the exact one, by the energy of the difference.
    double *x = next->field + wanted * dofs, *reaction = next->reaction + wanted * (m + 1);
    double energy = dense_dot(full->held, work->basis.responses.unit_load, (int32_t)dofs);
    double missing = energy - work->load_energy;
    if (missing > allowed * energy) {
        for (int64_t k = 0; k < dofs; k++) x[k] = full->held[k] / sqrt(missing);
        for (int64_t k = 0; k < m; k++) reaction[k] = -full->pull[k] / sqrt(missing);
        reaction[m] = 1 / sqrt(missing);
    } else {
        next->count--;
    }
    if (next->count > 0) TRY(basis_extend(&work->basis, err));
cleanup:
    memory_free(pushed);
    if (!error_is_clean(err)) error_context(err, "at inertia %g", point.inertia);
    return error_is_clean(err);
}

static bool train_point(void *self, int32_t k, const FactoredPoint *full, Error *err)
{
    Builder *work = self;
    TrainingPoint now = work->training.points[k];
    double left = 0, *error = &work->part->errors.error[now.level];
    const ReductionDef *def = work->def;
    if (def->goes_on && !def->goes_on(def->self, err)) return false;
    if (!train_at(work, now.point, full, &left, err)) return false;
    // The error left by the last addition counts, too.
    if (k == work->training.count - 1 && !train_at(work, now.point, full, &left, err)) return false;
    *error = fmax(*error, left);
    return true;
}

// Far beyond an element S is that of the mass alone: the interface's own, where that is diagonal.
static bool compare_beyond(Builder *work, Error *err)
{
    ReductionErrors *errors = &work->part->errors;
    const BulkOperator *full = work->full;
    int64_t m = full->interface_count;
    ParameterPoint point = {.viscosity = 0, .inertia = errors->inertia[errors->count - 1]};
    double *schur = NEW_ARRAY(double, m *m, err), *lower = NEW_ARRAY(double, m *m, err);
    InterfaceOperator *inertia = NULL;
    if (!schur || !lower) goto cleanup;
    if (full->bulk->mass_beside) {
        OperatorTerms terms = {.mass = point.inertia / work->def->scales.mass};
        TRY((inertia = interface_operator_create(work->full, terms, err)));
        memcpy(schur, interface_operator_schur(inertia), (size_t)(m * m) * sizeof *schur);
        memcpy(lower, interface_operator_schur_lower(inertia), (size_t)(m * m) * sizeof *lower);
    }
    for (int64_t j = 0; !inertia && j < m; j++) {
        double mass = full->bulk->mass[full->interface_dofs[j]] / work->def->scales.mass;
        schur[j * (m + 1)] = point.inertia * mass;
        lower[j * (m + 1)] = sqrt(schur[j * (m + 1)]);
    }
    work->lower = lower;
    TRY(compare_at(work, point, schur, err));
    errors->error[errors->count - 1] = fmax(work->values[m - 1], 0);
cleanup:
    interface_operator_destroy(inertia);
    memory_free_all(schur, lower);
    return error_is_clean(err);
}

static bool train_basis(Builder *work, Error *err)
{
    const ReductionDef *def = work->def;
    double slowest = work->far.slowest;   // where the whole mesh was looked at
    if (!(slowest > 0))
        TRY(inertia_slowest(work->full, &def->scales, work->statics, &slowest, err));

    // The points to train at.
    training_points_list(&def->materials, &def->scales, &work->full->bulk->spectrum, slowest,
                         inertia_element(work->full->bulk, &def->scales, work->full->interface_dofs,
                                         work->full->interface_count),
                         &work->part->errors, &work->training);
    work->basis.responses.inertia_least = slowest / 20;
    for (int32_t k = 0; k < work->training.count; k++)
        work->terms[k] = parameter_terms(work->training.points[k].point, &def->scales);
    TRY(basis_start(&work->basis, work->statics, err));
    FactoredPointsDef points = {.system = work->full,
                                .load = work->basis.responses.unit_load,
                                .terms = work->terms,
                                .count = work->training.count,
                                .visit = train_point,
                                .context = work};
    TRY(factored_points_visit(&points, err));
    TRY(compare_beyond(work, err));
cleanup:
    return error_is_clean(err);
}

// interface_dofs: [interface_count] unknowns of `bulk` that stay: the border of a part by itself.
static bool reduce_part(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                        const ReductionDef *def, ReducedPart *part, Error *err)
{
    Builder work = {.def = def, .part = part};
    FarField *far = &work.far;
    FarFieldDef far_def = {def->tolerance, def->scales, def->materials};
    int64_t m = interface_count;
    *part = (ReducedPart){.border = {.size = interface_count, .count = interface_count},
                          .mesh = {.size = bulk->dof_count, .count = bulk->dof_count}};
    if (interface_count >= FAR_INTERFACE && !def->no_patches)
        TRY(far_field_create(bulk, interface_dofs, interface_count, &far_def, far, err));
    work.full = far->used ? &far->system : &work.mesh;
    if (!far->used)
        TRY(bulk_operator_create(bulk, NULL, interface_dofs, interface_count, &work.mesh, err));

    // The basis; where rounding spoils it once more, every block made orthonormal (loss_max 0).
    TRY(basis_create(work.full, &def->scales, &work.basis, err));
    work.excess = NEW_ARRAY(double, m *m, err);
    work.values = NEW_ARRAY(double, m, err);
    work.eigen_work = NEW_ARRAY(double, DENSE_EIGEN_WORK(interface_count), err);
    TRY(error_is_clean(err));
    OperatorTerms at_rest = {.stiffness = 1 / def->scales.stiffness, .lift = true};
    TRY((work.statics = interface_operator_create(work.full, at_rest, err)));
    work.basis.loss_max = LOSS_LIMIT;
    if (!train_basis(&work, err) && work.spoiled) {
        error_clear(err);
        basis_destroy(&work.basis);
        part->errors = (ReductionErrors){0};
        TRY(basis_create(work.full, &def->scales, &work.basis, err));
        train_basis(&work, err);
    }
    TRY(error_is_clean(err));
    TRY(basis_finish(&work.basis, def->modes, part, err));
    if (!far->used) goto cleanup;

    // Unknowns far from the interface are expanded in their modes.
    if (def->modes) {
        double *near = part->modes;
        part->modes = NEW_ARRAY(double, (int64_t)far->modes.size * part->count, err);
        if (part->modes) transform_apply_many(&far->modes, near, part->count, part->modes, err);
        memory_free(near);
        TRY(error_is_clean(err));
    }

    // The far field's own error is part of what is allowed at each level; statics are the mesh's
    // own.
    part->full_dofs = far->modes.size;
    memcpy(part->stiffness, far->stiffness, (size_t)(m * m) * sizeof(double));
    for (int32_t level = 0; level < part->errors.count - 1; level++) {
        ParameterPoint point = {.inertia = part->errors.inertia[level]};
        part->errors.error[level] += far->error * allowed_error(&work, point);
    }
cleanup:
    basis_destroy(&work.basis);
    memory_free_all(work.excess, work.values, work.eigen_work);
    interface_operator_destroy(work.statics);
    bulk_operator_destroy(&work.mesh);
    far_field_destroy(far);
    if (!error_is_clean(err)) error_context(err, "while reducing the bulk");
    return error_is_clean(err);
}

// --- a block: one part, or those of its symmetry ------------------------------------------------

enum { TOGETHER = 2 };   // parts, for memory

typedef struct Parts {
    int first;   // of those that are built together
    Mirror *mirror;
    const ReductionDef *def;
    ReducedBulk *reduced;
} Parts;

static bool build_part(void *context, int32_t k, Error *err)
{
    Parts *parts = context;
    int p = parts->first + k;
    MirrorPart *from = &parts->mirror->part[p];
    ReducedPart *part = &parts->reduced->part[p];
    if (!reduce_part(&from->bulk, from->border_dofs, from->border.count, parts->def, part, err))
        return false;
    part->border = from->border;
    from->border = (Transform){0};
    if (!parts->def->modes) return true;
    part->mesh = from->unknowns;
    from->unknowns = (Transform){0};
    return true;
}

bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t m,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err)
{
    Mirror mirror = {0};
    Parts parts = {.mirror = &mirror, .def = def, .reduced = reduced};
    *reduced = (ReducedBulk){.dim = bulk->dim,
                             .area = bulk->area,
                             .interface_count = m,
                             .part_count = 1,
                             .scales = def->scales,
                             .spectrum = bulk->spectrum};
    if (def->node_image) TRY(mirror_find(bulk, def->node_image, interface_dofs, m, &mirror, err));
    if (mirror.part_count > 0) {
        reduced->part_count = mirror.part_count;
        reduced->mirrored = mirror.mirrored;
    } else {
        TRY(reduce_part(bulk, interface_dofs, m, def, &reduced->part[0], err));
    }
    int together = def->one_by_one ? 1 : TOGETHER;
    for (; parts.first < mirror.part_count; parts.first += together)   // 2 or 4 of them
        TRY(parallel_try(together, build_part, &parts, err));

    // Numbers of the whole that follow from its parts.
    const double *loads[REDUCED_PARTS_MAX];
    int32_t dim = bulk->dim, border_count = m + reduced->mirrored;
    reduced->count = border_count;
    for (int p = 0; p < reduced->part_count; p++) {
        reduced->count += reduced->part[p].interior_count;
        reduced->full_dofs += reduced->part[p].full_dofs;
        loads[p] = reduced->part[p].load;
    }
    TRY((reduced->load = NEW_ARRAY(double, reduced->count, err)));
    reduced_bulk_join(reduced, loads, reduced->load);
    if (!def->position) goto cleanup;

    // Rigid motions of the block as unknowns on the border, over a base that stands still; a rigid
    // motion is a static one, so that all else follows.
    const int32_t *border = mirror.border ? mirror.border : interface_dofs;
    double *next = NEW_ARRAY(double, (int64_t)rigid_count(dim) * border_count, err);
    TRY((reduced->rigid = next));
    for (int32_t which = 0; which < rigid_count(dim); which++)
        for (int32_t k = 0; k < border_count; k++) {
            const double *place = def->position + node_dof(dim, dof_node(dim, border[k]), 0);
            bool still = bulk->in_base && bulk->in_base[border[k]];
            *next++ = still ? 0 : rigid_motion(dim, which, place, dof_axis(dim, border[k]));
        }
cleanup:
    mirror_destroy(&mirror);
    return error_is_clean(err);
}
