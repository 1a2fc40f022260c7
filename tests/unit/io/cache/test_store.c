// SPDX-License-Identifier: GPL-2.0-or-later
// Entries are read back to the bit or not at all: cut, changed, foreign and half-written files
// are refused with a reason, and writers do not disturb each other.
#include "io/cache/store.h"

#include "base/memory.h"
#include "cache_fixture.h"
#include "random_numbers.h"

#include <dirent.h>
#include <sys/wait.h>

static const char KEY[] = "0123456789abcdef0123456789abcdef";
static const char OTHER[] = "0123456789abcdef0123456789abcdee";
enum { LONG_ARRAY = 20000, SHORT_ARRAY = 40 };   // the long one: blocks of the file

// Files in the folder whose name ends in `ending`.
static int32_t count_files(const char *ending)
{
    DIR *listing = opendir(cache);
    int32_t count = 0;
    for (struct dirent *entry; (entry = readdir(listing));) {
        size_t length = strlen(entry->d_name), tail = strlen(ending);
        count += length >= tail && strcmp(entry->d_name + length - tail, ending) == 0;
    }
    closedir(listing);
    return count;
}

// The entry of these tests.
typedef struct Thing {
    int32_t count;
    double *numbers, *odd;   // [count]; [6]
} Thing;

static void thing_archive(void *self, Archive *archive)
{
    Thing *thing = self;
    archive_length(archive, &thing->count);
    archive_new_numbers(archive, &thing->numbers, thing->count);
    archive_new_numbers(archive, &thing->odd, 6);
}

static void thing_destroy(Thing *thing)
{
    memory_free_all(thing->numbers, thing->odd);
    *thing = (Thing){0};
}

static void less_archive(void *self, Archive *archive)
{
    Thing *thing = self;
    archive_length(archive, &thing->count);
}

static void more_archive(void *self, Archive *archive)
{
    thing_archive(self, archive);
    less_archive(self, archive);
}

static double numbers[LONG_ARRAY];
static double odd[6] = {-0.0, INFINITY, NAN, 5e-324, 0x1.fffffffffffffp1023, 1. / 3};

static CacheItem item_of(const char *key, Thing *thing)
{
    return (CacheItem){CACHE_BASIS, key, thing_archive, thing};
}

static void write_thing(int32_t count)
{
    Random random = {.state = 31};
    char note[CACHE_NOTE_SIZE] = "";
    Thing thing = {count, numbers, odd};
    const CacheItem item = item_of(KEY, &thing);
    for (int32_t k = 0; k < LONG_ARRAY; k++) numbers[k] = random_between(&random, -1, 1);
    if (!cache_store(&item, note)) fail_msg("%s", note);
}

// *note is empty where it is good or missing. thing->numbers and thing->odd: the caller's to free.
static bool read_thing(const char *key, Thing *thing, char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    bool found = true;
    const CacheItem item = item_of(key, thing);
    *thing = (Thing){0};
    note[0] = 0;
    if (!cache_load(&item, &found, note, &err)) fail_msg("%s", err.message);
    return found;
}

static void assert_refused(const char *what)
{
    Thing thing;
    char note[CACHE_NOTE_SIZE];
    int64_t live = memory_counters().live;
    if (read_thing(KEY, &thing, note)) fail_msg("%s is trusted", what);
    if (!strstr(note, "a cached basis is not used: it")) fail_msg("%s: %s", what, note);
    assert_true(!thing.numbers && !thing.odd);
    assert_int_equal(memory_counters().live, live);
}

static void path_of(const char *key, char path[2 * PLACE_SIZE])
{
    snprintf(path, 2 * PLACE_SIZE, "%s/%s.basis", cache, key);
}

TEST_BETWEEN(test_round_trip, cache_begin, cache_end)
{
    Thing thing;
    char note[CACHE_NOTE_SIZE];
    static const int32_t counts[] = {0, 1, SHORT_ARRAY, LONG_ARRAY, LONG_ARRAY, 8192 - 24};
    int64_t live = memory_counters().live;
    assert_false(read_thing(KEY, &thing, note));   // missing is no fault
    assert_string_equal(note, "");
    for (size_t round = 0; round < sizeof counts / sizeof *counts; round++) {   // over itself, too
        write_thing(counts[round]);
        assert_true(read_thing(KEY, &thing, note));
        assert_string_equal(note, "");
        assert_int_equal(thing.count, counts[round]);
        assert_int_equal((uintptr_t)thing.numbers % 64, 0);   // as a basis that was just made
        assert_memory_equal(thing.odd, odd, sizeof odd);
        if (thing.count > 0)
            assert_memory_equal(thing.numbers, numbers, (size_t)thing.count * sizeof(double));
        thing_destroy(&thing);
    }
    assert_int_equal(count_files(".part"), 0);
    assert_int_equal(memory_counters().live, live);
}

