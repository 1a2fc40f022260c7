// SPDX-License-Identifier: GPL-2.0-or-later
// Functions of io/cache/cache_folder for `amontons cache`.
#include "amontons_cache.h"
#include "base/decimal_point.h"
#include "io/cache/cache_folder.h"

#include <stdio.h>

// A path that is too long for AMONTONS_PATH_SIZE is cut: it is shown only.
static bool summarise(const CacheFolder *folder, CacheSummary *summary, Error *err)
{
    *summary = (CacheSummary){.files = folder->count, .bytes = folder->bytes};
    snprintf(summary->folder, sizeof summary->folder, "%.*s", AMONTONS_PATH_SIZE - 1, folder->path);
    return cache_folder_limit(&summary->limit, err);
}

bool amontons_cache_list(CacheCallback on_entry, void *context, CacheSummary *summary, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    CacheFolder folder = {0};
    TRY(cache_folder_read(&folder, err));
    TRY(summarise(&folder, summary, err));
    for (int32_t k = 0; on_entry && k < folder.count; k++) {
        CacheEntry entry = {.name = folder.entries[k].name,
                            .bytes = folder.entries[k].bytes,
                            .used = folder.entries[k].used};
        on_entry(&entry, context);
    }
cleanup:
    cache_folder_destroy(&folder);
    return error_is_clean(err);
}

bool amontons_cache_clean(CacheSummary *removed, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    CacheFolder folder = {0};
    TRY(cache_folder_read(&folder, err));
    TRY(summarise(&folder, removed, err));
    removed->files = cache_folder_trim(&folder, -1, NULL, &removed->bytes);
    int32_t failed = 0;
    for (int32_t k = 0; k < folder.count; k++) failed += folder.entries[k].failed;
    if (failed > 0)
        FAIL(err, ERROR_FILE, "%d of %d files in %s could not be removed", failed, folder.count,
             folder.path);
cleanup:
    cache_folder_destroy(&folder);
    return error_is_clean(err);
}
