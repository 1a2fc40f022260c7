// SPDX-License-Identifier: GPL-2.0-or-later
// A file is read in one piece and its matrices are used where they lie: the reduced bulk takes the
// bytes over. Modes are several times as large and seldom wanted, so they have a file of their own.
#include "model/basis_cache.h"

#include "base/memory.h"
#include "io/cache/cache_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

// The whole's sizes, and 1 more than its images where it is put together of two halves, else 0;
// those of a half have names of their own.
enum { COUNTS = 5, HALF_COUNTS = 4 };

typedef struct FoldNames {
    const char *one, *other, *sign;
} FoldNames;
static const FoldNames BORDER_NAMES = {"one", "other", "sign"};
static const FoldNames MESH_NAMES = {"mesh one", "mesh other", "mesh sign"};

// s: the largest basis that model/obtain asks for takes a minute of a core to itself; twice
// the work, done by both, is better than waiting for a process that was stopped.
static const double WAIT_MAX = 300;

// Of an array of half h: 0 or 1; of a basis in one piece h is WHOLE.
enum { WHOLE = -1 };
static const char *name_of(int h, const char *array, char name[CACHE_NAME_SIZE])
{
    if (h == WHOLE)
        snprintf(name, CACHE_NAME_SIZE, "%s", array);
    else
        snprintf(name, CACHE_NAME_SIZE, "%s %d", array, h);
    return name;
}

// An array within the file's bytes, which the whole then owns.
static double *borrow(const CacheFile *file, int h, const char *array, int64_t count)
{
    char name[CACHE_NAME_SIZE];
    return (double *)(uintptr_t)cache_file_array(file, name_of(h, array, name), count);   // nobody
    // writes to it
}

// false: an array is missing or of another length. found: with its sizes.
static bool take_matrices(const CacheFile *file, int h, ReducedBulk *found)
{
    int64_t m = found->interface_count, all = found->count, levels = found->errors.count;
    const double *inertia = borrow(file, h, "inertia", levels);
    const double *error = borrow(file, h, "error", levels);
    found->mass = borrow(file, h, "mass", all * all);
    found->damping = borrow(file, h, "damping", all * all);
    found->stiffness = borrow(file, h, "stiffness", m * m);
    found->viscous = borrow(file, h, "viscous", m * m);
    found->load = borrow(file, h, "load", all);
    if (!inertia || !error || !found->mass || !found->damping || !found->stiffness ||
        !found->viscous || !found->load)
        return false;
    memcpy(found->errors.inertia, inertia, (size_t)levels * sizeof *inertia);
    memcpy(found->errors.error, error, (size_t)levels * sizeof *error);
    return true;
}

static bool take_counts(const CacheFile *file, int h, ReducedBulk *found, int32_t *halved)
{
    char name[CACHE_NAME_SIZE];
    int32_t counts[COUNTS] = {0}, length = h == WHOLE ? COUNTS : HALF_COUNTS;
    if (!cache_file_whole(file, name_of(h, "counts", name), length, CACHE_COUNT_LIMIT, counts) ||
        counts[3] > REDUCTION_LEVELS_MAX)
        return false;
    *found = (ReducedBulk){
        .full_dofs = counts[0], .interface_count = counts[1], .interior_count = counts[2]};
    found->count = counts[1] + counts[2];
    found->errors.count = counts[3];
    *halved = counts[4];
    return true;
}

// Of `fold`, with room for `count`, unknowns of `whole`.
static bool take_fold(const CacheFile *file, int h, const FoldNames *names, int32_t whole,
                      int32_t count, Fold *fold)
{
    char name[CACHE_NAME_SIZE];
    const double *sign = borrow(file, h, names->sign, count);
    if (!sign || !cache_file_whole(file, name_of(h, names->one, name), count, whole, fold->one) ||
        !cache_file_whole(file, name_of(h, names->other, name), count, whole, fold->other))
        return false;
    for (int32_t k = 0; k < count; k++)
        fold_append(fold, fold->one[k], fold->other[k], sign[k] < 0 ? -1 : 1);
    return true;
}

// The sizes of both fit the whole's.
static bool is_split(const ReducedBulk *reduced)
{
    const ReducedBulk *half = reduced->half;
    const Halves *halves = reduced->halves;
    int64_t border = (int64_t)reduced->interface_count + halves->images;
    return (int64_t)half[0].interface_count + half[1].interface_count == border &&
           (int64_t)half[0].full_dofs + half[1].full_dofs == reduced->full_dofs &&
           (int64_t)half[0].count + half[1].count == reduced->count;
}

static bool take_half(const CacheFile *file, int h, ReducedBulk *reduced, bool *found, Error *err)
{
    int32_t none, border = reduced->interface_count + reduced->halves->images;
    ReducedBulk *half = &reduced->half[h];
    Fold *fold = &reduced->halves->border[h];
    *found = take_counts(file, h, half, &none) && take_matrices(file, h, half);
    if (!*found) return true;
    reduced->halves->interior[h] = half->interior_count;
    if (!fold_create(half->interface_count, fold, err)) return false;
    *found = take_fold(file, h, &BORDER_NAMES, border, half->interface_count, fold);
    return true;
}

