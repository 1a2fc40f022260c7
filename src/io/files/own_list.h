// SPDX-License-Identifier: GPL-2.0-or-later
// Whose a file is. A folder is ours if it is empty or has our list, amontons.files, of the files
// that we wrote there; a file outside of such a folder is somebody's. Only what is listed is ever
// written over or removed without `--overwrite`, and of an earlier result nothing else goes. A file
// is listed before anything is written into it: what a kill leaves is listed, or empty, and an
// empty file is nobody's.
//
// The list has one name a line, as seen from its folder: force.csv, or figures/force.png. Names
// that begin with "amontons." (the list, locks) are ours everywhere.
//
//   check -> (the work is accepted) -> make -> part_file_create, which asks has and add
#ifndef AMONTONS_IO_FILES_OWN_LIST_H
#define AMONTONS_IO_FILES_OWN_LIST_H

#include "base/error.h"

#include <limits.h>
#include <stdio.h>

#define OWN_LIST_NAME "amontons.files"

// True if `folder` has a list; a link in its place is none.
bool own_list_is_in(const char *folder);

// ERROR_INPUT: there are files in `folder`, and no list. Nothing is made; names that begin with a
// dot do not count.
bool own_list_check(const char *folder, Error *err);
bool own_list_make(const char *folder, Error *err);   // an empty list, where there is none

// *has: `path` is in the list of its folder, or of the folder above that. false: a list could not
// be read.
bool own_list_has(const char *path, bool *has, Error *err);

// ERROR_INPUT: `path` is there and not empty, and no list has it.
bool own_list_refuse_taken(const char *path, Error *err);

// Lists `path` there, once more where it is listed. Without a list nothing is done.
bool own_list_add(const char *path, Error *err);

// The list of `folder`, to be read by own_list_next and closed by fclose; NULL: there is none, or
// an error. No memory is asked for: an earlier result is put back where it is short, too.
FILE *own_list_open(const char *folder, Error *err);

// The next name; false: no more. A list may be a stranger's: names that lead out of its folder, or
// deeper than one folder in it, are passed over, as are hidden ones.
enum { OWN_NAME_SIZE = 2 * NAME_MAX + 4 };
bool own_list_next(FILE *list, char name[OWN_NAME_SIZE]);

#endif
