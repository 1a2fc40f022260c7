// SPDX-License-Identifier: GPL-2.0-or-later
// Which pad lets go first: a line a pad, against U, from where some of it slips to where all of it
// has let go, with its number in the order; of one cycle, or of all. The rule is that of
// record/pads: a node counts from when it has stuck, as the tail of a sliding is not the next
// cycle's slip. Where no node ever sticks one that slips slower than CREEP V is at rest.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "io/hdf5/result_tables.h"
#include "io/text/csv_writer.h"
#include "render/canvas/key.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// --- numbers -------------------------------------------------------------------------------------

static const double CREEP = 0.1;   // of V (record/observation)

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

// All cycles that ended in a sliding; without one the whole history is the first. In space only
// nodes of the line that is shown are looked at.
static bool pad_courses_read(ResultView *view, PadCourses *courses, Error *err)
{
    int32_t cycles = 0, pads = result_view_pads(view);
    int64_t first = 0;
    double least = CREEP * fabs(view->number[NUMBER_ROD_VELOCITY]);
    bool *stuck = NULL, *slipped = NULL;   // [nodes] seen sticking in this cycle; slipped since
    *courses = (PadCourses){.pads = pads};
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        cycles += event->kind == VIEW_LEADING && isfinite(event->U_start + event->U_stop);
    }
    TRY(result_view_read_status(view, err) && result_view_read_slip_rate(view, err));
    bool creeps = true;   // no node ever sticks
    for (int64_t k = 0; k < view->rows * view->nodes && creeps; ++k)
        creeps = view->status[k] != STATUS_STICKS;
    TRY((stuck = NEW_ARRAY(bool, view->nodes, err)) &&
        (slipped = NEW_ARRAY(bool, view->nodes, err)));
    TRY(courses->list = NEW_ARRAY(PadCourse, (int64_t)pads * (cycles ? cycles : 1), err));
    for (int32_t k = 0; k < view->event_count || (cycles == 0 && courses->count == 0); ++k) {
        const ViewEvent *event = k < view->event_count ? &view->events[k] : NULL;
        int64_t before = 0, last = view->rows - 1;
        if (event && !(event->kind == VIEW_LEADING && isfinite(event->U_start + event->U_stop)))
            continue;
        if (event) result_view_event_rows(view, event->U_start, event->U_stop, &before, &last);

        // A cycle begins: nothing has stuck yet.
        PadCourse *own = courses->list + courses->count;
        for (int32_t p = 0; p < pads; ++p)
            own[p] = (PadCourse){.cycle = 1 + courses->count / pads,
                                 .pad = p,
                                 .U_first_slip = NAN,
                                 .U_let_go = NAN,
                                 .mu_let_go = NAN};
        memset(stuck, 0, (size_t)view->nodes * sizeof *stuck);
        memset(slipped, 0, (size_t)view->nodes * sizeof *slipped);

        // Its rows, up to that in which the last pad lets go.
        int32_t let_go = 0;
        for (int64_t row = first; row <= last && let_go < pads; ++row) {
            const double *status = view->status + row * view->nodes;
            const double *rate = view->slip_rate + row * view->nodes;
            int32_t letting_go = 0;
            for (int32_t i = 0; i < view->nodes; ++i) {
                bool rests = status[i] == STATUS_STICKS ||
                             (creeps && status[i] != STATUS_OPEN && fabs(rate[i]) < least);
                if (rests)
                    stuck[i] = true;
                else if (stuck[i])
                    slipped[i] = true;
            }
            for (int32_t p = 0; p < pads; ++p) {
                bool some = false, all = true;
                for (int32_t i = 0; i < view->nodes; ++i) {
                    if ((int32_t)view->pad[i] != p) continue;
                    some = some || slipped[i];
                    all = all && (slipped[i] || status[i] == STATUS_OPEN);
                }
                if (some && isnan(own[p].U_first_slip)) own[p].U_first_slip = view->U[row];
                if (!some || !all || own[p].order > 0) continue;
                own[p].U_let_go = view->U[row];
                own[p].mu_let_go = view->mu[row];
                own[p].order = let_go + 1;
                ++letting_go;
            }
            let_go += letting_go;
        }
        courses->count += pads;
        first = last + 1;
    }
