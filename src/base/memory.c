// SPDX-License-Identifier: GPL-2.0-or-later
// Each thread has counters of its own, so that simulations in several threads count what is theirs;
// a module counts in those of the library that opened it (amontons_module_tally).
// Every array begins at a multiple of 64 bytes, a cache line and the widest vector, and its size is
// rounded up to whole lines, so that loops over it may be vectorised to its end. Some kernels of
// OpenBLAS (Prescott's) round by where a vector lies in a line: an answer must not depend on where
// an array was made. An array does not know its length: its owner keeps it.
#include "base/memory.h"

#include "base/system.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64, FIRST_ROOM = 16, LARGE_PAGE = 1 << 21 };

static _Thread_local MemoryTally own_tally = {.until_failure = -1};

static MemoryTally *tally_of_thread(void)
{
    return &own_tally;
}

static _Atomic(MemoryTallyFunction) tally_function = tally_of_thread;

static MemoryTally *tally_now(void)
{
    return atomic_load_explicit(&tally_function, memory_order_relaxed)();
}

// *padded: the bytes that were allocated, whole lines of ALIGNMENT.
// NULL with ERROR_MEMORY: also where count * size does not fit into size_t.
static void *allocate(int64_t count, size_t size, size_t *padded, Error *err)
{
    void *array = NULL;
    size_t bytes = 0;
    if (count < 0 || size == 0 || __builtin_mul_overflow((size_t)count, size, &bytes) ||
        bytes > SIZE_MAX / 2)
        FAIL(err, ERROR_MEMORY, "an array of %lld items of %zu bytes is not possible",
             (long long)count, size);
    *padded = (bytes / ALIGNMENT + 1) * ALIGNMENT;
    MemoryTally *tally = tally_now();

    // Counts down to the failure that a test asked for, and stays at 0: from then on all fails, as
    // when memory has run out.
    bool fails = tally->until_failure == 0;
    if (tally->until_failure > 0) tally->until_failure--;

    // Where the system has larger pages it is asked for them: each page that is touched for the
    // first time costs as much as 10 000 additions. aligned_alloc takes multiples of the alignment.
    bool large = *padded >= 2 * LARGE_PAGE;
    if (!fails && !large) array = aligned_alloc(ALIGNMENT, *padded);
    if (!fails && large && posix_memalign(&array, LARGE_PAGE, *padded) != 0) array = NULL;
    if (array && large) system_use_large_pages(array, *padded);
    if (!array)
        FAIL(err, ERROR_MEMORY, "no memory for %lld items of %zu bytes", (long long)count, size);
    tally->counters.allocations++;
    tally->counters.live++;
cleanup:
    return array;
}

// Padding is zeroed as well: no byte is uninitialised.
void *memory_array(int64_t count, size_t size, Error *err)
{
    size_t padded = 0;
    void *array = allocate(count, size, &padded, err);
    return array ? memset(array, 0, padded) : NULL;
}

void *memory_bytes(int64_t size, Error *err)
{
    size_t padded = 0;
    return allocate(size, 1, &padded, err);
}

// Copied rather than realloc'ed: realloc does not keep the alignment. A pointer to any type is read
// and written byte by byte.
bool memory_resize(void *array, int64_t old_count, int64_t new_count, size_t size, Error *err)
{
    void *old = NULL, *longer = memory_array(new_count, size, err);
    if (!longer) return false;
    memcpy(&old, array, sizeof old);
    int64_t kept = old_count < new_count ? old_count : new_count;
    if (old && kept > 0) memcpy(longer, old, (size_t)kept * size);
    memory_free(old);
    memcpy(array, &longer, sizeof longer);
    return true;
}

bool memory_grow(void *list, int32_t count, int32_t *room, size_t size, Error *err)
{
    int64_t more = *room > 0 ? 2 * (int64_t)*room : FIRST_ROOM;
    if (count < *room) return true;
    if (more > INT32_MAX) more = INT32_MAX;
    if (more == *room)
        return FAULT(err, ERROR_MEMORY, "a list of more than %d items is not possible", *room);
    if (!memory_resize(list, *room, more, size, err)) return false;
    *room = (int32_t)more;
    return true;
}

char *memory_text(const char *text, Error *err)
{
    size_t size = strlen(text) + 1;
    char *copy = memory_array((int64_t)size, 1, err);
    if (copy) memcpy(copy, text, size);
    return copy;
}

// Frees only what this file gave out: tests find leaks by the counter of live arrays.
void memory_free(void *array)
{
    if (!array) return;
    tally_now()->counters.live--;
    free(array);
}

void memory_free_list(void *const *arrays, int32_t count)
{
    for (int32_t k = 0; k < count; k++) memory_free(arrays[k]);
}

MemoryCounters memory_counters(void)
{
    return tally_now()->counters;
}

void memory_take_over(MemoryCounters counted)
{
    MemoryCounters *own = &tally_now()->counters;
    own->allocations += counted.allocations;
    own->live += counted.live;
}

// A test that sets it must take it back (-1) also where it fails.
void memory_fail_after(int64_t allocations)
{
    tally_now()->until_failure = allocations;
}

bool memory_may_fail(void)
{
    return tally_now()->until_failure >= 0;
}

MemoryTallyFunction memory_tally(void)
{
    return atomic_load_explicit(&tally_function, memory_order_relaxed);
}

// Exported by modules, by this name: base/module calls it when it has opened one.
void amontons_module_tally(MemoryTallyFunction tally)
{
    atomic_store_explicit(&tally_function, tally, memory_order_relaxed);
}
