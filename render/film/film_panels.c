// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_panels.h"

#include "base/memory.h"
#include "render/figures/figure_contact_plane.h"
#include "render/figures/figures.h"
#include "render/view/space_time.h"

#include <math.h>
#include <stdio.h>

static const double ABOVE = 0.08;   // of the range of mu: room over and below the curve
static const double RIGHT = 6;   // points: frame to the cell's right end
static const double DOT = 2.6, RING = 1.0;   // points: radius, white around it
static const double THIN_DISTANCE = 0.3;   // pixels: nearer points of a curve add nothing
static const double STICK_SHARE = 0.02;   // of the height: the foot where the contact sticks
static const double PAST_WIDTH = 1.2, LATER_WIDTH = 0.8;   // points

static const Color PAST = {0.05f, 0.27f, 0.55f, 1};
static const Color LATER = {0.78f, 0.81f, 0.85f, 1};
static const Color DOT_COLOR = {0.75f, 0.12f, 0.12f, 1};

// --- force ---------------------------------------------------------------------------------------

void film_force_place(const Page *page, const Box *cell, const double t[2], FilmForce *force)
{
    const ResultView *view = force->view;
    FilmMoment from = film_moment(view, t[0]), to = film_moment(view, t[1]);
    double low = fmin(from.mu, to.mu), high = fmax(from.mu, to.mu);
    double U[2] = {fmin(from.U, to.U), fmax(from.U, to.U)};
    force->first = from.row + 1;
    force->last = to.row;
    for (int64_t row = force->first; row <= force->last; ++row) {
        low = fmin(low, view->mu[row]);
        high = fmax(high, view->mu[row]);
        U[0] = fmin(U[0], view->U[row]);
        U[1] = fmax(U[1], view->U[row]);
    }
    if (!(high > low)) high = low + 1;
    if (!(U[1] > U[0])) U[1] = U[0] + 1;   // the rod stands all the time
    force->axes.x = figure_length_axis(view, "U", U[0], U[1]);
    double beyond = ABOVE * (high - low);
    force->axes.y = (Axis){low - beyond, high + beyond, 1, .label = FIGURE_MU};
    force->drawn = from.row;
    axes_fit(page, cell, RIGHT, &force->axes);
}

// Rows from `first` to `last`, then `end` where it is not NULL.
static void curve_draw(const Page *page, const FilmForce *force, const Stroke *stroke,
                       const int64_t rows[2], const Point *end)
{
    const ResultView *view = force->view;
    canvas_clip(page->canvas, &force->axes.box);
    LinePen pen = line_begin(page->canvas, stroke);
    for (int64_t row = rows[0]; row <= rows[1]; ++row) {
        pen.thin = row < rows[1] ? THIN_DISTANCE : 0;
        line_add(&pen, axes_place(&force->axes, view->U[row], view->mu[row]));
    }
    if (end) line_add(&pen, *end);
    line_end(&pen);
    canvas_clip(page->canvas, NULL);
}

void film_force_draw(const Page *page, const FilmForce *force)
{
    Stroke stroke = {.color = LATER, .width = LATER_WIDTH * page->point};
    curve_draw(page, force, &stroke, (const int64_t[]){force->first - 1, force->last}, NULL);
    axes_draw(page, &force->axes);
}

enum { STEPS_AT_ONCE = 64 };

// Draws in pieces of some steps; of the last one film_force_now draws the rest.
void film_force_pass(const Page *page, FilmForce *force, const FilmMoment *now)
{
    Stroke stroke = {.color = PAST, .width = PAST_WIDTH * page->point};
    while (force->drawn < now->row) {
        int64_t last = force->drawn + STEPS_AT_ONCE;
        if (last > now->row) last = now->row;
        curve_draw(page, force, &stroke, (const int64_t[]){force->drawn, last}, NULL);
        force->drawn = last;
    }
}

void film_force_now(const Page *page, const FilmForce *force, const FilmMoment *now)
{
    double point = page->point;
    Stroke stroke = {.color = PAST, .width = PAST_WIDTH * point};
    Point place = axes_place(&force->axes, now->U, now->mu);
    curve_draw(page, force, &stroke, (const int64_t[]){now->row, now->row}, &place);
    draw_disc(page->canvas, PAPER, place, (DOT + RING) * point);
    draw_disc(page->canvas, DOT_COLOR, place, DOT * point);
}

// --- slip rate, or a state -----------------------------------------------------------------------

