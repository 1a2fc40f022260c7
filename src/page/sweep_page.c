// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep on a page, from its tables: figures, ranking, all points, and what failed or warned.
#include "page/page.h"

#include "base/memory.h"
#include "base/module.h"
#include "base/text.h"
#include "io/files/folder.h"
#include "io/files/text_file.h"
#include "io/hdf5/array_file.h"
#include "io/text/csv_reader.h"
#include "io/text/json_reader.h"
#include "study/sweep/showing/warned.h"

#include <dirent.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 300, SENTENCE_SIZE = 8 * RUN_WARNING_SIZE, ANSWER_BYTES_MAX = 1 << 22 };
enum { ROWS_MAX = 500, RANKED_MAX = 30, VALUES_SHOWN = 14, FIGURES_MAX = 20 };

typedef struct SweepSource {
    const char *folder;
    CsvTable table;   // owned, like all
    CsvTable ranking;   // no columns: none
    bool *is_key;   // [table.columns] of the scene
    bool *varies;   // [table.columns] a key that has several values
    char title[RUN_TITLE_SIZE];
    int32_t done, failed;   // of table.rows
    RunSource run;   // of the first point that is done, or none
    struct dirent **figures;   // [figure_count] descriptions in its folder of figures
    int figure_count;   // -1: there is no such folder
} SweepSource;

static int is_description(const struct dirent *entry)
{
    return text_ends_with(entry->d_name, ".json");
}

static void sweep_close(SweepSource *sweep)
{
    csv_destroy(&sweep->table);
    csv_destroy(&sweep->ranking);
    memory_free_all(sweep->is_key, sweep->varies);
    run_source_close(&sweep->run);
    for (int k = 0; k < sweep->figure_count; ++k) free(sweep->figures[k]);
    free(sweep->figures);
    *sweep = (SweepSource){0};
}

static bool sweep_open(const char *folder, SweepSource *sweep, Error *err)
{
    char path[PATH_MAX], name[NAME_SIZE];
    CsvTable *table = &sweep->table;
    ArrayFile *file = NULL;
    *sweep = (SweepSource){.folder = folder};
    snprintf(path, sizeof path, "%s/figures", folder);
    sweep->figure_count = scandir(path, &sweep->figures, is_description, alphasort);
    snprintf(path, sizeof path, "%s/sweep.csv", folder);
    TRY(csv_read(path, table, err));
    TRY(sweep->is_key = NEW_ARRAY(bool, table->columns, err));
    TRY(sweep->varies = NEW_ARRAY(bool, table->columns, err));

    // Which columns are keys, and the title, stand in sweep.h5 only.
    folder_name(folder, sweep->title);
    if (folder_holds(folder, "sweep.h5", path)) {
        TRY(file = array_file_open(path, err));
        Error absent = {0};
        if (!array_file_get_text(file, "title", name, sizeof name, &absent)) *name = 0;
        if (*name) snprintf(sweep->title, sizeof sweep->title, "%s", name);
    }
    for (int32_t k = 0; file && k < table->columns; ++k) {
        snprintf(name, sizeof name, "scene/%.200s", csv_name(table, k));
        sweep->is_key[k] = array_file_has(file, name);
        for (int32_t row = 1; row < table->rows && sweep->is_key[k] && !sweep->varies[k]; ++row)
            sweep->varies[k] = strcmp(csv_cell(table, row, k), csv_cell(table, 0, k)) != 0;
    }
    int32_t status = csv_column(table, "status"), run = csv_column(table, "run");
    if (status < 0 || run < 0)
        FAIL(err, ERROR_INPUT, "%s/sweep.csv is no table of a sweep", folder);
    for (int32_t row = 0; row < sweep->table.rows; ++row) {
        const char *word = csv_cell(&sweep->table, row, status);
        bool done = strcmp(word, "done") == 0;
        sweep->failed += strcmp(word, "failed") == 0;
        sweep->done += done;
        if (!done || sweep->run.json) continue;
        snprintf(path, sizeof path, "%.200s", csv_cell(&sweep->table, row, run));
        TRY(folder_check_inside(folder, path, err));
        if (!folder_holds(folder, path, NULL)) continue;   // `keep: table`
        snprintf(path, sizeof path, "%s/%.200s", folder, csv_cell(&sweep->table, row, run));
        TRY(run_source_open(path, &sweep->run, err));
    }
    if (folder_holds(folder, "ranking.csv", path)) TRY(csv_read(path, &sweep->ranking, err));
cleanup:
    if (file) array_file_close(file, err);
    if (!error_is_clean(err)) sweep_close(sweep);
    return error_is_clean(err);
}

