// SPDX-License-Identifier: GPL-2.0-or-later
// Records of a contact in space: nine nodes at x, y = 0, 0.5, 1, in order of x, then y.
//
//      y  2---5---8     weights: corners 1/16, sides 1/8, the middle 1/4
//         1---4---7     the line along the drive: 1, 4, 7
//         0---3---6  x
#include "base/memory.h"
#include "contact/slip.h"
#include "near.h"
#include "answers/answers.h"
#include "record/contact_arrays.h"
#include "record/history.h"
#include "record/pads.h"
#include "record/rotation.h"
#include "result_place.h"

enum { NODES = 9, UNKNOWNS = 3 * NODES };

typedef struct HandSpace {
    Interface interface;
    BulkOperator system;
    State state;
    Observation seen;
    double x[NODES], y[NODES], weight[NODES];
    int32_t pad[NODES], dofs[UNKNOWNS];
    double displacement[UNKNOWNS], slip_rate[UNKNOWNS], reaction[UNKNOWNS];
    uint8_t status[NODES];
} HandSpace;

static HandSpace hand;
static Events events;

FIXTURE(setup)
{
    Error err = {0};
    hand = (HandSpace){
        .interface = {.dim = 3,
                      .contact_count = NODES,
                      .count = UNKNOWNS,
                      .x = hand.x,
                      .y = hand.y,
                      .weight = hand.weight,
                      .pad = hand.pad,
                      .pad_count = 1,
                      .dofs = hand.dofs},
        .system = {.dof_count = UNKNOWNS, .interface_count = UNKNOWNS, .interface_dofs = hand.dofs},
        .state = {.dof_count = UNKNOWNS,
                  .interface_count = UNKNOWNS,
                  .contact_count = NODES,
                  .displacement = hand.displacement,
                  .slip_rate = hand.slip_rate,
                  .reaction = hand.reaction,
                  .status = hand.status},
        .seen = {.state = &hand.state,
                 .interface = &hand.interface,
                 .system = &hand.system,
                 .certified = true}};
    for (int32_t i = 0; i < NODES; i++) {
        hand.x[i] = 0.5 * (i / 3);
        hand.y[i] = 0.5 * (i % 3);
        hand.weight[i] = 0.25 * (i / 3 == 1 ? 1 : 0.5) * (i % 3 == 1 ? 1 : 0.5);
    }
    for (int32_t k = 0; k < UNKNOWNS; k++) hand.dofs[k] = k;
    if (!interface_find_line(&hand.interface, &err)) return 1;
    return events_create(&hand.interface, 1, &events, &err) ? 0 : 1;
}

FIXTURE(teardown)
{
    events_destroy(&events);
    memory_free(hand.interface.line);
    return 0;
}

// At time t and U = t/10: nodes slip at these speeds in the direction (0.6, -0.8), 0 means they
// stick; front and largest rate as record/observation defines them.
static const Observation *show(double t, const double speed[NODES])
{
    hand.state.time = hand.seen.t = t;
    hand.seen.U = t / 10;
    hand.seen.max_slip_rate = hand.seen.front = 0;
    hand.seen.front_slips = speed[1] > 0;   // the trailing node of the middle line; none is open
    for (int32_t i = 0; i < NODES; i++) {
        hand.slip_rate[3 * i] = 0.6 * speed[i];
        hand.slip_rate[3 * i + 1] = -0.8 * speed[i];
        hand.status[i] = speed[i] > 0 ? CONTACT_SLIP_FORWARD : CONTACT_STICK;
        hand.seen.max_slip_rate = fmax(hand.seen.max_slip_rate, speed[i]);
    }
    for (int32_t i = 1; i < NODES && speed[i] > 0; i += 3) hand.seen.front = hand.x[i];
    return &hand.seen;
}

static void see(double t, const double speed[NODES])
{
    Error err = {0};
    assert_true(events_record(&events, show(t, speed), &err));
}

// --- the line along the drive -------------------------------------------------------------------

// Checks places in order of x; `line`: -1 ends it.
static void expect_line(int32_t count, double *x, double *y, const int32_t *line)
{
    Error err = {0};
    double weight[12];
    for (int32_t i = 0; i < count; i++) weight[i] = 1.0 / count;
    Interface interface = {.dim = 3, .contact_count = count, .x = x, .y = y, .weight = weight};
    assert_true(interface_find_line(&interface, &err));
    int32_t k = 0;
    for (; line[k] >= 0; k++) assert_int_equal(interface_line_node(&interface, k), line[k]);
    assert_int_equal(interface_line_count(&interface), k);
    memory_free(interface.line);
}

