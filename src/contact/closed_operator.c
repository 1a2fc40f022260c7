// SPDX-License-Identifier: GPL-2.0-or-later
// Rounding of sweeps adds up, to and fro as well, and S itself is at hand: a copy is renewed when
// it was swept so often that renewing costs less than it has cost already.
#include "contact/closed_operator.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// Of both unknowns of every node: sweeps after which a copy is made anew.
static const int32_t SWEEPS_EACH = 8;
// Part of its diagonal entry that is left of an unknown when the others of O are held, at least: a
// body that floats has 0, up to rounding; one that a step's mass holds has far more.
static const double SINGULAR = 1e-8;
// Of all copies, which take memory as they come into use: every rung of a ladder is asked for in
// turn where growth is looked for (stepping/step_control), and should then be here still.
static const double BYTES_MAX = 1e9;

bool closed_operator_create(const Interface *interface, ClosedOperator *closed, Error *err)
{
    int64_t count = interface->count;
    *closed =
        (ClosedOperator){.count = interface->count, .contact_count = interface->contact_count};
    closed->work = NEW_ARRAY(double, count, err);
    double each = 8.0 * (double)count * (double)count;
    int32_t fitting = each > 0 ? (int32_t)fmin(BYTES_MAX / each, CLOSED_OPERATORS_MAX) : 0;
    closed->kept_count = fitting > CLOSED_OPERATORS_MIN ? fitting : CLOSED_OPERATORS_MIN;
    for (int32_t k = 0; k < closed->kept_count; k++) {
        closed->kept[k].matrix = memory_bytes(8 * count * count, err);
        closed->kept[k].out = NEW_ARRAY(uint8_t, interface->contact_count, err);
    }
    return error_is_clean(err);
}

void closed_operator_destroy(ClosedOperator *closed)
{
    for (int32_t k = 0; k < closed->kept_count; k++) {
        memory_free(closed->kept[k].matrix);
        memory_free(closed->kept[k].out);
    }
    memory_free(closed->work);
    *closed = (ClosedOperator){0};
}

static void copy_operator(const ClosedOperator *closed, const double *schur, SweptOperator *swept)
{
    size_t count = (size_t)closed->count;
    swept->schur = schur;
    swept->sweeps = 0;
    memcpy(swept->matrix, schur, count * count * sizeof(double));
    memset(swept->out, 0, (size_t)closed->contact_count);
}

// The copy of `schur`, or the one that was not used for longest.
static SweptOperator *find_copy(ClosedOperator *closed, const double *schur)
{
    SweptOperator *oldest = closed->kept;
    for (int32_t k = 0; k < closed->kept_count; k++) {
        if (closed->kept[k].schur == schur) return &closed->kept[k];
        if (closed->kept[k].used < oldest->used) oldest = &closed->kept[k];
    }
    copy_operator(closed, schur, oldest);
    return oldest;
}

// A pivot below its part of S's own entry would leave, swept back, only the digits that it has more
// than rounding: false, and the copy is of no more use.
static bool sweep_unknown(ClosedOperator *closed, SweptOperator *swept, int32_t k, bool back)
{
    int64_t entry = (int64_t)k * (closed->count + 1);
    double pivot = swept->matrix[entry];
    if (back ? !(pivot < 0) : !(pivot > SINGULAR * swept->schur[entry])) return false;
    return dense_sweep(swept->matrix, closed->count, k, back, closed->work);
}

// Both unknowns of node i.
static bool sweep_node(ClosedOperator *closed, SweptOperator *swept, int32_t i)
{
    bool back = swept->out[i];
    if (!sweep_unknown(closed, swept, interface_tangent(i), back) ||
        !sweep_unknown(closed, swept, interface_normal(i), back))
        return false;
    swept->out[i] = !back;
    swept->sweeps += 2;
    closed->sweeps += 2;
    return true;
}

const double *closed_operator_of(ClosedOperator *closed, const double *schur, const uint8_t *status)
{
    if (!memchr(status, CONTACT_OPEN, (size_t)closed->contact_count)) return schur;
    SweptOperator *swept = find_copy(closed, schur);
    swept->used = ++closed->clock;
    if (swept->sweeps > 2 * SWEEPS_EACH * closed->contact_count)
        copy_operator(closed, schur, swept);
    for (int32_t i = 0; i < closed->contact_count; i++) {
        bool open = status[i] == CONTACT_OPEN;
        if (open == swept->out[i] || sweep_node(closed, swept, i)) continue;
        swept->schur = NULL;
        return NULL;
    }
    return swept->matrix;
}
