// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons cache`: how large the cache is, what was used when, and how to get rid of it.
#include "amontons_cache.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/say.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SHOWN_MAX = 20 };

// The last ones of the list: those used last.
typedef struct Shown {
    int64_t count;
    CacheEntry list[SHOWN_MAX];
    char names[SHOWN_MAX][64];
} Shown;

static void keep_entry(const CacheEntry *entry, void *context)
{
    Shown *shown = context;
    int k = (int)(shown->count++ % SHOWN_MAX);
    shown->list[k] = *entry;
    snprintf(shown->names[k], sizeof shown->names[k], "%s", entry->name);
}

int command_cache(const Command *command, int argc, char **argv)
{
    const char *none = NULL;
    bool clean = false;
    CacheSummary summary;
    Shown shown = {0};
    Error err = {0};
    const Option options[] = {{"clean", 0, NULL, "Remove all that is in the cache", .flag = &clean},
                              {0}};
    int status = options_read(command, options, argc, argv, &none);
    if (status != 0) return status;
    bool done = clean ? amontons_cache_clean(&summary, &err)
                      : amontons_cache_list(keep_entry, &shown, &summary, &err);
    if (!done) return report_error(&err);
    if (!*summary.folder) {
        say(getenv("AMONTONS_CACHE")
                ? "there is no cache: AMONTONS_CACHE is empty, or too long a path\n"
                : "there is no cache: neither AMONTONS_CACHE nor XDG_CACHE_HOME nor HOME names a "
                  "folder for it\n");
        return 0;
    }
    say("%s: %s%lld files, %.1f MB", summary.folder, clean ? "removed " : "",
        (long long)summary.files, 1e-6 * (double)summary.bytes);
    say(clean ? "\n" : "; at most %.1f MB are kept\n", 1e-6 * (double)summary.limit);
    int64_t count = shown.count < SHOWN_MAX ? shown.count : SHOWN_MAX;
    if (count > 0) say("\n  last used              MB  file\n");
    for (int64_t back = 1; back <= count; back++) {
        int k = (int)((shown.count - back) % SHOWN_MAX);
        time_t used = (time_t)shown.list[k].used;
        char when[32] = "";
        struct tm local;
        if (localtime_r(&used, &local)) strftime(when, sizeof when, "%Y-%m-%d %H:%M", &local);
        say("  %s %8.2f  %s\n", when, 1e-6 * (double)shown.list[k].bytes, shown.names[k]);
    }
    if (shown.count > count)
        say("  ... and %lld more, unused for longer\n", (long long)(shown.count - count));
    return 0;
}
