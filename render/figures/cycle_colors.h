// SPDX-License-Identifier: GPL-2.0-or-later
// Colours that tell the cycles of a figure apart which shows all of them. Called by
// figure_precursors and figure_front_speed.
#ifndef AMONTONS_RENDER_FIGURES_CYCLE_COLORS_H
#define AMONTONS_RENDER_FIGURES_CYCLE_COLORS_H

#include "render/canvas/key.h"

// Entries that the key has at most, and room for their words.
enum { CYCLE_KEYS = 8, CYCLE_WORDS_SIZE = 48 };
typedef char CycleWords[CYCLE_KEYS][CYCLE_WORDS_SIZE];

// Colour of cycle number k, from 1, of `count`: up to eight colours of their own, beyond that from
// blue in the first to orange in the last.
Color cycle_color(int32_t k, int32_t count);

// Adds what the colours mean to the entries of a key; returns how many these are then. words: must
// outlive the entries.
int32_t cycle_key(int32_t count, CycleWords words, KeyEntry *entries, int32_t used);

#endif
