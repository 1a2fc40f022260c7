// SPDX-License-Identifier: GPL-2.0-or-later
// One pass over the matrices a step. Blocks of a node's unknowns by another's, K and C side by
// side, upper triangle only: block (i, j), j >= i, holds in the plane
//
//     K_xx K_zx | K_xz K_zz | C_xx C_zx | C_xz C_zz      (rows i, columns j)
//
// and in space likewise three columns of K and three of C, each with a 0 behind it: vectors of a
// node have room for two or four numbers, which a processor takes at once. A block
// serves rows i and, transposed, rows j. Measured per step against full rows: the same at 20x20
// and 40x40, where both fit the cache, 0.7 of the time at 80x80. Node i's row is complete when the
// pass reaches it, for it has met all j < i: its velocity and displacement are advanced there.
#include "stepping/explicit_sweep.h"

#include "base/memory.h"

#include <string.h>

// x and z of one node.
typedef double Pair __attribute__((vector_size(16)));

static int64_t block_size(const ExplicitSweep *sweep)
{
    return 2 * sweep->bulk->dim * explicit_room(sweep);
}

bool explicit_sweep_create(const Bulk *bulk, double step, ExplicitSweep *sweep, Error *err)
{
    const SparsePattern *pattern = &bulk->pattern;
    int32_t dim = bulk->dim, nodes = dof_node(dim, bulk->dof_count), blocks = 0;
    for (int32_t row = 0; row < pattern->size; row += dim)
        for (int32_t k = pattern->start[row]; k < pattern->start[row + 1]; k += dim)
            blocks += pattern->index[k] >= row;

    *sweep = (ExplicitSweep){.bulk = bulk, .step = step, .node_count = nodes};
    int64_t size = explicit_field_size(sweep);
    sweep->start = NEW_ARRAY(int32_t, (int64_t)nodes + 1, err);
    sweep->column = NEW_ARRAY(int32_t, blocks, err);
    sweep->blocks = NEW_ARRAY(double, block_size(sweep) * blocks, err);
    sweep->kick = NEW_ARRAY(double, nodes, err);
    sweep->now = NEW_ARRAY(double, size, err);
    sweep->next = NEW_ARRAY(double, size, err);
    sweep->force = NEW_ARRAY(double, size, err);
    if (bulk->spectrum.count > 0) sweep->pull = NEW_ARRAY(double, bulk->dof_count, err);
    if (!error_is_clean(err)) return false;

    // Blocks of K and C, row by row.
    int32_t filled = 0, room = explicit_room(sweep);
    for (int32_t i = 0; i < nodes; i++) {
        const int32_t *row = pattern->start + node_dof(dim, i, 0);
        for (int32_t k = 0; k < row[1] - row[0]; k += dim) {
            int32_t j = dof_node(dim, pattern->index[row[0] + k]);
            if (j < i) continue;
            double *block = sweep->blocks + block_size(sweep) * filled;
            for (int32_t d = 0; d < dim; d++)
                for (int32_t e = 0; e < dim; e++) {
                    block[room * d + e] = bulk->stiffness[row[e] + k + d];
                    block[room * (dim + d) + e] = bulk->damping[row[e] + k + d];
                }
            sweep->column[filled++] = j;
        }
        sweep->start[i + 1] = filled;
        sweep->kick[i] = step / bulk->mass[node_dof(dim, i, 0)];
    }
    return true;
}

void explicit_sweep_destroy(ExplicitSweep *sweep)
{
    memory_free_all(sweep->start, sweep->column, sweep->blocks, sweep->kick, sweep->now,
                    sweep->next, sweep->force, sweep->pull);
    *sweep = (ExplicitSweep){0};
}

// Begins the sums in the place of K u with the forces that neither K nor C makes.
static void begin_forces(ExplicitSweep *sweep)
{
    int32_t dim = sweep->bulk->dim;
    memset(sweep->force, 0, (size_t)explicit_field_size(sweep) * sizeof(double));
    for (int32_t i = 0; sweep->pull && i < sweep->node_count; i++)
        for (int32_t d = 0; d < dim; d++)
            sweep->force[explicit_place(sweep, i) + d] = sweep->pull[node_dof(dim, i, d)];
}

