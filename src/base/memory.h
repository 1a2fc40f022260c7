// SPDX-License-Identifier: GPL-2.0-or-later
// The program's one allocator: zeroed, 64-byte aligned arrays that count themselves and can be
// told to fail, so that "nothing is allocated in a step" and "every error path frees" can be
// tested. Sizes in bytes are computed only here, checked for overflow.
#ifndef AMONTONS_BASE_MEMORY_H
#define AMONTONS_BASE_MEMORY_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct MemoryCounters {
    int64_t allocations;   // calls that returned memory, in this thread, since it started
    int64_t live;   // arrays not yet freed, less those that this thread freed for others
} MemoryCounters;

// `count` items of `size` bytes, zeroed, 64-byte aligned; count 0 gives a valid pointer.
// NULL with ERROR_MEMORY set when count is negative, too large, or memory is short.
void *memory_array(int64_t count, size_t size, Error *err);

// The same of `size` bytes, not zeroed: for a buffer that a file is read into at once.
void *memory_bytes(int64_t size, Error *err);

// Makes the array that *array points to (array: a T **; of NULL a new one) longer or shorter; new
// items are zeroed. On failure it is untouched.
bool memory_resize(void *array, int64_t old_count, int64_t new_count, size_t size, Error *err);

// Makes room for one more than `count` items in the list that *list points to (list: a T **): twice
// as much where it is full. *room: items that it can hold; 0 at first, with *list NULL. On failure
// both are untouched.
bool memory_grow(void *list, int32_t count, int32_t *room, size_t size, Error *err);

char *memory_text(const char *text, Error *err);   // an owned copy
void memory_free(void *array);   // NULL is fine
void memory_free_list(void *const *arrays, int32_t count);   // for memory_free_all
MemoryCounters memory_counters(void);
void memory_take_over(MemoryCounters counted);   // by a thread that has ended, into this one's

// Fault injection: this thread's allocation after `allocations` more successful ones fails, and
// every later one too, until called with -1. For tests only.
void memory_fail_after(int64_t allocations);
bool memory_may_fail(void);   // a failure is asked for: all is allocated in this thread then

// A module has a copy of base/ in it. It counts where the library that opened it does.
typedef struct MemoryTally {
    MemoryCounters counters;
    int64_t until_failure;   // allocations; below 0: none is asked for
} MemoryTally;
typedef MemoryTally *(*MemoryTallyFunction)(void);   // that of the calling thread
MemoryTallyFunction memory_tally(void);
void amontons_module_tally(MemoryTallyFunction tally);

// NEW_ARRAY(double, n, err): a zeroed double[n], or NULL with the error set.
#define NEW_ARRAY(type, count, err) ((type *)memory_array((count), sizeof(type), (err)))

// memory_free of each of several arrays.
#define memory_free_all(...)                                                                       \
    memory_free_list((void *[]){__VA_ARGS__},                                                      \
                     (int32_t)(sizeof((void *[]){__VA_ARGS__}) / sizeof(void *)))

#endif
