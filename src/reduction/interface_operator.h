// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk as the time stepper sees it: a linear system with `dof_count` unknowns, of which a
// few, the interface, carry unknown reactions:
//
//     M u'' + C u' + K u = f + G' r
//
// (with the forces of its materials' branches, fem/spectrum) and asks for A = m M + c C + k K, with
// what branches add to it (OperatorTerms in reduction/reduced_operator), condensed on the
// interface, S v_b = g + r_b, and for v from v_b. There are two kinds. Full: the unknowns of the
// mesh, A factored by CHOLMOD with the interface last. Reduced (reduction/reduction): the interface
// first, then a small interior basis, dense.
#ifndef AMONTONS_REDUCTION_INTERFACE_OPERATOR_H
#define AMONTONS_REDUCTION_INTERFACE_OPERATOR_H

#include "base/archive.h"
#include "base/hash.h"
#include "fem/assembly.h"
#include "reduction/machine.h"
#include "reduction/reduced_operator.h"

typedef struct BulkOperator {
    int32_t dof_count;
    int32_t interface_count;
    int32_t *interface_dofs;   // [interface_count] indices of unknowns; owned
    double *load;   // [dof_count] f, force/width; owned
    double *rigid;   // [rigid_count][dof_count] rigid motions (reduction/reduced_bulk); owned
    double mass_total;   // of the block, mass/width
    Machine machine;   // behind the rod; set before an operator is made, rigid at first
    const Bulk *bulk;   // full: K, C, M; not owned; NULL when reduced
    const double *position;   // [dof_count] full: places of its nodes, length; not owned; NULL: not
        // given
    const ReducedBulk *reduced;   // reduced: likewise; not owned; NULL when full
    ReducedOperator *small;   // of it; owned
    SparseAnalysis *analysis;   // full; owned
    double *values;   // full: [entries] work, A; owned
    int64_t factorisations;   // counted: sparse, or dense of the interior
    int64_t solves;   // counted
} BulkOperator;

// position: [dof_count] of `bulk`, places of its nodes, length; NULL: no rigid motions and no
// mirror images are asked for. `bulk` and position must outlive the operator.
bool bulk_operator_create(const Bulk *bulk, const double *position, const int32_t *interface_dofs,
                          int32_t interface_count, BulkOperator *system, Error *err);
// Another one of a full bulk, for another thread: nothing is analysed again.
bool bulk_operator_copy(const BulkOperator *from, BulkOperator *system, Error *err);

// length: L. `reduced` must outlive the operator.
bool bulk_operator_reduce(const ReducedBulk *reduced, double length, double mass_total,
                          BulkOperator *system, Error *err);
void bulk_operator_destroy(BulkOperator *system);

// The spectrum of the materials' branches.
const Spectrum *bulk_operator_spectrum(const BulkOperator *system);

// y = K x, C x, M x or S_j x; [dof_count]
void bulk_operator_apply(const BulkOperator *system, BulkTerm term, const double *x, double *y);
// The size of a displacement, length, or of a velocity: the largest component on the full mesh; on
// a reduced one the largest on the border or, if larger, sqrt(2 elastic energy / E) of the
// interior.
double bulk_operator_size(const BulkOperator *system, const double *x);

// full: [2 * nodes] of `count` vectors x of the system's unknowns, as displacement and velocity:
// copies, or modes * x at far less than the cost of as many calls.
bool bulk_operator_recover(const BulkOperator *system, int32_t count, const double *const *x,
                           double *const *full, Error *err);

// The transpose: the coefficients of a linear reading of the mesh's displacements, full [dim *
// nodes], become those of the system's unknowns, row [dof_count].
bool bulk_operator_project(const BulkOperator *system, const double *full, double *row, Error *err);

// The largest relative error of S that the reduction leaves at these terms; 0: full.
double bulk_operator_error(const BulkOperator *system, OperatorTerms terms);

typedef struct InterfaceOperator InterfaceOperator;   // A, factored

// ERROR_COMPUTE when A is not positive definite.
InterfaceOperator *interface_operator_create(BulkOperator *system, OperatorTerms terms, Error *err);
void interface_operator_destroy(InterfaceOperator *condensed);   // NULL is fine

// S: [interface_count^2], symmetric, column-major. Behind a rod on a spring (reduction/machine) it
// is S', what is condensed is g', and a caller turns what it finds by interface_operator_release
// before the expand.
const double *interface_operator_schur(const InterfaceOperator *condensed);
// S, from here on owned by the caller; the operator has none. What is condensed needs none.
double *interface_operator_take_schur(InterfaceOperator *condensed);
// The Cholesky factor of S of a full mesh that is not lifted, 0 above the diagonal.
const double *interface_operator_schur_lower(const InterfaceOperator *condensed);
// rhs [dof_count] -> g [interface_count]; expand must follow before the next condense.
bool interface_operator_condense(InterfaceOperator *condensed, const double *rhs, double *g,
                                 Error *err);
// Sets the force that pulls the rod at v_R = 0 in all that is condensed from here on, force/width.
void interface_operator_pull(InterfaceOperator *condensed, double force);
// y [interface_count], against the rod, becomes v_b; returns v_R (0, and v_b as it is: no spring).
double interface_operator_release(const InterfaceOperator *condensed, double *velocity);
// v_b [interface_count] -> v [dof_count]
bool interface_operator_expand(InterfaceOperator *condensed, const double *interface, double *v,
                               Error *err);

// Responses v [dof_count * count] of the full mesh to `count` boundary motions v_b [interface_count
// * count], nothing pressing inside.
bool interface_operator_respond(const InterfaceOperator *condensed, const double *boundary,
                                int32_t count, double *v, Error *err);

// What is condensed of `count` right sides, g [interface_count * count] of rhs [dof_count * count],
// of the full mesh.
bool interface_operator_condense_many(const InterfaceOperator *condensed, const double *rhs,
                                      int32_t count, double *g, Error *err);

// The response v [dof_count] to `rhs`, the interface held, and what is condensed of it, g
// [interface_count].
bool interface_operator_respond_held(InterfaceOperator *condensed, const double *rhs, double *v,
                                     double *g, Error *err);

// The load, which a caller may have changed, and the counters; all else is the model's.
void bulk_operator_archive(BulkOperator *system, Archive *archive);
// Hashes all that a state depends on: a state of another bulk means nothing here.
void bulk_operator_hash(const BulkOperator *system, Hash *hash);

#endif
