// SPDX-License-Identifier: GPL-2.0-or-later
// The full operator leaves all to algebra/sparse, which reads S out of CHOLMOD's factor, the
// reduced one to reduction/reduced_operator. Callers do not know which of the two they have (a test
// compares them). Unknowns of the full system are those of the mesh; of the reduced one the
// interface's come first, then the interior's coordinates q.
#include "reduction/interface_operator.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

struct InterfaceOperator {
    BulkOperator *system;   // not owned
    double *schur;   // [interface_count^2] S, not lifted; owned
    SparseFactor *factor;   // full; owned
    CondensedBulk *small;   // reduced; owned
    MachineColumn machine;   // empty: the rod is rigid; owned
};

static bool allocate_full(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                          BulkOperator *system, Error *err)
{
    *system = (BulkOperator){
        .dof_count = bulk->dof_count, .interface_count = interface_count, .bulk = bulk};
    system->interface_dofs = NEW_ARRAY(int32_t, interface_count, err);
    system->load = NEW_ARRAY(double, bulk->dof_count, err);
    system->values = NEW_ARRAY(double, bulk->pattern.start[bulk->dof_count], err);
    if (!error_is_clean(err)) return false;
    memcpy(system->interface_dofs, interface_dofs, (size_t)interface_count * sizeof(int32_t));
    return true;
}

// The load is copied: later changes of `bulk` do not reach it.
bool bulk_operator_create(const Bulk *bulk, const double *position, const int32_t *interface_dofs,
                          int32_t interface_count, BulkOperator *system, Error *err)
{
    int32_t dim = bulk->dim, dofs = bulk->dof_count;
    if (!allocate_full(bulk, interface_dofs, interface_count, system, err)) return false;
    memcpy(system->load, bulk->load, (size_t)dofs * sizeof(double));
    system->position = position;

    // Rigid motions of the block, over a base that stands still, and the mass in one direction, as
    // all have the same.
    if (position) {
        double *next = system->rigid = NEW_ARRAY(double, (int64_t)rigid_count(dim) * dofs, err);
        if (!next) return false;
        for (int32_t dof = 0; dof < dofs; dof += dim)
            system->mass_total += bulk->in_base && bulk->in_base[dof] ? 0 : bulk->mass[dof];
        for (int32_t which = 0; which < rigid_count(dim); which++)
            for (int32_t dof = 0; dof < dofs; dof++) {
                bool still = bulk->in_base && bulk->in_base[dof];
                int32_t axis = dof_axis(dim, dof);
                *next++ = still ? 0 : rigid_motion(dim, which, position + dof - axis, axis);
            }
    }
    system->analysis =
        sparse_analyse(&bulk->pattern, bulk->place, interface_dofs, interface_count, err);
    return error_is_clean(err);
}

bool bulk_operator_copy(const BulkOperator *from, BulkOperator *system, Error *err)
{
    if (!allocate_full(from->bulk, from->interface_dofs, from->interface_count, system, err))
        return false;
    memcpy(system->load, from->load, (size_t)from->dof_count * sizeof(double));
    system->position = from->position;
    system->analysis = sparse_analysis_copy(from->analysis, err);
    return error_is_clean(err);
}

bool bulk_operator_reduce(const ReducedBulk *reduced, double length, double mass_total,
                          BulkOperator *system, Error *err)
{
    *system = (BulkOperator){.dof_count = reduced->count,
                             .interface_count = reduced->interface_count,
                             .reduced = reduced,
                             .mass_total = mass_total};
    system->interface_dofs = NEW_ARRAY(int32_t, reduced->interface_count, err);
    system->load = NEW_ARRAY(double, reduced->count, err);
    int32_t border = reduced->interface_count + reduced->mirrored,
            motions = rigid_count(reduced->dim);
    system->rigid = NEW_ARRAY(double, (int64_t)motions * reduced->count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t which = 0; reduced->rigid && which < motions; which++)
        for (int32_t k = 0; k < border; k++)
            system->rigid[which * reduced->count + k] = (which < reduced->dim ? 1 : length) *
                                                        reduced->rigid[which * border + k];
    for (int32_t k = 0; k < reduced->interface_count; k++) system->interface_dofs[k] = k;
    for (int32_t k = 0; k < reduced->count; k++)
        system->load[k] = reduced->scales.load * reduced->load[k];
    system->small = reduced_operator_create(reduced, err);
    return error_is_clean(err);
}

void bulk_operator_destroy(BulkOperator *system)
{
    memory_free_all(system->interface_dofs, system->load, system->rigid, system->values);
    reduced_operator_destroy(system->small);
    sparse_analysis_destroy(system->analysis);
    *system = (BulkOperator){0};
}

const Spectrum *bulk_operator_spectrum(const BulkOperator *system)
{
    static const Spectrum none = {0};   // of a system without a bulk
    if (system->bulk) return &system->bulk->spectrum;
    return system->reduced ? &system->reduced->spectrum : &none;
}

