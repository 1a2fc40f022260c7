// SPDX-License-Identifier: GPL-2.0-or-later
// The one place where files are opened, to read or to write: what is no file is not waited for, and
// what is somebody's is not written into (ctest -R format). Called by readers and by part_file,
// file_lock and others that write.
#ifndef AMONTONS_IO_FILES_OPEN_FILE_H
#define AMONTONS_IO_FILES_OPEN_FILE_H

#include "base/error.h"

#include <stdio.h>

// A descriptor for reading; -1 and an error: ERROR_FILE where the system refuses, ERROR_INPUT where
// nothing is there, and for a named pipe, a device or a folder, none of which is opened. A pipe of
// the shell, <(command), may be read by the name that the shell gives it.
int open_to_read(const char *path, Error *err);
FILE *open_stream(const char *path, Error *err);   // the same; NULL and an error

// Checks a path that stands in a file, which may be a stranger's. ERROR_INPUT: it is a descriptor
// of this process (base/system), as a command line alone may name one: a pipe may never end.
bool open_check_named(const char *path, Error *err);

// Checks that `path` may be handed to a library that opens it itself; ERROR_INPUT: it is no file.
bool open_check(const char *path, Error *err);

typedef enum OpenAs {
    OPEN_KEPT,   // made here, or there already; whose that is, io/files/own_list says
    OPEN_THERE,   // there already
} OpenAs;

enum { OPEN_WHY_SIZE = 400 };

// A descriptor for reading and writing; what is there is not emptied. -1: errno, and `why` in
// words. Links are not followed, and a file with a second name (a hard link) is refused.
int open_to_write(const char *path, OpenAs as, char why[OPEN_WHY_SIZE]);

// True if `path` is there, be it a link that leads nowhere.
bool open_is_there(const char *path);
// The same question, but no for empty files, as mktemp or a kill leaves them: they hold nothing of
// anybody's.
bool open_holds_something(const char *path);

#endif
