// SPDX-License-Identifier: GPL-2.0-or-later
// An archive is read back to the bit, by the same calls; what does not fit is a fault,
// whatever the bytes are.
#include "base/archive.h"

#include "base/memory.h"
#include "near.h"

#include <stdlib.h>

typedef struct Thing {
    double number, numbers[3];
    int32_t integer, index;
    int64_t count;
    bool flag;
    uint8_t octets[5];
    char text[8];
    double *list;   // [list_count]
    int32_t list_count, room;
} Thing;

static bool thing_archive(Thing *thing, Archive *archive, Error *err)
{
    void *list = thing->list;
    archive_section(archive, "thing");
    archive_number(archive, &thing->number);
    archive_numbers(archive, thing->numbers, 3);
    archive_integer(archive, &thing->integer);
    archive_index(archive, &thing->index, -1, 4);
    archive_count(archive, &thing->count);
    archive_flag(archive, &thing->flag);
    archive_octets(archive, thing->octets, 5);
    archive_text(archive, thing->text, sizeof thing->text);
    if (!archive_list(archive, &list, &thing->list_count, &thing->room, sizeof(double), err))
        return false;
    thing->list = list;
    for (int32_t k = 0; k < thing->list_count; k++) archive_number(archive, &thing->list[k]);
    return archive_check(archive, false, err);
}

static double values[4] = {1, -0.0, 3e-310, INFINITY};

static Thing example(void)
{
    return (Thing){.number = -0.0,
                   .numbers = {NAN, 1.0 / 3, 5e-324},
                   .integer = INT32_MIN,
                   .index = 3,
                   .count = INT64_C(1) << 53,
                   .flag = true,
                   .octets = {0, 255, 1, 2, 3},
                   .text = "abcdefg",
                   .list = values,
                   .list_count = 3,
                   .room = 4};
}

// The bytes of the example, the caller's to free.
static void *write_example(int64_t *size)
{
    Error err = {0};
    Thing thing = example();
    Archive archive = archive_measure();
    assert_true(thing_archive(&thing, &archive, &err));
    *size = archive.at;
    void *bytes = malloc((size_t)*size);
    archive = archive_write(bytes, *size);
    assert_true(thing_archive(&thing, &archive, &err));
    assert_true(archive_check(&archive, true, &err));
    return bytes;
}

TEST(test_comes_back)
{
    Error err = {0};
    int64_t size = 0;
    void *bytes = write_example(&size);
    Thing written = example(), thing = {0};
    Archive archive = archive_read(bytes, size);
    assert_true(thing_archive(&thing, &archive, &err));
    assert_true(archive_check(&archive, true, &err));
    assert_memory_equal(&thing.number, &written.number, sizeof(double));
    assert_memory_equal(thing.numbers, written.numbers, sizeof thing.numbers);
    assert_int_equal(thing.integer, written.integer);
    assert_int_equal(thing.index, 3);
    assert_true(thing.count == written.count && thing.flag);
    assert_memory_equal(thing.octets, written.octets, 5);
    assert_string_equal(thing.text, "abcdefg");
    assert_int_equal(thing.list_count, 3);
    assert_int_equal(thing.room, 4);
    assert_memory_equal(thing.list, values, 3 * sizeof(double));
    memory_free(thing.list);
    free(bytes);
}

// Cut off anywhere, or longer than what is asked for.
TEST(test_length_is_checked)
{
    int64_t size = 0, live = memory_counters().live;
    char *bytes = write_example(&size);
    for (int64_t cut = 0; cut < size; cut++) {
        Error err = {0};
        Thing thing = {0};
        Archive archive = archive_read(bytes, cut);
        assert_false(thing_archive(&thing, &archive, &err));
        assert_int_equal(err.code, ERROR_FILE);
        memory_free(thing.list);
    }
    Error err = {0};
    Archive archive = archive_read(bytes, size);
    archive_section(&archive, "thing");
    assert_true(archive_check(&archive, false, &err));
    assert_false(archive_check(&archive, true, &err));
    assert_int_equal(memory_counters().live, live);
    free(bytes);
}

static bool reads(const void *bytes, int64_t size, char message[ERROR_MESSAGE_SIZE])
{
    Error err = {0};
    Thing thing = {0};
    Archive archive = archive_read(bytes, size);
    bool done = thing_archive(&thing, &archive, &err);
    snprintf(message, ERROR_MESSAGE_SIZE, "%s", err.message);
    memory_free(thing.list);
    return done;
}

// Names, lengths, indices and rooms that cannot be; 12345 stands for what an array would be.
TEST(test_contents_are_checked)
{
    enum { NAME = 24, NUMBER = 8, ARRAY_LENGTH = NAME + NUMBER };
    enum { INDEX = ARRAY_LENGTH + 8 + 3 * 8 + 4, ROOM = INDEX + 4 + 8 + 1 + 8 + 5 + 8 + 8 + 4 };
    enum { COUNT = INDEX + 4 + 4 };   // its higher half
    const struct {
        int64_t at;
        int32_t value;
    } wrong[] = {{0, 'x'},    {ARRAY_LENGTH, 2}, {INDEX, 4},     {INDEX, -2},
                 {COUNT, -1}, {COUNT, 1 << 22},  {ROOM - 4, -1}, {ROOM - 4, 12345},
                 {ROOM, 2},   {ROOM, INT32_MAX}};
    char message[ERROR_MESSAGE_SIZE];
    int64_t size = 0;
    char *bytes = write_example(&size);
    assert_true(reads(bytes, size, message));
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        char kept[4];
        memcpy(kept, bytes + wrong[k].at, 4);
        memcpy(bytes + wrong[k].at, &wrong[k].value, 4);
        assert_false(reads(bytes, size, message));
        assert_non_null(strstr(message, "thing"));
        memcpy(bytes + wrong[k].at, kept, 4);
    }
    free(bytes);
}

