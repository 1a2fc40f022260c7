// SPDX-License-Identifier: GPL-2.0-or-later
// What all pages have: head, style, script, and at the end version and how to cite. Nothing is
// loaded from elsewhere, and the page's own policy forbids it: a page holds texts of others.
// Called by the pages.
#ifndef AMONTONS_PAGE_SHEET_H
#define AMONTONS_PAGE_SHEET_H

#include "io/text/html_writer.h"

typedef struct SheetPart {
    const char *id, *name;   // of a section, for the links at the top; NULL ends a list
} SheetPart;

// Up to the title, below it `kind` ("A run"), and links to the parts.
void sheet_begin(HtmlWriter *html, const char *title, const char *kind, const SheetPart *parts);
// A section with its heading; ends the one before.
void sheet_part(HtmlWriter *html, const SheetPart *part);
// made_by: version of the program that computed; empty: not known.
void sheet_end(HtmlWriter *html, const char *made_by);

// A box that is seen at once: "warning" or "failure".
void sheet_box(HtmlWriter *html, const char *kind, const char *words);

#endif