TEST_BETWEEN(test_line, setup, teardown)
{
    assert_int_equal(interface_line_count(&hand.interface), 3);
    for (int32_t k = 0; k < 3; k++)
        assert_int_equal(interface_line_node(&hand.interface, k), 3 * k + 1);
    // An even number of rows: the lower of those beside the middle, whatever rounding says.
    double x[12], y[12];
    for (int32_t i = 0; i < 12; i++) {
        x[i] = i / 4 * 0.5 + (i % 4 == 1 ? 1e-12 : 0);
        y[i] = i % 4 / 3.0 - (i == 6 ? 1e-12 : 0);
    }
    expect_line(12, x, y, (const int32_t[]){1, 5, 9, -1});
    // Cells long across: of nodes side by side that nearest to the middle; and none of the sides.
    double free_x[] = {0, 0, 0, 0.3, 0.3, 0.7, 1, 1},
           free_y[] = {0, 0.45, 1, 0.4, 0.5, 0.9, 0.55, 1};
    expect_line(8, free_x, free_y, (const int32_t[]){1, 4, 6, -1});
    // Two rows of pads with a gap along the middle: the lower row.
    double gap_x[] = {0, 0, 0, 0, 1, 1, 1, 1}, gap_y[] = {0, 0.4, 0.6, 1, 0, 0.4, 0.6, 1};
    expect_line(8, gap_x, gap_y, (const int32_t[]){1, 5, -1});
}

// --- events -------------------------------------------------------------------------------------

static const double REST[NODES] = {0};
static const double SLOW[NODES] = {0.5, 0.5, 0.5, 0.5, 0.5};   // all at x = 0, two at 0.5
static const double FAST[NODES] = {3, 3, 3, 3, 3, 0, 0, 3};   // the line to its end; 5, 6, 8 hold

// All of the line slips, and the block does not: corners and a side hold. In the second event the
// last of them let go one after the other.
TEST_BETWEEN(test_bulk_sliding_takes_all_nodes, setup, teardown)
{
    see(0, REST);
    see(1, SLOW);
    see(2, FAST);
    see(3, FAST);
    see(4, REST);
    const Event *slow = &events.list[0], *bounded = &events.list[1];
    assert_int_equal(events.kinds[EVENT_LEADING], 0);
    assert_int_equal(bounded->kind, EVENT_BOUNDED);
    assert_near("front", slow->reach, 0.5, 0);
    assert_near("slow", slow->slipped, 0.25 + 3.0 / 8, 1e-15);
    assert_near("speed", bounded->peak_slip_rate, 3, 1e-15);   // |v|, not its part along x
    assert_near("reach", bounded->reach, 1, 0);
    assert_near("area", bounded->slipped, 1 - 1.0 / 8 - 2.0 / 16, 1e-15);
    assert_near("before", bounded->slip_before, 5.0 / 8, 1e-15);
    assert_near("length", bounded->slip_length, 5.0 / 8, 1e-15);   // over a breadth of 1
    assert_near("cells", bounded->slip_cells, 5.0 / 8 * 3, 1e-15);   // nine nodes on an area of 1
    see(5, (const double[NODES]){3, 3, 3, 3, 3, 3, 0, 3, 0});
    see(6, (const double[NODES]){3, 0, 0, 0, 0, 0, 3, 0, 0});
    assert_false(events.crossed);
    see(7, (const double[NODES]){0, 0, 3, 0, 0, 0, 0, 0, 3});
    assert_true(events.crossed);
    see(8, REST);
    assert_int_equal(events.list[2].kind, EVENT_LEADING);
    assert_near("all", events.list[2].slipped, 1, 1e-15);
}

