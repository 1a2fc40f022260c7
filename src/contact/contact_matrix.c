// SPDX-License-Identifier: GPL-2.0-or-later
// Rounding of sweeps adds up. So the copy is made anew from S when it was swept so often that this
// costs less than the sweeps so far.
#include "contact/contact_matrix.h"

#include "base/dense.h"
#include "base/memory.h"
#include "contact/contact_status.h"
#include "contact/interface.h"

#include <math.h>
#include <string.h>

// Of both unknowns of every node: sweeps after which the copy is made anew.
static const int32_t SWEEPS_EACH = 8;
// Of an unknown, at most, before the copy is renewed: those, and one of each after the last look.
enum { SWEEPS_KEPT = 9 };
// Part of its diagonal entry that is left of an unknown when the others of O are held, at least: a
// body that nothing holds has 0, up to rounding; one that a step's mass holds has far more.
static const double SINGULAR = 1e-8;

bool contact_matrix_create(const double *schur, int32_t count, ContactMatrix *matrix, Error *err)
{
    int64_t bytes = 8 * (int64_t)count * count;
    *matrix = (ContactMatrix){.schur = schur, .count = count, .swept = -1};
    for (int64_t k = 0; k < count; k++)
        matrix->diagonal = fmax(matrix->diagonal, schur[k * count + k]);
    matrix->closed = memory_bytes(bytes, err);
    matrix->out = NEW_ARRAY(uint8_t, count, err);
    matrix->work = NEW_ARRAY(double, count, err);
    matrix->order = NEW_ARRAY(int32_t, SWEEPS_KEPT * (int64_t)count, err);
    return error_is_clean(err);
}

void contact_matrix_destroy(ContactMatrix *matrix)
{
    memory_free(matrix->closed);
    memory_free(matrix->out);
    memory_free(matrix->work);
    memory_free(matrix->order);
    *matrix = (ContactMatrix){0};
}

static void renew_copy(ContactMatrix *matrix)
{
    size_t count = (size_t)matrix->count;
    matrix->swept = 0;
    memcpy(matrix->closed, matrix->schur, count * count * sizeof(double));
    memset(matrix->out, 0, count);
}

// A pivot below its part of S's own entry would leave, swept back, only the digits that it has more
// than rounding: false, and the copy is of no more use.
static bool sweep_unknown(ContactMatrix *matrix, int32_t k)
{
    int64_t entry = (int64_t)k * (matrix->count + 1);
    double pivot = matrix->closed[entry];
    bool back = matrix->out[k];
    if (back ? !(pivot < 0) : !(pivot > SINGULAR * matrix->schur[entry])) return false;
    if (!dense_sweep(matrix->closed, matrix->count, k, back, matrix->work)) return false;
    matrix->out[k] = !back;
    matrix->order[matrix->swept++] = k;
    matrix->sweeps++;
    return true;
}

const double *contact_matrix_close(ContactMatrix *matrix, const uint8_t *status,
                                   int32_t contact_count)
{
    if (!memchr(status, CONTACT_OPEN, (size_t)contact_count)) return matrix->schur;
    if (matrix->swept < 0 || matrix->swept > 2 * SWEEPS_EACH * contact_count) renew_copy(matrix);
    for (int32_t i = 0; i < contact_count; i++) {
        int32_t unknowns[] = {interface_tangent(i), interface_normal(i)};
        for (int32_t a = 0; a < 2; a++) {
            bool open = status[i] == CONTACT_OPEN;
            if (open == matrix->out[unknowns[a]] || sweep_unknown(matrix, unknowns[a])) continue;
            matrix->swept = -1;
            return NULL;
        }
    }
    return matrix->closed;
}

// The same sweeps of the same S in the same order: the copy to the last bit, in far less room.
static void repeat_sweeps(ContactMatrix *matrix, int32_t swept, Archive *archive)
{
    renew_copy(matrix);
    for (int32_t k = 0; k < swept && !archive->failed; k++) {
        if (!sweep_unknown(matrix, matrix->order[k])) archive->failed = true;
    }
}

void contact_matrix_archive(ContactMatrix *matrix, int64_t last, Archive *archive)
{
    int32_t swept = matrix->swept;
    int64_t sweeps = matrix->sweeps, factored = matrix->factored == last ? last : 0;
    archive_section(archive, "contact matrix");
    archive_index(archive, &swept, -1, SWEEPS_KEPT * matrix->count + 1);
    if (archive->failed) return;
    if (swept > 0) archive_indices(archive, matrix->order, swept, 0, matrix->count);
    archive_count(archive, &sweeps);
    archive_count(archive, &factored);
    if (!archive_reads(archive)) return;
    matrix->factored = factored;
    matrix->swept = -1;
    if (swept >= 0) repeat_sweeps(matrix, swept, archive);
    matrix->sweeps = sweeps;
}
