// SPDX-License-Identifier: GPL-2.0-or-later
// Pages about results, report.html: what a page knows of a run, the parts that several pages have,
// and the three pages. page/report calls these.
#ifndef AMONTONS_PAGE_PAGE_H
#define AMONTONS_PAGE_PAGE_H

#include "amontons.h"
#include "render/render.h"

// --- a run --------------------------------------------------------------------------------------

// A run's result folder as a page sees it: what there is of it, and the values of its run.json.
enum { RUN_NAME_SIZE = 120, RUN_TITLE_SIZE = 600 };

typedef enum RunState { RUN_DONE, RUN_FAILED, RUN_UNFINISHED } RunState;

typedef struct RunSource {
    char folder[AMONTONS_PATH_SIZE];
    char name[RUN_NAME_SIZE];   // the folder's own
    char title[RUN_TITLE_SIZE];   // of the scene; where it has none the folder's name
    char *json;   // run.json; "{}" where there is none; owned
    RunState state;
    bool has_history, has_checkpoint, si;
} RunSource;

// ERROR_INPUT: the folder holds nothing of a run.
bool run_source_open(const char *folder, RunSource *source, Error *err);
void run_source_close(RunSource *source);   // zeroed is fine

// The number at `path` in run.json; NaN: there is none, or the source is zeroed.
double run_number(const RunSource *source, const char *path);
// Its k-th warning; false: there is none.
bool run_warning(const RunSource *source, int32_t k, char *words, int32_t size);
// Number of events of this kind, "leading rapid".
int32_t run_events(const RunSource *source, const char *kind);

// True if `folder` holds `name`, and no link leads there; the path, where one is wanted, has
// PATH_MAX bytes.
bool folder_holds(const char *folder, const char *name, char *path);
// The last part of a path: "fig1" of "results/fig1/".
void folder_name(const char *folder, char name[RUN_NAME_SIZE]);

// --- the sheet ----------------------------------------------------------------------------------

// Parts that all pages have: head, style, script, and at the end version and how to cite. Nothing
// is loaded from elsewhere, and the page's own policy forbids it: a page holds texts of others.

// Subject of a page, and what one part of it has found for another.
typedef struct PageSource {
    const RunSource
        *runs;   // [count] one, several side by side, or of a sweep the first that is done
    int32_t count;
    const char *cycle;   // that figures of one cycle show; NULL: as they choose
    RenderFrames frames;   // the table of events leads to them
    const struct SweepSource *sweep;   // NULL: it is no sweep
} PageSource;

typedef struct SheetPart {
    const char *id, *name;   // of a section, for the links at the top; NULL ends a list
    // NULL: it is part of sheet_end
    bool (*write)(TextWriter *html, PageSource *source, Error *err);
} SheetPart;

extern const SheetPart SHEET_CITE;   // that part

// Writes the page up to the title, below it `kind` ("A run"), and links to the parts.
void sheet_begin(TextWriter *html, const char *title, const char *kind, const SheetPart *parts);
// All of them, each below its heading.
bool sheet_parts(TextWriter *html, const SheetPart *parts, PageSource *source, Error *err);
// json: run.json of what was computed, by whichever version; NULL: not known.
void sheet_end(TextWriter *html, const char *json);

// A box that is seen at once: "warning" or "failure".
void sheet_box(TextWriter *html, const char *kind, const char *words);

// --- numbers and scenes -------------------------------------------------------------------------

// Writes an estimate as text_estimate has it, and says so where nothing is known of its error.
void estimate_write(TextWriter *html, double value, double bar, double known_to);
// Error within which the result at `path` in run.json is known; NaN: not known. *bar: its error
// bar; NaN: none was asked for.
double run_known_to(const RunSource *run, const char *path, double *bar);

// Writes two tables, each with a caption: what was found, and how far the computation can be
// trusted. For a single run they also say what a number means.
bool numbers_write(TextWriter *html, PageSource *source, Error *err);

// A table with a row a group of keys, "material | young 1, poisson 0.34, ..."; then the whole scene
// as text, and as a file to save. What was saved can be run.
bool scene_write(TextWriter *html, PageSource *source, Error *err);

// Keys whose values are not the same in all scenes, a column a run.
bool scene_differences_write(TextWriter *html, PageSource *source, Error *err);

// --- the three pages ----------------------------------------------------------------------------

// cycle: that the figures show; NULL: as they choose.
bool run_page_write(TextWriter *html, const char *folder, const char *cycle, Error *err);
bool sweep_page_write(TextWriter *html, const char *folder, Error *err);
bool compare_page_write(TextWriter *html, const char *const *folders, int32_t count, Error *err);

#endif
