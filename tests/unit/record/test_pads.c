// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up cycles on two pads, one of nodes 0 to 2, the other of nodes 3 and 4: who carries what,
// who lets go when, how much slips before it slips fast; and a real block on three pads.
#include "record/pads.h"

#include "amontons.h"
#include "base/memory.h"
#include "io/hdf5/result_file.h"
#include "plane.h"
#include "result_place.h"
#include "run/simulation_state.h"
#include "seen_by_hand.h"

typedef struct Fixture {
    HandRun run;
    Pads pads;
} Fixture;

static void fixture_build(Fixture *fixture)
{
    Error err = {0};
    hand_run_begin(&fixture->run, 2);
    assert_true(
        pads_create(&fixture->run.hand.interface, &fixture->run.events, &fixture->pads, &err));
    recorders_add(&fixture->run.recorders, &fixture->pads, pads_record);
}

static void fixture_destroy(Fixture *fixture)
{
    pads_destroy(&fixture->pads);
    pads_destroy(&fixture->pads);
    events_destroy(&fixture->run.events);
}

// Node i presses with 10 mu + i and is held by mu + i.
static void see(Fixture *fixture, double mu, const double rate[SEEN_NODES])
{
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        fixture->run.hand.reaction[plane_normal(i)] = 10 * mu + i;
        fixture->run.hand.reaction[plane_tangent(i)] = -(mu + i);
    }
    hand_run_see(&fixture->run, mu, rate);
}

static const double REST[] = {0, 0, 0, 0, 0}, ACROSS[] = {9, 9, 9, 9, 9};
static const double TAIL[] = {0.5, 0.5, 0.5, 0.5, 0.5};

// The pads: nodes weigh 1/8, 1/4, 1/4 and 1/4, 1/8.
TEST(test_what_they_are)
{
    Fixture fixture;
    fixture_build(&fixture);
    const Pad *left = &fixture.pads.list[0], *right = &fixture.pads.list[1];
    assert_int_equal(fixture.pads.count, 2);
    assert_string_equal(left->name, "left");
    assert_string_equal(right->name, "right");
    assert_true(left->size.nodes == 3 && right->size.nodes == 2);
    assert_true(left->size.x_from == 0 && left->size.x_to == 0.5 && right->size.x_from == 0.75);
    assert_near("length", left->length, 0.625, 1e-15);
    assert_near("length", right->length, 0.375, 1e-15);
    see(&fixture, 0, REST);
    see(&fixture, 1, REST);
    assert_near("at the start", left->normal_force_start, 3, 1e-15);
    assert_near("at the start", right->normal_force_start, 7, 1e-15);
    assert_true(isnan(left->last.shear) && isnan(left->now.U_first_slip) && left->last.order == 0);
    fixture_destroy(&fixture);
}

// Slow slip on the left pad up to two of its nodes, then fast; the whole block goes from there.
TEST(test_cycle)
{
    Fixture fixture;
    fixture_build(&fixture);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, (double[]){0.5, 0, 0, 0, 0});   // U = 0.1
    see(&fixture, 0.4, (double[]){0.5, 0.5, 0, 0, 0});   // U = 0.2: the largest mu
    see(&fixture, 0.3, (double[]){9, 9, 9, 0, 0});   // U = 0.3, t = 3: left lets go, fast
    see(&fixture, 0.3, (double[]){9, 9, 9, 9, 0});   // U = 0.4
    see(&fixture, 0.2, ACROSS);   // U = 0.5: sliding
    see(&fixture, 0.9, ACROSS);   // not a peak: it slides
    const PadCycle *left = &fixture.pads.list[0].last, *right = &fixture.pads.list[1].last;
    assert_int_equal(fixture.pads.cycles, 1);
    assert_near("load", left->normal_force, 12 + 3, 1e-14);
    assert_near("load", right->normal_force, 8 + 7, 1e-14);
    assert_near("shear", left->shear, 1.2 + 3, 1e-14);
    assert_near("shear", right->shear, 0.8 + 7, 1e-14);
    assert_near("first", left->U_first_slip, 0.1, 1e-15);
    assert_near("first", right->U_first_slip, 0.4, 1e-15);
    assert_near("all", left->U_detached, 0.3, 1e-15);
    assert_near("all", right->U_detached, 0.5, 1e-15);
    assert_true(left->order == 1 && right->order == 2);
    assert_near("rapid", left->t_rapid, 3, 0);
    assert_near("rapid", right->U_rapid, 0.4, 1e-15);
    assert_near("l_c", left->slow_length, 0.375, 1e-15);
    assert_true(isnan(right->slow_length));   // the left pad's slip ran over it
    fixture_destroy(&fixture);
}

