// SPDX-License-Identifier: GPL-2.0-or-later
// Records are read back by io/hdf5/result_file, value by value, with events and peaks.
#include "record/history.h"

#include "base/memory.h"
#include "io/files/own_list.h"
#include "plane.h"
#include "result_place.h"
#include "seen_by_hand.h"

enum { STEPS = 40 };

static HandSeen hand;
static const FrictionLaw LAW = {.mu_static = 0.4, .mu_kinetic = 0.1, .critical_velocity = 1};
static const Friction FRICTION = {.whole = {.law = &LAW, .factor = 1}};

// Step k has numbers of its own everywhere.
static void show(int32_t k)
{
    double rate[SEEN_NODES];
    for (int32_t i = 0; i < SEEN_NODES; i++) rate[i] = 0.1 * k - 0.25 * i;
    hand_seen(&hand, 0.5 * k, rate);
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        hand.displacement[plane_normal(i)] = 0.02 * (i + 1);
        hand.displacement[plane_tangent(i)] = 7 + 3 * k + 0.5 * i;
        hand.reaction[plane_normal(i)] = 2 + k + i;
        hand.reaction[plane_tangent(i)] = k - 10 * i;
    }
    if (k % 7 == 3) hand.status[4] = CONTACT_OPEN;
    hand.seen.mu = 0.01 * k;
    hand.seen.rod_force = 1.5 * k;
    hand.seen.normal_force = 2.5 * k;
    hand.seen.step_size = 0.125 * k;
    hand.seen.certified = k % 3 == 0;
    hand.seen.energy_imbalance = 1e-9 * k;
}

// Sums of what `wanted` says of the nodes: pad 0 is nodes 0 to 2, pad 1 nodes 3 and 4.
static double wanted(ResultSeries series, int32_t k, int32_t i);
static double wanted_of_pad(ResultSeries series, int32_t k, int32_t p)
{
    int32_t from = p == 0 ? 0 : 3, to = p == 0 ? 3 : SEEN_NODES;
    double sum = 0, length = 0;
    for (int32_t i = from; i < to; i++) {
        double weight = hand.weight[i];
        length += weight;
        if (series == SERIES_PAD_NORMAL) sum += weight * wanted(SERIES_PRESSURE, k, i);
        if (series == SERIES_PAD_SHEAR) sum += weight * wanted(SERIES_SHEAR, k, i);
        if (series == SERIES_PAD_SLIP) sum += weight * wanted(SERIES_SLIP, k, i);
        if (series == SERIES_PAD_SLIPPING && wanted(SERIES_STATUS, k, i) >= 2) sum += weight;
    }
    return series == SERIES_PAD_SLIP ? sum / length : sum;
}

static double wanted(ResultSeries series, int32_t k, int32_t i)
{
    double rate = 0.1 * k - 0.25 * i;
    bool open = k % 7 == 3 && i == 4;
    switch (series) {
    case SERIES_TIME:
        return 0.5 * k;
    case SERIES_ROD:
        return 0.05 * k;
    case SERIES_ROD_WAY:
        return 0.03 * k;
    case SERIES_MU:
        return 0.01 * k;
    case SERIES_ROD_FORCE:
        return 1.5 * k;
    case SERIES_NORMAL_FORCE:
        return 2.5 * k;
    case SERIES_STEP:
        return 0.125 * k;
    case SERIES_FRONT:
        return hand.seen.front;
    case SERIES_MAX_SLIP_RATE:
        return fmax(fabs(0.1 * k), fabs(0.1 * k - 1));
    case SERIES_CERTIFIED:
        return k % 3 == 0;
    case SERIES_ENERGY_ERROR:
        return 1e-9 * k;
    case SERIES_SLIP_RATE:
        return rate;
    case SERIES_SLIP:
        return 3 * k;
    case SERIES_PRESSURE:
        return (2 + k + i) / hand.weight[i];
    case SERIES_SHEAR:
        return (10 * i - k) / hand.weight[i];
    case SERIES_GAP:   // of what touches its displacement is rounding and counts as none
        return open ? 0.02 * (i + 1) : 0;
    case SERIES_STATUS:
        return open ? 0 : (rate == 0 ? 1 : (fabs(rate) < 1 ? 2 : 3));
    default:
        return NAN;
    }
}

