// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/far_cache.h"

#include "base/memory.h"
#include "bulk/far_field.h"
#include "model/basis_cache.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Stands in every key, beside the basis's: a new meaning of the arrays below needs a new number,
// motions that come out otherwise than before are a new basis.
static const char FORMAT[] = "upper 1";

enum { COUNTS = 3 };   // unknowns, layers, rows of the first coupling

static void find_name(const FarCacheDef *def, char name[HASH_TEXT_SIZE])
{
    const UpperBlock *upper = def->upper;
    Hash hash = hash_start();
    name[0] = 0;
    if (!def->keep) return;
    hash_text(&hash, BASIS_FORMAT);
    hash_text(&hash, FORMAT);
    hash_number(&hash, def->far.tolerance);
    reduction_block_hash(&upper->block, &upper->mesh, upper->interface_dofs, upper->interface_count,
                         &hash);
    hash_write(&hash, name);
}

static void field_name(int32_t layer, char name[CACHE_NAME_SIZE])
{
    snprintf(name, CACHE_NAME_SIZE, "field %d", layer);
}

// Sizes that are those of the bulk; false: they cannot be.
static bool read_sizes(const CacheFile *file, const UpperBlock *upper, FarBlock *block)
{
    int32_t counts[COUNTS], sizes[FAR_LAYERS_MAX], columns[FAR_LAYERS_MAX];
    int32_t dofs = upper->block.bulk.dof_count;
    if (!cache_file_whole(file, "counts", COUNTS, CACHE_COUNT_LIMIT, counts)) return false;
    if (counts[0] != dofs || counts[1] < 1 || counts[1] > FAR_LAYERS_MAX || counts[2] > dofs)
        return false;
    if (!cache_file_whole(file, "sizes", counts[1], dofs, sizes) ||
        !cache_file_whole(file, "columns", counts[1], dofs, columns))
        return false;
    block->dof_count = dofs;
    block->layer_count = counts[1];
    for (int32_t k = 0; k < counts[1]; k++) {
        block->layers[k].size = sizes[k];
        block->layers[k].count = columns[k];
        block->layers[k].coupling.count = k == 0 ? counts[2] : columns[k - 1];
    }
    return true;
}

// No unknown is replaced twice, and what is near stays so.
static bool is_sound(const FarBlock *block, const UpperBlock *upper, Error *err)
{
    uint8_t *seen = NEW_ARRAY(uint8_t, block->dof_count, err);
    bool sound = seen != NULL;
    for (int64_t k = 0; sound && k < block->index_count; k++) {
        sound = !seen[block->indices[k]];
        seen[block->indices[k]] = 1;
    }
    for (int32_t k = 0; sound && k < block->layer_count; k++)
        for (int32_t i = 0; i < block->layers[k].size; i++) seen[block->layers[k].dofs[i]] = 2;
    for (int32_t j = 0; sound && j < upper->interface_count; j++)
        sound = seen[upper->interface_dofs[j]] != 2;
    memory_free(seen);
    return sound;
}

// false without an error: an array is missing, of another length or holds what cannot be.
static bool read_block(const CacheFile *file, const UpperBlock *upper, FarBlock *block, Error *err)
{
    const double *error = cache_file_array(file, "error", 1);
    if (!error || !read_sizes(file, upper, block) || !far_block_lay_out(block, err)) return false;
    const double *matrices = cache_file_array(file, "matrices", block->number_count);
    if (!matrices || !cache_file_whole(file, "indices", (int32_t)block->index_count,
                                       block->dof_count, block->indices))
        return false;
    memcpy(block->matrices, matrices, (size_t)block->number_count * sizeof *matrices);
    block->error = *error;
    return is_sound(block, upper, err);
}

static bool read_fields(const char *name, FarBlock *block, bool *found, char *reason, Error *err)
{
    char path[CACHE_PATH_SIZE], array[CACHE_NAME_SIZE];
    CacheFile file = {0};
    cache_file_path(name, "field", path);
    TRY(cache_file_read(path, name, &file, found, reason, err));
    for (int32_t k = 0; *found && k < block->layer_count; k++) {
        FarLayer *layer = &block->layers[k];
        int64_t count = (int64_t)layer->size * layer->count;
        field_name(k, array);
        const double *field = cache_file_array(&file, array, count);
        *found = field != NULL;
        if (!field) break;
        layer->field = NEW_ARRAY(double, count, err);
        if (!layer->field) goto cleanup;
        memcpy(layer->field, field, (size_t)count * sizeof *field);
    }
cleanup:
    cache_file_destroy(&file);
    return error_is_clean(err);
}

