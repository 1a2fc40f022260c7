// SPDX-License-Identifier: GPL-2.0-or-later
#include "page/page.h"

#include "base/text.h"
#include "io/text/json_reader.h"

#include <math.h>
#include <string.h>

enum { DIGITS = 5, PATH_SIZE = 80 };
static const double BIG = 1e4, LENGTH_KNOWN_TO = 0.01;
static const double OLDER_KNOWN_TO = 0.01;   // of mu: what a mesh usually leaves

typedef enum NumberKind {
    NUMBER_ESTIMATE,   // has an error bar, or is known to so much
    NUMBER_LENGTH,   // over L, of which no error is computed
    NUMBER_PLAIN,   // a count, or an error itself
    NUMBER_EVENTS   // how many events of a kind the run has
} NumberKind;

typedef struct NumberRow {
    const char *path;   // in run.json, or an event's kind
    NumberKind kind;
    const char *label, *meaning;   // markup
} NumberRow;

static const NumberRow RESULTS[] = {
    {"results.mu_M", NUMBER_ESTIMATE, "<i>\u03bc</i><sub>M</sub>",
     "macroscopic static friction coefficient: mean of the peaks before the whole block slides, or "
     "what it takes to slide steadily"},
    {"results.mu_hold", NUMBER_ESTIMATE, "<i>\u03bc</i><sub>hold</sub>",
     "what the contact holds: the lowest load ratio at which the load dropped"},
    {"results.mu_max", NUMBER_ESTIMATE, "<i>\u03bc</i><sub>max</sub>",
     "largest load ratio <i>F</i><sub>T</sub>/<i>F</i><sub>N</sub> of the run"},
    {"results.l_c_over_L", NUMBER_LENGTH, "<i>l</i><sub>c</sub>/<i>L</i>",
     "critical length: how far slow slip had come when the block slid"},
    {"results.l_sc_over_L", NUMBER_LENGTH, "<i>l</i><sub>sc</sub>/<i>L</i>",
     "how far it had come when it was first not certified stable"},
    {"results.mu_M_peaks", NUMBER_PLAIN, "peaks behind the start",
     "what <i>\u03bc</i><sub>M</sub> is taken from, where they say enough for it"},
    {"results.period", NUMBER_PLAIN, "period", "peaks repeat after so many slidings; 0: not yet"},
    {"results.slip_cells", NUMBER_PLAIN, "resolution",
     "cells of the contact that slipped where slow slip turned fast; below 8 is too few"},
};

static const NumberRow EVENTS[] = {
    {"quasi-static", NUMBER_EVENTS, "quasi-static precursors", "slow slip grew from an edge"},
    {"bounded rapid", NUMBER_EVENTS, "bounded rapid precursors",
     "rapid slip, faster than 2.5 V and over 5 % of the contact, stopped on its way"},
    {"leading rapid", NUMBER_EVENTS, "slidings of the whole block",
     "slip crossed the whole contact; the paper\u2019s leading rapid precursors"},
};

static const NumberRow CHECKS[] = {
    {"errors.energy", NUMBER_PLAIN, "energy", "work neither stored nor dissipated, relative"},
    {"errors.complementarity", NUMBER_PLAIN, "contact conditions",
     "violation of contact, friction and rod conditions, relative"},
    {"errors.moment", NUMBER_PLAIN, "moments", "balance over <i>F</i><sub>N</sub><i>L</i>"},
    {"errors.equation", NUMBER_PLAIN, "equation of motion", "residual over <i>F</i><sub>N</sub>"},
    {"errors.reduction", NUMBER_PLAIN, "reduction",
     "reduced interface against the full mesh, relative"},
    {"model.elements", NUMBER_PLAIN, "elements", "of the mesh"},
    {"model.contact_nodes", NUMBER_PLAIN, "contact nodes", "of the mesh"},
    {"steps.accepted", NUMBER_PLAIN, "steps", "accepted"},
    {"timing_s.total", NUMBER_PLAIN, "time taken, s", "by the clock"},
};

