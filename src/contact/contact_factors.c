// SPDX-License-Identifier: GPL-2.0-or-later
// Sizes: J0 of up to all interface unknowns, the border of up to a part of them. The derivation is
// in the header.
#include "contact/contact_factors.h"

#include "base/dense.h"
#include "base/memory.h"

#include <string.h>

// The border has at most this part of J0's rows.
static const double BORDER_PART = 0.2;
// Fewer rows are factored anew as fast.
enum { ROWS_LEAST = 64 };
// x may be this much smaller than J0^-1 b, of which it is what is left: ten digits of it stay.
static const double CANCELLED = 1e6;

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err)
{
    int64_t count = interface->count, room = 1 + (int64_t)(BORDER_PART * (double)count);
    *factors = (ContactFactors){.count = interface->count, .room = (int32_t)room};
    factors->lu = memory_bytes(8 * count * count, err);
    factors->pivots = NEW_ARRAY(int32_t, count, err);
    factors->unknown = NEW_ARRAY(int32_t, count, err);
    factors->normal = NEW_ARRAY(int32_t, count, err);
    factors->mu = NEW_ARRAY(double, count, err);
    factors->beside = NEW_ARRAY(double, count, err);
    factors->status = NEW_ARRAY(uint8_t, count, err);
    factors->border = NEW_ARRAY(int32_t, room, err);
    factors->z = memory_bytes(8 * count * room, err);
    factors->v = memory_bytes(8 * count * room, err);
    factors->p = memory_bytes(8 * room * room, err);
    factors->p_pivots = NEW_ARRAY(int32_t, room, err);
    factors->place = NEW_ARRAY(int32_t, count, err);
    factors->rank = NEW_ARRAY(int32_t, count, err);
    factors->now = NEW_ARRAY(int32_t, count, err);
    factors->diagonal = NEW_ARRAY(double, count, err);
    factors->inner = NEW_ARRAY(double, count, err);
    factors->outer = NEW_ARRAY(double, count, err);
    return error_is_clean(err);
}

void contact_factors_destroy(ContactFactors *factors)
{
    memory_free(factors->lu);
    memory_free(factors->pivots);
    memory_free(factors->unknown);
    memory_free(factors->normal);
    memory_free(factors->mu);
    memory_free(factors->beside);
    memory_free(factors->status);
    memory_free(factors->border);
    memory_free(factors->z);
    memory_free(factors->v);
    memory_free(factors->p);
    memory_free(factors->p_pivots);
    memory_free(factors->place);
    memory_free(factors->rank);
    memory_free(factors->now);
    memory_free(factors->diagonal);
    memory_free(factors->inner);
    memory_free(factors->outer);
    *factors = (ContactFactors){0};
}

// place[list[k]] = k, -1 elsewhere.
static void find_places(const int32_t *list, int32_t length, int32_t count, int32_t *place)
{
    for (int32_t k = 0; k < count; k++) place[k] = -1;
    for (int32_t k = 0; k < length; k++) place[list[k]] = k;
}

bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix)
{
    int32_t rows = equations->free_count;
    contact_jacobian(equations, matrix, rows, factors->lu);
    contact_diagonal(equations, factors->beside);
    for (int32_t a = 0; a < rows; a++) {
        factors->unknown[a] = equations->free[a];
        factors->normal[a] = equations->row[a].normal;
        factors->mu[a] = equations->row[a].mu;
    }
    contact_copy_statuses(equations, factors->status);
    find_places(equations->free, rows, factors->count, factors->place);
    find_places(NULL, 0, factors->count, factors->rank);
    factors->border_count = 0;
    factors->rows = dense_lu(factors->lu, rows, factors->pivots) ? rows : 0;
    return factors->rows == rows;
}

// --- border -------------------------------------------------------------------------------------

// Z's column of an unknown that is not yet in the border. false: there is no more room.
static bool add_border(ContactFactors *factors, const ContactProblem *problem, const double *matrix,
                       int32_t unknown)
{
    int32_t rows = factors->rows, place = factors->place[unknown], b = factors->border_count;
    if (b >= factors->room || b >= (int32_t)(BORDER_PART * rows)) return false;
    double *column = factors->z + (int64_t)b * rows;
    const double *own = matrix + (int64_t)unknown * factors->count;   // symmetric
    memset(column, 0, (size_t)rows * sizeof(double));
    if (place >= 0) column[place] = problem->matrix->diagonal;
    for (int32_t a = 0; place < 0 && a < rows; a++) {
        int32_t k = factors->unknown[a];
        column[a] = own[k] + factors->mu[a] * own[factors->normal[a]];
    }
    dense_lu_solve(factors->lu, rows, factors->pivots, column);
    factors->border[b] = unknown;
    factors->rank[unknown] = b;
    factors->border_count++;
    return true;
}

// Puts into the border what is new since J0, what is held since and every row that is another.
static bool find_border(ContactFactors *factors, const ContactEquations *equations,
                        const double *matrix)
{
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t unknown = equations->free[a], place = factors->place[unknown];
        bool same = place >= 0 && factors->mu[place] == equations->row[a].mu &&
                    factors->beside[place] == factors->diagonal[a];
        if (same || factors->rank[unknown] >= 0) continue;
        if (!add_border(factors, equations->problem, matrix, unknown)) return false;
    }
    for (int32_t k = 0; k < factors->rows; k++) {
        int32_t unknown = factors->unknown[k];
        if (factors->now[unknown] >= 0 || factors->rank[unknown] >= 0) continue;
        if (!add_border(factors, equations->problem, matrix, unknown)) return false;
    }
    return true;
}

