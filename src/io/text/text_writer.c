// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/text/text_writer.h"

#include <string.h>

bool text_writer_open(TextWriter *writer, const char *path, bool any, Error *err)
{
    return part_file_replace(&writer->file, path, any, err);
}

// After the first failure nothing is written.
static void flush(TextWriter *writer)
{
    if (error_is_clean(&writer->first))
        part_file_write(&writer->file, writer->bytes, (int64_t)writer->waiting, &writer->first);
    writer->waiting = 0;
}

void text_writer_put(TextWriter *writer, const char *bytes, size_t count)
{
    writer->size += (int64_t)count;
    while (count > 0) {
        size_t room = sizeof writer->bytes - writer->waiting, part = count < room ? count : room;
        memcpy(writer->bytes + writer->waiting, bytes, part);
        writer->waiting += part;
        bytes += part;
        count -= part;
        if (writer->waiting == sizeof writer->bytes) flush(writer);
    }
}

bool text_writer_finish(TextWriter *writer, Error *err)
{
    flush(writer);
    if (!error_is_clean(&writer->first)) *err = writer->first;
    return error_is_clean(err) && part_file_commit(&writer->file, err);
}

void text_writer_close(TextWriter *writer)
{
    part_file_discard(&writer->file);
}
