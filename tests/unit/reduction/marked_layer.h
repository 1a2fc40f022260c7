// SPDX-License-Identifier: GPL-2.0-or-later
// A block of two materials, one above the other.
#ifndef AMONTONS_TESTS_MARKED_LAYER_H
#define AMONTONS_TESTS_MARKED_LAYER_H

#include "base/memory.h"
#include "fem/material.h"
#include "fem/mesh.h"

#include <math.h>

// Two materials: elements whose first node is below `layer` are of the second. Sets areas and
// mean.
static inline void mark_layer(Mesh *mesh, double layer, Materials *materials)
{
    Error err = {0};
    if (materials->count == 1) return;
    mesh->region = NEW_ARRAY(uint8_t, mesh->element_count, &err);
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double lowest = INFINITY;
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
            lowest = fmin(lowest, mesh->position[2 * mesh->element_nodes[a] + 1]);
        mesh->region[e] = lowest < layer - 1e-9;
        materials->area[mesh->region[e]] += mesh_element_area(mesh, e);
    }
    materials_find_mean(materials);
}

#endif