void film_profile_place(const Page *page, const Box *cell, FilmProfile *profile)
{
    const ResultView *view = profile->view;
    Axes *axes = &profile->axes;
    double low = 0, high = 0;
    result_view_x_extent(view, &low, &high);
    axes->x = figure_length_axis(view, "x", low, high);
    const Colorbar *bar = &profile->bar;
    axes->y = (Axis){.low = bar->powers ? pow(10, bar->low) : bar->low,
                     .high = bar->powers ? pow(10, bar->high) : bar->high,
                     .factor = 1,
                     .is_log = bar->powers};
    snprintf(axes->y.label, sizeof axes->y.label, "%s", bar->label);
    axes_fit(page, cell, RIGHT, axes);
}

void film_profile_draw(const Page *page, const FilmProfile *profile)
{
    axes_draw(page, &profile->axes);
}

// A bar a node, as wide as the part of the contact it stands for, in the colours of the map; what
// is slower than the scale is a grey foot.
void film_profile_now(const Page *page, const FilmProfile *profile, const FilmMoment *now)
{
    const ResultView *view = profile->view;
    const Axes *axes = &profile->axes;
    const Stroke stroke = {.color = INK, .width = FRAME_WIDTH * page->point};
    SpaceTime data = {.nodes = view->nodes, .x = view->x, .pad = view->pad};
    double height = axes->box.bottom - axes->box.top;
    canvas_set_below(page->canvas, profile->bar.neutral_color);
    for (int32_t i = 0; i < view->nodes; ++i) {
        double from = 0, to = 0;
        node_extent(&data, i, &from, &to);
        float level =
            colorbar_level(&profile->bar, film_value(now, profile->values, view->nodes, i));
        if (level <= (float)HEAT_MISSING) continue;
        Box bar = axes->box;
        bar.left = round(axes_place(axes, from, axes->y.low).x);
        bar.right = round(fmax(axes_place(axes, to, axes->y.low).x, bar.left + 1));
        bar.top = bar.bottom - round(fmax((double)level, STICK_SHARE) * height);
        canvas_heat_cell(page->canvas, &bar, level);
    }
    draw_outline(page->canvas, &stroke, &axes->box);
}

// --- the contact in space ------------------------------------------------------------------------

static const double BAR_GAP = 5, PLANE_ABOVE = 6;   // points
static const double BAR_LEAST = 30;   // points: how high the bar is at least

bool film_plane_create(const Page *page, const Box *cell, FilmPlane *plane, Error *err)
{
    double point = page->point;
    if (!result_view_read_plane(plane->view, err)) return false;
    ResultSeries series = plane->state ? SERIES_STATE : SERIES_SLIP_RATE;
    if (!result_view_read(plane->view, series, true, &plane->values, err)) return false;
    if (!(plane->level = NEW_ARRAY(float, plane->view->all_nodes, err))) return false;
    Axes *axes = &plane->axes;
    *axes = contact_map_axes(plane->view);
    double left = axes_left_margin(page, axes) * point, below = axes_bottom_margin(axes) * point;
    double beside = (BAR_GAP + colorbar_width(page, &plane->bar)) * point;
    double room[2] = {cell->right - cell->left - left - beside,
                      cell->bottom - cell->top - below - PLANE_ABOVE * point};
    double scale =
        fmin(room[0] / (axes->x.high - axes->x.low), room[1] / (axes->y.high - axes->y.low));
    if (!(room[0] > 0 && room[1] > BAR_LEAST * point))
        return REFUSE(err, "the film is too small for the contact of the block");
    axes->box.left = round(cell->left + left);
    axes->box.right = axes->box.left + round(scale * (axes->x.high - axes->x.low));
    axes->box.top = round(cell->top + PLANE_ABOVE * point);
    axes->box.bottom = axes->box.top + round(scale * (axes->y.high - axes->y.low));
    return true;
}

void film_plane_destroy(FilmPlane *plane)
{
    memory_free_all(plane->values, plane->level);
    *plane = (FilmPlane){0};
}

void film_plane_draw(const Page *page, const FilmPlane *plane)
{
    Box bar = plane->axes.box;
    bar.bottom = fmax(bar.bottom, bar.top + BAR_LEAST * page->point);
    axes_draw(page, &plane->axes);
    colorbar_draw(page, &plane->bar, &bar, BAR_GAP);
}

bool film_plane_now(const Page *page, const FilmPlane *plane, const FilmMoment *now, Error *err)
{
    const ResultView *view = plane->view;
    for (int32_t i = 0; i < view->all_nodes; ++i)
        plane->level[i] =
            colorbar_level(&plane->bar, film_value(now, plane->values, view->all_nodes, i));
    return contact_map_draw(page, &view->plane, plane->level, plane->bar.neutral_color,
                            &plane->axes, err);
}
