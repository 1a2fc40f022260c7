// SPDX-License-Identifier: GPL-2.0-or-later
// Every allocation of a tiny run fails in turn while a cache is filled, and again while it is read:
// out of memory or, where only the keeping failed, done with a note; nothing is lost, nothing
// half-written is ever taken for a shape.
#include "base/memory.h"
#include "result_place.h"
#include "small_scene.h"

static const char *const TINY[] = {
    "mesh.set.nx=2",        "mesh.set.nz=2",        "rod.width=0.3",
    "time.until={t: 2}",    "time.step_max=1",      "output.history=false",
    "reduction.use=always", "reduction.cache=true", NULL};

static bool run_once(const Scene *scene, const char *folder, Error *err)
{
    RunSummary summary;
    RunOptions options = {.folder = folder, .overwrite = true};
    return amontons_run(scene, &options, &summary, err);
}

static bool report_says(const char *folder, const char *text)
{
    char path[PLACE_SIZE + 16], bytes[1 << 14] = "";
    snprintf(path, sizeof path, "%s/run.json", folder);
    FILE *stream = fopen(path, "rb");
    if (!stream) return false;
    bytes[fread(bytes, 1, sizeof bytes - 1, stream)] = 0;
    fclose(stream);
    return strstr(bytes, text) != NULL;
}

TEST(test_cache)
{
    char place[PLACE_SIZE], cache[PLACE_SIZE];
    place_make(place);
    place_make(cache);
    setenv("AMONTONS_CACHE", cache, 1);
    Scene *scene = small_scene(TINY);
    int64_t live = memory_counters().live;
    int32_t cold = 0, warm = 0, refused = 0;
    for (bool done = false; !done; cold++) {   // until the basis is kept
        Error err = {0};
        memory_fail_after(cold);
        done = run_once(scene, place, &err);
        memory_fail_after(-1);
        if (!done && err.code != ERROR_MEMORY)
            fail_msg("allocation %d: %s: %s", cold, amontons_error_name(err.code), err.message);
        assert_int_equal(memory_counters().live, live);
    }
    assert_true(report_says(place, "\"from_cache\": true"));   // kept by a run that failed later
    for (bool done = false; !done; warm++) {
        Error err = {0};
        memory_fail_after(warm);
        done = run_once(scene, place, &err);
        memory_fail_after(-1);
        refused += !done;
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
    }
    print_message("%d allocations to build, %d to take from the cache\n", cold, warm);
    assert_true(cold > 60 && warm > 30 && refused == warm - 1);
    assert_true(report_says(place, "\"cache_note\": null"));
    amontons_scene_destroy(scene);
    place_remove(cache);
    place_remove(place);
}
