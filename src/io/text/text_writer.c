// SPDX-License-Identifier: GPL-2.0-or-later
// A stream of the C library gathers the bytes: its own word on a failure would not say why.
#include "io/text/text_writer.h"

#include "base/memory.h"

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

TextWriter *text_writer_create(const char *path, bool overwrite, Error *err)
{
    TextWriter *writer = NEW_ARRAY(TextWriter, 1, err);
    TRY(writer && part_file_replace(&writer->file, path, overwrite, err));
    writer->out = fopencookie(writer, "w", (cookie_io_functions_t){.write = write_bytes});
    if (writer->out && setvbuf(writer->out, NULL, _IOFBF, BUFFER) == 0) return writer;
    FAIL(err, ERROR_MEMORY, "no memory to write %s", path);
cleanup:
    text_writer_finish(writer, err);
    return NULL;
}

bool text_writer_finish(TextWriter *writer, Error *err)
{
    if (!writer) return error_is_clean(err);
    if (error_is_clean(err) && fflush(writer->out) != 0 && error_is_clean(&writer->first))
        error_set(&writer->first, ERROR_MEMORY, __FILE__, __LINE__,
                  "no memory for what is written");
    if (error_is_clean(err) && !error_is_clean(&writer->first)) *err = writer->first;
    if (error_is_clean(err)) part_file_commit(&writer->file, err);
    if (writer->out) fclose(writer->out);
    part_file_discard(&writer->file);
    memory_free(writer);
    return error_is_clean(err);
}
