// SPDX-License-Identifier: GPL-2.0-or-later
// K, C, M and the shape matrices are compared with their images entry by entry: so elements,
// materials and supports need not be looked at.
#include "reduction/mirror.h"

#include "base/memory.h"
#include "base/order.h"
#include "base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- images of nodes ----------------------------------------------------------------------------

// Nodes are put in order along a direction in which hardly any two are abreast.
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

// --- a bulk and its image ----------------------------------------------------------------------

// Tolerance for rounding, relative to the diagonal entries of row and column.
static const double ALIKE = 1e-9;

// More mirrored unknowns than this part of the interface: it lies on one side, and two parts gain
// little.
static const double MIRRORED_MAX = 0.25;

enum { NONE = -1, AXES_MAX = DIM_MAX - 1 };

typedef struct Finder {
    const Bulk *bulk;
    int32_t axes, axis[AXES_MAX];   // [axes] across which it is its own image
    int32_t *image[AXES_MAX];   // [axes][dof_count] mirror image of each unknown
    int32_t border_count, *border;   // the interface, then mirror images that are not on it
    int32_t *place;   // [dof_count] of each on that list, or NONE
    double *root[2 + SPECTRUM_SHAPES_MAX];   // [dof_count] of the diagonal of K, C and each S_j
} Finder;

static void finder_destroy(Finder *find)
{
    for (int32_t k = 0; k < AXES_MAX; k++) memory_free(find->image[k]);
    for (size_t k = 0; k < sizeof find->root / sizeof *find->root; k++) memory_free(find->root[k]);
    memory_free_all(find->border, find->place);
}

void mirror_destroy(Mirror *mirror)
{
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        MirrorPart *part = &mirror->part[p];
        bulk_destroy(&part->bulk);
        transform_destroy(&part->unknowns);
        transform_destroy(&part->border);
        memory_free(part->border_dofs);
    }
    memory_free(mirror->border);
    *mirror = (Mirror){0};
}

// Motion along the axis, and no other, changes its sign in the image.
static double sign_of(const Finder *find, int32_t k, int32_t dof)
{
    return dof_axis(find->bulk->dim, dof) == find->axis[k] ? -1 : 1;
}

// K, C or S_j.
static const double *values_of(const Bulk *bulk, int32_t which)
{
    return which == 0 ? bulk->stiffness : which == 1 ? bulk->damping : bulk->shape[which - 2];
}

// K, C, M and S_j are their own images across the last axis.
static bool is_alike(const Finder *find)
{
    int32_t last = find->axes - 1;
    const int32_t *image = find->image[last];
    const Bulk *bulk = find->bulk;
    const SparsePattern *pattern = &bulk->pattern;
    for (int32_t j = 0; j < pattern->size; j++) {
        int32_t across = image[j];
        int32_t entries = pattern->start[across + 1] - pattern->start[across];
        if (pattern->start[j + 1] - pattern->start[j] != entries) return false;
        if (!(fabs(bulk->mass[j] - bulk->mass[across]) <= ALIKE * bulk->mass[j])) return false;
        for (int32_t k = pattern->start[j]; k < pattern->start[j + 1]; k++) {
            int32_t row = pattern->index[k], at = sparse_entry(pattern, across, image[row]);
            if (pattern->index[at] != image[row]) return false;
            double sign = sign_of(find, last, row) * sign_of(find, last, j);
            double beside = bulk->mass_beside ? bulk->mass_beside[k] - sign * bulk->mass_beside[at]
                                              : 0;
            if (!(fabs(beside) <= ALIKE * bulk->mass[j])) return false;
            for (int32_t which = 0; which < 2 + bulk->spectrum.matrix_count; which++) {
                const double *values = values_of(bulk, which), *root = find->root[which];
                if (!(fabs(values[k] - sign * values[at]) <= ALIKE * root[row] * root[j]))
                    return false;
            }
        }
    }
    return true;
}

// An unknown, its images and their signs in part p, in which motions are opposite across the axes
// that are bits of p; how many, 0: they cancel.
static int32_t list_images(const Finder *find, int p, int32_t dof, int32_t *rows, double *signs)
{
    int32_t count = 0;
    for (int across = 0; across < 1 << find->axes; across++) {
        int32_t at = dof, same = 0;
        double sign = 1;
        for (int32_t k = 0; k < find->axes; k++) {
            if (!(across >> k & 1)) continue;
            at = find->image[k][at];
            sign *= sign_of(find, k, dof) * (p >> k & 1 ? -1 : 1);
        }
        while (same < count && rows[same] != at) same++;
        if (same < count && signs[same] != sign) return 0;
        if (same < count) continue;
        rows[count] = at;
        signs[count++] = sign;
    }
    return count;
}

static int32_t least_of(const int32_t *list, int32_t count)
{
    int32_t least = list[0];
    for (int32_t k = 1; k < count; k++)
        if (list[k] < least) least = list[k];
    return least;
}

