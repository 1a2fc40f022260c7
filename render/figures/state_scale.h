// SPDX-License-Identifier: GPL-2.0-or-later
// The states of friction that remembers, and the colours that they have: powers of ten where they
// span decades, else a linear scale. Called by the state map, the contact plane and the film.
#ifndef AMONTONS_RENDER_FIGURES_STATE_SCALE_H
#define AMONTONS_RENDER_FIGURES_STATE_SCALE_H

#include "render/view/result_view.h"
#include "render/figures/value_range.h"

// Name and unit of that state; `name` is what the words stand in.
ValueWords state_words(const ResultView *view, char name[VIEW_STATE_SIZE]);

// The bar of states [rows * nodes] while U is from range[0] to range[1], all counted alike.
bool state_scale(const ResultView *view, const double range[2], const double *states,
                 const PictureStyle *style, Colorbar *bar, Error *err);

#endif
