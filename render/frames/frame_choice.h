// SPDX-License-Identifier: GPL-2.0-or-later
// Which stored times a row of frames shows: close together where much happens, and one of each
// rapid event. Numbers only. Called by frames.
#ifndef AMONTONS_RENDER_FRAMES_FRAME_CHOICE_H
#define AMONTONS_RENDER_FRAMES_FRAME_CHOICE_H

#include "render/view/result_view.h"

// rows: [count] rows of the history that there are frames of, rising. chosen: [most] indices into
// rows, rising; returns how many, `most` at most and all where there are no more.
int32_t frames_choose(const ResultView *view, const int64_t *rows, int32_t count, int32_t most,
                      int32_t *chosen);

#endif
