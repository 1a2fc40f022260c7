// SPDX-License-Identifier: GPL-2.0-or-later
// `--compare` reads the files that are written here, so that one run may be drawn beside another.
#include "render/figure_data.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/hdf5/result_tables.h"
#include "io/text/csv_writer.h"
#include "render/events_table.h"
#include "render/figures/color_scale.h"
#include "render/figures/figures.h"
#include "render/figures/figure_pads.h"
#include "render/figures/probe_data.h"
#include "render/figures/figure_profile.h"
#include "render/view/zoom.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 6, OF_STATE = 3, NAME_SIZE = 100 };

// Names may say " (m)" where the result is in SI.
typedef struct DataColumn {
    const char *name, *unit;   // unit: of SI; NULL: none
    const double *values;
    double factor;
} DataColumn;

static bool write_columns(const char *path, const DataColumn *columns, int32_t count, int64_t rows,
                          bool si, Error *err)
{
    CsvWriter *csv = csv_create(path, err);
    char name[NAME_SIZE + 20];
    if (!csv) return false;
    for (int32_t k = 0; k < count; ++k) {
        bool has_unit = si && columns[k].unit;
        snprintf(name, sizeof name, has_unit ? "%s (%s)" : "%s", columns[k].name, columns[k].unit);
        csv_text(csv, name);
    }
    csv_end_row(csv);
    for (int64_t row = 0; row < rows; ++row) {
        for (int32_t k = 0; k < count; ++k)
            csv_rounded(csv, columns[k].values[row] * columns[k].factor);
        csv_end_row(csv);
    }
    return csv_finish(csv, err);
}

static bool write_curve(const char *path, ResultView *view, MeasuredKind kind, Error *err)
{
    ViewCurve curve;
    if (!computed_curve(view, kind, &curve, err)) return false;
    const DataColumn columns[MEASURED_KINDS][3] = {
        [MEASURED_MU] = {{"U", "m", curve.at, 1},
                         {"t", "s", view->t, 1},
                         {"F_T/F_N", NULL, curve.value, 1}},
        [MEASURED_FRONT] = {{"U", "m", curve.at, 1},
                            {"t", "s", view->t, 1},
                            {"x", "m", curve.value, 1}},
    };
    return write_columns(path, columns[kind], 3, curve.count, view->si, err);
}

static void write_length(CsvWriter *csv, double mu, double part, int32_t cycle, const char *event)
{
    csv_rounded(csv, mu);
    csv_rounded(csv, part);
    csv_number(csv, cycle);
    csv_text(csv, event);
    csv_end_row(csv);
}

// Loads and lengths of the events of each cycle that is shown, then the farthest slip so far.
static bool write_lengths(const char *path, ResultView *view, Error *err)
{
    static const char *const names[] = {"F_T/F_N", "l/L", "cycle", "event"};
    int32_t asked = view->cycle, first = 0, last = 0;
    double L = view->number[NUMBER_LENGTH];
    CsvWriter *csv = csv_create(path, err);
    if (!csv) return false;
    for (int32_t c = 0; c < 4; ++c) csv_text(csv, names[c]);
    csv_end_row(csv);
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        ViewCurve curve;
        computed_choose_cycle(view, k);
        TRY(computed_curve(view, MEASURED_LENGTH, &curve, err));
        int32_t cycle = zoom_choose(view).cycle;
        for (int32_t i = 0; i < view->event_count; ++i) {
            double mu = NAN, length = NAN;
            if (computed_event(view, &view->events[i], &mu, &length))
                write_length(csv, mu, length / L, cycle, view_event_word(&view->events[i]));
        }
        for (int64_t i = 0; i < curve.count; ++i)
            write_length(csv, curve.at[i], curve.value[i] / L, cycle, MEASURED_FARTHEST);
    }
    CsvWriter *whole = csv;
    csv = NULL;
    TRY(csv_finish(whole, err));
cleanup:
    csv_abandon(csv);
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

