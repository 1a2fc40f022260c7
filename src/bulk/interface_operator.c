// SPDX-License-Identifier: GPL-2.0-or-later
// The reduced operator keeps, for each A, the inverse of its interior block and the map
//
//     B = A_qq^-1 A_qb,   S = A_bb - A_bq B,   g = rhs_b - B' rhs_q,   v_q = A_qq^-1 rhs_q - B v_b.
//
// The full operator leaves all this to base/sparse, which reads S out of CHOLMOD's factor. Callers
// do not know which of the two they have (a test compares them). Unknowns of the full system are
// those of the mesh; of the reduced one the interface's come first, then the interior's coordinates
// q. A stage reads B twice (the second time what moves of it), half of A_qq^-1 and, for M v, M_qb.
#include "bulk/interface_operator.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

struct InterfaceOperator {
    BulkOperator *system;   // not owned
    double *schur;   // [interface_count^2] S, not lifted; owned
    SparseFactor *factor;   // full; owned
    double *inverse;   // reduced: [interior^2] A_qq^-1; owned
    double *map;   // reduced: [interior * interface] B; owned
    double *half;   // reduced: [interior] A_qq^-1 rhs_q; owned
    MachineColumn machine;   // empty: the rod is rigid; owned
};

static bool allocate_full(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                          BulkOperator *system, Error *err)
{
    *system = (BulkOperator){
        .dof_count = bulk->dof_count, .interface_count = interface_count, .bulk = bulk};
    system->interface_dofs = NEW_ARRAY(int32_t, interface_count, err);
    system->load = NEW_ARRAY(double, bulk->dof_count, err);
    system->rotation = NEW_ARRAY(double, bulk->dof_count, err);
    system->values = NEW_ARRAY(double, bulk->pattern.start[bulk->dof_count], err);
    if (!error_is_clean(err)) return false;
    memcpy(system->interface_dofs, interface_dofs, (size_t)interface_count * sizeof(int32_t));
    return true;
}

// The load is copied: later changes of `bulk` do not reach it. mass_total: of one direction, as
// both have the same.
bool bulk_operator_create(const Bulk *bulk, const double *position, const int32_t *interface_dofs,
                          int32_t interface_count, BulkOperator *system, Error *err)
{
    TRY(allocate_full(bulk, interface_dofs, interface_count, system, err));
    memcpy(system->load, bulk->load, (size_t)bulk->dof_count * sizeof(double));
    for (int32_t dof = 0; dof < bulk->dof_count; dof += 2) {
        system->rotation[dof] = position ? -position[dof + 1] : 0;
        system->rotation[dof + 1] = position ? position[dof] : 0;
        system->mass_total += bulk->mass[dof];
    }
    system->analysis = sparse_analyse(&bulk->pattern, interface_dofs, interface_count, err);
cleanup:
    return error_is_clean(err);
}

bool bulk_operator_copy(const BulkOperator *from, BulkOperator *system, Error *err)
{
    size_t size = (size_t)from->dof_count * sizeof(double);
    TRY(allocate_full(from->bulk, from->interface_dofs, from->interface_count, system, err));
    memcpy(system->load, from->load, size);
    memcpy(system->rotation, from->rotation, size);
    system->mass_total = from->mass_total;
    system->machine = from->machine;
    system->analysis = sparse_analysis_copy(from->analysis, err);
cleanup:
    return error_is_clean(err);
}

// M_qq where it is tridiagonal (reduced_bulk_narrow), close together.
static bool copy_narrow_mass(BulkOperator *system, Error *err)
{
    const ReducedBulk *reduced = system->reduced;
    int64_t r = reduced->interior_count, stride = reduced->count;
    const double *mass = reduced->mass + reduced->interface_count * (stride + 1);
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = j + 2; i < r; i++)
            if (mass[j * stride + i] != 0) return true;
    system->interior_mass = NEW_ARRAY(double, 2 * r, err);
    if (!system->interior_mass) return false;
    for (int64_t j = 0; j < r; j++) {
        system->interior_mass[j] = mass[j * stride + j];
        if (j + 1 < r) system->interior_mass[r + j] = mass[j * stride + j + 1];
    }
    return true;
}

