// SPDX-License-Identifier: GPL-2.0-or-later
// A recorder: every accepted step becomes a row of each series in history.h5. Which series there
// are, their names, units and kinds stands in io/hdf5/result_tables.h; the arrays below say where a
// value comes from. io/hdf5/array_file gathers rows into chunks and compresses those.
#include "record/history.h"

#include "base/clock.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double FLUSH_EVERY = 2.0;   // s
static const double FLUSH_SHARE = 0.02;   // of the time, at most, where the disk is slow

// head: title, units and numbers are set; what belongs to the nodes is added here and points into
// `history` and `interface`, which must outlive the call. `contact` must outlive the history.
bool history_create(const char *folder, ResultHead *head, const Interface *interface,
                    const ContactArrays *contact, History *history, Error *err)
{
    int32_t count = interface->contact_count;
    *history = (History){.contact = contact,
                         .flush_at = clock_seconds() + FLUSH_EVERY,
                         .pad_count = interface->pad_count};
    history->status = NEW_ARRAY(double, count, err);
    history->pad = NEW_ARRAY(double, count, err);
    if (interface->line) history->line = NEW_ARRAY(double, count, err);
    history->pad_sums = NEW_ARRAY(PadSum, interface->pad_count, err);
    history->pad_rows = NEW_ARRAY(double, RESULT_SERIES_COUNT * interface->pad_count, err);
    history->pad_length = NEW_ARRAY(double, interface->pad_count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t i = 0; i < count; i++) history->pad[i] = interface->pad[i];
    for (int32_t p = 0; p < interface->pad_count; p++)
        history->pad_length[p] = pad_size(interface, p).weight;
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
    history->file = head->goes_on ? result_file_reopen(folder, head, err)
                                  : result_file_create(folder, head, err);
    history->end.kept = history->file != NULL;
    return history->file != NULL;
}

// A file that was not finished stays as history.h5.part, which render and info can read.
void history_destroy(History *history)
{
    memory_free_all(history->status, history->pad, history->line, history->pad_sums,
                    history->pad_rows, history->pad_length);
    array_file_abandon(history->file);
    *history = (History){0};
}

// row[s]: of each series, as many entries as it has columns: 1, the contact nodes (or their
// tangents), the pads or the probes.
static void fill_rows(History *history, const Observation *seen, double *row[RESULT_SERIES_COUNT])
{
    const Interface *interface = seen->interface;
    const ContactArrays *contact = history->contact;
    double *number = history->end.last, *pads = history->pad_rows;
    for (ResultSeries s = 0; s < RESULT_SERIES_COUNT; s++) {
        row[s] = &number[s];
        if (result_series_columns(s) != COLUMNS_PADS) continue;
        row[s] = pads;
        pads += history->pad_count;
    }

    // Numbers of the whole block; that of SERIES_ROD_WAY is there though it may not be written.
    number[SERIES_TIME] = seen->t;
    number[SERIES_ROD] = seen->U;
    number[SERIES_ROD_WAY] = seen->rod_way;
    number[SERIES_MU] = seen->mu;
    number[SERIES_ROD_FORCE] = seen->rod_force;
    number[SERIES_NORMAL_FORCE] = seen->normal_force;
    number[SERIES_STEP] = seen->step_size;
    number[SERIES_FRONT] = seen->front;
    number[SERIES_MAX_SLIP_RATE] = seen->max_slip_rate;
    number[SERIES_CERTIFIED] = seen->certified;
    number[SERIES_ENERGY_ERROR] = seen->energy_imbalance;

    // Pads; their slip is the mean over nodes by weight.
    pad_sums(seen, history->pad_sums);
    for (int32_t p = 0; p < history->pad_count; p++) {
        const PadSum *sum = &history->pad_sums[p];
        row[SERIES_PAD_NORMAL][p] = sum->normal_force;
        row[SERIES_PAD_SHEAR][p] = sum->shear;
        row[SERIES_PAD_SHEAR_ACROSS][p] = sum->shear_across;
        row[SERIES_PAD_SLIP][p] = row[SERIES_PAD_SLIP_ACROSS][p] = 0;
        row[SERIES_PAD_SLIPPING][p] = sum->slipping;
    }
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t p = interface->pad[i];
        double part = interface->weight[i] / history->pad_length[p];
        const double *slip = &contact->slip[i * contact->tangents];
        row[SERIES_PAD_SLIP][p] += part * slip[0];
        if (contact->tangents > 1) row[SERIES_PAD_SLIP_ACROSS][p] += part * slip[1];
    }

    // Probes and contact nodes, where they lie.
    Probes *probes = history->probes;
    if (probes) {
        probes_read(probes, seen->state);
        row[SERIES_PROBE_DISPLACEMENT] = probes->displacement;
        row[SERIES_PROBE_VELOCITY] = probes->velocity;
        row[SERIES_PROBE_STRAIN] = probes->strain;
        row[SERIES_PROBE_STRESS] = probes->stress;
    }
    row[SERIES_SLIP_RATE] = contact->slip_rate;
    row[SERIES_SLIP] = contact->slip;
    row[SERIES_PRESSURE] = contact->pressure;
    row[SERIES_SHEAR] = contact->shear;
    row[SERIES_GAP] = contact->gap;
    row[SERIES_STATE] = contact->state;
    row[SERIES_AREA] = contact->area;
    row[SERIES_STATUS] = history->status;
    for (int32_t i = 0; i < contact->count; i++) history->status[i] = contact->status[i];
}

