// SPDX-License-Identifier: GPL-2.0-or-later
// Modes are several times as large as the rest and seldom wanted, so they have a file of their own.
#include "model/basis_cache.h"

#include <math.h>

// Archives the images of `count` unknowns among `whole`; T = 1 where these are all.
static void archive_images(Transform *by, int32_t count, int32_t whole, Archive *archive)
{
    if (archive_fills(archive)) *by = (Transform){.size = whole, .count = count};
    if (count == whole) return;
    if (archive_fills(archive))
        archive_require(archive, transform_create(whole, count, whole, by, archive->err));
    for (int32_t k = 0; k < count; k++) {
        int32_t rows[REDUCED_PARTS_MAX] = {0}, size = 1;
        double signs[REDUCED_PARTS_MAX] = {0};
        if (!archive_reads(archive)) {
            const TransformBlock *block = &by->blocks[k];
            size = block->size;
            for (int32_t i = 0; i < size; i++) rows[i] = block->rows[i];
            for (int32_t i = 0; i < size; i++) signs[i] = block->values[i] < 0 ? -1 : 1;
        }
        archive_index(archive, &size, 1, REDUCED_PARTS_MAX + 1);
        if (archive->failed) return;
        archive_indices(archive, rows, size, 0, whole);
        archive_numbers(archive, signs, size);
        if (archive_reads(archive)) archive_require(archive, by->row_count + size <= whole);
        for (int32_t i = 0; archive_fills(archive) && i < size; i++)
            archive_require(archive, by->block_of[rows[i]] == NO_BLOCK && fabs(signs[i]) == 1);
        if (archive_fills(archive)) transform_append_images(by, rows, size, signs);
    }
}

static void archive_basis(void *self, Archive *archive)
{
    ReducedBulk *reduced = self;
    archive_index(archive, &reduced->dim, 2, DIM_MAX + 1);
    archive_number(archive, &reduced->area);
    archive_length(archive, &reduced->interface_count);
    archive_length(archive, &reduced->mirrored);
    archive_length(archive, &reduced->count);
    archive_index(archive, &reduced->part_count, 1, REDUCED_PARTS_MAX + 1);
    int32_t m = reduced->interface_count, n = reduced->mirrored, left = reduced->count - m - n;
    int32_t border = m + n, dofs = 0;
    archive_new_numbers(archive, &reduced->load, reduced->count);
    archive_new_numbers(archive, &reduced->rigid, (int64_t)rigid_count(reduced->dim) * (m + n));
    archive_require(archive, left >= 0);
    for (int p = 0; p < reduced->part_count; p++) {
        ReducedPart *part = &reduced->part[p];
        ReductionErrors *errors = &part->errors;
        archive_length(archive, &part->full_dofs);
        archive_length(archive, &part->border_count);
        archive_length(archive, &part->interior_count);
        part->count = part->border_count + part->interior_count;
        int64_t own = part->border_count, all = part->count;
        archive_require(archive, all > 0);
        archive_index(archive, &errors->count, 0, REDUCTION_LEVELS_MAX + 1);
        archive_numbers(archive, errors->inertia, errors->count);
        archive_numbers(archive, errors->error, errors->count);
        archive_new_numbers(archive, &part->load, all);
        archive_new_numbers(archive, &part->mass, own * own);
        archive_new_numbers(archive, &part->coupling, (all - own) * own);
        archive_new_numbers(archive, &part->masses, all - own);
        archive_new_numbers(archive, &part->damping, all * all);
        archive_new_numbers(archive, &part->stiffness, own * own);
        archive_index(archive, &part->shape_count, 0, SPECTRUM_SHAPES_MAX + 1);
        for (int32_t j = 0; j < part->shape_count; j++)
            archive_new_numbers(archive, &part->shape[j], all * all);
        archive_images(&part->border, part->border_count, m + n, archive);
        border -= part->border_count;
        left -= part->interior_count;
        dofs += part->full_dofs;
    }
    archive_require(archive, border == 0 && left == 0);
    reduced->full_dofs = dofs;
}

// Archives the modes of a basis that is there already.
static void archive_modes(void *self, Archive *archive)
{
    ReducedBulk *reduced = self;
    for (int p = 0; p < reduced->part_count; p++) {
        ReducedPart *part = &reduced->part[p];
        archive_new_numbers(archive, &part->modes, (int64_t)part->full_dofs * part->count);
        archive_images(&part->mesh, part->full_dofs, reduced->full_dofs, archive);
    }
}

bool basis_cache_load(const char *name, bool with_modes, ReducedBulk *reduced, bool *found,
                      char note[CACHE_NOTE_SIZE], Error *err)
{
    const CacheItem basis = {CACHE_BASIS, name, archive_basis, reduced};
    const CacheItem modes = {CACHE_MODES, name, archive_modes, reduced};
    *reduced = (ReducedBulk){0};
    TRY(cache_load(&basis, found, note, err));
    if (*found && with_modes) TRY(cache_load(&modes, found, note, err));
cleanup:
    if (!*found || !error_is_clean(err)) reduced_bulk_destroy(reduced);
    return error_is_clean(err);
}

// The modes first: they belong to the basis that is there afterwards. Processes that write it at
// once write the same bytes: io/files/part_file lets one of them through.
bool basis_cache_store(const char *name, const ReducedBulk *reduced, char note[CACHE_NOTE_SIZE])
{
    ReducedBulk same = *reduced;
    if (!name[0]) return false;
    if (!reduced->part[0].modes)
        cache_remove(CACHE_MODES, name);
    else if (!cache_store(&(CacheItem){CACHE_MODES, name, archive_modes, &same}, note))
        return false;
    return cache_store(&(CacheItem){CACHE_BASIS, name, archive_basis, &same}, note);
}
