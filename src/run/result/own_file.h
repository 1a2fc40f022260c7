// SPDX-License-Identifier: GPL-2.0-or-later
// Which names a result of ours has in its folder; io/files/own_mark says whether a file of such a
// name is ours. Whatever else lies there belongs to somebody. Called by run/result/result_folder.
#ifndef AMONTONS_RUN_RESULT_OWN_FILE_H
#define AMONTONS_RUN_RESULT_OWN_FILE_H

#include <stdbool.h>
#include <stdint.h>

#define CHECKPOINT_FILE "checkpoint.bin"   // of a run (run/checkpoint)

// What proves a result, in the order in which it is to be removed; NULL: no more. Beside each there
// may be an unfinished one, name.part, and name.part.part, which is to replace it.
const char *own_file_name(int32_t k);

bool own_file_is_figure(const char *name);   // in figures/: force.png
bool own_file_is_field(const char *name);   // in fields/: bulk_000012.vtu (record/field_files)

#endif
