// SPDX-License-Identifier: GPL-2.0-or-later
// The library as a guest in somebody else's process: it leaves locale, signals, folder and output
// alone, and computes separate simulations in separate threads, each as if it were alone.
#include "amontons_simulation.h"
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
static long bytes_printed(const char *place, void (*work)(const char *, Error *), Error *err)
{
    int kept[2] = {dup(STDOUT_FILENO), dup(STDERR_FILENO)};
    fflush(NULL);
    int file = open(place_path(place, "printed"), O_CREAT | O_RDWR | O_APPEND, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    work(place, err);
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

// Every module takes part: gmsh, HDF5, VTK, pictures. Then three things that cannot be done. What
// went wrong is the caller's to say: here nobody would see it.
static void use_everything(const char *place, Error *err)
{
    Error refused = {0}, unread = {0}, unfinished = {0};
    const char *const all[] = {"output.fields={every_U: 3e-3}", "output.figures=[force]", NULL};
    const char *const wrong[] = {"time.energy_tolerance=1e-14", NULL};
    RunSummary summary;
    Scene *scene = small_scene(all), *none = NULL, *failing = small_scene(wrong);
    char folder[PLACE_SIZE + 20];
    snprintf(folder, sizeof folder, "%s/result", place);
    RunOptions options = {.folder = folder}, nowhere = {0};
    bool done = amontons_run(scene, &options, &summary, err);
    bool read = amontons_scene_read("no-such-scene.yaml", NULL, 0, &none, &refused);
    bool shown = amontons_render_result("no-such-folder", NULL, &unread);
    bool ended = amontons_run(failing, &nowhere, &summary, &unfinished);
    amontons_scene_destroy(scene);
    amontons_scene_destroy(failing);
    if (done && (read || shown || ended || unfinished.code != ERROR_COMPUTE))
        error_set(err, ERROR_COMPUTE, __FILE__, __LINE__, "one of the three things was done");
}

TEST(test_leaves_the_process_alone)
{
    char place[PLACE_SIZE] = "";
    Surroundings before, after;
    Error err = {0};
    place_make(place);
    setlocale(LC_ALL, "C.UTF-8");
    signal(SIGUSR1, SIG_IGN);
    look_around(&before);
    long printed = bytes_printed(place, use_everything, &err);
    look_around(&after);
    assert_string_equal(err.message, "");
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

// Where a process writes numbers with a comma everything works, and the process keeps its comma.
// The locale is made here: systems have few.
TEST(test_numbers_with_a_comma)
{
    char place[PLACE_SIZE] = "", command[2 * PLACE_SIZE], written[20], report[20000] = "";
    Error failed = {0};
    place_make(place);
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 2>/dev/null",
             place);
    bool made = system(command) == 0 && setenv("LOCPATH", place, 1) == 0 &&
                setlocale(LC_NUMERIC, "de_DE.UTF-8");
    if (made) {
        use_everything(place, &failed);
        place_read(place, "result/run.json", report, sizeof report);
    }
    snprintf(written, sizeof written, "%.1f", 0.5);
    bool kept = strcmp(setlocale(LC_NUMERIC, NULL), "de_DE.UTF-8") == 0;
    setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
    place_remove(place);
    if (!made) {
        print_message("skipped: localedef makes no de_DE.UTF-8 (Debian's package locales)\n");
        skip();
    }
    assert_string_equal(failed.message, "");
    assert_true(kept);
    assert_string_equal(written, "0,5");
    assert_non_null(strstr(report, "\"mu_max\": 0."));
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

TEST(test_threads_compute_as_if_alone)
{
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

// --- what a caller sees between steps -----------------------------------------------------------

// The arrays against the scalars of the same step, and against what the law and the load say.
static void check_contact(const StepView *view)
{
    const ContactView *contact = &view->contact;
    double fastest = 0, pressure = 0, shear = 0;
    for (int32_t i = 0; i < contact->count; i++) {
        // Nodes of a uniform line: the outer two have half a cell each.
        double weight = 0.1 * (i == 0 || i == contact->count - 1 ? 0.5 : 1);
        fastest = fmax(fastest, fabs(contact->slip_rate[i]));
        pressure += weight * contact->pressure[i];
        shear += weight * contact->shear[i];
        assert_near("x", contact->x[i], 0.1 * i, 1e-9);
        assert_true(fabs(contact->shear[i]) <= 0.38 * contact->pressure[i] + 1e-12);
        if (contact->status[i] == NODE_STICKS) assert_true(contact->slip_rate[i] == 0);
        if (contact->status[i] == NODE_OPEN) assert_true(contact->pressure[i] == 0);
        if (contact->status[i] == NODE_SLIPS) assert_true(fabs(contact->slip_rate[i]) >= 3.4e-4);
    }
    assert_near("fastest", fastest, view->max_slip_rate, 0);
    if (view->certified && view->slidings == 0) {   // slow: inertia has little part
        assert_near("load", pressure, 0.003, 1e-5);
        assert_near("shear", shear, view->mu * 0.003, 1e-5);
    }
}

TEST(test_arrays_of_a_step)
{
    Error err = {0};
    Simulation *simulation = NULL;
    StepView start, view;
    BlockView block;
    RunOptions options = {.whole_block = true};
    const char *const settings[] = {NULL};
    Scene *scene = small_scene(settings);
    bool finished = false;
    double slip = 0, mean_slip = 0;
    assert_true(amontons_simulation_create(scene, &options, &simulation, &err));
    amontons_simulation_view(simulation, &start);
    assert_int_equal(start.contact.count, 11);
    double x_start = 0;
    assert_true(amontons_simulation_block(simulation, &block, &err));
    for (int32_t i = 0; i < block.nodes; i++)
        if (block.position[2 * i] < 1e-9 && block.position[2 * i + 1] < 1e-9)
            x_start = block.displacement[2 * i];
    while (!finished) {
        double before = start.contact.slip[10], rate = start.contact.slip_rate[10];
        assert_true(amontons_simulation_step(simulation, &view, &finished, &err));
        assert_ptr_equal(view.contact.slip, start.contact.slip);   // they stay where they are
        check_contact(&view);
        // The slip of the last node is the sum of its rates (trapezia: of second order).
        slip += 0.5 * view.step_size * (rate + view.contact.slip_rate[10]);
        mean_slip += view.contact.slip[10] - before;
    }
    assert_near("slip", slip, mean_slip, 0.02 * mean_slip);
    assert_true(amontons_simulation_block(simulation, &block, &err));
    int32_t found = 0;
    for (int32_t i = 0; i < block.nodes; i++) {
        if (block.position[2 * i] > 1e-9 || block.position[2 * i + 1] > 1e-9) continue;
        assert_near("trailing edge", block.displacement[2 * i] - x_start, view.contact.slip[0],
                    1e-12);
        found++;
    }
    assert_int_equal(found, 1);
    assert_int_equal(block.first_node[block.elements], 4 * block.elements);
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
}

TEST(test_block_must_be_asked_for)
{
    Error err = {0};
    Simulation *simulation = NULL;
    BlockView block;
    RunOptions options = {0};
    const char *const settings[] = {NULL};
    Scene *scene = small_scene(settings);
    assert_true(amontons_simulation_create(scene, &options, &simulation, &err));
    assert_false(amontons_simulation_block(simulation, &block, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    amontons_simulation_destroy(simulation);
    amontons_scene_destroy(scene);
}
