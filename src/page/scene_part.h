// SPDX-License-Identifier: GPL-2.0-or-later
// The scenes of runs, from their run.json: what was computed, how scenes differ, the scene itself.
// Called by the pages.
#ifndef AMONTONS_PAGE_SCENE_PART_H
#define AMONTONS_PAGE_SCENE_PART_H

#include "page/sheet.h"

// A table with a row a group of keys, "material | young 1, poisson 0.34, ..."; then the whole scene
// as text, and as a file to save. What was saved can be run.
bool scene_write(HtmlWriter *html, PageSource *source, Error *err);

// Keys whose values are not the same in all scenes, a column a run.
bool scene_differences_write(HtmlWriter *html, PageSource *source, Error *err);

#endif