static void two_pads(void)
{
    hand.pad[3] = hand.pad[4] = 1;
    hand.interface.pad_count = 2;
}

static ResultHead head_of(const char *title)
{
    ResultHead head = {
        .title = title, .units = "normalised", .version = "test", .rod_on_spring = true};
    for (int32_t k = 0; k < RESULT_NUMBERS_COUNT; k++) head.numbers[k] = 100 + k;
    head.numbers[NUMBER_MU_M] = head.numbers[NUMBER_L_C] = NAN;
    return head;
}

static void check_series(ArrayFile *file)
{
    Error err = {0};
    for (ResultSeries series = 0; series < RESULT_SERIES_COUNT; series++) {
        ResultHead head = head_of("");   // LAW remembers nothing; in the plane nothing is across
        if (!result_series_written(&head, series)) continue;
        double *values = NULL;
        int64_t rows = 0;
        int32_t width = 0;
        assert_true(result_file_read_series(file, series, &values, &rows, &width, &err));
        assert_int_equal(rows, STEPS);
        ResultColumns columns = result_series_columns(series);
        bool of_pads = columns == COLUMNS_PADS;
        assert_int_equal(width, of_pads ? 2 : columns == COLUMNS_NODES ? SEEN_NODES : 1);
        for (int32_t k = 0; k < STEPS; k++) {
            show(k);
            for (int32_t i = 0; i < width; i++) {
                double value = of_pads ? wanted_of_pad(series, k, i) : wanted(series, k, i);
                assert_near(result_series_name(series), values[k * width + i], value,
                            1e-6 * fabs(value) + 1e-12);
            }
        }
        memory_free(values);
    }
}

static void check_table(ArrayFile *file, ResultTable table, int32_t count, const double *column)
{
    Error err = {0};
    double *values = NULL;
    int32_t rows = 0;
    assert_true(result_file_read_table(file, table, &values, &rows, &err));
    assert_int_equal(rows, count);
    for (int32_t k = 0; k < count; k++) {
        if (isnan(column[k]))
            assert_true(isnan(values[k]));
        else
            assert_near(result_table_name(table), values[k], column[k], 0);
    }
    memory_free(values);
}

static void record_steps(ContactArrays *contact, History *history)
{
    Error err = {0};
    for (int32_t k = 0; k < STEPS; k++) {
        show(k);
        assert_true(contact_arrays_record(contact, &hand.seen, &err));
        assert_true(history_record(history, &hand.seen, &err));
    }
}

