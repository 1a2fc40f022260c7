// SPDX-License-Identifier: GPL-2.0-or-later
// The library as a guest in somebody else's process: it leaves locale, signals, folder and output
// alone, and computes separate simulations in separate threads, each as if it were alone.
#include "base/memory.h"
#include "result_place.h"
#include "small_scene.h"

#include <fcntl.h>
#include <locale.h>
#include <pthread.h>

enum { THREADS = 2, SIGNALS = 32 };

// --- what belongs to the process ----------------------------------------------------------------

typedef struct Surroundings {
    char locale[200], folder[4096];
    struct sigaction actions[SIGNALS];
    sigset_t blocked;
    mode_t mask;
} Surroundings;

static void look_around(Surroundings *seen)
{
    memset(seen, 0, sizeof *seen);
    snprintf(seen->locale, sizeof seen->locale, "%s", setlocale(LC_ALL, NULL));
    assert_non_null(getcwd(seen->folder, sizeof seen->folder));
    for (int k = 1; k < SIGNALS; k++) sigaction(k, NULL, &seen->actions[k]);
    sigprocmask(SIG_BLOCK, NULL, &seen->blocked);
    seen->mask = umask(0);
    umask(seen->mask);
}

// With both outputs sent to a file: how many bytes arrive there in `work`.
static long bytes_printed(const char *place, void (*work)(const char *))
{
    int kept[2] = {dup(STDOUT_FILENO), dup(STDERR_FILENO)};
    fflush(NULL);
    int file = open(place_path(place, "printed"), O_CREAT | O_RDWR | O_APPEND, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    work(place);
    fflush(NULL);
    struct stat about;
    fstat(file, &about);
    dup2(kept[0], STDOUT_FILENO);
    dup2(kept[1], STDERR_FILENO);
    close(kept[0]);
    close(kept[1]);
    close(file);
    return (long)about.st_size;
}

// Every module takes part: gmsh, HDF5, VTK, pictures. Then three things that cannot be done.
static void use_everything(const char *place)
{
    Error err = {0}, refused = {0}, unread = {0}, unfinished = {0};
    const char *const all[] = {"output.fields={every_U: 3e-3}", "output.figures=[force]", NULL};
    const char *const wrong[] = {"time.energy_tolerance=1e-14", NULL};
    RunSummary summary;
    Scene *scene = small_scene(all), *none = NULL, *failing = small_scene(wrong);
    char folder[PLACE_SIZE + 20];
    snprintf(folder, sizeof folder, "%s/result", place);
    RunOptions options = {.folder = folder}, nowhere = {0};
    bool done = amontons_run(scene, &options, &summary, &err);
    bool read = amontons_scene_read("no-such-scene.yaml", NULL, 0, &none, &refused);
    bool shown = amontons_render_result("no-such-folder", NULL, 0, &unread);
    bool ended = amontons_run(failing, &nowhere, &summary, &unfinished);
    amontons_scene_destroy(scene);
    amontons_scene_destroy(failing);
    assert_true(done && !read && !shown && !ended);
    assert_int_equal(unfinished.code, ERROR_COMPUTE);
}

static void test_leaves_the_process_alone(void **state)
{
    (void)state;
    char place[PLACE_SIZE] = "";
    Surroundings before, after;
    place_make(place);
    setlocale(LC_ALL, "C.UTF-8");
    signal(SIGUSR1, SIG_IGN);
    look_around(&before);
    long printed = bytes_printed(place, use_everything);
    look_around(&after);
    assert_string_equal(before.locale, after.locale);
    assert_string_equal(before.folder, after.folder);
    assert_int_equal(before.mask, after.mask);
    assert_memory_equal(&before.blocked, &after.blocked, sizeof before.blocked);
    for (int k = 1; k < SIGNALS; k++)
        assert_ptr_equal(before.actions[k].sa_handler, after.actions[k].sa_handler);
    assert_int_equal(printed, 0);
    assert_true(place_has(place, "result/figures/force.png"));
    place_remove(place);
}

// --- threads ------------------------------------------------------------------------------------

typedef struct Work {
    const char *pressure;   // "load.pressure=..."
    char place[PLACE_SIZE];   // empty: nothing is written
    bool done;
    Error err;
    RunSummary summary;
    int64_t live;   // arrays that this thread made and did not free
} Work;

static void *compute(void *argument)
{
    Work *work = argument;
    char folder[PLACE_SIZE + 20];
    const char *const settings[] = {work->pressure, "output.fields={every_U: 3e-3}",
                                    "output.figures=[force]", NULL};
    snprintf(folder, sizeof folder, "%s/result", work->place);
    RunOptions options = {.folder = work->place[0] ? folder : NULL};
    int64_t live = memory_counters().live;
    Scene *scene = small_scene(settings);
    work->done = amontons_run(scene, &options, &work->summary, &work->err);
    amontons_scene_destroy(scene);
    work->live = memory_counters().live - live;
    return NULL;
}

static void test_threads_compute_as_if_alone(void **state)
{
    (void)state;
    Work alone[THREADS] = {{.pressure = "load.pressure=0.003"},
                           {.pressure = "load.pressure=0.006"}};
    Work together[THREADS];
    pthread_t thread[THREADS];
    memcpy(together, alone, sizeof together);
    for (int k = 0; k < THREADS; k++) {
        place_make(together[k].place);
        assert_int_equal(pthread_create(&thread[k], NULL, compute, &together[k]), 0);
    }
    for (int k = 0; k < THREADS; k++) pthread_join(thread[k], NULL);
    for (int k = 0; k < THREADS; k++) {
        compute(&alone[k]);
        if (!together[k].done) fail_msg("%s", together[k].err.message);
        assert_true(alone[k].done);
        assert_memory_equal(&alone[k].summary.mu_max, &together[k].summary.mu_max, sizeof(double));
        assert_int_equal(alone[k].summary.counters.accepted, together[k].summary.counters.accepted);
        assert_int_equal(alone[k].summary.counters.contact_iterations,
                         together[k].summary.counters.contact_iterations);
        assert_int_equal(together[k].live, 0);
        assert_true(place_has(together[k].place, "result/figures/force.png"));
        place_remove(together[k].place);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_leaves_the_process_alone),
        cmocka_unit_test(test_threads_compute_as_if_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
