// SPDX-License-Identifier: GPL-2.0-or-later
// The rule is that of record/pads: a node counts from when it has stuck, as the tail of a sliding
// is not the next cycle's slip. Where no node ever sticks one that slips slower than CREEP V is at
// rest.
#include "render/figures/pad_data.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { OPEN = 0, STICK = 1 };   // statuses in the history
static const double CREEP = 0.1;   // of V (record/observation)

void pad_words(const ResultView *view, int32_t pad, char words[PAD_WORDS_SIZE])
{
    int length = 0;
    const char *name = result_view_name(view->pad_names, pad, &length);
    if (length > 0)
        snprintf(words, PAD_WORDS_SIZE, "%.*s", length < PAD_WORDS_SIZE ? length : 40, name);
    else
        snprintf(words, PAD_WORDS_SIZE, "pad %d", pad + 1);
}

// Follows the nodes through the rows of a cycle.
typedef struct Follower {
    bool creeps;   // no node ever sticks
    bool *stuck, *slipped;   // [nodes] seen sticking in this cycle; slipped or opened since; owned
} Follower;

// One row of a pad's course. *letting_go: one more where the pad lets go in it.
static void follow_pad(const ResultView *view, int64_t row, const Follower *follower,
                       int32_t let_go, PadCourse *course, int32_t *letting_go)
{
    bool some = false, all = true;
    for (int32_t i = 0; i < view->nodes; ++i) {
        if ((int32_t)view->pad[i] != course->pad) continue;
        some = some || follower->slipped[i];
        all = all && (follower->slipped[i] || view->status[row * view->nodes + i] == OPEN);
    }
    if (some && isnan(course->U_first_slip)) course->U_first_slip = view->U[row];
    if (!some || !all || course->order > 0) return;
    course->U_let_go = view->U[row];
    course->mu_let_go = view->mu[row];
    course->order = let_go + 1;
    ++*letting_go;
}

// Rows from `first` to the one before `end`, or the one in which the last pad lets go.
static void follow_cycle(const ResultView *view, int64_t first, int64_t end, int32_t pads,
                         Follower *follower, PadCourse *courses)
{
    int32_t let_go = 0;
    memset(follower->stuck, 0, (size_t)view->nodes * sizeof *follower->stuck);
    memset(follower->slipped, 0, (size_t)view->nodes * sizeof *follower->slipped);
    for (int64_t row = first; row < end && let_go < pads; ++row) {
        int32_t letting_go = 0;
        double least = CREEP * fabs(view->number[NUMBER_ROD_VELOCITY]);
        for (int32_t i = 0; i < view->nodes; ++i) {
            int64_t k = row * view->nodes + i;
            bool rests = view->status[k] == STICK || (follower->creeps && view->status[k] != OPEN &&
                                                      fabs(view->slip_rate[k]) < least);
            if (rests)
                follower->stuck[i] = true;
            else if (follower->stuck[i])
                follower->slipped[i] = true;
        }
        for (int32_t p = 0; p < pads; ++p)
            follow_pad(view, row, follower, let_go, &courses[p], &letting_go);
        let_go += letting_go;
    }
}

bool pad_courses_read(ResultView *view, PadCourses *courses, Error *err)
{
    Follower follower = {0};
    int32_t cycles = 0;
    int64_t first = 0;
    *courses = (PadCourses){.pads = result_view_pads(view)};
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        cycles += event->kind == VIEW_LEADING && isfinite(event->U_start + event->U_stop);
    }
    TRY(result_view_read_status(view, err) && result_view_read_slip_rate(view, err));
    follower.creeps = true;
    for (int64_t k = 0; k < view->rows * view->nodes && follower.creeps; ++k)
        follower.creeps = view->status[k] != STICK;
    TRY((follower.stuck = NEW_ARRAY(bool, view->nodes, err)) &&
        (follower.slipped = NEW_ARRAY(bool, view->nodes, err)));
    TRY(courses->list = NEW_ARRAY(PadCourse, (int64_t)courses->pads * (cycles ? cycles : 1), err));
    for (int32_t k = 0; k < view->event_count || (cycles == 0 && courses->count == 0); ++k) {
        const ViewEvent *event = k < view->event_count ? &view->events[k] : NULL;
        int64_t before = 0, last = view->rows - 1;
        if (event && !(event->kind == VIEW_LEADING && isfinite(event->U_start + event->U_stop)))
            continue;
        if (event) result_view_event_rows(view, event->U_start, event->U_stop, &before, &last);
        PadCourse *own = courses->list + courses->count;
        for (int32_t p = 0; p < courses->pads; ++p)
            own[p] = (PadCourse){.cycle = 1 + courses->count / courses->pads,
                                 .pad = p,
                                 .U_first_slip = NAN,
                                 .U_let_go = NAN,
                                 .mu_let_go = NAN};
        follow_cycle(view, first, last + 1, courses->pads, &follower, own);
        courses->count += courses->pads;
        first = last + 1;
    }
cleanup:
    memory_free_all(follower.stuck, follower.slipped);
    return error_is_clean(err);
}

void pad_courses_destroy(PadCourses *courses)
{
    memory_free(courses->list);
    *courses = (PadCourses){0};
}
