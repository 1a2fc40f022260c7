// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/showing/rank_notes.h"

#include "base/memory.h"
#include "io/text/json_reader.h"

#include <math.h>
#include <string.h>

static void add_note(char note[RANK_NOTE_SIZE], const char *words)
{
    size_t used = strlen(note);
    snprintf(note + used, RANK_NOTE_SIZE - used, "%s%s", used ? ", " : "", words);
}

static bool ranks_by_mu_hold(const Study *study)
{
    return strcmp(study->records[study->rank.record].path, "results.mu_hold") == 0;
}

// Period of the values behind the result that is ranked; NaN: not known.
static double period_of(const Study *study, const char *report)
{
    double period = NAN;
    json_find_number(report, ranks_by_mu_hold(study) ? "results.drops.period" : "results.period",
                     &period);
    return period;
}

bool rank_notes(const Sweep *sweep, const Ranking *ranking, const RankRow *row,
                char note[RANK_NOTE_SIZE], Error *err)
{
    PointStatus status = sweep->points[row->point].status;
    char *report = status == POINT_DONE ? point_report(sweep, row->point, err) : NULL;
    char text[60], warning[8];
    double enough = 1, over = 1, period = report ? period_of(&sweep->study, report) : (double)NAN;
    *note = 0;
    TRY(error_is_clean(err));
    if (status != POINT_DONE) add_note(note, point_status_name(status));
    if (status == POINT_DONE && isnan(row->value)) add_note(note, "no value");
    snprintf(text, sizeof text, "not decided between %d and %d", row->from, row->to);
    if (row->from < row->to) add_note(note, text);
    if (ranking->has_error && !isnan(row->value) && isnan(row->error))
        add_note(note, "error not known");
    if (sweep->points[row->point].refined) add_note(note, "refined");
    if (period == 0) add_note(note, "not periodic");
    if (report && ranks_by_mu_hold(&sweep->study) &&
        json_find_number(report, "results.drops.enough", &enough) && enough == 0)
        add_note(note, "too few drops");
    if (report && json_find_number(report, "results.run_in.over", &over) && over == 0)
        add_note(note, "run-in not over");
    snprintf(text, sizeof text, "period %.0f", period);
    if (period > 1) add_note(note, text);
    if (report && json_find_text(report, "warnings.0", warning, sizeof warning))
        add_note(note, "warned");
cleanup:
    memory_free(report);
    return error_is_clean(err);
}