// --- what varies ---------------------------------------------------------------------------------

static bool write_varied(TextWriter *html, PageSource *source, Error *err)
{
    const SweepSource *sweep = source->sweep;
    html_markup(html, "<div class='wide'><table><caption>Keys of the scene that differ from point "
                      "to point</caption><tbody>\n");
    for (int32_t k = 0; k < sweep->table.columns; ++k) {
        if (!sweep->varies[k]) continue;
        html_around(html, "<tr><th scope='row'>", csv_name(&sweep->table, k), "</th><td>");

        // The different values of the key, in the order of the table.
        const char *shown[VALUES_SHOWN];
        int32_t different = 0;
        for (int32_t row = 0; row < sweep->table.rows && different <= VALUES_SHOWN; ++row) {
            const char *cell = csv_cell(&sweep->table, row, k);
            bool seen = false;
            for (int32_t i = 0; i < different && !seen; ++i) seen = strcmp(shown[i], cell) == 0;
            if (seen) continue;
            html_markup(html, "%s", different ? ", " : "");
            if (different == VALUES_SHOWN)
                html_markup(html, "\u2026");
            else
                html_text(html, cell);
            if (different < VALUES_SHOWN) shown[different] = cell;
            ++different;
        }
        html_markup(html, "</td></tr>\n");
    }
    html_markup(html, "</tbody></table></div>\n");
    return error_is_clean(err);
}

// --- figures -------------------------------------------------------------------------------------

static bool write_figures(TextWriter *html, PageSource *source, Error *err)
{
    const SweepSource *sweep = source->sweep;
    char path[PATH_MAX], caption[RUN_NAME_SIZE];
    RenderPlotHtmlFunction render =
        (RenderPlotHtmlFunction)module_function("render", "amontons_render_plot_html", err);
    for (int k = 0; render && k < sweep->figure_count && k < FIGURES_MAX; ++k) {
        Error here = {0};
        const char *name = sweep->figures[k]->d_name;
        bool ranking = strcmp(name, "ranking.json") == 0;
        snprintf(path, sizeof path, "figures/%s", name);
        snprintf(caption, sizeof caption, "%s",
                 ranking ? "The ranking. Bars: 95 %. Open marks: see the legend."
                         : "The points of the sweep. Bars: 95 %. Open marks: see the legend.");
        if (!render(sweep->folder, path, caption, html, &here))
            sheet_box(html, "failure", here.message);
    }
    return error_is_clean(err);
}

// --- of a search ---------------------------------------------------------------------------------

// Its answer in words, and a picture of the best design's mesh.
static bool write_answer(TextWriter *html, PageSource *source, Error *err)
{
    const SweepSource *sweep = source->sweep;
    char path[PATH_MAX], *text = NULL, *picture = NULL;
    int32_t size = 0;
    if (!folder_holds(sweep->folder, "answer.txt", path)) return true;
    TRY(text_file_read(path, ANSWER_BYTES_MAX, &text, &size, err));
    html_around(html, "<pre tabindex='0'>", text, "</pre>\n");
    if (!folder_holds(sweep->folder, "figures/best.png", path)) goto cleanup;
    TRY(text_file_bytes(path, ANSWER_BYTES_MAX, &picture, &size, err));
    html_markup(html, "<figure><img alt='mesh and rod of the best design' src='");
    html_data(html, "image/png", picture, size);
    html_markup(html, "'><figcaption>The best design: its mesh, and the rod.</figcaption>"
                      "</figure>\n");
cleanup:
    memory_free_all(text, picture);
    return error_is_clean(err);
}

// --- tables --------------------------------------------------------------------------------------

// The column NAME_error or NAME_known_to beside NAME; -1: there is none.
static int32_t column_beside(const CsvTable *table, int32_t column, const char *ending)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "%.200s_%s", csv_name(table, column), ending);
    return csv_column(table, name);
}