// Speeds of the fronts of the events of each cycle that is shown, below 0 towards the trailing end.
// U, where the rod was when it began, says which row of events.csv an event is.
static bool write_speeds(const char *path, ResultView *view, Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    ViewCurve curve = {0};
    CsvWriter *csv = csv_create(path, err);
    if (!csv) return false;
    const char *const names[] = {"x/L", "v/c_R", "cycle", "event", view->si ? "U (m)" : "U"};
    for (int32_t c = 0; c < 5; ++c) csv_text(csv, names[c]);
    csv_end_row(csv);
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        computed_choose_cycle(view, k);
        Zoom zoom = zoom_choose(view);
        for (int32_t e = 0; e < view->event_count; ++e) {
            const ViewEvent *event = &view->events[e];
            if (!view_event_counts(event) || !zoom_covers(&zoom, event->U_start)) continue;
            TRY(computed_front_speed(view, event, &curve, err));
            for (int64_t i = 0; i < curve.count; ++i) {
                csv_rounded(csv, curve.at[i] / view->number[NUMBER_LENGTH]);
                csv_rounded(csv, curve.value[i] / view->number[NUMBER_C_RAYLEIGH]);
                csv_number(csv, zoom.cycle);
                csv_text(csv, view_event_word(event));
                csv_rounded(csv, event->U_start);
                csv_end_row(csv);
            }
            memory_free_all(curve.at, curve.value);
            curve = (ViewCurve){0};
        }
    }
    CsvWriter *whole = csv;
    csv = NULL;
    TRY(csv_finish(whole, err));
cleanup:
    csv_abandon(csv);
    memory_free_all(curve.at, curve.value);
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

// Least, median and largest over the nodes, of the state that the view stands for.
static bool state_columns(ResultView *view, double *columns[OF_STATE], Error *err)
{
    double *states = NULL;
    TRY(result_view_read(view, SERIES_STATE, false, &states, err));
    for (int32_t k = 0; k < OF_STATE; ++k) TRY(columns[k] = NEW_ARRAY(double, view->rows, err));
    for (int64_t row = 0; row < view->rows; ++row) {
        double *own = states + row * view->nodes;
        qsort(own, (size_t)view->nodes, sizeof *own, order_doubles);
        for (int32_t k = 0; k < OF_STATE; ++k)
            columns[k][row] = own[k * (view->nodes - 1) / (OF_STATE - 1)];
    }
cleanup:
    memory_free(states);
    return error_is_clean(err);
}

// Least, mean and largest of the contact area over the nodes that are shown.
static bool write_area(const char *path, ResultView *view, Error *err)
{
    double *columns[OF_STATE] = {0};
    TRY(computed_area_read(view, err));
    TRY(result_view_read_status(view, err));
    for (int32_t k = 0; k < OF_STATE; ++k) TRY(columns[k] = NEW_ARRAY(double, view->rows, err));
    for (int64_t row = 0; row < view->rows; ++row) {
        double least = INFINITY, sum = 0, most = -INFINITY;
        for (int64_t k = row * view->nodes; k < (row + 1) * view->nodes; ++k) {
            double value = view->status[k] == STATUS_OPEN ? 0 : view->area[k];
            least = fmin(least, value);
            most = fmax(most, value);
            sum += value;
        }
        columns[0][row] = least;
        columns[1][row] = sum / view->nodes;
        columns[2][row] = most;
    }
    const DataColumn data[] = {{"U", "m", view->U, 1},
                               {"t", "s", view->t, 1},
                               {"least area", NULL, columns[0], 1},
                               {"mean area", NULL, columns[1], 1},
                               {"largest area", NULL, columns[2], 1}};
    TRY(write_columns(path, data, 5, view->rows, view->si, err));
cleanup:
    memory_free_list((void *const *)columns, OF_STATE);
    return error_is_clean(err);
}

static bool write_states(const char *path, ResultView *view, Error *err)
{
    static const char *const what[OF_STATE] = {"least", "median", "largest"};
    int32_t count = 2;
    DataColumn *columns = NEW_ARRAY(DataColumn, 2 + OF_STATE * view->states, err);
    char(*names)[VIEW_STATE_SIZE + 12] = memory_array(OF_STATE * view->states, sizeof *names, err);
    double **values = NEW_ARRAY(double *, OF_STATE * view->states, err);
    TRY(columns && names && values);
    columns[0] = (DataColumn){"U", "m", view->U, 1};
    columns[1] = (DataColumn){"t", "s", view->t, 1};
    for (view->state = 0; view->state < view->states; ++view->state) {
        char name[VIEW_STATE_SIZE];
        ValueWords words = state_words(view, name);
        TRY(state_columns(view, values + OF_STATE * view->state, err));
        for (int32_t k = 0; k < OF_STATE; ++k, ++count) {
            snprintf(names[count - 2], sizeof *names, "%s %s", what[k], name);
            columns[count] =
                (DataColumn){names[count - 2], words.si[0] ? words.si : NULL, values[count - 2], 1};
        }
    }
    TRY(write_columns(path, columns, count, view->rows, view->si, err));
cleanup:
    view->state = 0;
    for (int32_t k = 0; values && k < OF_STATE * view->states; ++k) memory_free(values[k]);
    memory_free_all(columns, names, values);
    return error_is_clean(err);
}