TEST(test_written_and_read_back)
{
    Error err = {0};
    char place[PLACE_SIZE];
    place_make(place);
    int64_t live = memory_counters().live;
    hand_seen_init(&hand);
    two_pads();
    ResultHead head = head_of("made up");
    head.pads = "left\nright";
    History history;
    ContactArrays contact;
    assert_true(contact_arrays_create(&hand.interface, &FRICTION, &contact, &err));
    assert_true(history_create(place, &head, &hand.interface, &contact, &history, &err));
    record_steps(&contact, &history);
    assert_int_equal(history.end.rows, STEPS);
    assert_false(place_has(place, "history.h5"));   // not before it is whole
    Event event_list[] = {{.kind = EVENT_LEADING,
                           .U_start = 1,
                           .U_stop = 2,
                           .t_start = 3,
                           .t_stop = 4,
                           .reach = 5,
                           .peak_slip_rate = 6,
                           .front_speed = 7},
                          {.kind = EVENT_QUASI_STATIC, .U_start = 11, .front_speed = NAN},
                          {0},
                          {0}};
    // Peaks are the bulk slidings alone: 0.5 was reached before the load drop that is none.
    Drop drop_list[] = {{.U = 0.1, .mu = 0.2, .bulk = true, .load = true},
                        {.U = 0.3, .mu = 0.4, .bulk = true, .load = true},
                        {.U = 0.5, .mu = 0.6, .load = true},
                        {.U = 0.7, .mu = 0.5, .bulk = true, .load = true}};
    Events events = {.list = event_list, .count = 4};
    Drops drops = {.events = &events, .list = drop_list, .count = 4};
    assert_true(history_finish(&history, &drops, 1, 0.5, NAN, &err));
    history_destroy(&history);
    contact_arrays_destroy(&contact);
    assert_int_equal(memory_counters().live, live);
    assert_true(place_has(place, "history.h5") && !place_has(place, "history.h5.part"));

    ArrayFile *file = result_file_open(place, &err);
    assert_non_null(file);
    check_series(file);
    check_table(file, PEAKS_U, 3, (double[]){0.1, 0.3, 0.5});
    check_table(file, PEAKS_MU, 3, (double[]){0.2, 0.4, 0.6});
    check_table(file, PEAKS_COUNTS, 3, (double[]){0, 1, 1});
    check_table(file, EVENTS_KIND, 4, (double[]){2, 0, 0, 0});
    check_table(file, EVENTS_U_START, 4, (double[]){1, 11, 0, 0});
    check_table(file, EVENTS_U_STOP, 4, (double[]){2, 0, 0, 0});
    check_table(file, EVENTS_T_START, 4, (double[]){3, 0, 0, 0});
    check_table(file, EVENTS_T_STOP, 4, (double[]){4, 0, 0, 0});
    check_table(file, EVENTS_REACH, 4, (double[]){5, 0, 0, 0});
    check_table(file, EVENTS_PEAK_RATE, 4, (double[]){6, 0, 0, 0});
    check_table(file, EVENTS_FRONT_SPEED, 4, (double[]){7, NAN, 0, 0});
    double *pads = NULL;
    int32_t count = 0;
    assert_true(result_file_read_nodes(file, NODES_PAD, &pads, &count, &err));
    assert_true(count == SEEN_NODES && pads[2] == 0 && pads[3] == 1);
    memory_free(pads);
    assert_near("mu_M", result_file_number(file, NUMBER_MU_M), 0.5, 0);
    assert_true(isnan(result_file_number(file, NUMBER_L_C)));
    assert_near("load", result_file_number(file, NUMBER_LOAD), 100 + NUMBER_LOAD, 0);
    char title[64];
    assert_true(result_file_text(file, "title", title, sizeof title, &err));
    assert_string_equal(title, "made up");
    assert_true(result_file_text(file, "pads", title, sizeof title, &err));
    assert_string_equal(title, "left\nright");
    assert_true(array_file_close(file, &err));
    place_remove(place);
}

// A history that is given up leaves what it had, under the name of an unfinished file.
TEST(test_abandoned)
{
    Error err = {0};
    char place[PLACE_SIZE];
    place_make(place);
    hand_seen_init(&hand);
    two_pads();
    ResultHead head = head_of("given up");
    History history;
    ContactArrays contact;
    assert_true(contact_arrays_create(&hand.interface, &FRICTION, &contact, &err));
    assert_true(history_create(place, &head, &hand.interface, &contact, &history, &err));
    record_steps(&contact, &history);
    history_destroy(&history);
    contact_arrays_destroy(&contact);
    assert_false(place_has(place, "history.h5"));
    ArrayFile *file = result_file_open(place, &err);
    assert_non_null(file);
    check_series(file);
    check_table(file, PEAKS_MU, 0, NULL);
    assert_true(array_file_close(file, &err));
    place_remove(place);
}

TEST(test_memory_faults)
{
    char place[PLACE_SIZE];
    place_make(place);
    assert_true(own_list_make(place, &(Error){0}));
    hand_seen_init(&hand);
    two_pads();
    show(1);
    int64_t live = memory_counters().live;
    bool done = false;
    Events events = {0};
    Drops drops = {.events = &events};
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        ResultHead head = head_of("faults");
        History history = {0};
        ContactArrays contact;
        memory_fail_after(k);
        done = contact_arrays_create(&hand.interface, &FRICTION, &contact, &err) &&
               contact_arrays_record(&contact, &hand.seen, &err) &&
               history_create(place, &head, &hand.interface, &contact, &history, &err) &&
               history_record(&history, &hand.seen, &err) &&
               history_finish(&history, &drops, 0, NAN, NAN, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        history_destroy(&history);
        contact_arrays_destroy(&contact);
        assert_int_equal(memory_counters().live, live);
        assert_int_equal(place_has(place, "history.h5"), done);
    }
    place_remove(place);
}
