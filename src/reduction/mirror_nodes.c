// SPDX-License-Identifier: GPL-2.0-or-later
// Nodes are put in order along a direction in which hardly any two are abreast.
#include "reduction/mirror_nodes.h"

#include "base/memory.h"
#include "base/order.h"
#include "fem/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SLANT = 0.6180339887498949;   // of the direction: no ratio of small numbers

// Largest distance of a node's image from a node, over the length.
static const double APART = 3e-9;

typedef struct Place {
    double along;
    int32_t node;
} Place;

static double along(int32_t dim, const double *at)
{
    double sum = at[0], part = 1;
    for (int32_t d = 1; d < dim; d++) sum += (part *= SLANT) * at[d];
    return sum;
}

// The nodes that are searched.
typedef struct Nodes {
    int32_t dim, count;
    const double *position;   // [count * dim]
    Place *places;   // [count] in order; owned
    double apart;
} Nodes;

// The node at a place, or -1.
static int32_t node_at(const Nodes *nodes, const double *at)
{
    MeshPlace corner;
    for (int32_t d = 0; d < DIM_MAX; d++) corner[d] = nodes->apart;
    double reach = along(nodes->dim, corner), from = along(nodes->dim, at) - reach;
    int32_t first = 0, end = nodes->count;
    while (first < end) {
        int32_t middle = first + (end - first) / 2;
        if (nodes->places[middle].along < from)
            first = middle + 1;
        else
            end = middle;
    }
    for (int32_t k = first; k < nodes->count && nodes->places[k].along <= from + 2 * reach; k++) {
        int32_t node = nodes->places[k].node;
        const double *there = nodes->position + node_dof(nodes->dim, node, 0);
        bool close = true;
        for (int32_t d = 0; d < nodes->dim; d++)
            close = close && fabs(there[d] - at[d]) <= nodes->apart;
        if (close) return node;
    }
    return -1;
}

bool mirror_nodes_find(int32_t dim, int32_t axis, double *position, int32_t nodes, int32_t **out,
                       Error *err)
{
    double least = INFINITY, most = -INFINITY;
    Nodes all = {dim, nodes, position, NEW_ARRAY(Place, nodes, err), 0};
    int32_t *image = *out = NEW_ARRAY(int32_t, nodes, err);
    bool found = error_is_clean(err);
    if (!found) goto cleanup;
    for (int32_t i = 0; i < nodes; i++) {
        const double *at = position + node_dof(dim, i, 0);
        all.places[i] = (Place){along(dim, at), i};
        least = fmin(least, at[axis]);
        most = fmax(most, at[axis]);
    }
    double sum = least + most;
    all.apart = APART * (most - least);
    qsort(all.places, (size_t)nodes, sizeof *all.places, order_doubles);
    for (int32_t i = 0; found && i < nodes; i++) {
        MeshPlace across;
        memcpy(across, position + node_dof(dim, i, 0), (size_t)dim * sizeof(double));
        across[axis] = sum - across[axis];
        image[i] = node_at(&all, across);
        found = image[i] >= 0;
    }
    for (int32_t i = 0; found && i < nodes; i++) found = image[image[i]] == i;

    // A node and its image both go into the middle: across the mirror along `axis`, else alike.
    for (int32_t i = 0; found && i < nodes; i++) {
        double *here = position + node_dof(dim, i, 0),
               *there = position + node_dof(dim, image[i], 0);
        if (image[i] < i) continue;
        here[axis] = (here[axis] + (sum - there[axis])) / 2;
        there[axis] = sum - here[axis];
        for (int32_t d = 0; d < dim; d++)
            if (d != axis) there[d] = here[d] = (here[d] + there[d]) / 2;
    }
cleanup:
    memory_free(all.places);
    if (found) return true;
    memory_free(image);
    *out = NULL;
    return error_is_clean(err);
}
