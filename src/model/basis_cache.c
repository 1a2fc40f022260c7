// SPDX-License-Identifier: GPL-2.0-or-later
// A file is read in one piece and its matrices are used where they lie: the reduced bulk takes the
// bytes over. Modes are several times as large and seldom wanted, so they have a file of their own.
#include "model/basis_cache.h"

static void archive_sizes(ReducedBulk *reduced, Archive *archive)
{
    archive_length(archive, &reduced->full_dofs);
    archive_length(archive, &reduced->interface_count);
    archive_length(archive, &reduced->interior_count);
    reduced->count = reduced->interface_count + reduced->interior_count;
    archive_lend_numbers(archive, &reduced->load, reduced->count);
}

static void archive_matrices(ReducedBulk *reduced, Archive *archive)
{
    int64_t m = reduced->interface_count, all = reduced->count;
    ReductionErrors *errors = &reduced->errors;
    archive_index(archive, &errors->count, 0, REDUCTION_LEVELS_MAX + 1);
    archive_numbers(archive, errors->inertia, errors->count);
    archive_numbers(archive, errors->error, errors->count);
    archive_lend_numbers(archive, &reduced->mass, all * all);
    archive_lend_numbers(archive, &reduced->damping, all * all);
    archive_lend_numbers(archive, &reduced->stiffness, m * m);
    archive_lend_numbers(archive, &reduced->viscous, m * m);
}

// Of `count` unknowns of `whole`.
static void archive_pairs(Transform *by, int32_t count, int32_t whole, Archive *archive)
{
    if (archive_fills(archive))
        archive_require(archive, transform_create(whole, count, whole, by, archive->err));
    for (int32_t k = 0; k < count; k++) {
        int32_t pair[2] = {0};
        double sign = 1;
        if (!archive_reads(archive)) {
            const TransformBlock *block = &by->blocks[k];
            pair[0] = block->rows[0];
            pair[1] = block->rows[block->size - 1];
            sign = block->values[block->size - 1];
        }
        archive_indices(archive, pair, 2, 0, whole);
        archive_number(archive, &sign);
        if (!archive_fills(archive)) continue;
        archive_require(archive,
                        by->block_of[pair[0]] == NO_BLOCK && by->block_of[pair[1]] == NO_BLOCK);
        if (archive_fills(archive)) transform_append_pair(by, pair[0], pair[1], sign < 0 ? -1 : 1);
    }
}

static void archive_parts(ReducedBulk *reduced, Archive *archive)
{
    int32_t m = reduced->interface_count;
    SymmetryParts *symmetry = reduced->symmetry =
        archive_new(archive, reduced->symmetry, 1, sizeof *symmetry);
    ReducedBulk *part = reduced->part = archive_new(archive, reduced->part, 2, sizeof *part);
    if (!symmetry || !part) return;
    archive_length(archive, &symmetry->mirrored);
    int32_t n = symmetry->mirrored, border = m + n;
    symmetry->interface_count = m;
    archive_new_numbers(archive, &symmetry->at_rest.follow, (int64_t)n * m);
    archive_new_numbers(archive, &symmetry->at_rest.lower, (int64_t)n * n);
    for (int p = 0; p < 2; p++) {
        archive_sizes(&part[p], archive);
        archive_matrices(&part[p], archive);
        symmetry->interior[p] = part[p].interior_count;
        archive_pairs(&symmetry->border[p], part[p].interface_count, border, archive);
    }
    archive_require(archive, part[0].interface_count + part[1].interface_count == border &&
                                 part[0].full_dofs + part[1].full_dofs == reduced->full_dofs &&
                                 part[0].count + part[1].count == reduced->count);
}

static void archive_basis(void *self, Archive *archive)
{
    ReducedBulk *reduced = self;
    bool parted = reduced->symmetry != NULL;
    archive_sizes(reduced, archive);
    archive_flag(archive, &parted);
    if (parted)
        archive_parts(reduced, archive);
    else
        archive_matrices(reduced, archive);
}

// Of a basis that is there.
static void archive_modes(void *self, Archive *archive)
{
    ReducedBulk *reduced = self, *part = reduced->part;
    if (!part)
        archive_new_numbers(archive, &reduced->modes, (int64_t)reduced->full_dofs * reduced->count);
    for (int p = 0; part && p < 2; p++) {
        archive_new_numbers(archive, &part[p].modes, (int64_t)part[p].full_dofs * part[p].count);
        archive_pairs(&reduced->symmetry->mesh[p], part[p].full_dofs, reduced->full_dofs, archive);
    }
}

bool basis_cache_load(const char *name, bool with_modes, ReducedBulk *reduced, bool *found,
                      char note[CACHE_NOTE_SIZE], Error *err)
{
    const CacheItem basis = {CACHE_BASIS, name, archive_basis, reduced};
    const CacheItem modes = {CACHE_MODES, name, archive_modes, reduced};
    *reduced = (ReducedBulk){0};
    TRY(cache_load(&basis, &reduced->storage, found, note, err));
    if (*found && with_modes) TRY(cache_load(&modes, NULL, found, note, err));
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
    if (!reduced_bulk_has_modes(reduced))
        cache_remove(CACHE_MODES, name);
    else if (!cache_store(&(CacheItem){CACHE_MODES, name, archive_modes, &same}, note))
        return false;
    return cache_store(&(CacheItem){CACHE_BASIS, name, archive_basis, &same}, note);
}
