// SPDX-License-Identifier: GPL-2.0-or-later
// K, C and M are compared with their images entry by entry: so elements, materials and supports
// need not be looked at.
#include "reduction/mirror.h"

#include "base/memory.h"
#include "reduction/mirror_nodes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of the diagonal entries of row and column, for rounding; where nodes have not been put together
// yet, for what lies between them in the smallest cells.
static const double ALIKE = 1e-9, NEARLY_ALIKE = 1e-3;

// More images than this part of the interface: it lies on one side, and halves gain little.
static const double IMAGES_MAX = 0.25;

enum { NONE = -1 };

typedef struct Finder {
    const Bulk *bulk;
    int32_t *image;   // [dof_count] of each unknown
    int32_t *half_of[2];   // [dof_count] the unknown of each half that it is part of, or NONE
    int32_t border_count, *border;   // the interface and images that are not on it
    int32_t *place;   // [dof_count] of each on that list, or NONE
    double *root[2];   // [dof_count] of the diagonal of K and of C
    bool found;
} Finder;

static void finder_destroy(Finder *find)
{
    memory_free(find->image);
    memory_free(find->border);
    memory_free(find->place);
    for (int h = 0; h < 2; h++) {
        memory_free(find->half_of[h]);
        memory_free(find->root[h]);
    }
}

void mirror_destroy(Mirror *mirror)
{
    for (int h = 0; h < 2; h++) {
        MirrorHalf *half = &mirror->half[h];
        bulk_destroy(&half->bulk);
        fold_destroy(&half->unknowns);
        fold_destroy(&half->border);
        memory_free(half->border_dofs);
    }
    *mirror = (Mirror){0};
}

// u_x, and not u_z, has another sign in the image of a motion.
static double sign_of(int32_t dof)
{
    return dof % 2 == 0 ? -1 : 1;
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

// K, C and M are their own images, but for `part`.
static bool is_alike(const Finder *find, double part)
{
    const Bulk *bulk = find->bulk;
    const SparsePattern *pattern = &bulk->pattern;
    for (int32_t j = 0; j < pattern->size; j++) {
        int32_t across = find->image[j], first = pattern->start[across];
        int32_t end = pattern->start[across + 1];
        if (pattern->start[j + 1] - pattern->start[j] != end - first) return false;
        if (!(fabs(bulk->mass[j] - bulk->mass[across]) <= part * bulk->mass[j])) return false;
        for (int32_t k = pattern->start[j]; k < pattern->start[j + 1]; k++) {
            int32_t row = pattern->index[k], at = first;
            while (at < end && pattern->index[at] != find->image[row]) at++;
            if (at == end) return false;
            double sign = sign_of(row) * sign_of(j);
            double stiffness = fabs(bulk->stiffness[k] - sign * bulk->stiffness[at]);
            double damping = fabs(bulk->damping[k] - sign * bulk->damping[at]);
            if (!(stiffness <= part * find->root[0][row] * find->root[0][j] &&
                  damping <= part * find->root[1][row] * find->root[1][j]))
                return false;
        }
    }
    return true;
}

// Half 0: alike on both sides. The sign of what moves in one direction is the other's in half 1.
static double sign_in(int half, int32_t dof)
{
    return half == 0 ? sign_of(dof) : -sign_of(dof);
}

static bool list_unknowns(Finder *find, int h, Fold *fold, Error *err)
{
    int32_t dofs = find->bulk->dof_count;
    int32_t *half_of = find->half_of[h] = NEW_ARRAY(int32_t, dofs, err);
    if (!half_of || !fold_create(dofs, fold, err)) return false;
    for (int32_t dof = 0; dof < dofs; dof++) {
        int32_t image = find->image[dof];
        double sign = sign_in(h, dof);
        half_of[dof] = image < dof ? half_of[image] : NONE;
        if (image < dof || (image == dof && sign < 0)) continue;
        half_of[dof] = fold->count;
        fold_append(fold, dof, image, sign);
    }
    return true;
}

static int ascending(const void *left, const void *right)
{
    int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    return (a > b) - (a < b);
}

// Columns of the half's pattern: those of both unknowns of each.
static bool fold_pattern(const Finder *find, int h, const Fold *fold, SparsePattern *to, Error *err)
{
    const SparsePattern *from = &find->bulk->pattern;
    const int32_t *half_of = find->half_of[h];
    int32_t entries = from->start[from->size];
    int32_t *seen = NEW_ARRAY(int32_t, fold->count, err);
    *to = (SparsePattern){.size = fold->count,
                          .start = NEW_ARRAY(int32_t, (int64_t)fold->count + 1, err),
                          .index = NEW_ARRAY(int32_t, entries, err)};
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t j = 0; j < fold->count; j++) {
        int32_t end = to->start[j];
        const int32_t both[] = {fold->one[j], fold->other[j]};
        for (int k = 0; k < 2; k++) {
            for (int32_t at = from->start[both[k]]; at < from->start[both[k] + 1]; at++) {
                int32_t row = half_of[from->index[at]];
                if (row == NONE || seen[row] == j + 1) continue;
                seen[row] = j + 1;
                to->index[end++] = row;
            }
        }
        qsort(to->index + to->start[j], (size_t)(end - to->start[j]), sizeof *to->index, ascending);
        to->start[j + 1] = end;
    }
cleanup:
    memory_free(seen);
    return error_is_clean(err);
}

