// SPDX-License-Identifier: GPL-2.0-or-later
// Arrays are checked here once, when they are read; the figures trust them.
#include "render/view/result_view.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNITS_SIZE = 32, LINES_SIZE = 1 << 16 };   // bytes

static const double LINE_ROUNDING = 1e-6;   // of places along the contact, over a mean cell

// One value a row; `rows` shrinks to the shortest series: a killed run may have flushed some only.
static bool scalar_read(ResultView *view, ResultSeries series, double **values, Error *err)
{
    int64_t rows = 0;
    int32_t width = 0;
    if (!result_file_read_series(view->file, series, values, &rows, &width, err)) return false;
    if (width != 1)
        return FAULT(err, ERROR_FILE, "%s has %d columns, not 1", result_series_name(series),
                     width);
    if (rows < view->rows) view->rows = rows;
    return true;
}

int64_t curve_place(const double *values, int64_t count, double at)
{
    int64_t low = 0, high = count - 1;
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        if (values[middle] <= at)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double curve_value(const ViewCurve *curve, double at)
{
    if (curve->count < 2 || !(at >= curve->at[0] && at <= curve->at[curve->count - 1])) return NAN;
    int64_t k = curve_place(curve->at, curve->count, at);
    double span = curve->at[k + 1] - curve->at[k];
    double part = span > 0 ? (at - curve->at[k]) / span : 1;
    return curve->value[k] + part * (curve->value[k + 1] - curve->value[k]);
}

// 0 in results that do not say it, which are older.
double result_view_trailing_end(const ResultView *view)
{
    double x = view->number[NUMBER_TRAILING];
    return isfinite(x) ? x : 0;
}

void result_view_x_extent(const ResultView *view, double *low, double *high)
{
    double begin = result_view_trailing_end(view), length = view->number[NUMBER_LENGTH];
    double end = isfinite(length) && length > 0 ? begin + length : begin;
    *low = fmin(begin, view->x[0]);
    *high = fmax(end, view->x[view->nodes - 1]);
    if (!(*high > *low)) *high = *low + 1;   // one node at 0
}

void result_view_mu_range(const ResultView *view, const double U[2], double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int64_t row = 0; row < view->rows; ++row) {
        double mu = view->mu[row];
        if (!(view->U[row] >= U[0] && view->U[row] <= U[1]) || !isfinite(mu)) continue;
        range[0] = fmin(range[0], mu);
        range[1] = fmax(range[1], mu);
    }
}

int32_t result_view_pads(const ResultView *view)
{
    double last = 0;
    for (int32_t i = 0; i < view->nodes; ++i) last = fmax(last, view->pad[i]);
    return (int32_t)last + 1;
}

const char *result_view_name(const char *names, int32_t k, int *length)
{
    for (; names && k > 0; --k) {
        names = strchr(names, '\n');
        if (names) ++names;
    }
    *length = names ? (int)strcspn(names, "\n") : 0;
    return names;
}

void result_view_pad(const ResultView *view, int32_t pad, char name[PAD_NAME_SIZE])
{
    static const char common[] = "contact_";
    int length = 0, skip = sizeof common - 1;
    const char *start = result_view_name(view->pad_names, pad, &length);
    if (length == 0)
        snprintf(name, PAD_NAME_SIZE, "pad %d", pad + 1);
    else if (length > skip && strncmp(start, common, sizeof common - 1) == 0)
        snprintf(name, PAD_NAME_SIZE, "pad %.*s", length - skip, start + skip);
    else
        snprintf(name, PAD_NAME_SIZE, "%.*s", length, start);
}

int64_t result_view_nearest_row(const ResultView *view, const double *values, double value)
{
    int64_t nearest = 0;
    for (int64_t row = 1; row < view->rows; ++row)
        if (fabs(values[row] - value) < fabs(values[nearest] - value)) nearest = row;
    return nearest;
}

void result_view_event_rows(const ResultView *view, double start, double stop, int64_t *before,
                            int64_t *last)
{
    *before = *last = 0;
    for (int64_t row = 0; row < view->rows; ++row) {
        if (view->U[row] < start) *before = row;
        if (view->U[row] <= stop) *last = row;
    }
}

void result_view_range(const ResultView *view, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int64_t row = 0; row < view->rows; ++row) {
        if (!isfinite(view->U[row])) continue;
        *low = fmin(*low, view->U[row]);
        *high = fmax(*high, view->U[row]);
    }
}

