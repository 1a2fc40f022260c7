// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/archive.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

// A list has room for twice its items at most, but for its first room (base/memory).
enum { FIRST_ROOM_MAX = 1024 };
static const int64_t COUNT_MAX = (int64_t)1 << 53;   // beyond any run; the sum of some is none too

Archive archive_measure(void)
{
    return (Archive){.mode = ARCHIVE_MEASURES};
}

Archive archive_write(void *bytes, int64_t size)
{
    return (Archive){.mode = ARCHIVE_WRITES, .bytes = bytes, .size = size};
}

// The bytes are only read: one pointer serves both ways.
Archive archive_read(const void *bytes, int64_t size)
{
    return (Archive){.mode = ARCHIVE_READS, .bytes = (char *)bytes, .size = size};
}

bool archive_reads(const Archive *archive)
{
    return archive->mode == ARCHIVE_READS;
}

// The next `count` pieces of `size` bytes, to or from `values`.
static void pass(Archive *archive, void *values, int64_t count, size_t size)
{
    int64_t bytes = count * (int64_t)size;
    if (archive->failed) return;
    if (archive->mode != ARCHIVE_MEASURES && bytes > archive->size - archive->at) {
        archive->failed = true;
        return;
    }
    if (archive->mode == ARCHIVE_WRITES && bytes > 0)
        memcpy(archive->bytes + archive->at, values, (size_t)bytes);
    if (archive->mode == ARCHIVE_READS && bytes > 0)
        memcpy(values, archive->bytes + archive->at, (size_t)bytes);
    archive->at += bytes;
}

void archive_section(Archive *archive, const char *name)
{
    char found[ARCHIVE_NAME_SIZE] = {0};
    if (archive->failed) return;
    snprintf(archive->section, sizeof archive->section, "%s", name);
    snprintf(found, sizeof found, "%s", name);
    pass(archive, found, ARCHIVE_NAME_SIZE, 1);
    if (memcmp(found, archive->section, strlen(name) + 1) != 0) archive->failed = true;
}

void archive_number(Archive *archive, double *number)
{
    pass(archive, number, 1, sizeof *number);
}

void archive_integer(Archive *archive, int32_t *integer)
{
    pass(archive, integer, 1, sizeof *integer);
}

void archive_count(Archive *archive, int64_t *count)
{
    pass(archive, count, 1, sizeof *count);
    if (archive_reads(archive) && (*count < 0 || *count > COUNT_MAX)) archive->failed = true;
}

void archive_flag(Archive *archive, bool *flag)
{
    uint8_t octet = *flag;
    pass(archive, &octet, 1, 1);
    *flag = octet != 0;
}

// An array, its length before it.
static void pass_array(Archive *archive, void *values, int64_t count, size_t size)
{
    int64_t found = count;
    archive_count(archive, &found);
    if (found != count) archive->failed = true;
    pass(archive, values, count, size);
}

void archive_numbers(Archive *archive, double *numbers, int64_t count)
{
    pass_array(archive, numbers, count, sizeof *numbers);
}

static void check_range(Archive *archive, const int32_t *indices, int64_t count, int32_t low,
                        int32_t high)
{
    for (int64_t k = 0; archive_reads(archive) && k < count; k++)
        if (indices[k] < low || indices[k] >= high) archive->failed = true;
}

void archive_indices(Archive *archive, int32_t *indices, int64_t count, int32_t low, int32_t high)
{
    pass_array(archive, indices, count, sizeof *indices);
    if (!archive->failed) check_range(archive, indices, count, low, high);
}

void archive_index(Archive *archive, int32_t *index, int32_t low, int32_t high)
{
    archive_integer(archive, index);
    if (!archive->failed) check_range(archive, index, 1, low, high);
}

void archive_octets(Archive *archive, uint8_t *octets, int64_t count)
{
    pass_array(archive, octets, count, 1);
}

void archive_text(Archive *archive, char *text, int64_t size)
{
    pass_array(archive, text, size, 1);
    if (archive_reads(archive)) text[size - 1] = 0;
}

bool archive_list(Archive *archive, void **list, int32_t *count, int32_t *room, size_t size,
                  Error *err)
{
    int32_t found[2] = {*count, *room};
    archive_integer(archive, &found[0]);
    archive_integer(archive, &found[1]);
    if (!archive_reads(archive)) return true;
    bool possible = found[0] >= 0 && found[0] <= found[1] &&
                    found[0] <= archive->size - archive->at &&
                    found[1] <= 2 * (int64_t)found[0] + FIRST_ROOM_MAX;
    if (!possible) archive->failed = true;
    if (archive->failed) return archive_check(archive, false, err);
    void *made = memory_array(found[1], size, err);
    if (!made) return false;
    memory_free(*list);
    *list = made;
    *count = found[0];
    *room = found[1];
    return true;
}

bool archive_check(const Archive *archive, bool whole, Error *err)
{
    if (archive->failed)
        FAIL(err, ERROR_FILE, "the saved state does not fit what it is read into (%s)",
             archive->section);
    if (whole && archive->at != archive->size)
        FAIL(err, ERROR_FILE, "the saved state is longer than what it is read into");
cleanup:
    return error_is_clean(err);
}
