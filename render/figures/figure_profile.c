// SPDX-License-Identifier: GPL-2.0-or-later
// Pressure, friction, their ratio, slip, contact area and gap along the contact at chosen moments:
// a frame for each, a curve for each moment; in space along a line. Where the block has lifted off,
// rings.
#include "render/figures/figures.h"

#include "render/figures/profile_data.h"
#include "render/figures/stack.h"

#include <math.h>
#include <stdio.h>

static const double RING = 0.62;   // inside over outside of the mark of an open node

static bool is_shown(const Profiles *profiles, ProfileQuantity quantity)
{
    return profiles->values[quantity] && (quantity != PROFILE_GAP || profiles->opens);
}

static void name_axis(const ResultView *view, ProfileQuantity quantity, Axis *axis)
{
    static const struct {
        const char *name, *si, *normalised;
    } words[PROFILE_QUANTITIES] = {{"~{p}", "Pa", "~{E}"},       {"~{\u03c4}", "Pa", "~{E}"},
                                   {"~{\u03c4} / ~{p}", "", ""}, {"slip", "m", "~{L}_{0}"},
                                   {"~{A} / ~{A}_{0}", "", ""},  {"gap", "m", "~{L}_{0}"}};
    const char *name = words[quantity].name, *normalised = words[quantity].normalised;
    if (view->si && words[quantity].si[0])
        axis_set_unit(axis, name, words[quantity].si);
    else
        snprintf(axis->label, sizeof axis->label, "%s%s%s", name, *normalised ? " / " : "",
                 normalised);
}

bool figure_profile(Page *page, const FigureInput *input, Error *err)
{
    ResultView *view = input->view;
    PageDef def = input->def;
    Profiles profiles = {0};
    Axes axes[PROFILE_QUANTITIES] = {0};
    ProfileQuantity shown[PROFILE_QUANTITIES];
    double from = 0, to = 0;
    int32_t frames = 0;
    TRY(profiles_read(view, input->field->at, &profiles, err));
    result_view_x_extent(view, &from, &to);
    for (int32_t q = 0; q < PROFILE_QUANTITIES; ++q) {
        bool area = q == PROFILE_AREA;   // which changes by a few per cent
        double low = area ? INFINITY : 0, high = area ? -INFINITY : 0;
        if (!is_shown(&profiles, (ProfileQuantity)q)) continue;
        for (int64_t i = 0; i < (int64_t)profiles.count * profiles.nodes; ++i)
            stack_widen(profiles.values[q][i], &low, &high);
        Axes *own = &axes[frames];
        *own = (Axes){.x = figure_length_axis(view, "x", from, to), .y = stack_axis(low, high)};
        name_axis(view, (ProfileQuantity)q, &own->y);
        shown[frames++] = (ProfileQuantity)q;
    }
    def.height = page_shape(def.style, stack_shape(frames));
    TRY(page_begin(page, &def, err));
    Page whole = *page;
    KeyEntry entries[PROFILES_MAX + 2];
    int32_t count = 0;
    for (int32_t k = 0; k < profiles.count; ++k)
        entries[count++] = (KeyEntry){KEY_LINE, stack_color(k), profiles.words[k]};
    if (profiles.count > 1)
        entries[count++] = (KeyEntry){.words = "slip is that since the first of these moments"};
    if (profiles.opens) entries[count++] = (KeyEntry){KEY_RING, INK, "open: no contact"};
    key_draw(&whole, entries, count);
    stack_fit(&whole, axes, frames);
    for (int32_t f = 0; f < frames; ++f) {
        for (int32_t k = 0; k < profiles.count; ++k) {
            // Gaps between pads break the curve.
            Stroke stroke = {.color = stack_color(k), .width = CURVE_WIDTH * whole.point};
            canvas_clip(whole.canvas, &axes[f].box);
            LinePen pen = line_begin(whole.canvas, &stroke);
            for (int32_t i = 0; i < view->nodes; ++i) {
                if (i > 0 && view->pad[i] != view->pad[i - 1]) line_add(&pen, (Point){NAN, NAN});
                line_add(&pen,
                         axes_place(&axes[f], view->x[i],
                                    (profiles.values[shown[f]] + (int64_t)k * profiles.nodes)[i]));
            }
            line_end(&pen);
            canvas_clip(whole.canvas, NULL);
        }

        for (int32_t k = 0; shown[f] == PROFILE_PRESSURE && k < profiles.count; ++k) {
            double radius = KEY_RADIUS * whole.point;
            for (int32_t i = 0; i < view->nodes; ++i) {
                int64_t at_node = (int64_t)k * view->nodes + i;
                if (profiles.status[at_node] != 0) continue;
                Point at =
                    axes_place(&axes[f], view->x[i], profiles.values[PROFILE_PRESSURE][at_node]);
                draw_disc(whole.canvas, stack_color(k), at, radius);
                draw_disc(whole.canvas, PAPER, at, RING * radius);
            }
        }
        axes_draw(&whole, &axes[f]);
    }
cleanup:
    profiles_destroy(&profiles);
    return error_is_clean(err);
}
