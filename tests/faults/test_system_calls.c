// SPDX-License-Identifier: GPL-2.0-or-later
// Calls to the system, and allocations, that fail once, one for each chain of callers, in what the
// library does besides a run in memory: a run with results, one that is gone on with, statics,
// stability, the 1D model, a sweep, pictures, looking at results. Each ends with a sentence or is
// done, gives all its memory back, and leaves no half of a text file under its final name.
//
// AMONTONS_FAULTS_EVERY: one fault of so many is tried (standard: some of each work).
#include "amontons_cache.h"
#include "amontons_model1d.h"
#include "amontons_pictures.h"
#include "amontons_stability.h"

#include "base/memory.h"
#include "fake_slurm.h"
#include "faults/file_faults.h"
#include "result_place.h"
#include "small_scene.h"

#include <dirent.h>

enum { FAULTS_MAX = 6000 };

static char place[PLACE_SIZE], result[PLACE_SIZE + 20];
static Scene *scene;
static FILE *nowhere;

// --- what is done -------------------------------------------------------------------------------

static bool run(Error *err)
{
    RunSummary summary;
    RunOptions options = {.folder = result, .overwrite = true, .checkpoint_every = 1e-9};
    return amontons_run(scene, &options, &summary, err);
}

// Stops after some steps, as Ctrl-C does, and goes on.
static volatile sig_atomic_t stop;

static void stop_later(const StepView *view, void *context)
{
    (void)context;
    stop = view->t > 0.5;
}

static bool resume(Error *err)
{
    RunSummary summary;
    RunOptions options = {
        .folder = result, .overwrite = true, .on_step = stop_later, .stop = &stop};
    stop = 0;
    if (amontons_run(scene, &options, &summary, err) || err->code != ERROR_INTERRUPT) return false;
    *err = (Error){0};
    return amontons_run(scene, &(RunOptions){.folder = result, .resume = true}, &summary, err);
}

static bool equilibrium(Error *err)
{
    StaticSummary summary;
    return amontons_static(scene, result, true, &summary, err);
}

static bool stability(Error *err)
{
    StabilitySummary summary;
    StabilityOptions options = {.folder = result, .overwrite = true};
    return amontons_stability(scene, &options, &summary, err);
}

static bool line(Error *err)
{
    Model1dSummary summary;
    Model1dOptions options = amontons_model1d_options();
    options.nodes = 5;
    options.folder = result;
    options.overwrite = true;
    return amontons_model1d(scene, &options, &summary, err);
}

static bool sweep(Error *err)
{
    char study[PLACE_SIZE + 20];
    SweepSummary summary;
    SweepOptions options = {.folder = result, .jobs = 1, .fresh = true, .out = nowhere};
    snprintf(study, sizeof study, "%s/study.yaml", place);
    return amontons_sweep(study, &options, &summary, err) && summary.failed + summary.pending == 0;
}

// Its jobs are said to have failed, so that the lists of their elements stay for `element`.
static bool sweep_by_slurm(Error *err)
{
    char study[PLACE_SIZE + 20];
    SweepSummary summary;
    SweepOptions options = {.folder = result, .slurm = "", .fresh = true};
    snprintf(study, sizeof study, "%s/study.yaml", place);
    unlink(place_path(place, "arrays"));
    return amontons_sweep(study, &options, &summary, err);
}

static bool element(Error *err)
{
    char study[PLACE_SIZE + 20];
    SweepOptions options = {.folder = result};
    snprintf(study, sizeof study, "%s/study.yaml", place);
    return amontons_sweep_element(study, &options, 0, err);
}

static bool look(Error *err)
{
    CacheSummary summary;
    return amontons_info(result, NULL, nowhere, err) &&
           amontons_cache_list(NULL, NULL, &summary, err);
}

static bool draw(Error *err)
{
    const char *figures[] = {"force"};
    PictureRequest request = {.figures = figures, .figure_count = 1};
    return amontons_render_result(result, &request, err);
}

static bool report(Error *err)
{
    char page[PLACE_SIZE + 20];
    snprintf(page, sizeof page, "%s/page.html", place);
    return amontons_report((const char *const[]){result}, 1, page,
                           &(PictureStyle){.overwrite = true}, err);
}

static bool draw_sweep(Error *err)
{
    return amontons_render_sweep(result, NULL, NULL, err);
}

// A mesh that no cache holds.
static bool look_at_mesh(Error *err)
{
    static const char *const settings[] = {"nx=4", "nz=2", "grade_z=2"};
    char path[4 * PLACE_SIZE], picture[PLACE_SIZE + 20];
    snprintf(path, sizeof path, "%s/meshes/block.geo", getenv("AMONTONS_SOURCE"));
    snprintf(picture, sizeof picture, "%s/mesh.svg", place);
    InfoOptions options = {
        .overrides = settings, .override_count = 3, .picture = picture, .overwrite = true};
    return amontons_info(path, &options, nowhere, err);
}

