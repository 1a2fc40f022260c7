// SPDX-License-Identifier: GPL-2.0-or-later
// `--compare` reads the files that are written here, so that one run may be drawn beside another.
#include "render/figure_data.h"

#include "io/text/csv_writer.h"
#include "render/events_table.h"
#include "render/figures/columns.h"
#include "render/figures/probe_data.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

enum { COLUMNS_MAX = 6 };

// The figure that shows what is measured; a measured area stands on that of the law's own measure,
// where it has one.
static FigureId figure_of(MeasuredKind kind, const ResultView *view)
{
    static const FigureId figures[MEASURED_KINDS] = {[MEASURED_MU] = FIGURE_FORCE,
                                                     [MEASURED_FRONT] = FIGURE_SLIP_MAP,
                                                     [MEASURED_AREA] = FIGURE_CONTACT_DENSITY,
                                                     [MEASURED_LENGTH] = FIGURE_PRECURSORS,
                                                     [MEASURED_SPEED] = FIGURE_FRONT_SPEED,
                                                     [MEASURED_PROBE] = FIGURE_PROBES};
    return kind == MEASURED_AREA && figure_contact_area_is_there(view) ? FIGURE_CONTACT_AREA
                                                                       : figures[kind];
}

// MEASURED_KINDS: nothing of the figure is measured.
static MeasuredKind kind_of(const Figure *figure, const ResultView *view)
{
    int32_t kind = 0;
    while (kind < MEASURED_KINDS && figure_of((MeasuredKind)kind, view) != figure->id) ++kind;
    return (MeasuredKind)kind;
}

static bool data_path(const char *folder, const char *name, const char *end, char path[PATH_MAX],
                      Error *err)
{
    if (snprintf(path, PATH_MAX, "%s/figures/%s%s.csv", folder, name, end) >= PATH_MAX)
        return REFUSE(err, "the result folder's path is too long");
    return true;
}

// Each point with what was computed there, in the result's own units; of probes with the name of
// the column that it stands in.
static bool write_compared(const char *path, const Measured *measured, const ResultView *view,
                           Error *err)
{
    const MeasuredWords *words = &MEASURED_WORDS[measured->kind];
    bool probes = measured->kind == MEASURED_PROBE;
    Column columns[COLUMNS_MAX] = {{words->at, words->at_unit, measured->at}};
    int32_t count = 1;
    if (measured->kind == MEASURED_AREA) columns[count++] = (Column){"x", "m", measured->x};
    columns[count++] = (Column){words->value, words->unit, measured->value};
    columns[count++] = (Column){"error", words->unit, measured->error};
    columns[count++] = (Column){"computed", words->unit, measured->computed};
    if (measured->matched) columns[count++] = (Column){"computed F_T/F_N", NULL, measured->x};
    TextWriter *csv = text_writer_create(path, false, err);
    if (!csv) return false;
    for (int32_t k = 0; k < count; ++k) {
        csv_heading(csv, columns[k].name, view->si ? columns[k].unit : NULL);
        if (probes && k == 0) csv_text(csv, "column");
    }
    csv_end_row(csv);
    for (int32_t row = 0; row < measured->count; ++row) {
        int32_t id = probes ? (int32_t)measured->x[row] : 0;
        for (int32_t k = 0; k < count; ++k) {
            csv_rounded(csv, columns[k].values[row]);
            if (probes && k == 0)
                probe_column_csv(csv, view, id / PROBE_COMPONENTS_MAX, measured->quantity,
                                 id % PROBE_COMPONENTS_MAX);
        }
        csv_end_row(csv);
    }
    return text_writer_finish(csv, err);
}

bool figure_data_write(const char *folder, const Figure *figure, ResultView *view,
                       const FieldChoice *field, const char *compare, Error *err)
{
    MeasuredKind kind = kind_of(figure, view);
    Measured measured = {0};
    char path[PATH_MAX];
    if (figure->id == FIGURE_FORCE)
        TRY(data_path(folder, "events", "", path, err) && events_table_write(path, view, err));
    TRY(data_path(folder, figure->name, "", path, err));
    if (figure->kind->write_table) TRY(figure->kind->write_table(path, view, field, err));
    if (kind == MEASURED_KINDS) goto cleanup;
    TRY(measured_read(compare, kind, view, &measured, err));
    if (measured.count > 0) {
        TRY(data_path(folder, figure->name, "-compared", path, err));
        TRY(write_compared(path, &measured, view, err));
    }
cleanup:
    measured_destroy(&measured);
    return error_is_clean(err);
}

bool figure_data_misfits(const char *folder, ResultView *view, const char *compare, Error *err)
{
    char path[PATH_MAX];
    Measured measured = {0};
    TextWriter *csv = NULL;
    TRY(data_path(folder, "misfit", "", path, err));
    TRY(csv = text_writer_create(path, false, err));
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
            const char *over = MEASURED_WORDS[kind].over;
            if (kind == MEASURED_PROBE && view->si) over = probe_words(measured.quantity).si;
            csv_text(csv, figure_get(figure_of((MeasuredKind)kind, view))->name);
            csv_number(csv, measured.count);
            csv_number(csv, measured.compared);
            csv_number(csv, measured.compared > 0 ? measured.misfit : NAN);
            csv_text(csv, over);
            csv_number(csv, measured.compared > 0 ? measured.in_errors : NAN);
            csv_end_row(csv);
        }
        measured_destroy(&measured);
    }
cleanup:
    measured_destroy(&measured);
    return text_writer_finish(csv, err);
}

bool figure_data_measured(const Figure *figure, const char *compare, ResultView *view, bool *shows,
                          Error *err)
{
    MeasuredKind kind = kind_of(figure, view);
    *shows = false;
    return kind == MEASURED_KINDS || !compare || measured_has(compare, kind, view, shows, err);
}
