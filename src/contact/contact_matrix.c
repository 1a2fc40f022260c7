// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep of a symmetric matrix on its k-th diagonal entry d, or back: s_kk := -1/d, s_ik := s_ik/d
// (back: -s_ik/d), the rest less s_ik s_kj/d. Swept on O, what is left of S is -S_OO^-1 on O,
// S_OO^-1 S_O. in its rows, and S' elsewhere (Goodnight, The American Statistician 33, 1979).
//
// Rounding of sweeps adds up. So the copy is made anew from S when it was swept so often that this
// costs less than the sweeps so far.
#include "contact/contact_matrix.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact/contact_status.h"
#include "contact/interface.h"

#include <float.h>
#include <math.h>
#include <string.h>

// Sweeps for each unknown before the copy is renewed.
enum { SWEEPS_LIMIT = 9 };
// Unknowns that are swept together, at most: S' then comes from memory once for all of them. Both
// of a node always are.
enum { PAIR = 2, TOGETHER = 16 };

bool contact_matrix_create(const double *schur, int32_t count, ContactMatrix *matrix, Error *err)
{
    int64_t bytes = 8 * (int64_t)count * count;
    *matrix = (ContactMatrix){.schur = schur, .count = count, .swept = -1};
    matrix->own = NEW_ARRAY(double, count, err);
    matrix->closed = memory_bytes(bytes, err);
    matrix->out = NEW_ARRAY(uint8_t, count, err);
    matrix->work = NEW_ARRAY(double, 3 * TOGETHER * (int64_t)count, err);
    matrix->order = NEW_ARRAY(int32_t, SWEEPS_LIMIT * (int64_t)count, err);
    if (!error_is_clean(err)) return false;
    for (int64_t k = 0; k < count; k++) {
        matrix->own[k] = schur[k * (count + 1)];
        matrix->diagonal = fmax(matrix->diagonal, matrix->own[k]);
    }
    return true;
}

void contact_matrix_destroy(ContactMatrix *matrix)
{
    memory_free_all(matrix->own, matrix->closed, matrix->out, matrix->work, matrix->order);
    *matrix = (ContactMatrix){0};
}

static void renew_copy(ContactMatrix *matrix)
{
    size_t count = (size_t)matrix->count;
    matrix->swept = 0;
    memcpy(matrix->closed, matrix->schur, count * count * sizeof(double));
    memset(matrix->out, 0, count);
}

// Distinct unknowns. Their columns, `now`, follow each sweep; what each takes from the rest, was
// was'/pivot, is taken for all at once. false: the copy is of no more use.
static bool sweep_unknowns(ContactMatrix *matrix, const int32_t *list, int32_t length)
{
    int64_t n = matrix->count;
    double *now = matrix->work, *was = now + TOGETHER * n, *over = was + TOGETHER * n;
    for (int32_t t = 0; t < length; t++)
        memcpy(now + t * n, matrix->closed + list[t] * n, (size_t)n * sizeof(double));
    for (int32_t t = 0; t < length; t++) {
        int32_t k = list[t];
        double *own = now + t * n, *column = was + t * n, pivot = own[k];
        double sign = matrix->out[k] ? -1 : 1;

        // A pivot is what is left of S's own entry when the others of O are held: 0, up to
        // rounding, of a body that nothing holds, far more than half of the digits of one that a
        // step's mass holds.
        double least = sqrt(DBL_EPSILON) * matrix->own[k];
        if (!(matrix->out[k] ? pivot < 0 : pivot > least)) return false;

        memcpy(column, own, (size_t)n * sizeof(double));
        for (int64_t i = 0; i < n; i++) over[i * length + t] = column[i] / pivot;
        for (int32_t s = 0; s < length; s++) {
            double factor = column[list[s]] / pivot;
            if (s != t) dense_add_scaled(-factor, column, matrix->count, now + s * n);
            now[s * n + k] = sign * factor;
        }
        for (int64_t i = 0; i < n; i++) own[i] = sign * column[i] / pivot;
        own[k] = -1 / pivot;
        matrix->out[k] = !matrix->out[k];
        matrix->order[matrix->swept++] = t == 0 ? ~k : k;
        matrix->sweeps++;
    }
    dense_multiply(dense_view(was, n, length), dense_view(over, length, n), -1, 1, matrix->closed);
    for (int32_t t = 0; t < length; t++) {
        memcpy(matrix->closed + list[t] * n, now + t * n, (size_t)n * sizeof(double));
        for (int64_t i = 0; i < n; i++) matrix->closed[i * n + list[t]] = now[t * n + i];
    }
    return true;
}

const double *contact_matrix_close(ContactMatrix *matrix, const uint8_t *status,
                                   int32_t contact_count, int32_t dim)
{
    if (!memchr(status, CONTACT_OPEN, (size_t)contact_count)) return matrix->schur;
    int32_t unknowns = dim * contact_count, room = SWEEPS_LIMIT * matrix->count - matrix->swept;
    if (matrix->swept < 0 || room < unknowns) renew_copy(matrix);
    int32_t list[TOGETHER], length = 0;
    bool holds = true;
    for (int32_t k = 0; k < unknowns && holds; k++) {
        if ((status[dof_node(dim, k)] == CONTACT_OPEN) != matrix->out[k]) list[length++] = k;
        if (length < TOGETHER && k + 1 < unknowns) continue;
        holds = length == 0 || sweep_unknowns(matrix, list, length);
        length = 0;
    }
    if (!holds) matrix->swept = -1;
    return holds ? matrix->closed : NULL;
}

void contact_matrix_archive(ContactMatrix *matrix, int64_t last, Archive *archive)
{
    int32_t swept = matrix->swept;
    int64_t sweeps = matrix->sweeps, factored = matrix->factored == last ? last : 0;
    archive_section(archive, "contact matrix");
    archive_index(archive, &swept, -1, SWEEPS_LIMIT * matrix->count + 1);
    if (archive->failed) return;
    if (swept > 0) archive_indices(archive, matrix->order, swept, -matrix->count, matrix->count);
    archive_counts_of(archive, &sweeps, &factored);
    if (!archive_reads(archive)) return;
    matrix->factored = factored;
    matrix->swept = -1;
    // The same sweeps of the same S in the same order: the copy to the last bit, in far less room.
    if (swept >= 0) renew_copy(matrix);
    while (matrix->swept < swept && !archive->failed) {
        int32_t list[TOGETHER], length = 0, k = matrix->swept;
        do {
            int32_t unknown = matrix->order[k++];
            list[length++] = unknown < 0 ? ~unknown : unknown;
        } while (k < swept && matrix->order[k] >= 0 && length < TOGETHER);
        if (!sweep_unknowns(matrix, list, length)) archive->failed = true;
    }
    matrix->sweeps = sweeps;
}
