// SPDX-License-Identifier: GPL-2.0-or-later
// The scenes of runs, from their run.json: what was computed, how scenes differ, the scene itself.
// Called by the pages.
#ifndef AMONTONS_PAGE_SCENE_PART_H
#define AMONTONS_PAGE_SCENE_PART_H

#include "io/text/html_writer.h"
#include "page/run_source.h"

// A table with a row a group of keys: "material | young 1, poisson 0.34, ...".
void scene_summary_write(HtmlWriter *html, const RunSource *run);

// Keys whose values are not the same in all scenes, a column a run.
void scene_differences_write(HtmlWriter *html, const RunSource *runs, int32_t count);

// The whole scene as text, and as a file to save. What was saved can be run.
bool scene_text_write(HtmlWriter *html, const RunSource *run, Error *err);

#endif
