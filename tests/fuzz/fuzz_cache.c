// SPDX-License-Identifier: GPL-2.0-or-later
// A cache file whose checksum holds, whatever else it is: what no mesh or basis consists of.
// The bytes are those between head and checksum, which are put on here.
#include "base/hash.h"
#include "io/mesh/mesh_cache.h"
#include "model/basis_cache.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>

static const char KEY[] = "0123456789abcdef0123456789abcdef";
enum { HEAD = 64, KEY_SIZE = HASH_TEXT_SIZE - 1, ROOM = 1 << 16 };   // one block
static char folder[] = "/dev/shm/amontons_fuzz_XXXXXX";

// Head and checksum as io/cache/store.c has them.
static void put(const char *ending, char *bytes, int64_t size)
{
    char path[sizeof folder + 48], digest[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    memset(bytes, 0, HEAD);
    memcpy(bytes, "amontons-cache 6", 16);
    memcpy(bytes + 16, KEY, KEY_SIZE);
    memcpy(bytes + 16 + KEY_SIZE, ending, strlen(ending));
    memcpy(bytes + HEAD - sizeof size, &size, sizeof size);
    hash_bytes(&hash, bytes, (size_t)(HEAD + size));
    hash_write(&hash, digest);
    memcpy(bytes + HEAD + size, digest, KEY_SIZE);
    snprintf(path, sizeof path, "%s/%s.%s", folder, KEY, ending);
    FILE *file = fopen(path, "wb");
    size_t all = (size_t)(HEAD + size + KEY_SIZE);
    if (!file || fwrite(bytes, 1, all, file) != all || fclose(file) != 0) abort();
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
    char bytes[ROOM], note[CACHE_NOTE_SIZE];
    Error err = {0};
    MeshFile mesh;
    ReducedBulk reduced;
    bool found = false;
    if (!begun && mkdtemp(folder)) atexit(remove_folder);
    begun = true;
    setenv("AMONTONS_CACHE", folder, 1);
    if (size > ROOM - HEAD - KEY_SIZE) return 0;
    memcpy(bytes + HEAD, data, size);
    int64_t before = memory_counters().live;
    put("mesh", bytes, (int64_t)size);
    mesh_cache_load(KEY, &mesh, &found, &err);
    mesh_file_destroy(&mesh);
    put("basis", bytes, (int64_t)size);
    basis_cache_load(KEY, false, &reduced, &found, note, &err);
    reduced_bulk_destroy(&reduced);
    fuzz_check_freed(before);
    return 0;
}
