// SPDX-License-Identifier: GPL-2.0-or-later
// A whole small file in memory.
#ifndef AMONTONS_IO_FILES_TEXT_FILE_H
#define AMONTONS_IO_FILES_TEXT_FILE_H

#include "base/error.h"

#include <stdint.h>

// Reads `path` into *bytes ([*size + 1], zero-terminated, owned by the caller: memory_free). A byte
// order mark is left out. ERROR_INPUT: missing, a folder, more than `size_max` bytes, or a
// zero byte among them, behind which C sees nothing; ERROR_FILE: there but unreadable.
bool text_file_read(const char *path, int32_t size_max, char **bytes, int32_t *size, Error *err);
// The same of a file that need not be a text, or whose reader names the place of a zero byte.
bool text_file_bytes(const char *path, int32_t size_max, char **bytes, int32_t *size, Error *err);

#endif
