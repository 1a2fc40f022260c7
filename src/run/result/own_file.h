// SPDX-License-Identifier: GPL-2.0-or-later
// Which names a result of ours has in its folder: those that must be free where no list of ours
// (io/files/own_list) has them, and those of a result of version 0.2, which had no list. Called by
// run/result/result_folder, run/result/pictures and page/report.
#ifndef AMONTONS_RUN_RESULT_OWN_FILE_H
#define AMONTONS_RUN_RESULT_OWN_FILE_H

#include "base/error.h"

#define CHECKPOINT_FILE "checkpoint.bin"   // of a run (run/checkpoint)

// Calls `found` with the path of each file in `folder`, figures/ and fields/ that has a name of
// ours, finished or not, until it returns false. false: `found` returned it.
typedef bool (*OwnFileFound)(const char *path, void *context, Error *err);
bool own_file_visit(const char *folder, OwnFileFound found, void *context, Error *err);

// Lists the files of a result of version 0.2 or before; does nothing in a folder that has a list,
// or no report of that version.
bool own_file_adopt(const char *folder, Error *err);

#endif
