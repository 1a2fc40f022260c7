// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/contact_map.h"

#include "base/memory.h"
#include "render/figures/figures.h"

#include <math.h>
#include <string.h>

static const double OUTLINE_WIDTH = 0.4, SEAM = 0.15;   // points

Axes contact_map_axes(const ResultView *view)
{
    const ContactPlane *plane = &view->plane;
    return (Axes){.x = figure_length_axis(view, "x", plane->low[0], plane->high[0]),
                  .y = figure_length_axis(view, "y", plane->low[1], plane->high[1])};
}

// Patches in colours as an image; what has none is a shape.
bool contact_map_draw(const Page *page, const ContactPlane *plane, const float *level,
                      Color neutral, const Axes *axes, Error *err)
{
    static const int32_t turn[6] = {0, 1, 2, 0, 2, 3};
    int64_t count = 0;
    GlCorner *corners = NULL;
    TRY(corners = NEW_ARRAY(GlCorner, 6 * (int64_t)plane->patch_count, err));
    for (int32_t k = 0; k < plane->patch_count; ++k) {
        const ContactPatch *patch = &plane->patches[k];
        Point corner[PATCH_CORNERS];
        for (int32_t c = 0; c < PATCH_CORNERS; ++c)
            corner[c] = axes_place(axes, patch->corner[c][0], patch->corner[c][1]);

        if (level[patch->node] < 0) {
            // Its edge, too: between shapes side by side the paper would shine through.
            Stroke stroke = {.color = neutral, .width = fmax(1, SEAM * page->point)};
            Point round[PATCH_CORNERS + 1];
            memcpy(round, corner, PATCH_CORNERS * sizeof *corner);
            round[PATCH_CORNERS] = corner[0];
            draw_polygon(page->canvas, neutral, corner, PATCH_CORNERS);
            draw_line(page->canvas, &stroke, round, PATCH_CORNERS + 1);
        }

        for (int32_t c = 0; c < 6 && level[patch->node] >= 0; ++c) {
            const Point *at = &corner[turn[c]];
            corners[count++] = (GlCorner){(float)(at->x - axes->box.left),
                                          (float)(at->y - axes->box.top), level[patch->node]};
        }
    }
    if (count > 0) canvas_heat_triangles(page->canvas, &axes->box, corners, count);
    Stroke stroke = {.color = INK, .width = OUTLINE_WIDTH * page->point};
    for (int32_t k = 0; k < plane->side_count; ++k) {
        Point line[3];
        for (int32_t c = 0; c < 3; ++c)
            line[c] = axes_place(axes, plane->sides[k].point[c][0], plane->sides[k].point[c][1]);
        draw_line(page->canvas, &stroke, line, 3);
    }
cleanup:
    memory_free(corners);
    return error_is_clean(err);
}
