// SPDX-License-Identifier: GPL-2.0-or-later
// By the keys of the scene, without meshing: blocks that differ in their length alone share a basis
// too (reduction/reduction_block), and are counted apart.
#include "study/sweep/computing/block_counts.h"

#include "base/memory.h"
#include "scene/keys.h"

#include <stdlib.h>
#include <string.h>

void block_counts_destroy(BlockCounts *counts)
{
    memory_free(counts->blocks);
    *counts = (BlockCounts){0};
}

// Where the block is, what it consists of, where it is held and pushed, how exactly it is reduced.
static bool key_counts(const char *key)
{
    static const char *const counted[] = {
        "mesh.set",   "groups",    "material", "reduction",      "rod.kind",
        "rod.height", "rod.width", "rod.ends", "load.tractions", "load.supports"};
    if (strcmp(key, "material.density") == 0) return false;
    for (size_t k = 0; k < sizeof counted / sizeof counted[0]; k++)
        if (strncmp(key, counted[k], strlen(counted[k])) == 0) return true;
    return false;
}

// With tractions the pattern of the load depends on the pressure.
bool block_counts_note(const Scene *scene, const PointMesh *mesh, BlockCounts *counts, Error *err)
{
    Hash hash = hash_start();
    hash_bytes(&hash, &mesh->hash, sizeof mesh->hash);
    if (scene->load.traction_count > 0) hash_number(&hash, scene->load.pressure);
    hash_number(&hash, scene->time.accuracy);   // the reduction's, where it says none itself
    if (!scene_hash(scene, key_counts, &hash, err)) return false;
    if (!memory_grow(&counts->blocks, counts->count, &counts->room, sizeof *counts->blocks, err))
        return false;
    counts->blocks[counts->count++] = hash;
    return true;
}

typedef struct BlockOfPoint {
    Hash block;
    int32_t point;
} BlockOfPoint;

static int compare_blocks(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(Hash));
}

bool block_counts_set(const BlockCounts *counts, SweepPoint *points, Error *err)
{
    int32_t count = counts->count;
    BlockOfPoint *sorted = NEW_ARRAY(BlockOfPoint, count, err);
    if (!sorted) return false;
    for (int32_t k = 0; k < count; k++) sorted[k] = (BlockOfPoint){counts->blocks[k], k};
    qsort(sorted, (size_t)count, sizeof *sorted, compare_blocks);
    for (int32_t first = 0, end; first < count; first = end) {
        for (end = first; end < count && compare_blocks(&sorted[first], &sorted[end]) == 0;) end++;
        for (int32_t k = first; k < end; k++) points[sorted[k].point].runs = end - first;
    }
    memory_free(sorted);
    return true;
}
