// SPDX-License-Identifier: GPL-2.0-or-later
// The three pages. Called by report.
#ifndef AMONTONS_PAGE_PAGES_H
#define AMONTONS_PAGE_PAGES_H

#include "io/text/html_writer.h"

// cycle: that the figures show; NULL: as they choose.
bool run_page_write(HtmlWriter *html, const char *folder, const char *cycle, Error *err);
bool sweep_page_write(HtmlWriter *html, const char *folder, Error *err);
bool compare_page_write(HtmlWriter *html, const char *const *folders, int32_t count, Error *err);

#endif
