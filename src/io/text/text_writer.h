// SPDX-License-Identifier: GPL-2.0-or-later
// A text on its way into a file, many bytes at once. The final name appears when all is on disk.
// The first failure is kept and reported at the end, so that a caller who writes a thousand cells
// asks once. Called by page/, by all that write tables (io/text/csv_writer), by
// io/fields/field_file and by study/sweep/computing.
#ifndef AMONTONS_IO_TEXT_TEXT_WRITER_H
#define AMONTONS_IO_TEXT_TEXT_WRITER_H

#include "base/error.h"
#include "io/files/part_file.h"

#include <stdio.h>

typedef struct TextWriter {
    PartFile file;
    Error first;   // the first failure
    FILE *out;   // stream into the file
    bool in_row;   // a cell of a table stands on the line already
} TextWriter;

// overwrite: as part_file_replace has it.
TextWriter *text_writer_create(const char *path, bool overwrite, Error *err);
// fsync, rename; frees `writer`, which may be NULL. Where *err has an error already, or writing
// failed, no file is left. Returns true if *err has no error.
bool text_writer_finish(TextWriter *writer, Error *err);

#endif
