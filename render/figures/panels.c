// SPDX-License-Identifier: GPL-2.0-or-later
// Figures of the history below each other on one page, as the paper's Figure 1: (a), (b), (c), with
// frames of one width, and numbers of U below the last of those that share it.
#include "render/figures/panels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LETTER_LEFT = 1.5,
                    LETTER_DROP = 7.5;   // points: of (a), from its panel's corner
static const double LETTER_ROOM = 3;   // points: from the letter to numbers beside it
static const double SCRATCH_DPI = 100;   // of the page that is measured
static const double SLACK = 0.4;   // points: what the measured page is coarser
static const char *const ENLARGES = "contact-density";   // the panel that shows another U

// The frames of the panels on a page of which nothing else is wanted.
typedef struct Panels {
    const PanelFigure *figures;   // [count] borrowed
    int32_t count;
    double shapes;   // sum of all
    char zoom_name[32];   // of the panel that enlarges; "": it is not here
} Panels;

static bool enlarges(const Panels *panels, int32_t k)
{
    return strcmp(panels->figures[k].name, ENLARGES) == 0;
}

static Panels panels_take(const PanelFigure *figures, int32_t count)
{
    Panels panels = {.figures = figures, .count = count};
    for (int32_t k = 0; k < count; ++k) {
        panels.shapes += figures[k].shape;
        if (enlarges(&panels, k))
            snprintf(panels.zoom_name, sizeof panels.zoom_name, "enlarged in (%c)", 'a' + k);
    }
    return panels;
}

// One below the other; frame: [count] where theirs lie.
static bool draw_all(const Page *page, const Panels *panels, ResultView *view, Box *frame,
                     Error *err)
{
    double height = page->room.bottom - page->room.top, top = page->room.top, point = page->point;
    TextStyle style = {.size = LABEL_SIZE * point, .color = INK};
    for (int32_t k = 0; k < panels->count; ++k) {
        Page part = *page;
        char letter[8];
        part.room.top = top;
        part.room.bottom = round(top + height * panels->figures[k].shape / panels->shapes);
        part.frame = &frame[k];
        part.zoom_name = panels->zoom_name[0] ? panels->zoom_name : NULL;
        part.bare_x = k + 1 < panels->count && !enlarges(panels, k) && !enlarges(panels, k + 1);
        view->state = panels->figures[k].state;
        if (!panels->figures[k].draw(&part, view, err)) return false;
        snprintf(letter, sizeof letter, "(%c)", 'a' + k);
        text_draw(page->text, &style, (Point){LETTER_LEFT * point, top + LETTER_DROP * point},
                  letter);
        top = part.room.bottom;
    }
    return true;
}

// Measures the room that the widest names and numbers take beside the frames, points.
static bool measure(const PageDef *def, const Panels *panels, ResultView *view, double beside[2],
                    Error *err)
{
    PictureStyle style = *def->style;
    PageDef scratch = *def;
    Box frame[PANELS_MAX];
    Page page = {0};
    style.dpi = SCRATCH_DPI;
    style.format = "png";
    scratch.style = &style;
    beside[0] = beside[1] = 0;
    TRY(page_begin(&page, &scratch, err));
    TRY(draw_all(&page, panels, view, frame, err));
    for (int32_t k = 0; k < panels->count; ++k) {
        beside[0] = fmax(beside[0], frame[k].left / page.point);
        beside[1] = fmax(beside[1], (page.room.right - frame[k].right) / page.point);
    }
    beside[0] += LETTER_ROOM;
cleanup:
    page_destroy(&page);
    return error_is_clean(err);
}

bool panels_draw(Page *page, PageDef *def, const PanelFigure *figures, int32_t count,
                 ResultView *view, Error *err)
{
    Panels panels = panels_take(figures, count);
    Box frame[PANELS_MAX];
    double beside[2];
    def->height = page_shape(def->style, panels.shapes);
    if (!measure(def, &panels, view, beside, err) || !page_begin(page, def, err)) return false;
    for (int32_t side = 0; side < 2; ++side)
        page->beside[side] = ceil((beside[side] + SLACK) * page->point);
    return draw_all(page, &panels, view, frame, err);
}
