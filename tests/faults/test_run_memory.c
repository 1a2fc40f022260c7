// SPDX-License-Identifier: GPL-2.0-or-later
// Every allocation of a tiny run fails in turn: the run says it is out of memory, and gives back
// all it had, whatever it was about.
#include "base/memory.h"
#include "result_place.h"
#include "small_scene.h"

static const char *const TINY[] = {"mesh.set.nx=2",
                                   "mesh.set.nz=2",
                                   "rod.width=0.3",
                                   "time.until={t: 2}",
                                   "time.step_max=1",
                                   NULL,
                                   NULL,
                                   NULL,
                                   NULL};

static int32_t fail_everywhere(const char *const *more, const char *folder)
{
    const char *settings[16];
    int32_t count = 0, failed = 0;
    for (const char *const *setting = TINY; *setting; setting++) settings[count++] = *setting;
    while (*more) settings[count++] = *more++;
    settings[count] = NULL;
    Scene *scene = small_scene(settings);
    int64_t live = memory_counters().live;
    for (bool done = false; !done; failed += !done) {
        Error err = {0};
        RunSummary summary;
        RunOptions options = {.folder = folder, .overwrite = true};
        memory_fail_after(failed);
        done = amontons_run(scene, &options, &summary, &err);
        memory_fail_after(-1);
        if (done) continue;
        if (err.code != ERROR_MEMORY)
            fail_msg("allocation %d: %s: %s", failed, amontons_error_name(err.code), err.message);
        if (memory_counters().live != live)
            fail_msg("allocation %d: %d arrays are not freed", failed,
                     (int)(memory_counters().live - live));
        if (folder && place_has(folder, "run.json.part")) fail_msg("half a report is left");
    }
    assert_int_equal(memory_counters().live, live);
    amontons_scene_destroy(scene);
    return failed;
}

TEST(test_full)
{
    int32_t failed = fail_everywhere((const char *const[]){"reduction.use=never", NULL}, NULL);
    assert_true(failed > 50);
}

TEST(test_reduced)
{
    int32_t failed = fail_everywhere((const char *const[]){"reduction.use=always", NULL}, NULL);
    assert_true(failed > 50);
}

TEST(test_results)
{
    char place[PLACE_SIZE];
    place_make(place);
    int32_t failed = fail_everywhere(
        (const char *const[]){"reduction.use=never", "output.fields={every_t: 1}", NULL}, place);
    assert_true(failed > 100);
    assert_true(place_has(place, "run.json") && place_has(place, "history.h5"));
    place_remove(place);
}
