// SPDX-License-Identifier: GPL-2.0-or-later
// Which pad lets go first: a line a pad, against U, from where some of it slips to where all of it
// has let go, with its number in the order; of one cycle, or of all.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/figures/pad_data.h"
#include "render/figures/stack.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

enum { NAMES_MAX = 40 };

static const double RIGHT_MARGIN = 10;   // points: half a number
static const double BESIDE = 0.06;   // of what is shown, on either side
static const double NUMBER_GAP = 3;   // points: from the mark to its number
static const double LINE_WIDTH = 2.5;   // points

static bool is_shown(const PadCourse *course, const Zoom *zoom)
{
    return !zoom->found || zoom->cycle == 0 || course->cycle == zoom->cycle;
}

static void course_draw(const Page *page, const Axes *axes, const PadCourse *course)
{
    double y = course->pad + 1;
    Stroke stroke = {.color = FIGURE_CURVE, .width = LINE_WIDTH * page->point};
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK, .up = 0.5};
    char number[16];
    if (isnan(course->U_first_slip)) return;
    double end = isnan(course->U_let_go) ? axes->x.high : course->U_let_go;
    canvas_clip(page->canvas, &axes->box);
    draw_segment(page->canvas, &stroke, axes_place(axes, course->U_first_slip, y),
                 axes_place(axes, end, y));
    canvas_clip(page->canvas, NULL);
    if (course->order == 0) return;
    Point at = axes_place(axes, end, y);
    draw_disc(page->canvas, INK, at, 1.5 * KEY_RADIUS * page->point);
    snprintf(number, sizeof number, "%d", course->order);
    at.x += NUMBER_GAP * page->point;
    text_draw(page->text, &style, at, number);
}

bool figure_pads_shows(const ResultView *view)
{
    return result_view_pads(view) > 1;
}

bool figure_pads(Page *page, const FigureInput *input, Error *err)
{
    ResultView *view = input->view;
    PageDef def = input->def;
    PadCourses courses = {0};
    Axes axes = {0};
    char(*names)[AXIS_LABEL_SIZE] = NULL;
    double low = INFINITY, high = -INFINITY;
    Zoom zoom = zoom_choose(view);
    TRY(pad_courses_read(view, &courses, err));
    if (courses.pads < 2 || courses.pads > NAMES_MAX)
        FAIL(err, ERROR_INPUT, "the contact has %d piece%s: 2 to %d are told apart", courses.pads,
             courses.pads == 1 ? "" : "s", NAMES_MAX);
    TRY(names = memory_array(courses.pads, sizeof *names, err));
    for (int32_t k = 0; k < courses.count; ++k) {
        if (!is_shown(&courses.list[k], &zoom)) continue;
        stack_widen(courses.list[k].U_first_slip, &low, &high);
        stack_widen(courses.list[k].U_let_go, &low, &high);
    }
    if (!(low < high)) result_view_range(view, &low, &high);
    for (int32_t p = 0; p < courses.pads; ++p) {
        char words[PAD_WORDS_SIZE];
        pad_words(view, p, words);
        snprintf(names[p], sizeof names[p], "%s", words);
    }
    double beside = BESIDE * (high - low);
    axes.x = figure_length_axis(view, "U", low - beside, high + beside);
    axes.y = (Axis){.low = 0.5,
                    .high = courses.pads + 0.5,
                    .factor = 1,
                    .names = (const char(*)[AXIS_LABEL_SIZE])names,
                    .name_count = courses.pads};
    def.height = page_shape(def.style, stack_shape(1) + 0.05 * courses.pads);
    TRY(page_begin(page, &def, err));
    Page whole = *page;
    KeyEntry entries[3] = {{KEY_LINE, FIGURE_CURVE, "slips in part"},
                           {KEY_DISC, INK, "all of it has let go, in this order"}};
    int32_t count = 2;
    if (zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    key_draw(&whole, entries, count);
    axes_fit(&whole, &whole.room, RIGHT_MARGIN, &axes);
    for (int32_t k = 0; k < courses.count; ++k)
        if (is_shown(&courses.list[k], &zoom)) course_draw(&whole, &axes, &courses.list[k]);
    axes_draw(&whole, &axes);
cleanup:
    pad_courses_destroy(&courses);
    memory_free(names);
    return error_is_clean(err);
}