// Speeds pass the threshold 2 at times known by hand, also where v_x never does; slip that turns
// fast beside the line has a front from when it comes to it.
TEST_BETWEEN(test_front, setup, teardown)
{
    see(0, REST);
    see(1, (const double[NODES]){4});   // a corner, at t = 0.5
    see(2, (const double[NODES]){4, 4});   // node 1 at 1.5
    see(4, (const double[NODES]){4, 4, 0, 0, 4});   // node 4 at 3
    see(5, REST);
    const Event *event = &events.list[0];
    assert_near("start", event->t_start, 1, 0);
    assert_near("first", event->front_times[0], 1.5 - 1, 1e-15);
    assert_near("middle", event->front_times[10], 3 - 1, 1e-15);
    assert_near("between", event->front_times[5], 0.5 * (0.5 + 2), 1e-15);
    assert_true(isnan(event->front_times[20]));
    assert_near("corner", events.path.arrival[0], 0.5, 1e-15);
    assert_near("speed", event->front_speed, 0.5 / 2, 1e-15);
    assert_near("reach", event->reach, 0.5, 0);
}

TEST_BETWEEN(test_critical_area, setup, teardown)
{
    Error err = {0};
    Drops drops;
    assert_true(drops_create(&hand.interface, &events, 0.01, &drops, &err));
    const double all[NODES] = {9, 9, 9, 9, 9, 9, 9, 9, 9};
    const double *const steps[] = {REST, SLOW, all, all, REST};
    for (int32_t k = 0; k < 5; k++) {
        see(k, steps[k]);
        hand.seen.mu = k == 1 ? 0.4 : 0.1;
        assert_true(drops_record(&drops, &hand.seen, &err));
    }
    assert_int_equal(drops.count, 1);
    assert_near("A_c", drops.list[0].critical_part, 5.0 / 8, 1e-15);
    assert_near("l_c", drops.list[0].critical_length, 0.5, 1e-15);   // along the line
    assert_near("A_c", answers_of(&drops).critical_part, 5.0 / 8, 1e-15);
    drops_destroy(&drops);
}

// Pads side by side, y <= 0.5 and y = 1: forces, sizes; the second is none of the line.
TEST_BETWEEN(test_pads, setup, teardown)
{
    Error err = {0};
    PadSum sums[2];
    Pads pads;
    for (int32_t i = 0; i < NODES; i++) hand.pad[i] = i % 3 == 2;
    hand.interface.pad_count = 2;
    for (int32_t i = 0; i < NODES; i++) {
        hand.reaction[3 * i] = -0.1 * i;
        hand.reaction[3 * i + 1] = 7;   // across the drive: no shear of the block
        hand.reaction[3 * i + 2] = i;
    }
    pad_sums(show(0, FAST), sums);
    assert_near("normal", sums[0].normal_force, 21, 1e-14);
    assert_near("shear", sums[1].shear, 1.5, 1e-14);
    assert_near("slipping", sums[1].slipping, 1.0 / 16, 1e-15);
    assert_near("fastest", sums[1].fastest, 3, 1e-15);
    assert_true(pads_create(&hand.interface, &events, &pads, &err));
    assert_near("area", pads.list[0].size.weight, 0.75, 1e-15);
    assert_near("breadth", pads.list[0].size.breadth, 0.75, 1e-15);
    assert_near("length", pads.list[1].length, 1, 1e-15);
    assert_true(pads.list[0].size.y_to == 0.5 && pads.list[1].size.y_from == 1);
    pads_destroy(&pads);
}

// --- files --------------------------------------------------------------------------------------

static const FrictionLaw LAW = {.mu_static = 0.4, .mu_kinetic = 0.1, .critical_velocity = 4};
static const Friction FRICTION = {.whole = {.law = &LAW, .factor = 1}};

static void expect_values(ArrayFile *file, ResultSeries series, int32_t width, const double *wanted)
{
    Error err = {0};
    double *values = NULL;
    int64_t rows = 0;
    int32_t found = 0;
    assert_true(result_file_read_series(file, series, &values, &rows, &found, &err));
    assert_true(found == width && rows == 2);
    for (int32_t k = 0; k < width; k++)
        assert_near(result_series_name(series), values[width + k], wanted[k], 1e-6);
    memory_free(values);
}

