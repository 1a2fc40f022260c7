// SPDX-License-Identifier: GPL-2.0-or-later
// The words of `amontons info` on a scene and on a result that the test writes itself; every failed
// allocation is an error and leaks nothing.
#include "amontons.h"
#include "base/memory.h"
#include "cases.h"
#include "io/files/own_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/info-test-XXXXXX";

static void write_text(const char *name, const char *text)
{
    char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void assert_info_holds(const char *path, const char *const *parts)
{
    char *text = NULL;
    size_t size = 0;
    Error err = {0};
    FILE *out = open_memstream(&text, &size);
    if (!amontons_info(path, NULL, out, &err)) fail_msg("%s", err.message);
    fclose(out);
    for (; *parts; parts++)
        if (!strstr(text, *parts)) fail_msg("no `%s` in\n%s", *parts, text);
    free(text);
}

static void assert_faults_are_clean(const char *path)
{
    int64_t live = memory_counters().live;
    bool done = false;
    for (int64_t k = 0; !done; k++) {
        assert_true(k < 400);
        Error err = {0};
        FILE *out = fopen("/dev/null", "w");
        memory_fail_after(k);
        done = amontons_info(path, NULL, out, &err);
        memory_fail_after(-1);
        fclose(out);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
    }
}

TEST(test_result)
{
    static const char *const unfinished[] = {"no run.json", NULL};
    static const char *const whole[] = {
        "status             done",
        "mu_M               0.251, one mesh: known to about 2 % (on this mesh 0.251234)\n",
        "mu_M spread        none",
        "mu_hold            0.234568\n",
        "mu_max             0.375\n",
        "accepted steps     12345678\n",
        NULL};
    static const char *const failed[] = {"status             failed",
                                         "failure            computation failed",
                                         "message            the ledger does not close", NULL};
    write_text("history.h5", "");   // that it is there is all that counts
    assert_info_holds(folder, unfinished);
    static const char *const killed[] = {"no run.json", "checkpoint.bin: `run --resume` goes on",
                                         NULL};
    write_text("checkpoint.bin", "");
    assert_info_holds(folder, killed);
    char checkpoint[200];
    snprintf(checkpoint, sizeof checkpoint, "%s/checkpoint.bin", folder);
    unlink(checkpoint);
    write_text("run.json", "{\"status\": \"failed\", \"failure\": \"computation failed\", "
                           "\"message\": \"the ledger does not close\"}");
    assert_info_holds(folder, failed);
    write_text("run.json", "{\"status\": \"done\", \"results\": {\"mu_M\": 0.251234, "
                           "\"mu_M_error\": 3.1e-4, \"mu_M_known_to\": 4e-3, "
                           "\"mu_M_spread\": null, "
                           "\"mu_hold\": 0.2345678, \"mu_hold_error\": null, "
                           "\"mu_max\": 0.375}, \"steps\": {\"accepted\": 12345678}}");
    assert_info_holds(folder, whole);
    static const char *const files[] = {"run.json", "history.h5"};
    for (int k = 0; k < 2; k++) {
        char path[200];
        snprintf(path, sizeof path, "%s/%s", folder, files[k]);
        assert_info_holds(path, whole);   // its folder
    }
    assert_faults_are_clean(folder);
}

// By the file's name alone in the folder where it lies; and what makes no sense there.
TEST(test_where_one_stands)
{
    static const char *const said[] = {"accepted steps     12345678\n", NULL};
    char here[4000];
    Error err = {0};
    FILE *out = fopen("/dev/null", "w");
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(folder), 0);
    assert_info_holds("history.h5", said);
    InfoOptions picture = {.picture = "x.png"};
    assert_false(amontons_info(".", &picture, out, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "is a result folder"));
    static const char *const setting[] = {"nx=3"};
    InfoOptions set = {.overrides = setting, .override_count = 1};
    err = (Error){0};
    assert_false(amontons_info(".", &set, out, &err));
    write_text("s.yml", "title: By hand\nmesh: {file: b.geo}\nmaterial: {poisson: 0.3}\n"
                        "friction: {law: coulomb, mu_static: 0.5}\nload: {pressure: 0.01}\n"
                        "rod: {velocity: 1e-4}\ntime: {until: {U: 0.1}}\n");
    static const char *const scene[] = {"material.poisson             0.3\n", NULL};
    assert_info_holds("s.yml", scene);
    unlink("s.yml");
    err = (Error){0};
    fclose(out);
    assert_non_null(out = fopen("/dev/full", "w"));
    assert_false(amontons_info(".", NULL, out, &err));
    assert_int_equal(err.code, ERROR_FILE);
    fclose(out);
    assert_int_equal(chdir(here), 0);
}

