// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/memory.h"

#include "near.h"

#include <string.h>

TEST(test_zeroed_and_aligned)
{
    Error err = {0};
    for (int64_t count = 0; count < 300; count += 7) {
        unsigned char *dirt = memory_array(count, 1, &err);   // the next array may get its place
        memset(dirt, 0xAB, (size_t)count);
        memory_free(dirt);
        unsigned char *bytes = memory_array(count, 1, &err);
        assert_non_null(bytes);
        assert_int_equal((uintptr_t)bytes % 64, 0);
        for (int64_t k = 0; k < count; k++) assert_int_equal(bytes[k], 0);
        memory_free(bytes);
    }
    assert_true(error_is_clean(&err));
}

TEST(test_impossible_sizes)
{
    const struct {
        int64_t count;
        size_t size;
    } impossible[] = {{-1, 8},        {INT64_MIN, 1}, {INT64_MAX, 8}, {1LL << 61, 8},
                      {1LL << 62, 4}, {3, 0},         {2, SIZE_MAX},  {1, SIZE_MAX / 2 + 1}};
    MemoryCounters before = memory_counters();
    for (size_t k = 0; k < sizeof impossible / sizeof impossible[0]; k++) {
        Error err = {0};
        assert_null(memory_array(impossible[k].count, impossible[k].size, &err));
        assert_int_equal(err.code, ERROR_MEMORY);
        assert_non_null(strstr(err.message, "is not possible"));
    }
    assert_int_equal(memory_counters().allocations, before.allocations);
    assert_int_equal(memory_counters().live, before.live);
}

TEST(test_counters)
{
    Error err = {0};
    MemoryCounters before = memory_counters();
    double *a = NEW_ARRAY(double, 10, &err);
    char *text = memory_text("interface", &err);
    assert_string_equal(text, "interface");
    assert_int_equal(memory_counters().allocations, before.allocations + 2);
    assert_int_equal(memory_counters().live, before.live + 2);
    memory_free(a);
    memory_free(text);
    memory_free(NULL);
    assert_int_equal(memory_counters().allocations, before.allocations + 2);
    assert_int_equal(memory_counters().live, before.live);
}

TEST(test_resize)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    int32_t *list = NULL;
    assert_true(memory_resize(&list, 0, 3, sizeof(int32_t), &err));
    for (int32_t k = 0; k < 3; k++) list[k] = k + 1;
    assert_true(memory_resize(&list, 3, 100, sizeof(int32_t), &err));
    for (int32_t k = 0; k < 100; k++) assert_int_equal(list[k], k < 3 ? k + 1 : 0);
    assert_true(memory_resize(&list, 100, 2, sizeof(int32_t), &err));
    assert_int_equal(list[0], 1);
    assert_int_equal(list[1], 2);
    assert_int_equal(memory_counters().live, live + 1);

    memory_fail_after(0);   // the old items stay where they are
    assert_false(memory_resize(&list, 2, 50, sizeof(int32_t), &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_int_equal(list[1], 2);
    assert_int_equal(memory_counters().live, live + 1);
    memory_free(list);
    assert_int_equal(memory_counters().live, live);
}

// A list fills up by ones: what stands in it stays, new room is zeroed, allocations are few.
TEST(test_grow)
{
    Error err = {0};
    MemoryCounters before = memory_counters();
    int32_t *list = NULL, room = 0;
    for (int32_t count = 0; count < 1000; count++) {
        assert_true(memory_grow(&list, count, &room, sizeof(int32_t), &err));
        assert_true(room > count && list[count] == 0);
        list[count] = 3 * count + 1;
    }
    for (int32_t k = 0; k < 1000; k++) assert_int_equal(list[k], 3 * k + 1);
    assert_true(memory_counters().allocations - before.allocations <= 10);   // doubled each time
    assert_int_equal(memory_counters().live, before.live + 1);

    memory_fail_after(0);
    int32_t full = room;
    const int32_t *same = list;
    assert_true(memory_grow(&list, room - 1, &room, sizeof(int32_t), &err) && list == same);
    assert_false(memory_grow(&list, room, &room, sizeof(int32_t), &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_int_equal(room, full);
    assert_int_equal(list[999], 2998);
    room = INT32_MAX;   // as full as a list can be: refused, nothing touched
    err = (Error){0};
    assert_false(memory_grow(&list, room, &room, sizeof(int32_t), &err));
    assert_true(list == same);
    assert_int_equal(err.code, ERROR_MEMORY);
    memory_free(list);
    assert_int_equal(memory_counters().live, before.live);
}

TEST(test_faults)
{
    memory_fail_after(2);
    for (int32_t k = 0; k < 6; k++) {
        Error err = {0};
        char *text = memory_text("x", &err);
        assert_int_equal(text != NULL, k < 2);   // and every later one fails too
        assert_int_equal(err.code, k < 2 ? ERROR_NONE : ERROR_MEMORY);
        memory_free(text);
    }
    memory_fail_after(-1);
    Error err = {0};
    void *array = memory_array(4, 8, &err);
    assert_non_null(array);
    memory_free(array);
}

// Counted, aligned and failing like the others; what stands in them is for the caller to say.
TEST(test_bytes)
{
    Error err = {0};
    MemoryCounters before = memory_counters();
    unsigned char *bytes = memory_bytes(1000001, &err);
    assert_int_equal((uintptr_t)bytes % 64, 0);
    memset(bytes, 0xa5, 1000001);
    assert_int_equal(memory_counters().allocations, before.allocations + 1);
    assert_int_equal(memory_counters().live, before.live + 1);
    memory_free(bytes);
    assert_int_equal(memory_counters().live, before.live);
    assert_null(memory_bytes(-1, &err));
    assert_int_equal(err.code, ERROR_MEMORY);
    error_clear(&err);
    memory_fail_after(0);
    assert_null(memory_bytes(8, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
}
