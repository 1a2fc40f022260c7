// SPDX-License-Identifier: GPL-2.0-or-later
// An element of a Slurm array reads what it needs from a file that the sweep wrote, so that nothing
// has to pass through a shell:
//
//     {"directory": ..., "study": ..., "folder": ..., "set_count": 1, "set": ["rod.kind=push"],
//      "design_count": 0, "designs": [], "first": 0}
//
// Element e computes the share first + e.
#include "study/sweep/computing/element.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "io/files/text_file.h"
#include "io/text/json_reader.h"
#include "io/text/json_writer.h"
#include "study/sweep/computing/share.h"
#include "study/sweep/reading/study_read.h"
#include "study/sweep/reading/study_vary.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ELEMENTS_BYTES_MAX = 1 << 24, SETTING_SIZE = 1000 };

// Paths are stored as the sweep was given them, with the folder it was called in: errors in an
// element's report then read as they would in the pool's.
bool elements_write(const Sweep *sweep, const char *path, int32_t first, Error *err)
{
    const SweepOptions *options = sweep->options;
    char *directory = getcwd(NULL, 0), *folder = realpath(sweep->folder, NULL);
    JsonWriter *json = NULL;
    if (!directory || !folder)
        FAIL(err, ERROR_FILE, "cannot find the path of %s: %s", sweep->folder, strerror(errno));
    TRY((json = json_create(path, err)));
    json_begin_object(json, NULL);
    json_text(json, "directory", directory);
    json_text(json, "study", sweep->study.path);
    json_text(json, "folder", folder);
    json_integer(json, "set_count", options->override_count);
    json_begin_list(json, "set");
    for (int32_t k = 0; k < options->override_count; k++)
        json_text(json, NULL, options->overrides[k]);
    json_end(json);
    json_integer(json, "design_count", sweep->study.design_count);
    json_begin_list(json, "designs");
    for (int32_t k = 0; k < sweep->study.design_count; k++)
        json_text(json, NULL, sweep->study.designs[k]);
    json_end(json);
    json_integer(json, "first", first);
    json_end(json);
    TRY(json_finish(json, err));
cleanup:
    free(directory);
    free(folder);
    return error_is_clean(err);
}

// --- in the process of the element --------------------------------------------------------------

// The --set words of the sweep, which every element must apply as well.
typedef struct ElementSettings {
    const char *list[STUDY_SETTINGS_MAX];   // as after --set
    char text[STUDY_SETTINGS_MAX][SETTING_SIZE];
    int32_t count;
} ElementSettings;

// More than there is room for cannot come from a sweep: it has the same bound.
static bool read_settings(const char *text, ElementSettings *settings, Error *err)
{
    double count = 0;
    bool found = json_find_number(text, "set_count", &count);
    if (!found || !(count >= 0 && count <= STUDY_SETTINGS_MAX))
        return REFUSE(err, "no list of elements as a sweep writes it");
    settings->count = (int32_t)count;
    for (int32_t k = 0; k < settings->count; k++) {
        char path[40];
        snprintf(path, sizeof path, "set.%d", k);
        if (!json_find_text(text, path, settings->text[k], SETTING_SIZE))
            return REFUSE(err, "the list of elements lacks setting %d", k);
        settings->list[k] = settings->text[k];
    }
    return true;
}

// Cases that a search has added to the study, one text for each round.
static bool read_designs(const char *text, Study *study, Error *err)
{
    double count = 0;
    json_find_number(text, "design_count", &count);
    for (int32_t k = 0; k < (int32_t)count; k++) {
        char path[40], *design = NULL;
        int32_t size = 0;
        snprintf(path, sizeof path, "designs.%d", k);
        bool found = json_find_raw(text, path, &size) != NULL;
        if (found) design = memory_array((int64_t)size + 1, 1, err);
        found = design && json_find_text(text, path, design, size + 1) &&
                study_add_designs(study, design, err);
        memory_free(design);
        if (!found && error_is_clean(err))
            return REFUSE(err, "the list of elements lacks design %d", k);
        if (!error_is_clean(err)) return false;
    }
    return error_is_clean(err);
}

// The sweep as far as an element needs it.
static bool read_sweep(const char *text, Sweep *sweep, Error *err)
{
    char directory[AMONTONS_PATH_SIZE] = "", study[AMONTONS_PATH_SIZE] = "";
    ElementSettings *settings = NEW_ARRAY(ElementSettings, 1, err);
    TRY(settings);
    TRY(read_settings(text, settings, err));
    bool found = json_find_text(text, "directory", directory, sizeof directory) &&
                 json_find_text(text, "study", study, sizeof study) &&
                 json_find_text(text, "folder", sweep->folder, sizeof sweep->folder);
    if (!found) FAIL(err, ERROR_INPUT, "no list of elements as a sweep writes it");
    if (chdir(directory) != 0)
        FAIL(err, ERROR_FILE, "cannot go to %s: %s", directory, strerror(errno));
    TRY(study_read(study, settings->list, settings->count, &sweep->study, err));
    TRY(read_designs(text, &sweep->study, err));
cleanup:
    memory_free(settings);
    return error_is_clean(err);
}

bool amontons_sweep_element(const char *path, int32_t element, Error *err)
{
    char *text = NULL;
    int32_t size = 0;
    double first = 0;
    const SweepOptions none = {0};
    Sweep *sweep = NEW_ARRAY(Sweep, 1, err);
    TRY(sweep);
    TRY((sweep->scene = NEW_ARRAY(Scene, 1, err)));
    dense_use_one_thread();
    TRY(text_file_read(path, ELEMENTS_BYTES_MAX, &text, &size, err));
    TRY(read_sweep(text, sweep, err));
    json_find_number(text, "first", &first);
    sweep->options = &none;
    TRY(share_run(sweep, (int32_t)first + element, err));
cleanup:
    memory_free(text);
    if (sweep) {
        memory_free_all(sweep->points, sweep->scene);
        study_destroy(&sweep->study);
    }
    memory_free(sweep);
    return error_is_clean(err);
}
