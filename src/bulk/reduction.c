// SPDX-License-Identifier: GPL-2.0-or-later
// A greedy basis whose error is known where it is built. At a point (viscosity, inertia) of the
// strip, with S of the full mesh from its factor and S_r of what the basis holds so far, the
// eigenvectors of
//
//     (S_r - S) y = mu S y,    y_j' S y_k = 1 if j = k, else 0,
//
// are the motions of the interface with the largest errors, mu the relative error of each. The
// difference of responses e = R_r y - R y, with R y the answer of the full mesh, vanishes on the
// interface, has the energy e'A e = mu and is A-orthogonal to Phi and to the other e. So adding
// exactly the e with mu above the tolerance leaves no error above it at this point, with the
// smallest number of new vectors.
#include "bulk/reduction.h"

#include "base/dense.h"
#include "base/memory.h"
#include "bulk/growing_basis.h"

#include <math.h>
#include <string.h>

// Levels of inertia that the basis is built at, a factor of about LEVEL_RATIO apart, from
// LEVEL_LOWEST times the slowest mode of the interior, below which it follows like a spring, to
// that of one element. Then the levels between two of them, and LEVEL_BEYOND above, are treated
// likewise.
static const double LEVEL_RATIO = 10, LEVEL_LOWEST = 0.1, LEVEL_BEYOND = 1e6;
enum { SLOWEST_ITERATIONS = 10, VISCOSITIES_MAX = 12 };

// K and C are isotropic, so the static answer at a viscosity depends on the quotients of A's areal
// and shear moduli alone, of all regions. At a viscosity v each is its elastic value times
// 1 - v + v t, t its viscous time, and no quotient changes more than that of the longest and the
// shortest time. The basis is built at viscosities where that quotient differs by this factor at
// most: then the error in between stays below those measured (a test asks at random, of one
// material up to eta2 = 10 eta1; at 100 it was 1.4 times as large; of two up to times that differ
// by 1e4). With eta2 = eta1 in plane stress the two ends suffice.
static const double VISCOSITY_RATIO = 2;

// Where inertia acts within an element the mesh itself has an error, of about a quarter of
// inertia's share (a thin layer in linear elements with lumped mass). A tolerance of 0.01 allows a
// tenth of it.
static const double MESH_SHARE = 2.5;

// Errors of S below this are its rounding.
static const double ERROR_LEAST = 1e-10;

typedef struct Point {
    double viscosity, inertia;
} Point;

// Work of one build.
typedef struct Builder {
    const Bulk *bulk;
    const ReductionDef *def;
    GrowingBasis basis;
    double element_inertia;   // where mass takes over within an element
    int32_t viscosity_count;
    double viscosity[VISCOSITIES_MAX];   // [viscosity_count] visited at each level
    double load_energy;   // at a point, of the basis's answer to the unit load
    double *exact, *excess;   // [m^2] S, then its Cholesky factor; S_r - S
    double *values;   // [m] eigenvalues
    double *eigen_work;   // [dense_eigen_work(m)]
} Builder;

// All but the reduced bulk.
static void builder_destroy(Builder *work)
{
    basis_destroy(&work->basis);
    memory_free(work->exact);
    memory_free(work->excess);
    memory_free(work->values);
    memory_free(work->eigen_work);
}

static bool builder_create(const int32_t *interface_dofs, int32_t m, ReducedBulk *reduced,
                           Builder *work, Error *err)
{
    TRY(basis_create(work->bulk, interface_dofs, m, reduced, &work->basis, err));
    work->exact = NEW_ARRAY(double, (int64_t)m *m, err);
    work->excess = NEW_ARRAY(double, (int64_t)m *m, err);
    work->values = NEW_ARRAY(double, m, err);
    work->eigen_work = NEW_ARRAY(double, dense_eigen_work(m), err);
cleanup:
    return error_is_clean(err);
}

