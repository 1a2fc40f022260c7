// SPDX-License-Identifier: GPL-2.0-or-later
// Responses are asked at rest, then elastic and viscous in turns at inertias 6 apart, from where
// inertia leaves something of them far from the interface downwards, at last with all viscosities.
#include "reduction/far_samples.h"

#include "base/dense.h"
#include "base/largest_eigen.h"
#include "base/memory.h"
#include "base/share.h"
#include "reduction/factors_ahead.h"
#include "reduction/inertias.h"

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

// S of what the far field leaves is not below that of the mesh; beyond this part of what is allowed
// all eigenvalues are looked at.
static const double NEGATIVE = 1e-3;

// Of the mean diagonal: S of K alone is lifted by it, where rigid motions cost nothing.
static const double LIFT = 1;

enum { LEVELS_MAX = 16, POINTS_MAX = TRAINING_VISCOSITIES_MAX * (LEVELS_MAX + 1) + 1 };

typedef struct Sampling {
    const Bulk *bulk;
    const FarFieldDef *def;
    FarSamples *samples;   // not owned
    BulkOperator mesh;
    InterfaceOperator *statics;
    ParameterPoint points[POINTS_MAX];   // [count], then that at which S is compared
    OperatorTerms terms[POINTS_MAX];
    int32_t count;
    double viscosity[TRAINING_VISCOSITIES_MAX];   // [viscosity_count]
    int32_t viscosity_count;
    double top;   // the largest inertia
    FactorsAhead *ahead;
    const double *lower;   // [m^2] Cholesky factor of S at a point; not owned
    double *lifted;   // [m^2] that of S of K alone
    double *asked;   // [m * CHUNK] boundary motions
    double *fields;   // [dofs * (CHUNK + 1)] responses
    uint64_t drawn;   // random numbers
    bool *busy;   // [patches] whether a patch still finds much that is new
    FarRoom room[2];   // of two threads
} Sampling;

// All but what the comparison needs.
static void sampling_end(Sampling *work)
{
    interface_operator_destroy(work->statics);
    memory_free(work->lifted);
    memory_free(work->asked);
    memory_free(work->fields);
    memory_free(work->busy);
    for (int which = 0; which < 2; which++) far_room_destroy(&work->room[which]);
    work->busy = NULL;
    work->statics = NULL;
    work->lifted = work->asked = work->fields = NULL;
}

static void sampling_destroy(Sampling *work)
{
    if (!work) return;
    sampling_end(work);
    factors_ahead_destroy(work->ahead);
    bulk_operator_destroy(&work->mesh);
    memory_free(work);
}

void far_samples_destroy(FarSamples *samples)
{
    memory_free(samples->stiffness);
    sampling_destroy(samples->sampling);
    *samples = (FarSamples){0};
}

// 1 or -1 (Steele, Lea, Flood, OOPSLA 2014: splitmix64).
static double draw_sign(uint64_t *drawn)
{
    uint64_t z = ++*drawn * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) >> 63 ? 1 : -1;
}

static void add_point(Sampling *work, ParameterPoint point)
{
    work->points[work->count] = point;
    work->terms[work->count] = parameter_terms(point, &work->def->scales);
    work->terms[work->count++].lower_only = true;
}

// At one inertia, with every other viscosity.
static void add_level(Sampling *work, int32_t level, double inertia)
{
    for (int32_t k = level % 2; k < work->viscosity_count; k += 2)
        add_point(work, (ParameterPoint){work->viscosity[k], inertia});
}

// Those that are asked whatever the slowest mode is, as many as are factored ahead at least.
static void list_first_points(Sampling *work, double element_inertia)
{
    TrainingPoints training;
    ReductionErrors levels = {0};
    const FarFieldDef *def = work->def;
    training_points_list(&def->materials, &def->scales, element_inertia, element_inertia, &levels,
                         &training);
    work->viscosity_count = training_viscosities(&def->materials, &def->scales, work->viscosity);
    // Half a step below where responses no longer reach that far.
    work->top = training.element_inertia * pow(FALLEN / work->samples->patches->distance, 2) /
                sqrt(INERTIA_STEP);
    add_level(work, 0, work->top);
    add_level(work, 1, work->top / INERTIA_STEP);
}