// x, y: [dof_count], distinct.
void bulk_operator_apply(const BulkOperator *system, BulkTerm term, const double *x, double *y)
{
    const Bulk *bulk = system->bulk;
    if ((int32_t)term >= BULK_SHAPE + bulk_operator_spectrum(system)->matrix_count)
        term = BULK_STIFFNESS;
    if (!bulk) {
        reduced_operator_apply(system->small, term, x, y);
    } else if (term == BULK_MASS) {
        bulk_apply_mass(bulk, x, y);
    } else {
        sparse_apply(&bulk->pattern,
                     term == BULK_STIFFNESS ? bulk->stiffness
                     : term == BULK_DAMPING ? bulk->damping
                                            : bulk->shape[term - BULK_SHAPE],
                     x, y);
    }
}

// Interior coordinates are orthonormal in K/E, so their length is a displacement's elastic size.
double bulk_operator_size(const BulkOperator *system, const double *x)
{
    if (system->bulk) return dense_max_abs(x, system->dof_count);
    int32_t border = system->interface_count + system->reduced->mirrored;
    double interior = sqrt(dense_dot(x + border, x + border, system->dof_count - border));
    return fmax(interior, dense_max_abs(x, border));
}

// Nothing is lost: u = V q in every node of the mesh.
bool bulk_operator_recover(const BulkOperator *system, int32_t count, const double *const *x,
                           double *const *full, Error *err)
{
    if (system->reduced) return reduced_bulk_recover(system->reduced, count, x, full, err);
    for (int32_t k = 0; k < count; k++)
        memcpy(full[k], x[k], (size_t)system->dof_count * sizeof(double));
    return true;
}

bool bulk_operator_project(const BulkOperator *system, const double *full, double *row, Error *err)
{
    if (system->reduced) return reduced_bulk_project(system->reduced, full, row, err);
    memcpy(row, full, (size_t)system->dof_count * sizeof *row);
    return true;
}

// The share of inertia in A, normalised as reduction/reduction has it.
double bulk_operator_error(const BulkOperator *system, OperatorTerms terms)
{
    if (!system->reduced) return 0;
    const BulkScales *scales = &system->reduced->scales;
    double rest = terms.damping * scales->damping + terms.stiffness * scales->stiffness;
    return reduced_bulk_error(system->reduced, terms.mass * scales->mass / rest);
}

// A = m M + c C + k K with its branches, factored. S is the square of the factor's last block
// (algebra/sparse); lifting the border's diagonal adds the same to S, and is taken off again.
static bool condense_sparse(InterfaceOperator *condensed, OperatorTerms terms, Error *err)
{
    BulkOperator *system = condensed->system;
    const Bulk *bulk = system->bulk;
    const SparsePattern *pattern = &bulk->pattern;
    double weight[SPECTRUM_SHAPES_MAX], *values = system->values, shift = 0;
    int32_t entries = pattern->start[bulk->dof_count];
    int64_t m = system->interface_count;
    terms.stiffness += spectrum_weights(&bulk->spectrum, terms.damping, terms.stiffness, weight);
    for (int32_t k = 0; k < entries; k++)
        values[k] = terms.damping * bulk->damping[k] + terms.stiffness * bulk->stiffness[k];
    for (int32_t j = 0; j < bulk->spectrum.matrix_count; j++)
        for (int32_t k = 0; weight[j] != 0 && k < entries; k++)
            values[k] += weight[j] * bulk->shape[j][k];
    for (int32_t dof = 0; terms.mass != 0 && dof < bulk->dof_count; dof++)
        values[sparse_entry(pattern, dof, dof)] += terms.mass * bulk->mass[dof];
    for (int32_t k = 0; bulk->mass_beside && terms.mass != 0 && k < entries; k++)
        values[k] += terms.mass * bulk->mass_beside[k];

    // Lifted by its largest diagonal entry on the interface.
    for (int64_t j = 0; terms.lift && j < m; j++) {
        int32_t dof = system->interface_dofs[j];
        shift = fmax(shift, values[sparse_entry(pattern, dof, dof)]);
    }
    for (int64_t j = 0; j < m; j++) {
        int32_t dof = system->interface_dofs[j];
        values[sparse_entry(pattern, dof, dof)] += shift;
    }
    condensed->factor = sparse_factorise(system->analysis, values, err);
    if (!condensed->factor) return false;
    if (terms.lower_only) return true;
    sparse_schur(condensed->factor, condensed->schur);
    for (int64_t j = 0; j < m; j++) condensed->schur[j * m + j] -= shift;
    return true;
}

// Memory of a reduced one: m^2 + r^2 + r m doubles, m interface and r interior unknowns, of two
// parts m^2 and half of the rest; of a full one the sparse factor and 2 m^2.
InterfaceOperator *interface_operator_create(BulkOperator *system, OperatorTerms terms, Error *err)
{
    int64_t m = system->interface_count;
    InterfaceOperator *condensed = NEW_ARRAY(InterfaceOperator, 1, err);
    if (!condensed) goto cleanup;
    condensed->system = system;
    int64_t entries = terms.lower_only ? 0 : m * m;   // all are written
    TRY((condensed->schur = memory_bytes(entries * (int64_t)sizeof(double), err)));
    if (system->bulk)
        TRY(condense_sparse(condensed, terms, err));
    else
        TRY(condensed->small = condensed_bulk_create(system->small, terms, condensed->schur, err));
    system->factorisations++;
    if (system->machine.stiffness > 0)
        TRY(machine_soften(&system->machine, terms.stiffness, (int32_t)m, condensed->schur,
                           &condensed->machine, err));
cleanup:
    if (error_is_clean(err)) return condensed;
    interface_operator_destroy(condensed);
    return NULL;
}