static char *slurp(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    char *bytes = malloc(1 << 16);
    *size = fread(bytes, 1, 1 << 16, stream);
    fclose(stream);
    return bytes;
}

static void spill(const char *path, const char *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    fclose(stream);
}

// Every length below the whole, and some above it.
TEST_BETWEEN(test_every_cut, cache_begin, cache_end)
{
    char path[2 * PLACE_SIZE];
    size_t size;
    path_of(KEY, path);
    write_thing(SHORT_ARRAY);
    char *bytes = slurp(path, &size);
    assert_int_equal(size, 64 + (4 + 8 + SHORT_ARRAY * 8) + (8 + 6 * 8) + 32);
    for (size_t length = 0; length < size; length++) {
        spill(path, bytes, length);
        assert_refused("a cut file");
    }
    memset(bytes + size, 0, 100);
    for (size_t more = 1; more <= 100; more += 33) {
        spill(path, bytes, size + more);
        assert_refused("a file with something behind its end");
    }
    free(bytes);
}

// One bit in each byte, and each byte set to values that numbers of entries are sensitive to.
TEST_BETWEEN(test_every_byte, cache_begin, cache_end)
{
    Thing thing;
    char path[2 * PLACE_SIZE], note[CACHE_NOTE_SIZE];
    size_t size;
    path_of(KEY, path);
    write_thing(SHORT_ARRAY);
    char *bytes = slurp(path, &size);
    const unsigned char values[] = {0x00, 0x7f, 0x80, 0xff};
    for (size_t at = 0; at < size; at++) {
        char kept = bytes[at];
        bytes[at] = (char)(kept ^ (1 << at % 8));
        spill(path, bytes, size);
        assert_refused("a flipped bit");
        for (size_t v = 0; v < sizeof values; v++) {
            bytes[at] = (char)values[v];
            if (bytes[at] == kept) continue;
            spill(path, bytes, size);
            assert_refused("a changed byte");
        }
        bytes[at] = kept;
    }
    spill(path, bytes, size);
    assert_true(read_thing(KEY, &thing, note));   // it was the byte, not the test
    thing_destroy(&thing);
    // Sizes that would reach beyond the file, or wrap around.
    const int64_t sizes[] = {41, 1000, INT64_MAX, INT64_MAX / 8 + 1, INT64_MIN, -2, 1LL << 61};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        memcpy(bytes + 64 - sizeof sizes[k], &sizes[k], sizeof sizes[k]);
        spill(path, bytes, size);
        assert_refused("a wrong size");
    }
    free(bytes);
}

// A whole file of something else: more, less, or what `list` refuses.
TEST_BETWEEN(test_other_contents, cache_begin, cache_end)
{
    char path[2 * PLACE_SIZE], other[2 * PLACE_SIZE], note[CACHE_NOTE_SIZE] = "";
    Thing thing = {SHORT_ARRAY, numbers, odd};
    CacheItem item = item_of(KEY, &thing);
    item.kind = CACHE_MODES;
    assert_true(cache_store(&item, note));
    path_of(KEY, path);
    snprintf(other, sizeof other, "%s/%s.modes", cache, KEY);
    assert_int_equal(rename(other, path), 0);
    assert_false(read_thing(KEY, &thing, note));
    assert_string_equal(note, "a cached basis is not used: it belongs to another shape");
    item.kind = CACHE_BASIS;
    for (int k = 0; k < 2; k++) {
        thing = (Thing){SHORT_ARRAY, numbers, odd};
        item.list = k == 0 ? less_archive : more_archive;
        assert_true(cache_store(&item, note));
        assert_false(read_thing(KEY, &thing, note));
        assert_string_equal(note, "a cached basis is not used: an array is missing or wrong");
        thing_destroy(&thing);
    }
}

TEST_BETWEEN(test_foreign_files, cache_begin, cache_end)
{
    Thing thing;
    char path[2 * PLACE_SIZE], other[2 * PLACE_SIZE], note[CACHE_NOTE_SIZE];
    path_of(KEY, path);
    path_of(OTHER, other);
    write_thing(SHORT_ARRAY);
    assert_int_equal(rename(path, other), 0);
    assert_false(read_thing(OTHER, &thing, note));
    assert_string_equal(note, "a cached basis is not used: it belongs to another shape");
    write_thing(SHORT_ARRAY);
    size_t size;
    char *bytes = slurp(path, &size);
    bytes[15]++;   // the version's digit
    spill(path, bytes, size);
    assert_false(read_thing(KEY, &thing, note));
    assert_string_equal(note, "a cached basis is not used: it is not a cache file of this version");
    bytes[15]--;
    char *junk = malloc(1 << 16);
    Random random = {.state = 32};
    for (int32_t trial = 0; trial < 20; trial++) {
        for (int32_t k = 0; k < 1 << 16; k++) junk[k] = (char)random_bits(&random);
        if (trial % 2) memcpy(junk, bytes, 16);
        if (trial % 4 == 3) memcpy(junk, bytes, 64);
        spill(path, junk, (size_t)random_index(&random, 1 << 15) + 600);
        assert_refused("junk");
    }
    free(junk);
    free(bytes);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(mkdir(path, 0777), 0);   // as good as missing
    assert_false(read_thing(KEY, &thing, note));
    assert_string_equal(note, "");
}

