// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/far_cache.h"

#include "base/computation.h"
#include "base/memory.h"
#include "reduction/far_field.h"
#include "io/cache/store.h"

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

// Patches and couplings, and room for what they count.
static void archive_lists(FarBlock *block, Archive *archive)
{
    int32_t patches = block->patch_count, couplings = block->coupling_count;
    archive_index(archive, &patches, 1, block->dof_count + 1);
    archive_length(archive, &couplings);
    if (archive_fills(archive))
        archive_require(archive, far_block_make_lists(patches, couplings, block, archive->err));
    for (int32_t p = 0; !archive->failed && p < patches; p++) {
        archive_index(archive, &block->patches[p].size, 0, block->dof_count);
        archive_index(archive, &block->patches[p].count, 0, block->dof_count);
    }
    for (int32_t k = 0; !archive->failed && k < couplings; k++) {
        FarCoupling *coupling = &block->couplings[k], *last = &block->couplings[k > 0 ? k - 1 : 0];
        archive_index(archive, &coupling->patch, 0, patches);
        archive_index(archive, &coupling->before, NO_PATCH, patches);
        archive_index(archive, &coupling->count, 0, block->dof_count);
        archive_require(archive, coupling->before < coupling->patch);
        archive_require(archive,
                        k == 0 || coupling->patch > last->patch ||
                            (coupling->patch == last->patch && coupling->before > last->before));
        if (!archive->failed && coupling->before != NO_PATCH)
            archive_require(archive, coupling->count == block->patches[coupling->before].count);
    }
    if (archive_fills(archive)) archive_require(archive, far_block_lay_out(block, archive->err));
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

typedef struct Kept {
    FarBlock *block;
    const UpperBlock *upper;   // that it is of
} Kept;

static void archive_block(void *self, Archive *archive)
{
    const Kept *kept = self;
    FarBlock *block = kept->block;
    archive_number(archive, &block->error);
    archive_lists(block, archive);
    archive_indices(archive, block->indices, block->index_count, 0, block->dof_count);
    archive_numbers(archive, block->matrices, block->number_count);
    if (archive_fills(archive))
        archive_require(archive, is_sound(block, kept->upper, archive->err));
}

// Of a block that is there.
static void archive_fields(void *self, Archive *archive)
{
    FarBlock *block = ((const Kept *)self)->block;
    if (archive_fills(archive))
        archive_require(archive, far_block_lay_out_fields(block, archive->err));
    archive_numbers(archive, block->fields, block->field_count);
}

static bool load(const char *name, const FarCacheDef *def, FarBlock *block, bool *found, char *note,
                 Error *err)
{
    Kept kept = {block, def->upper};
    block->dof_count = def->upper->block.bulk.dof_count;
    TRY(cache_load(&(CacheItem){CACHE_UPPER, name, archive_block, &kept}, NULL, found, note, err));
    if (*found && def->with_fields)
        TRY(cache_load(&(CacheItem){CACHE_FIELD, name, archive_fields, &kept}, NULL, found, note,
                       err));
cleanup:
    *found = *found && error_is_clean(err);
    if (!*found) far_block_destroy(block);
    return error_is_clean(err);
}

// Never an error. The fields first: they belong to the block that is there afterwards.
static void store(const char *name, const FarCacheDef *def, FarBlock *block, char *note)
{
    Kept kept = {block, def->upper};
    if (block->patch_count == 0) return;
    if (!def->with_fields)
        cache_remove(CACHE_FIELD, name);
    else if (!cache_store(&(CacheItem){CACHE_FIELD, name, archive_fields, &kept}, note))
        return;
    cache_store(&(CacheItem){CACHE_UPPER, name, archive_block, &kept}, note);
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
    if (cache_lock(name, &lock)) TRY(load(name, def, block, found, note, err));
    if (*found) goto cleanup;
    TRY(make(def, block, err));
    store(name, def, block, note);
cleanup:
    file_lock_release(&lock);
    return error_is_clean(err);
}
