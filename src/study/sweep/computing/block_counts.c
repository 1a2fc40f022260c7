// SPDX-License-Identifier: GPL-2.0-or-later
// By the keys of the scene, without meshing: blocks that differ in their length alone share a basis
// too (reduction/reduction_block), and are counted apart.
#include "study/sweep/computing/block_counts.h"

#include "scene/keys.h"

#include <search.h>
#include <string.h>

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
bool block_note(const Scene *scene, const PointMesh *mesh, SweepPoint *point, Error *err)
{
    point->block = hash_start();
    hash_bytes(&point->block, &mesh->hash, sizeof mesh->hash);
    if (scene->load.traction_count > 0) hash_number(&point->block, scene->load.pressure);
    hash_number(&point->block,
                scene->time.accuracy);   // the reduction's, where it says none itself
    return scene_hash(scene, key_counts, &point->block, err);
}

static int compare_blocks(const void *a, const void *b)
{
    const SweepPoint *one = a, *other = b;
    return memcmp(&one->block, &other->block, sizeof one->block);
}

bool blocks_count(SweepPoint *points, int32_t count, Error *err)
{
    void *tree = NULL;   // the first of each block, which counts for all
    for (int32_t k = 0; k < count; k++) {
        points[k].runs = 0;
        SweepPoint *const *first = tsearch(&points[k], &tree, compare_blocks);
        if (!first) FAIL(err, ERROR_MEMORY, "no memory for %d blocks", k);
        (*first)->runs++;
    }
    for (int32_t k = 0; k < count; k++) {
        SweepPoint *const *first = tfind(&points[k], &tree, compare_blocks);
        points[k].runs = (*first)->runs;
    }
cleanup:
    points_forget(&tree);
    return error_is_clean(err);
}
