// SPDX-License-Identifier: GPL-2.0-or-later
// A run that dies between two steps and is gone on with ends as if it had not, to the bit; a state
// can be put back; and what does not belong to a simulation is refused before anything is touched.
#include "run/simulation_state.h"

#include "base/computation.h"
#include "base/hash.h"
#include "base/memory.h"
#include "io/hdf5/result_file.h"
#include "cache_fixture.h"
#include "small_scene.h"

#include <sys/wait.h>

enum { TEXT_MAX = 1 << 18 };

// --- two results --------------------------------------------------------------------------------

static void compare_series(ArrayFile *first, ArrayFile *second, ResultSeries series)
{
    Error err = {0};
    double *one = NULL, *other = NULL;
    int64_t rows[2];
    int32_t width[2];
    assert_true(result_file_read_series(first, series, &one, &rows[0], &width[0], &err));
    assert_true(result_file_read_series(second, series, &other, &rows[1], &width[1], &err));
    assert_int_equal(rows[0], rows[1]);
    assert_int_equal(width[0], width[1]);
    assert_memory_equal(one, other, (size_t)(rows[0] * width[0]) * sizeof(double));
    memory_free(one);
    memory_free(other);
}

static void compare_table(ArrayFile *first, ArrayFile *second, ResultTable table)
{
    Error err = {0};
    double *one = NULL, *other = NULL;
    int32_t rows[2];
    assert_true(result_file_read_table(first, table, &one, &rows[0], &err));
    assert_true(result_file_read_table(second, table, &other, &rows[1], &err));
    assert_int_equal(rows[0], rows[1]);
    assert_memory_equal(one, other, (size_t)rows[0] * sizeof(double));
    memory_free(one);
    memory_free(other);
}

static void compare_histories(const char *whole, const char *cut)
{
    Error err = {0};
    ArrayFile *first = result_file_open(whole, &err), *second = result_file_open(cut, &err);
    if (!error_is_clean(&err)) fail_msg("%s", err.message);
    for (ResultSeries series = 0; series < RESULT_SERIES_COUNT; series++)
        if (array_file_has(first, result_series_name(series)))
            compare_series(first, second, series);
    for (ResultTable table = 0; table < RESULT_TABLES_COUNT; table++)
        compare_table(first, second, table);
    for (ResultNumber number = 0; number < RESULT_NUMBERS_COUNT; number++) {
        double one = result_file_number(first, number), other = result_file_number(second, number);
        assert_memory_equal(&one, &other, sizeof one);
    }
    array_file_close(first, &err);
    array_file_close(second, &err);
}

// run.json without its times and the line that says how often it was gone on with.
static void read_report(const char *folder, char *text)
{
    place_read(folder, "run.json", text, TEXT_MAX);
    for (const char *const *key = (const char *const[]){"\"resumed\"", "\"timing_s\"", NULL}; *key;
         key++) {
        char *from = strstr(text, *key);
        assert_non_null(from);
        char *to = strchr(from, **key == '"' && (*key)[1] == 'r' ? '\n' : '}');
        memmove(from, to, strlen(to) + 1);
    }
}

static void compare_results(const char *whole, const char *cut)
{
    static char texts[2][TEXT_MAX];
    compare_histories(whole, cut);
    read_report(whole, texts[0]);
    read_report(cut, texts[1]);
    assert_string_equal(texts[0], texts[1]);
}

// --- runs that die ------------------------------------------------------------------------------

static StepView step(Simulation *simulation, int32_t steps)
{
    Error err = {0};
    StepView view;
    bool finished;
    for (int32_t k = 0; k < steps; k++)
        if (!amontons_simulation_step(simulation, &view, &finished, &err))
            fail_msg("%s", err.message);
    return view;
}

static Simulation *begin(const Scene *scene, const char *folder, bool resume)
{
    Error err = {0};
    RunOptions options = {.folder = folder, .resume = resume};
    Simulation *simulation = NULL;
    if (!amontons_simulation_create(scene, &options, &simulation, &err))
        fail_msg("%s", err.message);
    return simulation;
}

