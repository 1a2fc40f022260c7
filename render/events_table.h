// SPDX-License-Identifier: GPL-2.0-or-later
// Table of the events that count, a row each, beside the force curve: figures/events.csv. Called by
// figure_data.
#ifndef AMONTONS_RENDER_EVENTS_TABLE_H
#define AMONTONS_RENDER_EVENTS_TABLE_H

#include "render/view/result_view.h"

// Bounded rapid precursors and slidings of the whole block, whatever cycle is shown.
bool events_table_write(const char *path, ResultView *view, Error *err);

#endif