static bool take_halves(const CacheFile *file, int32_t images, ReducedBulk *reduced, bool *found,
                        Error *err)
{
    int64_t m = reduced->interface_count, n = images;
    Halves *halves = reduced->halves = NEW_ARRAY(Halves, 1, err);
    reduced->half = NEW_ARRAY(ReducedBulk, 2, err);
    const double *follow = borrow(file, WHOLE, "follow", n * m);
    const double *lower = borrow(file, WHOLE, "lower", n * n);
    if (!error_is_clean(err)) goto cleanup;
    *halves = (Halves){.interface_count = (int32_t)m, .images = images};
    reduced->load = borrow(file, WHOLE, "load", reduced->count);
    *found = reduced->load && follow && lower;
    for (int h = 0; *found && h < 2; h++) TRY(take_half(file, h, reduced, found, err));
    *found = *found && is_split(reduced);
    if (!*found) goto cleanup;
    halves->at_rest.follow = NEW_ARRAY(double, n *m, err);
    halves->at_rest.lower = NEW_ARRAY(double, n *n, err);
    if (!error_is_clean(err)) goto cleanup;
    memcpy(halves->at_rest.follow, follow, (size_t)(n * m) * sizeof *follow);
    memcpy(halves->at_rest.lower, lower, (size_t)(n * n) * sizeof *lower);
cleanup:
    return error_is_clean(err);
}

// The matrices stay where they were read to, whatever is found.
static bool take_basis(CacheFile *file, ReducedBulk *reduced, bool *found, Error *err)
{
    int32_t halved = 0;
    *found = take_counts(file, WHOLE, reduced, &halved);
    reduced->storage = file->bytes;
    file->bytes = NULL;
    if (!*found) return true;
    if (halved > 0) return take_halves(file, halved - 1, reduced, found, err);
    *found = take_matrices(file, WHOLE, reduced);
    return true;
}

static bool take_modes(const CacheFile *file, int h, ReducedBulk *reduced, bool *found, Error *err)
{
    int64_t count = (int64_t)reduced->full_dofs * reduced->count;
    const double *modes = borrow(file, h, "modes", count);
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
    if (*found && !reduced->half) TRY(take_modes(&file, WHOLE, reduced, found, err));
    for (int h = 0; *found && reduced->half && h < 2; h++) {
        ReducedBulk *half = &reduced->half[h];
        Fold *fold = &reduced->halves->mesh[h];
        TRY(fold_create(half->full_dofs, fold, err));
        TRY(take_modes(&file, h, half, found, err));
        *found = *found &&
                 take_fold(&file, h, &MESH_NAMES, reduced->full_dofs, half->full_dofs, fold);
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

static void put(Writing *file, int h, const char *array, int64_t count, const double *values)
{
    CacheArray *next = &file->arrays[file->count++];
    name_of(h, array, next->name);
    next->count = count;
    next->values = values;
}

static bool put_fold(Writing *file, int h, const FoldNames *names, const Fold *fold, Error *err)
{
    double *one = file->copies[file->copy_count++] = NEW_ARRAY(double, fold->count, err);
    double *other = file->copies[file->copy_count++] = NEW_ARRAY(double, fold->count, err);
    for (int32_t k = 0; one && other && k < fold->count; k++) {
        one[k] = fold->one[k];
        other[k] = fold->other[k];
    }
    put(file, h, names->one, fold->count, one);
    put(file, h, names->other, fold->count, other);
    put(file, h, names->sign, fold->count, fold->sign);
    return error_is_clean(err);
}

static void put_matrices(Writing *file, int h, const ReducedBulk *reduced, const double *counts)
{
    int64_t m = reduced->interface_count, all = reduced->count, levels = reduced->errors.count;
    put(file, h, "counts", h == WHOLE ? COUNTS : HALF_COUNTS, counts);
    put(file, h, "load", all, reduced->load);
    if (reduced->half) return;
    put(file, h, "inertia", levels, reduced->errors.inertia);
    put(file, h, "error", levels, reduced->errors.error);
    put(file, h, "mass", all * all, reduced->mass);
    put(file, h, "damping", all * all, reduced->damping);
    put(file, h, "stiffness", m * m, reduced->stiffness);
    put(file, h, "viscous", m * m, reduced->viscous);
}

static void list_counts(const ReducedBulk *reduced, double counts[COUNTS])
{
    counts[0] = reduced->full_dofs;
    counts[1] = reduced->interface_count;
    counts[2] = reduced->interior_count;
    counts[3] = reduced->errors.count;
    counts[4] = reduced->halves ? 1 + reduced->halves->images : 0;
}

static bool write_basis(const char *path, const char *name, const ReducedBulk *reduced, Error *err)
{
    double counts[3][COUNTS];
    const Halves *halves = reduced->halves;
    Writing file = {0};
    list_counts(reduced, counts[2]);
    put_matrices(&file, WHOLE, reduced, counts[2]);
    for (int h = 0; halves && h < 2; h++) {
        list_counts(&reduced->half[h], counts[h]);
        put_matrices(&file, h, &reduced->half[h], counts[h]);
        TRY(put_fold(&file, h, &BORDER_NAMES, &halves->border[h], err));
    }
    if (halves) {
        int64_t m = halves->interface_count, n = halves->images;
        put(&file, WHOLE, "follow", n * m, halves->at_rest.follow);
        put(&file, WHOLE, "lower", n * n, halves->at_rest.lower);
    }
    TRY(cache_file_write(path, name, file.arrays, file.count, err));
cleanup:
    writing_destroy(&file);
    return error_is_clean(err);
}

static bool write_modes(const char *path, const char *name, const ReducedBulk *reduced, Error *err)
{
    Writing file = {0};
    for (int h = 0; reduced->half && h < 2; h++) {
        const ReducedBulk *half = &reduced->half[h];
        put(&file, h, "modes", (int64_t)half->full_dofs * half->count, half->modes);
        TRY(put_fold(&file, h, &MESH_NAMES, &reduced->halves->mesh[h], err));
    }
    if (!reduced->half)
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
