// SPDX-License-Identifier: GPL-2.0-or-later
// A file is read in one piece and its matrices are used where they lie: the reduced bulk takes the
// bytes over. Modes are several times as large and seldom wanted, so they have a file of their own.
#include "model/basis_cache.h"

#include "base/memory.h"
#include "io/cache_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

const char BASIS_FORMAT[] = "basis 13 " AMONTONS_VERSION;

enum { COUNTS = 4 };

// s: the largest basis that model/obtain asks for takes a minute of a core to itself; twice
// the work, done by both, is better than waiting for a process that was stopped.
static const double WAIT_MAX = 300;

// A square matrix within the file's bytes, which `reduced` then owns.
static bool borrow(const CacheFile *file, const char *name, int64_t count, double **array)
{
    *array = (double *)(uintptr_t)cache_file_array(file, name, count);   // nobody writes to it
    return *array != NULL;
}

// false: an array is missing or of another length. The matrices stay where they were read to.
static bool take_basis(CacheFile *file, ReducedBulk *reduced)
{
    int32_t counts[COUNTS];
    if (!cache_file_whole(file, "counts", COUNTS, CACHE_COUNT_LIMIT, counts)) return false;
    if (counts[3] > REDUCTION_LEVELS_MAX) return false;
    ReducedBulk found = {
        .full_dofs = counts[0], .interface_count = counts[1], .interior_count = counts[2]};
    found.count = found.interface_count + found.interior_count;
    found.errors.count = counts[3];
    int64_t m = found.interface_count, all = found.count, levels = found.errors.count;
    const double *inertia = cache_file_array(file, "inertia", levels);
    const double *error = cache_file_array(file, "error", levels);
    bool whole = inertia && error && borrow(file, "mass", all * all, &found.mass) &&
                 borrow(file, "damping", all * all, &found.damping) &&
                 borrow(file, "stiffness", m * m, &found.stiffness) &&
                 borrow(file, "viscous", m * m, &found.viscous) &&
                 borrow(file, "load", all, &found.load);
    if (!whole) return false;
    memcpy(found.errors.inertia, inertia, (size_t)levels * sizeof *inertia);
    memcpy(found.errors.error, error, (size_t)levels * sizeof *error);
    found.storage = file->bytes;
    file->bytes = NULL;
    *reduced = found;
    return true;
}

// *found stays true only if they are there, whole, and of this basis.
static bool load_modes(const char *name, ReducedBulk *reduced, bool *found, char *reason,
                       Error *err)
{
    char path[CACHE_PATH_SIZE];
    CacheFile file = {0};
    int64_t count = (int64_t)reduced->full_dofs * reduced->count;
    cache_file_path(name, "modes", path);
    TRY(cache_file_read(path, name, &file, found, reason, err));
    const double *modes = *found ? cache_file_array(&file, "modes", count) : NULL;
    *found = modes != NULL;
    if (!modes) goto cleanup;
    reduced->modes = NEW_ARRAY(double, count, err);
    if (reduced->modes) memcpy(reduced->modes, modes, (size_t)count * sizeof *modes);
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
    if (*found && !take_basis(&file, reduced)) {
        *found = false;
        snprintf(reason, sizeof reason, "an array is missing");
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

// Processes that write it at once write the same bytes: io/part_file lets one of them through.
static bool store_basis(const char *name, const ReducedBulk *reduced, Error *err)
{
    char path[CACHE_PATH_SIZE];
    int64_t m = reduced->interface_count, all = reduced->count;
    const ReductionErrors *errors = &reduced->errors;
    double counts[COUNTS] = {reduced->full_dofs, reduced->interface_count, reduced->interior_count,
                             errors->count};
    CacheArray modes = {"modes", reduced->full_dofs * all, reduced->modes};
    CacheArray arrays[] = {{"counts", COUNTS, counts},
                           {"inertia", errors->count, errors->inertia},
                           {"error", errors->count, errors->error},
                           {"mass", all * all, reduced->mass},
                           {"damping", all * all, reduced->damping},
                           {"stiffness", m * m, reduced->stiffness},
                           {"viscous", m * m, reduced->viscous},
                           {"load", all, reduced->load}};
    // The modes first: they belong to the basis that is there afterwards.
    if (!cache_file_path(name, "modes", path)) goto cleanup;
    if (reduced->modes)
        TRY(cache_file_write(path, name, &modes, 1, err));
    else
        unlink(path);
    if (!cache_file_path(name, "basis", path)) goto cleanup;
    TRY(cache_file_write(path, name, arrays, sizeof arrays / sizeof *arrays, err));
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
