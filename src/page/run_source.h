// SPDX-License-Identifier: GPL-2.0-or-later
// A run's result folder as a page sees it: what there is of it, and the values of its run.json.
// Called by the pages.
#ifndef AMONTONS_PAGE_RUN_SOURCE_H
#define AMONTONS_PAGE_RUN_SOURCE_H

#include "amontons.h"

enum { RUN_NAME_SIZE = 120, RUN_TITLE_SIZE = 600 };

typedef enum RunState { RUN_DONE, RUN_FAILED, RUN_UNFINISHED } RunState;

typedef struct RunSource {
    char folder[AMONTONS_PATH_SIZE];
    char name[RUN_NAME_SIZE];   // the folder's own
    char title[RUN_TITLE_SIZE];   // of the scene; where it has none the folder's name
    char *json;   // run.json; "{}" where there is none; owned
    RunState state;
    bool has_history, has_checkpoint, si;
} RunSource;

// ERROR_INPUT: the folder holds nothing of a run.
bool run_source_open(const char *folder, RunSource *source, Error *err);
void run_source_close(RunSource *source);   // zeroed is fine

// The number at `path` in run.json; NaN: there is none, or the source is zeroed.
double run_number(const RunSource *source, const char *path);
// Its k-th warning; false: there is none.
bool run_warning(const RunSource *source, int32_t k, char *words, int32_t size);
// Number of events of this kind, "leading rapid".
int32_t run_events(const RunSource *source, const char *kind);

// True if `folder` holds `name`; the path, where one is wanted, has PATH_MAX bytes.
bool folder_holds(const char *folder, const char *name, char *path);
// The last part of a path: "fig1" of "results/fig1/".
void folder_name(const char *folder, char name[RUN_NAME_SIZE]);

#endif