// Dies some steps after its checkpoint; what the history has of them by then is flushed.
static void run_until_killed(const Scene *scene, const char *folder, bool resume, int32_t steps)
{
    Error err = {0};
    int status = 0;
    pid_t child = fork();
    if (child == 0) {
        Simulation *simulation = begin(scene, folder, resume);
        step(simulation, steps);
        if (!checkpoint_now(simulation, &err)) _exit(1);
        step(simulation, 37);
        if (!history_sync(&simulation->history, &err)) _exit(1);
        kill(getpid(), SIGKILL);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

// In a process of its own, like all before: threads of libraries do not come along into a child.
static void run_to_end(const Scene *scene, const char *folder, bool resume)
{
    Error err = {0};
    RunSummary summary;
    RunOptions options = {.folder = folder, .resume = resume};
    int status = 0;
    pid_t child = fork();
    if (child == 0) _exit(amontons_run(scene, &options, &summary, &err) ? 0 : 1);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

// Killed on its way, so often.
static void compare_killed(const char *const *settings, int32_t steps, int32_t kills)
{
    char place[PLACE_SIZE], whole[2 * PLACE_SIZE], cut[2 * PLACE_SIZE];
    place_make(place);
    snprintf(whole, sizeof whole, "%s/whole", place);
    snprintf(cut, sizeof cut, "%s/cut", place);
    Scene *scene = small_scene(settings);
    scene->reduction.cache = true;
    run_to_end(scene, cut, false);   // fills the cache
    place_remove(cut);
    run_to_end(scene, whole, false);
    for (int32_t k = 0; k < kills; k++) run_until_killed(scene, cut, k > 0, steps);
    run_to_end(scene, cut, true);
    compare_results(whole, cut);
    amontons_scene_destroy(scene);
    place_remove(place);
}

// The rod's own way is part of the state.
TEST(test_reduced)
{
    compare_killed((const char *const[]){"time.until={U: 0.008}", "rod.stiffness=1", NULL}, 70, 3);
}

// Strong friction lets corners open.
TEST(test_open_nodes)
{
    compare_killed((const char *const[]){"mesh.set.nx=8", "mesh.set.nz=8", "rod.height=0.45",
                                         "friction.mu_static=0.9", "friction.mu_kinetic=0.3",
                                         "time.until={U: 0.012}", NULL},
                   90, 3);
}

// --- states -------------------------------------------------------------------------------------

static void expect_same(const StepView *one, const StepView *other)
{
    assert_memory_equal(&one->t, &other->t, sizeof(double));
    assert_memory_equal(&one->mu, &other->mu, sizeof(double));
    assert_memory_equal(&one->max_slip_rate, &other->max_slip_rate, sizeof(double));
    assert_memory_equal(one->contact.slip, other->contact.slip,
                        (size_t)one->contact.count * sizeof(double));
}

// Back in the same simulation, and forward in another one.
static void expect_put_back(const Scene *scene, int32_t steps, bool changed)
{
    Error err = {0};
    SavedState saved = {0};
    int64_t live = memory_counters().live;
    Simulation *one = begin(scene, NULL, false), *other = begin(scene, NULL, false);
    step(one, steps);
    if (changed) {
        assert_true(amontons_simulation_set_rod_velocity(one, 2e-5, &err));
        assert_true(amontons_simulation_set_pressure(one, 0.0035, &err));
    }
    StepView before = step(one, 5), shown;
    assert_true(amontons_simulation_save(one, &saved, &err));
    StepView after = step(one, steps);
    double slip = after.contact.slip[2];
    assert_true(amontons_simulation_restore(other, &saved, &err));
    amontons_simulation_view(other, &shown);
    assert_memory_equal(&shown.mu, &before.mu, sizeof(double));
    StepView again = step(other, steps);
    expect_same(&after, &again);
    assert_true(amontons_simulation_restore(one, &saved, &err));
    StepView third = step(one, steps);
    expect_same(&third, &again);
    assert_memory_equal(&third.contact.slip[2], &slip, sizeof slip);
    amontons_state_free(&saved);
    amontons_simulation_destroy(one);
    amontons_simulation_destroy(other);
    assert_int_equal(memory_counters().live, live);
}

// With all that a caller may have changed on the way.
TEST(test_put_back)
{
    Scene *scene = small_scene((const char *const[]){"reduction.use=never", "mesh.set.nx=6", NULL});
    expect_put_back(scene, 150, true);
    amontons_scene_destroy(scene);
}

TEST(test_put_back_explicit)
{
    Scene *scene = small_scene((const char *const[]){
        "mesh.set.nx=4", "mesh.set.nz=4", "time.scheme=explicit", "rod.stiffness=0.3", NULL});
    expect_put_back(scene, 40, false);
    amontons_scene_destroy(scene);
}

static void expect_refused(Simulation *simulation, const SavedState *saved, const char *words)
{
    Error err = {0};
    assert_false(amontons_simulation_restore(simulation, saved, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, words)) fail_msg("%s", err.message);
}

// Every byte counts, and so do scene and mesh. A refusal changes nothing.
TEST(test_refused)
{
    Error err = {0};
    SavedState saved = {0}, shorter;
    Scene *scene = small_scene((const char *const[]){"reduction.cache=true", NULL});
    Scene *finer = small_scene((const char *const[]){"mesh.set.nz=9", NULL});
    Simulation *one = begin(scene, NULL, false), *twin = begin(scene, NULL, false),
               *other = begin(finer, NULL, false);
    step(one, 20);
    step(twin, 20);
    assert_true(amontons_simulation_save(one, &saved, &err));
    expect_refused(other, &saved, "another scene or mesh");
    for (int64_t at = 0; at < saved.size; at += saved.size / 97) {
        ((char *)saved.bytes)[at] ^= 16;
        expect_refused(one, &saved, "checksum");
        ((char *)saved.bytes)[at] ^= 16;
    }
    shorter = (SavedState){.bytes = saved.bytes, .size = 20};
    expect_refused(one, &shorter, "too short");
    StepView view = step(one, 50), twins = step(twin, 50);
    expect_same(&view, &twins);
    amontons_state_free(&saved);
    Simulation *const all[] = {one, twin, other};
    for (int k = 0; k < 3; k++) amontons_simulation_destroy(all[k]);
    amontons_scene_destroy(scene);
    amontons_scene_destroy(finer);
}

// The checksum of what was changed on purpose.
static void seal(SavedState *saved)
{
    char text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    int64_t size = saved->size - (HASH_TEXT_SIZE - 1);
    hash_bytes(&hash, saved->bytes, (size_t)size);
    hash_write(&hash, text);
    memcpy((char *)saved->bytes + size, text, HASH_TEXT_SIZE - 1);
}

// The state of another version, or half a state, under a checksum that holds.
TEST(test_of_other_versions)
{
    Error err = {0};
    SavedState saved = {0}, none;
    Scene *scene = small_scene((const char *const[]){"mesh.set.nx=4", "mesh.set.nz=4", NULL});
    Simulation *one = begin(scene, NULL, false), *twin = begin(scene, NULL, false);
    step(one, 5);
    step(twin, 5);
    assert_true(amontons_simulation_save(one, &saved, &err));
    char word[HASH_TEXT_SIZE];
    Hash computation = computation_hash();
    hash_write(&computation, word);
    char *sources = memmem(saved.bytes, (size_t)saved.size, word, sizeof word);
    assert_non_null(sources);
    *sources ^= 1;
    seal(&saved);
    expect_refused(one, &saved, "it was saved by a build of other sources");
    *sources ^= 1;
    char *format = (char *)saved.bytes + 8;   // behind its length
    *format ^= 8;
    seal(&saved);
    expect_refused(one, &saved, "not a saved state as this version writes it");
    *format ^= 8;
    saved.size = 3 * (8 + 33) + 8 + 200;   // head, time and some more
    seal(&saved);
    assert_false(amontons_simulation_restore(twin, &saved, &err));
    assert_non_null(strstr(err.message, "the state cannot be put back"));
    saved.size = 80;
    seal(&saved);
    expect_refused(one, &saved, "not a saved state as this version writes it");
    err = (Error){0};
    assert_false(amontons_state_read("/dev/null", &none, &err));
    assert_non_null(strstr(err.message, "/dev/null is a device, not a file"));
    assert_false(amontons_state_read("/proc/none/at/all", &none, &err));

    // Larger than any memory, and all holes.
    char place[PLACE_SIZE];
    place_make(place);
    place_write(place, "checkpoint.bin", "");
    assert_int_equal(truncate(place_path(place, "checkpoint.bin"), (off_t)1 << 42), 0);
    err = (Error){0};
    assert_false(amontons_state_read(place_path(place, "checkpoint.bin"), &none, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "more than the state of a run can have"));
    place_remove(place);
    step(one, 5);
    amontons_state_free(&saved);
    amontons_simulation_destroy(one);
    amontons_simulation_destroy(twin);
    amontons_scene_destroy(scene);
}

// A history goes back with the state, and no farther than it has steps.
TEST(test_history_is_cut)
{
    Error err = {0};
    SavedState early = {0}, late = {0};
    RunSummary summary;
    char place[PLACE_SIZE], folder[2][2 * PLACE_SIZE];
    place_make(place);
    Scene *scene = small_scene((const char *const[]){"reduction.cache=true", NULL});
    Simulation *run[2];
    for (int k = 0; k < 2; k++) {
        snprintf(folder[k], sizeof folder[k], "%s/%d", place, k);
        run[k] = begin(scene, folder[k], false);
        step(run[k], 40);
    }
    assert_true(amontons_simulation_save(run[0], &early, &err));
    step(run[0], 70);
    assert_true(amontons_simulation_save(run[0], &late, &err));
    expect_refused(run[1], &late, "does not go as far");
    err = (Error){0};
    assert_true(amontons_simulation_restore(run[0], &early, &err));
    assert_true(amontons_simulation_restore(run[1], &early, &err));
    for (int k = 0; k < 2; k++) {
        step(run[k], 20);
        assert_true(amontons_simulation_finish(run[k], &summary, &err));
        amontons_simulation_destroy(run[k]);
    }
    compare_histories(folder[0], folder[1]);
    amontons_state_free(&early);
    amontons_state_free(&late);
    amontons_scene_destroy(scene);
    place_remove(place);
}

// A checkpoint beside the history of another scene's run, which has steps enough.
TEST(test_history_of_another_run)
{
    char place[PLACE_SIZE], folder[2][2 * PLACE_SIZE], command[8 * PLACE_SIZE];
    Error err = {0};
    RunSummary summary;
    place_make(place);
    for (int k = 0; k < 2; k++) {
        Scene *scene = small_scene((const char *const[]){
            "reduction.cache=true", k ? "load.pressure=0.004" : "load.pressure=0.003", NULL});
        snprintf(folder[k], sizeof folder[k], "%s/%d", place, k);
        Simulation *run = begin(scene, folder[k], false);
        step(run, 40 + 10 * k);
        assert_true(amontons_simulation_finish(run, &summary, &err));
        amontons_simulation_destroy(run);
        amontons_scene_destroy(scene);
    }
    snprintf(command, sizeof command, "cp '%s/history.h5' '%s/history.h5'", folder[1], folder[0]);
    assert_int_equal(system(command), 0);
    Scene *scene =
        small_scene((const char *const[]){"reduction.cache=true", "load.pressure=0.003", NULL});
    Simulation *run = NULL;
    RunOptions options = {.folder = folder[0], .resume = true};
    assert_false(amontons_simulation_create(scene, &options, &run, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, "the history is that of another run than the saved state: in row "))
        fail_msg("%s", err.message);
    amontons_simulation_destroy(run);
    snprintf(command, sizeof command,
             "cmp '%s/history.h5' '%s/history.h5' && test -e '%s/run.json'", folder[1], folder[0],
             folder[0]);
    assert_int_equal(system(command), 0);   // untouched
    amontons_scene_destroy(scene);
    place_remove(place);
}

GROUP_BETWEEN(cache_begin, cache_end);
