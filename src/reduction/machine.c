// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/machine.h"

#include "base/memory.h"

#include <math.h>

// With damping alone kappa is 0, and S' of all rod nodes is singular: a rod that no node touches
// may move as it likes. It gets this part of what the block sets against it, far above rounding and
// far below what tells a certified state from another.
static const double LOOSE = 1e-6;

// So it is in a step so short that beside the block the spring is rounding. There the rod gets at
// least this part, as if it had so much of the mass of its nodes. (A block 1e6 times as stiff as
// the machine is a rigid one, and 1e-6 would be seen.)
static const double LOOSE_LIMIT = 1e-10;

bool machine_soften(const Machine *machine, double reach, int32_t count, double *schur,
                    MachineColumn *column, Error *err)
{
    int32_t first = machine->first;
    *column = (MachineColumn){.first = first, .count = count};
    column->column = NEW_ARRAY(double, count, err);
    if (!column->column) return false;
    double *s = column->column, resistance = 0;
    for (int64_t b = first; b < count; b++)
        for (int32_t a = 0; a < count; a++) s[a] += schur[b * count + a];
    for (int32_t b = first; b < count; b++) resistance += s[b];
    double kappa = fmax(reach * machine->stiffness, (reach > 0 ? LOOSE_LIMIT : LOOSE) * resistance);
    column->pivot = kappa + resistance;
    double factor = 1 / column->pivot;
    for (int64_t b = 0; b < count; b++)   // symmetric to the bit
        for (int32_t a = 0; a < count; a++) schur[b * count + a] -= s[a] * s[b] * factor;
    return true;
}

void machine_column_destroy(MachineColumn *column)
{
    memory_free(column->column);
    *column = (MachineColumn){0};
}

void machine_refer(MachineColumn *column, double *g)
{
    column->given = column->force;
    for (int32_t a = column->first; a < column->count; a++) column->given += g[a];
    double factor = column->given / column->pivot;
    for (int32_t a = 0; a < column->count; a++) g[a] -= factor * column->column[a];
}

double machine_release(const MachineColumn *column, double *velocity)
{
    double left = column->given;
    for (int32_t a = 0; a < column->count; a++) left -= column->column[a] * velocity[a];
    double own = left / column->pivot;
    for (int32_t a = column->first; a < column->count; a++) velocity[a] += own;
    return own;
}
