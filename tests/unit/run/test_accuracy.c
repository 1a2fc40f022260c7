// SPDX-License-Identifier: GPL-2.0-or-later
// A search for an error bar that is stopped, and what it says of a bar not met;
// loads and parameters of its runs. How good its bars are is tested by end_to_end.accuracy.
#include "run/accuracy.h"
#include "run/warnings.h"

#include "base/memory.h"
#include "place_fixture.h"
#include "small_scene.h"

#include <signal.h>
#include <time.h>

// Stops in the run of so many, 0: the first of the first mesh; counts the meshes that were done.
typedef struct Watch {
    int32_t runs_left;
    int32_t mesh, run;
    int32_t levels;
    char reached[200];   // what the last mesh that was done gave, as the message says it
    bool in_full;   // stops in the run in full
    volatile sig_atomic_t stop;
} Watch;

static void watch_step(const StepView *view, void *context)
{
    Watch *watch = context;
    if (view->mesh == watch->mesh && view->run == watch->run) return;
    watch->mesh = view->mesh;
    watch->run = view->run;
    watch->stop = view->mesh > 0 ? watch->runs_left-- == 0 : watch->in_full;
}

static void watch_level(const LevelView *view, void *context)
{
    Watch *watch = context;
    size_t used = strlen(watch->reached);
    char value[ESTIMATE_SIZE];
    amontons_estimate(view->value, view->bar, view->known_to, value);
    if (view->level == watch->levels) return;   // more runs on the same mesh
    snprintf(watch->reached + used, sizeof watch->reached - used, "%s%s on %d%s",
             used ? ", " : "so far mu_M = ", value, view->contact_nodes,
             used ? "" : " contact nodes");
    watch->levels = view->level;
}

static Scene *scene_of(const char *one, const char *other)
{
    return small_scene((const char *const[]){"mesh.set.nx=20", "mesh.set.nz=4",
                                             "load.pressure=0.006", "time.until.U=0.008",
                                             "accuracy.mu=0.001", one, other, NULL});
}

// The message of a search that was stopped in its run `runs`, -1: in the run in full after it.
static Watch stop_in(int32_t runs, const char *folder, bool overwrite, Error *err)
{
    bool in_full = runs < 0;
    Scene *scene = scene_of(in_full ? "accuracy.mu=0.3" : NULL, NULL);
    RunSummary summary;
    Watch watch = {.runs_left = runs, .in_full = in_full};
    RunOptions options = {.folder = folder,
                          .overwrite = overwrite,
                          .on_step = watch_step,
                          .on_level = watch_level,
                          .context = &watch,
                          .stop = &watch.stop};
    int64_t live = memory_counters().live;
    assert_false(amontons_run(scene, &options, &summary, err));
    assert_int_equal(err->code, ERROR_INTERRUPT);
    assert_int_equal(memory_counters().live, live);
    if (!in_full) assert_int_equal(watch.levels, runs < 2 ? 0 : runs - 1);   // two on the first
    amontons_scene_destroy(scene);
    return watch;
}

TEST_BETWEEN(test_stopped_in_the_first_run, begin, end)
{
    Error err = {0};
    stop_in(0, place, false, &err);
    if (!strstr(err.message, "no run has ended yet, nothing was written"))
        fail_msg("%s", err.message);
    assert_false(place_has(place, "figures"));
}

// The first run has the search's folder, with its lock, when it reports.
TEST_BETWEEN(test_out_of_time_in_the_first_run, begin, end)
{
    Error err = {0};
    RunSummary summary;
    Scene *scene = scene_of("accuracy.within=0.001", NULL);
    RunOptions options = {.folder = place, .overwrite = true};
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    assert_true(place_has(place, "run.json"));
    assert_false(place_has(place, "amontons.lock"));
    amontons_scene_destroy(scene);
}

// A search whose steps all take the same time, whatever the machine does besides: each waits for
// the moment that is its own, and those that come late catch up.
typedef struct Slow {
    struct timespec next;   // moment of the next step
    int32_t meshes, nodes[2];
    double seconds[2];   // of each mesh
    RunSummary summary;
} Slow;

static void wait_at_step(const StepView *view, void *context)
{
    Slow *slow = context;
    if (view->mesh == 0) return;   // the run in full, behind the search
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &slow->next, NULL);
    slow->next.tv_nsec += 2000000;
    if (slow->next.tv_nsec < 1000000000) return;
    slow->next.tv_nsec -= 1000000000;
    slow->next.tv_sec++;
}

static void note_mesh(const LevelView *view, void *context)
{
    Slow *slow = context;
    if (view->level == slow->meshes || slow->meshes == 2) return;
    slow->seconds[slow->meshes] = view->seconds;
    slow->nodes[slow->meshes++] = view->contact_nodes;
}

