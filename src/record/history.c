// SPDX-License-Identifier: GPL-2.0-or-later
// A recorder: every accepted step becomes a row of each series in history.h5. Which series there
// are, their names, units and kinds stands in io/hdf5/result_tables.h; the arrays below say where a
// value comes from. io/hdf5/array_file gathers rows into chunks and compresses those.
#include "record/history.h"

#include "base/clock.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double FLUSH_EVERY = 2.0;   // s; what a kill -9 may cost

// head: title, units and numbers are set; what belongs to the nodes is added here and points into
// `history` and `interface`, which must outlive the call. `contact` must outlive the history.
bool history_create(const char *folder, ResultHead *head, const Interface *interface,
                    const ContactArrays *contact, History *history, Error *err)
{
    int32_t count = interface->contact_count;
    *history = (History){
        .contact = contact, .flushed_at = clock_seconds(), .pad_count = interface->pad_count};
    history->row = NEW_ARRAY(double, count, err);
    history->pad = NEW_ARRAY(double, count, err);
    if (interface->line) history->line = NEW_ARRAY(double, count, err);
    history->pad_sums = NEW_ARRAY(PadSum, interface->pad_count, err);
    history->pad_row = NEW_ARRAY(double, interface->pad_count, err);
    history->pad_length = NEW_ARRAY(double, interface->pad_count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t i = 0; i < count; i++) {
        history->pad[i] = interface->pad[i];
        history->pad_length[interface->pad[i]] += interface->weight[i];
    }
    for (int32_t k = 0; interface->line && k < interface->line_count; k++)
        history->line[interface->line[k]] = 1;
    head->contact_count = count;
    head->tangents = contact->tangents;
    for (ResultSeries k = 0; k < RESULT_SERIES_COUNT; k++)
        history->written[k] = result_series_written(head, k);
    head->nodes[NODES_X] = interface->x;
    head->nodes[NODES_Y] = interface->y;
    head->nodes[NODES_LINE] = history->line;
    head->nodes[NODES_WEIGHT] = interface->weight;
    head->nodes[NODES_PAD] = history->pad;
    history->file = head->goes_on ? result_file_reopen(folder, err)
                                  : result_file_create(folder, head, err);
    history->end.kept = history->file != NULL;
    return history->file != NULL;
}

// A file that was not finished stays as history.h5.part, which render and info can read.
void history_destroy(History *history)
{
    memory_free_all(history->row, history->pad, history->line, history->pad_sums, history->pad_row,
                    history->pad_length);
    array_file_abandon(history->file);
    *history = (History){0};
}

// Of the whole block.
static double series_value(const Observation *seen, ResultSeries series)
{
    const double values[RESULT_SERIES_COUNT] = {[SERIES_TIME] = seen->t,
                                                [SERIES_ROD] = seen->U,
                                                [SERIES_ROD_WAY] = seen->rod_way,
                                                [SERIES_MU] = seen->mu,
                                                [SERIES_ROD_FORCE] = seen->rod_force,
                                                [SERIES_NORMAL_FORCE] = seen->normal_force,
                                                [SERIES_STEP] = seen->step_size,
                                                [SERIES_FRONT] = seen->front,
                                                [SERIES_MAX_SLIP_RATE] = seen->max_slip_rate,
                                                [SERIES_CERTIFIED] = seen->certified,
                                                [SERIES_ENERGY_ERROR] = seen->energy_imbalance};
    return values[series];
}

// Of all contact nodes; status as numbers, in history->row.
static const double *node_values(const History *history, ResultSeries series)
{
    const ContactArrays *contact = history->contact;
    const double *const values[RESULT_SERIES_COUNT] = {[SERIES_SLIP_RATE] = contact->slip_rate,
                                                       [SERIES_SLIP] = contact->slip,
                                                       [SERIES_PRESSURE] = contact->pressure,
                                                       [SERIES_SHEAR] = contact->shear,
                                                       [SERIES_STATE] = contact->state};
    if (values[series]) return values[series];
    for (int32_t i = 0; i < contact->count; i++) history->row[i] = contact->status[i];
    return history->row;
}

// Mean slip of pad p along the drive, 0, or across it, 1: of its nodes by weight.
static double pad_slip(const History *history, const Interface *interface, int32_t p, int32_t c)
{
    const ContactArrays *contact = history->contact;
    double slip = 0;
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (interface->pad[i] == p)
            slip += interface->weight[i] / history->pad_length[p] *
                    contact->slip[i * contact->tangents + c];
    return slip;
}

static double pad_value(const History *history, const Observation *seen, ResultSeries series,
                        int32_t p)
{
    const PadSum *sum = &history->pad_sums[p];
    const double sums[RESULT_SERIES_COUNT] = {[SERIES_PAD_NORMAL] = sum->normal_force,
                                              [SERIES_PAD_SHEAR] = sum->shear,
                                              [SERIES_PAD_SHEAR_ACROSS] = sum->shear_across,
                                              [SERIES_PAD_SLIPPING] = sum->slipping};
    bool across = series == SERIES_PAD_SLIP_ACROSS;
    return across || series == SERIES_PAD_SLIP ? pad_slip(history, seen->interface, p, across)
                                               : sums[series];
}

// One series of one step.
// `row` has as many entries as the series has columns: 1, the contact nodes (or their tangents) or
// the pads.
static bool append(History *history, const Observation *seen, ResultSeries series, Error *err)
{
    const double *row = history->row;
    switch (result_series_columns(series)) {
    case COLUMNS_ONE:
        history->row[0] = history->end.last[series] = series_value(seen, series);
        break;
    case COLUMNS_NODES:
        row = node_values(history, series);
        break;
    case COLUMNS_PADS:
        for (int32_t p = 0; p < history->pad_count; p++)
            history->pad_row[p] = pad_value(history, seen, series, p);
        row = history->pad_row;
        break;
    }
    return array_file_append(history->file, result_series_name(series), row, 1, err);
}