// The others, down to the lowest level of the reduction, there with all viscosities; and the one at
// which S is compared: where one is asked half way, with the other viscosity.
static void list_points(Sampling *work, double slowest, double element_inertia)
{
    TrainingPoints training;
    ReductionErrors levels = {0};
    const FarFieldDef *def = work->def;
    training_points_list(&def->materials, &def->scales, slowest, element_inertia, &levels,
                         &training);
    double lowest = levels.inertia[0], second = work->top / INERTIA_STEP;
    int32_t steps =
        (int32_t)fmin(fmax(round(log(second / lowest) / log(INERTIA_STEP)), 1), LEVELS_MAX - 2);
    for (int32_t k = 1; k < steps; k++)
        add_level(work, 1 + k, second * pow(lowest / second, (double)k / steps));
    ParameterPoint compared = work->points[(work->count + 1) / 2];
    compared.viscosity = work->viscosity[compared.viscosity < 0.5 ? 1 : 0];
    for (int32_t k = 1; k < work->viscosity_count; k++)
        add_point(work, (ParameterPoint){work->viscosity[k], lowest});
    add_point(work, compared);
    work->terms[--work->count].lower_only = false;
    work->samples->allowed = parameter_error_allowed(&training, compared, def->tolerance);
}

static bool begin_patches(Sampling *work, Error *err)
{
    FarPatches *patches = work->samples->patches;
    int32_t size = 0;
    work->busy = NEW_ARRAY(bool, patches->count, err);
    if (!work->busy) goto cleanup;
    TRY(far_patches_begin(work->bulk, work->def->scales.stiffness, ROOM, patches, err));
    for (int32_t p = 0; p < patches->count; p++)
        if (patches->modes[p].size > size) size = patches->modes[p].size;
    for (int which = 0; which < 2; which++)
        TRY(far_room_create(size, CHUNK + 1, &work->room[which], err));
cleanup:
    return error_is_clean(err);
}

static bool sampling_begin(const int32_t *interface_dofs, int32_t m, Sampling *work, Error *err)
{
    FarSamples *samples = work->samples;
    const Bulk *bulk = work->bulk;
    const BulkScales *scales = &work->def->scales;
    OperatorTerms terms = {.stiffness = 1 / scales->stiffness, .lift = true};
    double element = inertia_element(bulk, scales, interface_dofs, m);
    TRY(bulk_operator_create(bulk, NULL, interface_dofs, m, &work->mesh, err));
    list_first_points(work, element);
    FactorsAheadDef def = {
        .system = &work->mesh, .load = bulk->load, .terms = work->terms, .count = work->count};
    TRY(factors_ahead_create(&def, &work->ahead, err));
    work->statics = interface_operator_create(&work->mesh, terms, err);
    if (!work->statics) goto cleanup;
    TRY(inertia_slowest(&work->mesh, scales, work->statics, &samples->slowest, err));
    list_points(work, samples->slowest, element);
    factors_ahead_extend(work->ahead, work->count + 1);
    TRY(begin_patches(work, err));
    samples->stiffness = NEW_ARRAY(double, (int64_t)m *m, err);
    work->lifted = NEW_ARRAY(double, (int64_t)m *m, err);
    work->asked = NEW_ARRAY(double, (int64_t)m *CHUNK, err);
    work->fields = NEW_ARRAY(double, (int64_t)bulk->dof_count *(CHUNK + 1), err);
cleanup:
    return error_is_clean(err);
}

