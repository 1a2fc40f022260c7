// SPDX-License-Identifier: GPL-2.0-or-later
// A run on a page, from the answer to how it was found.
#include "page/pages.h"

#include "io/text/json_reader.h"
#include "page/history_part.h"
#include "page/numbers.h"
#include "page/scene_part.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum { PARTS_MAX = 8, WORDS_SIZE = 700 };

// The scene's mesh is named as seen from the result folder, so the scene is to be saved there.
static bool write_again(HtmlWriter *html, PageSource *source, Error *err)
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

bool run_page_write(HtmlWriter *html, const char *folder, const char *cycle, Error *err)
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
    if (history) parts[count++] = (SheetPart){"frames-part", "Frames", frames_write};
    if (history) parts[count++] = (SheetPart){"figures", "Figures", figures_write};
    if (history) parts[count++] = (SheetPart){"events", "Events", events_write};
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