static bool load(const char *name, const FarCacheDef *def, FarBlock *block, bool *found, char *note,
                 Error *err)
{
    char path[CACHE_PATH_SIZE], reason[CACHE_REASON_SIZE] = "";
    CacheFile file = {0};
    *found = false;
    if (!name[0] || !cache_file_path(name, "upper", path)) goto cleanup;
    TRY(cache_file_read(path, name, &file, found, reason, err));
    if (*found && !read_block(&file, def->upper, block, err)) {
        *found = false;
        snprintf(reason, sizeof reason, "an array is missing or wrong");
    }
    if (*found && def->with_fields) TRY(read_fields(name, block, found, reason, err));
    if (reason[0]) snprintf(note, CACHE_NOTE_SIZE, "a cached upper block is not used: %s", reason);
cleanup:
    cache_file_destroy(&file);
    *found = *found && error_is_clean(err);
    if (!*found) far_block_destroy(block);
    return error_is_clean(err);
}

static bool store_fields(const char *path, const char *name, const FarBlock *block, Error *err)
{
    CacheArray arrays[FAR_LAYERS_MAX];
    for (int32_t k = 0; k < block->layer_count; k++) {
        const FarLayer *layer = &block->layers[k];
        arrays[k] =
            (CacheArray){.count = (int64_t)layer->size * layer->count, .values = layer->field};
        field_name(k, arrays[k].name);
    }
    return cache_file_write(path, name, arrays, block->layer_count, err);
}

static bool store_block(const char *name, const FarBlock *block, Error *err)
{
    char path[CACHE_PATH_SIZE];
    double counts[COUNTS] = {block->dof_count, block->layer_count, block->layers[0].coupling.count};
    double sizes[FAR_LAYERS_MAX], columns[FAR_LAYERS_MAX];
    double *indices = NEW_ARRAY(double, block->index_count, err);
    if (!indices || !cache_file_path(name, "upper", path)) goto cleanup;
    for (int64_t k = 0; k < block->index_count; k++) indices[k] = block->indices[k];
    for (int32_t k = 0; k < block->layer_count; k++) {
        sizes[k] = block->layers[k].size;
        columns[k] = block->layers[k].count;
    }
    CacheArray arrays[] = {{"counts", COUNTS, counts},
                           {"sizes", block->layer_count, sizes},
                           {"columns", block->layer_count, columns},
                           {"error", 1, &block->error},
                           {"indices", block->index_count, indices},
                           {"matrices", block->number_count, block->matrices}};
    TRY(cache_file_write(path, name, arrays, sizeof arrays / sizeof *arrays, err));
cleanup:
    memory_free(indices);
    return error_is_clean(err);
}

// Never an error. The fields first: they belong to the block that is there afterwards.
static void store(const char *name, const FarCacheDef *def, const FarBlock *block, char *note)
{
    char path[CACHE_PATH_SIZE];
    Error err = {0};
    if (!name[0] || block->layer_count == 0 || !cache_file_path(name, "field", path)) return;
    if (!def->with_fields) unlink(path);
    bool stored = (!def->with_fields || store_fields(path, name, block, &err)) &&
                  store_block(name, block, &err);
    if (!stored)
        snprintf(note, CACHE_NOTE_SIZE, "the upper block is not kept for the next run: %.180s",
                 err.message);
}

static bool make(const FarCacheDef *def, FarBlock *block, Error *err)
{
    const UpperBlock *upper = def->upper;
    const Bulk *bulk = &upper->block.bulk;
    FarField far = {.block = block};
    TRY(far_block_create(bulk, upper->interface_dofs, upper->interface_count, &def->far, block,
                         err));
    if (block->layer_count == 0) goto cleanup;
    TRY(far_field_create(bulk, upper->interface_dofs, upper->interface_count,
                         def->far.scales.stiffness, &far, err));
    TRY(far_field_measure(&far, block, err));
cleanup:
    far_field_destroy(&far);
    return error_is_clean(err);
}

bool far_cache_obtain(const FarCacheDef *def, FarBlock *block, bool *found,
                      char note[CACHE_NOTE_SIZE], Error *err)
{
    char name[HASH_TEXT_SIZE];
    FileLock lock = {0};
    *block = (FarBlock){0};
    find_name(def, name);
    TRY(load(name, def, block, found, note, err));
    if (*found) goto cleanup;
    if (basis_cache_lock(name, &lock)) TRY(load(name, def, block, found, note, err));
    if (*found) goto cleanup;
    TRY(make(def, block, err));
    store(name, def, block, note);
cleanup:
    file_lock_release(&lock);
    return error_is_clean(err);
}
