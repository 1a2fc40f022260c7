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

enum { PARTS_MAX = 9, WORDS_SIZE = 700 };

static const SheetPart NUMBERS = {"numbers", "Key numbers"}, FILM = {"film", "Film"},
                       FRAMES = {"frames-part", "Frames"}, FIGURES = {"figures", "Figures"},
                       EVENTS = {"events", "Events"}, SCENE = {"scene", "Scene"},
                       AGAIN = {"again", "To reproduce"}, CITE = {"cite", "How to cite"};

static int32_t list_parts(const RunSource *run, bool film, SheetPart parts[PARTS_MAX])
{
    int32_t count = 0;
    if (run->state != RUN_UNFINISHED) parts[count++] = NUMBERS;
    if (run->has_history) parts[count++] = FRAMES;
    if (film) parts[count++] = FILM;
    if (run->has_history) parts[count++] = FIGURES;
    if (run->has_history) parts[count++] = EVENTS;
    if (run->state != RUN_UNFINISHED) parts[count++] = SCENE;
    if (run->state != RUN_UNFINISHED) parts[count++] = AGAIN;
    parts[count++] = CITE;
    parts[count] = (SheetPart){0};
    return count;
}

// What was computed, in two sentences.
static void write_lead(HtmlWriter *html, const RunSource *run)
{
    const char *unit = run->si ? "\u202fm" : "\u202f<i>L</i><sub>0</sub>";
    if (run->state == RUN_UNFINISHED) return;
    html_markup(html, "<p class='lead'>An elastic block, ");
    html_number(html, run_number(run, "model.length"), 4);
    html_markup(html, "%s long and ", unit);
    html_number(html, run_number(run, "model.height"), 4);
    html_markup(html,
                "%s high, is pressed on a rigid floor and pushed by a rod until it slides. "
                "Friction obeys Amontons\u2019 law at every point of the contact (law ",
                unit);
    char law[80] = "";
    json_find_text(run->json, "scene.friction.law", law, sizeof law);
    html_text(html, law);
    double mu = run_number(run, "scene.friction.mu_static");
    if (isfinite(mu)) {
        html_markup(html, ", <i>\u03bc</i><sub>S</sub> = ");
        html_number(html, mu, 4);
    }
    html_markup(html, ").");
    double mu_M = run_number(run, "results.mu_M");
    char is[160] = "";   // older results do not say
    json_find_text(run->json, "results.mu_M_is", is, sizeof is);
    bool steady = strcmp(is, "steady sliding") == 0;
    if (isfinite(mu_M)) {
        html_markup(html, " The block as a whole slides at <i>F</i><sub>T</sub>/<i>F</i>"
                          "<sub>N</sub> = <strong><i>\u03bc</i><sub>M</sub> = ");
        double bar = NAN, known_to = run_known_to(run, "results.mu_M", &bar);
        estimate_write(html, mu_M, bar, known_to);
        html_markup(html, "</strong>%s.",
                    steady        ? ", slowly and steadily: no sliding was fast"
                    : !isnan(bar) ? ""
                                  : " (in the digits that finer meshes keep as a rule; there is no "
                                    "error bar)");
    } else {
        bool told = strncmp(is, "none: ", 6) == 0;
        html_around(html, " There is no <i>\u03bc</i><sub>M</sub>: ",
                    told ? is + 6 : "the block as a whole did not slide after the start", ".");
    }
    html_markup(html, "</p>\n");
}

static void write_state(HtmlWriter *html, const RunSource *run)
{
    char words[WORDS_SIZE + ERROR_MESSAGE_SIZE], path[40], message[ERROR_MESSAGE_SIZE] = "";
    if (run->state == RUN_UNFINISHED) {
        snprintf(words, sizeof words,
                 "this run has not ended: it is under way, or was killed (there is no run.json). "
                 "Figures and frames show what it has stored so far; numbers, events and the "
                 "scene are written at its end.%s",
                 run->has_checkpoint ? " `amontons run SCENE -o FOLDER --resume` goes on with it."
                                     : "");
        sheet_box(html, "failure", words);
    }
    if (run->state == RUN_FAILED) {
        json_find_text(run->json, "message", message, sizeof message);
        snprintf(words, sizeof words, "this run failed: %s", message);
        sheet_box(html, "failure", words);
    }
    for (int32_t k = 0; k < RUN_WARNINGS_MAX; ++k) {
        snprintf(path, sizeof path, "warnings.%d", k);
        if (!json_find_text(run->json, path, words, sizeof words)) break;
        sheet_box(html, "warning", words);
    }
}

static bool write_scene(HtmlWriter *html, const RunSource *run, Error *err)
{
    sheet_part(html, &SCENE);
    scene_summary_write(html, run);
    return scene_text_write(html, run, err);
}

// The scene's mesh is named as seen from the result folder, so the scene is to be saved there.
static void write_again(HtmlWriter *html, const RunSource *run)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    bool is_plain = run->name[strspn(run->name, plain)] == 0;   // else: nothing for a shell
    sheet_part(html, &AGAIN);
    html_markup(html, "<p>Save the <a href='#scene'>scene</a> as scene.json in the result folder, "
                      "where its mesh is found. The same version gives the same bits.</p>\n"
                      "<pre tabindex='0'>");
    html_around(html, "cd ", is_plain ? run->name : "RESULT", "\n");
    html_around(html, "amontons run scene.json -o again", "", "    # the run\n");
    html_around(html, "amontons render . --format pdf", "", "      # its figures for print\n");
    html_around(html, "amontons report .", "", "                   # this page\n");
    html_markup(html, "</pre>\n");
}

static bool write_history(HtmlWriter *html, const RunSource *run, const char *film, Error *err)
{
    RenderFrames frames = {0};
    sheet_part(html, &FRAMES);
    if (!frames_write(html, run, &frames, err)) return false;
    if (film) sheet_part(html, &FILM);
    if (film && !film_write(html, run->folder, film, err)) return false;
    sheet_part(html, &FIGURES);
    if (!figures_write(html, run, err)) return false;
    sheet_part(html, &EVENTS);
    return events_write(html, run, &frames, err);
}

bool run_page_write(HtmlWriter *html, const char *folder, Error *err)
{
    RunSource run = {0};
    SheetPart parts[PARTS_MAX];
    char film[NAME_MAX + 1] = "", version[40] = "";
    TRY(run_source_open(folder, &run, err));
    bool has_film = film_find(folder, film);
    list_parts(&run, has_film, parts);
    sheet_begin(html, run.title, "Report of a run, by amontons", parts);
    write_lead(html, &run);
    write_state(html, &run);
    if (run.state != RUN_UNFINISHED) {
        sheet_part(html, &NUMBERS);
        numbers_write(html, &run, 1);
    }
    if (run.has_history) {
        TRY(write_history(html, &run, has_film ? film : NULL, err));
    } else {
        if (has_film) sheet_part(html, &FILM);
        if (has_film) TRY(film_write(html, folder, film, err));
    }
    if (run.state != RUN_UNFINISHED) {
        TRY(write_scene(html, &run, err));
        write_again(html, &run);
    }
    json_find_text(run.json, "version", version, sizeof version);
    sheet_end(html, version);
cleanup:
    run_source_close(&run);
    return error_is_clean(err);
}