// The slow tail of a sliding belongs to no cycle; slip counts once a node has stuck. Pads that go
// in one step share their place, and the next one after two is third.
TEST(test_next_cycle)
{
    Fixture fixture;
    fixture_build(&fixture);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, ACROSS);   // both at once
    const Pads *pads = &fixture.pads;
    assert_true(pads->list[0].last.order == 1 && pads->list[1].last.order == 1);
    see(&fixture, 0.1, TAIL);   // the event ends here
    see(&fixture, 0.1, TAIL);
    assert_true(isnan(pads->list[0].now.U_first_slip));
    see(&fixture, 0.1, REST);   // U = 0.4
    see(&fixture, 0.2, (double[]){0, 0, 0, 0.5, 0.5});   // U = 0.5: right first
    see(&fixture, 0.3, (double[]){0.5, 0.5, 0.5, 0.5, 0.5});   // U = 0.6
    see(&fixture, 0.2, ACROSS);   // U = 0.7
    assert_int_equal(pads->cycles, 2);
    assert_near("first", pads->list[1].last.U_detached, 0.5, 1e-15);
    assert_near("then", pads->list[0].last.U_detached, 0.6, 1e-15);
    assert_true(pads->list[1].last.order == 1 && pads->list[0].last.order == 2);
    assert_near("l_c", pads->list[0].last.slow_length, 0.625, 1e-15);
    assert_true(isnan(pads->list[1].last.slow_length));
    fixture_destroy(&fixture);
}

// A foot whose corner is lifted from the start lets go with its other nodes; the corner alone is no
// slip, and a foot that never touches lets go of nothing.
TEST(test_lifted_corner)
{
    Fixture fixture;
    char order[PADS_ORDER_SIZE];
    fixture_build(&fixture);
    fixture.run.hand.open[0] = true;
    see(&fixture, 0.1, REST);
    assert_true(isnan(fixture.pads.list[0].now.U_first_slip));
    pads_order(&fixture.pads, false, order);
    assert_string_equal(order, "");
    see(&fixture, 0.2, (double[]){0, 0.5, 0, 0, 0});   // U = 0.1
    see(&fixture, 0.3, (double[]){0, 0.5, 0.5, 0, 0});   // U = 0.2
    see(&fixture, 0.3, ACROSS);
    const PadCycle *left = &fixture.pads.list[0].last;
    assert_near("first", left->U_first_slip, 0.1, 1e-15);
    assert_near("all", left->U_detached, 0.2, 1e-15);
    assert_int_equal(left->order, 1);
    assert_int_equal(fixture.pads.list[1].last.order, 2);
    pads_order(&fixture.pads, false, order);
    assert_string_equal(order, "left, right");
    fixture_destroy(&fixture);
}

// Another order before the next sliding: what went before the first is kept.
TEST(test_first_and_last)
{
    Fixture fixture;
    char order[PADS_ORDER_SIZE];
    fixture_build(&fixture);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, (double[]){0.5, 0.5, 0.5, 0, 0});
    see(&fixture, 0.3, ACROSS);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, (double[]){0, 0, 0, 0.5, 0.5});
    see(&fixture, 0.3, ACROSS);
    pads_order(&fixture.pads, true, order);
    assert_string_equal(order, "left, right");
    pads_order(&fixture.pads, false, order);
    assert_string_equal(order, "right, left");
    fixture_destroy(&fixture);
}

