// SPDX-License-Identifier: GPL-2.0-or-later
// Whole runs on a coarse mesh: the same bits twice, balances, what is written and when, and how a
// run that is stopped or fails leaves things.
#include "run/simulation_state.h"

#include "base/memory.h"
#include "io/hdf5/result_file.h"
#include "result_place.h"
#include "small_scene.h"

enum { VIEWS_MAX = 8000 };

typedef struct Track {
    int32_t count;
    StepView view[VIEWS_MAX];
    int32_t stop_after;   // 0: never
    volatile sig_atomic_t stop;
} Track;

static void keep_view(const StepView *view, void *context)
{
    Track *track = context;
    assert_true(track->count < VIEWS_MAX);
    track->view[track->count++] = *view;
    if (track->count == track->stop_after) track->stop = 1;
}

static Track track, again;

static RunSummary run_small(const char *const *more, const char *folder, Track *kept)
{
    Error err = {0};
    RunSummary summary;
    memset(kept, 0, sizeof *kept);
    RunOptions options = {.folder = folder, .on_step = keep_view, .context = kept};
    Scene *scene = small_scene(more);
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return summary;
}

TEST(test_same_bits_twice)
{
    const char *const settings[][2] = {{"reduction.use=always", NULL},
                                       {"reduction.use=never", NULL}};
    int64_t live = memory_counters().live;
    for (int k = 0; k < 2; k++) {
        RunSummary first = run_small(settings[k], NULL, &track);
        RunSummary second = run_small(settings[k], NULL, &again);
        assert_int_equal(track.count, first.counters.accepted + 1);   // the start too
        assert_int_equal(track.count, again.count);
        for (int32_t s = 0; s < track.count; s++) {
            assert_memory_equal(&track.view[s].mu, &again.view[s].mu, sizeof(double));
            assert_memory_equal(&track.view[s].t, &again.view[s].t, sizeof(double));
            assert_memory_equal(&track.view[s].max_slip_rate, &again.view[s].max_slip_rate,
                                sizeof(double));
        }
        assert_memory_equal(&first.mu_M, &second.mu_M, sizeof(double));
        assert_memory_equal(&first.counters, &second.counters, sizeof first.counters);
    }
    assert_int_equal(memory_counters().live, live);
}

// Moments, contact conditions, energy; the energy the better the smaller the steps, left to
// themselves.
TEST(test_balances)
{
    const char *const tolerances[][3] = {{"time.tolerance=1e-2", "time.energy_tolerance=1", NULL},
                                         {"time.tolerance=1e-3", "time.energy_tolerance=1", NULL},
                                         {"time.tolerance=1e-4", "time.energy_tolerance=1", NULL}};
    double before = INFINITY;
    for (int k = 0; k < 3; k++) {
        RunSummary summary = run_small(tolerances[k], NULL, &track);
        assert_true(summary.moment_error < 1e-10);
        assert_true(summary.complementarity_error < 1e-8);
        assert_true(summary.energy_error < 1e-3 && summary.energy_error < 0.7 * before);
        before = summary.energy_error;
    }
    assert_true(before < 1e-4);
}

// Steps go forward to the end, and the views say so.
TEST(test_views)
{
    RunSummary summary = run_small((const char *const[]){NULL}, NULL, &track);
    const StepView *last = &track.view[track.count - 1];
    assert_near("t", track.view[0].t, 0, 0);
    assert_near("step", track.view[0].step_size, 0, 0);
    assert_near("mu", track.view[0].mu, 0, 0);
    double largest = 0;
    for (int32_t s = 1; s < track.count; s++) {
        const StepView *view = &track.view[s], *old = view - 1;
        assert_near("t", view->t, old->t + view->step_size, 1e-9);
        assert_near("U", view->U, 1e-5 * view->t, 1e-15);
        assert_true(view->fraction >= old->fraction && view->fraction <= 1);
        assert_true(view->events >= old->events && view->slidings >= old->slidings);
        assert_true(view->mu >= 0 && view->front >= 0 && view->front <= 1);
        largest = fmax(largest, view->mu);
    }
    assert_near("end", last->fraction, 1, 1e-3);   // less than the shortest level is missing
    assert_true(last->U <= 0.0055 * (1 + 1e-9));
    assert_int_equal(last->slidings, summary.leading);
    assert_int_equal(last->events, summary.leading + summary.bounded);
    assert_true(summary.leading >= 1 && summary.peaks == summary.leading);
    assert_true(largest > 0.3 && largest < 0.38);   // never beyond mu_S
}