// The time of a flush is not counted in `seconds`: it is the disk's.
bool history_record(void *self, const Observation *seen, Error *err)
{
    History *history = self;
    double started = clock_seconds();
    pad_sums(seen, history->pad_sums);
    for (ResultSeries series = 0; series < RESULT_SERIES_COUNT; series++) {
        if (!history->written[series]) continue;
        if (!append(history, seen, series, err)) return false;
    }
    history->end.rows++;
    double now = clock_seconds();
    history->seconds += now - started;
    if (now - history->flushed_at > FLUSH_EVERY) {
        if (!array_file_flush(history->file, err)) return false;
        history->flushed_at = now;
    }
    return true;
}

void history_end_archive(HistoryEnd *end, Archive *archive)
{
    archive_flag(archive, &end->kept);
    archive_count(archive, &end->rows);
    archive_numbers(archive, end->last, RESULT_SERIES_COUNT);
}

// One series; its bits, as NaN stands in some.
static bool has_last(ArrayFile *file, const HistoryEnd *end, ResultSeries series, Error *err)
{
    double *values = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    TRY(result_file_read_series(file, series, &values, &rows, &width, err));
    if (rows < end->rows || width != 1)
        FAIL(err, ERROR_INPUT,
             "the history does not go as far as the saved state: it is that of another run, or was "
             "cut off while it was written");
    const double *found = &values[end->rows - 1];
    if (memcmp(found, &end->last[series], sizeof *found) != 0)
        FAIL(err, ERROR_INPUT,
             "the history is that of another run than the saved state: in row %lld of %s it has "
             "%.17g, not %.17g",
             (long long)end->rows - 1, result_series_name(series), *found, end->last[series]);
cleanup:
    memory_free(values);
    return error_is_clean(err);
}

bool history_has_end(ArrayFile *file, const HistoryEnd *end, Error *err)
{
    for (ResultSeries series = 0; end->rows > 0 && series < RESULT_SERIES_COUNT; series++) {
        bool one = result_series_columns(series) == COLUMNS_ONE;
        if (one && array_file_has(file, result_series_name(series)) &&
            !has_last(file, end, series, err))
            return false;
    }
    return true;
}

bool history_take_back(History *history, const HistoryEnd *end, Error *err)
{
    if (!history->file) return true;
    if (!end->kept) return REFUSE(err, "the saved state is that of a run without a history");
    if (!history_has_end(history->file, end, err)) return false;
    if (!result_file_cut(history->file, end->rows, err)) return false;
    history->end = *end;
    return true;
}

bool history_sync(History *history, Error *err)
{
    return !history->file || array_file_sync(history->file, err);
}

// A table is stored a column at a time. Peaks are the bulk slidings among the drops; how many.
static int32_t peak_column(const Drops *drops, const Answers *answers, ResultTable table,
                           double *column)
{
    int32_t count = 0;
    for (int32_t k = 0; k < drops->count; k++) {
        if (!drop_is(&drops->list[k], DROP_BULK)) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        column[count++] = table == PEAKS_U    ? peak.U
                          : table == PEAKS_MU ? peak.mu
                                              : k >= answers->first;
    }
    return count;
}

// Entry `table` of one event.
static double event_column(const Event *event, ResultTable table)
{
    const double entries[RESULT_TABLES_COUNT] = {[EVENTS_KIND] = event->kind,
                                                 [EVENTS_U_START] = event->U_start,
                                                 [EVENTS_U_STOP] = event->U_stop,
                                                 [EVENTS_T_START] = event->t_start,
                                                 [EVENTS_T_STOP] = event->t_stop,
                                                 [EVENTS_REACH] = event->reach,
                                                 [EVENTS_SLIPPED] = event->slipped,
                                                 [EVENTS_PEAK_RATE] = event->peak_slip_rate,
                                                 [EVENTS_FRONT_SPEED] = event->front_speed};
    return entries[table];
}

static bool is_peak_table(ResultTable table)
{
    return table == PEAKS_U || table == PEAKS_MU || table == PEAKS_COUNTS;
}

// Tables of peaks and events, mu_M and l_c where there are any, then the file gets its final name.
// After a failure the file is no longer `history`'s.
bool history_finish(History *history, const Drops *drops, const Answers *answers, Error *err)
{
    const Events *events = drops->events;   // as many as drops, or more
    double *column = NEW_ARRAY(double, events->count, err);
    if (!column) goto cleanup;
    for (ResultTable table = 0; table < RESULT_TABLES_COUNT; table++) {
        int32_t count = events->count;
        if (table == EVENTS_SLIPPED && !events->in_space) continue;
        if (is_peak_table(table))
            count = peak_column(drops, answers, table, column);
        else
            for (int32_t k = 0; k < count; k++) column[k] = event_column(&events->list[k], table);
        TRY(result_file_write_table(history->file, table, column, count, err));
    }
    if (!isnan(answers->mu_M.value))
        TRY(array_file_set_number(history->file, result_number_name(NUMBER_MU_M),
                                  answers->mu_M.value, err));
    if (history->pad_count == 1 && !isnan(answers->critical_length))
        TRY(array_file_set_number(history->file, result_number_name(NUMBER_L_C),
                                  answers->critical_length, err));
    ArrayFile *file = history->file;
    history->file = NULL;
    TRY(array_file_close(file, err));
cleanup:
    memory_free(column);
    return error_is_clean(err);
}
