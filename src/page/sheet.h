// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the parts that all pages have: head, style, script, and at the end version and how to
// cite. Nothing is loaded from elsewhere, and the page's own policy forbids it: a page holds texts
// of others. Called by the pages.
#ifndef AMONTONS_PAGE_SHEET_H
#define AMONTONS_PAGE_SHEET_H

#include "page/run_source.h"
#include "render/render.h"

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
    bool (*write)(HtmlWriter *html, PageSource *source, Error *err);
} SheetPart;

extern const SheetPart SHEET_CITE;   // that part

// Writes the page up to the title, below it `kind` ("A run"), and links to the parts.
void sheet_begin(HtmlWriter *html, const char *title, const char *kind, const SheetPart *parts);
// All of them, each below its heading.
bool sheet_parts(HtmlWriter *html, const SheetPart *parts, PageSource *source, Error *err);
// json: run.json of what was computed, by whichever version; NULL: not known.
void sheet_end(HtmlWriter *html, const char *json);

// A box that is seen at once: "warning" or "failure".
void sheet_box(HtmlWriter *html, const char *kind, const char *words);

#endif
