// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/far_patches.h"

#include "base/memory.h"

#include <math.h>

// Elements between the interface and the first layer: FAR_NEAR over the interface's unknowns,
// within these. The wider an interface, the more a row of elements costs, in products.
enum { FAR_NEAR = 8000, FAR_DISTANCE_LEAST = 8, FAR_DISTANCE_MOST = 20 };

// Unknowns of the interface that a patch of the first layer is nearest to.
enum { FAR_WIDTH = 32 };

// Below FAR_SHARE of all unknowns nothing is replaced.
static const double FAR_SHARE = 0.4;

// Unknowns that are left, over those within that distance of a straight interface: 1.6, 1.5, 1.6
// and 1.5 on 100 x 100, 160 x 160 and 320 x 320 cells and at 800 contact nodes.
static const double LEFT = 1.5;

enum { LAYERS_MAX = 12 };

// Distance of each unknown from the interface in elements, -1: out of reach; the place of the
// nearest unknown of the interface.
typedef struct Reach {
    int32_t *distance, *nearest;   // [dofs] owned
    int32_t farthest;
} Reach;

void far_patches_destroy(FarPatches *patches)
{
    for (int32_t p = 0; patches->modes && p < patches->count; p++)
        patch_modes_destroy(&patches->modes[p]);
    memory_free_all(patches->modes, patches->of, patches->place);
    *patches = (FarPatches){0};
}

static int32_t distance_for(double m)
{
    return (int32_t)fmin(fmax(FAR_NEAR / m, FAR_DISTANCE_LEAST), FAR_DISTANCE_MOST);
}

// That of the unknowns one element nearer, of which diagonals offer several at the same distance:
// the one in the middle, so that patches stand upright.
static int32_t nearest_of(const SparsePattern *pattern, int32_t dof, const Reach *reach)
{
    int32_t first = pattern->start[dof], end = pattern->start[dof + 1], count = 0, nearest = 0;
    double sum = 0, least = INFINITY;
    for (int32_t k = first; k < end; k++) {
        if (reach->distance[pattern->index[k]] != reach->distance[dof] - 1) continue;
        sum += reach->nearest[pattern->index[k]];
        count++;
    }
    for (int32_t k = first; k < end; k++) {
        int32_t other = pattern->index[k];
        if (reach->distance[other] != reach->distance[dof] - 1) continue;
        double off = fabs(reach->nearest[other] - sum / count);
        if (off >= least) continue;
        least = off;
        nearest = reach->nearest[other];
    }
    return nearest;
}

static bool find_reach(const SparsePattern *pattern, const int32_t *interface_dofs, int32_t m,
                       Reach *reach, Error *err)
{
    int32_t *list = NEW_ARRAY(int32_t, pattern->size, err), end = 0;
    int32_t *distance = reach->distance = NEW_ARRAY(int32_t, pattern->size, err);
    int32_t *nearest = reach->nearest = NEW_ARRAY(int32_t, pattern->size, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; k < pattern->size; k++) distance[k] = -1;
    for (int32_t j = 0; j < m; j++) {
        distance[interface_dofs[j]] = 0;
        nearest[interface_dofs[j]] = j;
        list[end++] = interface_dofs[j];
    }
    for (int32_t at = 0; at < end; at++) {
        int32_t from = list[at];
        reach->farthest = distance[from];
        if (distance[from] > 0) nearest[from] = nearest_of(pattern, from, reach);
        for (int32_t k = pattern->start[from]; k < pattern->start[from + 1]; k++) {
            int32_t other = pattern->index[k];
            if (distance[other] >= 0) continue;
            distance[other] = distance[from] + 1;
            list[end++] = other;
        }
    }
cleanup:
    memory_free(list);
    return error_is_clean(err);
}

// NO_PATCH: none. A layer that would be thinner than half of its depth belongs to the one before.
static int32_t layer_of(int32_t distance, int32_t first, int32_t farthest)
{
    if (distance >= 0 && distance <= first) return NO_PATCH;
    int32_t layer = 0, depth = first, end = 2 * first;
    while ((distance < 0 || distance > end) && farthest > end + depth && layer < LAYERS_MAX - 1) {
        depth *= 2;
        end += depth;
        layer++;
    }
    return layer;
}

// Parts of the interface over which a layer is cut.
static int32_t parts_of(int32_t layer, int32_t m)
{
    return (int32_t)fmax(round((double)m / ((double)FAR_WIDTH * (1 << layer))), 1);
}