// Errors stand beside their values; what a run took and how exact it was is for sweep.csv.
static bool is_shown(const SweepSource *sweep, const CsvTable *table, int32_t column)
{
    static const char *const left_out[] = {
        "steps",        "unsolved",        "solve_s", "total_s",   "energy_error", "contact_error",
        "moment_error", "reduction_error", "run",     "rank_from", "rank_to",      "message",
        "warnings",     "spread",          "low",     "high"};
    static const char *const endings[] = {"_error", "_known_to"};
    const char *name = csv_name(table, column);
    char value[NAME_SIZE];
    int32_t key = csv_column(&sweep->table, name);
    if (key >= 0 && sweep->is_key[key]) return sweep->varies[key];
    for (size_t k = 0; k < sizeof left_out / sizeof *left_out; ++k)
        if (strcmp(name, left_out[k]) == 0) return false;
    for (int32_t k = 0; k < 2; ++k) {
        snprintf(value, sizeof value, "%s", name);
        char *end = text_ends_with(name, endings[k]) ? strstr(value, endings[k]) : NULL;
        if (end) *end = 0;
        if (end && csv_column(table, value) >= 0) return false;
    }
    return true;
}

// Each cell is a number with its error bar, where there is one, or in the digits that are known; or
// a text.
static void write_table(TextWriter *html, const SweepSource *sweep, const CsvTable *table,
                        int32_t most, const char *caption)
{
    html_markup(html, "<div class='wide'><table><caption>%s</caption><thead><tr>", caption);
    for (int32_t k = 0; k < table->columns; ++k) {
        if (!is_shown(sweep, table, k)) continue;
        html_around(html, "<th scope='col'>", csv_name(table, k), "</th>");
    }
    html_markup(html, "</tr></thead><tbody>\n");
    for (int32_t row = 0; row < table->rows && row < most; ++row) {
        html_markup(html, "<tr>");
        for (int32_t k = 0; k < table->columns; ++k) {
            if (!is_shown(sweep, table, k)) continue;
            double value = csv_value(table, row, k);
            int32_t beside = column_beside(table, k, "error");
            int32_t known = column_beside(table, k, "known_to");
            if (isfinite(value) || (beside >= 0 && !*csv_cell(table, row, k))) {
                double error = csv_value(table, row, beside);
                double known_to = known >= 0    ? csv_value(table, row, known)
                                  : beside >= 0 ? error
                                                : 0;
                html_markup(html, "<td class='number'>");
                estimate_write(html, value, error == known_to ? error : (double)NAN, known_to);
            } else {
                html_markup(html, "<td>");
                html_text(html, csv_cell(table, row, k));
            }
            html_markup(html, "</td>");
        }
        html_markup(html, "</tr>\n");
    }
    html_markup(html, "</tbody></table></div>\n");
}

static bool write_ranking(TextWriter *html, PageSource *source, Error *err)
{
    const SweepSource *sweep = source->sweep;
    int32_t rows = sweep->ranking.rows, shown = rows < RANKED_MAX ? rows : RANKED_MAX;
    char caption[160];
    snprintf(caption, sizeof caption, "%d of %d points in order; all in ranking.csv", shown, rows);
    write_table(html, sweep, &sweep->ranking, RANKED_MAX, caption);
    return error_is_clean(err);
}

static bool write_points(TextWriter *html, PageSource *source, Error *err)
{
    const SweepSource *sweep = source->sweep;
    int32_t rows = sweep->table.rows, shown = rows < ROWS_MAX ? rows : ROWS_MAX;
    char caption[160];
    snprintf(caption, sizeof caption,
             "%d of %d points, with \u00b1 where there is an error bar; more columns in sweep.csv",
             shown, rows);
    if (run_number(&sweep->run, "scene.accuracy.mu") == 0)
        html_markup(
            html, "<p class='note'>mu down to the first digit that finer meshes change as a rule; "
                  "<code>set: {accuracy.mu: 1%%}</code> in the study asks for error bars.</p>\n");
    write_table(html, sweep, &sweep->table, ROWS_MAX, caption);
    return error_is_clean(err);
}

// --- failures and warnings -----------------------------------------------------------------------