void interface_operator_destroy(InterfaceOperator *condensed)
{
    if (!condensed) return;
    sparse_factor_destroy(condensed->factor);
    memory_free(condensed->schur);
    condensed_bulk_destroy(condensed->small);
    machine_column_destroy(&condensed->machine);
    memory_free(condensed);
}

const double *interface_operator_schur(const InterfaceOperator *condensed)
{
    return condensed->schur;
}

double *interface_operator_take_schur(InterfaceOperator *condensed)
{
    double *schur = condensed->schur;
    condensed->schur = NULL;
    return schur;
}

const double *interface_operator_schur_lower(const InterfaceOperator *condensed)
{
    return sparse_schur_lower(condensed->factor);
}

// The half-solved right-hand side is kept for the expand that follows.
bool interface_operator_condense(InterfaceOperator *condensed, const double *rhs, double *g,
                                 Error *err)
{
    if (condensed->factor)
        TRY(sparse_condense(condensed->factor, rhs, g, err));
    else
        condensed_bulk_condense(condensed->small, rhs, g);
    if (condensed->machine.column) machine_refer(&condensed->machine, g);
cleanup:
    return error_is_clean(err);
}

void interface_operator_pull(InterfaceOperator *condensed, double force)
{
    condensed->machine.force = force;
}

double interface_operator_release(const InterfaceOperator *condensed, double *velocity)
{
    return condensed->machine.column ? machine_release(&condensed->machine, velocity) : 0;
}

bool interface_operator_expand(InterfaceOperator *condensed, const double *interface, double *v,
                               Error *err)
{
    condensed->system->solves++;
    if (condensed->factor) return sparse_expand(condensed->factor, interface, v, err);
    condensed_bulk_expand(condensed->small, interface, v);
    return true;
}

bool interface_operator_respond(const InterfaceOperator *condensed, const double *boundary,
                                int32_t count, double *v, Error *err)
{
    return sparse_expand_many(condensed->factor, boundary, count, v, err);
}

bool interface_operator_condense_many(const InterfaceOperator *condensed, const double *rhs,
                                      int32_t count, double *g, Error *err)
{
    return sparse_condense_many(condensed->factor, rhs, count, g, err);
}

bool interface_operator_respond_held(InterfaceOperator *condensed, const double *rhs, double *v,
                                     double *g, Error *err)
{
    double *still = NEW_ARRAY(double, condensed->system->interface_count, err);
    bool done = still && interface_operator_condense(condensed, rhs, g, err) &&
                interface_operator_expand(condensed, still, v, err);
    memory_free(still);
    return done;
}

void bulk_operator_archive(BulkOperator *system, Archive *archive)
{
    archive_section(archive, "bulk");
    archive_numbers(archive, system->load, system->dof_count);
    archive_counts_of(archive, &system->factorisations, &system->solves);
}

static void hash_numbers(Hash *hash, const double *numbers, int64_t count)
{
    hash_bytes(hash, numbers, (size_t)count * sizeof(double));
}

// A reduced state is in coordinates of its basis: the same mesh reduced on another computer may
// have another one.
void bulk_operator_hash(const BulkOperator *system, Hash *hash)
{
    const Bulk *bulk = system->bulk;
    const ReducedBulk *reduced = system->reduced;
    spectrum_hash(bulk_operator_spectrum(system), hash);
    hash_bytes(hash, &system->dof_count, sizeof system->dof_count);
    hash_bytes(hash, system->interface_dofs,
               (size_t)system->interface_count * sizeof *system->interface_dofs);
    if (bulk) {
        int64_t entries = bulk->pattern.start[bulk->dof_count];
        hash_numbers(hash, bulk->mass, bulk->dof_count);
        if (bulk->mass_beside) hash_numbers(hash, bulk->mass_beside, entries);
        hash_numbers(hash, bulk->stiffness, entries);
        hash_numbers(hash, bulk->damping, entries);
        for (int32_t j = 0; j < bulk->spectrum.matrix_count; j++)
            hash_numbers(hash, bulk->shape[j], entries);
    }
    for (int p = 0; reduced && p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        int64_t m = part->border_count, all = part->count;
        hash_numbers(hash, part->mass, m * m);
        hash_numbers(hash, part->coupling, (all - m) * m);
        hash_numbers(hash, part->masses, all - m);
        hash_numbers(hash, part->damping, all * all);
        hash_numbers(hash, part->stiffness, m * m);
        for (int32_t j = 0; j < part->shape_count; j++)
            hash_numbers(hash, part->shape[j], all * all);
    }
}