// The name of a probe's column, with its unit where the result is in SI.
static void csv_probe_column(CsvWriter *csv, const ResultView *view, int32_t probe,
                             ProbeQuantity quantity, int32_t c)
{
    char name[PROBE_COLUMN_SIZE], text[PROBE_COLUMN_SIZE + 20];
    const char *unit = view->si ? probe_words(quantity).si : "";
    probe_column(view, probe, quantity, c, name);
    snprintf(text, sizeof text, *unit ? "%s (%s)" : "%s", name, unit);
    csv_text(csv, text);
}

// U, t, then each component of each quantity of each probe: "gauge1 strain_xx".
static bool write_probes(const char *path, ResultView *view, Error *err)
{
    CsvWriter *csv = NULL;
    double *values[PROBE_QUANTITY_COUNT] = {0};
    for (int32_t q = 0; q < PROBE_QUANTITY_COUNT; ++q)
        TRY(probe_read(view, (ProbeQuantity)q, &values[q], err));
    TRY(csv = csv_create(path, err));
    csv_text(csv, view->si ? "U (m)" : "U");
    csv_text(csv, view->si ? "t (s)" : "t");
    for (int32_t k = 0; k < view->probes; ++k)
        for (int32_t q = 0; q < PROBE_QUANTITY_COUNT; ++q)
            for (int32_t c = 0; c < probe_components(view, (ProbeQuantity)q); ++c)
                csv_probe_column(csv, view, k, (ProbeQuantity)q, c);
    csv_end_row(csv);
    for (int64_t row = 0; row < view->rows; ++row) {
        csv_rounded(csv, view->U[row]);
        csv_rounded(csv, view->t[row]);
        for (int32_t k = 0; k < view->probes; ++k)
            for (int32_t q = 0; q < PROBE_QUANTITY_COUNT; ++q) {
                int32_t components = probe_components(view, (ProbeQuantity)q);
                const double *at = values[q] + (row * view->probes + k) * components;
                for (int32_t c = 0; c < components; ++c) csv_rounded(csv, at[c]);
            }
        csv_end_row(csv);
    }
    TRY(csv_finish(csv, err));
cleanup:
    memory_free_list((void *const *)values, PROBE_QUANTITY_COUNT);
    return error_is_clean(err);
}

// A row for each node at each moment.
static bool write_profiles(const char *path, ResultView *view, const char *at, Error *err)
{
    enum { COLUMNS = 4 + PROFILE_QUANTITIES + 1 };
    static const char *const names[2][COLUMNS] = {
        {"U", "t", "F_T/F_N", "x", "p", "tau", "tau/p", "slip", "A/A_0", "gap", "status"},
        {"U (m)", "t (s)", "F_T/F_N", "x (m)", "p (Pa)", "tau (Pa)", "tau/p", "slip (m)", "A/A_0",
         "gap (m)", "status"}};
    Profiles profiles;
    CsvWriter *csv = NULL;
    TRY(profiles_read(view, at, &profiles, err));
    TRY(csv = csv_create(path, err));
    for (int32_t c = 0; c < COLUMNS; ++c) csv_text(csv, names[view->si][c]);
    csv_end_row(csv);
    for (int32_t k = 0; k < profiles.count; ++k)
        for (int32_t i = 0; i < profiles.nodes; ++i) {
            int64_t row = profiles.row[k], at_node = (int64_t)k * profiles.nodes + i;
            csv_rounded(csv, view->U[row]);
            csv_rounded(csv, view->t[row]);
            csv_rounded(csv, view->mu[row]);
            csv_rounded(csv, view->x[i]);
            for (int32_t q = 0; q < PROFILE_QUANTITIES; ++q)
                csv_rounded(csv, profiles.values[q] ? profiles.values[q][at_node] : NAN);
            csv_rounded(csv, profiles.status[at_node]);
            csv_end_row(csv);
        }
    TRY(csv_finish(csv, err));
cleanup:
    profiles_destroy(&profiles);
    return error_is_clean(err);
}

