// SPDX-License-Identifier: GPL-2.0-or-later
// Which pad lets go first, and when: in each cycle, read off the statuses of a history. Called by
// figure_data.
#ifndef AMONTONS_RENDER_FIGURES_FIGURE_PADS_H
#define AMONTONS_RENDER_FIGURES_FIGURE_PADS_H

#include "render/view/result_view.h"

enum { PAD_WORDS_SIZE = 64 };

// One pad in one cycle. NaN, order 0: it did not happen, or not before the sliding.
typedef struct PadCourse {
    int32_t cycle, pad;   // from 1, from 0
    double U_first_slip;   // where some of it slips, length
    double U_let_go;   // where each of its nodes had slipped since it stuck, or was open; length
    double mu_let_go;   // F_T/F_N there
    int32_t order;   // of letting go, from 1; pads that let go in the same step share it
} PadCourse;

typedef struct PadCourses {
    int32_t pads, count;
    PadCourse *list;   // [count] cycle by cycle, pads by number; owned
} PadCourses;

void pad_words(const ResultView *view, int32_t pad, char words[PAD_WORDS_SIZE]);   // its name

// All cycles that ended in a sliding; without one the whole history is the first. In space only
// nodes of the line that is shown are looked at.
bool pad_courses_read(ResultView *view, PadCourses *courses, Error *err);
void pad_courses_destroy(PadCourses *courses);   // zeroed is fine

#endif