// Slip, its rate and shear are vectors; what is judged by |v| is no longer weakening at 3.
TEST_BETWEEN(test_history, setup, teardown)
{
    Error err = {0};
    char place[PLACE_SIZE];
    ContactArrays contact;
    History history;
    ResultHead head = {.title = "space", .units = "normalised", .version = "test"};
    double rate[2 * NODES], slip[2 * NODES], shear[2 * NODES], status[NODES];
    place_make(place);
    assert_true(contact_arrays_create(&hand.interface, &FRICTION, &contact, &err));
    assert_true(history_create(place, &head, &hand.interface, &contact, &history, &err));
    for (int32_t k = 0; k < 2; k++) {
        const double speed[NODES] = {3, 5, 0};
        show(k, speed);
        for (int32_t i = 0; i < NODES; i++)
            for (int32_t c = 0; c < 2; c++) {
                hand.displacement[3 * i + c] = 5 + k * (i + 0.25 * c);
                hand.reaction[3 * i + c] = c - i;
                rate[2 * i + c] = (c == 0 ? 0.6 : -0.8) * speed[i];
                slip[2 * i + c] = i + 0.25 * c;
                shear[2 * i + c] = (i - c) / hand.weight[i];
                status[i] = speed[i] == 0 ? 1 : speed[i] < 4 ? 2 : 3;
            }
        assert_true(contact_arrays_record(&contact, &hand.seen, &err));
        assert_true(history_record(&history, &hand.seen, &err));
    }
    Drops drops = {.events = &events};
    assert_true(history_finish(&history, &drops, 0, NAN, NAN, &err));
    ArrayFile *file = result_file_open(place, &err);
    assert_non_null(file);
    expect_values(file, SERIES_SLIP_RATE, 2 * NODES, rate);
    expect_values(file, SERIES_SLIP, 2 * NODES, slip);
    expect_values(file, SERIES_SHEAR, 2 * NODES, shear);
    expect_values(file, SERIES_STATUS, NODES, status);
    // For nine nodes: sum of 1 - i below 0; slip by weights, whose mean of i is 4.
    expect_values(file, SERIES_PAD_SHEAR, 1, (const double[]){36});
    expect_values(file, SERIES_PAD_SHEAR_ACROSS, 1, (const double[]){36 - NODES});
    expect_values(file, SERIES_PAD_SLIP, 1, (const double[]){4});
    expect_values(file, SERIES_PAD_SLIP_ACROSS, 1, (const double[]){4.25});
    assert_near("format", result_file_number(file, NUMBER_FORMAT), 2, 0);
    double *y = NULL;
    int32_t count = 0;
    assert_true(result_file_read_nodes(file, NODES_Y, &y, &count, &err));
    assert_true(count == NODES && y[5] == 1);
    memory_free(y);
    assert_true(array_file_close(file, &err));
    history_destroy(&history);
    contact_arrays_destroy(&contact);
    place_remove(place);
}

// A rotation by 0.01 about (2, 1) and slip of (1, -0.2), with a stretch across that is no rotation.
TEST_BETWEEN(test_rotation, setup, teardown)
{
    Error err = {0};
    ContactArrays contact;
    assert_true(contact_arrays_create(&hand.interface, &FRICTION, &contact, &err));
    Rotation rotation = {.contact = &contact};
    for (int32_t k = 0; k < 3; k++) {
        double part = k == 1 ? 1 : 0.25 * k;   // it comes back half way
        for (int32_t i = 0; i < NODES; i++) {
            hand.displacement[3 * i] = part * (1 - 0.01 * (hand.y[i] - 1));
            hand.displacement[3 * i + 1] =
                part * (-0.2 + 0.01 * (hand.x[i] - 2) + 0.1 * (hand.y[i] - 0.5));
        }
        assert_true(contact_arrays_record(&contact, show(k, REST), &err));
        assert_true(rotation_record(&rotation, &hand.seen, &err));
    }
    assert_near("angle", rotation.angle, 0.01, 1e-15);
    assert_near("drift", rotation.drift, -0.215, 1e-15);
    assert_near("way", rotation.way, 1.005, 1e-15);
    assert_near("across", rotation.across, -0.27, 1e-15);
    assert_near("share", rotation_share(&rotation), 0.215 / 1.005, 1e-14);
    contact_arrays_destroy(&contact);
}

// A history of a format that is not known yet is refused in words.
TEST_BETWEEN(test_later_format, setup, teardown)
{
    Error err = {0};
    char place[PLACE_SIZE], path[PLACE_SIZE + 16];
    place_make(place);
    snprintf(path, sizeof path, "%s/history.h5", place);
    ArrayFile *file = array_file_create(path, &err);
    assert_true(file && array_file_set_number(file, "format", 3, &err));
    assert_true(array_file_close(file, &err));
    assert_null(result_file_open(place, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "later version"));
    place_remove(place);
}
