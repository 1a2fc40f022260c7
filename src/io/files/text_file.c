// SPDX-License-Identifier: GPL-2.0-or-later
// A shell may hand over a pipe (/dev/fd/63), which has no size beforehand: so the size is checked
// meanwhile.
#include "io/files/text_file.h"

#include "base/memory.h"
#include "io/files/open_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

// A mesh of 100 MB given by mistake is refused.
static bool check_size(const char *path, int64_t size, int32_t size_max, Error *err)
{
    if (size > size_max)
        return REFUSE(err, "%s has more than the %d bytes a text of this kind may have", path,
                      size_max);
    return true;
}

bool text_file_bytes(const char *path, int32_t size_max, char **bytes, int32_t *size, Error *err)
{
    *bytes = NULL;
    *size = 0;
    FILE *stream = NULL;
    int32_t capacity = 4096;   // the buffer grows as bytes come in
    TRY(stream = open_stream(path, err));
    TRY(*bytes = memory_array(capacity + 1, 1, err));
    for (;;) {
        *size += (int32_t)fread(*bytes + *size, 1, (size_t)(capacity - *size), stream);
        if (*size < capacity) break;
        TRY(check_size(path, *size, size_max, err));
        TRY(memory_resize(bytes, capacity, 2 * (int64_t)capacity + 1, 1, err));
        capacity *= 2;
    }
    if (ferror(stream)) FAIL(err, ERROR_FILE, "cannot read %s: %s", path, strerror(errno));
    TRY(check_size(path, *size, size_max, err));
    if (*size >= 3 && memcmp(*bytes, "\xEF\xBB\xBF", 3) == 0) {
        *size -= 3;
        memmove(*bytes, *bytes + 3, (size_t)*size);
    }
    (*bytes)[*size] = 0;
cleanup:
    if (stream) fclose(stream);
    if (!error_is_clean(err)) {
        memory_free(*bytes);
        *bytes = NULL;
    }
    return error_is_clean(err);
}

// C's texts end with a zero byte: what stands behind one would go unseen.
bool text_file_read(const char *path, int32_t size_max, char **bytes, int32_t *size, Error *err)
{
    int32_t line = 1;
    if (!text_file_bytes(path, size_max, bytes, size, err)) return false;
    const char *zero = memchr(*bytes, 0, (size_t)*size);
    if (!zero) return true;
    for (const char *at = *bytes; at < zero; at++) line += *at == '\n';
    memory_free(*bytes);
    *bytes = NULL;
    return REFUSE(err, "%s: a zero byte in line %d: this is no text", path, line);
}