TEST(test_foot_in_the_air)
{
    Fixture fixture;
    char order[PADS_ORDER_SIZE];
    fixture_build(&fixture);
    fixture.run.hand.open[3] = fixture.run.hand.open[4] = true;
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, ACROSS);
    assert_int_equal(fixture.pads.list[1].last.order, 0);
    pads_order(&fixture.pads, false, order);
    assert_string_equal(order, "left");
    fixture_destroy(&fixture);
}

// Names of pads that let go together, and as many as there is room for.
TEST(test_order_in_words)
{
    enum { MANY = 40 };
    char order[PADS_ORDER_SIZE];
    Pad list[MANY] = {0};
    Pads pads = {.count = 3, .list = list};
    for (int32_t p = 0; p < MANY; p++) {
        snprintf(list[p].name, sizeof list[p].name, "contact_%d", p + 1);
        list[p].last.order = p + 1;
    }
    list[0].last.order = 2;
    list[1].last.order = 1;
    list[2].last.order = 2;
    pads_order(&pads, false, order);
    assert_string_equal(order, "contact_2, contact_1 with contact_3");
    pads.count = MANY;
    list[0].last.order = list[2].last.order = 3;
    pads_order(&pads, false, order);
    assert_non_null(strstr(order, "contact_2, contact_1 with contact_3, contact_4, "));
    const char *last = strrchr(order, ',');
    int32_t told = 1, left = 0;
    for (const char *c = order; (c = strstr(c + 1, "contact_"));) told++;
    assert_int_equal(sscanf(last, ", and %d more", &left), 1);
    assert_int_equal(told + left, MANY);
}

// Slip that turned fast, came to rest and turned fast again: the last time counts.
TEST(test_bounded_first)
{
    Fixture fixture;
    fixture_build(&fixture);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, (double[]){9, 0, 0, 0, 0});
    see(&fixture, 0.2, REST);
    see(&fixture, 0.3, (double[]){0.5, 0.5, 0, 0, 0});
    see(&fixture, 0.3, ACROSS);   // U = 0.4
    const PadCycle *left = &fixture.pads.list[0].last;
    assert_near("first", left->U_first_slip, 0.1, 1e-15);
    assert_near("rapid", left->U_rapid, 0.4, 1e-15);
    assert_near("l_c", left->slow_length, 0.375, 1e-15);
    fixture_destroy(&fixture);
}

// Each rapid event in which all of a pad slipped counts for it, whether or not others slid as well.
TEST(test_slidings)
{
    Fixture fixture;
    fixture_build(&fixture);
    for (int32_t k = 0; k < 3; k++) {
        see(&fixture, 0.1, REST);
        see(&fixture, 0.4, (double[]){9, 9, 0, 0, 0});   // part of the left pad
        see(&fixture, 0.2, REST);
        see(&fixture, 0.3, (double[]){9, 9, 9, 0, 0});   // all of it
        see(&fixture, 0.3, (double[]){9, 9, 9, 9, 0});
        see(&fixture, 0.1, REST);
        see(&fixture, 0.2, ACROSS);   // both
        see(&fixture, 0.1, REST);
    }
    assert_int_equal(fixture.pads.list[0].slidings, 6);
    assert_int_equal(fixture.pads.list[1].slidings, 3);
    fixture_destroy(&fixture);
}

TEST(test_memory_faults)
{
    Fixture fixture;
    fixture_build(&fixture);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        Pads pads;
        memory_fail_after(k);
        done = pads_create(&fixture.run.hand.interface, &fixture.run.events, &pads, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        pads_destroy(&pads);
        assert_int_equal(memory_counters().live, live);
    }
    fixture_destroy(&fixture);
}

// --- a block on three pads ----------------------------------------------------------------------

