// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the parts of a page that show a history: the slider's frames, the table of events that
// leads to them, and the figures. Called by run_page.
#ifndef AMONTONS_PAGE_HISTORY_PART_H
#define AMONTONS_PAGE_HISTORY_PART_H

#include "page/sheet.h"

bool figures_write(HtmlWriter *html, PageSource *source, Error *err);
bool frames_write(HtmlWriter *html, PageSource *source, Error *err);   // sets source->frames
bool events_write(HtmlWriter *html, PageSource *source, Error *err);

#endif
