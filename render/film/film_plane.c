// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_plane.h"

#include "base/memory.h"
#include "render/figures/contact_map.h"
#include "render/figures/state_scale.h"

#include <math.h>

static const double BAR_GAP = 5, ABOVE = 6;   // points
static const double BAR_LEAST = 30;   // points: how high the bar is at least

bool film_plane_create(const Page *page, const Box *cell, FilmPlane *plane, Error *err)
{
    double point = page->point;
    TRY(result_view_read_plane(plane->view, err));
    if (plane->state)
        TRY(state_read(plane->view, true, &plane->values, err));
    else
        TRY(result_view_read_contact(plane->view, SERIES_SLIP_RATE, &plane->values, err));
    TRY(plane->level = NEW_ARRAY(float, plane->view->all_nodes, err));
    Axes *axes = &plane->axes;
    *axes = contact_map_axes(plane->view);
    double left = axes_left_margin(page, axes) * point, below = axes_bottom_margin(axes) * point;
    double beside = (BAR_GAP + colorbar_width(page, &plane->bar)) * point;
    double room[2] = {cell->right - cell->left - left - beside,
                      cell->bottom - cell->top - below - ABOVE * point};
    double scale =
        fmin(room[0] / (axes->x.high - axes->x.low), room[1] / (axes->y.high - axes->y.low));
    if (!(room[0] > 0 && room[1] > BAR_LEAST * point))
        FAIL(err, ERROR_INPUT, "the film is too small for the contact of the block");
    axes->box.left = round(cell->left + left);
    axes->box.right = axes->box.left + round(scale * (axes->x.high - axes->x.low));
    axes->box.top = round(cell->top + ABOVE * point);
    axes->box.bottom = axes->box.top + round(scale * (axes->y.high - axes->y.low));
cleanup:
    return error_is_clean(err);
}

void film_plane_destroy(FilmPlane *plane)
{
    memory_free(plane->values);
    memory_free(plane->level);
    plane->values = NULL;
    plane->level = NULL;
}

void film_plane_draw(const Page *page, const FilmPlane *plane)
{
    uint8_t colors[3 * MAP_SIZE];
    Box bar = plane->axes.box;
    color_map_fill(colors);
    canvas_set_map(page->canvas, colors, plane->bar.neutral_color);
    bar.left = round(bar.right + BAR_GAP * page->point);
    bar.bottom = fmax(bar.bottom, bar.top + BAR_LEAST * page->point);
    axes_draw(page, &plane->axes);
    colorbar_draw(page, &plane->bar, &bar);
}

bool film_plane_now(const Page *page, const FilmPlane *plane, const FilmMoment *now, Error *err)
{
    const ResultView *view = plane->view;
    uint8_t colors[3 * MAP_SIZE];
    for (int32_t i = 0; i < view->all_nodes; ++i)
        plane->level[i] =
            colorbar_level(&plane->bar, film_value(now, plane->values, view->all_nodes, i));
    color_map_fill(colors);
    canvas_set_map(page->canvas, colors, plane->bar.neutral_color);
    return contact_map_draw(page, &view->plane, plane->level, plane->bar.neutral_color,
                            &plane->axes, err);
}