// The interface and all images of it.
static void list_border(Finder *find, const int32_t *interface_dofs, int32_t m)
{
    for (int32_t k = 0; k < find->bulk->dof_count; k++) find->place[k] = NONE;
    for (int32_t k = 0; k < m; k++) {
        find->border[k] = interface_dofs[k];
        find->place[interface_dofs[k]] = k;
    }
    find->border_count = m;
    for (int32_t k = 0; k < find->border_count; k++) {
        for (int32_t j = 0; j < find->axes; j++) {
            int32_t image = find->image[j][find->border[k]];
            if (find->place[image] != NONE) continue;
            find->place[image] = find->border_count;
            find->border[find->border_count++] = image;
        }
    }
}

// Finds the axes across which the bulk is its own image, and the interface not on one side.
static bool look(int32_t *const *node_image, const int32_t *interface_dofs, int32_t m, Finder *find,
                 Error *err)
{
    int32_t dofs = find->bulk->dof_count, dim = find->bulk->dim;
    find->border = NEW_ARRAY(int32_t, (int64_t)REDUCED_PARTS_MAX * m, err);
    find->place = NEW_ARRAY(int32_t, dofs, err);

    // The roots of the diagonals.
    const Bulk *bulk = find->bulk;
    for (int32_t which = 0; which < 2 + bulk->spectrum.matrix_count; which++) {
        const double *values = values_of(bulk, which);
        double *root = find->root[which] = NEW_ARRAY(double, dofs, err);
        for (int32_t k = 0; root && k < dofs; k++)
            root[k] = sqrt(values[sparse_entry(&bulk->pattern, k, k)]);
    }
    if (!error_is_clean(err)) return false;

    // Axis by axis.
    for (int32_t axis = 0; axis < dim - 1; axis++) {
        if (!node_image[axis]) continue;
        int32_t last = find->axes++, *image = find->image[last];
        if (!image) image = find->image[last] = NEW_ARRAY(int32_t, dofs, err);
        if (!image) return false;
        find->axis[last] = axis;
        for (int32_t dof = 0; dof < dofs; dof++)
            image[dof] = node_dof(dim, node_image[axis][dof_node(dim, dof)], dof_axis(dim, dof));
        list_border(find, interface_dofs, m);
        if (find->border_count - m > MIRRORED_MAX * m || !is_alike(find)) find->axes--;
    }
    list_border(find, interface_dofs, m);
    return true;
}

bool mirror_count_parts(const Bulk *bulk, int32_t *const *node_image, const int32_t *interface_dofs,
                        int32_t m, int32_t *parts, Error *err)
{
    Finder find = {.bulk = bulk};
    bool done = look(node_image, interface_dofs, m, &find, err);
    *parts = 1 << find.axes;
    finder_destroy(&find);
    return done;
}

typedef struct Parts {
    const Finder *find;
    MirrorPart *part;
} Parts;

static bool make_part(void *context, int32_t p, Error *err)
{
    const Parts *parts = context;
    const Finder *find = parts->find;
    MirrorPart *part = &parts->part[p];
    int32_t dofs = find->bulk->dof_count, border = find->border_count, rows[REDUCED_PARTS_MAX];
    double signs[REDUCED_PARTS_MAX];
    if (!transform_create(dofs, dofs, dofs, &part->unknowns, err)) return false;
    for (int32_t dof = 0; dof < dofs; dof++) {
        int32_t count = list_images(find, p, dof, rows, signs);
        if (count > 0 && least_of(rows, count) == dof)
            transform_append_images(&part->unknowns, rows, count, signs);
    }

    // The border's unknowns as those of the part.
    part->border_dofs = NEW_ARRAY(int32_t, border, err);
    if (!transform_create(border, border, border, &part->border, err)) return false;
    for (int32_t k = 0; k < border; k++) {
        int32_t unknown = transform_column(&part->unknowns, find->border[k]);
        if (unknown == NO_BLOCK) continue;
        int32_t count = list_images(find, p, part->unknowns.blocks[unknown].rows[0], rows, signs);
        for (int32_t i = 0; i < count; i++) rows[i] = find->place[rows[i]];
        if (least_of(rows, count) != k) continue;
        part->border_dofs[part->border.count] = unknown;
        transform_append_images(&part->border, rows, count, signs);
    }
    return bulk_transform(find->bulk, &part->unknowns, &part->bulk, err);
}

bool mirror_find(const Bulk *bulk, int32_t *const *node_image, const int32_t *interface_dofs,
                 int32_t m, Mirror *mirror, Error *err)
{
    Finder find = {.bulk = bulk};
    *mirror = (Mirror){0};
    TRY(look(node_image, interface_dofs, m, &find, err));
    if (find.axes == 0) goto cleanup;
    mirror->part_count = 1 << find.axes;
    mirror->mirrored = find.border_count - m;
    TRY(parallel_try(mirror->part_count, make_part, &(Parts){&find, mirror->part}, err));
    mirror->border = find.border;
    find.border = NULL;
cleanup:
    finder_destroy(&find);
    return error_is_clean(err);
}
