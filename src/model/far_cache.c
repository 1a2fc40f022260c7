// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/far_cache.h"

#include "base/computation.h"
#include "base/memory.h"
#include "reduction/far_field.h"
#include "model/basis_cache.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { COUNTS = 3 };   // unknowns, patches, couplings

static void find_name(const FarCacheDef *def, char name[HASH_TEXT_SIZE])
{
    const UpperBlock *upper = def->upper;
    Hash hash = computation_hash_bits();
    name[0] = 0;
    if (!def->keep) return;
    hash_number(&hash, def->far.tolerance);
    reduction_block_hash(&upper->block, &upper->mesh, upper->interface_dofs, upper->interface_count,
                         &hash);
    hash_write(&hash, name);
}

static bool take_counts(const CacheFile *file, const char *name, int32_t count, int32_t limit,
                        int32_t **out, Error *err)
{
    *out = NEW_ARRAY(int32_t, count, err);
    return *out && cache_file_whole(file, name, count, limit, *out);
}

// Patches and couplings that are in order; false: they cannot be.
static bool read_lists(const CacheFile *file, int32_t dofs, FarBlock *block, Error *err)
{
    int32_t patches = block->patch_count, couplings = block->coupling_count;
    int32_t *size = NULL, *columns = NULL, *patch = NULL, *before = NULL, *rows = NULL;
    bool sound = take_counts(file, "sizes", patches, dofs, &size, err) &&
                 take_counts(file, "columns", patches, dofs, &columns, err) &&
                 take_counts(file, "patch", couplings, patches, &patch, err) &&
                 take_counts(file, "before", couplings, patches, &before, err) &&
                 take_counts(file, "rows", couplings, dofs, &rows, err);
    for (int32_t p = 0; sound && p < patches; p++) {
        block->patches[p].size = size[p];
        block->patches[p].count = columns[p];
    }
    for (int32_t k = 0; sound && k < couplings; k++) {
        // `before` is stored from 1 on; 0: near.
        block->couplings[k] =
            (FarCoupling){.patch = patch[k], .before = before[k] - 1, .count = rows[k]};
        bool ascends = k == 0 || patch[k] > patch[k - 1] ||
                       (patch[k] == patch[k - 1] && before[k] > before[k - 1]);
        sound = ascends && before[k] - 1 < patch[k] &&
                (before[k] == 0 || rows[k] == columns[before[k] - 1]);
    }
    memory_free(size);
    memory_free(columns);
    memory_free(patch);
    memory_free(before);
    memory_free(rows);
    return sound;
}

// Sizes that are those of the bulk; false: they cannot be.
static bool read_sizes(const CacheFile *file, const UpperBlock *upper, FarBlock *block, Error *err)
{
    int32_t counts[COUNTS], dofs = upper->block.bulk.dof_count;
    if (!cache_file_whole(file, "counts", COUNTS, CACHE_COUNT_LIMIT, counts)) return false;
    if (counts[0] != dofs || counts[1] < 1 || counts[1] > dofs) return false;
    block->dof_count = dofs;
    return far_block_make_lists(counts[1], counts[2], block, err) &&
           read_lists(file, dofs, block, err);
}

// No unknown is replaced twice, and what is near stays so.
static bool is_sound(const FarBlock *block, const UpperBlock *upper, Error *err)
{
    uint8_t *far = NEW_ARRAY(uint8_t, block->dof_count, err);
    bool sound = far != NULL;
    for (int32_t p = 0; p < block->patch_count; p++) {
        const FarPatch *patch = &block->patches[p];
        for (int32_t i = 0; sound && i < patch->size; i++) {
            sound = !far[patch->dofs[i]];
            far[patch->dofs[i]] = 1;
        }
    }
    for (int32_t k = 0; k < block->coupling_count; k++) {
        const FarCoupling *coupling = &block->couplings[k];
        for (int32_t i = 0; sound && coupling->rows && i < coupling->count; i++)
            sound = !far[coupling->rows[i]] &&
                    (i == 0 || coupling->rows[i] > coupling->rows[i - 1]);
    }
    for (int32_t j = 0; sound && j < upper->interface_count; j++)
        sound = !far[upper->interface_dofs[j]];
    memory_free(far);
    return sound;
}

// false without an error: an array is missing, of another length or holds what cannot be.
static bool read_block(const CacheFile *file, const UpperBlock *upper, FarBlock *block, Error *err)
{
    const double *error = cache_file_array(file, "error", 1);
    if (!error || !read_sizes(file, upper, block, err) || !far_block_lay_out(block, err))
        return false;
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
    char path[CACHE_PATH_SIZE];
    CacheFile file = {0};
    cache_file_path(name, "field", path);
    TRY(cache_file_read(path, name, &file, found, reason, err));
    if (!*found) goto cleanup;
    const double *fields = cache_file_array(&file, "fields", block->field_count);
    *found = fields != NULL;
    if (!fields) goto cleanup;
    TRY(far_block_lay_out_fields(block, err));
    memcpy(block->fields, fields, (size_t)block->field_count * sizeof *fields);
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
    const CacheArray fields = {"fields", block->field_count, block->fields};
    return cache_file_write(path, name, &fields, 1, err);
}

static bool store_block(const char *name, const FarBlock *block, Error *err)
{
    char path[CACHE_PATH_SIZE];
    int64_t patches = block->patch_count, couplings = block->coupling_count;
    double counts[COUNTS] = {block->dof_count, block->patch_count, block->coupling_count};
    double *sizes = NEW_ARRAY(double, 2 * patches, err);
    double *patch = NEW_ARRAY(double, 3 * couplings, err);
    double *indices = NEW_ARRAY(double, block->index_count, err);
    if (!sizes || !patch || !indices || !cache_file_path(name, "upper", path)) goto cleanup;
    double *columns = sizes + patches, *before = patch + couplings, *rows = before + couplings;
    for (int64_t k = 0; k < block->index_count; k++) indices[k] = block->indices[k];
    for (int64_t p = 0; p < patches; p++) {
        sizes[p] = block->patches[p].size;
        columns[p] = block->patches[p].count;
    }
    for (int64_t k = 0; k < couplings; k++) {
        patch[k] = block->couplings[k].patch;
        before[k] = block->couplings[k].before + 1;
        rows[k] = block->couplings[k].count;
    }
    CacheArray arrays[] = {{"counts", COUNTS, counts},
                           {"sizes", patches, sizes},
                           {"columns", patches, columns},
                           {"patch", couplings, patch},
                           {"before", couplings, before},
                           {"rows", couplings, rows},
                           {"error", 1, &block->error},
                           {"indices", block->index_count, indices},
                           {"matrices", block->number_count, block->matrices}};
    TRY(cache_file_write(path, name, arrays, sizeof arrays / sizeof *arrays, err));
cleanup:
    memory_free(sizes);
    memory_free(patch);
    memory_free(indices);
    return error_is_clean(err);
}

// Never an error. The fields first: they belong to the block that is there afterwards.
static void store(const char *name, const FarCacheDef *def, const FarBlock *block, char *note)
{
    char path[CACHE_PATH_SIZE];
    Error err = {0};
    if (!name[0] || block->patch_count == 0 || !cache_file_path(name, "field", path)) return;
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
    if (block->patch_count == 0) goto cleanup;
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
