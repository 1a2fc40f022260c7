// SPDX-License-Identifier: GPL-2.0-or-later
// The folder that a computation writes into: one computation at a time, and of what lies there only
// files that our list names are ever removed (io/files/own_list). Called by run/simulation,
// run/static/static_solve and the studies of one scene.
//
//   claim -> (input accepted) -> clear or take_up -> (files are written) -> settle -> release
#ifndef AMONTONS_RUN_RESULT_RESULT_FOLDER_H
#define AMONTONS_RUN_RESULT_RESULT_FOLDER_H

#include "amontons.h"
#include "io/files/file_lock.h"

#define CHECKPOINT_FILE "checkpoint.bin"   // of a run (run/checkpoint)

typedef struct ResultFolder {
    char path[AMONTONS_PATH_SIZE];   // empty: nothing is written at all
    bool has_earlier;   // an earlier result lies there and has not been cleared: not to be touched
    bool aside;   // cleared, and not settled yet
    FileLock lock;   // held from claim to release
} ResultFolder;

// Makes the folder with all that leads to it; nothing is removed. path NULL: none is wanted.
// ERROR_INPUT: it holds a result and `overwrite` is false, another process computes into it, or
// it is not ours, or a file of somebody's has a name that a result needs.
bool result_folder_claim(const char *path, bool overwrite, ResultFolder *folder, Error *err);

// Sets the earlier result aside, where there is one; to be called once the input is known to be
// right. From release it is back, unless the new result was settled: only then is it removed.
bool result_folder_clear(ResultFolder *folder, Error *err);
bool result_folder_settle(ResultFolder *folder, Error *err);   // fine when nothing is aside

// Instead of clear, to go on with the earlier result: only its report is removed.
bool result_folder_take_up(ResultFolder *folder, Error *err);

bool result_folder_is_ours(const ResultFolder *folder);   // files may be written now
bool result_folder_is_settled(const ResultFolder *folder);   // and they will stay
void result_folder_release(ResultFolder *folder);   // zeroed and released too

#endif