// T A T' of a sparse matrix, column by column.
static void fold_matrix(const Finder *find, int h, const Fold *fold, const double *values,
                        const SparsePattern *to, double *out)
{
    const SparsePattern *from = &find->bulk->pattern;
    const int32_t *half_of = find->half_of[h];
    for (int32_t j = 0; j < fold->count; j++) {
        const int32_t both[] = {fold->one[j], fold->other[j]};
        const double signs[] = {1, fold->sign[j]};
        for (int side = 0; side < 2 && signs[side] != 0; side++) {
            double weight = fold->weight[j] * signs[side];
            for (int32_t at = from->start[both[side]]; at < from->start[both[side] + 1]; at++) {
                int32_t dof = from->index[at], row = half_of[dof];
                if (row == NONE) continue;
                double share = fold->weight[row] * (dof == fold->one[row] ? 1 : fold->sign[row]);
                out[sparse_entry(to, row, j)] += weight * share * values[at];
            }
        }
    }
}

static bool fold_bulk(const Finder *find, int h, MirrorHalf *half, Error *err)
{
    const Bulk *bulk = find->bulk;
    const Fold *fold = &half->unknowns;
    Bulk *to = &half->bulk;
    to->dof_count = fold->count;
    TRY(fold_pattern(find, h, fold, &to->pattern, err));
    int64_t entries = to->pattern.start[fold->count];
    to->stiffness = NEW_ARRAY(double, entries, err);
    to->damping = NEW_ARRAY(double, entries, err);
    to->mass = NEW_ARRAY(double, fold->count, err);
    to->load = NEW_ARRAY(double, fold->count, err);
    to->held = NEW_ARRAY(uint8_t, fold->count, err);
    if (!error_is_clean(err)) goto cleanup;
    fold_matrix(find, h, fold, bulk->stiffness, &to->pattern, to->stiffness);
    fold_matrix(find, h, fold, bulk->damping, &to->pattern, to->damping);
    fold_take(fold, bulk->load, to->load);
    for (int32_t k = 0; k < fold->count; k++) {
        to->held[k] = bulk->held[fold->one[k]];
        to->mass[k] = (bulk->mass[fold->one[k]] + bulk->mass[fold->other[k]]) / 2;
    }
cleanup:
    return error_is_clean(err);
}

// The border's unknowns as those of a half.
static bool fold_border(const Finder *find, int h, MirrorHalf *half, Error *err)
{
    if (!fold_create(find->border_count, &half->border, err)) return false;
    half->border_dofs = NEW_ARRAY(int32_t, find->border_count, err);
    if (!half->border_dofs) return false;
    for (int32_t k = 0; k < find->border_count; k++) {
        int32_t dof = find->border[k], image = find->place[find->image[dof]];
        int32_t unknown = find->half_of[h][dof];
        if (unknown == NONE || image < k) continue;
        int32_t first = half->unknowns.one[unknown] == dof ? k : image;
        half->border_dofs[half->border.count] = unknown;
        fold_append(&half->border, first, k + image - first, sign_in(h, dof));
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

// find->found: the bulk is its own image but for `part`, and the interface is not on one side.
static bool look(const int32_t *node_image, const int32_t *interface_dofs, int32_t m, double part,
                 Finder *find, Error *err)
{
    int32_t dofs = find->bulk->dof_count;
    find->image = NEW_ARRAY(int32_t, dofs, err);
    if (!find->image) return false;
    for (int32_t dof = 0; dof < dofs; dof++) find->image[dof] = 2 * node_image[dof / 2] + dof % 2;
    if (!list_border(find, interface_dofs, m, err) || !find_roots(find, err)) return false;
    find->found = find->border_count - m <= IMAGES_MAX * m && is_alike(find, part);
    return true;
}

bool mirror_is_likely(const Bulk *bulk, const double *position, const int32_t *interface_dofs,
                      int32_t m, bool *likely, Error *err)
{
    Finder find = {.bulk = bulk};
    int32_t nodes = bulk->dof_count / 2, *image = NEW_ARRAY(int32_t, nodes, err);
    double *places = NEW_ARRAY(double, bulk->dof_count, err);
    *likely = false;
    if (!places || !image) goto cleanup;
    memcpy(places, position, (size_t)bulk->dof_count * sizeof *places);
    TRY(mirror_nodes_find(places, nodes, image, likely, err));
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
    mirror->images = find.border_count - m;
    for (int h = 0; find.found && h < 2; h++) {
        MirrorHalf *half = &mirror->half[h];
        TRY(list_unknowns(&find, h, &half->unknowns, err));
        TRY(fold_border(&find, h, half, err));
        TRY(fold_bulk(&find, h, half, err));
    }
cleanup:
    finder_destroy(&find);
    return error_is_clean(err);
}