// A picture needs two steps between which the rod has moved.
static bool range_check(const ResultView *view, Error *err)
{
    double low = 0, high = 0;
    if (view->rows < 2)
        return REFUSE(err, "the history holds %lld step%s: a picture needs two at least",
                      (long long)view->rows, view->rows == 1 ? "" : "s");
    result_view_range(view, &low, &high);
    if (!(high > low))
        return REFUSE(err, "the rod does not move in this history: pictures are drawn against "
                           "its displacement U");
    return true;
}

enum { SLIP_COMPONENTS = 2 };   // in space

bool result_view_read(ResultView *view, ResultSeries series, bool whole, double **values,
                      Error *err)
{
    int64_t rows = 0;
    int32_t width = 0, nodes = view->all_nodes;
    if (series == SERIES_STATE && view->states == 0)
        return REFUSE(err, "the friction of this result remembers nothing: there is no state");
    TRY(result_file_read_series(view->file, series, values, &rows, &width, err));
    int32_t components = series == SERIES_STATE         ? view->states
                         : view->line && width != nodes ? SLIP_COMPONENTS
                                                        : 1;
    if (width != (int64_t)components * nodes)
        FAIL(err, ERROR_FILE, "%s has %d columns, but there are %d contact nodes",
             result_series_name(series), width, nodes);
    if (rows < view->rows) view->rows = rows;   // a killed run may have flushed some series only

    // One of several states stays, in place; of a vector its size, of slip its component along the
    // drive.
    for (int64_t k = 0; components > 1 && k < rows * nodes; ++k) {
        const double *all = *values + components * k;
        (*values)[k] = series == SERIES_STATE  ? all[view->state]
                       : series == SERIES_SLIP ? all[0]
                                               : hypot(all[0], all[1]);
    }
    for (int64_t row = 0; view->line && !whole && row < view->rows; ++row)
        for (int32_t k = 0; k < view->nodes; ++k)
            (*values)[row * view->nodes + k] = (*values)[row * nodes + view->line[k]];
    TRY(range_check(view, err));
cleanup:
    if (!error_is_clean(err)) {
        memory_free(*values);
        *values = NULL;
    }
    return error_is_clean(err);
}

bool result_view_read_at(ResultView *view, ResultSeries series, bool whole, const int64_t *rows,
                         int32_t count, double **values, Error *err)
{
    double *all = NULL;
    int32_t nodes = whole ? view->all_nodes : view->nodes;
    TRY(result_view_read(view, series, whole, &all, err));
    TRY(*values = NEW_ARRAY(double, (int64_t)count *nodes, err));
    for (int32_t k = 0; k < count; ++k) {
        if (rows[k] >= view->rows)
            FAIL(err, ERROR_FILE, "%s has %lld rows only", result_series_name(series),
                 (long long)view->rows);
        memcpy(*values + (int64_t)k * nodes, all + rows[k] * nodes, (size_t)nodes * sizeof *all);
    }
cleanup:
    memory_free(all);
    return error_is_clean(err);
}

// A text of several lines; "" where the history has none: no error.
static bool lines_read(ResultView *view, const char *name, char **lines, Error *err)
{
    Error absent = {0};
    if (!(*lines = NEW_ARRAY(char, LINES_SIZE, err))) return false;
    if (!result_file_text(view->file, name, *lines, LINES_SIZE, &absent)) (*lines)[0] = '\0';
    return true;
}

// Columns of the file into a list of events; a kind that this version does not know becomes -1 and
// is drawn by nobody.
static bool events_read(ResultView *view, Error *err)
{
    static const ResultTable tables[4] = {EVENTS_KIND, EVENTS_U_START, EVENTS_U_STOP, EVENTS_REACH};
    double *column[4] = {0};
    int32_t count = 0;
    TRY(result_file_read_tables(view->file, tables, 4, column, &count, err));
    TRY(view->events = NEW_ARRAY(ViewEvent, count, err));
    for (int32_t k = 0; k < count; ++k) {
        double kind = column[0][k];
        bool known = kind >= 0 && kind < VIEW_EVENT_KINDS;
        view->events[k] =
            (ViewEvent){known ? (int32_t)kind : -1, column[1][k], column[2][k], column[3][k]};
    }
    view->event_count = count;
    TRY(view->rapid = memory_array(count, sizeof *view->rapid, err));
    for (int32_t k = 0; k < count; ++k) {
        const ViewEvent *event = &view->events[k];
        if (event->kind <= VIEW_QUASI_STATIC || !isfinite(event->U_start + event->U_stop)) continue;
        view->rapid[view->rapid_count][0] = event->U_start;
        view->rapid[view->rapid_count++][1] = event->U_stop;
    }
cleanup:
    memory_free_list((void *const *)column, 4);
    return error_is_clean(err);
}

