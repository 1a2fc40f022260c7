// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/patch_modes.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// Part of the largest energy of some fields: a field with less is looked at again when the others
// are taken out, or half of its digits would be lost.
static const double DIGITS = 1e-8;

// Part of the squares of some fields: where less is left, they are taken out once more.
static const double LITTLE = 1e-4;

void patch_modes_destroy(PatchModes *modes)
{
    memory_free(modes->dofs);
    sparse_pattern_destroy(&modes->pattern);
    memory_free_all(modes->stiffness, modes->field, modes->image);
    *modes = (PatchModes){0};
}

bool far_room_create(int64_t size, int64_t columns, FarRoom *room, Error *err)
{
    *room = (FarRoom){.rows = NEW_ARRAY(double, size *columns, err),
                      .next = NEW_ARRAY(double, size *columns, err),
                      .parts = NEW_ARRAY(double, (size + columns) * columns, err),
                      .energies = NEW_ARRAY(double, columns *columns, err),
                      .values = NEW_ARRAY(double, columns, err),
                      .eigen = NEW_ARRAY(double, DENSE_EIGEN_WORK(columns), err)};
    return error_is_clean(err);
}

void far_room_destroy(FarRoom *room)
{
    memory_free_all(room->rows, room->next, room->parts, room->values, room->energies, room->eigen);
    *room = (FarRoom){0};
}

// Not zeroed: what is not written to stays without memory behind it.
static bool lengthen(double **columns, int64_t filled, int64_t needed, Error *err)
{
    double *longer = memory_bytes(needed * (int64_t)sizeof *longer, err);
    if (!longer) return false;
    if (filled > 0) memcpy(longer, *columns, (size_t)filled * sizeof *longer);
    memory_free(*columns);
    *columns = longer;
    return true;
}

bool patch_modes_make_room(PatchModes *modes, int32_t columns, Error *err)
{
    int64_t size = modes->size, filled = size * modes->count;
    int64_t room = modes->room, needed = modes->count + columns;
    if (needed <= room) return true;
    if (needed < 2 * room) needed = 2 * room;
    if (!lengthen(&modes->field, filled, size * needed, err) ||
        !lengthen(&modes->image, filled, size * needed, err))
        return false;
    modes->room = (int32_t)needed;
    return true;
}

static double square_sum(const double *values, int64_t count)
{
    double sum = 0;
    for (int64_t k = 0; k < count; k++) sum += values[k] * values[k];
    return sum;
}

bool patch_modes_add(PatchModes *modes, DenseView fields, double least, FarRoom *room,
                     int32_t *added)
{
    int64_t size = modes->size, c = fields.columns;
    DenseView rows = dense_view(room->rows, size, c), image = dense_view(room->next, size, c);
    double *energies = room->energies, *values = room->values;
    bool again = true;
    *added = 0;
    for (int64_t j = 0; j < c; j++)
        for (int64_t i = 0; i < size; i++)
            room->rows[j * size + i] = fields.values[j * fields.rows + modes->dofs[i]];
    while (again && *added < c) {
        // Fields less what F has of them, and their image. Twice where little is left: what
        // rounding put back is large beside it.
        int64_t count = modes->count, end = size * count, first = c, most = c - *added;
        for (bool once_more = count > 0; once_more;) {
            double before = square_sum(room->rows, size * c);
            dense_multiply_transposed(dense_view(modes->image, size, count), rows, 1, 0,
                                      room->parts);
            dense_multiply(dense_view(modes->field, size, count), dense_view(room->parts, count, c),
                           -1, 1, room->rows);
            double after = square_sum(room->rows, size * c);
            once_more = after > 0 && after < LITTLE * before;
        }
        sparse_apply_many(&modes->pattern, modes->stiffness, room->rows, c, room->next);

        // New columns of F and its image: those of the rows times eigenvectors of their energies.
        dense_multiply_transposed(rows, image, 1, 0, energies);
        if (!dense_eigen(energies, (int32_t)c, values, room->eigen)) return false;
        double enough = fmax(least, DIGITS * values[c - 1]);
        while (first > c - most && values[first - 1] > enough) first--;
        again = first > 0 && values[first - 1] > least;   // with few digits as yet
        for (int64_t j = first; j < c; j++)
            for (int64_t i = 0; i < c; i++) energies[j * c + i] /= sqrt(values[j]);
        DenseView kept = dense_view(energies + first * c, c, c - first);
        if (first < c) {
            dense_multiply(rows, kept, 1, 0, modes->field + end);
            dense_multiply(image, kept, 1, 0, modes->image + end);
        }
        modes->count += (int32_t)(c - first);
        *added += (int32_t)(c - first);
    }
    return true;
}
