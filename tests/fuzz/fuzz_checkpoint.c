// SPDX-License-Identifier: GPL-2.0-or-later
// A saved state whose head and checksum hold, whatever stands between: what is put back into a
// simulation must be refused, or stepped on from without harm. An input edits the state of a real
// run: how it ends, then pieces of place (two bytes), length and new bytes.
#include "amontons.h"
#include "amontons_simulation.h"
#include "base/hash.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>
#include <sys/stat.h>

// HEAD: three words with their lengths, and the time.
enum { CHECKSUM = HASH_TEXT_SIZE - 1, HEAD = 3 * (8 + 33) + 8, STEPS = 40, LONGER = 100 };

typedef struct Stock {
    Scene *scene;
    SavedState state, with_history;
    char *history;   // of the run in a folder
    size_t history_size;
} Stock;

static Stock stock;
static char place[] = "/dev/shm/amontons_fuzz_XXXXXX";

static void remove_place(void)
{
    char command[80];
    snprintf(command, sizeof command, "rm -r '%s'", place);
    if (system(command) != 0) fprintf(stderr, "%s stays\n", place);
    amontons_scene_destroy(stock.scene);
    amontons_state_free(&stock.state);
    amontons_state_free(&stock.with_history);
    free(stock.history);
}

static const char *in_place(const char *name)
{
    static char path[100];
    snprintf(path, sizeof path, "%s/%s", place, name);
    return path;
}

static void put(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(in_place(name), "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) abort();
}

static void give_up(const Error *err)
{
    fprintf(stderr, "%s\n", err->message);
    abort();
}

// A run of some steps, kept.
static void run(const char *folder, SavedState *state)
{
    Error err = {0};
    Simulation *simulation = NULL;
    RunOptions options = {.folder = folder, .checkpoint_every = folder ? 1e-9 : 0};
    StepView view;
    bool finished;
    if (!amontons_simulation_create(stock.scene, &options, &simulation, &err)) give_up(&err);
    for (int k = 0; k < STEPS; k++)
        if (!amontons_simulation_step(simulation, &view, &finished, &err)) give_up(&err);
    if (!amontons_simulation_save(simulation, state, &err)) give_up(&err);
    amontons_simulation_destroy(simulation);
}

static void read_history(void)
{
    struct stat status;
    FILE *file = fopen(in_place("out/history.h5.part"), "rb");
    if (!file) file = fopen(in_place("out/history.h5"), "rb");
    if (!file || fstat(fileno(file), &status) != 0) abort();
    stock.history_size = (size_t)status.st_size;
    stock.history = malloc(stock.history_size);
    if (!stock.history || fread(stock.history, 1, stock.history_size, file) != stock.history_size)
        abort();
    fclose(file);
}

static void begin(void)
{
    static const char *const settings[] = {"mesh.set.nx=3",          "mesh.set.nz=2",
                                           "time.until={U: 0.0055}", "output.fields=none",
                                           "output.figures=[]",      "start.state=relaxed"};
    Error err = {0};
    char path[1000];
    const char *source = getenv("AMONTONS_SOURCE");
    if (!mkdtemp(place)) abort();
    setenv("AMONTONS_CACHE", in_place("cache"), 1);
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", source ? source : ".");
    if (!amontons_scene_read(path, settings, 6, &stock.scene, &err)) give_up(&err);
    run(NULL, &stock.state);
    char folder[100];
    snprintf(folder, sizeof folder, "%s", in_place("out"));
    run(folder, &stock.with_history);
    read_history();
    atexit(remove_place);
}

// *size: room on entry.
static void edit(char *bytes, size_t *size, const uint8_t *data, size_t count)
{
    size_t end = *size - CHECKSUM, room = end + LONGER;
    const uint8_t *behind = data + count;
    if (count == 0) return;
    int ending = *data++ / 2;
    while (behind - data > 3) {
        size_t at = HEAD + (size_t)(data[0] + 256 * data[1]) % (end - HEAD), length = data[2];
        data += 3;
        if (length > (size_t)(behind - data)) length = (size_t)(behind - data);
        if (at + length > end) length = end - at;
        memcpy(bytes + at, data, length);
        data += length;
    }
    if (ending % 4 == 1) end = HEAD + (end - HEAD) * (size_t)(ending / 4) / 32;
    if (ending % 4 == 2) end = room - LONGER + (size_t)(ending / 4);
    *size = end + CHECKSUM;
}

static void seal(char *bytes, size_t size)
{
    Hash hash = hash_start();
    char checksum[HASH_TEXT_SIZE];
    hash_bytes(&hash, bytes, size - CHECKSUM);
    hash_write(&hash, checksum);
    memcpy(bytes + size - CHECKSUM, checksum, CHECKSUM);
}

static void step_on(Simulation *simulation, Error *err)
{
    StepView view;
    bool finished = false;
    for (int k = 0; k < 2 && !finished; k++)
        if (!amontons_simulation_step(simulation, &view, &finished, err)) break;
}

// As `amontons run --resume` does.
static void resume(const SavedState *state, Error *err)
{
    Simulation *simulation = NULL;
    char folder[100];
    int64_t before = memory_counters().live;
    snprintf(folder, sizeof folder, "%s", in_place("out"));
    unlink(in_place("out/history.h5.part"));
    put("out/history.h5", stock.history, stock.history_size);
    put("out/checkpoint.bin", state->bytes, (size_t)state->size);
    RunOptions options = {.folder = folder, .resume = true, .checkpoint_every = -1};
    if (amontons_simulation_create(stock.scene, &options, &simulation, err))
        step_on(simulation, err);
    amontons_simulation_destroy(simulation);
    fuzz_check_freed(before);
}

// Into the same simulation again and again, while that is promised to be whole.
static void restore(const SavedState *state, Error *err)
{
    static Simulation *simulation = NULL;
    static int64_t before;
    RunOptions options = {0};
    if (!simulation) before = memory_counters().live;
    if (!simulation && !amontons_simulation_create(stock.scene, &options, &simulation, err))
        give_up(err);
    if (amontons_simulation_restore(simulation, state, err)) step_on(simulation, err);
    if (error_is_clean(err)) return;
    amontons_simulation_destroy(simulation);
    simulation = NULL;
    fuzz_check_freed(before);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    Error err = {0};
    if (!stock.scene) begin();
    bool in_folder = size > 0 && data[0] % 16 == 1;   // takes three times as long
    const SavedState *from = in_folder ? &stock.with_history : &stock.state;
    size_t length = (size_t)from->size;
    char *bytes = calloc(1, length + LONGER);
    if (!bytes) abort();
    memcpy(bytes, from->bytes, length);
    edit(bytes, &length, data, size);
    seal(bytes, length);
    SavedState state = {.bytes = bytes, .size = (int64_t)length};
    if (in_folder)
        resume(&state, &err);
    else
        restore(&state, &err);
    if (size == 0 && !error_is_clean(&err)) give_up(&err);   // the state as it was
    free(bytes);
    return 0;
}