static bool plot(Error *err)
{
    static const char *const plots[] = {
        "{x: load.pressure, y: mu_max, series: load.pressure, log: both}",
        "{x: load.pressure, y: = 2 * mu_max, color: mu_max, contours: mu_max}"};
    return amontons_render_sweep(result, plots[0], NULL, err) &&
           amontons_render_sweep(result, plots[1], NULL, err);
}

// A scene with what other files and formulas it may name.
static bool read_scene(Error *err)
{
    static const char *const settings[] = {"mesh.set.nx== 2 * mesh.set.nz",
                                           "rod.width== load.pressure * 10",
                                           "materials.pads={young: 2, eta1: 3}",
                                           "friction.contacts=[{group: a, mu_kinetic: 0.05}]",
                                           "contact.profile=profile.csv",
                                           "output.fields={every_t: 1}",
                                           "output.figures=[force]"};
    char path[PLACE_SIZE + 20];
    Scene *read = NULL;
    snprintf(path, sizeof path, "%s/again.yaml", place);
    bool done = amontons_scene_read(path, settings, 7, &read, err);
    amontons_scene_destroy(read);
    return done;
}

static bool film(Error *err)
{
    char path[PLACE_SIZE + 20];
    snprintf(path, sizeof path, "%s/film.mp4", place);
    FilmRequest request = {
        .path = path, .seconds = 0.1, .width = 640, .height = 360, .style.overwrite = true};
    return amontons_film(result, &request, err);
}

static bool compare(Error *err)
{
    char page[PLACE_SIZE + 20];
    snprintf(page, sizeof page, "%s/page.html", place);
    return amontons_report((const char *const[]){result, result}, 2, page,
                           &(PictureStyle){.overwrite = true}, err);
}

// --- and how it may end -------------------------------------------------------------------------

static bool is_whole(const char *name)
{
    static char text[1 << 18];
    size_t length = strlen(name);
    if (length < 6 || strcmp(name + length - 5, ".json") != 0) return true;
    place_read(result, name, text, sizeof text);
    for (length = strlen(text); length > 0 && text[length - 1] == '\n';) length--;
    return length > 0 && text[length - 1] == '}';
}

static void check_files(const char *fault)
{
    DIR *listing = opendir(result);
    for (struct dirent *entry; listing && (entry = readdir(listing));)
        if (!is_whole(entry->d_name)) fail_msg("%s: half of %s is left", fault, entry->d_name);
    if (listing) closedir(listing);
}

static void try_one(bool (*work)(Error *), const char *fault)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    file_faults_start(fault);
    bool done = work(&err);
    clearerr(nowhere);
    file_faults_start(NULL);
    if (!done && work != sweep && (err.code == ERROR_NONE || !*err.message))
        fail_msg("%s: failed without a word", fault);
    if (!done && strncmp(fault, "interrupt", 9) == 0) fail_msg("%s: %s", fault, err.message);
    if (done && err.code != ERROR_NONE) fail_msg("%s: done, but: %s", fault, err.message);
    if (memory_counters().live != live)
        fail_msg("%s: %d arrays are not freed", fault, (int)(memory_counters().live - live));
    check_files(fault);
}

// standard: one of so many, where nobody says otherwise.
static void try_all(bool (*work)(Error *), int32_t standard)
{
    static char faults[FAULTS_MAX][FILE_FAULT_SIZE];
    const char *given = getenv("AMONTONS_FAULTS_EVERY");
    int32_t every = given && *given ? atoi(given) : standard, tried = 0;
    Error err = {0};
    file_faults_start(NULL);
    if (!work(&err)) fail_msg("%s", err.message);   // modules opened
    file_faults_start("count:/dev/null");
    if (!work(&err)) fail_msg("%s", err.message);
    int32_t count = file_faults_list(faults, FAULTS_MAX);
    file_faults_start(NULL);
    assert_in_range(count, 5, FAULTS_MAX - 1);   // the least is that of `info`: 8
    for (int32_t k = 0; k < count; k += every, tried++) try_one(work, faults[k]);
    print_message("%d of %d faults\n", tried, count);
    if (!work(&err)) fail_msg("and then: %s", err.message);
}

static void open_scene(const char *const *more)
{
    const char *settings[16] = {"mesh.set.nx=4", "mesh.set.nz=2", "rod.width=0.3"};
    int32_t count = 3;
    while (*more) settings[count++] = *more++;
    scene = small_scene(settings);
}

static void close_scene(void)
{
    amontons_scene_destroy(scene);
    scene = NULL;
}