// The response to the load, of energy 1, behind the others; 0: there is no load.
static int32_t take_load(const Sampling *work, const double *held)
{
    int32_t dofs = work->bulk->dof_count;
    double energy = dense_dot(work->bulk->load, held, dofs);
    double *out = work->fields + (int64_t)CHUNK * dofs;
    if (!(energy > 0)) return 0;
    for (int32_t i = 0; i < dofs; i++) out[i] = held[i] / sqrt(energy);
    return 1;
}

// Patches that found much that was new in the responses before, two at a time.
typedef struct Turn {
    Sampling *work;
    DenseView fields;
    double least;
    atomic_int next;   // patch
    atomic_bool failed;
} Turn;

static void add_in_turn(void *context, int32_t which)
{
    Turn *turn = context;
    Sampling *work = turn->work;
    const FarPatches *patches = work->samples->patches;
    int32_t count = patches->count, added = 0;
    for (int32_t p = atomic_fetch_add(&turn->next, 1); p < count;
         p = atomic_fetch_add(&turn->next, 1)) {
        if (!work->busy[p]) continue;
        if (!patch_modes_add(&patches->modes[p], turn->fields, turn->least, &work->room[which],
                             &added))
            atomic_store(&turn->failed, true);
        work->busy[p] = added > NEW_SHARE * turn->fields.columns;
    }
}

// *left: patches that found much that is new now, too.
static bool add_to_patches(Sampling *work, int32_t columns, double least, int32_t *left, Error *err)
{
    const FarPatches *patches = work->samples->patches;
    Turn turn = {.work = work,
                 .fields = dense_view(work->fields, work->bulk->dof_count, columns),
                 .least = least};
    for (int32_t p = 0; p < patches->count; p++)
        if (work->busy[p]) TRY(patch_modes_make_room(&patches->modes[p], columns, err));
    share_in_two(add_in_turn, &turn);
    if (turn.failed)
        FAIL(err, ERROR_LIBRARY, "LAPACK: no energies of modes far from the interface");
    *left = 0;
    for (int32_t p = 0; p < patches->count; p++) *left += work->busy[p];
cleanup:
    return error_is_clean(err);
}

// Boundary motions of energy 1 on average, of S = L L': L^-T times signs.
static bool sample(Sampling *work, InterfaceOperator *full, const double *held, double least,
                   Error *err)
{
    int32_t m = work->mesh.interface_count;
    int32_t left = work->samples->patches->count;
    for (int32_t p = 0; p < left; p++) work->busy[p] = true;
    // m boundary motions are all there are.
    for (int32_t loads = take_load(work, held), asked = 0; left > 0 && asked < m; asked += CHUNK) {
        for (int32_t k = 0; k < m * CHUNK; k++) work->asked[k] = draw_sign(&work->drawn);
        dense_lower_divide_transposed(work->lower, m, CHUNK, work->asked);
        TRY(interface_operator_respond(full, work->asked, CHUNK, work->fields, err));
        TRY(add_to_patches(work, CHUNK + loads, least, &left, err));
        loads = 0;
    }
cleanup:
    return error_is_clean(err);
}

static bool factor_statics(Sampling *work, Error *err)
{
    int64_t m = work->mesh.interface_count;
    const double *schur = interface_operator_schur(work->statics);
    double sum = 0;
    memcpy(work->lifted, schur, (size_t)(m * m) * sizeof *schur);
    for (int64_t j = 0; j < m; j++) sum += schur[j * (m + 1)];
    for (int64_t j = 0; j < m; j++) work->lifted[j * (m + 1)] += LIFT * sum / (double)m;
    if (!dense_cholesky(work->lifted, (int32_t)m))
        FAIL(err, ERROR_COMPUTE, "the interface operator is not positive definite");
cleanup:
    return error_is_clean(err);
}