// A row for each pad in each cycle.
static bool write_pads(const char *path, ResultView *view, Error *err)
{
    static const char *const names[2][6] = {
        {"cycle", "pad", "order", "U first slip", "U let go", "F_T/F_N let go"},
        {"cycle", "pad", "order", "U first slip (m)", "U let go (m)", "F_T/F_N let go"}};
    PadCourses courses;
    CsvWriter *csv = NULL;
    TRY(pad_courses_read(view, &courses, err));
    TRY(csv = csv_create(path, err));
    for (int32_t c = 0; c < 6; ++c) csv_text(csv, names[view->si][c]);
    csv_end_row(csv);
    for (int32_t k = 0; k < courses.count; ++k) {
        const PadCourse *course = &courses.list[k];
        char words[PAD_WORDS_SIZE];
        pad_words(view, course->pad, words);
        csv_number(csv, course->cycle);
        csv_text(csv, words);
        csv_number(csv, course->order);
        csv_rounded(csv, course->U_first_slip);
        csv_rounded(csv, course->U_let_go);
        csv_rounded(csv, course->mu_let_go);
        csv_end_row(csv);
    }
    TRY(csv_finish(csv, err));
cleanup:
    pad_courses_destroy(&courses);
    return error_is_clean(err);
}

// The figure that shows what is measured; a measured area stands on that of the law's own measure,
// where it has one.
static const char *figure_of(MeasuredKind kind, const ResultView *view)
{
    static const char *const figures[MEASURED_KINDS] = {
        "force", "slip-map", "contact-density", "precursors", "front-speed", "probes"};
    return kind == MEASURED_AREA && figure_contact_area_shows(view) ? "contact-area"
                                                                    : figures[kind];
}

// MEASURED_KINDS: nothing of the figure is measured.
static MeasuredKind kind_of(const char *figure, const ResultView *view)
{
    int32_t kind = 0;
    while (kind < MEASURED_KINDS && strcmp(figure_of((MeasuredKind)kind, view), figure) != 0)
        ++kind;
    return (MeasuredKind)kind;
}

static bool data_path(const char *folder, const char *name, const char *end, char path[PATH_MAX],
                      Error *err)
{
    if (snprintf(path, PATH_MAX, "%s/figures/%s%s.csv", folder, name, end) >= PATH_MAX)
        return REFUSE(err, "the result folder's path is too long");
    return true;
}

// Each point with what was computed there, in the result's own units.
static bool write_compared(const char *path, const Measured *measured, bool si, Error *err)
{
    static const struct {
        const char *at, *at_unit, *value, *unit;
    } kinds[MEASURED_KINDS] = {{"U", "m", "F_T/F_N", NULL},
                               {"U", "m", "x", "m"},
                               {"U", "m", "A/A_0", NULL},
                               {"F_T/F_N", NULL, "l", "m"},
                               {"x", "m", "v", "m/s"}};
    DataColumn columns[COLUMNS_MAX];
    int32_t count = 0, kind = (int32_t)measured->kind;
    const char *unit = kinds[kind].unit;
    columns[count++] = (DataColumn){kinds[kind].at, kinds[kind].at_unit, measured->at, 1};
    if (kind == MEASURED_AREA) columns[count++] = (DataColumn){"x", "m", measured->x, 1};
    columns[count++] = (DataColumn){kinds[kind].value, unit, measured->value, 1};
    columns[count++] = (DataColumn){"error", unit, measured->error, 1};
    columns[count++] = (DataColumn){"computed", unit, measured->computed, 1};
    if (measured->matched)
        columns[count++] = (DataColumn){"computed F_T/F_N", NULL, measured->x, 1};
    return write_columns(path, columns, count, measured->count, si, err);
}

