// SPDX-License-Identifier: GPL-2.0-or-later
// When fields are written, under which names, and that more frames than there was room for are all
// listed. What stands in them is held against history and report end to end (test_run_fields.py).
#include "record/fields.h"

#include "io/files/own_list.h"

#include "block_rig.h"
#include "result_place.h"

static BlockRig rig;
static Material material;
static State now;
static Events events;
static Fields fields;
static Observation seen;
static char place[PLACE_SIZE];

FIXTURE(setup)
{
    Error err = {0};
    RigDef def = rig_def();
    def.block.nx = def.block.nz = 1;
    def.rod_width = 0;
    material = def.material;
    rig_build(&def, &rig);
    events = (Events){0};
    assert_true(state_create(&rig.system, &rig.interface, &now, &err));
    seen = (Observation){.state = &now, .interface = &rig.interface, .system = &rig.system};
    place_make(place);
    if (!own_list_make(place, &err)) return 1;   // some write twice
    return 0;
}

FIXTURE(teardown)
{
    fields_destroy(&fields);
    fields_destroy(&fields);
    state_destroy(&now);
    rig_destroy(&rig);
    place_remove(place);
    return 0;
}

static void start(FieldsDef def)
{
    Error err = {0};
    assert_true(fields_create(&def, place, &rig.mesh, &rig.interface, &fields, &err));
    fields.files.materials = &material;
    fields.files.spectrum = &rig.bulk.spectrum;
    fields.friction = &rig.friction;
    fields.events = &events;
}

// Whether a step at this t (and U = t/100) was written.
static bool record(double t)
{
    Error err = {0};
    int32_t before = fields.written;
    now.time = seen.t = t;
    seen.U = t / 100;
    if (!fields_record(&fields, &seen, &err)) fail_msg("%s", err.message);
    return fields.written > before;
}

static void expect_written(const double *times, const bool *wanted, int32_t count)
{
    for (int32_t k = 0; k < count; k++)
        if (record(times[k]) != wanted[k]) fail_msg("t = %g: %d", times[k], !wanted[k]);
}

TEST_BETWEEN(test_every_U, setup, teardown)
{
    start((FieldsDef){.every_U = 0.1});
    expect_written((double[]){0, 5, 9.9, 10.5, 11, 26, 29, 30.5, 30.6, 61, 62},
                   (bool[]){1, 0, 0, 1, 0, 1, 0, 1, 0, 1, 0}, 11);
}

// At a slip rate of 0.1 in steps of 1 that do not show in U: by hand, every third.
TEST_BETWEEN(test_every_slip, setup, teardown)
{
    start((FieldsDef){.every_slip = 0.25});
    seen.max_slip_rate = 0.1;
    seen.step_size = 1;
    expect_written((double[]){0, 1, 2, 3, 4, 5, 6, 7}, (bool[]){1, 0, 0, 1, 0, 0, 1, 0}, 8);
    seen.max_slip_rate = seen.step_size = 0;
}

TEST_BETWEEN(test_every_t, setup, teardown)
{
    start((FieldsDef){.every_t = 2});
    expect_written((double[]){0, 1, 2, 3, 7, 7.9, 8}, (bool[]){1, 0, 1, 0, 1, 0, 1}, 7);
}

TEST_BETWEEN(test_at_events, setup, teardown)
{
    bool *const flags[] = {&events.began, &events.crossed, &events.ended};
    start((FieldsDef){.at_events = true});
    assert_true(record(0));   // the start in any case
    for (int k = 0; k < 3; k++) {
        *flags[k] = true;
        assert_true(record(2 * k + 1));
        *flags[k] = false;
        assert_false(record(2 * k + 2));
    }
    fields_destroy(&fields);
    start((FieldsDef){.every_t = 100});
    assert_true(record(0));
    events.began = true;
    assert_false(record(1));   // not asked for
    events.began = false;
}

// 150 frames: every file is there, and the list names each with its time.
TEST_BETWEEN(test_many, setup, teardown)
{
    static char list[100000];
    start((FieldsDef){.every_t = 1});
    for (int32_t k = 0; k < 150; k++) assert_true(record(k));
    assert_true(fields_flush(&fields, &(Error){0}));
    place_read(place, "fields.pvd", list, sizeof list);
    const char *at = list;
    for (int32_t k = 0; k < 150; k++) {
        char name[64], time[64];
        snprintf(time, sizeof time, "timestep=\"%d\"", k);
        const char *const kinds[] = {"fields/bulk_%06d.vtu", "fields/interface_%06d.vtp"};
        for (int kind = 0; kind < 2; kind++) {
            snprintf(name, sizeof name, kinds[kind], k);
            assert_true(place_has(place, name));
            const char *line = strstr(at, "<DataSet");
            assert_non_null(line);
            const char *end = strchr(line, '\n');
            const char *named = strstr(line, name), *timed = strstr(line, time);
            if (!named || named > end || !timed || timed > end)
                fail_msg("%s is not listed in its place", name);
            at = end;
        }
    }
    assert_null(strstr(at, "<DataSet"));
}

TEST_BETWEEN(test_memory_faults, setup, teardown)
{
    int64_t live = memory_counters().live;
    bool done = false;
    FieldsDef def = {.every_t = 1};
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        memory_fail_after(k);
        done = fields_create(&def, place, &rig.mesh, &rig.interface, &fields, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        fields_destroy(&fields);
        assert_int_equal(memory_counters().live, live);
    }
    start(def);
    for (int32_t k = 0; k < 64; k++) assert_true(record(k));
    Error err = {0};
    now.time = seen.t = 100;
    memory_fail_after(0);   // the list is full and cannot grow
    assert_false(fields_record(&fields, &seen, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    fields.next_t = 0;
    assert_true(record(100));   // and then it can
    assert_true(fields_flush(&fields, &(Error){0}));
    assert_int_equal(fields.listed, 65);
    assert_true(fields.times[64] == 100);
}
