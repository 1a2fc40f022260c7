// SPDX-License-Identifier: GPL-2.0-or-later
// K, C and M are compared with their images entry by entry: so elements, materials and supports
// need not be looked at.
#include "reduction/mirror.h"

#include "base/memory.h"
#include "reduction/mirror_nodes.h"

#include <math.h>
#include <string.h>

// Of the diagonal entries of row and column, for rounding; where nodes have not been put together
// yet, for what lies between them in the smallest cells.
static const double ALIKE = 1e-9, NEARLY_ALIKE = 1e-3;

// More mirrored unknowns than this part of the interface: it lies on one side, and two parts gain
// little.
static const double MIRRORED_MAX = 0.25;

enum { NONE = -1 };

typedef struct Finder {
    const Bulk *bulk;
    int32_t *image;   // [dof_count] mirror image of each unknown
    int32_t border_count, *border;   // the interface, then mirror images that are not on it
    int32_t *place;   // [dof_count] of each on that list, or NONE
    double *root[2];   // [dof_count] of the diagonal of K and of C
    bool found;
} Finder;

static void finder_destroy(Finder *find)
{
    memory_free(find->image);
    memory_free(find->border);
    memory_free(find->place);
    for (int p = 0; p < 2; p++) {
        memory_free(find->root[p]);
    }
}

void mirror_destroy(Mirror *mirror)
{
    for (int p = 0; p < 2; p++) {
        MirrorPart *part = &mirror->part[p];
        bulk_destroy(&part->bulk);
        transform_destroy(&part->unknowns);
        transform_destroy(&part->border);
        memory_free(part->border_dofs);
    }
    memory_free(mirror->border);
    *mirror = (Mirror){0};
}

// u_x, and no other, has another sign in the image of a motion.
static double sign_of(const Bulk *bulk, int32_t dof)
{
    return dof_axis(bulk->dim, dof) == 0 ? -1 : 1;
}

// The roots of the diagonal of K and of C.
static bool find_roots(Finder *find, Error *err)
{
    const Bulk *bulk = find->bulk;
    const double *const values[] = {bulk->stiffness, bulk->damping};
    for (int which = 0; which < 2; which++) {
        double *root = find->root[which] = NEW_ARRAY(double, bulk->dof_count, err);
        for (int32_t k = 0; root && k < bulk->dof_count; k++)
            root[k] = sqrt(values[which][sparse_entry(&bulk->pattern, k, k)]);
    }
    return error_is_clean(err);
}

// K, C and M are their own images, but for `tolerance`.
static bool is_alike(const Finder *find, double tolerance)
{
    const Bulk *bulk = find->bulk;
    const SparsePattern *pattern = &bulk->pattern;
    for (int32_t j = 0; j < pattern->size; j++) {
        int32_t across = find->image[j], first = pattern->start[across];
        int32_t end = pattern->start[across + 1];
        if (pattern->start[j + 1] - pattern->start[j] != end - first) return false;
        if (!(fabs(bulk->mass[j] - bulk->mass[across]) <= tolerance * bulk->mass[j])) return false;
        for (int32_t k = pattern->start[j]; k < pattern->start[j + 1]; k++) {
            int32_t row = pattern->index[k], at = first;
            while (at < end && pattern->index[at] != find->image[row]) at++;
            if (at == end) return false;
            double sign = sign_of(bulk, row) * sign_of(bulk, j);
            double stiffness = fabs(bulk->stiffness[k] - sign * bulk->stiffness[at]);
            double damping = fabs(bulk->damping[k] - sign * bulk->damping[at]);
            if (!(stiffness <= tolerance * find->root[0][row] * find->root[0][j] &&
                  damping <= tolerance * find->root[1][row] * find->root[1][j]))
                return false;
        }
    }
    return true;
}

// Part 0: alike on both sides. The sign of what moves in one direction is the other's in part 1.
static double sign_in(const Bulk *bulk, int part, int32_t dof)
{
    return part == 0 ? sign_of(bulk, dof) : -sign_of(bulk, dof);
}

static bool list_unknowns(const Finder *find, int p, Transform *by, Error *err)
{
    int32_t dofs = find->bulk->dof_count;
    if (!transform_create(dofs, dofs, dofs, by, err)) return false;
    for (int32_t dof = 0; dof < dofs; dof++) {
        double sign = sign_in(find->bulk, p, dof);
        if (find->image[dof] > dof || (find->image[dof] == dof && sign > 0))
            transform_append_pair(by, dof, find->image[dof], sign);
    }
    return true;
}

