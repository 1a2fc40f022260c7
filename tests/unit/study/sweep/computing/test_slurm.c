// SPDX-License-Identifier: GPL-2.0-or-later
// The end of a sweep whose jobs end, vanish, or cannot be submitted: Slurm's commands are
// scripts. And an element, which is one point of the sweep.
#include "study/sweep/computing/slurm_jobs.h"

#include "fake_slurm.h"

static char place[PLACE_SIZE], study[PLACE_SIZE + 20], folder[PLACE_SIZE + 20], old_path[4000];

static const char *const settings[] = {"rod.velocity=9e-6"};

static bool sweep(const char *words, SweepSummary *summary, Error *err)
{
    SweepOptions options = {.folder = folder,
                            .slurm = words,
                            .fresh = true,
                            .overrides = settings,
                            .override_count = 1};
    *err = (Error){0};
    unlink(place_path(place, "arrays"));
    return amontons_sweep(study, &options, summary, err);
}

static void assert_says(const char *text, const char *part)
{
    if (!strstr(text, part)) fail_msg("'%s' does not say '%s'", text, part);
}

// The table tells why each point failed.
static void assert_failures(const char *first, const char *second)
{
    char text[8000];
    place_read(place, "out/sweep.csv", text, sizeof text);
    const char *line = strchr(text, '\n') + 1, *next = strchr(line, '\n') + 1;
    assert_says(line, first);
    assert_says(next, second);
    assert_true(strstr(line, first) < next);
}

TEST(test_ends)
{
    Error err;
    SweepSummary summary;
    fake_slurm_says(place, "scontrol", "MaxArraySize = 2\nExitCode=0:11 \n", "0");   // one element
    place_write(place, "queue",
                "a site's own line\n1 0 OUT_OF_MEMORY None\n9 0 FAILED None\n1 7 FAILED None\n");
    assert_false(sweep("--time=1 --comment='two words'", &summary, &err));
    assert_int_equal(err.code, ERROR_INTERRUPT);
    assert_says(err.message, "1 points are not computed, the same command goes on: the Slurm job "
                             "ended as OUT_OF_MEMORY by signal 11");
    assert_int_equal(summary.failed, 1);
    assert_int_equal(summary.pending, 1);
    assert_failures("ended as OUT_OF_MEMORY by signal 11 (Segmentation fault)", "pending");
    char asked[4000];
    place_read(place, "sbatch.asked", asked, sizeof asked);
    assert_says(asked, "--comment=two words --array=0-0 --job-name=amontons-");

    fake_slurm_says(place, "scontrol", "", "0");   // one array, no signal
    place_write(place, "queue", "1 0 CANCELLED None\n1 1 TIMEOUT TimeLimit\n");
    place_write(place, "out/slurm/1_1.out", "first\nslurmstepd: too late\n");
    assert_true(sweep("", &summary, &err));
    assert_failures("the Slurm job ended as CANCELLED,",
                    "the Slurm job ended as TIMEOUT (TimeLimit): slurmstepd: too late");
    assert_false(place_has(place, "out/slurm/running"));

    fake_slurm_says(place, "scontrol", "MaxArraySize = few\nExitCode=none\n", "0");   // no numbers
    place_write(place, "queue", "1 0 FAILED None\n1 1 NODE_FAIL None\n");
    place_write(place, "out/slurm/1_0.out", "\n\n");
    place_write(place, "out/slurm/1_1.out", "no end of line");
    assert_true(sweep("", &summary, &err));
    assert_failures("the Slurm job ended as FAILED,",
                    "the Slurm job ended as NODE_FAIL: no end of line");
}