void result_view_state_name(const ResultView *view, char name[VIEW_STATE_SIZE])
{
    const char *at = view->state_names;
    for (int32_t k = 0; k < view->state && *at; ++k) at += strcspn(at, "\n") + 1;
    snprintf(name, VIEW_STATE_SIZE, "%.*s", (int)strcspn(at, "\n"), at);
    if (!name[0]) snprintf(name, VIEW_STATE_SIZE, "state");
}

bool result_view_choose_state(ResultView *view, const char *name)
{
    char own[VIEW_STATE_SIZE];
    for (view->state = 0; view->state < view->states; ++view->state) {
        result_view_state_name(view, own);
        if (strcmp(own, name) == 0) return true;
    }
    view->state = 0;
    return view->states > 0 && strcmp(name, "state") == 0;
}

// Series of one number a step are read at once, those over the nodes on demand: they are the most
// of the file.
bool result_view_open(const char *folder, ResultView *view, Error *err)
{
    static const ResultTable tables[3] = {PEAKS_U, PEAKS_MU, PEAKS_COUNTS};
    double *of_line = NULL, *column[3] = {0};
    char units[UNITS_SIZE] = "";
    *view = (ResultView){.rows = INT64_MAX};
    TRY(view->file = result_file_open(folder, err));
    TRY(result_file_text(view->file, "units", units, sizeof units, err));
    view->si = strcmp(units, "si") == 0;
    TRY(scalar_read(view, SERIES_TIME, &view->t, err));
    TRY(scalar_read(view, SERIES_ROD, &view->U, err));
    TRY(scalar_read(view, SERIES_MU, &view->mu, err));
    TRY(range_check(view, err));

    // Positions and pads of the contact nodes.
    int32_t pads = 0;
    TRY(result_file_read_nodes(view->file, NODES_X, &view->x, &view->nodes, err));
    TRY(result_file_read_nodes(view->file, NODES_PAD, &view->pad, &pads, err));
    if (view->nodes < 1 || pads != view->nodes)
        FAIL(err, ERROR_FILE, "%d contact nodes with %d pad numbers", view->nodes, pads);
    view->all_nodes = view->nodes;

    // In space x and pads become those of the line; ascending x, as the nodes are.
    int32_t all = view->nodes, marks = 0;
    if (result_file_has_nodes(view->file, NODES_LINE)) {
        TRY(result_file_read_nodes(view->file, NODES_LINE, &of_line, &marks, err));
        if (marks != all)
            FAIL(err, ERROR_FILE, "%d contact nodes with %d marks of the line", all, marks);
        TRY(view->line = NEW_ARRAY(int32_t, all, err));
        view->nodes = 0;
        for (int32_t i = 0; i < all; ++i) {
            if (!(of_line[i] > 0)) continue;
            view->x[view->nodes] = view->x[i];
            view->pad[view->nodes] = view->pad[i];
            view->line[view->nodes++] = i;
        }
        if (view->nodes < 1) FAIL(err, ERROR_FILE, "no contact node is on the line");
    }

    TRY(lines_read(view, "title", &view->title, err));
    TRY(lines_read(view, "pads", &view->pad_names, err));
    TRY(lines_read(view, "warnings", &view->warnings, err));
    TRY(lines_read(view, "states", &view->state_names, err));
    TRY(lines_read(view, "state_unit", &view->state_unit, err));
    view->states =
        result_file_has_series(view->file, SERIES_STATE);   // older histories may not name them
    for (const char *at = view->state_names; view->states > 0 && *at; ++at)
        view->states += *at == '\n';
    TRY(lines_read(view, "probes", &view->probe_names, err));
    view->probes = view->probe_names[0] != 0;
    for (const char *at = view->probe_names; *at; ++at) view->probes += *at == '\n';
    TRY(events_read(view, err));
    TRY(result_file_read_tables(view->file, tables, 3, column, &view->peak_count, err));
    TRY(view->peaks = NEW_ARRAY(ViewPeak, view->peak_count, err));
    for (int32_t k = 0; k < view->peak_count; ++k)
        view->peaks[k] = (ViewPeak){column[0][k], column[1][k], column[2][k] > 0.5};
    for (int32_t k = 0; k < RESULT_NUMBERS_COUNT; ++k)
        view->number[k] = result_file_number(view->file, (ResultNumber)k);
cleanup:
    memory_free(of_line);
    memory_free_list((void *const *)column, 3);
    if (!error_is_clean(err)) {
        error_context(err, "while reading the result in %s", folder);
        result_view_close(view);
    }
    return error_is_clean(err);
}