// Numbers those that have unknowns, layer by layer.
static bool number_patches(const Reach *reach, int32_t m, int32_t dofs, FarPatches *patches,
                           Error *err)
{
    int32_t start[LAYERS_MAX + 1] = {0}, far = 0;
    for (int32_t layer = 0; layer < LAYERS_MAX; layer++)
        start[layer + 1] = start[layer] + parts_of(layer, m);
    int32_t *number = NEW_ARRAY(int32_t, start[LAYERS_MAX], err);
    if (!number) return false;
    for (int32_t k = 0; k < dofs; k++) {
        int32_t layer = layer_of(reach->distance[k], patches->distance, reach->farthest);
        patches->of[k] = NO_PATCH;
        if (layer == NO_PATCH) continue;
        int64_t part = (int64_t)reach->nearest[k] * parts_of(layer, m) / m;
        patches->of[k] = start[layer] + (int32_t)part;
        number[patches->of[k]] = 1;
        far++;
    }
    for (int32_t p = 0; p < start[LAYERS_MAX]; p++)
        if (number[p]) number[p] = patches->count++;
    for (int32_t k = 0; k < dofs; k++)
        if (patches->of[k] != NO_PATCH) patches->of[k] = number[patches->of[k]];
    if (far < FAR_SHARE * dofs) patches->count = 0;
    memory_free(number);
    return true;
}

bool far_patches_begin(const Bulk *bulk, double unit, int32_t expected, FarPatches *patches,
                       Error *err)
{
    const SparsePattern *from = &bulk->pattern;
    for (int32_t p = 0; p < patches->count; p++) {
        PatchModes *modes = &patches->modes[p];
        const int32_t *dofs = modes->dofs;
        int32_t size = modes->size, entries = 0, filled = 0;
        for (int32_t j = 0; j < size; j++)
            entries += from->start[dofs[j] + 1] - from->start[dofs[j]];
        modes->pattern = (SparsePattern){.size = size,
                                         .start = NEW_ARRAY(int32_t, (int64_t)size + 1, err),
                                         .index = NEW_ARRAY(int32_t, entries, err)};
        modes->stiffness = NEW_ARRAY(double, entries, err);
        if (!error_is_clean(err)) return false;
        for (int32_t j = 0; j < size; j++) {
            for (int32_t k = from->start[dofs[j]]; k < from->start[dofs[j] + 1]; k++) {
                if (patches->of[from->index[k]] != p) continue;
                modes->pattern.index[filled] = patches->place[from->index[k]];
                modes->stiffness[filled++] = bulk->stiffness[k] / unit;
            }
            modes->pattern.start[j + 1] = filled;
        }
        if (!patch_modes_make_room(modes, expected, err)) return false;
    }
    return true;
}

double far_patches_left(double unknowns, double interface_count)
{
    double left = LEFT * distance_for(interface_count) * interface_count;
    return interface_count < FAR_INTERFACE ? unknowns : fmin(left, unknowns);
}

bool far_patches_create(const SparsePattern *pattern, const int32_t *interface_dofs, int32_t m,
                        FarPatches *patches, Error *err)
{
    Reach reach = {0};
    *patches =
        (FarPatches){.distance = distance_for(m), .of = NEW_ARRAY(int32_t, pattern->size, err)};
    if (!patches->of) goto cleanup;
    TRY(find_reach(pattern, interface_dofs, m, &reach, err));
    TRY(number_patches(&reach, m, pattern->size, patches, err));
    if (patches->count == 0) goto cleanup;

    // The unknowns of each patch.
    int32_t dofs = pattern->size;
    patches->place = NEW_ARRAY(int32_t, dofs, err);
    patches->modes = NEW_ARRAY(PatchModes, patches->count, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; k < dofs; k++)
        if (patches->of[k] != NO_PATCH) patches->place[k] = patches->modes[patches->of[k]].size++;
    for (int32_t p = 0; p < patches->count; p++)
        TRY((patches->modes[p].dofs = NEW_ARRAY(int32_t, patches->modes[p].size, err)));
    for (int32_t k = 0; k < dofs; k++)
        if (patches->of[k] != NO_PATCH) patches->modes[patches->of[k]].dofs[patches->place[k]] = k;
cleanup:
    memory_free_all(reach.distance, reach.nearest);
    return error_is_clean(err);
}
