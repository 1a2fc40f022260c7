// SPDX-License-Identifier: GPL-2.0-or-later
// Rounding of sweeps adds up. So the copy is made anew from S when it was swept so often that this
// costs less than the sweeps so far.
#include "contact/contact_matrix.h"

#include "base/dense.h"
#include "base/memory.h"
#include "contact/contact_status.h"
#include "contact/interface.h"

#include <string.h>

// Of both unknowns of every node: sweeps after which the copy is made anew.
static const int32_t SWEEPS_EACH = 8;
// Part of its diagonal entry that is left of an unknown when the others of O are held, at least: a
// body that nothing holds has 0, up to rounding; one that a step's mass holds has far more.
static const double SINGULAR = 1e-8;

bool contact_matrix_create(const double *schur, int32_t count, ContactMatrix *matrix, Error *err)
{
    int64_t bytes = 8 * (int64_t)count * count;
    *matrix = (ContactMatrix){.schur = schur, .count = count, .swept = -1};
    matrix->closed = memory_bytes(bytes, err);
    matrix->out = NEW_ARRAY(uint8_t, count, err);
    matrix->work = NEW_ARRAY(double, count, err);
    matrix->factors = memory_bytes(bytes, err);
    matrix->pivots = NEW_ARRAY(int32_t, count, err);
    matrix->status = NEW_ARRAY(uint8_t, count, err);
    return error_is_clean(err);
}

void contact_matrix_destroy(ContactMatrix *matrix)
{
    memory_free(matrix->closed);
    memory_free(matrix->out);
    memory_free(matrix->work);
    memory_free(matrix->factors);
    memory_free(matrix->pivots);
    memory_free(matrix->status);
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
    matrix->swept++;
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