TEST(test_scene)
{
    static const char *const parts[] = {"By hand", "material.poisson             0.3\n",
                                        "rod.kind                     push   (default)\n", NULL};
    char path[200];
    write_text("s.yaml", "title: By hand\nmesh: {file: b.geo}\nmaterial: {poisson: 0.3}\n"
                         "friction: {law: coulomb, mu_static: 0.5}\nload: {pressure: 0.01}\n"
                         "rod: {velocity: 1e-4}\ntime: {until: {U: 0.1}}\n");
    snprintf(path, sizeof path, "%s/s.yaml", folder);
    assert_info_holds(path, parts);
    assert_faults_are_clean(path);
}

// A run of some seconds: thousands of events, 200000 values in run.json.
TEST(test_long_result)
{
    static const char *const parts[] = {"mu_M               0.25\n", "accepted steps     7\n",
                                        NULL};
    enum { EVENTS = 50000, EACH = 60 };
    char *text = malloc(EVENTS * EACH + 200);
    char *end = text + sprintf(text, "{\"status\": \"done\", \"results\": {\"mu_M\": 0.25, "
                                     "\"events\": [");
    for (int32_t k = 0; k < EVENTS; k++)
        end += sprintf(end, "%s{\"kind\": \"bounded\", \"U\": %d, \"x\": [1, 2]}",
                       k > 0 ? ",\n" : "", k);
    strcpy(end, "]}, \"steps\": {\"accepted\": 7}}");
    write_text("run.json", text);
    free(text);
    assert_info_holds(folder, parts);
}

// Killed, with and without a checkpoint; a file that is nothing of ours, a picture of one.
TEST(test_odd_folders)
{
    Error err = {0};
    char path[200], other[200];
    snprintf(other, sizeof other, "%s/run.json", folder);
    write_text("notes.txt", "mine\n");
    snprintf(path, sizeof path, "%s/notes.txt", folder);
    assert_false(amontons_info(path, NULL, stdout, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    unlink(path);
    InfoOptions options = {.picture = "/proc/none/a.png"};
    write_text("run.json", "{}");
    error_clear(&err);
    assert_false(amontons_info(folder, &options, stdout, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    static const char *const wrong[] = {"n", "=3", "n=",
                                        "a_name_that_is_longer_than_any_name_of_a_parameter_of_a_"
                                        "mesh_may_be_in_a_scene_or_here=1"};
    snprintf(path, sizeof path, "%s/meshes/block.geo", getenv("AMONTONS_SOURCE"));
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        options = (InfoOptions){.overrides = &wrong[k], .override_count = 1};
        error_clear(&err);
        assert_false(amontons_info(path, &options, stdout, &err));
        if (!strstr(err.message, wrong[k])) fail_msg("%s", err.message);
    }
    write_text("run.json",
               "{\"status\": \"failed\", \"results\": {\"mu_M\": null, \"mu_max\": 1e300}}");
    static const char *const parts[] = {"failed", "none", "1e+300", NULL};
    assert_info_holds(folder, parts);
    unlink(other);
}

TEST(test_broken_results)
{
    Error err = {0};
    char path[200];
    write_text("run.json", "{\"status\": ");
    assert_false(amontons_info(folder, NULL, stdout, &err));
    assert_non_null(strstr(err.message, "run.json:1:"));
    snprintf(path, sizeof path, "%s/run.json", folder);
    unlink(path);
    snprintf(path, sizeof path, "%s/history.h5", folder);
    unlink(path);
    error_clear(&err);
    assert_false(amontons_info(folder, NULL, stdout, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "not a result folder"));
}

FIXTURE(group_begin)
{
    return mkdtemp(folder) && own_list_make(folder, &(Error){0}) ? 0 : -1;
}

FIXTURE(group_end)
{
    char path[200];
    snprintf(path, sizeof path, "%s/s.yaml", folder);
    unlink(path);
    snprintf(path, sizeof path, "%s/" OWN_LIST_NAME, folder);
    unlink(path);
    return rmdir(folder);
}

GROUP_BETWEEN(group_begin, group_end);
