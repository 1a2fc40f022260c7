// SPDX-License-Identifier: GPL-2.0-or-later
// A file is read in one piece and its matrices are used where they lie: the reduced bulk takes the
// bytes over. Modes are several times as large and seldom wanted, so they have a file of their own.
#include "model/basis_cache.h"

#include "base/memory.h"
#include "io/cache/cache_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// The whole's sizes, and 1 more than its mirrored unknowns where it is put together of two parts,
// else 0; those of a part have names of their own.
enum { COUNTS = 5, PART_COUNTS = 4 };

typedef struct MapNames {
    const char *one, *other, *sign;
} MapNames;
static const MapNames BORDER_NAMES = {"one", "other", "sign"};
static const MapNames MESH_NAMES = {"mesh one", "mesh other", "mesh sign"};

// s: the largest basis that model/obtain asks for takes a minute of a core to itself; twice
// the work, done by both, is better than waiting for a process that was stopped.
static const double WAIT_MAX = 300;

// Of an array of part p: 0 or 1; of a basis in one piece p is WHOLE.
enum { WHOLE = -1 };
static const char *name_of(int p, const char *array, char name[CACHE_NAME_SIZE])
{
    if (p == WHOLE)
        snprintf(name, CACHE_NAME_SIZE, "%s", array);
    else
        snprintf(name, CACHE_NAME_SIZE, "%s %d", array, p);
    return name;
}

// An array within the file's bytes, which the whole then owns.
static double *borrow(const CacheFile *file, int p, const char *array, int64_t count)
{
    char name[CACHE_NAME_SIZE];
    return (double *)(uintptr_t)cache_file_array(file, name_of(p, array, name), count);   // nobody
    // writes to it
}

// false: an array is missing or of another length. found: with its sizes.
static bool take_matrices(const CacheFile *file, int p, ReducedBulk *found)
{
    int64_t m = found->interface_count, all = found->count, levels = found->errors.count;
    const double *inertia = borrow(file, p, "inertia", levels);
    const double *error = borrow(file, p, "error", levels);
    found->mass = borrow(file, p, "mass", all * all);
    found->damping = borrow(file, p, "damping", all * all);
    found->stiffness = borrow(file, p, "stiffness", m * m);
    found->viscous = borrow(file, p, "viscous", m * m);
    found->load = borrow(file, p, "load", all);
    if (!inertia || !error || !found->mass || !found->damping || !found->stiffness ||
        !found->viscous || !found->load)
        return false;
    memcpy(found->errors.inertia, inertia, (size_t)levels * sizeof *inertia);
    memcpy(found->errors.error, error, (size_t)levels * sizeof *error);
    return true;
}

static bool take_counts(const CacheFile *file, int p, ReducedBulk *found, int32_t *parted)
{
    char name[CACHE_NAME_SIZE];
    int32_t counts[COUNTS] = {0}, length = p == WHOLE ? COUNTS : PART_COUNTS;
    if (!cache_file_whole(file, name_of(p, "counts", name), length, CACHE_COUNT_LIMIT, counts) ||
        counts[3] > REDUCTION_LEVELS_MAX)
        return false;
    *found = (ReducedBulk){
        .full_dofs = counts[0], .interface_count = counts[1], .interior_count = counts[2]};
    found->count = counts[1] + counts[2];
    found->errors.count = counts[3];
    *parted = counts[4];
    return true;
}

// Of `map`, with room for `count`, unknowns of `whole`.
static bool take_map(const CacheFile *file, int p, const MapNames *names, int32_t whole,
                     int32_t count, SymmetryMap *map)
{
    char name[CACHE_NAME_SIZE];
    const double *sign = borrow(file, p, names->sign, count);
    if (!sign || !cache_file_whole(file, name_of(p, names->one, name), count, whole, map->one) ||
        !cache_file_whole(file, name_of(p, names->other, name), count, whole, map->other))
        return false;
    for (int32_t k = 0; k < count; k++)
        symmetry_map_append(map, map->one[k], map->other[k], sign[k] < 0 ? -1 : 1);
    return true;
}

// The sizes of both fit the whole's.
static bool is_split(const ReducedBulk *reduced)
{
    const ReducedBulk *part = reduced->part;
    const SymmetryParts *symmetry = reduced->symmetry;
    int64_t border = (int64_t)reduced->interface_count + symmetry->mirrored;
    return (int64_t)part[0].interface_count + part[1].interface_count == border &&
           (int64_t)part[0].full_dofs + part[1].full_dofs == reduced->full_dofs &&
           (int64_t)part[0].count + part[1].count == reduced->count;
}

static bool take_part(const CacheFile *file, int p, ReducedBulk *reduced, bool *found, Error *err)
{
    int32_t none, border = reduced->interface_count + reduced->symmetry->mirrored;
    ReducedBulk *part = &reduced->part[p];
    SymmetryMap *map = &reduced->symmetry->border[p];
    *found = take_counts(file, p, part, &none) && take_matrices(file, p, part);
    if (!*found) return true;
    reduced->symmetry->interior[p] = part->interior_count;
    if (!symmetry_map_create(part->interface_count, map, err)) return false;
    *found = take_map(file, p, &BORDER_NAMES, border, part->interface_count, map);
    return true;
}