// Four processes write the same file over and over; a reader beside them sees a whole file or none.
TEST_BETWEEN(test_many_writers, cache_begin, cache_end)
{
    enum { WRITERS = 4, ROUNDS = 25 };
    Thing thing;
    char note[CACHE_NOTE_SIZE];
    pid_t child[WRITERS];
    write_thing(LONG_ARRAY);
    for (int w = 0; w < WRITERS; w++) {
        child[w] = fork();
        if (child[w] != 0) continue;
        Thing written = {LONG_ARRAY, numbers, odd};
        const CacheItem item = item_of(KEY, &written);
        numbers[0] = w;
        for (int32_t round = 0; round < ROUNDS; round++)
            if (!cache_store(&item, note)) _exit(1);
        _exit(0);
    }
    int32_t failed = 0, seen = 0;
    // On a busy machine all may have ended before the first look: then that is the last, too.
    for (int32_t left = WRITERS; left > 0 || seen == 0;) {
        int status;
        if (read_thing(KEY, &thing, note)) {
            seen++;
            assert_true(thing.numbers[0] < WRITERS);
            assert_memory_equal(thing.numbers + 1, numbers + 1, (LONG_ARRAY - 1) * sizeof(double));
        }
        assert_string_equal(note, "");
        thing_destroy(&thing);
        pid_t ended = waitpid(-1, &status, WNOHANG);
        if (ended <= 0) continue;
        failed += !(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        left--;
    }
    assert_int_equal(failed, 0);   // who comes second gives way, without an error
    assert_true(read_thing(KEY, &thing, note));
    thing_destroy(&thing);
    assert_int_equal(count_files(".part"), 0);
}

// Nowhere to write to: a note that says so, and nothing left behind. No cache, no key: no note.
TEST_BETWEEN(test_no_room, cache_begin, cache_end)
{
    Thing thing = {SHORT_ARRAY, numbers, odd};
    CacheItem item = item_of(KEY, &thing);
    char path[2 * PLACE_SIZE], note[CACHE_NOTE_SIZE] = "";
    FileLock lock;
    path_of(KEY, path);
    assert_int_equal(mkdir(path, 0777), 0);   // taken by a folder
    assert_false(cache_store(&item, note));
    assert_non_null(strstr(note, "the basis is not kept for the next run: "));
    assert_false(cache_store(&item, NULL));
    assert_int_equal(count_files(".part"), 0);
    setenv("AMONTONS_CACHE", "/proc/self/missing", 1);
    note[0] = 0;
    assert_false(cache_store(&item, note));
    assert_non_null(strstr(note, "No such file"));
    note[0] = 0;
    setenv("AMONTONS_CACHE", "", 1);
    assert_true(cache_store(&item, note));
    assert_false(cache_lock(KEY, &lock));
    setenv("AMONTONS_CACHE", cache, 1);
    item.key = "";
    assert_true(cache_store(&item, note));
    assert_false(cache_lock("", &lock));
    assert_string_equal(note, "");
}

TEST_BETWEEN(test_removed_and_locked, cache_begin, cache_end)
{
    FileLock lock;
    char path[2 * PLACE_SIZE];
    path_of(KEY, path);
    write_thing(SHORT_ARRAY);
    cache_remove(CACHE_MODES, KEY);
    assert_int_equal(access(path, F_OK), 0);
    cache_remove(CACHE_BASIS, KEY);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_true(cache_lock(KEY, &lock));
    assert_int_equal(count_files(".lock"), 1);
    file_lock_release(&lock);
}

TEST_BETWEEN(test_memory_faults, cache_begin, cache_end)
{
    char note[CACHE_NOTE_SIZE];
    write_thing(SHORT_ARRAY);
    int64_t live = memory_counters().live;
    bool done = false, found;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        Thing thing = {0};
        const CacheItem item = item_of(KEY, &thing);
        memory_fail_after(k);
        done = cache_load(&item, &found, note, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(found, done);
        thing_destroy(&thing);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 6);
    }
    Thing thing = {SHORT_ARRAY, numbers, odd};
    const CacheItem item = item_of(KEY, &thing);
    memory_fail_after(0);
    assert_false(cache_store(&item, note));
    memory_fail_after(-1);
    assert_int_equal(memory_counters().live, live);
}
