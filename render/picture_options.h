// SPDX-License-Identifier: GPL-2.0-or-later
// The options of a picture by their names, read and checked by the one table, PICTURE_OPTIONS.
// Called by run/result/pictures, for callers, by render/plot, for the `page` of a plot file, and by
// render/film and page/report.
#ifndef AMONTONS_RENDER_PICTURE_OPTIONS_H
#define AMONTONS_RENDER_PICTURE_OPTIONS_H

#include "amontons_pictures.h"
#include "base/error.h"

// Sets an option as amontons_picture_option does.
bool picture_option_set(PictureStyle *style, const char *name, const char *value, Error *err);

// An option that none of the `figures` [count] takes is refused: it would be given for nothing.
// `field` NULL: none. Of a plot file the figure is "plot".
bool picture_options_fit(const PictureStyle *style, const FieldChoice *field,
                         const char *const *figures, int32_t count, Error *err);

// The same of a film or a page.
bool picture_options_fit_taker(const PictureStyle *style, int32_t taker, Error *err);

// Sets the options that `style` leaves open to those of `base`.
void picture_style_complete(PictureStyle *style, const PictureStyle *base);

// One end of `limits`, 0 the lower: a number, or a part (of 1) of what is shown. NAN: none is
// asked.
double picture_limit(const PictureStyle *style, int32_t end, bool *is_part);

// Lines of a map of more points than this, on a grid, are those of medians of so many by so many
// points: each alone tells little there.
enum { MAP_MANY = 10000, MAP_MEDIANS = 7 };

#endif
