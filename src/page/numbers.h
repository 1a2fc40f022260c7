// SPDX-License-Identifier: GPL-2.0-or-later
// The key numbers of runs, a column each, with their errors. Called by run_page and compare_page.
#ifndef AMONTONS_PAGE_NUMBERS_H
#define AMONTONS_PAGE_NUMBERS_H

#include "page/sheet.h"

// As text_estimate has it; that nothing is known of its error is said.
void estimate_write(HtmlWriter *html, double value, double bar, double known_to);
// Of the result at `path` in run.json; *bar: its error bar, NaN: none was asked for. NaN: unknown.
double run_known_to(const RunSource *run, const char *path, double *bar);

// What was found, and how far the computation can be trusted: two tables, each with a caption. Of
// one run they also say what a number means.
bool numbers_write(HtmlWriter *html, PageSource *source, Error *err);

#endif
