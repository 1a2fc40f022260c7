// SPDX-License-Identifier: GPL-2.0-or-later
// A cache file whose checksum holds, whatever else it is: arrays of other names and lengths, which
// a shape or a basis must not be made of. The bytes are what follows the head; the end and the sum
// are put on here.
#include "base/hash.h"
#include "io/cache/cache_file.h"
#include "model/basis_cache.h"
#include "model/shape_cache.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>
#include <sys/stat.h>

static const char KEY[] = "0123456789abcdef0123456789abcdef";
enum { HEAD = 64, ARRAY_HEAD = 64, ROOM = 1 << 16 };
static char folder[] = "/dev/shm/amontons_fuzz_XXXXXX";

static void put(const char *ending, const char *bytes, size_t size)
{
    char path[CACHE_PATH_SIZE];
    if (!cache_file_path(KEY, ending, path)) abort();
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) abort();
}

// Adds to the checksum piece by piece as the reader does: each array's head, its values,
// and what follows them up to a multiple of 64 bytes.
static size_t seal(char *bytes, size_t size)
{
    Hash hash = hash_start();
    char digest[HASH_TEXT_SIZE];
    int64_t count = 0;
    size_t at = HEAD;
    hash_bytes(&hash, bytes, HEAD);
    while (at + ARRAY_HEAD <= size) {
        memcpy(&count, bytes + at + CACHE_NAME_SIZE, sizeof count);
        if (count < 0 || (size_t)count > (size - at - ARRAY_HEAD) / 8) break;
        size_t length = (size_t)count * 8, rest = -length % 64;
        if (length + rest > size - at - ARRAY_HEAD) break;
        hash_bytes(&hash, bytes + at, ARRAY_HEAD);
        at += ARRAY_HEAD;
        hash_bytes(&hash, bytes + at, length);
        hash_bytes(&hash, bytes + at + length, rest);
        at += length + rest;
    }
    memset(bytes + at, 0, ARRAY_HEAD);
    count = -1;
    memcpy(bytes + at + CACHE_NAME_SIZE, &count, sizeof count);
    hash_bytes(&hash, bytes + at, ARRAY_HEAD);
    hash_write(&hash, digest);
    memcpy(bytes + at + ARRAY_HEAD, digest, HASH_TEXT_SIZE - 1);
    return at + ARRAY_HEAD + HASH_TEXT_SIZE - 1;
}

static void remove_folder(void)
{
    char command[80];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    if (system(command) != 0) fprintf(stderr, "%s stays\n", folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bool begun = false;
    char bytes[ROOM] = "amontons-cache 2\n", note[CACHE_NOTE_SIZE];
    Error err = {0};
    Shape shape = {0};
    ReducedBulk reduced = {0};
    bool found = false;
    if (!begun && mkdtemp(folder)) atexit(remove_folder);
    begun = true;
    setenv("AMONTONS_CACHE", folder, 1);
    if (size > ROOM - HEAD - 2 * ARRAY_HEAD - HASH_TEXT_SIZE) return 0;
    memcpy(bytes + strlen(bytes), KEY, sizeof KEY - 1);
    memcpy(bytes + HEAD, data, size);
    size = seal(bytes, HEAD + size);
    int64_t before = memory_counters().live;
    put("shape", bytes, size);
    shape_cache_load(KEY, &shape, &found, note, &err);
    shape_destroy(&shape);
    put("basis", bytes, size);
    basis_cache_load(KEY, false, &reduced, &found, note, &err);
    reduced_bulk_destroy(&reduced);
    fuzz_check_freed(before);
    return 0;
}
