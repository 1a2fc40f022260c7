// SPDX-License-Identifier: GPL-2.0-or-later
// Several runs side by side: their numbers, where their scenes differ, their force curves over each
// other.
#include "page/page.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/text/json_reader.h"

#include <string.h>

enum { WORDS_SIZE = 700 };

static bool write_curves(TextWriter *html, PageSource *source, Error *err)
{
    const RunSource *runs = source->runs;
    int32_t count = source->count;
    const char *folders[RENDER_CURVES_MAX], *names[RENDER_CURVES_MAX];
    bool drawn = true;
    int32_t with = 0;
    for (int32_t k = 0; k < count; ++k) {
        if (!runs[k].has_history) continue;
        folders[with] = runs[k].folder;
        names[with++] = runs[k].name;
    }
    if (with < count)
        html_markup(html,
                    "<p class='note'>%d of %d runs kept no history, and have no curve here.</p>\n",
                    count - with, count);
    if (with == 0) return true;
    RenderCurvesFunction render =
        (RenderCurvesFunction)module_function("render", "amontons_render_curves", err);
    if (!render || !render(folders, names, with, html, &drawn, err)) return false;
    if (!drawn)
        html_markup(html, "<p class='note'>Some runs are in SI units and some are normalised: "
                          "their curves have no common axis.</p>\n");
    return error_is_clean(err);
}

static bool write_again(TextWriter *html, PageSource *source, Error *err)
{
    html_markup(html, "<p>The report of each run holds its scene: ");
    html_markup(html, "<code>amontons report FOLDER</code>, with</p>\n<ul>");
    for (int32_t k = 0; k < source->count; ++k) {
        html_around(html, "<li>", source->runs[k].name, ": ");
        html_around(html, "", source->runs[k].title, "</li>");
    }
    html_markup(html, "</ul>\n");
    return error_is_clean(err);
}

bool compare_page_write(TextWriter *html, const char *const *folders, int32_t count, Error *err)
{
    const SheetPart parts[] = {{"numbers", "Key numbers", numbers_write},
                               {"differences", "What differs", scene_differences_write},
                               {"figures", "Force curves", write_curves},
                               {"again", "To reproduce", write_again},
                               SHEET_CITE,
                               {0}};
    char title[60], words[RUN_NAME_SIZE + WORDS_SIZE + 40], sentence[WORDS_SIZE];
    RunSource *runs = NEW_ARRAY(RunSource, count, err);
    PageSource source = {.runs = runs, .count = count};
    TRY(runs);
    if (count > RENDER_CURVES_MAX)
        FAIL(err, ERROR_INPUT, "%d runs: a comparison takes up to %d; a sweep takes many", count,
             RENDER_CURVES_MAX);
    for (int32_t k = 0; k < count; ++k) TRY(run_source_open(folders[k], &runs[k], err));

    // Folders of one name are told apart by the end of their paths.
    bool alike = false;
    for (int32_t k = 1; k < count; ++k)
        for (int32_t j = 0; j < k; ++j) alike = alike || strcmp(runs[j].name, runs[k].name) == 0;
    for (int32_t k = 0; alike && k < count; ++k) {
        size_t length = strlen(runs[k].folder);
        size_t cut = length < RUN_NAME_SIZE ? 0 : length - RUN_NAME_SIZE + 1;
        snprintf(runs[k].name, RUN_NAME_SIZE, "%s", runs[k].folder + cut);
    }

    // The head of the page says what is not complete, and what is to be doubted.
    snprintf(title, sizeof title, "Comparison of %d runs", count);
    sheet_begin(html, title, "Report by amontons", parts);
    for (int32_t k = 0; k < count; ++k) {
        const RunSource *run = &runs[k];
        if (run->state != RUN_DONE) {
            snprintf(words, sizeof words, "%s %s", run->name,
                     run->state == RUN_FAILED ? "failed: its own report says why"
                                              : "has not ended: it has no numbers yet");
            sheet_box(html, "failure", words);
        }
        for (int32_t w = 0; run_warning(run, w, sentence, sizeof sentence); ++w) {
            snprintf(words, sizeof words, "%s: %s", run->name, sentence);
            sheet_box(html, "warning", words);
        }
    }
    TRY(sheet_parts(html, parts, &source, err));
    sheet_end(html, runs[0].json);
cleanup:
    for (int32_t k = 0; runs && k < count; ++k) run_source_close(&runs[k]);
    memory_free(runs);
    return error_is_clean(err);
}