static bool take_parts(const CacheFile *file, int32_t mirrored, ReducedBulk *reduced, bool *found,
                       Error *err)
{
    int64_t m = reduced->interface_count, n = mirrored;
    SymmetryParts *symmetry = reduced->symmetry = NEW_ARRAY(SymmetryParts, 1, err);
    reduced->part = NEW_ARRAY(ReducedBulk, 2, err);
    const double *follow = borrow(file, WHOLE, "follow", n * m);
    const double *lower = borrow(file, WHOLE, "lower", n * n);
    if (!error_is_clean(err)) goto cleanup;
    *symmetry = (SymmetryParts){.interface_count = (int32_t)m, .mirrored = mirrored};
    reduced->load = borrow(file, WHOLE, "load", reduced->count);
    *found = reduced->load && follow && lower;
    for (int p = 0; *found && p < 2; p++) TRY(take_part(file, p, reduced, found, err));
    *found = *found && is_split(reduced);
    if (!*found) goto cleanup;
    symmetry->at_rest.follow = NEW_ARRAY(double, n *m, err);
    symmetry->at_rest.lower = NEW_ARRAY(double, n *n, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(symmetry->at_rest.follow, follow, (size_t)(n * m) * sizeof *follow);
    memcpy(symmetry->at_rest.lower, lower, (size_t)(n * n) * sizeof *lower);
cleanup:
    return error_is_clean(err);
}

// The matrices stay where they were read to, whatever is found.
static bool take_basis(CacheFile *file, ReducedBulk *reduced, bool *found, Error *err)
{
    int32_t parted = 0;
    *found = take_counts(file, WHOLE, reduced, &parted);
    reduced->storage = file->bytes;
    file->bytes = NULL;
    if (!*found) return true;
    if (parted > 0) return take_parts(file, parted - 1, reduced, found, err);
    *found = take_matrices(file, WHOLE, reduced);
    return true;
}

static bool take_modes(const CacheFile *file, int p, ReducedBulk *reduced, bool *found, Error *err)
{
    int64_t count = (int64_t)reduced->full_dofs * reduced->count;
    const double *modes = borrow(file, p, "modes", count);
    *found = modes != NULL;
    if (!modes) return true;
    reduced->modes = NEW_ARRAY(double, count, err);
    if (reduced->modes) memcpy(reduced->modes, modes, (size_t)count * sizeof *modes);
    return reduced->modes;
}

// *found stays true only if they are there, whole, and of this basis.
static bool load_modes(const char *name, ReducedBulk *reduced, bool *found, char *reason,
                       Error *err)
{
    char path[CACHE_PATH_SIZE];
    CacheFile file = {0};
    cache_file_path(name, "modes", path);
    TRY(cache_file_read(path, name, &file, found, reason, err));
    if (*found && !reduced->part) TRY(take_modes(&file, WHOLE, reduced, found, err));
    for (int p = 0; *found && reduced->part && p < 2; p++) {
        ReducedBulk *part = &reduced->part[p];
        SymmetryMap *map = &reduced->symmetry->mesh[p];
        TRY(symmetry_map_create(part->full_dofs, map, err));
        TRY(take_modes(&file, p, part, found, err));
        *found = *found &&
                 take_map(&file, p, &MESH_NAMES, reduced->full_dofs, part->full_dofs, map);
    }
cleanup:
    cache_file_destroy(&file);
    return error_is_clean(err);
}

bool basis_cache_load(const char *name, bool with_modes, ReducedBulk *reduced, bool *found,
                      char note[CACHE_NOTE_SIZE], Error *err)
{
    char path[CACHE_PATH_SIZE], reason[CACHE_REASON_SIZE] = "";
    CacheFile file = {0};
    *reduced = (ReducedBulk){0};
    *found = false;
    if (!name[0] || !cache_file_path(name, "basis", path)) goto cleanup;
    TRY(cache_file_read(path, name, &file, found, reason, err));
    if (*found) {
        TRY(take_basis(&file, reduced, found, err));
        if (!*found) snprintf(reason, sizeof reason, "an array is missing");
    }
    if (*found && with_modes) TRY(load_modes(name, reduced, found, reason, err));
    if (reason[0]) snprintf(note, CACHE_NOTE_SIZE, "a cached basis is not used: %s", reason);
cleanup:
    cache_file_destroy(&file);
    if (!*found || !error_is_clean(err)) reduced_bulk_destroy(reduced);
    return error_is_clean(err);
}

bool basis_cache_lock(const char *name, FileLock *lock)
{
    char path[CACHE_PATH_SIZE];
    *lock = (FileLock){0};
    return name[0] && cache_file_path(name, "lock", path) && file_lock_take(lock, path, WAIT_MAX);
}

// Arrays of a file that is to be written. What is not at hand as numbers is copied.
typedef struct Writing {
    CacheArray arrays[CACHE_ARRAYS_MAX];
    int32_t count;
    double *copies[CACHE_ARRAYS_MAX];   // owned
    int32_t copy_count;
} Writing;

static void writing_destroy(Writing *file)
{
    for (int32_t k = 0; k < file->copy_count; k++) memory_free(file->copies[k]);
}

static void put(Writing *file, int p, const char *array, int64_t count, const double *values)
{
    CacheArray *next = &file->arrays[file->count++];
    name_of(p, array, next->name);
    next->count = count;
    next->values = values;
}

static bool put_map(Writing *file, int p, const MapNames *names, const SymmetryMap *map, Error *err)
{
    double *one = file->copies[file->copy_count++] = NEW_ARRAY(double, map->count, err);
    double *other = file->copies[file->copy_count++] = NEW_ARRAY(double, map->count, err);
    for (int32_t k = 0; one && other && k < map->count; k++) {
        one[k] = map->one[k];
        other[k] = map->other[k];
    }
    put(file, p, names->one, map->count, one);
    put(file, p, names->other, map->count, other);
    put(file, p, names->sign, map->count, map->sign);
    return error_is_clean(err);
}

static void put_matrices(Writing *file, int p, const ReducedBulk *reduced, const double *counts)
{
    int64_t m = reduced->interface_count, all = reduced->count, levels = reduced->errors.count;
    put(file, p, "counts", p == WHOLE ? COUNTS : PART_COUNTS, counts);
    put(file, p, "load", all, reduced->load);
    if (reduced->part) return;
    put(file, p, "inertia", levels, reduced->errors.inertia);
    put(file, p, "error", levels, reduced->errors.error);
    put(file, p, "mass", all * all, reduced->mass);
    put(file, p, "damping", all * all, reduced->damping);
    put(file, p, "stiffness", m * m, reduced->stiffness);
    put(file, p, "viscous", m * m, reduced->viscous);
}

static void list_counts(const ReducedBulk *reduced, double counts[COUNTS])
{
    counts[0] = reduced->full_dofs;
    counts[1] = reduced->interface_count;
    counts[2] = reduced->interior_count;
    counts[3] = reduced->errors.count;
    counts[4] = reduced->symmetry ? 1 + reduced->symmetry->mirrored : 0;
}

static bool write_basis(const char *path, const char *name, const ReducedBulk *reduced, Error *err)
{
    double counts[3][COUNTS];
    const SymmetryParts *symmetry = reduced->symmetry;
    Writing file = {0};
    list_counts(reduced, counts[2]);
    put_matrices(&file, WHOLE, reduced, counts[2]);
    for (int p = 0; symmetry && p < 2; p++) {
        list_counts(&reduced->part[p], counts[p]);
        put_matrices(&file, p, &reduced->part[p], counts[p]);
        TRY(put_map(&file, p, &BORDER_NAMES, &symmetry->border[p], err));
    }
    if (symmetry) {
        int64_t m = symmetry->interface_count, n = symmetry->mirrored;
        put(&file, WHOLE, "follow", n * m, symmetry->at_rest.follow);
        put(&file, WHOLE, "lower", n * n, symmetry->at_rest.lower);
    }
    TRY(cache_file_write(path, name, file.arrays, file.count, err));
cleanup:
    writing_destroy(&file);
    return error_is_clean(err);
}

static bool write_modes(const char *path, const char *name, const ReducedBulk *reduced, Error *err)
{
    Writing file = {0};
    for (int p = 0; reduced->part && p < 2; p++) {
        const ReducedBulk *part = &reduced->part[p];
        put(&file, p, "modes", (int64_t)part->full_dofs * part->count, part->modes);
        TRY(put_map(&file, p, &MESH_NAMES, &reduced->symmetry->mesh[p], err));
    }
    if (!reduced->part)
        put(&file, WHOLE, "modes", (int64_t)reduced->full_dofs * reduced->count, reduced->modes);
    TRY(cache_file_write(path, name, file.arrays, file.count, err));
cleanup:
    writing_destroy(&file);
    return error_is_clean(err);
}

// Processes that write it at once write the same bytes: io/files/part_file lets one of them
// through.
static bool store_basis(const char *name, const ReducedBulk *reduced, Error *err)
{
    char path[CACHE_PATH_SIZE];
    // The modes first: they belong to the basis that is there afterwards.
    if (!cache_file_path(name, "modes", path)) goto cleanup;
    if (reduced_bulk_has_modes(reduced))
        TRY(write_modes(path, name, reduced, err));
    else
        unlink(path);
    if (!cache_file_path(name, "basis", path)) goto cleanup;
    TRY(write_basis(path, name, reduced, err));
cleanup:
    return error_is_clean(err);
}

bool basis_cache_store(const char *name, const ReducedBulk *reduced, char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    if (!name[0]) return false;
    bool stored = store_basis(name, reduced, &err);
    if (!stored)
        snprintf(note, CACHE_NOTE_SIZE, "the basis is not kept for the next run: %.180s",
                 err.message);
    return stored;
}
