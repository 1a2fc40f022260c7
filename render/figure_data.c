// SPDX-License-Identifier: GPL-2.0-or-later
// What is written is what `--compare` reads: one run may be drawn beside another.
#include "render/figure_data.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/text/csv_writer.h"
#include "render/figures/state_scale.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 6, OF_STATE = 3 };

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
    char name[VIEW_STATE_SIZE + 20];
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

static bool write_force(const char *path, ResultView *view, Error *err)
{
    const DataColumn columns[] = {
        {"U", "m", view->U, 1}, {"t", "s", view->t, 1}, {"F_T/F_N", NULL, view->mu, 1}};
    return write_columns(path, columns, 3, view->rows, view->si, err);
}

static bool write_front(const char *path, ResultView *view, Error *err)
{
    if (!result_view_read_front(view, err)) return false;
    const DataColumn columns[] = {
        {"U", "m", view->U, 1}, {"t", "s", view->t, 1}, {"x", "m", view->front, 1}};
    return write_columns(path, columns, 3, view->rows, view->si, err);
}

static bool write_lengths(const char *path, ResultView *view, Error *err)
{
    if (!precursors_compute(view, err)) return false;
    const DataColumn columns[] = {
        {"F_T/F_N", NULL, view->precursors.at, 1},
        {"l/L", NULL, view->precursors.value, 1 / view->number[NUMBER_LENGTH]}};
    return write_columns(path, columns, 2, view->precursors.count, view->si, err);
}

static bool write_speeds(const char *path, ResultView *view, Error *err)
{
    if (!front_speed_compute(view, err)) return false;
    const DataColumn columns[] = {
        {"x/L", NULL, view->front_speed.at, 1 / view->number[NUMBER_LENGTH]},
        {"v/c_R", NULL, view->front_speed.value, 1 / view->number[NUMBER_C_RAYLEIGH]}};
    return write_columns(path, columns, 2, view->front_speed.count, view->si, err);
}

// Least, median and largest over the nodes, of the state that the view stands for.
static bool state_columns(ResultView *view, double *columns[OF_STATE], Error *err)
{
    double *states = NULL;
    TRY(state_read(view, false, &states, err));
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

static const struct FigureData {
    const char *name;
    bool (*write)(const char *path, ResultView *view, Error *err);   // NULL: no curve
    MeasuredFunction measured;
    MeasuredKind kind;
} DATA[] = {
    {"force", write_force, figure_force_measured, MEASURED_MU},
    {"slip-map", write_front, figure_slip_map_measured, MEASURED_FRONT},
    {"contact-density", NULL, figure_contact_density_measured, MEASURED_AREA},
    {"state-map", write_states, NULL, MEASURED_KINDS},
    {"precursors", write_lengths, figure_precursors_measured, MEASURED_LENGTH},
    {"front-speed", write_speeds, figure_front_speed_measured, MEASURED_SPEED},
};

static const struct FigureData *find_data(const char *name)
{
    for (size_t k = 0; k < sizeof DATA / sizeof *DATA; ++k)
        if (strcmp(DATA[k].name, name) == 0) return &DATA[k];
    return NULL;
}

static bool data_path(const char *folder, const char *name, const char *end, char path[PATH_MAX],
                      Error *err)
{
    if (snprintf(path, PATH_MAX, "%s/figures/%s%s.csv", folder, name, end) >= PATH_MAX)
        FAIL(err, ERROR_INPUT, "the result folder's path is too long");
cleanup:
    return error_is_clean(err);
}

// Each point with what was computed there, in the result's own units.
static bool write_compared(const char *path, const Measured *measured, bool si, Error *err)
{
    static const struct {
        const char *at, *at_unit, *value, *unit;
    } names[MEASURED_KINDS] = {{"U", "m", "F_T/F_N", NULL},
                               {"U", "m", "x", "m"},
                               {"U", "m", "A/A_0", NULL},
                               {"F_T/F_N", NULL, "l", "m"},
                               {"x", "m", "v", "m/s"}};
    DataColumn columns[COLUMNS_MAX];
    int32_t count = 0;
    const char *unit = names[measured->kind].unit;
    columns[count++] =
        (DataColumn){names[measured->kind].at, names[measured->kind].at_unit, measured->at, 1};
    if (measured->kind == MEASURED_AREA) columns[count++] = (DataColumn){"x", "m", measured->x, 1};
    columns[count++] = (DataColumn){names[measured->kind].value, unit, measured->value, 1};
    columns[count++] = (DataColumn){"error", unit, measured->error, 1};
    columns[count++] = (DataColumn){"computed", unit, measured->computed, 1};
    return write_columns(path, columns, count, measured->count, si, err);
}

bool figure_data_write(const char *folder, const char *name, ResultView *view, const char *compare,
                       Error *err)
{
    const struct FigureData *data = find_data(name);
    Measured measured = {0};
    char path[PATH_MAX];
    if (!data) return true;
    TRY(data_path(folder, name, "", path, err));
    if (data->write) TRY(data->write(path, view, err));
    if (!compare || !data->measured) return true;
    TRY(data->measured(view, compare, &measured, err));
    TRY(data_path(folder, name, "-compared", path, err));
    if (measured.count > 0) TRY(write_compared(path, &measured, view->si, err));
cleanup:
    measured_destroy(&measured);
    return error_is_clean(err);
}

bool figure_data_measured(const char *name, const char *compare, ResultView *view, bool *shows,
                          Error *err)
{
    const struct FigureData *data = find_data(name);
    *shows = false;
    return !data || !data->measured || !compare ||
           measured_has(compare, data->kind, view, shows, err);
}
