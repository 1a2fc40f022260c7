// SPDX-License-Identifier: GPL-2.0-or-later
// A stream of the C library gathers the bytes: its own word on a failure would not say why.
#include "io/text/text_writer.h"

#include <stdio.h>

enum { BUFFER = 1 << 16 };

// After the first failure nothing is written.
static ssize_t write_bytes(void *self, const char *bytes, size_t count)
{
    TextWriter *writer = self;
    if (error_is_clean(&writer->first))
        part_file_write(&writer->file, bytes, (int64_t)count, &writer->first);
    return (ssize_t)count;
}

bool text_writer_open(TextWriter *writer, const char *path, bool overwrite, Error *err)
{
    if (!part_file_replace(&writer->file, path, overwrite, err)) return false;
    writer->out = fopencookie(writer, "w", (cookie_io_functions_t){.write = write_bytes});
    if (writer->out && setvbuf(writer->out, NULL, _IOFBF, BUFFER) == 0) return true;
    text_writer_close(writer);
    return FAULT(err, ERROR_MEMORY, "no memory to write %s", path);
}

bool text_writer_finish(TextWriter *writer, Error *err)
{
    if (fflush(writer->out) != 0 && error_is_clean(&writer->first))
        error_set(&writer->first, ERROR_MEMORY, __FILE__, __LINE__,
                  "no memory for what is written");
    if (!error_is_clean(&writer->first)) *err = writer->first;
    return error_is_clean(err) && part_file_commit(&writer->file, err);
}

void text_writer_close(TextWriter *writer)
{
    if (writer->out) fclose(writer->out);
    writer->out = NULL;
    part_file_discard(&writer->file);
}
