// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/result/own_file.h"

#include "base/memory.h"
#include "io/files/own_list.h"
#include "io/files/text_file.h"
#include "amontons_pictures.h"
#include "render/quantities.h"

#include <ctype.h>
#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = PATH_MAX + NAME_MAX + 16, REPORT_MAX = 1 << 28 };

static const char *const RESULT_FILES[] = {
    "run.json",   CHECKPOINT_FILE,  "history.h5",   "fields.pvd",   "static.json", "static.h5",
    "static.vtu", "stability.json", "stability.h5", "model1d.json", "model1d.h5",  "report.html"};
static const char *const FIELDS[] = {"bulk_", ".vtu", "interface_", ".vtp"};

#define FIGURE_FILE(id, name, words)                                                               \
    name ".png", name ".pdf", name ".svg", name ".csv", name "-compared.csv",
#define FIELD_FILE(id, name, ...) FIGURE_FILE(id, "field-" name, )   // of a quantity
#define CONTACT_FILE(id, name, ...) FIGURE_FILE(id, "contact-plane-" name, )
static const char *const FIGURES[] = {PICTURE_FIGURES(FIGURE_FILE) BLOCK_QUANTITIES(FIELD_FILE)
                                          CONTACT_QUANTITIES(CONTACT_FILE)
                                              FIGURE_FILE(, "panels", ) "events.csv",
                                      "misfit.csv", "accuracy.png", "accuracy.json"};

static bool is_proof(const char *name)
{
    for (size_t k = 0; k < sizeof RESULT_FILES / sizeof *RESULT_FILES; k++)
        if (strcmp(RESULT_FILES[k], name) == 0) return true;
    return false;
}

static bool is_figure(const char *name)
{
    for (size_t k = 0; k < sizeof FIGURES / sizeof FIGURES[0]; k++)
        if (strcmp(FIGURES[k], name) == 0) return true;
    return false;
}

// bulk_000012.vtu (record/field_files).
static bool is_field(const char *name)
{
    for (size_t k = 0; k < sizeof FIELDS / sizeof FIELDS[0]; k += 2) {
        size_t length = strlen(FIELDS[k]), digits = 0;
        if (strncmp(name, FIELDS[k], length) != 0) continue;
        while (isdigit((unsigned char)name[length + digits])) digits++;
        if (digits >= 6 && strcmp(name + length + digits, FIELDS[k + 1]) == 0) return true;
    }
    return false;
}

bool own_file_visit(const char *folder, OwnFileFound found, void *context, Error *err)
{
    static const struct {
        const char *name;
        bool (*is_own)(const char *);
    } rooms[] = {{"", is_proof}, {"/fields", is_field}, {"/figures", is_figure}};
    // Twice .part: a file that replaces an unfinished one. A journal is one of version 0.2.
    static const char *const endings[] = {".part", ".part", ".journal"};
    char path[PATH_SIZE], bare[NAME_MAX + 1];
    bool whole = true;
    for (size_t k = 0; k < sizeof rooms / sizeof *rooms && whole; k++) {
        snprintf(path, sizeof path, "%s%s", folder, rooms[k].name);
        DIR *directory = opendir(path);
        if (!directory) continue;   // what cannot be looked at shows when it is written to
        for (const struct dirent *entry; whole && (entry = readdir(directory));) {
            // Its name without what an unfinished file has behind it.
            snprintf(bare, sizeof bare, "%s", entry->d_name);
            for (size_t e = 0; e < sizeof endings / sizeof *endings; e++) {
                size_t length = strlen(bare), end = strlen(endings[e]);
                if (length > end && strcmp(bare + length - end, endings[e]) == 0)
                    bare[length - end] = 0;
            }
            snprintf(path, sizeof path, "%s%s/%s", folder, rooms[k].name, bare);
            whole = !rooms[k].is_own(bare) || found(path, context, err);
        }
        closedir(directory);
    }
    return whole;
}

static bool add(const char *path, void *context, Error *err)
{
    (void)context;
    return own_list_add(path, err);
}

bool own_file_adopt(const char *folder, Error *err)
{
    static const char *const reports[] = {"run.json", "static.json", "stability.json",
                                          "model1d.json"};
    bool earlier = false;
    if (own_list_is_in(folder)) return true;
    for (size_t k = 0; k < sizeof reports / sizeof *reports && !earlier; k++) {
        char path[PATH_SIZE], *text = NULL;
        int32_t size = 0;
        Error unseen = {0};
        snprintf(path, sizeof path, "%.*s/%s", PATH_MAX, folder, reports[k]);
        if (access(path, F_OK) != 0 || !text_file_read(path, REPORT_MAX, &text, &size, &unseen))
            continue;
        earlier = strstr(text, "\"version\": \"0.1.") || strstr(text, "\"version\": \"0.2.");
        memory_free(text);
    }
    return !earlier || (own_list_make(folder, err) && own_file_visit(folder, add, NULL, err));
}
