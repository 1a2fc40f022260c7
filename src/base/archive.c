// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/archive.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

// A list has room for twice its items at most, but for its first room (base/memory).
enum { FIRST_ROOM_MAX = 1024 };
enum { LENGTH_LIMIT = 1 << 28 };
static const int64_t COUNT_MAX = (int64_t)1 << 53;   // beyond any run; the sum of some is none too

Archive archive_measure(void)
{
    return (Archive){.mode = ARCHIVE_MEASURES};
}

Archive archive_write(void *bytes, int64_t size)
{
    return (Archive){.mode = ARCHIVE_WRITES, .bytes = bytes, .size = size};
}

Archive archive_send(ArchiveSend send, void *context)
{
    return (Archive){.mode = ARCHIVE_SENDS, .send = send, .context = context};
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

bool archive_fills(const Archive *archive)
{
    return archive_reads(archive) && !archive->failed;
}

// The next `count` pieces of `size` bytes, to or from `values`.
static void pass(Archive *archive, void *values, int64_t count, size_t size)
{
    int64_t bytes = count * (int64_t)size;
    if (archive->failed) return;
    bool in_memory = archive->mode == ARCHIVE_WRITES || archive->mode == ARCHIVE_READS;
    if (in_memory && bytes > archive->size - archive->at) {
        archive->failed = true;
        return;
    }
    if (archive->mode == ARCHIVE_WRITES && bytes > 0)
        memcpy(archive->bytes + archive->at, values, (size_t)bytes);
    if (archive->mode == ARCHIVE_READS && bytes > 0)
        memcpy(values, archive->bytes + archive->at, (size_t)bytes);
    if (archive->mode == ARCHIVE_SENDS && !archive->send(archive->context, values, bytes))
        archive->failed = true;
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

void archive_number_list(Archive *archive, double *const *numbers, int32_t count)
{
    for (int32_t k = 0; k < count; k++) archive_number(archive, numbers[k]);
}

void archive_count_list(Archive *archive, int64_t *const *counts, int32_t count)
{
    for (int32_t k = 0; k < count; k++) archive_count(archive, counts[k]);
}

void archive_flag(Archive *archive, bool *flag)
{
    uint8_t octet = *flag;
    pass(archive, &octet, 1, 1);
    *flag = octet != 0;
}

static void pass_length(Archive *archive, int64_t count)
{
    int64_t found = count;
    archive_count(archive, &found);
    if (found != count) archive->failed = true;
}

// An array, its length before it.
static void pass_array(Archive *archive, void *values, int64_t count, size_t size)
{
    pass_length(archive, count);
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
    if (archive_reads(archive) && archive->failed) *index = low;
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

void archive_length(Archive *archive, int32_t *length)
{
    archive_index(archive, length, 0, LENGTH_LIMIT);
}

void archive_require(Archive *archive, bool condition)
{
    if (archive_reads(archive) && !condition) archive->failed = true;
}

// An item takes a byte or more: a false count asks for little beyond what there is.
void *archive_new(Archive *archive, void *known, int64_t count, size_t size)
{
    if (!archive_reads(archive)) return known;
    archive_require(archive, count >= 0 && count <= archive->size - archive->at);
    void *made = archive->failed ? NULL : memory_array(count, size, archive->err);
    archive_require(archive, made != NULL);
    return made;
}

void archive_new_numbers(Archive *archive, double **numbers, int64_t count)
{
    *numbers = archive_new(archive, *numbers, count, sizeof **numbers);
    archive_numbers(archive, *numbers, count);
}

void archive_new_counts(Archive *archive, int64_t **counts, int64_t count)
{
    *counts = archive_new(archive, *counts, count, sizeof **counts);
    pass_array(archive, *counts, count, sizeof **counts);
    for (int64_t k = 0; !archive->failed && k < count; k++)
        archive_require(archive, (*counts)[k] >= 0 && (*counts)[k] <= COUNT_MAX);
}

void archive_new_indices(Archive *archive, int32_t **indices, int64_t count, int32_t low,
                         int32_t high)
{
    *indices = archive_new(archive, *indices, count, sizeof **indices);
    archive_indices(archive, *indices, count, low, high);
}

void archive_new_octets(Archive *archive, uint8_t **octets, int64_t count, uint8_t high)
{
    *octets = archive_new(archive, *octets, count, sizeof **octets);
    archive_octets(archive, *octets, count);
    for (int64_t k = 0; !archive->failed && k < count; k++)
        archive_require(archive, (*octets)[k] < high);
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
        return FAULT(err, ERROR_FILE, "the saved state does not fit what it is read into (%s)",
                     archive->section);
    if (whole && archive->at != archive->size)
        return FAULT(err, ERROR_FILE, "the saved state is longer than what it is read into");
    return true;
}
