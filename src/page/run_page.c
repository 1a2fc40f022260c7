// SPDX-License-Identifier: GPL-2.0-or-later
// A run on a page, from the answer to how it was found.
#include "page/page.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/hdf5/result_file.h"
#include "io/text/json_reader.h"
#include "record/events.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum { PARTS_MAX = 8, WORDS_SIZE = 700 };
enum { EVENTS_SHOWN_MAX = 300, COLUMNS = 8, DIGITS = 5 };
static const double SLACK = 1e-9;   // of U: a time at the border of an event belongs to it

// --- the history --------------------------------------------------------------------------------

// Nothing of the history may cost the page: a picture that cannot be drawn is told in its place.
static bool go_on_without(TextWriter *html, const char *what, Error *err)
{
    char words[ERROR_MESSAGE_SIZE + 40];
    if (error_is_clean(err)) return true;
    if (err->code == ERROR_MEMORY || err->code == ERROR_LIBRARY) return false;
    snprintf(words, sizeof words, "no %s: %s", what, err->message);
    sheet_box(html, "failure", words);
    error_clear(err);
    return true;
}

static bool write_figures(TextWriter *html, PageSource *source, Error *err)
{
    static const char name[] = "figures/accuracy.json";
    const char *folder = source->runs->folder;
    RenderFiguresFunction render =
        (RenderFiguresFunction)module_function("render", "amontons_render_figures", err);
    if (render) render(folder, source->cycle, html, err);
    if (!go_on_without(html, "figures", err)) return false;

    // Draw runs over contact nodes where an error bar was asked for.
    if (!folder_holds(folder, name, NULL)) return true;
    RenderPlotHtmlFunction plot =
        (RenderPlotHtmlFunction)module_function("render", "amontons_render_plot_html", err);
    if (plot)
        plot(folder, name, "How the error bar was found: runs on finer and finer meshes.", html,
             err);
    return go_on_without(html, "figure of the error bar", err);
}

// --- frames --------------------------------------------------------------------------------------

// The slider's frames; sets source->frames, to which the table of events leads.
static bool write_frames(TextWriter *html, PageSource *source, Error *err)
{
    RenderFrames *found = &source->frames;
    RenderFramesFunction render =
        (RenderFramesFunction)module_function("render", "amontons_render_frames", err);
    if (!render) return false;
    html_markup(html, "<div class='controls' id='controls' hidden role='group' aria-label='Frames'>"
                      "<button type='button' id='back' aria-label='Frame before'>\u25c0</button>"
                      "<input type='range' id='slider' min='1' max='1' value='1' "
                      "aria-label='Frame'>"
                      "<button type='button' id='on' aria-label='Next frame'>\u25b6</button>"
                      "<button type='button' id='play' aria-pressed='false'>Play</button></div>\n"
                      "<p class='keys' id='keys' hidden>Arrow keys on the slider go from frame to "
                      "frame; links in the table of events lead here.</p>\n");
    if (render(source->runs->folder, html, found, err)) {
        html_markup(html,
                    "<p class='note'>%d of %d %s are shown, close together where the force "
                    "or the rod moves much%s. ",
                    found->count, found->stored,
                    found->fields ? "stored times" : "steps of the history",
                    found->fields ? "" : "; of the block it stored no fields, or too few");
        html_markup(html,
                    "Below the floor, or above the curves: the contact <span "
                    "class='swatch status1'></span> sticks, <span class='swatch status2'></span> "
                    "slips while friction weakens, <span class='swatch status3'></span> slips, "
                    "<span class='swatch status0'></span> is open. "
                    "<i>p</i>: contact pressure, <i>\u03c4</i>: friction stress, <i>v</i>: slip "
                    "rate; slower than <i>V</i>/100 is drawn at the edge.</p>\n");
    }
    return go_on_without(html, "frames", err);
}

// --- events --------------------------------------------------------------------------------------

enum { KIND, U_START, U_STOP, T_START, T_STOP, REACH, RATE, SPEED };