bool result_view_read_slip_rate(ResultView *view, Error *err)
{
    return view->slip_rate ||
           result_view_read(view, SERIES_SLIP_RATE, false, &view->slip_rate, err);
}

// In space also those beside the line, where the history says what the contact is made of.
bool result_view_read_status(ResultView *view, Error *err)
{
    if (view->line && result_file_has_faces(view->file) && !result_view_read_plane(view, err))
        return false;
    return view->status || result_view_read(view, SERIES_STATUS, false, &view->status, err);
}

bool result_view_read_plane(ResultView *view, Error *err)
{
    if (!view->line)
        return REFUSE(err,
                      "the block is in the plane: slip-map and contact-density show its contact");
    return (view->plane.patch_count > 0 ||
            contact_plane_read(view->file, view->all_nodes, &view->plane, err)) &&
           (view->contact_status ||
            result_view_read(view, SERIES_STATUS, true, &view->contact_status, err));
}

bool result_view_choose_line(ResultView *view, const char *words, Error *err)
{
    double *pad = NULL, y = NAN;
    int32_t pads = 0;
    char *end = NULL;
    if (strncmp(words, "y=", 2) == 0) y = strtod(words + 2, &end);
    if (!isfinite(y) || *end)
        FAIL(err, ERROR_INPUT, "a line is given by its y, as y=0.2, not as \"%.40s\"", words);
    TRY(result_view_read_plane(view, err));
    TRY(result_file_read_nodes(view->file, NODES_PAD, &pad, &pads, err));
    memory_free(view->x);
    view->x = NULL;
    TRY(view->x = NEW_ARRAY(double, view->all_nodes, err));

    // y of the node nearest to what is asked for.
    const ContactPlane *plane = &view->plane;
    double nearest = INFINITY, area = 0;
    for (int32_t i = 0; i < plane->nodes; ++i)
        if (fabs(plane->y[i] - y) < fabs(nearest - y)) nearest = plane->y[i];

    // The nodes within half a mean cell of it, one for each x: that nearest to it. As the run
    // itself finds its line.
    for (int32_t i = 0; i < plane->nodes; ++i) area += plane->weight[i];
    double cell = sqrt(area / plane->nodes), rounding = LINE_ROUNDING * cell;
    view->nodes = 0;
    for (int32_t i = 0; i < plane->nodes; ++i) {
        double off = fabs(plane->y[i] - nearest);
        if (off > 0.5 * cell + rounding) continue;
        int32_t last = view->nodes - 1;
        bool beside = last >= 0 && plane->x[i] - view->x[last] <= rounding;
        if (beside && off >= fabs(plane->y[view->line[last]] - nearest)) continue;
        int32_t at = beside ? last : view->nodes++;
        view->line[at] = i;
        view->x[at] = plane->x[i];
    }
    for (int32_t k = 0; k < view->nodes; ++k) view->pad[k] = pad[view->line[k]];
cleanup:
    memory_free(pad);
    return error_is_clean(err);
}

bool result_view_read_slip(ResultView *view, Error *err)
{
    return view->slip || result_view_read(view, SERIES_SLIP, false, &view->slip, err);
}

bool result_view_read_front(ResultView *view, Error *err)
{
    return view->front || scalar_read(view, SERIES_FRONT, &view->front, err);
}

void result_view_close(ResultView *view)
{
    Error ignored = {0};   // nothing was written: closing has nothing to lose
    array_file_close(view->file, &ignored);
    memory_free_all(view->title, view->t, view->U, view->mu, view->x, view->pad, view->line,
                    view->pad_names, view->warnings, view->slip_rate, view->slip, view->front,
                    view->status, view->contact_status, view->state_names, view->state_unit,
                    view->probe_names, view->events, view->peaks, view->rapid, view->area);
    memory_free_all(view->precursors.at, view->precursors.value, view->front_speed.at,
                    view->front_speed.value);
    contact_plane_destroy(&view->plane);
    *view = (ResultView){0};
}
