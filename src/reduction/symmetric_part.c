// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/symmetric_part.h"

#include "base/memory.h"
#include "fem/mesh.h"
#include "reduction/mirror.h"

#include <math.h>
#include <string.h>

enum { ACROSS = 1 };   // axis of the mirror: y

// The unknowns of a mesh by its nodes. K, C and M must be their own images, and unknowns of the
// interface have the images that are known.
static bool find_on_mesh(const BulkOperator *system, const int32_t *image, SymmetricPart *part,
                         Error *err)
{
    int32_t dim = system->bulk->dim, dofs = system->dof_count, *node_image = NULL;
    const int32_t *interface_dofs = system->interface_dofs;
    double *place = NEW_ARRAY(double, dofs, err);
    part->image = NEW_ARRAY(int32_t, dofs, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(place, system->position, (size_t)dofs * sizeof *place);
    TRY(mirror_nodes_find(dim, ACROSS, place, dofs / dim, &node_image, err));
    int32_t parts = 1, *across[DIM_MAX - 1] = {[ACROSS] = node_image};
    if (node_image)
        TRY(mirror_count_parts(system->bulk, across, interface_dofs, system->interface_count,
                               &parts, err));
    part->exists = parts > 1;
    for (int32_t k = 0; part->exists && k < dofs; k++)
        part->image[k] = node_dof(dim, node_image[dof_node(dim, k)], dof_axis(dim, k));
    for (int32_t k = 0; part->exists && k < system->interface_count; k++)
        part->exists = part->image[interface_dofs[k]] == interface_dofs[image[k]];
cleanup:
    memory_free_all(place, node_image);
    return error_is_clean(err);
}

// 1 or -1: what a column of T moves is its own image or opposite to it; 0: neither.
static int32_t column_parity(const TransformBlock *column, const int32_t *image, const double *sign,
                             int32_t interface_count)
{
    int32_t parity = 0;
    for (int32_t i = 0; i < column->size; i++) {
        int32_t row = column->rows[i], j = 0;
        if (row >= interface_count) continue;   // a mirrored unknown: of the other axis
        while (j < column->size && column->rows[j] != image[row]) j++;
        if (j == column->size) return 0;
        int32_t here = sign[row] * column->values[j] * column->values[i] > 0 ? 1 : -1;
        if (parity != 0 && here != parity) return 0;
        parity = here;
    }
    return parity;
}

// A part is symmetric or antisymmetric as all of its unknowns on the interface are.
static void find_in_parts(const ReducedBulk *reduced, const int32_t *image, const double *sign,
                          SymmetricPart *symmetric)
{
    symmetric->exists = reduced->part_count > 1;
    for (int p = 0; p < reduced->part_count; p++) {
        const Transform *by = &reduced->part[p].border;
        int32_t parity = 0;
        for (int32_t b = 0; b < by->block_count && symmetric->exists; b++) {
            int32_t own = column_parity(&by->blocks[b], image, sign, reduced->interface_count);
            bool mirrored = by->blocks[b].rows[0] >= reduced->interface_count;
            if (b == 0) parity = own;
            symmetric->exists = by->blocks[b].count == 1 && (own == parity || mirrored);
        }
        symmetric->exists = symmetric->exists && parity != 0;
        symmetric->kept[p] = parity > 0;
    }
}

bool symmetric_part_find(const BulkOperator *system, const int32_t *image, const double *sign,
                         SymmetricPart *part, Error *err)
{
    *part = (SymmetricPart){.system = system};
    if (system->reduced) find_in_parts(system->reduced, image, sign, part);
    bool on_mesh = system->bulk && system->position;
    return !on_mesh || find_on_mesh(system, image, part, err);
}

void symmetric_part_destroy(SymmetricPart *part)
{
    memory_free(part->image);
    *part = (SymmetricPart){0};
}

void symmetric_part_take(const SymmetricPart *part, const double *x, double *out)
{
    const BulkOperator *system = part->system;
    if (system->reduced) {
        reduced_operator_keep(system->small, part->kept, x, out);
        return;
    }
    for (int32_t k = 0; k < system->dof_count; k++) {
        double across = dof_axis(system->bulk->dim, k) == ACROSS ? -1 : 1;
        out[k] = 0.5 * (x[k] + across * x[part->image[k]]);
    }
}

double symmetric_part_antisymmetric(const SymmetricPart *part, const double *x)
{
    const BulkOperator *system = part->system;
    return system->reduced ? reduced_operator_share_beside(system->small, part->kept, x)
                           : (double)NAN;
}

void symmetric_part_alone(const SymmetricPart *part, bool alone)
{
    const BulkOperator *system = part->system;
    if (part->exists && system->reduced)
        reduced_operator_rest(system->small, alone ? part->kept : NULL);
}
