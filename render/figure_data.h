// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of what a figure shows, beside its picture: figures/force.csv, and where measurements were
// given figures/force-compared.csv. Called by render.c.
#ifndef AMONTONS_RENDER_FIGURE_DATA_H
#define AMONTONS_RENDER_FIGURE_DATA_H

#include "render/figures/picture.h"

// Writes what the figure shows, of `force` also the events, and each measured value beside the
// computed one. field: the moments of profile.
bool figure_data_write(const char *folder, const Figure *figure, ResultView *view,
                       const FieldChoice *field, const char *compare, Error *err);

// Finds if the figure shows what the file has measured.
bool figure_data_measured(const Figure *figure, const char *compare, ResultView *view, bool *shows,
                          Error *err);

// Writes figures/misfit.csv: a row for each figure that shows what the file has measured.
bool figure_data_misfits(const char *folder, ResultView *view, const char *compare, Error *err);

#endif