// The reduced bulk and the full one agree where steps are so fine that they leave less than the
// reduction does: errors are measured differently in them, so their steps differ.
TEST(test_reduced_and_full_agree)
{
    RunSummary summary[2];
    for (int full = 0; full < 2; full++)
        summary[full] =
            run_small((const char *const[]){full ? "reduction.use=never" : "reduction.use=always",
                                            "time.tolerance=1e-6", "time.wave_step=0.05", NULL},
                      NULL, full ? &again : &track);
    assert_int_equal(summary[0].peaks, summary[1].peaks);
    assert_int_equal(summary[0].leading, summary[1].leading);
    assert_near("mu_M", summary[0].mu_M, summary[1].mu_M, 1e-4 * summary[1].mu_M);
}

// In the time loop memory is asked for where a level is built, and nowhere else.
TEST(test_allocations)
{
    Error err = {0};
    RunOptions options = {0};
    Simulation *simulation = NULL;
    Scene *scene = small_scene((const char *const[]){"output.history=false", NULL});
    assert_true(amontons_simulation_create(scene, &options, &simulation, &err));
    bool finished = false;
    int32_t growing = 0;
    while (!finished) {
        int64_t before = memory_counters().allocations;
        int64_t built = simulation->model.system.factorisations;
        assert_true(amontons_simulation_step(simulation, NULL, &finished, &err));
        bool asked = memory_counters().allocations != before;
        if (asked) assert_true(simulation->model.system.factorisations > built);
        growing += asked;
    }
    assert_true(growing <= simulation->control.dt_levels.level_count);
    amontons_simulation_destroy(simulation);
    amontons_simulation_destroy(NULL);
    amontons_scene_destroy(scene);
}

static int count_entries(const char *folder)
{
    char command[2 * PLACE_SIZE];
    snprintf(command, sizeof command, "ls -A '%s' | wc -l", folder);
    FILE *pipe = popen(command, "r");
    int count = -1;
    assert_int_equal(fscanf(pipe, "%d", &count), 1);
    pclose(pipe);
    return count;
}

TEST(test_no_folder_writes_nothing)
{
    char place[PLACE_SIZE], home[4096];
    Error err = {0};
    RunSummary summary;
    place_make(place);
    // Whatever a run might write to: here, the home, the caches.
    const char *source = getenv("AMONTONS_SOURCE"), *old_home = getenv("HOME");
    snprintf(home, sizeof home, "%s", old_home ? old_home : "/");
    if (!source || source[0] != '/') fail_msg("AMONTONS_SOURCE is no absolute path");
    Scene *scene = small_scene(
        (const char *const[]){"output.fields={at_events: true}", "output.figures=[force]", NULL});
    assert_int_equal(chdir(place), 0);
    setenv("HOME", place, 1);
    RunOptions options = {0};
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    assert_int_equal(count_entries(place), 0);
    assert_true(summary.field_files == 0 && summary.figures == 0 && summary.folder[0] == 0);
    setenv("HOME", home, 1);
    assert_int_equal(chdir(source), 0);
    amontons_scene_destroy(scene);
    place_remove(place);
}

static void expect_in_report(const char *place, const char *words)
{
    static char text[200000];
    place_read(place, "run.json", text, sizeof text);
    if (!strstr(text, words)) fail_msg("'%s' is not in run.json", words);
}

static double history_rows(const char *place)
{
    Error err = {0};
    ArrayFile *file = result_file_open(place, &err);
    if (!file) fail_msg("%s", err.message);
    double *mu = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    assert_true(result_file_read_series(file, SERIES_MU, &mu, &rows, &width, &err));
    for (int64_t s = 0; s < rows; s++) assert_true(mu[s] == track.view[s].mu);
    memory_free(mu);
    assert_true(array_file_close(file, &err));
    return (double)rows;
}