static bool write_doubts(TextWriter *html, PageSource *source, Error *err)
{
    const SweepSource *sweep = source->sweep;
    const CsvTable *table = &sweep->table;
    int32_t status = csv_column(table, "status"), message = csv_column(table, "message");
    Warned warned = {0};
    char *words = NULL, sentence[SENTENCE_SIZE];
    size_t size = 0;
    FILE *lines = NULL;
    if (sweep->failed > 0) {
        html_markup(html, "<div class='wide'><table><caption>Points that failed</caption><thead>"
                          "<tr><th scope='col'>point</th><th scope='col'>why</th></tr></thead>"
                          "<tbody>\n");
        for (int32_t row = 0; row < table->rows; ++row) {
            if (strcmp(csv_cell(table, row, status), "failed") != 0) continue;
            html_markup(html, "<tr><th scope='row'>%d</th><td>", row);
            html_text(html, csv_cell(table, row, message));
            html_markup(html, "</td></tr>\n");
        }
        html_markup(html, "</tbody></table></div>\n");
    } else {
        html_markup(html, "<p>No point failed.</p>\n");
    }

    // Warnings of all points together. Sentences of one cell have // between them.
    TRY(warned_make(table->rows, &warned, err));
    int32_t column = csv_column(table, "warnings");
    for (int32_t row = 0; row < table->rows; ++row) {
        for (const char *cell = csv_cell(table, row, column); *cell;) {
            const char *end = strstr(cell, " // ");
            size_t length = end ? (size_t)(end - cell) : strlen(cell);
            snprintf(sentence, sizeof sentence, "%.*s",
                     (int)(length < RUN_WARNING_SIZE ? length : RUN_WARNING_SIZE - 1), cell);
            warned_add(&warned, row, sentence);
            cell += end ? length + 4 : length;
        }
    }
    if (warned.count == 0) goto cleanup;
    if (!(lines = open_memstream(&words, &size)))
        FAIL(err, ERROR_MEMORY, "no memory for the warnings");
    warned_print(&warned, lines);
    fclose(lines);
    sheet_box(html, "warning", words);
cleanup:
    free(words);
    warned_destroy(&warned);
    return error_is_clean(err);
}

// --- the page ------------------------------------------------------------------------------------

static bool write_scene(TextWriter *html, PageSource *source, Error *err)
{
    html_markup(html, "<p>That of the first point that is done; the others differ in the keys "
                      "above.</p>\n");
    return scene_write(html, source, err);
}

static bool write_again(TextWriter *html, PageSource *source, Error *err)
{
    const char *folder = source->sweep->folder;
    const char *command = folder_holds(folder, "fit.csv", NULL)      ? "fit"
                          : folder_holds(folder, "answer.txt", NULL) ? "optimise"
                                                                     : "sweep";
    html_markup(html,
                "<p>The study\u2019s file is not kept with its results. With it, and the same "
                "version, each point has the same bits again:</p>\n<pre tabindex='0'>amontons "
                "%s STUDY.yaml -o again\n</pre>\n<p>The scene of each point stands in its "
                "points/.../run.json, which sweep.csv names.</p>\n",
                command);
    return error_is_clean(err);
}

bool sweep_page_write(TextWriter *html, const char *folder, Error *err)
{
    SweepSource sweep = {0};
    PageSource source = {.runs = &sweep.run, .count = 1, .sweep = &sweep};
    SheetPart parts[10] = {0};
    int32_t count = 0;
    bool search = folder_holds(folder, "answer.txt", NULL);
    char words[160];
    TRY(sweep_open(folder, &sweep, err));
    int32_t rows = sweep.table.rows;
    if (search) parts[count++] = (SheetPart){"answer", "The answer", write_answer};
    parts[count++] = (SheetPart){"varied", "What varies", write_varied};
    if (sweep.figure_count > 0) parts[count++] = (SheetPart){"figures", "Figures", write_figures};
    if (sweep.ranking.columns > 0)
        parts[count++] = (SheetPart){"ranking", "Ranking", write_ranking};
    parts[count++] = (SheetPart){"points", "All points", write_points};
    parts[count++] = (SheetPart){"doubts", "Failures and warnings", write_doubts};
    if (sweep.run.json) parts[count++] = (SheetPart){"scene", "A scene", write_scene};
    parts[count++] = (SheetPart){"again", "To reproduce", write_again};
    parts[count] = SHEET_CITE;
    sheet_begin(html, sweep.title,
                search ? "Report of a search, by amontons" : "Report of a sweep, by amontons",
                parts);
    html_markup(html,
                "<p class='lead'>%d runs of an elastic block that is pressed on a rigid floor "
                "and pushed by a rod until it slides",
                rows);
    if (sweep.run.json) html_around(html, " (", sweep.run.title, ")");
    html_markup(html, ".</p>\n");
    if (sweep.done < rows) {
        snprintf(words, sizeof words,
                 "%d of %d points are done, %d failed, %d are not computed yet", sweep.done, rows,
                 sweep.failed, rows - sweep.done - sweep.failed);
        sheet_box(html, "failure", words);
    }
    TRY(sheet_parts(html, parts, &source, err));
    sheet_end(html, sweep.run.json);
cleanup:
    sweep_close(&sweep);
    return error_is_clean(err);
}