// Row b of V and T: of its unknown as it is now, or that it is held.
static void fill_row(ContactFactors *factors, const ContactEquations *equations,
                     const double *matrix, int32_t b)
{
    int32_t unknown = factors->border[b], a = factors->now[unknown], rows = factors->rows;
    int32_t place = factors->place[unknown], borders = factors->border_count;
    double *v = factors->v + (int64_t)b * rows, *t = factors->p + b;
    double itself = equations->problem->matrix->diagonal;
    if (a < 0) {
        memset(v, 0, (size_t)rows * sizeof(double));
        for (int32_t c = 0; c < borders; c++) t[(int64_t)c * borders] = 0;
    } else {
        ContactRow row = equations->row[a];
        const double *own = matrix + (int64_t)unknown * factors->count;
        const double *normal = matrix + (int64_t)row.normal * factors->count;
        for (int32_t k = 0; k < rows; k++)
            v[k] = own[factors->unknown[k]] + row.mu * normal[factors->unknown[k]];
        for (int32_t c = 0; c < borders; c++) {
            int32_t k = factors->border[c];
            bool came_in = factors->place[k] < 0;
            t[(int64_t)c * borders] = came_in ? own[k] + row.mu * normal[k] : 0;
        }
        itself = factors->diagonal[a];
    }
    *(place >= 0 ? &v[place] : &t[(int64_t)b * borders]) += itself;
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
    int32_t rows = factors->rows;
    if (rows < ROWS_LEAST || !same_are_open(factors, equations)) return false;
    contact_diagonal(equations, factors->diagonal);
    find_places(equations->free, equations->free_count, factors->count, factors->now);
    if (!find_border(factors, equations, matrix)) return false;
    int32_t borders = factors->border_count;
    for (int32_t b = 0; b < borders; b++) fill_row(factors, equations, matrix, b);
    dense_multiply_transposed(dense_view(factors->v, rows, borders),
                              dense_view(factors->z, rows, borders), -1, 1, factors->p);
    contact_copy_statuses(equations, factors->status);
    return dense_lu(factors->p, borders, factors->p_pivots);
}

bool contact_factors_solve(ContactFactors *factors, const ContactEquations *equations, double *x)
{
    int32_t rows = factors->rows, borders = factors->border_count;
    int32_t free_count = equations->free_count;
    if (borders == 0) {
        dense_lu_solve(factors->lu, rows, factors->pivots, x);
        return true;
    }
    double *inner = factors->inner, *outer = factors->outer;
    memset(inner, 0, (size_t)rows * sizeof(double));
    memset(outer, 0, (size_t)borders * sizeof(double));
    for (int32_t a = 0; a < free_count; a++) {
        int32_t unknown = equations->free[a], rank = factors->rank[unknown];
        *(rank >= 0 ? &outer[rank] : &inner[factors->place[unknown]]) = x[a];
    }
    DenseView v = dense_view(factors->v, rows, borders), z = dense_view(factors->z, rows, borders);
    dense_lu_solve(factors->lu, rows, factors->pivots, inner);
    double before = dense_max_abs(inner, rows);
    dense_apply_transposed(v, inner, -1, 1, outer);
    dense_lu_solve(factors->p, borders, factors->p_pivots, outer);
    dense_apply(z, outer, -1, 1, inner);
    if (!(before <= CANCELLED * dense_max_abs(inner, rows))) return false;
    for (int32_t a = 0; a < free_count; a++) {
        int32_t unknown = equations->free[a], place = factors->place[unknown];
        x[a] = place >= 0 ? inner[place] : outer[factors->rank[unknown]];
    }
    return true;
}

// --- state --------------------------------------------------------------------------------------

void contact_factors_archive(ContactFactors *factors, Archive *archive)
{
    archive_section(archive, "contact factors");
    archive_octets(archive, factors->status, factors->count);
    archive_index(archive, &factors->rows, 0, factors->count + 1);
    if (archive_reads(archive)) factors->border_count = 0;
    if (archive->failed || factors->rows == 0) return;
    int32_t rows = factors->rows;
    archive_numbers(archive, factors->lu, (int64_t)rows * rows);
    archive_indices(archive, factors->pivots, rows, 1, rows + 1);
    archive_indices(archive, factors->unknown, rows, 0, factors->count);
    archive_indices(archive, factors->normal, rows, 0, factors->count);
    archive_numbers(archive, factors->mu, rows);
    archive_numbers(archive, factors->beside, rows);
    archive_index(archive, &factors->border_count, 0, factors->room + 1);
    if (archive->failed) return;
    int32_t borders = factors->border_count;
    archive_indices(archive, factors->border, borders, 0, factors->count);
    archive_numbers(archive, factors->z, (int64_t)rows * borders);
    archive_numbers(archive, factors->v, (int64_t)rows * borders);
    archive_numbers(archive, factors->p, (int64_t)borders * borders);
    archive_indices(archive, factors->p_pivots, borders, 1, borders + 1);
    if (!archive_reads(archive) || archive->failed) return;
    find_places(factors->unknown, rows, factors->count, factors->place);
    find_places(factors->border, borders, factors->count, factors->rank);
}