static void test_run(void **state)
{
    (void)state;
    open_scene((const char *const[]){"time.until={t: 1}", "time.step_max=0.5",
                                     "output.fields={every_t: 0.5}", "output.figures=[force]",
                                     "reduction.use=always", "reduction.cache=true", NULL});
    try_all(run, 97);
    try_all(look, 1);
    try_all(draw, 41);
    try_all(report, 101);
    close_scene();
}

// Only where all faults are tried: a film and a comparison take long.
static void test_films(void **state)
{
    (void)state;
    if (!getenv("AMONTONS_FAULTS_EVERY")) skip();
    open_scene((const char *const[]){"time.until={t: 1}", "time.step_max=0.5",
                                     "reduction.use=never", NULL});
    Error err = {0};
    if (!run(&err)) fail_msg("%s", err.message);
    try_all(film, 1);
    try_all(compare, 1);
    close_scene();
}

static void test_scene(void **state)
{
    (void)state;
    char text[4000], path[PLACE_SIZE];
    snprintf(path, sizeof path, "%s/validation/paper", getenv("AMONTONS_SOURCE"));
    place_read(path, "fig1.yaml", text, sizeof text);
    place_write(place, "again.yaml", text);
    place_write(place, "profile.csv", "x,gap\n0,0\n0.5,1e-6\n1,0\n");
    try_all(read_scene, 19);
}

static void test_resume(void **state)
{
    (void)state;
    open_scene((const char *const[]){"time.until={t: 1}", "time.step_max=0.25",
                                     "output.fields={every_t: 0.5}", "reduction.use=never", NULL});
    try_all(resume, 101);
    close_scene();
    open_scene((const char *const[]){"time.until={t: 1}", "accuracy.mu=0.1", "reduction.use=never",
                                     "output.figures=[force]", NULL});
    try_all(run, 101);
    close_scene();
}

static void test_studies(void **state)
{
    (void)state;
    open_scene((const char *const[]){"time.until={t: 1}", "reduction.use=never", NULL});
    try_all(equilibrium, 31);
    try_all(stability, 73);
    close_scene();
    open_scene((const char *const[]){"load.pressure=0.03", "time.until={U: 1e-4}", "mesh.set.nx=10",
                                     "mesh.set.nz=10", "rod.width=0.05", NULL});
    try_all(line, 53);
    close_scene();
}

static void write_study(void)
{
    char text[2000];
    snprintf(text, sizeof text,
             "scene: %s/validation/paper/fig1.yaml\n"
             "set: {mesh.set.nx: 4, mesh.set.nz: 2, rod.height: 0, rod.width: 0, "
             "time.until.t: 1, reduction.use: never}\n"
             "vary: {load.pressure: [0.003, 0.006]}\n"
             "rank: {by: mu_max}\nplot: {x: load.pressure, y: mu_max}\n",
             getenv("AMONTONS_SOURCE"));
    place_write(place, "study.yaml", text);
}

static void test_sweep(void **state)
{
    (void)state;
    write_study();
    try_all(sweep, 199);
    try_all(draw_sweep, 29);
    try_all(report, 101);
}

// Where the cache cannot help.
static void test_meshes(void **state)
{
    (void)state;
    setenv("AMONTONS_CACHE", "", 1);
    try_all(look_at_mesh, 41);
    setenv("AMONTONS_CACHE", place_path(place, "cache"), 1);
}

// Only where all faults are tried.
static void test_plots(void **state)
{
    (void)state;
    if (!getenv("AMONTONS_FAULTS_EVERY")) skip();
    Error err = {0};
    write_study();
    if (!sweep(&err)) fail_msg("%s", err.message);
    try_all(plot, 1);
}

static void test_slurm(void **state)
{
    (void)state;
    fake_slurm_make(place);
    place_write(place, "queue", "1 0 TIMEOUT None\n1 1 FAILED None\n");
    write_study();
    try_all(sweep_by_slurm, 101);
    try_all(element, 101);
}

FIXTURE(begin)
{
    amontons_use_child_processes(true);   // as the program does
    place_make(place);
    snprintf(result, sizeof result, "%s/result", place);
    setenv("AMONTONS_CACHE", place_path(place, "cache"), 1);
    nowhere = fopen("/dev/null", "w");
    return nowhere ? 0 : -1;
}

FIXTURE(anew)
{
    place_remove(result);
    return 0;
}

FIXTURE(end)
{
    fclose(nowhere);
    place_remove(place);
    return 0;
}

// An argument: only the tests that it fits.
int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_run, anew),     cmocka_unit_test_teardown(test_films, anew),
        cmocka_unit_test_teardown(test_scene, anew),   cmocka_unit_test_teardown(test_resume, anew),
        cmocka_unit_test_teardown(test_studies, anew), cmocka_unit_test_teardown(test_sweep, anew),
        cmocka_unit_test_teardown(test_meshes, anew),  cmocka_unit_test_teardown(test_plots, anew),
        cmocka_unit_test_teardown(test_slurm, anew),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, begin, end);
}