static Scene *read_scene(void)
{
    static const char *const overrides[] = {
        "mesh.file=../../meshes/pads.geo",
        "mesh.set={n: 3, cells_pad: 4, cells_gap: 3, nz: 8, total_height: 0.5}",
        "time.until={U: 0.012}", "output={history: true, fields: none, figures: []}"};
    char path[600];
    Error err = {0};
    Scene *scene = NULL;
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    if (!amontons_scene_read(path, overrides, 4, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

static double sum_of(ArrayFile *file, ResultSeries series, int64_t row)
{
    Error err = {0};
    double *values = NULL, sum = 0;
    int64_t rows = 0;
    int32_t width = 0;
    assert_true(result_file_read_series(file, series, &values, &rows, &width, &err));
    if (row < 0) row += rows;
    for (int32_t k = 0; k < width; k++) sum += values[row * width + k];
    memory_free(values);
    return sum;
}

// The second run of a shape takes the pads' names from the cache.
TEST(test_names_from_cache)
{
    char place[PLACE_SIZE], cache[PLACE_SIZE + 8];
    place_make(place);
    snprintf(cache, sizeof cache, "%s/cache", place);
    setenv("AMONTONS_CACHE", cache, 1);
    Scene *scene = read_scene();
    for (int32_t k = 0; k < 2; k++) {
        Error err = {0};
        RunOptions options = {.folder = NULL};
        Simulation *simulation = NULL;
        if (!amontons_simulation_create(scene, &options, &simulation, &err))
            fail_msg("%s", err.message);
        assert_int_equal(simulation->model.from_cache, k == 1);
        assert_int_equal(simulation->pads.count, 3);
        assert_string_equal(simulation->pads.list[2].name, "contact_3");
        amontons_simulation_destroy(simulation);
    }
    amontons_scene_destroy(scene);
    setenv("AMONTONS_CACHE", "", 1);
    place_remove(place);
}

// Pads carry the whole load and, at rest at the end, hold the whole rod's force; they are named in
// the history, and the trailing pad lets go first.
TEST(test_block_on_pads)
{
    Error err = {0};
    char place[PLACE_SIZE], names[128], path[600];
    place_make(place);
    setenv("AMONTONS_CACHE", "", 1);
    Scene *scene = read_scene();
    RunOptions options = {.folder = place, .overwrite = true};
    RunSummary summary;
    if (!amontons_run(scene, &options, &summary, &err)) fail_msg("%s", err.message);
    assert_true(summary.leading >= 2);
    ArrayFile *file = result_file_open(place, &err);
    assert_non_null(file);
    assert_true(result_file_text(file, "pads", names, sizeof names, &err));
    assert_string_equal(names, "contact_1\ncontact_2\ncontact_3");
    assert_near("load", sum_of(file, SERIES_PAD_NORMAL, 0), 0.003, 1e-9);
    assert_near("load", sum_of(file, SERIES_PAD_NORMAL, -1), 0.003, 1e-5);
    double shear = sum_of(file, SERIES_PAD_SHEAR, -1);
    assert_near("shear", shear, sum_of(file, SERIES_ROD_FORCE, -1), 2e-3 * shear);
    assert_true(array_file_close(file, &err));
    snprintf(path, sizeof path, "%s/run.json", place);
    FILE *json = fopen(path, "r");
    char *text = NULL;
    size_t size = 0;
    assert_true(json && getdelim(&text, &size, '\0', json) > 0);
    fclose(json);
    const char *first = strstr(text, "\"name\": \"contact_1\""),
               *second = strstr(text, "\"name\": \"contact_2\""),
               *third = strstr(text, "\"name\": \"contact_3\"");
    assert_true(first && second && third && first < second && second < third);
    assert_non_null(strstr(first, "\"detachment_order\": 1"));
    assert_true(strstr(first, "\"detachment_order\": 1") < second);
    free(text);
    amontons_scene_destroy(scene);
    place_remove(place);
}
