// SPDX-License-Identifier: GPL-2.0-or-later
// A file being written: as `path`.part, renamed when all of it is on disk, so that a final name
// never has half a file. Called by all that
// write files.
//
//   create -> write ... -> commit     the file has its final name (reopen: to go on with one)
//                       -> discard    nothing is left
//                       -> leave      `path`.part is left, for what may still be read of it
#ifndef AMONTONS_IO_FILES_PART_FILE_H
#define AMONTONS_IO_FILES_PART_FILE_H

#include "base/error.h"

#include <limits.h>
#include <stdint.h>

typedef struct PartFile {
    bool open;   // false: zeroed, committed or discarded
    bool taken;   // another process is writing it: why create failed
    int descriptor;   // for reading and writing; valid while open
    char path[PATH_MAX];   // the final name
    char part[PATH_MAX + 8];   // the name until then
} PartFile;

// `path`.part into `part`, of PATH_MAX + 8 bytes; false when `path` is empty or too long.
bool part_file_name(const char *path, char *part);

// Opens an empty `path`.part and locks it against other writers. What is there of either name is
// written over where it is empty, or the folder's list has `path` (io/files/own_list), which is
// added to it; else it is somebody's: ERROR_INPUT. The lock of a killed process is waited for, for
// a second.
// ERROR_FILE names the path and the cause, here and below: also a link, a pipe or a folder in the
// part's place (io/files/open_file).
bool part_file_create(PartFile *file, const char *path, Error *err);
// overwrite: what is there is written over, whoever wrote it.
bool part_file_replace(PartFile *file, const char *path, bool overwrite, Error *err);
// In the cache, where names are ours: whatever is there is written over, and no lock is waited for.
bool part_file_try(PartFile *file, const char *path, Error *err);
// Opens what there is of `path` to be gone on with: its .part, or the finished file, which is
// called .part again until it is committed. ERROR_FILE where there is neither.
bool part_file_reopen(PartFile *file, const char *path, Error *err);
// A file that is still being written is replaced as a whole, so that a killed process leaves the
// old or the new one: `next` is a new `path`.part.part, empty, which takes the place of `path`.part
// when it has been filled and put on the disk. A `next` that did not take the place is to be
// discarded.
bool part_file_begin_next(const PartFile *file, PartFile *next, Error *err);
bool part_file_take_next(PartFile *file, PartFile *next, Error *err);
bool part_file_write(PartFile *file, const void *bytes, int64_t size, Error *err);

// All of the above: a small file at once.
bool part_file_put(const char *path, bool overwrite, const void *bytes, int64_t size, Error *err);

// Onto the disk (fsync), then under the final name. A failure leaves it open, to discard or leave.
bool part_file_commit(PartFile *file, Error *err);
void part_file_discard(PartFile *file);   // closes and removes; fine when not open
void part_file_leave(PartFile *file);   // closes and keeps `path`.part; fine when not open

#endif
