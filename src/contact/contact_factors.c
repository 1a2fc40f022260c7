// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of all interface unknowns: what is held in J0 and in J, and what is open, has zeros.
#include "contact/contact_factors.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

// x may be this much smaller than J0^-1 b, of which it is what is left: ten digits of it stay.
static const double CANCELLED_LIMIT = 1e6;

// More rows than a fifth of J0's are factored anew as fast; a tenth or 0.4 of them takes as long.
static int32_t room_of(int32_t rows)
{
    return rows / 5;
}

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err)
{
    int64_t count = interface->count, room = room_of(interface->count);
    *factors = (ContactFactors){.count = interface->count};
    factors->lu = memory_bytes(8 * count * count, err);
    factors->pivots = NEW_ARRAY(int32_t, count, err);
    factors->free = NEW_ARRAY(int32_t, count, err);
    factors->row = NEW_ARRAY(FactoredRow, count, err);
    factors->status = NEW_ARRAY(uint8_t, count, err);
    factors->replaced = NEW_ARRAY(int32_t, room, err);
    factors->z = memory_bytes(8 * count * room, err);
    factors->v = memory_bytes(8 * count * room, err);
    factors->p = memory_bytes(8 * room * room, err);
    factors->p_pivots = NEW_ARRAY(int32_t, room, err);
    factors->now = NEW_ARRAY(FactoredRow, count, err);
    factors->x = NEW_ARRAY(double, count, err);
    factors->y = NEW_ARRAY(double, count, err);
    factors->t = NEW_ARRAY(double, count, err);
    return error_is_clean(err);
}

void contact_factors_destroy(ContactFactors *factors)
{
    memory_free_all(factors->lu, factors->pivots, factors->free, factors->row, factors->status,
                    factors->replaced, factors->z, factors->v, factors->p, factors->p_pivots,
                    factors->now, factors->x, factors->y, factors->t);
    *factors = (ContactFactors){0};
}

static void find_rows(ContactFactors *factors, const ContactEquations *equations, FactoredRow *row)
{
    contact_diagonal(equations, factors->x);
    for (int32_t k = 0; k < factors->count; k++) row[k] = (FactoredRow){.normal = -1};
    for (int32_t a = 0; a < equations->free_count; a++) {
        ContactRow now = equations->row[a];
        row[equations->free[a]] = (FactoredRow){now.normal, now.mu, factors->x[a]};
    }
}

bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix)
{
    int32_t rows = equations->free_count;
    contact_jacobian(equations, matrix, rows, factors->lu);
    find_rows(factors, equations, factors->row);
    contact_copy_statuses(equations, factors->status);
    memcpy(factors->free, equations->free, (size_t)rows * sizeof(int32_t));
    factors->replaced_count = 0;
    factors->rows = dense_lu(factors->lu, rows, factors->pivots) ? rows : 0;
    return factors->rows == rows;
}

// --- other rows ---------------------------------------------------------------------------------

// z := J0^-1 z, where what is held is right already.
static void solve_kept(ContactFactors *factors, double *z)
{
    for (int32_t a = 0; a < factors->rows; a++) factors->x[a] = z[factors->free[a]];
    dense_lu_solve(factors->lu, factors->rows, factors->pivots, factors->x);
    for (int32_t a = 0; a < factors->rows; a++) z[factors->free[a]] = factors->x[a];
}

// Column b of Z, that leaves all of J0's rows but one as they are; its scale is any.
static void leave_row(ContactFactors *factors, const ContactProblem *problem, const double *matrix,
                      int32_t b)
{
    int32_t unknown = factors->replaced[b];
    double *z = factors->z + (int64_t)b * factors->count;
    const double *own = matrix + (int64_t)unknown * factors->count;   // symmetric
    bool held = factors->row[unknown].normal < 0;
    memset(z, 0, (size_t)factors->count * sizeof(double));
    for (int32_t a = 0; held && a < factors->rows; a++) {
        int32_t k = factors->free[a];
        z[k] = -own[k] - factors->row[k].mu * own[factors->row[k].normal];
    }
    z[unknown] = held ? 1 : problem->matrix->diagonal;
    solve_kept(factors, z);
}

static void fill_row(ContactFactors *factors, const ContactProblem *problem, const double *matrix,
                     int32_t b)
{
    int64_t count = factors->count, unknown = factors->replaced[b];
    FactoredRow row = factors->now[unknown];
    double *v = factors->v + b * count;
    memset(v, 0, (size_t)count * sizeof(double));
    v[unknown] = problem->matrix->diagonal;
    if (row.normal < 0) return;
    memcpy(v, matrix + unknown * count, (size_t)count * sizeof(double));
    dense_add_scaled(row.mu, matrix + row.normal * count, factors->count, v);
    v[unknown] += row.beside;
}