static bool sample_statics(Sampling *work, Error *err)
{
    double *held = NEW_ARRAY(double, work->bulk->dof_count, err);
    double *pull = NEW_ARRAY(double, work->mesh.interface_count, err);
    if (!held || !pull) goto cleanup;
    TRY(interface_operator_respond_held(work->statics, work->bulk->load, held, pull, err));
    TRY(factor_statics(work, err));
    work->lower = work->lifted;
    TRY(sample(work, work->statics, held, LEAST_AT_REST, err));
cleanup:
    memory_free(held);
    memory_free(pull);
    return error_is_clean(err);
}

bool far_samples_take(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarSamples *samples, Error *err)
{
    Sampling *work = samples->sampling = NEW_ARRAY(Sampling, 1, err);
    double least = LEAST * def->tolerance * def->tolerance;
    size_t square = (size_t)interface_count * (size_t)interface_count * sizeof(double);
    FactoredPoint point;
    if (!work) goto cleanup;
    *work = (Sampling){.bulk = bulk, .def = def, .samples = samples};
    TRY(sampling_begin(interface_dofs, interface_count, work, err));
    memcpy(samples->stiffness, interface_operator_schur(work->statics), square);
    TRY(sample_statics(work, err));
    for (int32_t k = 0; k < work->count; k++) {
        TRY(factors_ahead_next(work->ahead, &point, err));
        work->lower = interface_operator_schur_lower(point.full);
        TRY(sample(work, point.full, point.held, least, err));
    }
    sampling_end(work);
cleanup:
    return error_is_clean(err);
}

// Few boundary motions are above what is allowed, or S is of no use.
static bool find_largest(const InterfaceOperator *full, const double *excess, int32_t m,
                         double allowed, double *error, Error *err)
{
    const double *lower = interface_operator_schur_lower(full);
    LargestEigen largest = {0};
    bool found = false;
    double *work = NEW_ARRAY(double, dense_eigen_work(m), err), *values = NEW_ARRAY(double, m, err);
    double *turned = NEW_ARRAY(double, (int64_t)m *m, err);
    if (!error_is_clean(err)) goto cleanup;
    LargestEigenDef def = {.size = m,
                           .a = excess,
                           .b = interface_operator_schur(full),
                           .lower = lower,
                           .above = fmin(allowed, 1),
                           .least = -NEGATIVE * allowed,
                           .work = work};
    TRY(largest_eigen_find(&def, &largest, &found, err));
    if (found) {
        *error = largest.count > 0 ? largest.values[largest.count - 1] : largest.next;
        goto cleanup;
    }
    memcpy(turned, excess, (size_t)m * (size_t)m * sizeof *turned);
    dense_divide_both_sides(lower, m, turned);
    if (!dense_eigen_above(turned, m, INFINITY, values, work))   // values alone
        FAIL(err, ERROR_LIBRARY, "LAPACK: no eigenvalues");
    *error = fmax(fabs(values[0]), fabs(values[m - 1]));
cleanup:
    largest_eigen_destroy(&largest);
    memory_free(work);
    memory_free(values);
    memory_free(turned);
    return error_is_clean(err);
}

bool far_samples_compare(FarSamples *samples, BulkOperator *system, double *error, Error *err)
{
    int32_t m = system->interface_count;
    Sampling *work = samples->sampling;
    FactoredPoint point;
    InterfaceOperator *condensed = NULL;
    double *excess = NEW_ARRAY(double, (int64_t)m *m, err);
    if (!excess) goto cleanup;
    condensed = interface_operator_create(system, work->terms[work->count], err);
    if (!condensed) goto cleanup;
    TRY(factors_ahead_next(work->ahead, &point, err));
    memcpy(excess, interface_operator_schur(condensed), (size_t)m * (size_t)m * sizeof *excess);
    dense_add_scaled(-1, interface_operator_schur(point.full), m * m, excess);
    TRY(find_largest(point.full, excess, m, samples->allowed, error, err));
    *error /= samples->allowed;
cleanup:
    interface_operator_destroy(condensed);
    memory_free(excess);
    sampling_destroy(work);
    samples->sampling = NULL;
    return error_is_clean(err);
}