bool history_record(void *self, const Observation *seen, Error *err)
{
    History *history = self;
    double *row[RESULT_SERIES_COUNT];
    fill_rows(history, seen, row);
    for (ResultSeries s = 0; s < RESULT_SERIES_COUNT; s++)
        if (history->written[s] &&
            !array_file_append(history->file, result_series_name(s), row[s], 1, err))
            return false;
    history->end.rows++;
    return clock_seconds() < history->flush_at || history_sync(history, err);
}

void history_end_archive(HistoryEnd *end, Archive *archive)
{
    archive_flag(archive, &end->kept);
    archive_count(archive, &end->rows);
    archive_numbers(archive, end->last, RESULT_SERIES_COUNT);
}

// The bits of each series are compared, as NaN stands in some.
bool history_has_end(ArrayFile *file, const HistoryEnd *end, Error *err)
{
    double *values = NULL;
    for (ResultSeries series = 0; end->rows > 0 && series < RESULT_SERIES_COUNT; series++) {
        bool one = result_series_columns(series) == COLUMNS_ONE;
        int64_t rows = 0;
        int32_t width = 0;
        if (!one || !array_file_has(file, result_series_name(series))) continue;
        memory_free(values);
        values = NULL;
        TRY(result_file_read_series(file, series, &values, &rows, &width, err));
        if (rows < end->rows || width != 1)
            FAIL(err, ERROR_INPUT,
                 "the history does not go as far as the saved state: it is that of another run, or "
                 "was cut off while it was written");
        const double *found = &values[end->rows - 1];
        if (memcmp(found, &end->last[series], sizeof *found) != 0)
            FAIL(err, ERROR_INPUT,
                 "the history is that of another run than the saved state: in row %lld of %s it "
                 "has %.17g, not %.17g",
                 (long long)end->rows - 1, result_series_name(series), *found, end->last[series]);
    }
cleanup:
    memory_free(values);
    return error_is_clean(err);
}

bool history_take_back(History *history, const HistoryEnd *end, Error *err)
{
    if (!history->file) return true;
    if (!end->kept) return REFUSE(err, "the saved state is that of a run without a history");
    if (!history_has_end(history->file, end, err)) return false;
    if (!result_file_cut(history->file, history->written, end->rows, err)) return false;
    history->end = *end;
    return true;
}

bool history_sync(History *history, Error *err)
{
    double started = clock_seconds();
    bool done = !history->file || array_file_flush(history->file, err);
    double now = clock_seconds();
    history->flush_at = now + fmax(FLUSH_EVERY, (now - started) / FLUSH_SHARE);
    return done;
}

// Tables of peaks and events, mu_M and l_c where there are any, then the file gets its final name.
// After a failure the file is no longer `history`'s.
bool history_finish(History *history, const Drops *drops, int32_t counted, double mu_M, double l_c,
                    Error *err)
{
    const Events *events = drops->events;   // as many as drops, or more
    double *column = NEW_ARRAY(double, events->count, err);
    if (!column) goto cleanup;
    for (ResultTable table = 0; table < RESULT_TABLES_COUNT; table++) {
        int32_t count = 0;
        if (table == EVENTS_SLIPPED && !events->in_space) continue;
        bool of_peaks = table == PEAKS_U || table == PEAKS_MU || table == PEAKS_COUNTS;
        // k is the number of a drop in tables of peaks, of an event in the others.
        int32_t rows = of_peaks ? drops->count : events->count;
        for (int32_t k = 0; k < rows; k++) {
            if (of_peaks && !drop_is(&drops->list[k], DROP_BULK))
                continue;   // no sliding of the whole block
            const Event *event = &events->list[k];
            Drop peak = of_peaks ? drops_as(drops, DROP_BULK, k) : (Drop){0};
            column[count++] = (const double[RESULT_TABLES_COUNT]){
                [PEAKS_U] = peak.U,
                [PEAKS_MU] = peak.mu,
                [PEAKS_COUNTS] = k >= counted,
                [EVENTS_KIND] = event->kind,
                [EVENTS_U_START] = event->U_start,
                [EVENTS_U_STOP] = event->U_stop,
                [EVENTS_T_START] = event->t_start,
                [EVENTS_T_STOP] = event->t_stop,
                [EVENTS_REACH] = event->reach,
                [EVENTS_SLIPPED] = event->slipped,
                [EVENTS_PEAK_RATE] = event->peak_slip_rate,
                [EVENTS_FRONT_SPEED] = event->front_speed}[table];
        }
        TRY(result_file_write_table(history->file, table, column, count, err));
    }
    if (!isnan(mu_M))
        TRY(array_file_set_number(history->file, result_number_name(NUMBER_MU_M), mu_M, err));
    if (history->pad_count == 1 && !isnan(l_c))
        TRY(array_file_set_number(history->file, result_number_name(NUMBER_L_C), l_c, err));
    ArrayFile *file = history->file;
    history->file = NULL;
    TRY(array_file_close(file, err));
cleanup:
    memory_free(column);
    return error_is_clean(err);
}
