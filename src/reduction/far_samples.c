// SPDX-License-Identifier: GPL-2.0-or-later
// Responses are asked at rest, then elastic and viscous in turns at inertias 6 apart, from where
// inertia leaves something of them far from the interface downwards, at last with all viscosities.
#include "reduction/far_samples.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "reduction/factored_points.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

// Boundary motions asked at once; where fewer than NEW_SHARE of them are new to a patch it takes no
// more at that point.
enum { CHUNK = 24 };
static const double NEW_SHARE = 0.75;

enum { ROOM = 4 * CHUNK };   // modes of a patch that there is room for at first

// The energy of what a random boundary motion, of energy 1, may lack: a part of tolerance^2, and at
// rest. What all boundary motions lack adds up in it, so that the worst lacks less.
static const double LEAST = 0.25, LEAST_AT_REST = 1e-12;

static const double INERTIA_STEP = 6;

// e^-5 of a response has come through the elements between at most, where inertia is asked last.
static const double FALLEN = 5;

// Part of the mean diagonal by which S of K alone is lifted, as rigid motions cost nothing there.
static const double LIFT = 1;

enum { LEVELS_MAX = 16, POINTS_MAX = TRAINING_VISCOSITIES_MAX * (LEVELS_MAX + 1) + 1 };

typedef struct Sampling {
    BulkOperator *mesh;   // not owned
    const FarFieldDef *def;
    FarSamples *samples;   // not owned
    InterfaceOperator *statics;
    ParameterPoint points[POINTS_MAX];   // [count]
    OperatorTerms terms[POINTS_MAX];   // likewise
    int32_t count;
    const double *lower;   // [m^2] Cholesky factor of S at a point; not owned
    double *lifted;   // [m^2] that of S of K alone
    double *asked;   // [m * CHUNK] boundary motions
    double *fields;   // [dofs * (CHUNK + 1)] responses
    uint64_t drawn;   // random numbers
    bool *busy;   // [patches] whether a patch still finds much that is new
    FarRoom room[PARALLEL_WORKERS_MAX];   // of a thread each
} Sampling;

// 1 or -1 (Steele, Lea, Flood, OOPSLA 2014: splitmix64).
static double draw_sign(uint64_t *drawn)
{
    uint64_t z = ++*drawn * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) >> 63 ? 1 : -1;
}

static void add_point(Sampling *work, double viscosity, double inertia)
{
    ParameterPoint point = {viscosity, inertia};
    work->points[work->count] = point;
    work->terms[work->count] = parameter_terms(point, &work->def->scales);
    work->terms[work->count++].lower_only = true;
}

// From half a step below where responses no longer reach that far down to the lowest level of the
// reduction, with every other viscosity, there with all; S is compared where one is asked half way,
// with the other viscosity.
static void list_points(Sampling *work, double element_inertia)
{
    TrainingPoints training;
    ReductionErrors levels = {0};
    FarSamples *samples = work->samples;
    const FarFieldDef *def = work->def;
    const Spectrum *spectrum = &work->mesh->bulk->spectrum;
    double viscosity[TRAINING_VISCOSITIES_MAX];
    int32_t count = training_viscosities(&def->materials, &def->scales, spectrum, viscosity);
    training_points_list(&def->materials, &def->scales, spectrum, samples->slowest, element_inertia,
                         &levels, &training);
    double lowest = levels.inertia[0];
    double top = training.element_inertia * pow(FALLEN / samples->patches->distance, 2) /
                 sqrt(INERTIA_STEP);
    double second = top / INERTIA_STEP;
    int32_t steps =
        (int32_t)fmin(fmax(round(log(second / lowest) / log(INERTIA_STEP)), 1), LEVELS_MAX - 2);
    for (int32_t level = 0; level <= steps; level++) {
        double inertia = level == 0 ? top : second * pow(lowest / second, (level - 1.0) / steps);
        for (int32_t k = level % 2; k < count; k += 2) add_point(work, viscosity[k], inertia);
    }
    ParameterPoint compared = work->points[(work->count + 1) / 2];
    compared.viscosity = viscosity[compared.viscosity < 0.5 ? 1 : 0];
    samples->compared = parameter_terms(compared, &def->scales);
    samples->allowed = parameter_error_allowed(&training, compared, def->tolerance);
    for (int32_t k = 1; k < count; k++) add_point(work, viscosity[k], lowest);
}

