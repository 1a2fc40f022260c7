// SPDX-License-Identifier: GPL-2.0-or-later
// Nodes are put in order along a direction in which hardly any two are abreast.
#include "reduction/mirror_nodes.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

static const double SLANT = 0.6180339887498949;   // of the direction: no ratio of small numbers

// Between a node and its image, over the length.
static const double APART = 3e-9;

typedef struct Place {
    double along;
    int32_t node;
} Place;

static double along(double x, double z)
{
    return x + SLANT * z;
}

static int by_place(const void *left, const void *right)
{
    double a = ((const Place *)left)->along, b = ((const Place *)right)->along;
    return (a > b) - (a < b);
}

// The node within `apart` of (x, z), or -1.
static int32_t node_at(const Place *places, int32_t count, const double *position, double x,
                       double z, double apart)
{
    double reach = along(apart, apart), from = along(x, z) - reach;
    int32_t first = 0, end = count;
    while (first < end) {
        int32_t middle = first + (end - first) / 2;
        if (places[middle].along < from)
            first = middle + 1;
        else
            end = middle;
    }
    for (int32_t k = first; k < count && places[k].along <= from + 2 * reach; k++) {
        const double *at = position + 2 * (int64_t)places[k].node;
        if (fabs(at[0] - x) <= apart && fabs(at[1] - z) <= apart) return places[k].node;
    }
    return -1;
}

bool mirror_nodes_find(double *position, int32_t nodes, int32_t *image, bool *found, Error *err)
{
    double least = INFINITY, most = -INFINITY;
    Place *places = NEW_ARRAY(Place, nodes, err);
    if (!places) return false;
    for (int32_t i = 0; i < nodes; i++) {
        const double *at = position + 2 * (int64_t)i;
        places[i] = (Place){along(at[0], at[1]), i};
        least = fmin(least, at[0]);
        most = fmax(most, at[0]);
    }
    double sum = least + most, apart = APART * (most - least);
    qsort(places, (size_t)nodes, sizeof *places, by_place);
    *found = true;
    for (int32_t i = 0; *found && i < nodes; i++) {
        const double *at = position + 2 * (int64_t)i;
        image[i] = node_at(places, nodes, position, sum - at[0], at[1], apart);
        *found = image[i] >= 0;
    }
    for (int32_t i = 0; *found && i < nodes; i++) *found = image[image[i]] == i;
    for (int32_t i = 0; *found && i < nodes; i++) {
        if (image[i] < i) continue;
        double *here = position + 2 * (int64_t)i, *there = position + 2 * (int64_t)image[i];
        here[0] = (here[0] + (sum - there[0])) / 2;
        here[1] = (here[1] + there[1]) / 2;
        there[0] = sum - here[0];
        there[1] = here[1];
    }
    memory_free(places);
    return true;
}