TEST(test_results)
{
    Error err = {0};
    char place[PLACE_SIZE];
    place_make(place);
    RunSummary summary = run_small((const char *const[]){NULL}, place, &track);
    assert_string_equal(summary.folder, place);
    assert_near("rows", history_rows(place), (double)summary.counters.accepted + 1, 0);
    expect_in_report(place, "\"status\": \"done\"");
    assert_false(place_has(place, "fields.pvd"));
    assert_false(place_has(place, "history.h5.part") || place_has(place, "run.json.part"));
    ArrayFile *file = result_file_open(place, &err);
    assert_near("mu_M", result_file_number(file, NUMBER_MU_M), summary.mu_M, 0);
    assert_near("L", result_file_number(file, NUMBER_LENGTH), 1, 0);
    assert_near("F_N", result_file_number(file, NUMBER_LOAD), 0.003, 1e-15);
    assert_true(array_file_close(file, &err));

    // A second time: refused, and what is there is not touched; unless asked for.
    Scene *scene = small_scene((const char *const[]){"time.until={U: 0.0005}", NULL});
    RunOptions options = {.folder = place, .on_step = keep_view, .context = &again};
    assert_false(amontons_run(scene, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_near("rows", history_rows(place), track.count, 0);
    expect_in_report(place, "\"status\": \"done\"");
    error_clear(&err);
    options.overwrite = true;
    options.context = memset(&track, 0, sizeof track);
    assert_true(amontons_run(scene, &options, &summary, &err));
    assert_near("rows", history_rows(place), track.count, 0);
    assert_near("U", track.view[track.count - 1].U, 0.0005, 1e-6);
    amontons_scene_destroy(scene);
    place_remove(place);
}

TEST(test_interrupted)
{
    Error err = {0};
    RunSummary summary;
    char place[PLACE_SIZE];
    place_make(place);
    memset(&track, 0, sizeof track);
    track.stop_after = 30;
    RunOptions options = {
        .folder = place, .on_step = keep_view, .context = &track, .stop = &track.stop};
    Scene *scene = small_scene((const char *const[]){NULL});
    assert_false(amontons_run(scene, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_INTERRUPT);
    assert_non_null(strstr(err.message, place));
    assert_int_equal(track.count, 30);
    assert_true(place_has(place, "history.h5"));
    assert_near("rows", history_rows(place), 30, 0);
    expect_in_report(place, "\"status\": \"failed\"");
    expect_in_report(place, "\"failure\": \"interrupted\"");
    assert_int_equal(summary.counters.accepted, 29);
    amontons_scene_destroy(scene);
    place_remove(place);
}

// Without checkpoints nothing is said of going on; without a folder there is nothing to go on from.
TEST(test_without_checkpoints)
{
    Error err = {0};
    RunSummary summary;
    char place[PLACE_SIZE];
    place_make(place);
    memset(&track, 0, sizeof track);
    track.stop_after = 5;
    RunOptions options = {.folder = place,
                          .checkpoint_every = -1,
                          .on_step = keep_view,
                          .context = &track,
                          .stop = &track.stop};
    Scene *scene = small_scene((const char *const[]){NULL});
    assert_false(amontons_run(scene, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_INTERRUPT);
    assert_null(strstr(err.message, "--resume"));
    assert_false(place_has(place, "checkpoint.bin"));
    err = (Error){0};
    assert_false(amontons_run(scene, &(RunOptions){.resume = true}, &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "leaves nothing to go on from"));
    amontons_scene_destroy(scene);
    place_remove(place);
}

// A scene that was warned of is told so again when its energy does not close.
TEST(test_failed_as_warned)
{
    Error err = {0};
    RunSummary summary;
    Scene *scene = small_scene((const char *const[]){
        "time.energy_tolerance=1e-14", "material={poisson: 0.34, eta1: 0, eta2: 1}", NULL});
    assert_false(amontons_run(scene, &(RunOptions){0}, &summary, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    if (!strstr(err.message, "ill-posed, or not resolved, as the run was warned"))
        fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
}

// A ledger that cannot close to the digits asked for ends the run with an error, and a report.
TEST(test_failed)
{
    Error err = {0};
    RunSummary summary;
    char place[PLACE_SIZE];
    place_make(place);
    memset(&track, 0, sizeof track);
    RunOptions options = {.folder = place, .on_step = keep_view, .context = &track};
    Scene *scene = small_scene((const char *const[]){"time.energy_tolerance=1e-14", NULL});
    assert_false(amontons_run(scene, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "the energy ledger does not close"));
    expect_in_report(place, "\"status\": \"failed\"");
    expect_in_report(place, "the energy ledger does not close");
    assert_near("rows", history_rows(place), track.count, 0);
    amontons_scene_destroy(scene);
    place_remove(place);
}