cleanup:
    memory_free_all(stuck, slipped);
    return error_is_clean(err);
}

static void pad_courses_destroy(PadCourses *courses)
{
    memory_free(courses->list);
    *courses = (PadCourses){0};
}

// --- the figure ----------------------------------------------------------------------------------

enum { NAMES_MAX = 40 };

static const double RIGHT_MARGIN = 10;   // points: half a number
static const double BESIDE = 0.06;   // of what is shown, on either side
static const double NUMBER_GAP = 3;   // points: from the mark to its number
static const double LINE_WIDTH = 2.5;   // points

static bool is_shown(const PadCourse *course, const Zoom *zoom)
{
    return !zoom->found || course->cycle == zoom->cycle;
}

bool figure_pads_are_there(const ResultView *view)
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

    // The axes: a line for each pad, with its name.
    for (int32_t p = 0; p < courses.pads; ++p) result_view_pad(view, p, names[p]);
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

    // A line goes from where some of a pad slips to where all of it has let go, or else to the
    // frame's end.
    double point = whole.point;
    Stroke stroke = {.color = FIGURE_CURVE, .width = LINE_WIDTH * point};
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK, .up = 0.5};
    for (int32_t k = 0; k < courses.count; ++k) {
        const PadCourse *course = &courses.list[k];
        char number[16];
        if (!is_shown(course, &zoom) || isnan(course->U_first_slip)) continue;
        double end = isnan(course->U_let_go) ? axes.x.high : course->U_let_go;
        Point at = axes_place(&axes, end, course->pad + 1);
        canvas_clip(whole.canvas, &axes.box);
        draw_segment(whole.canvas, &stroke,
                     axes_place(&axes, course->U_first_slip, course->pad + 1), at);
        canvas_clip(whole.canvas, NULL);
        if (course->order == 0) continue;
        draw_disc(whole.canvas, INK, at, 1.5 * KEY_RADIUS * point);
        snprintf(number, sizeof number, "%d", course->order);
        at.x += NUMBER_GAP * point;
        text_draw(whole.text, &style, at, number);
    }
    axes_draw(&whole, &axes);
cleanup:
    pad_courses_destroy(&courses);
    memory_free(names);
    return error_is_clean(err);
}

// A row for each pad in each cycle.
bool figure_pads_table(const char *path, ResultView *view, const FieldChoice *field, Error *err)
{
    (void)field;
    static const char *const names[2][6] = {
        {"cycle", "pad", "order", "U first slip", "U let go", "F_T/F_N let go"},
        {"cycle", "pad", "order", "U first slip (m)", "U let go (m)", "F_T/F_N let go"}};
    PadCourses courses;
    TextWriter *csv = NULL;
    TRY(pad_courses_read(view, &courses, err));
    TRY(csv = text_writer_create(path, false, err));
    for (int32_t c = 0; c < 6; ++c) csv_text(csv, names[view->si][c]);
    csv_end_row(csv);
    for (int32_t k = 0; k < courses.count; ++k) {
        const PadCourse *course = &courses.list[k];
        char words[PAD_WORDS_SIZE];   // the group's name as the mesh has it, or else its number
        int length = 0;
        const char *name = result_view_name(view->pad_names, course->pad, &length);
        if (length > 0)
            snprintf(words, sizeof words, "%.*s", length < PAD_WORDS_SIZE ? length : 40, name);
        else
            snprintf(words, sizeof words, "pad %d", course->pad + 1);
        csv_number(csv, course->cycle);
        csv_text(csv, words);
        csv_number(csv, course->order);
        csv_rounded(csv, course->U_first_slip);
        csv_rounded(csv, course->U_let_go);
        csv_rounded(csv, course->mu_let_go);
        csv_end_row(csv);
    }
cleanup:
    pad_courses_destroy(&courses);
    return text_writer_finish(csv, err);
}
