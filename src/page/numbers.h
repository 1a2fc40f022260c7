// SPDX-License-Identifier: GPL-2.0-or-later
// The key numbers of runs, a column each, with their errors. Called by run_page and compare_page.
#ifndef AMONTONS_PAGE_NUMBERS_H
#define AMONTONS_PAGE_NUMBERS_H

#include "page/sheet.h"

// Writes an estimate as text_estimate has it, and says so where nothing is known of its error.
void estimate_write(HtmlWriter *html, double value, double bar, double known_to);
// Error within which the result at `path` in run.json is known; NaN: not known. *bar: its error
// bar; NaN: none was asked for.
double run_known_to(const RunSource *run, const char *path, double *bar);

// Writes two tables, each with a caption: what was found, and how far the computation can be
// trusted. For a single run they also say what a number means.
bool numbers_write(HtmlWriter *html, PageSource *source, Error *err);

#endif