bool bulk_operator_reduce(const ReducedBulk *reduced, const double *interface_rotation,
                          double mass_total, BulkOperator *system, Error *err)
{
    *system = (BulkOperator){.dof_count = reduced->count,
                             .interface_count = reduced->interface_count,
                             .reduced = reduced,
                             .mass_total = mass_total};
    system->interface_dofs = NEW_ARRAY(int32_t, reduced->interface_count, err);
    system->load = NEW_ARRAY(double, reduced->count, err);
    system->rotation = NEW_ARRAY(double, reduced->count, err);
    if (!error_is_clean(err)) goto cleanup;
    // A rigid motion is a static mode: its interior coordinates are 0.
    memcpy(system->rotation, interface_rotation, (size_t)reduced->interface_count * sizeof(double));
    for (int32_t k = 0; k < reduced->interface_count; k++) system->interface_dofs[k] = k;
    for (int32_t k = 0; k < reduced->count; k++)
        system->load[k] = reduced->scales.load * reduced->load[k];
    TRY(copy_narrow_mass(system, err));
cleanup:
    return error_is_clean(err);
}

void bulk_operator_destroy(BulkOperator *system)
{
    memory_free(system->interface_dofs);
    memory_free(system->load);
    memory_free(system->rotation);
    memory_free(system->values);
    memory_free(system->interior_mass);
    sparse_analysis_destroy(system->analysis);
    *system = (BulkOperator){0};
}

// y = K x, C x or M x in the scene's units: normalised matrices times their scale.
static void apply_reduced(const BulkOperator *system, BulkTerm term, const double *x, double *y)
{
    const ReducedBulk *reduced = system->reduced;
    const BulkScales *scales = &reduced->scales;
    double factor = scales->stiffness;
    if (term == BULK_STIFFNESS) {
        int32_t m = reduced->interface_count;
        memset(y, 0, (size_t)m * sizeof(double));
        dense_add_nonzero((DenseView){reduced->stiffness, m, m}, x, 1, y);
        memcpy(y + reduced->interface_count, x + reduced->interface_count,
               (size_t)reduced->interior_count * sizeof(double));
    } else if (term == BULK_MASS && system->interior_mass) {
        factor = scales->mass;
        dense_bordered_apply(
            (DenseBordered){.values = reduced->mass,
                            .size = reduced->count,
                            .border = reduced->interface_count,
                            .diagonal = system->interior_mass,
                            .beside = system->interior_mass + reduced->interior_count},
            x, y);
    } else {
        factor = term == BULK_MASS ? scales->mass : scales->damping;
        dense_symmetric_apply(term == BULK_MASS ? reduced->mass : reduced->damping, reduced->count,
                              x, y);
    }
    for (int32_t k = 0; k < reduced->count; k++) y[k] *= factor;
}

// x, y: [dof_count], distinct.
void bulk_operator_apply(const BulkOperator *system, BulkTerm term, const double *x, double *y)
{
    const Bulk *bulk = system->bulk;
    if (!bulk) {
        apply_reduced(system, term, x, y);
    } else if (term == BULK_MASS) {
        for (int32_t k = 0; k < system->dof_count; k++) y[k] = bulk->mass[k] * x[k];
    } else {
        sparse_apply(&bulk->pattern, term == BULK_STIFFNESS ? bulk->stiffness : bulk->damping, x,
                     y);
    }
}

void bulk_operator_apply_many(const BulkOperator *system, BulkTerm term, const double *x,
                              int64_t columns, double *y, double *work)
{
    const Bulk *bulk = system->bulk;
    if (term == BULK_MASS) {
        for (int64_t j = 0; j < columns; j++)
            bulk_operator_apply(system, term, x + j * system->dof_count, y + j * system->dof_count);
    } else {
        sparse_apply_many(&bulk->pattern, term == BULK_STIFFNESS ? bulk->stiffness : bulk->damping,
                          x, columns, y, work);
    }
}

// Interior coordinates are orthonormal in K/E, so their length is a displacement's elastic size.
double bulk_operator_size(const BulkOperator *system, const double *x)
{
    if (system->bulk) return dense_max_abs(x, system->dof_count);
    int32_t m = system->interface_count;
    double interior = sqrt(dense_dot(x + m, x + m, system->dof_count - m));
    return fmax(interior, dense_max_abs(x, m));
}

// Nothing is lost: u = V q in every node of the mesh.
void bulk_operator_recover(const BulkOperator *system, const double *x, double *full)
{
    if (system->bulk)
        memcpy(full, x, (size_t)system->dof_count * sizeof(double));
    else
        reduced_bulk_recover(system->reduced, x, full);
}

void bulk_operator_recover_each(const BulkOperator *system, int32_t count, const double *const *x,
                                double *const *full)
{
    if (system->reduced)
        reduced_bulk_recover_each(system->reduced, count, x, full);
    else
        for (int32_t k = 0; k < count; k++) bulk_operator_recover(system, x[k], full[k]);
}

