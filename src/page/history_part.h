// SPDX-License-Identifier: GPL-2.0-or-later
// What a page shows of a history: the slider's frames, the table of events that leads to them, the
// figures, and a film if one lies in the folder. Called by run_page.
#ifndef AMONTONS_PAGE_HISTORY_PART_H
#define AMONTONS_PAGE_HISTORY_PART_H

#include "page/run_source.h"
#include "page/sheet.h"
#include "render/render.h"

bool figures_write(HtmlWriter *html, const RunSource *run, Error *err);
bool frames_write(HtmlWriter *html, const RunSource *run, RenderFrames *found, Error *err);
// frames: as frames_write found them.
bool events_write(HtmlWriter *html, const RunSource *run, const RenderFrames *frames, Error *err);

// Whether there is one: *.mp4, *.webm or *.gif; its name has NAME_MAX + 1 bytes.
bool film_find(const char *folder, char *name);
bool film_write(HtmlWriter *html, const char *folder, const char *name, Error *err);

#endif
