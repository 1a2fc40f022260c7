// SPDX-License-Identifier: GPL-2.0-or-later
#include "page/page.h"

#include "base/memory.h"
#include "io/files/folder.h"
#include "io/files/text_file.h"
#include "io/text/json_reader.h"
#include "run/result/result_folder.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { REPORT_BYTES_MAX = 1 << 28, WORD_SIZE = 40 };

bool folder_holds(const char *folder, const char *name, char *path)
{
    char here[PATH_MAX];
    Error outside = {0};
    int length = snprintf(here, sizeof here, "%s/%s", folder, name);
    if (!folder_check_inside(folder, name, &outside)) return false;
    if (length < 0 || length >= (int)sizeof here || access(here, R_OK) != 0) return false;
    if (path) memcpy(path, here, (size_t)length + 1);
    return true;
}

// "." and ".." are looked up: their names say nothing.
void folder_name(const char *folder, char name[RUN_NAME_SIZE])
{
    char whole[PATH_MAX];
    if (!realpath(folder, whole)) snprintf(whole, sizeof whole, "%s", folder);
    const char *slash = strrchr(whole, '/');
    snprintf(name, RUN_NAME_SIZE, "%.100s", slash && slash[1] ? slash + 1 : whole);
}

bool run_source_open(const char *folder, RunSource *source, Error *err)
{
    char path[PATH_MAX], status[WORD_SIZE] = "", units[WORD_SIZE] = "";
    int32_t size = 0;
    *source = (RunSource){0};
    if (strlen(folder) >= sizeof source->folder)
        FAIL(err, ERROR_INPUT, "the path of the result folder is too long");
    snprintf(source->folder, sizeof source->folder, "%s", folder);
    folder_name(folder, source->name);
    source->has_history = folder_holds(folder, "history.h5", NULL) ||
                          folder_holds(folder, "history.h5.part", NULL);
    source->has_checkpoint = folder_holds(folder, CHECKPOINT_FILE, NULL);
    if (folder_holds(folder, "run.json", path)) {
        TRY(text_file_read(path, REPORT_BYTES_MAX, &source->json, &size, err));
        if (!json_is_whole(source->json))
            FAIL(err, ERROR_INPUT, "%s ends before its last bracket: no run.json of ours", path);
        json_find_text(source->json, "status", status, sizeof status);
        json_find_text(source->json, "scene.units", units, sizeof units);
        json_find_text(source->json, "scene.title", source->title, sizeof source->title);
        source->state = strcmp(status, "done") == 0 ? RUN_DONE : RUN_FAILED;
        source->si = strcmp(units, "si") == 0;
    } else {
        source->state = RUN_UNFINISHED;
        TRY(source->json = memory_text("{}", err));
    }
    if (source->state == RUN_UNFINISHED && !source->has_history)
        FAIL(err, ERROR_INPUT,
             "%s: not the result of a run or a sweep: no run.json, history.h5 or sweep.csv in it",
             folder);
    if (!*source->title) snprintf(source->title, sizeof source->title, "%s", source->name);
cleanup:
    if (!error_is_clean(err)) run_source_close(source);
    return error_is_clean(err);
}

void run_source_close(RunSource *source)
{
    memory_free(source->json);
    *source = (RunSource){0};
}

double run_number(const RunSource *source, const char *path)
{
    double value = NAN;
    bool found = source->json && json_find_number(source->json, path, &value);
    return found ? value : (double)NAN;
}

bool run_warning(const RunSource *source, int32_t k, char *words, int32_t size)
{
    char path[WORD_SIZE];
    snprintf(path, sizeof path, "warnings.%d", k);
    return k < RUN_WARNINGS_MAX && json_find_text(source->json, path, words, size);
}

// Quotes inside of texts are escaped in JSON: the pattern is found nowhere else.
int32_t run_events(const RunSource *source, const char *kind)
{
    char pattern[WORD_SIZE];
    int32_t count = 0;
    int length = snprintf(pattern, sizeof pattern, "\"kind\": \"%.20s\"", kind);
    for (const char *at = strstr(source->json, pattern); at; at = strstr(at + length, pattern))
        ++count;
    return count;
}