static bool sampling_begin(Sampling *work, Error *err)
{
    FarSamples *samples = work->samples;
    BulkOperator *mesh = work->mesh;
    const BulkScales *scales = &work->def->scales;
    int64_t m = mesh->interface_count;
    OperatorTerms terms = {.stiffness = 1 / scales->stiffness, .lift = true};
    if (!(work->statics = interface_operator_create(mesh, terms, err))) return false;
    if (!inertia_slowest(mesh, scales, work->statics, &samples->slowest, err)) return false;
    list_points(work, inertia_element(mesh->bulk, scales, mesh->interface_dofs, (int32_t)m));

    // The patches, and room for threads to work in.
    FarPatches *patches = samples->patches;
    int32_t size = 0;
    if (!(work->busy = NEW_ARRAY(bool, patches->count, err)) ||
        !far_patches_begin(mesh->bulk, scales->stiffness, ROOM, patches, err))
        return false;
    for (int32_t p = 0; p < patches->count; p++)
        if (patches->modes[p].size > size) size = patches->modes[p].size;
    for (int32_t k = 0; k < parallel_workers(); k++)
        if (!far_room_create(size, CHUNK + 1, &work->room[k], err)) return false;
    samples->stiffness = NEW_ARRAY(double, m *m, err);
    work->lifted = NEW_ARRAY(double, m *m, err);
    work->asked = NEW_ARRAY(double, m *CHUNK, err);
    work->fields = NEW_ARRAY(double, (int64_t)mesh->dof_count *(CHUNK + 1), err);
    return error_is_clean(err);
}

// The part of the earlier responses that is new to patches which found much of it.
typedef struct Turn {
    Sampling *work;
    DenseView fields;
    double least;
    atomic_bool failed;
} Turn;

static void add_to_patch(void *context, int32_t p, int32_t worker)
{
    Turn *turn = context;
    Sampling *work = turn->work;
    int32_t added = 0;
    if (!work->busy[p]) return;
    if (!patch_modes_add(&work->samples->patches->modes[p], turn->fields, turn->least,
                         &work->room[worker], &added))
        atomic_store(&turn->failed, true);
    work->busy[p] = added > NEW_SHARE * turn->fields.columns;
}

// Boundary motions of energy 1 on average, of S = L L': L^-T times signs; and the response to the
// load, `held`.
static bool sample(Sampling *work, InterfaceOperator *full, const double *held, double least,
                   Error *err)
{
    const FarPatches *patches = work->samples->patches;
    int32_t m = work->mesh->interface_count, dofs = work->mesh->dof_count, left = patches->count;
    for (int32_t p = 0; p < left; p++) work->busy[p] = true;

    // The response to the load, of energy 1, stands behind the others of the first turn.
    double energy = dense_dot(work->mesh->load, held, dofs);
    double *last = work->fields + (int64_t)CHUNK * dofs;
    int32_t loads = energy > 0;
    for (int32_t i = 0; loads && i < dofs; i++) last[i] = held[i] / sqrt(energy);

    // m boundary motions are all there are.
    for (int32_t asked = 0; left > 0 && asked < m; asked += CHUNK, loads = 0) {
        for (int32_t k = 0; k < m * CHUNK; k++) work->asked[k] = draw_sign(&work->drawn);
        dense_lower_divide_transposed(work->lower, m, CHUNK, work->asked);
        if (!interface_operator_respond(full, work->asked, CHUNK, work->fields, err)) return false;

        // `left` patches found much that is new now, too.
        Turn turn = {
            .work = work, .fields = dense_view(work->fields, dofs, CHUNK + loads), .least = least};
        for (int32_t p = 0; p < patches->count; p++)
            if (work->busy[p] && !patch_modes_make_room(&patches->modes[p], CHUNK + loads, err))
                return false;
        parallel_for(patches->count, add_to_patch, &turn);
        if (turn.failed)
            return FAULT(err, ERROR_LIBRARY, "LAPACK: no energies of modes far from the interface");
        left = 0;
        for (int32_t p = 0; p < patches->count; p++) left += work->busy[p];
    }
    return true;
}