// --- arrays that reading makes ------------------------------------------------------------------

typedef struct Made {
    int32_t length;
    double *numbers;   // [length]
    int64_t *counts;
    int32_t *indices;
    uint8_t *octets;
    bool refused;   // by archive_require
} Made;

static void made_archive(Made *made, Archive *archive)
{
    archive_length(archive, &made->length);
    archive_new_numbers(archive, &made->numbers, made->length);
    archive_new_counts(archive, &made->counts, made->length);
    archive_new_indices(archive, &made->indices, made->length, -1, 4);
    archive_new_octets(archive, &made->octets, made->length, 200);
    archive_require(archive, !made->refused);
}

static void made_destroy(Made *made)
{
    memory_free(made->numbers);
    memory_free(made->counts);
    memory_free(made->indices);
    memory_free(made->octets);
    *made = (Made){0};
}

static double made_numbers[3] = {-0.0, NAN, 7};
static int64_t made_counts[3] = {0, 5, INT64_C(1) << 53};
static int32_t made_indices[3] = {-1, 3, 0};
static uint8_t made_octets[3] = {199, 0, 1};

static Made made_example(void)
{
    return (Made){3, made_numbers, made_counts, made_indices, made_octets, false};
}

typedef struct Sent {
    char bytes[1000];
    int64_t size;
    int64_t room;   // of a disk that is full beyond it
} Sent;

static bool take_bytes(void *context, const void *bytes, int64_t size)
{
    Sent *sent = context;
    if (sent->size + size > sent->room) return false;
    memcpy(sent->bytes + sent->size, bytes, (size_t)size);
    sent->size += size;
    return true;
}

static Sent send_made(Made made, int64_t room)
{
    Sent sent = {.room = room};
    Archive archive = archive_send(take_bytes, &sent);
    made_archive(&made, &archive);
    assert_int_equal(archive.failed, room < 1000);
    return sent;
}

// Reads what was sent into zeroed `made`; false: a fault, and nothing is left to free.
static bool read_made(Sent *sent, Made *made, Error *err)
{
    Archive archive = archive_read(sent->bytes, sent->size);
    archive.err = err;
    made_archive(made, &archive);
    assert_true(archive.failed || archive.at <= sent->size);
    bool whole = !archive.failed && archive.at == sent->size;
    if (!whole) made_destroy(made);
    return whole;
}

TEST(test_made_arrays_come_back)
{
    Error err = {0};
    Made made = made_example(), found = {0};
    int64_t live = memory_counters().live;
    Archive archive = archive_measure();
    made_archive(&made, &archive);
    Sent sent = send_made(made, 1000);
    assert_int_equal(sent.size, archive.at);
    assert_true(read_made(&sent, &found, &err));
    assert_int_equal(found.length, 3);
    assert_memory_equal(found.numbers, made_numbers, sizeof made_numbers);
    assert_memory_equal(found.counts, made_counts, sizeof made_counts);
    assert_memory_equal(found.indices, made_indices, sizeof made_indices);
    assert_memory_equal(found.octets, made_octets, sizeof made_octets);
    made_destroy(&found);
    assert_int_equal(memory_counters().live, live);
    for (int64_t room = 0; room < sent.size; room++) send_made(made, room);
}

// Cut off anywhere; lengths, indices and octets that cannot be; no memory for one of them.
TEST(test_made_arrays_are_checked)
{
    Error err = {0};
    Made made = made_example(), found = {0};
    int64_t live = memory_counters().live;
    Sent sent = send_made(made, 1000);
    for (int64_t size = sent.size; sent.size > 0; sent.size--) {
        assert_int_equal(read_made(&sent, &found, &err), sent.size == size);
        made_destroy(&found);
    }
    static const int32_t lengths[] = {-1, 2, 4, (1 << 28) - 1, INT32_MAX};
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        int64_t allocations = memory_counters().allocations;
        sent = send_made(made, 1000);
        memcpy(sent.bytes, &lengths[k], sizeof lengths[k]);
        assert_false(read_made(&sent, &found, &err));
        if (lengths[k] > sent.size) assert_int_equal(memory_counters().allocations, allocations);
        Archive archive = archive_read(sent.bytes, sent.size);
        archive_length(&archive, &found.length);   // nothing that would overflow in a sum
        assert_int_equal(found.length, archive.failed ? 0 : lengths[k]);
        made_destroy(&found);
    }
    int32_t index = 4;
    uint8_t octet = 200;
    int64_t count = -1;
    Made wrong[4] = {made, made, made, made};
    wrong[0].indices = &index;
    wrong[1].octets = &octet;
    wrong[2].counts = &count;
    wrong[3].numbers = values;
    for (int32_t k = 0; k < 4; k++) {
        wrong[k].length = 1;
        sent = send_made(wrong[k], 1000);
        assert_int_equal(read_made(&sent, &found, &err), k == 3);
        made_destroy(&found);
    }
    assert_true(error_is_clean(&err));
    sent = send_made(made, 1000);
    found.refused = true;
    assert_false(read_made(&sent, &found, &err));
    for (int32_t k = 0; k < 5; k++) {
        memory_fail_after(k);
        bool whole = read_made(&sent, &found, &err);
        memory_fail_after(-1);
        assert_int_equal(whole, k == 4);
        assert_int_equal(err.code, k == 4 ? ERROR_NONE : ERROR_MEMORY);
        made_destroy(&found);
        error_clear(&err);
    }
    assert_int_equal(memory_counters().live, live);
}
