// SPDX-License-Identifier: GPL-2.0-or-later
// A text on its way into a file, many bytes at once: what csv_writer and html_writer are made of.
// The file gets its name at the end, and the first failure is told there, so that who writes a
// thousand cells asks once. Called by io/text/csv_writer, io/text/html_writer,
// io/fields/field_file, and for the files of a Slurm array by study/sweep/computing.
#ifndef AMONTONS_IO_TEXT_TEXT_WRITER_H
#define AMONTONS_IO_TEXT_TEXT_WRITER_H

#include "base/error.h"
#include "io/files/part_file.h"

#include <stdio.h>

typedef struct TextWriter {
    PartFile file;
    Error first;   // the first failure
    FILE *out;   // what is put here comes into the file
} TextWriter;

// overwrite: as part_file_replace has it. *writer is zeroed, and not moved.
bool text_writer_open(TextWriter *writer, const char *path, bool overwrite, Error *err);
// fsync and rename. The part is left to text_writer_close, as after a failure.
bool text_writer_finish(TextWriter *writer, Error *err);
void text_writer_close(TextWriter *writer);

#endif