static bool is_replaced(const ContactFactors *factors, int32_t unknown)
{
    for (int32_t b = 0; b < factors->replaced_count; b++)
        if (factors->replaced[b] == unknown) return true;
    return false;
}

// R, with what is another since. false: there is no room.
static bool list_replaced(ContactFactors *factors)
{
    for (int32_t k = 0; k < factors->count; k++) {
        FactoredRow now = factors->now[k], kept = factors->row[k];
        bool same = now.normal == kept.normal && now.mu == kept.mu && now.beside == kept.beside;
        if (same || is_replaced(factors, k)) continue;
        if (factors->replaced_count == room_of(factors->rows)) return false;
        factors->replaced[factors->replaced_count++] = k;
    }
    return true;
}

static bool same_are_open(const ContactFactors *factors, const ContactEquations *equations)
{
    const uint8_t *status = equations->at->status;
    for (int32_t i = 0; i < equations->problem->interface->contact_count; i++)
        if ((status[i] == CONTACT_OPEN) != (factors->status[i] == CONTACT_OPEN)) return false;
    return true;
}

bool contact_factors_update(ContactFactors *factors, const ContactEquations *equations,
                            const double *matrix)
{
    if (factors->rows == 0 || !same_are_open(factors, equations)) return false;
    find_rows(factors, equations, factors->now);
    int32_t count = factors->count, before = factors->replaced_count;
    if (!list_replaced(factors)) return false;
    int32_t length = factors->replaced_count;
    for (int32_t b = before; b < length; b++) leave_row(factors, equations->problem, matrix, b);
    for (int32_t b = 0; b < length; b++) fill_row(factors, equations->problem, matrix, b);
    dense_multiply_transposed(dense_view(factors->v, count, length),
                              dense_view(factors->z, count, length), 1, 0, factors->p);
    contact_copy_statuses(equations, factors->status);
    return dense_lu(factors->p, length, factors->p_pivots);
}

bool contact_factors_solve(ContactFactors *factors, const ContactEquations *equations, double *x)
{
    int32_t count = factors->count, length = factors->replaced_count;
    double *y = factors->y, *t = factors->t;
    if (length == 0) {
        dense_lu_solve(factors->lu, factors->rows, factors->pivots, x);
        return true;
    }
    memset(y, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < equations->free_count; a++) y[equations->free[a]] = x[a];
    for (int32_t b = 0; b < length; b++) {
        t[b] = y[factors->replaced[b]];
        y[factors->replaced[b]] = 0;
    }
    solve_kept(factors, y);
    double before = dense_max_abs(y, count);
    dense_apply_transposed(dense_view(factors->v, count, length), y, -1, 1, t);
    dense_lu_solve(factors->p, length, factors->p_pivots, t);
    dense_apply(dense_view(factors->z, count, length), t, 1, 1, y);
    if (!(before <= CANCELLED_LIMIT * dense_max_abs(y, count))) return false;
    for (int32_t a = 0; a < equations->free_count; a++) x[a] = y[equations->free[a]];
    return true;
}

// --- state --------------------------------------------------------------------------------------

void contact_factors_archive(ContactFactors *factors, Archive *archive)
{
    int32_t count = factors->count;
    archive_section(archive, "contact factors");
    archive_octets(archive, factors->status, count);
    archive_index(archive, &factors->rows, 0, count + 1);
    if (archive_reads(archive)) factors->replaced_count = 0;
    if (archive->failed || factors->rows == 0) return;
    int32_t rows = factors->rows;
    archive_numbers(archive, factors->lu, (int64_t)rows * rows);
    archive_indices(archive, factors->pivots, rows, 1, rows + 1);
    archive_indices(archive, factors->free, rows, 0, count);
    for (int32_t k = 0; k < count; k++) {
        archive_index(archive, &factors->row[k].normal, -1, count);
        archive_numbers_of(archive, &factors->row[k].mu, &factors->row[k].beside);
    }
    for (int32_t a = 0; !archive->failed && a < rows; a++)
        archive_require(archive, factors->row[factors->free[a]].normal >= 0);
    archive_index(archive, &factors->replaced_count, 0, room_of(rows) + 1);
    if (archive->failed) return;
    int32_t length = factors->replaced_count;
    archive_indices(archive, factors->replaced, length, 0, count);
    archive_numbers(archive, factors->z, (int64_t)count * length);
    archive_numbers(archive, factors->v, (int64_t)count * length);
    archive_numbers(archive, factors->p, (int64_t)length * length);
    archive_indices(archive, factors->p_pivots, length, 1, length + 1);
}