TEST(test_refused)
{
    Error err;
    SweepSummary summary;
    assert_false(sweep("--comment='open", &summary, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_says(err.message, "expected options of sbatch");
    fake_slurm_says(place, "sbatch", "sbatch: error: invalid partition\n", "1");
    assert_false(sweep("", &summary, &err));
    assert_says(err.message, "sbatch refuses the array: sbatch: error: invalid partition");
    assert_false(place_has(place, "out/slurm/running"));   // scancel has answered
    fake_slurm_says(place, "scancel", "scancel: error: no controller\n", "1");
    assert_false(sweep("", &summary, &err));
    assert_true(place_has(place, "out/slurm/running"));   // jobs may be out
    assert_false(sweep("", &summary, &err));
    assert_says(err.message, "scancel fails: scancel: error: no controller");
    fake_slurm_says(place, "scancel", "", "0");
    fake_slurm_says(place, "sbatch", "", "0");
    setenv("PATH", "/proc/none", 1);
    unlink(place_path(place, "out/slurm/running"));
    assert_false(sweep("", &summary, &err));
    assert_says(err.message,
                "--slurm needs Slurm's commands (sbatch, squeue, scancel, scontrol) in PATH");
    snprintf(old_path, sizeof old_path, "%s:/bin:/usr/bin", place);
    setenv("PATH", old_path, 1);
}

TEST(test_silence)
{
    Error err = {0};
    SlurmJobs jobs;
    bool answered = true;
    assert_true(slurm_jobs_open(place, 2, &jobs, &err));
    fake_slurm_says(place, "squeue", "no controller\n", "1");
    int times = 0;
    for (; slurm_list(&jobs, &answered, &err); times++) assert_false(answered);
    assert_int_equal(times, 60);
    assert_says(err.message, "squeue does not answer: no controller");
    fake_slurm_says(place, "squeue", "", "0");
    slurm_jobs_close(&jobs);
    assert_false(slurm_jobs_open("/proc/none/at/all", 2, &jobs, &err));
}

// A squeue that fails says nothing of the jobs: they are asked for again.
TEST(test_cancel)
{
    Error err = {0};
    SlurmJobs jobs;
    char script[4 * PLACE_SIZE], usual[4000], asked[400];
    place_read(place, "squeue", usual, sizeof usual);
    snprintf(
        script, sizeof script,
        "#!/bin/sh\ncd %s\necho . >>cancel.asked\ncase $(wc -l <cancel.asked) in 1 | 2) echo no "
        "controller; exit 1;; 3) echo 1;; esac\n",
        place);
    place_write(place, "squeue", script);
    fake_slurm_says(place, "scancel", "", "0");
    assert_true(slurm_jobs_open(place, 2, &jobs, &err));
    if (!slurm_cancel(&jobs, &err)) fail_msg("%s", err.message);
    place_read(place, "cancel.asked", asked, sizeof asked);
    assert_string_equal(asked, ".\n.\n.\n.\n");
    slurm_jobs_close(&jobs);
    place_write(place, "squeue", usual);
}

// In what the last sweep left.
static bool element(int32_t number, Error *err)
{
    SweepOptions options = {.folder = folder, .overrides = settings, .override_count = 1};
    *err = (Error){0};
    return amontons_sweep_element(study, &options, number, err);
}

TEST(test_element)
{
    Error err;
    SweepSummary summary;
    char script[4000];
    fake_slurm_says(place, "squeue", "", "0");   // it answers again
    if (!sweep("", &summary, &err)) fail_msg("%s", err.message);
    assert_int_equal(summary.failed, 2);   // the element comes later
    place_read(place, "out/slurm/array.sh", script, sizeof script);
    assert_says(script, " sweep --element -o '");
    assert_says(script, "/out' --set 'rod.velocity=9e-6' -- '");
    if (!element(1, &err)) fail_msg("%s", err.message);
    assert_false(element(2, &err));
    assert_says(err.message, "out/slurm/share-2.points");
}

// A share as the sweep wrote it, and changed since.
TEST(test_share)
{
    Error err;
    static const struct {
        const char *share, *says;
    } wrong[] = {
        {"99 97e1\n", "fewer points than when the sweep began"},
        {"-1 97e1\n", "fewer points than when the sweep began"},
        {"0\n", "fewer points than when the sweep began"},
        {"1 97e10000000000000000000000000000", "was changed after the sweep began"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        place_write(place, "out/slurm/share-0.points", wrong[k].share);
        assert_false(element(0, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_says(err.message, wrong[k].says);
    }
    place_write(place, "out/slurm/share-0.points", "");
    if (!element(0, &err)) fail_msg("%s", err.message);   // nothing to do
}

FIXTURE(begin)
{
    char text[2000];
    place_make(place);
    fake_slurm_make(place);
    snprintf(study, sizeof study, "%s/study.yaml", place);
    snprintf(folder, sizeof folder, "%s/out", place);
    snprintf(text, sizeof text,
             "scene: %s/validation/paper/fig1.yaml\nset: {mesh.set.nx: 4, mesh.set.nz: 2, "
             "rod.height: 0, rod.width: 0, reduction.cache: false, time.until.t: 1, "
             "output.figures: []}\n"
             "vary: {load.pressure: [0.003, 0.006]}\n",
             getenv("AMONTONS_SOURCE"));
    place_write(place, "study.yaml", text);
    return 0;
}

FIXTURE(end)
{
    place_remove(place);
    return 0;
}

GROUP_BETWEEN(begin, end);
