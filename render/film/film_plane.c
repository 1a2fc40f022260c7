// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_plane.h"

#include "base/memory.h"
#include "render/figures/figure_contact_plane.h"

#include <math.h>

static const double BAR_GAP = 5, ABOVE = 6;   // points
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
                      cell->bottom - cell->top - below - ABOVE * point};
    double scale =
        fmin(room[0] / (axes->x.high - axes->x.low), room[1] / (axes->y.high - axes->y.low));
    if (!(room[0] > 0 && room[1] > BAR_LEAST * point))
        return REFUSE(err, "the film is too small for the contact of the block");
    axes->box.left = round(cell->left + left);
    axes->box.right = axes->box.left + round(scale * (axes->x.high - axes->x.low));
    axes->box.top = round(cell->top + ABOVE * point);
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