// The share of inertia in A, normalised as bulk/reduction has it.
double bulk_operator_error(const BulkOperator *system, OperatorTerms terms)
{
    if (!system->reduced) return 0;
    const BulkScales *scales = &system->reduced->scales;
    double rest = terms.damping * scales->damping + terms.stiffness * scales->stiffness;
    return reduced_bulk_error(system->reduced, terms.mass * scales->mass / rest);
}

// A = m M + c C + k K; returns its largest diagonal entry on the interface.
static double combine_sparse(BulkOperator *system, OperatorTerms terms)
{
    const Bulk *bulk = system->bulk;
    const SparsePattern *pattern = &bulk->pattern;
    double *values = system->values, largest = 0;
    int32_t entries = pattern->start[bulk->dof_count];
    for (int32_t k = 0; k < entries; k++)
        values[k] = terms.damping * bulk->damping[k] + terms.stiffness * bulk->stiffness[k];
    for (int32_t dof = 0; terms.mass != 0 && dof < bulk->dof_count; dof++)
        values[sparse_entry(pattern, dof, dof)] += terms.mass * bulk->mass[dof];
    for (int32_t j = 0; j < system->interface_count; j++) {
        int32_t dof = system->interface_dofs[j];
        largest = fmax(largest, values[sparse_entry(pattern, dof, dof)]);
    }
    return largest;
}

// S is the square of the factor's last block (base/sparse); lifting the border's diagonal adds the
// same to S, and is taken off again.
static bool condense_sparse(InterfaceOperator *condensed, OperatorTerms terms, Error *err)
{
    BulkOperator *system = condensed->system;
    int64_t m = system->interface_count;
    double largest = combine_sparse(system, terms), shift = terms.lift ? largest : 0;
    for (int32_t j = 0; j < m; j++) {
        int32_t dof = system->interface_dofs[j];
        system->values[sparse_entry(&system->bulk->pattern, dof, dof)] += shift;
    }
    condensed->factor = sparse_factorise(system->analysis, system->values, err);
    if (!condensed->factor) return false;
    if (terms.lower_only) return true;
    sparse_schur(condensed->factor, condensed->schur);
    for (int64_t j = 0; j < m; j++) condensed->schur[j * m + j] -= shift;
    return true;
}

// Rows `first` to `first + rows` of a column of A, but for its part in K.
static void reduced_column(const ReducedBulk *reduced, OperatorTerms terms, int64_t column,
                           int64_t first, int64_t rows, double *out)
{
    int64_t at = column * reduced->count + first;
    const double *mass = reduced->mass + at, *damping = reduced->damping + at;
    double m = terms.mass * reduced->scales.mass, c = terms.damping * reduced->scales.damping;
    for (int64_t row = 0; row < rows; row++) out[row] = m * mass[row] + c * damping[row];
}

// S of C alone, where the reduction has it and nothing else will be asked for.
static bool take_viscous(InterfaceOperator *condensed, OperatorTerms terms)
{
    const ReducedBulk *reduced = condensed->system->reduced;
    if (!reduced->viscous || !terms.schur_only || terms.mass != 0 || terms.stiffness != 0)
        return false;
    double factor = terms.damping * reduced->scales.damping;
    int64_t entries = (int64_t)reduced->interface_count * reduced->interface_count;
    for (int64_t k = 0; k < entries; k++) condensed->schur[k] = factor * reduced->viscous[k];
    return true;
}

// The formulas at the head. The inverse itself, not a factor: a product with it is one pass over
// memory for each of many right-hand sides, and A_qq is well conditioned (K_qq = 1).
static bool condense_dense(InterfaceOperator *condensed, OperatorTerms terms, Error *err)
{
    const ReducedBulk *reduced = condensed->system->reduced;
    int64_t m = reduced->interface_count, r = reduced->interior_count;
    double *coupling = NEW_ARRAY(double, r *m, err);
    condensed->inverse = NEW_ARRAY(double, r *r, err);
    condensed->map = NEW_ARRAY(double, r *m, err);
    condensed->half = NEW_ARRAY(double, r, err);
    if (!error_is_clean(err)) goto cleanup;
    double k = terms.stiffness * reduced->scales.stiffness;
    for (int64_t column = 0; column < r; column++) {
        reduced_column(reduced, terms, m + column, m, r, condensed->inverse + column * r);
        condensed->inverse[column * r + column] += k;
    }
    for (int64_t column = 0; column < m; column++) {
        double *schur = condensed->schur + column * m;
        const double *stiffness = reduced->stiffness + column * m;
        reduced_column(reduced, terms, column, m, r, coupling + column * r);
        reduced_column(reduced, terms, column, 0, m, schur);
        for (int64_t row = 0; row < m; row++) schur[row] += k * stiffness[row];
    }
    if (!dense_cholesky(condensed->inverse, (int32_t)r) ||
        !dense_invert_factored(condensed->inverse, (int32_t)r))
        FAIL(err, ERROR_COMPUTE, "the interior of the reduced bulk is not positive definite");
    DenseView inverse = {condensed->inverse, (int32_t)r, (int32_t)r};
    DenseView couple = {coupling, (int32_t)r, (int32_t)m};
    DenseView map = {condensed->map, (int32_t)r, (int32_t)m};
    dense_multiply(inverse, couple, 1, 0, condensed->map);
    dense_multiply_transposed(couple, map, -1, 1, condensed->schur);
cleanup:
    memory_free(coupling);
    return error_is_clean(err);
}