// A row an event; the last ones, where there are many: the first belong to the start.
static bool write_events(TextWriter *html, PageSource *source, Error *err)
{
    static const ResultTable names[COLUMNS] = {
        [KIND] = EVENTS_KIND,       [U_START] = EVENTS_U_START,  [U_STOP] = EVENTS_U_STOP,
        [T_START] = EVENTS_T_START, [T_STOP] = EVENTS_T_STOP,    [REACH] = EVENTS_REACH,
        [RATE] = EVENTS_PEAK_RATE,  [SPEED] = EVENTS_FRONT_SPEED};
    const RunSource *run = source->runs;
    const RenderFrames *frames = &source->frames;
    const char *length = run->si ? "m" : "<i>L</i><sub>0</sub>";
    const char *time = run->si ? "s" : "<i>t</i><sub>0</sub>";
    double *column[COLUMNS] = {0};   // [count] owned
    int32_t count = 0;
    ArrayFile *file = result_file_open(run->folder, err);
    TRY(file);
    TRY(result_file_read_tables(file, names, COLUMNS, column, &count, err));
    double block = result_file_number(file, NUMBER_LENGTH);
    double velocity = result_file_number(file, NUMBER_ROD_VELOCITY);
    int32_t first = count > EVENTS_SHOWN_MAX ? count - EVENTS_SHOWN_MAX : 0;
    if (count == 0) {
        html_markup(html, "<p>%s</p>\n",
                    run->state == RUN_UNFINISHED ? "Events are known at the end of a run."
                                                 : "None in this run.");
        goto cleanup;
    }
    if (first > 0)
        html_markup(html, "<p class='note'>The last %d of %d; all are in run.json.</p>\n",
                    count - first, count);
    html_markup(html, "<div class='wide'><table class='events'><caption>Slow and rapid slips that "
                      "come before sliding, and the sliding of the whole block</caption><thead><tr>"
                      "<th scope='col' class='number'>no.</th><th scope='col'>kind</th>");
    html_markup(html,
                "<th scope='col' class='number'><i>U</i> start, %s</th>"
                "<th scope='col' class='number'><i>U</i> stop, %s</th>"
                "<th scope='col' class='number'>duration, %s</th>"
                "<th scope='col' class='number'>reach / <i>L</i></th>",
                length, length, time);
    html_markup(html,
                "<th scope='col' class='number'>fastest slip / <i>V</i></th>"
                "<th scope='col' class='number'>speed of front, %s/%s</th>"
                "<th scope='col' class='number'>frame</th></tr></thead><tbody>\n",
                length, time);

    for (int32_t k = first; k < count; ++k) {
        double of_kind = column[KIND][k];
        const double shown[] = {column[U_START][k],
                                column[U_STOP][k],
                                column[T_STOP][k] - column[T_START][k],
                                column[REACH][k] / block,
                                column[RATE][k] / velocity,
                                column[SPEED][k]};
        html_markup(html, "<tr class='kind%d'><td class='number'>%d</td><td>%s</td>",
                    of_kind >= 0 && of_kind < EVENT_KIND_COUNT ? (int32_t)of_kind : -1, k + 1,
                    event_words(of_kind));
        for (size_t c = 0; c < sizeof shown / sizeof *shown; ++c) {
            html_markup(html, "<td class='number'>");
            html_number(html, shown[c], c < 2 ? DIGITS : 3);
            html_markup(html, "</td>");
        }

        // A link to the first frame within the event, else to the nearest one.
        double begin = column[U_START][k], end = column[U_STOP][k];
        double slack = SLACK * fabs(end), least = INFINITY;
        int32_t frame = 0;
        for (int32_t i = 0; i < frames->count; ++i) {
            double away = fmax(begin - slack - frames->U[i], frames->U[i] - end - slack);
            if (!(away > 0)) away = 0;
            if (!(away < least)) continue;
            least = away;
            frame = i;
        }
        html_markup(html, "<td class='number'>");
        if (frames->count > 0)
            html_markup(html, "<a href='#frame-%d'>%s%d</a>", frame + 1,
                        least == 0 ? "" : "nearest: ", frame + 1);
        html_markup(html, "</td></tr>\n");
    }
    html_markup(html, "</tbody></table></div>\n");
cleanup:
    if (file) array_file_close(file, err);
    memory_free_list((void *const *)column, COLUMNS);
    return go_on_without(html, "events", err);
}

// --- the page -----------------------------------------------------------------------------------

// The scene's mesh is named as seen from the result folder, so the scene is to be saved there.
static bool write_again(TextWriter *html, PageSource *source, Error *err)
{
    const RunSource *run = source->runs;
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    bool is_plain = run->name[strspn(run->name, plain)] == 0;   // else: nothing for a shell
    html_markup(html, "<p>Save the <a href='#scene'>scene</a> as scene.json in the result folder, "
                      "where its mesh is found. The same version gives the same bits.</p>\n"
                      "<pre tabindex='0'>");
    html_around(html, "cd ", is_plain ? run->name : "RESULT", "\n");
    html_around(html, "amontons run scene.json -o again", "", "    # the run\n");
    html_around(html, "amontons render . --format pdf", "", "      # its figures for print\n");
    html_around(html, "amontons report .", "", "                   # this page\n");
    html_markup(html, "</pre>\n");
    return error_is_clean(err);
}