void estimate_write(TextWriter *html, double value, double bar, double known_to)
{
    char text[ESTIMATE_SIZE], *between;
    if (!isfinite(value) || fabs(value) >= BIG) {
        html_markup(html, isfinite(value) ? "" : "none");
        if (isfinite(value)) html_number(html, value, DIGITS);
        return;
    }
    text_estimate(fabs(value), bar, known_to, text);
    between = strstr(text, " +- ");
    if (between) *between = 0;
    html_markup(html, "%s%s", value < 0 ? "\u2212" : "", text);
    if (between) html_markup(html, "&nbsp;\u00b1&nbsp;%s", between + 4);
    if (isnan(known_to) && isnan(bar))
        html_markup(html, " <span class='unknown'>error not known</span>");
}

double run_known_to(const RunSource *run, const char *path, double *bar)
{
    char beside[PATH_SIZE];
    snprintf(beside, sizeof beside, "%s_error", path);
    double error = run_number(run, beside);
    snprintf(beside, sizeof beside, "%s_known_to", path);
    double known_to = OLDER_KNOWN_TO * fabs(run_number(run, path));
    if (run->json) json_find_number(run->json, beside, &known_to);   // older results do not say
    snprintf(beside, sizeof beside, "%s_error_parts.mesh", path);
    *bar = isfinite(run_number(run, beside)) ? error : (double)NAN;
    return known_to;
}

static void write_rows(TextWriter *html, const NumberRow *rows, size_t row_count,
                       const RunSource *runs, int32_t count)
{
    for (size_t r = 0; r < row_count; ++r) {
        const NumberRow *row = &rows[r];
        html_markup(html, "<tr><th scope='row'>%s</th>", row->label);
        for (int32_t k = 0; k < count; ++k) {
            const RunSource *run = &runs[k];
            if (row->kind == NUMBER_EVENTS) {
                html_markup(html, "<td class='number' data-events='%s'>%d</td>", row->path,
                            run_events(run, row->path));
                continue;
            }
            double value = run_number(run, row->path), bar = NAN;
            html_markup(html, "<td class='number' data-path='%s'>", row->path);
            if (row->kind != NUMBER_PLAIN) {
                double known_to = run_known_to(run, row->path, &bar);
                estimate_write(html, value, bar,
                               row->kind == NUMBER_LENGTH ? LENGTH_KNOWN_TO : known_to);
            } else if (isfinite(value)) {
                html_number(html, value, fabs(value) >= 1 && value == floor(value) ? 12 : 3);
            } else {
                html_markup(html, "none");
            }
            html_markup(html, "</td>");
        }
        html_markup(html, "<td class='meaning'>%s</td></tr>\n", row->meaning);
    }
}

static void begin_table(TextWriter *html, const char *caption, const RunSource *runs, int32_t count)
{
    html_markup(html,
                "<div class='wide'><table%s><caption>%s</caption><thead><tr><th scope='col'>"
                "quantity</th>",
                count == 1 ? " class='one'" : "", caption);
    for (int32_t k = 0; k < count; ++k) {
        html_around(html, "<th scope='col' class='number'>", count == 1 ? "value" : runs[k].name,
                    "</th>");
    }
    html_markup(html, "<th scope='col'>meaning</th></tr></thead><tbody>\n");
}

bool numbers_write(TextWriter *html, PageSource *source, Error *err)
{
    const RunSource *runs = source->runs;
    int32_t count = source->count;
    begin_table(html,
                "What was found. \u00b1 is 95 %; without it: down to the "
                "first digit that finer meshes change as a rule.",
                runs, count);
    write_rows(html, RESULTS, sizeof RESULTS / sizeof *RESULTS, runs, count);
    write_rows(html, EVENTS, sizeof EVENTS / sizeof *EVENTS, runs, count);
    html_markup(html, "</tbody></table></div>\n");
    begin_table(html, "Checks of the computation (largest of the run), and what it took", runs,
                count);
    write_rows(html, CHECKS, sizeof CHECKS / sizeof *CHECKS, runs, count);
    html_markup(html, "</tbody></table></div>\n");
    return error_is_clean(err);
}