// The inertia at which the slowest mode of the interior is in balance, K x = slowest M x: inverse
// iteration, x'M x = 1 before each.
static bool find_slowest(Builder *work, InterfaceOperator *statics, double *slowest, Error *err)
{
    int32_t dofs = work->basis.full.dof_count;
    double *x = NEW_ARRAY(double, dofs, err), *rhs = NEW_ARRAY(double, dofs, err);
    if (!x || !rhs) goto cleanup;
    for (int32_t k = 0; k < dofs; k++) x[k] = 1;
    for (int32_t j = 0; j < work->basis.full.interface_count; j++)
        x[work->basis.full.interface_dofs[j]] = 0;
    for (int32_t round = 0; round < SLOWEST_ITERATIONS; round++) {
        basis_apply_full(&work->basis, BULK_MASS, x, rhs);
        double size = sqrt(dense_dot(x, rhs, dofs));
        for (int32_t k = 0; k < dofs; k++) rhs[k] /= size;
        TRY(interface_operator_condense(statics, rhs, work->basis.border, err));
        TRY(interface_operator_expand(statics, work->basis.still, x, err));
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
    for (int32_t j = 0; j < work->basis.full.interface_count; j++) {
        int32_t dof = work->basis.full.interface_dofs[j];
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

// The point as factors of the scene's own M, C and K.
static OperatorTerms point_terms(const Builder *work, Point point)
{
    const BulkScales *scales = &work->def->scales;
    return (OperatorTerms){.mass = point.inertia / scales->mass,
                           .damping = point.viscosity / scales->damping,
                           .stiffness = (1 - point.viscosity) / scales->stiffness};
}

// Solves (S_r - S) y = mu S y: mu ascending in `values`, y in the columns of `excess`, which is S_r
// before.
static bool compare(Builder *work, const InterfaceOperator *full, Error *err)
{
    int32_t m = work->basis.reduced->interface_count;
    const double *schur = interface_operator_schur(full);
    memcpy(work->exact, schur, (size_t)m * (size_t)m * sizeof *schur);
    dense_add_scaled(-1, schur, m * m, work->excess);
    if (!dense_cholesky(work->exact, m))
        FAIL(err, ERROR_COMPUTE, "the interface operator is not positive definite");
    dense_divide_both_sides(work->exact, m, work->excess);
    if (!dense_eigen(work->excess, m, work->values, work->eigen_work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: no eigenvalues of the reduction's error");
cleanup:
    return error_is_clean(err);
}

// Answers x [dofs * wanted] of the full mesh to the last `wanted` columns of `excess`, scaled so
// that what they differ by from the basis's has energy 1.
static bool answer_motions(Builder *work, InterfaceOperator *full, int32_t wanted, double *x,
                           Error *err)
{
    int64_t m = work->basis.reduced->interface_count;
    double *first = work->excess + (m - wanted) * m;
    for (int64_t k = 0; k < wanted; k++) {
        double *y = first + k * m, scale = 1 / sqrt(work->values[m - wanted + k]);
        dense_lower_solve_transposed(work->exact, (int32_t)m, y);
        for (int64_t i = 0; i < m; i++) y[i] *= scale;
    }
    return interface_operator_answer(full, first, wanted, x, err);
}

// The answer x of the full mesh to the load, the interface held, scaled likewise. *adds: the basis
// lacks more than `allowed` of its energy.
static bool answer_load(Builder *work, InterfaceOperator *full, double allowed, double *x,
                        bool *adds, Error *err)
{
    int32_t dofs = work->basis.full.dof_count;
    *adds = false;
    TRY(interface_operator_condense(full, work->basis.unit_load, work->basis.border, err));
    TRY(interface_operator_expand(full, work->basis.still, x, err));
    // The load does less work on a Galerkin answer than on the exact one, by the energy of the
    // difference.
    double energy = dense_dot(x, work->basis.unit_load, dofs), missing = energy - work->load_energy;
    *adds = missing > allowed * energy;
    for (int32_t k = 0; *adds && k < dofs; k++) x[k] /= sqrt(missing);
cleanup:
    return error_is_clean(err);
}

// Adds what the basis lacks at `point`; *left: the error of S there afterwards.
static bool visit(Builder *work, Point point, double *left, Error *err)
{
    const double factor[] = {[BULK_STIFFNESS] = 1 - point.viscosity,
                             [BULK_DAMPING] = point.viscosity,
                             [BULK_MASS] = point.inertia};
    int64_t m = work->basis.reduced->interface_count, dofs = work->basis.full.dof_count;
    int32_t wanted = 0;
    double allowed = allowed_error(work, point);
    bool load_too = false;
    InterfaceOperator *full =
        interface_operator_create(&work->basis.full, point_terms(work, point), err);
    if (!full) goto cleanup;
    TRY(basis_condense(&work->basis, factor, work->excess, &work->load_energy, err));
    TRY(compare(work, full, err));
    // The error of what is added becomes 0; what is left is that of the first motion not added.
    while (wanted < m && work->values[m - 1 - wanted] > allowed) wanted++;
    *left = wanted < m ? fmax(work->values[m - 1 - wanted], 0) : 0;
    double *x = basis_make_room(&work->basis, wanted + 1, err);
    if (!x) goto cleanup;
    TRY(answer_motions(work, full, wanted, x, err));
    TRY(answer_load(work, full, allowed, x + wanted * dofs, &load_too, err));
    if (wanted + load_too > 0) TRY(basis_extend(&work->basis, wanted + load_too, err));
cleanup:
    interface_operator_destroy(full);
    if (!error_is_clean(err)) error_context(err, "at inertia %g", point.inertia);
    return error_is_clean(err);
}

// Where regions differ in eta/E, C may be far softer or stiffer than K: slower and faster modes.
static void widen_levels(Builder *work, double *slowest)
{
    ViscousTimes range = materials_viscous_range(&work->def->materials);
    double unit = work->def->scales.stiffness / work->def->scales.damping;
    *slowest *= fmin(1, unit * range.volume);
    work->element_inertia *= fmax(1, unit * range.shear);
}

// Ascending: even ones are built at first, odd ones lie between, the last beyond.
static void list_levels(double slowest, double element_inertia, ReductionErrors *errors)
{
    // On a mesh of a few elements the slowest mode is hardly below that of one element.
    double lowest = fmin(LEVEL_LOWEST * slowest, element_inertia / LEVEL_RATIO);
    double decades = log(element_inertia / lowest) / log(LEVEL_RATIO);
    int32_t steps = (int32_t)fmin(ceil(decades), (REDUCTION_LEVELS_MAX - 2) / 2);
    for (int32_t k = 0; k <= 2 * steps; k++)
        errors->inertia[k] = lowest * pow(element_inertia / lowest, k / (2.0 * steps));
    errors->inertia[2 * steps + 1] = LEVEL_BEYOND * element_inertia;
    errors->count = 2 * steps + 2;
}

// Ascending from 0 to 1, such that the quotient named at VISCOSITY_RATIO goes from that of K to
// that of C in equal factors.
static void list_viscosities(Builder *work)
{
    const BulkScales *scales = &work->def->scales;
    ViscousTimes range = materials_viscous_range(&work->def->materials);
    double unit = scales->stiffness / scales->damping;
    double volume = unit * range.volume, shear = unit * range.shear;
    double decades = fabs(log(volume / shear)) / log(VISCOSITY_RATIO);
    int32_t steps = (int32_t)fmin(fmax(ceil(decades), 1), VISCOSITIES_MAX - 1);
    for (int32_t k = 1; k < steps; k++) {
        // (1 - v + v volume) = quotient (1 - v + v shear)
        double quotient = pow(volume / shear, (double)k / steps);
        work->viscosity[k] = (1 - quotient) / (1 - quotient + quotient * shear - volume);
    }
    work->viscosity[steps] = 1;
    work->viscosity_count = steps + 1;
}

// Every other level first: at those between them seldom anything is missing.
static bool visit_levels(Builder *work, Error *err)
{
    ReductionErrors *errors = &work->basis.reduced->errors;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = pass; k < errors->count; k += 2) {
            for (int32_t v = 0; v < work->viscosity_count; v++) {
                Point point = {.viscosity = work->viscosity[v], .inertia = errors->inertia[k]};
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
    int64_t m = work->basis.reduced->interface_count;
    const double factor[] = {[BULK_STIFFNESS] = 0, [BULK_DAMPING] = 1, [BULK_MASS] = 0};
    work->basis.reduced->viscous = NEW_ARRAY(double, m *m, err);
    return work->basis.reduced->viscous &&
           basis_condense(&work->basis, factor, work->basis.reduced->viscous, &work->load_energy,
                          err);
}

bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err)
{
    Builder work = {.bulk = bulk, .def = def};
    InterfaceOperator *statics = NULL;
    OperatorTerms terms = {.stiffness = 1 / def->scales.stiffness, .lift = true};
    double slowest = 0;
    *reduced = (ReducedBulk){.scales = def->scales};
    TRY(builder_create(interface_dofs, interface_count, reduced, &work, err));
    if (!(statics = interface_operator_create(&work.basis.full, terms, err))) goto cleanup;
    TRY(basis_start(&work.basis, statics, err));
    TRY(find_slowest(&work, statics, &slowest, err));
    work.element_inertia = find_element_inertia(&work);
    list_viscosities(&work);
    if (def->materials.count > 1) widen_levels(&work, &slowest);
    list_levels(slowest, work.element_inertia, &reduced->errors);
    TRY(visit_levels(&work, err));
    TRY(find_viscous(&work, err));
    int64_t m = reduced->interface_count, dofs = reduced->full_dofs;
    TRY(reduced_bulk_narrow(reduced, reduced->modes + m * dofs, dofs, err));
cleanup:
    interface_operator_destroy(statics);
    builder_destroy(&work);
    if (!error_is_clean(err)) error_context(err, "while reducing the bulk");
    return error_is_clean(err);
}
