// SPDX-License-Identifier: GPL-2.0-or-later
// A cache of its own, empty at first, for each test or group of tests that has these two as its
// setup and teardown.
#ifndef AMONTONS_TESTS_CACHE_FIXTURE_H
#define AMONTONS_TESTS_CACHE_FIXTURE_H

#include "base/hash.h"
#include "result_place.h"

static char cache[PLACE_SIZE];

// A file of the cache in memory, the caller's to free.
static inline char *cache_bytes(const char *name, size_t *size)
{
    struct stat status;
    FILE *file = fopen(place_path(cache, name), "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &status), 0);
    *size = (size_t)status.st_size;
    char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

// Bytes that were changed, as a file whose checksum holds again (io/cache/store.c).
static inline void cache_put(const char *name, char *bytes, size_t size)
{
    enum { BLOCK = 1 << 16, SUM = HASH_TEXT_SIZE - 1 };
    char digest[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    size_t end = size - SUM;
    for (size_t at = 0; at < end; at += BLOCK)
        hash_bytes(&hash, bytes + at, end - at < BLOCK ? end - at : BLOCK);
    hash_write(&hash, digest);
    memcpy(bytes + end, digest, SUM);
    FILE *file = fopen(place_path(cache, name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static int cache_begin(void **state)
{
    (void)state;
    place_make(cache);
    return setenv("AMONTONS_CACHE", cache, 1);
}

static int cache_end(void **state)
{
    (void)state;
    place_remove(cache);
    unsetenv("AMONTONS_CACHE_LIMIT");
    return setenv("AMONTONS_CACHE", "", 1);
}

#endif