// The sweep of a block in the plane.
static double sweep_plane(ExplicitSweep *sweep, double factor)
{
    const Pair *restrict blocks = (const Pair *)sweep->blocks;
    const Pair *restrict load = (const Pair *)sweep->bulk->load;
    const Pair *restrict now = (const Pair *)sweep->now;
    Pair *restrict next = (Pair *)sweep->next;
    Pair *restrict force = (Pair *)sweep->force;
    const int32_t *restrict start = sweep->start, *restrict column = sweep->column;
    double step = sweep->step;
    Pair power = {0, 0};
    begin_forces(sweep);
    for (int32_t i = 0; i < sweep->node_count; i++) {
        Pair u = now[2 * i], v = now[2 * i + 1];
        const Pair *diagonal = blocks + 4 * (int64_t)start[i];
        Pair elastic = force[2 * i] + diagonal[0] * u[0] + diagonal[1] * u[1];
        Pair viscous = force[2 * i + 1] + diagonal[2] * v[0] + diagonal[3] * v[1];
        for (int32_t b = start[i] + 1; b < start[i + 1]; b++) {
            const Pair *block = blocks + 4 * (int64_t)b;
            Pair kx = block[0], kz = block[1], cx = block[2], cz = block[3];
            int32_t j = column[b];
            Pair uj = now[2 * j], vj = now[2 * j + 1];
            elastic += kx * uj[0] + kz * uj[1];
            viscous += cx * vj[0] + cz * vj[1];
            force[2 * j] += __builtin_shufflevector(kx, kz, 0, 2) * u[0] +
                            __builtin_shufflevector(kx, kz, 1, 3) * u[1];
            force[2 * j + 1] += __builtin_shufflevector(cx, cz, 0, 2) * v[0] +
                                __builtin_shufflevector(cx, cz, 1, 3) * v[1];
        }
        power += v * viscous;
        Pair faster = v + sweep->kick[i] * (factor * load[i] - elastic - viscous);
        next[2 * i] = u + step * faster;
        next[2 * i + 1] = faster;
    }
    return power[0] + power[1];
}

// sum += B' x of a block B by its columns.
WITH_CONSTANTS void add_transposed(const Lane *column, const double *x, Lane *sum)
{
    Lane low = __builtin_shufflevector(column[0], column[1], 0, 4, 2, 6);   // 00 01 20 21
    Lane high = __builtin_shufflevector(column[0], column[1], 1, 5, 3, 7);   // 10 11 30 31
    Lane row_0 = __builtin_shufflevector(low, column[2], 0, 1, 4, 7);
    Lane row_1 = __builtin_shufflevector(high, column[2], 0, 1, 5, 7);
    Lane row_2 = __builtin_shufflevector(low, column[2], 2, 3, 6, 7);
    *sum += row_0 * x[0] + row_1 * x[1] + row_2 * x[2];
}

// The same in space.
FOR_EACH_PROCESSOR static double sweep_space(ExplicitSweep *sweep, double factor)
{
    const Lane *restrict blocks = (const Lane *)sweep->blocks;
    const double *restrict load = sweep->bulk->load;
    const Lane *restrict now = (const Lane *)sweep->now;
    Lane *restrict next = (Lane *)sweep->next;
    Lane *restrict force = (Lane *)sweep->force;
    const int32_t *restrict start = sweep->start, *restrict column = sweep->column;
    double step = sweep->step;
    Lane power = {0};
    begin_forces(sweep);
    for (int32_t i = 0; i < sweep->node_count; i++) {
        Lane u = now[2 * i], v = now[2 * i + 1];
        const Lane *own = blocks + 6 * (int64_t)start[i];
        Lane elastic = force[2 * i] + own[0] * u[0] + own[1] * u[1] + own[2] * u[2];
        Lane viscous = force[2 * i + 1] + own[3] * v[0] + own[4] * v[1] + own[5] * v[2];
        for (int32_t b = start[i] + 1; b < start[i + 1]; b++) {
            const Lane *k = blocks + 6 * (int64_t)b, *c = k + 3;
            int32_t j = column[b];
            Lane uj = now[2 * j], vj = now[2 * j + 1];
            elastic += k[0] * uj[0] + k[1] * uj[1] + k[2] * uj[2];
            viscous += c[0] * vj[0] + c[1] * vj[1] + c[2] * vj[2];
            add_transposed(k, (const double *)(now + 2 * i), &force[2 * j]);
            add_transposed(c, (const double *)(now + 2 * i + 1), &force[2 * j + 1]);
        }
        power += v * viscous;
        Lane given = {load[3 * i], load[3 * i + 1], load[3 * i + 2], 0};
        Lane faster = v + sweep->kick[i] * (factor * given - elastic - viscous);
        next[2 * i] = u + step * faster;
        next[2 * i + 1] = faster;
    }
    return power[0] + power[1] + power[2];
}

double explicit_sweep_free(ExplicitSweep *sweep, double factor)
{
    return sweep->bulk->dim == 2 ? sweep_plane(sweep, factor) : sweep_space(sweep, factor);
}