// Memory of a reduced one: m^2 + r^2 + r m doubles, m interface and r interior unknowns; of a full
// one the sparse factor and 2 m^2. That of C alone, for the certificate, is copied from the
// reduction.
InterfaceOperator *interface_operator_create(BulkOperator *system, OperatorTerms terms, Error *err)
{
    int64_t m = system->interface_count;
    InterfaceOperator *condensed = NEW_ARRAY(InterfaceOperator, 1, err);
    if (!condensed) goto cleanup;
    condensed->system = system;
    condensed->schur = NEW_ARRAY(double, terms.lower_only ? 0 : m *m, err);
    if (!condensed->schur) goto cleanup;
    bool taken = !system->bulk && take_viscous(condensed, terms);
    if (system->bulk)
        TRY(condense_sparse(condensed, terms, err));
    else if (!taken)
        TRY(condense_dense(condensed, terms, err));
    system->factorisations += !taken;
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
    memory_free(condensed->inverse);
    memory_free(condensed->map);
    memory_free(condensed->half);
    machine_column_destroy(&condensed->machine);
    memory_free(condensed);
}

const double *interface_operator_schur(const InterfaceOperator *condensed)
{
    return condensed->schur;
}

const double *interface_operator_schur_lower(const InterfaceOperator *condensed)
{
    return sparse_schur_lower(condensed->factor);
}

// The half-solved right-hand side (reduced: A_qq^-1 rhs_q) is kept for the expand that follows.
bool interface_operator_condense(InterfaceOperator *condensed, const double *rhs, double *g,
                                 Error *err)
{
    const ReducedBulk *reduced = condensed->system->reduced;
    if (condensed->factor) {
        TRY(sparse_condense(condensed->factor, rhs, g, err));
    } else {
        int32_t m = reduced->interface_count, r = reduced->interior_count;
        memcpy(g, rhs, (size_t)m * sizeof(double));
        dense_symmetric_apply(condensed->inverse, r, rhs + m, condensed->half);
        // B last: the expand reads it next.
        dense_apply_transposed((DenseView){condensed->map, r, m}, rhs + m, -1, 1, g);
    }
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
    const ReducedBulk *reduced = condensed->system->reduced;
    int32_t m = reduced->interface_count, r = reduced->interior_count;
    memcpy(v, interface, (size_t)m * sizeof(double));
    memcpy(v + m, condensed->half, (size_t)r * sizeof(double));
    dense_add_nonzero((DenseView){condensed->map, r, m}, interface, -1, v + m);
    return true;
}

bool interface_operator_answer(InterfaceOperator *condensed, const double *motions, int32_t count,
                               double *v, Error *err)
{
    return sparse_expand_many(condensed->factor, motions, count, v, err);
}

bool interface_operator_answer_held(InterfaceOperator *condensed, const double *rhs, double *v,
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
    archive_count(archive, &system->factorisations);
    archive_count(archive, &system->solves);
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
    hash_bytes(hash, &system->dof_count, sizeof system->dof_count);
    hash_bytes(hash, system->interface_dofs,
               (size_t)system->interface_count * sizeof *system->interface_dofs);
    if (bulk) {
        int64_t entries = bulk->pattern.start[bulk->dof_count];
        hash_numbers(hash, bulk->mass, bulk->dof_count);
        hash_numbers(hash, bulk->stiffness, entries);
        hash_numbers(hash, bulk->damping, entries);
    } else {
        int64_t m = reduced->interface_count, all = reduced->count;
        hash_numbers(hash, reduced->mass, all * all);
        hash_numbers(hash, reduced->damping, all * all);
        hash_numbers(hash, reduced->stiffness, m * m);
    }
}