bool run_page_write(TextWriter *html, const char *folder, const char *cycle, Error *err)
{
    RunSource run = {0};
    PageSource source = {.runs = &run, .count = 1, .cycle = cycle};
    SheetPart parts[PARTS_MAX] = {0};
    char words[WORDS_SIZE + ERROR_MESSAGE_SIZE], message[ERROR_MESSAGE_SIZE] = "";
    char law[80] = "", is[160] = "";   // older results do not say what mu_M is
    const char *unit = "\u202f<i>L</i><sub>0</sub>";
    int32_t count = 0;
    TRY(run_source_open(folder, &run, err));
    if (run.si) unit = "\u202fm";
    bool ended = run.state != RUN_UNFINISHED, history = run.has_history;
    if (ended) parts[count++] = (SheetPart){"numbers", "Key numbers", numbers_write};
    if (history) parts[count++] = (SheetPart){"frames-part", "Frames", write_frames};
    if (history) parts[count++] = (SheetPart){"figures", "Figures", write_figures};
    if (history) parts[count++] = (SheetPart){"events", "Events", write_events};
    if (ended) parts[count++] = (SheetPart){"scene", "Scene", scene_write};
    if (ended) parts[count++] = (SheetPart){"again", "To reproduce", write_again};
    parts[count++] = SHEET_CITE;
    sheet_begin(html, run.title, "Report of a run, by amontons", parts);

    // The lead says what was computed, and the answer.
    if (ended) {
        html_markup(html, "<p class='lead'>An elastic block, ");
        html_number(html, run_number(&run, "model.length"), 4);
        html_markup(html, "%s long and ", unit);
        html_number(html, run_number(&run, "model.height"), 4);
        html_markup(html,
                    "%s high, is pressed on a rigid floor and pushed by a rod until it slides. "
                    "Friction obeys Amontons\u2019 law at every point of the contact (law ",
                    unit);
        json_find_text(run.json, "scene.friction.law", law, sizeof law);
        html_text(html, law);
        double mu = run_number(&run, "scene.friction.mu_static");
        if (isfinite(mu)) {
            html_markup(html, ", <i>\u03bc</i><sub>S</sub> = ");
            html_number(html, mu, 4);
        }
        html_markup(html, ").");
        double mu_M = run_number(&run, "results.mu_M");
        json_find_text(run.json, "results.mu_M_is", is, sizeof is);
        bool steady = strcmp(is, "steady sliding") == 0;
        if (isfinite(mu_M)) {
            html_markup(html, " The block as a whole slides at <i>F</i><sub>T</sub>/<i>F</i>"
                              "<sub>N</sub> = <strong><i>\u03bc</i><sub>M</sub> = ");
            double bar = NAN, known_to = run_known_to(&run, "results.mu_M", &bar);
            estimate_write(html, mu_M, bar, known_to);
            html_markup(
                html, "</strong>%s.",
                steady ? ", slowly and steadily: no sliding was fast"
                : !isnan(bar)
                    ? ""
                    : " (down to the first digit that finer meshes change as a rule; there is no "
                      "error bar)");
        } else {
            bool told = strncmp(is, "none: ", 6) == 0;
            html_around(html, " There is no <i>\u03bc</i><sub>M</sub>: ",
                        told ? is + 6 : "the block as a whole did not slide after the start", ".");
        }
        html_markup(html, "</p>\n");
    }

    // Boxes say what is not complete, and what is to be doubted.
    if (!ended) {
        snprintf(words, sizeof words,
                 "this run has not ended: it is under way, or was killed (there is no run.json). "
                 "Figures and frames show what it has stored so far; numbers, events and the "
                 "scene are written at its end.%s",
                 run.has_checkpoint ? " `amontons run SCENE -o FOLDER --resume` goes on with it."
                                    : "");
        sheet_box(html, "failure", words);
    }
    if (run.state == RUN_FAILED) {
        json_find_text(run.json, "message", message, sizeof message);
        snprintf(words, sizeof words, "this run failed: %s", message);
        sheet_box(html, "failure", words);
    }
    for (int32_t k = 0; run_warning(&run, k, words, sizeof words); ++k)
        sheet_box(html, "warning", words);
    TRY(sheet_parts(html, parts, &source, err));
    sheet_end(html, run.json);
cleanup:
    run_source_close(&run);
    return error_is_clean(err);
}
