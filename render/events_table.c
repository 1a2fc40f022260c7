// SPDX-License-Identifier: GPL-2.0-or-later
// Events that count by their rate and their width (record/events). What the history adds is read
// off its steps: the load ratio in the step before and at the end, the moment of the pressure in
// both, and the work of friction, the integral of tau over slip and contact by the trapezoidal
// rule.
#include "render/events_table.h"

#include "base/memory.h"
#include "io/text/csv_writer.h"

#include <math.h>

// Steps that follow an event at least, for what is read off its course to be more than one step's.
enum { STEPS_ENOUGH = 8 };

// Series of the whole contact, not of the line that figures of a block in space show.
typedef struct Friction {
    int32_t nodes, components;   // components: of slip and shear, in space 2
    double *shear, *slip;   // [rows * nodes * components] stress, length
    double *pressure;   // [rows * nodes] stress
    double *weight, *x;   // [nodes] length, in space area; length
} Friction;

static double friction_work(const Friction *friction, int64_t first, int64_t last)
{
    int32_t width = friction->nodes * friction->components;
    double work = 0;
    for (int64_t row = first; row < last; ++row)
        for (int32_t k = 0; k < width; ++k) {
            int64_t from = row * width + k, to = from + width;
            work += friction->weight[k / friction->components] *
                    (friction->shear[from] + friction->shear[to]) / 2 *
                    (friction->slip[to] - friction->slip[from]);
        }
    return work;
}

// Moment of the contact's pressure about the middle of the block, positive where it presses more in
// front; force times length, in the plane per width.
static double torque(const ResultView *view, const Friction *friction, int64_t row)
{
    double sum = 0;
    double middle = result_view_trailing_end(view) + view->number[NUMBER_LENGTH] / 2;
    for (int32_t i = 0; i < friction->nodes; ++i)
        sum += friction->weight[i] * friction->pressure[row * friction->nodes + i] *
               (friction->x[i] - middle);
    return sum;
}

static bool read_vectors(ResultView *view, Friction *friction, ResultSeries series, double **values,
                         Error *err)
{
    int64_t rows = 0;
    int32_t width = 0;
    if (!result_file_read_series(view->file, series, values, &rows, &width, err)) return false;
    if (rows < view->rows) view->rows = rows;
    if (friction->components == 0) friction->components = width == friction->nodes ? 1 : 2;
    return width == friction->nodes * friction->components ||
           FAULT(err, ERROR_FILE, "%s has %d columns, but there are %d contact nodes",
                 result_series_name(series), width, friction->nodes);
}

static bool read_nodes(const ResultView *view, ResultNodes nodes, double **values, Error *err)
{
    int32_t count = 0;
    return result_file_read_nodes(view->file, nodes, values, &count, err) &&
           (count == view->all_nodes ||
            FAULT(err, ERROR_FILE, "%d values at %d contact nodes", count, view->all_nodes));
}

bool events_table_write(const char *path, ResultView *view, Error *err)
{
    Friction friction = {0};
    double *peak = NULL, thickness = view->number[NUMBER_THICKNESS];
    int32_t peaks = 0, cycle = 1;
    bool whole = view->line || thickness > 0;
    double times = !view->line && thickness > 0 ? thickness : 1;
    double load = view->number[NUMBER_LOAD] * times;
    TextWriter *csv = NULL;
    friction.nodes = view->all_nodes;
    TRY(read_vectors(view, &friction, SERIES_SLIP, &friction.slip, err) &&
        read_vectors(view, &friction, SERIES_SHEAR, &friction.shear, err) &&
        result_view_read(view, SERIES_PRESSURE, true, &friction.pressure, err) &&
        read_nodes(view, NODES_WEIGHT, &friction.weight, err) &&
        read_nodes(view, NODES_X, &friction.x, err));
    TRY(result_view_read_front(view, err));
    TRY(result_file_read_table(view->file, EVENTS_PEAK_RATE, &peak, &peaks, err));

    // Forces and energies are those of the whole block; in the plane, where its thickness is not
    // known, they are those of a metre of it.
    TRY(csv = text_writer_create(path, false, err));
    const char *force = whole ? "N" : "N/m", *energy = whole ? "J" : "J/m";
    const char *moment = whole ? "N m" : "N";
    csv_heading(csv, "cycle", NULL);
    csv_heading(csv, "event", NULL);
    csv_heading(csv, "U", view->si ? "m" : NULL);
    csv_heading(csv, "t", view->si ? "s" : NULL);
    csv_heading(csv, "F_T/F_N before", NULL);
    csv_heading(csv, "F_T/F_N after", NULL);
    csv_heading(csv, "F_T before", view->si ? force : NULL);
    csv_heading(csv, "F_T after", view->si ? force : NULL);
    csv_heading(csv, "length", view->si ? "m" : NULL);
    csv_heading(csv, "front", view->si ? "m" : NULL);
    csv_heading(csv, "largest slip rate", view->si ? "m/s" : NULL);
    csv_heading(csv, "duration", view->si ? "s" : NULL);
    csv_heading(csv, "work of friction", view->si ? energy : NULL);
    csv_heading(csv, "torque before", view->si ? moment : NULL);
    csv_heading(csv, "torque after", view->si ? moment : NULL);
    csv_heading(csv, "steps", NULL);
    csv_heading(csv, "resolved", NULL);
    csv_end_row(csv);

    // Each event that counts and has a start and an end becomes a row.
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        bool sliding = event->kind == VIEW_LEADING;
        if (!view_event_counts(event)) continue;
        if (!isfinite(event->U_start + event->U_stop)) continue;
        int64_t first = 0, last = 0;   // the step before, and that of its end
        result_view_event_rows(view, event->U_start, event->U_stop, &first, &last);

        // Find the largest length that slipped from the trailing end on at one moment.
        double longest = 0;
        for (int64_t row = first + 1; row <= last && row < view->rows; ++row)
            longest = fmax(longest, view->front[row] - result_view_trailing_end(view));
        csv_number(csv, cycle);
        csv_text(csv, view_event_word(event));
        csv_rounded(csv, event->U_start);
        csv_rounded(csv, view->t[first + 1 < view->rows ? first + 1 : first]);
        csv_rounded(csv, view->mu[first]);
        csv_rounded(csv, view->mu[last]);
        csv_rounded(csv, load * view->mu[first]);
        csv_rounded(csv, load * view->mu[last]);
        csv_rounded(csv, event->reach - result_view_trailing_end(view));
        csv_rounded(csv, longest);
        csv_rounded(csv, k < peaks ? peak[k] : NAN);
        csv_rounded(csv, view->t[last] - view->t[first]);
        csv_rounded(csv, times * friction_work(&friction, first, last));
        csv_rounded(csv, times * torque(view, &friction, first));
        csv_rounded(csv, times * torque(view, &friction, last));
        csv_number(csv, (double)(last - first));
        csv_number(csv, last - first >= STEPS_ENOUGH);
        csv_end_row(csv);
        cycle += sliding;
    }
cleanup:
    memory_free_all(friction.shear, friction.pressure, friction.slip, friction.weight, friction.x,
                    peak);
    return text_writer_finish(csv, err);
}
