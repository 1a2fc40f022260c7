// SPDX-License-Identifier: GPL-2.0-or-later
// The key numbers of runs, a column each, with their errors. Called by run_page and compare_page.
#ifndef AMONTONS_PAGE_NUMBERS_H
#define AMONTONS_PAGE_NUMBERS_H

#include "io/text/html_writer.h"
#include "page/run_source.h"

// "0.3275 +- 0.0001", to the error's second digit. NaN: none, and where the value has an error that
// is not known, that is said.
void estimate_write(HtmlWriter *html, double value, double error, bool has_error);

// What was found, and how far the computation can be trusted: two tables, each with a caption. Of
// one run they also say what a number means.
void numbers_write(HtmlWriter *html, const RunSource *runs, int32_t count);

#endif
