// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep in this process: what the caller is told, memory running out while planning and writing
// the table, and a stop. What its users see is in end_to_end/test_sweep.py.
#include "amontons.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 200, FAULTS_MAX = 4000 };

static char place[] = "/tmp/amontons_sweep_XXXXXX", study[PATH_SIZE], folder[PATH_SIZE];

typedef struct Told {
    int32_t calls, failed, reused;
    double mu, left;
    char words[300];
} Told;

static void note(const SweepView *view, void *context)
{
    Told *told = context;
    told->calls++;
    told->failed = view->failed;
    told->reused += view->reused;
    told->mu = view->mu_M;
    told->left = view->seconds_left;
    snprintf(told->words, sizeof told->words, "%s", view->words);
    assert_int_equal(view->finished, told->calls);
    assert_int_equal(view->points, 2);
}

static SweepOptions options_with(Told *told)
{
    return (SweepOptions){.folder = folder, .jobs = 1, .on_point = note, .context = told};
}

TEST(tells_of_each_point)
{
    Error err = {0};
    Told told = {0};
    SweepSummary summary;
    SweepOptions options = options_with(&told);
    int64_t live = memory_counters().live;
    FILE *said = tmpfile();
    fflush(stdout);
    int shown = dup(STDOUT_FILENO);
    dup2(fileno(said), STDOUT_FILENO);
    printf("once");   // by the caller: not again by gmsh in a process that has a copy of it
    bool done = amontons_sweep(study, &options, &summary, &err);
    fflush(stdout);
    dup2(shown, STDOUT_FILENO);
    close(shown);
    if (!done) fail_msg("%s", err.message);
    assert_int_equal(lseek(fileno(said), 0, SEEK_END), 4);
    fclose(said);
    assert_int_equal(told.calls, 2);
    assert_int_equal(told.reused, 0);
    assert_string_equal(told.words, "load.pressure=0.006");
    assert_true(told.mu > 0.1 && told.mu < 0.38 && told.left == 0);
    assert_int_equal(summary.computed, 2);
    assert_int_equal(summary.failed + summary.pending + summary.reused, 0);
    assert_int_equal(memory_counters().live, live);
}

// All points finished: nothing is forked, so the fault is met here and nowhere else.
TEST(frees_all_when_memory_fails)
{
    Told told = {0};
    SweepSummary summary;
    SweepOptions options = options_with(&told);
    int64_t live = memory_counters().live, k = 0;
    for (bool done = false; !done; k += k < 300 ? 1 : 11) {   // pictures take long
        Error err = {0};
        told = (Told){0};
        memory_fail_after(k);
        done = amontons_sweep(study, &options, &summary, &err);
        memory_fail_after(-1);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < FAULTS_MAX);
    }
    assert_true(k > 50);
    assert_int_equal(summary.reused, 2);
    assert_int_equal(told.reused, 2);
}

TEST(stops_when_told)
{
    Error err = {0};
    Told told = {0};
    SweepSummary summary;
    SweepOptions options = options_with(&told);
    volatile sig_atomic_t stop = 1;
    options.stop = &stop;
    options.fresh = true;
    assert_false(amontons_sweep(study, &options, &summary, &err));
    assert_int_equal(err.code, ERROR_INTERRUPT);
    assert_int_equal(summary.pending, 2);
}

FIXTURE(place_make)
{
    const char *source = getenv("AMONTONS_SOURCE") ? getenv("AMONTONS_SOURCE") : "../..";
    if (!mkdtemp(place) || setenv("AMONTONS_CACHE", place, 1) != 0) return -1;
    snprintf(study, sizeof study, "%s/study.yaml", place);
    snprintf(folder, sizeof folder, "%s/a/b", place);
    FILE *file = fopen(study, "w");
    if (!file) return -1;
    fprintf(file,
            "scene: %s/validation/paper/fig1.yaml\nset: {mesh.set.nx: 8, mesh.set.nz: 8, "
            "rod.height: 0, rod.width: 0, reduction.cache: false}\n"
            "vary: {load.pressure: [0.003, 0.006]}\n"
            "rank: {by: mu_M}\nplot: {x: load.pressure, y: mu_M}\n",
            source);
    return fclose(file);
}

FIXTURE(place_remove)
{
    char command[PATH_SIZE + 20];
    snprintf(command, sizeof command, "rm -rf '%s'", place);
    return system(command);
}

GROUP_BETWEEN(place_make, place_remove);