static Slow search_slowly(const char *mesh, const char *asked, double within)
{
    char limit[60];
    Slow slow = {0};
    Error err = {0};
    snprintf(limit, sizeof limit, "accuracy.within=%.3f", within);
    Scene *scene = small_scene((const char *const[]){
        mesh, "load.pressure=0.006", "time.until.U=0.003", asked, within > 0 ? limit : NULL, NULL});
    clock_gettime(CLOCK_MONOTONIC, &slow.next);
    RunOptions options = {.on_step = wait_at_step, .on_level = note_mesh, .context = &slow};
    if (!amontons_run(scene, &options, &slow.summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return slow;
}

// Two runs on the first mesh take two of 3.3 parts of the time, the run in full a quarter. One on a
// finer mesh is expected to take 1.4 of the part that is left, one on a coarser mesh 0.7: so it is
// the coarser one that says how far meshes differ.
TEST(test_a_coarser_mesh_where_time_is_short)
{
    static const char mesh[] = "mesh.set={length: 1, height: 0.5, nx: 26, nz: 5}";
    Slow free = search_slowly(mesh, "accuracy.mu=0.5", 0);
    assert_int_equal(free.meshes, 2);
    assert_true(free.nodes[1] > free.nodes[0]);
    Slow hurried = search_slowly(mesh, "accuracy.mu=0.001", 3.3 * free.seconds[0] / 2);
    assert_int_equal(hurried.meshes, 2);
    assert_int_equal(hurried.nodes[0], free.nodes[0]);
    assert_true(hurried.nodes[1] < free.nodes[0]);
}

// A mesh that can only be split wants two runs. Where time ends after the first of them, this one
// has its part in the bar. An eighth of the time of both is kept for the run in full, and a quarter
// is less than another run takes.
TEST_BETWEEN(test_one_run_on_a_split_mesh, begin, end)
{
    static const char script[] =
        "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 0.5, 0};\n"
        "Point(4) = {0, 0.5, 0}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};\n"
        "Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
        "Transfinite Curve{1, 3} = 14; Transfinite Curve{2, 4} = 4;\n"
        "Transfinite Surface{1}; Recombine Surface{1};\n"
        "Physical Curve(\"contact\") = {1}; Physical Curve(\"top\") = {3};\n"
        "Physical Curve(\"rod\") = {4}; Physical Surface(\"body\") = {1};\n";
    char mesh[PLACE_SIZE + 100];
    place_write(place, "block.geo", script);
    snprintf(mesh, sizeof mesh, "mesh={file: %s}", place_path(place, "block.geo"));
    Slow free = search_slowly(mesh, "accuracy.mu=0.9", 0);
    assert_int_equal(free.summary.bar_runs, 4);
    Slow hurried =
        search_slowly(mesh, "accuracy.mu=0.001", free.seconds[0] + 0.875 * free.seconds[1]);
    assert_int_equal(hurried.summary.bar_meshes, 2);
    assert_int_equal(hurried.summary.bar_nodes, free.summary.bar_nodes);
    assert_int_equal(hurried.summary.bar_runs, 3);
    assert_true(hurried.summary.mu_M_error > 0);
}

// mu_M of the first mesh's two runs is kept, but not beside an earlier result.
TEST_BETWEEN(test_stopped_on_the_second_mesh, begin, end)
{
    static char text[8000];
    char said[PLACE_SIZE + 300];
    Error err = {0};
    Watch watch = stop_in(2, place, false, &err);
    snprintf(said, sizeof said, "%s (%s/figures/accuracy.json); it does not go on from here",
             watch.reached, place);
    if (!strstr(err.message, said)) fail_msg("%s", err.message);
    place_read(place, "figures/accuracy.json", text, sizeof text);
    assert_non_null(strstr(text, "contact nodes"));
    assert_true(place_has(place, "figures/accuracy.png"));
}

// Without a folder the message is all that is left.
TEST(test_stopped_without_a_folder)
{
    char said[400];
    Error err = {0};
    Watch watch = stop_in(3, NULL, false, &err);
    snprintf(said, sizeof said,
             "stopped on mesh 3 of an error bar; %s; it does not go on from here: the same command "
             "begins anew; with --within TIME it keeps what it has when time is up",
             watch.reached);
    assert_string_equal(err.message, said);
    assert_non_null(strstr(watch.reached, " +- "));
    err = (Error){0};
    watch = stop_in(-1, NULL, false, &err);
    assert_true(watch.levels > 1);
    if (!strstr(err.message, watch.reached) || strncmp(err.message, "stopped at U = ", 15) != 0 ||
        strstr(err.message, "kept in"))
        fail_msg("%s", err.message);
}

TEST_BETWEEN(test_stopped_over_an_earlier_result, begin, end)
{
    Error err = {0};
    RunSummary summary;
    Scene *scene = small_scene((const char *const[]){"time.until={t: 1}", NULL});
    RunOptions options = {.folder = place, .overwrite = true};
    place_remove(place);
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    stop_in(2, place, true, &err);
    assert_null(strstr(err.message, place));
    assert_true(place_has(place, "run.json") && place_has(place, "history.h5"));
    assert_false(place_has(place, "figures/accuracy.json"));
}

static RunSummary searched(const char *one, const char *other)
{
    Error err = {0};
    RunSummary summary;
    Scene *scene = scene_of(one, other);
    if (!amontons_run(scene, &(RunOptions){0}, &summary, &err)) fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
    return summary;
}

TEST(test_loads_are_scaled_along_every_axis)
{
    static Scene scene;
    scene.load.pressure = 2;
    scene.load.traction_count = 1;
    scene.load.tractions[0] = (SceneTraction){.x = 4, .y = 8, .z = -16};
    scene_scale_loads(&scene, 1.5);
    assert_true(scene.load.pressure == 3 && scene.load.tractions[0].x == 6);
    assert_true(scene.load.tractions[0].y == 12 && scene.load.tractions[0].z == -24);
}

// A traction of the same size on the top instead of pressure gives the same block, and runs whose
// loads are scaled alike.
TEST(test_loads_of_the_runs)
{
    const char wide[] = "accuracy={mu: 0.3, window: 0.1}";
    RunSummary pressed = searched(wide, NULL);
    RunSummary pulled = searched(wide, "load={pressure: 0, tractions: [{group: top, z: -0.006}]}");
    assert_true(pressed.mu_M > 0.2 && pressed.mu_M < 0.4);
    assert_near("mu_M", pulled.mu_M, pressed.mu_M, 1e-6);
}

// `refine` of each mesh needs a place among the parameters.
TEST_BETWEEN(test_no_room_for_refine, NULL, end)
{
    char geo[8000] = "", text[4000] = "mesh={file: ", source[600];
    size_t used = 0, named = strlen(text);
    for (int32_t k = 0; k < SCENE_LIST_MAX - 4; k++)
        used += (size_t)snprintf(geo + used, sizeof geo - used, "DefineConstant[a%d = 1];\n", k);
    snprintf(source, sizeof source, "%s/meshes/block.geo", getenv("AMONTONS_SOURCE"));
    snprintf(geo + used, sizeof geo - used, "Include \"%s\";\n", source);
    place_make(place);
    place_write(place, "many.geo", geo);
    named += (size_t)snprintf(text + named, sizeof text - named,
                              "%s/many.geo, set: {nx: 6, nz: 3, length: 1, height: 0.5", place);
    for (int32_t k = 0; k < SCENE_LIST_MAX - 4; k++)
        named += (size_t)snprintf(text + named, sizeof text - named, ", a%d: 2", k);
    snprintf(text + named, sizeof text - named, "}}");
    Error err = {0};
    RunSummary summary;
    Scene *scene = small_scene((const char *const[]){text, "accuracy.mu=0.001", NULL});
    assert_false(amontons_run(scene, &(RunOptions){0}, &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, "mesh.set: no room for `refine` beside 32 parameters"))
        fail_msg("%s", err.message);
    amontons_scene_destroy(scene);
}

// --- what is said of a bar by hand --------------------------------------------------------------

// The newest warning about levels of 21, 41, 81 nodes with a bar of 0.03 about 0.3.
static RunWarnings said_of(Levels *levels)
{
    RunWarnings warnings = {0};
    levels->ended = "no time for more";
    levels->wanted = 0.01;
    for (int32_t k = 0; k < levels->count; k++) {
        Level *level = &levels->list[k];
        level->contact_nodes = 1 + (20 << k);
        level->nodes_along = level->contact_nodes;
        level->run_count = 2;
        for (int32_t kind = 0; kind < ANSWER_KINDS; kind++) {
            level->answer[kind].value = 0.3;
            level->answer[kind].bar = 0.03;
            level->runs[0].answer[kind].value = level->runs[1].answer[kind].value = 0.3;
        }
    }
    warnings_of_bar(levels, &warnings);
    assert_int_equal(warnings.count, 1);
    return warnings;
}

static void expect(Levels levels, const char *wanted)
{
    RunWarnings found = said_of(&levels);
    if (!strstr(found.text[0], wanted)) fail_msg("%s, not\n%s", found.text[0], wanted);
}

TEST(test_what_is_said_of_a_bar)
{
    Levels levels = {.count = 3};
    for (int32_t k = 0; k < 3; k++) levels.list[k].slip_cells = 100, levels.list[k].refine = 1 + k;
    expect(levels, "mu_M is known to 10.0 %, asked for 1.0 % (no time for more)");
    levels.list[0].undamped = true;   // 2 and 3 times as fine are left
    expect(levels,
           "known to 10.0 % by meshes less than twice as fine as one another, asked for 1.0 %");
    levels.list[2].answer[0].parts.mesh = NAN;
    expect(levels, "the mesh's part of it is not known (only the last mesh has an answer: no time "
                   "for more)");
    levels.list[2].undamped = true;
    expect(levels, "not known (cells are too long for slip: no time for more)");
}