// At rest S is lifted, as rigid motions cost nothing.
static bool sample_statics(Sampling *work, Error *err)
{
    int64_t m = work->mesh->interface_count;
    const double *schur = interface_operator_schur(work->statics);
    double sum = 0, *held = NEW_ARRAY(double, work->mesh->dof_count, err);
    double *pull = NEW_ARRAY(double, m, err);
    if (!held || !pull) goto cleanup;
    TRY(interface_operator_respond_held(work->statics, work->mesh->load, held, pull, err));
    memcpy(work->lifted, schur, (size_t)(m * m) * sizeof *schur);
    for (int64_t j = 0; j < m; j++) sum += schur[j * (m + 1)];
    for (int64_t j = 0; j < m; j++) work->lifted[j * (m + 1)] += LIFT * sum / (double)m;
    if (!dense_cholesky(work->lifted, (int32_t)m))
        FAIL(err, ERROR_COMPUTE, "the interface operator is not positive definite");
    work->lower = work->lifted;
    TRY(sample(work, work->statics, held, LEAST_AT_REST, err));
cleanup:
    memory_free_all(held, pull);
    return error_is_clean(err);
}

static bool sample_point(void *self, int32_t k, const FactoredPoint *point, Error *err)
{
    Sampling *work = self;
    double tolerance = work->def->tolerance;
    (void)k;
    work->lower = interface_operator_schur_lower(point->full);
    return sample(work, point->full, point->held, LEAST * tolerance * tolerance, err);
}

bool far_samples_take(BulkOperator *mesh, const FarFieldDef *def, FarSamples *samples, Error *err)
{
    Sampling *work = NEW_ARRAY(Sampling, 1, err);
    size_t square = (size_t)mesh->interface_count * (size_t)mesh->interface_count * sizeof(double);
    if (!work) return false;
    *work = (Sampling){.mesh = mesh, .def = def, .samples = samples};
    TRY(sampling_begin(work, err));
    memcpy(samples->stiffness, interface_operator_schur(work->statics), square);
    TRY(sample_statics(work, err));
    FactoredPointsDef points = {.system = mesh,
                                .load = mesh->load,
                                .terms = work->terms,
                                .count = work->count,
                                .visit = sample_point,
                                .context = work};
    TRY(factored_points_visit(&points, err));
cleanup:
    interface_operator_destroy(work->statics);
    for (int32_t k = 0; k < PARALLEL_WORKERS_MAX; k++) far_room_destroy(&work->room[k]);
    memory_free_all(work->lifted, work->asked, work->fields, work->busy, work);
    return error_is_clean(err);
}

bool far_samples_compare(const FarSamples *samples, BulkOperator *mesh, BulkOperator *left,
                         double *error, Error *err)
{
    int32_t m = left->interface_count;
    InterfaceOperator *full = NULL, *condensed = NULL;
    double *excess = NEW_ARRAY(double, (int64_t)m *m, err), *values = NEW_ARRAY(double, m, err);
    double *work = NEW_ARRAY(double, DENSE_EIGEN_WORK(m), err);
    if (!error_is_clean(err)) goto cleanup;
    full = interface_operator_create(mesh, samples->compared, err);
    TRY((condensed = full ? interface_operator_create(left, samples->compared, err) : NULL));
    memcpy(excess, interface_operator_schur(condensed), (size_t)m * (size_t)m * sizeof *excess);
    dense_add_scaled(-1, interface_operator_schur(full), m * m, excess);
    dense_divide_both_sides(interface_operator_schur_lower(full), m, excess);
    if (!dense_eigen_above(excess, m, INFINITY, values, work))   // values alone
        FAIL(err, ERROR_LIBRARY, "LAPACK: no eigenvalues");
    *error = fmax(fabs(values[0]), fabs(values[m - 1])) / samples->allowed;
cleanup:
    interface_operator_destroy(full);
    interface_operator_destroy(condensed);
    memory_free_all(excess, values, work);
    return error_is_clean(err);
}