// The border's unknowns as those of a part.
static bool list_border_unknowns(const Finder *find, int p, MirrorPart *part, Error *err)
{
    int32_t count = find->border_count;
    part->border_dofs = NEW_ARRAY(int32_t, count, err);
    if (!transform_create(count, count, count, &part->border, err)) return false;
    for (int32_t k = 0; k < count; k++) {
        int32_t dof = find->border[k], image = find->place[find->image[dof]];
        int32_t unknown = transform_column(&part->unknowns, dof);
        if (unknown == NO_BLOCK || image < k) continue;
        int32_t first = part->unknowns.blocks[unknown].rows[0] == dof ? k : image;
        part->border_dofs[part->border.count] = unknown;
        transform_append_pair(&part->border, first, k + image - first, sign_in(find->bulk, p, dof));
    }
    return true;
}

static bool list_border(Finder *find, const int32_t *interface_dofs, int32_t m, Error *err)
{
    int32_t dofs = find->bulk->dof_count;
    find->border = NEW_ARRAY(int32_t, 2 * (int64_t)m, err);
    find->place = NEW_ARRAY(int32_t, dofs, err);
    if (!error_is_clean(err)) return false;
    for (int32_t k = 0; k < dofs; k++) find->place[k] = NONE;
    for (int32_t k = 0; k < m; k++) {
        find->border[k] = interface_dofs[k];
        find->place[interface_dofs[k]] = k;
    }
    find->border_count = m;
    for (int32_t k = 0; k < m; k++) {
        int32_t image = find->image[interface_dofs[k]];
        if (find->place[image] != NONE) continue;
        find->place[image] = find->border_count;
        find->border[find->border_count++] = image;
    }
    return true;
}

// find->found: the bulk is its own image but for `tolerance`, and the interface is not on one side.
static bool look(const int32_t *node_image, const int32_t *interface_dofs, int32_t m,
                 double tolerance, Finder *find, Error *err)
{
    int32_t dofs = find->bulk->dof_count, dim = find->bulk->dim;
    find->image = NEW_ARRAY(int32_t, dofs, err);
    if (!find->image) return false;
    for (int32_t dof = 0; dof < dofs; dof++)
        find->image[dof] = node_dof(dim, node_image[dof_node(dim, dof)], dof_axis(dim, dof));
    if (!list_border(find, interface_dofs, m, err) || !find_roots(find, err)) return false;
    find->found = find->border_count - m <= MIRRORED_MAX * m && is_alike(find, tolerance);
    return true;
}

bool mirror_is_likely(const Bulk *bulk, const double *position, const int32_t *interface_dofs,
                      int32_t m, bool *likely, Error *err)
{
    Finder find = {.bulk = bulk};
    int32_t nodes = bulk->dof_count / bulk->dim, *image = NEW_ARRAY(int32_t, nodes, err);
    double *places = NEW_ARRAY(double, bulk->dof_count, err);
    *likely = false;
    if (!places || !image) goto cleanup;
    memcpy(places, position, (size_t)bulk->dof_count * sizeof *places);
    TRY(mirror_nodes_find(bulk->dim, places, nodes, image, likely, err));
    if (*likely) TRY(look(image, interface_dofs, m, NEARLY_ALIKE, &find, err));
    *likely = find.found;
cleanup:
    finder_destroy(&find);
    memory_free(places);
    memory_free(image);
    return error_is_clean(err);
}

bool mirror_find(const Bulk *bulk, const int32_t *node_image, const int32_t *interface_dofs,
                 int32_t m, Mirror *mirror, Error *err)
{
    Finder find = {.bulk = bulk};
    *mirror = (Mirror){0};
    TRY(look(node_image, interface_dofs, m, ALIKE, &find, err));
    mirror->found = find.found;
    mirror->mirrored = find.border_count - m;
    for (int p = 0; find.found && p < 2; p++) {
        MirrorPart *part = &mirror->part[p];
        TRY(list_unknowns(&find, p, &part->unknowns, err));
        TRY(list_border_unknowns(&find, p, part, err));
        TRY(bulk_transform(bulk, &part->unknowns, &part->bulk, err));
    }
    if (find.found) mirror->border = find.border;
    if (find.found) find.border = NULL;
cleanup:
    finder_destroy(&find);
    return error_is_clean(err);
}