// The same of probes, with the name of the column that each point stands in.
static bool write_compared_probes(const char *path, const Measured *measured,
                                  const ResultView *view, Error *err)
{
    CsvWriter *csv = csv_create(path, err);
    if (!csv) return false;
    const char *const names[] = {view->si ? "U (m)" : "U", "column", "value", "error", "computed"};
    for (int32_t k = 0; k < 5; ++k) csv_text(csv, names[k]);
    csv_end_row(csv);
    for (int32_t k = 0; k < measured->count; ++k) {
        int32_t id = (int32_t)measured->x[k];
        csv_rounded(csv, measured->at[k]);
        csv_probe_column(csv, view, id / PROBE_COMPONENTS_MAX, measured->quantity,
                         id % PROBE_COMPONENTS_MAX);
        csv_rounded(csv, measured->value[k]);
        csv_rounded(csv, measured->error[k]);
        csv_rounded(csv, measured->computed[k]);
        csv_end_row(csv);
    }
    return csv_finish(csv, err);
}

bool figure_data_write(const char *folder, const char *name, ResultView *view,
                       const FieldChoice *field, const char *compare, Error *err)
{
    MeasuredKind kind = kind_of(name, view);
    bool done = true;
    Measured measured = {0};
    char path[PATH_MAX];
    if (strcmp(name, "force") == 0 &&
        !(data_path(folder, "events", "", path, err) && events_table_write(path, view, err)))
        return false;
    if (!data_path(folder, name, "", path, err)) return false;
    if (strcmp(name, "contact-area") == 0 && !write_area(path, view, err)) return false;
    if (strcmp(name, "state-map") == 0) return write_states(path, view, err);
    if (kind == MEASURED_PROBE && !write_probes(path, view, err)) return false;
    if (strcmp(name, "pads") == 0) return write_pads(path, view, err);
    if (strcmp(name, "profile") == 0) return write_profiles(path, view, field->at, err);
    if (kind == MEASURED_KINDS) return true;
    if (kind == MEASURED_LENGTH && !write_lengths(path, view, err)) return false;
    if (kind == MEASURED_SPEED && !write_speeds(path, view, err)) return false;
    bool curve = kind == MEASURED_MU || kind == MEASURED_FRONT;
    if (curve && !write_curve(path, view, kind, err)) return false;
    if (!measured_read(compare, kind, view, &measured, err)) return false;
    if (measured.count > 0)
        done = data_path(folder, name, "-compared", path, err) &&
               (kind == MEASURED_PROBE ? write_compared_probes(path, &measured, view, err)
                                       : write_compared(path, &measured, view->si, err));
    measured_destroy(&measured);
    return done;
}

bool figure_data_misfits(const char *folder, ResultView *view, const char *compare, Error *err)
{
    static const char *const units[MEASURED_KINDS] = {"", "L", "", "L", "c_R", ""};
    char path[PATH_MAX];
    Measured measured = {0};
    CsvWriter *csv = NULL;
    TRY(data_path(folder, "misfit", "", path, err));
    TRY(csv = csv_create(path, err));
    csv_text(csv, "figure");
    csv_text(csv, "points");
    csv_text(csv, "covered");
    csv_text(csv, "misfit");
    csv_text(csv, "over");
    csv_text(csv, "misfit over errors");
    csv_end_row(csv);
    for (int32_t kind = 0; kind < MEASURED_KINDS; ++kind) {
        TRY(measured_read(compare, (MeasuredKind)kind, view, &measured, err));
        if (measured.count > 0) {
            const char *unit = kind == MEASURED_PROBE ? probe_words(measured.quantity).si
                                                      : units[kind];
            csv_text(csv, figure_of((MeasuredKind)kind, view));
            csv_number(csv, measured.count);
            csv_number(csv, measured.compared);
            csv_number(csv, measured.compared > 0 ? measured.misfit : NAN);
            csv_text(csv, kind == MEASURED_PROBE && !view->si ? "" : unit);
            csv_number(csv, measured.compared > 0 ? measured.in_errors : NAN);
            csv_end_row(csv);
        }
        measured_destroy(&measured);
    }
    CsvWriter *whole = csv;
    csv = NULL;
    TRY(csv_finish(whole, err));
cleanup:
    csv_abandon(csv);
    measured_destroy(&measured);
    return error_is_clean(err);
}

bool figure_data_measured(const char *name, const char *compare, ResultView *view, bool *shows,
                          Error *err)
{
    MeasuredKind kind = kind_of(name, view);
    *shows = false;
    return kind == MEASURED_KINDS || !compare || measured_has(compare, kind, view, shows, err);
}
