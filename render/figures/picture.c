// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/picture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAMES_SIZE = 320 };

static const double FORCE_PLAIN = 0.62;   // height over width of force without an inset
static const double LETTER_LEFT = 1.5, LETTER_DROP = 7.5;   // points: (a), from its panel's corner
static const double LETTER_ROOM = 3;   // points: from the letter to numbers beside it
static const double SCRATCH_DPI = 100;   // of the page that is measured
static const double SLACK = 0.4;   // points: what the measured page is coarser

// A page shows its figures in the order of PICTURE_FIGURES.
static const FigureKind KINDS[FIGURE_COUNT] = {
    [FIGURE_FORCE] = {.height_over_width = 0.85,
                      .draw = figure_force,
                      .write_table = figure_force_table,
                      .page_format = "svg",
                      .page_words =
                          "Line: friction force over load against the displacement of the rod.",
                      .page_caption =
                          "<i>F</i><sub>T</sub>/<i>F</i><sub>N</sub> against the rod\u2019s "
                          "displacement <i>U</i>. Circles: the peaks before the block slides as a "
                          "whole, filled if they count for <i>\u03bc</i><sub>M</sub>. The inset "
                          "enlarges the last precursors before a sliding."},
    [FIGURE_SLIP_MAP] =
        {.height_over_width = 0.62,
         .draw = figure_slip_map,
         .write_table = figure_slip_map_table,
         .page_format = "png",
         .page_words = "Map: slip rate along the contact against the displacement of the rod.",
         .page_caption = "Slip rate over the rod\u2019s velocity, against <i>U</i> and the place "
                         "<i>x</i> along the contact. Grey: stick."},
    [FIGURE_CONTACT_DENSITY] =
        {.height_over_width = 0.62,
         .draw = figure_contact_density,
         .page_format = "png",
         .page_words = "Map: contact density before a sliding, along the contact and against the "
                       "displacement of the rod.",
         .page_caption = "Contact density max(0, 1 \u2212 |<i>v</i>|/<i>v</i><sub>c</sub>) in the "
                         "last precursors before a sliding. Black line: the front of slip."},
    [FIGURE_CONTACT_AREA] = {.height_over_width = 0.62,
                             .draw = figure_contact_area,
                             .write_table = figure_contact_area_table,
                             .is_there = figure_contact_area_is_there,
                             .page_format = "png",
                             .page_words = "Map: area of the real contacts before a sliding, along "
                                           "the contact and against the displacement of the rod.",
                             .page_caption = "Area of the real contacts over that at rest, in the "
                                             "last precursors before a sliding."},
    [FIGURE_STATE_MAP] =
        {.height_over_width = 0.62,
         .draw = figure_state_map,
         .write_table = figure_state_map_table,
         .is_there = figure_state_map_is_there,
         .page_format = "png",
         .page_words = "Map: what friction remembers, along the contact and against the "
                       "displacement of the rod.",
         .page_caption = "What friction remembers at each place of the contact, against <i>U</i>: "
                         "the smallest in a pixel. Slip takes it away, rest brings it back."},
    [FIGURE_CONTACT_PLANE] =
        {.draw_whole = figure_contact_plane,
         .is_there = figure_contact_plane_is_there,
         .page_format = "png",
         .page_words = "Maps: slip rate over the contact at moments before and in a sliding.",
         .page_caption = "Slip rate over the rod\u2019s velocity, over the contact, while slow "
                         "slip grows and as slip turns rapid. Where there is no colour: stick."},
    [FIGURE_PRECURSORS] = {.height_over_width = 0.62,
                           .draw = figure_precursors,
                           .write_table = figure_precursors_table,
                           .own_axes = true,
                           .asked_only = true},
    [FIGURE_FRONT_SPEED] = {.height_over_width = 0.62,
                            .draw = figure_front_speed,
                            .write_table = figure_front_speed_table,
                            .own_axes = true,
                            .asked_only = true},
    [FIGURE_PROBES] = {.draw_whole = figure_probes,
                       .write_table = figure_probes_table,
                       .is_there = figure_probes_are_there},
    [FIGURE_PADS] = {.draw_whole = figure_pads,
                     .write_table = figure_pads_table,
                     .is_there = figure_pads_are_there},
    [FIGURE_PROFILE] = {.draw_whole = figure_profile,
                        .write_table = figure_profile_table,
                        .own_axes = true,
                        .asked_only = true},
    [FIGURE_FIELD] = {.draw_whole = figure_field},
    [FIGURE_STRIP] = {.draw_whole = figure_strip, .asked_only = true},
};

static const Figure FIGURES[FIGURE_COUNT] = {
#define X(symbol, name, title) {symbol, name, title, &KINDS[symbol]},
    PICTURE_FIGURES(X)
#undef X
};

const Figure *figure_get(FigureId id)
{
    return &FIGURES[id];
}

bool figure_find(const char *name, const Figure **figure, Error *err)
{
    char names[NAMES_SIZE] = "";
    for (int32_t k = 0; k < FIGURE_COUNT; ++k) {
        *figure = &FIGURES[k];
        if (strcmp(FIGURES[k].name, name) == 0) return true;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "", FIGURES[k].name);
    }
    return REFUSE(err, "there is no figure called \"%s\"; known are: %s", name, names);
}

bool figure_is_there(const Figure *figure, const ResultView *view)
{
    return !figure->kind->is_there || figure->kind->is_there(view);
}

bool picture_add(Picture *picture, const Figure *figure, Error *err)
{
    if (picture->count == PANELS_MAX) return REFUSE(err, "a page takes %d panels", PANELS_MAX);
    picture->panels[picture->count++] = (Panel){.figure = figure};
    return true;
}

// True if a panel shows another U than the others: contact-density enlarges a part.
static bool enlarges(const Picture *picture, int32_t k)
{
    return picture->panels[k].figure->id == FIGURE_CONTACT_DENSITY;
}

static double sum_shapes(const Picture *picture)
{
    double sum = 0;
    for (int32_t k = 0; k < picture->count; ++k) sum += picture->panels[k].shape;
    return sum;
}

// The panels one below the other, as the paper's Figure 1: (a), (b), (c); frame: [count] where
// their frames lie.
static bool panels_draw(const Page *page, const Picture *picture, ResultView *view, Box *frame,
                        Error *err)
{
    double height = page->room.bottom - page->room.top, top = page->room.top, point = page->point;
    double shapes = sum_shapes(picture);
    TextStyle style = {.size = LABEL_SIZE * point, .color = INK};
    char zoom_name[32] = "", letter[8];
    for (int32_t k = 0; k < picture->count; ++k)
        if (enlarges(picture, k))
            snprintf(zoom_name, sizeof zoom_name, "enlarged in (%c)", 'a' + k);
    for (int32_t k = 0; k < picture->count; ++k) {
        const Panel *panel = &picture->panels[k];
        Page part = *page;
        part.room.top = top;
        part.room.bottom = round(top + height * panel->shape / shapes);
        part.frame = &frame[k];
        part.zoom_name = zoom_name[0] ? zoom_name : NULL;
        part.bare_x = k + 1 < picture->count && !enlarges(picture, k) && !enlarges(picture, k + 1);
        view->state = panel->state;
        if (!panel->figure->kind->draw(&part, view, err)) return false;
        snprintf(letter, sizeof letter, "(%c)", 'a' + k);
        text_draw(page->text, &style, (Point){LETTER_LEFT * point, top + LETTER_DROP * point},
                  letter);
        top = part.room.bottom;
    }
    return true;
}

bool picture_draw(const Picture *asked, const char *folder, const PictureRequest *request,
                  ResultView *view, Page *page, Error *err)
{
    const PictureStyle *style = &request->style;
    const Figure *figure = asked->figure;
    bool warns = !style->warnings || strcmp(style->warnings, "none") != 0;
    Foot foot = foot_wrap(warns ? view->warnings : "", page_width(style));
    Picture picture = *asked;
    PageDef def = {
        .style = style, .title = page_title(style, view->title, false), .foot = foot_height(&foot)};
    FigureInput input = {view, folder, &request->field, def};
    Page coarse_page = {0};

    // A panel for each of several states, and the shapes of all panels.
    int32_t more = view->states - 1;
    Panel *panels = picture.panels;
    for (int32_t k = picture.count - 1; k >= 0; --k) {
        const Figure *own = panels[k].figure;
        bool plain = own->id == FIGURE_FORCE && !figure_force_enlarges(view, style);
        panels[k].shape = plain ? FORCE_PLAIN : own->kind->height_over_width;
        if (own->id != FIGURE_STATE_MAP || more < 1) continue;
        if (picture.count + more > PANELS_MAX)
            FAIL(err, ERROR_INPUT, "a page takes %d panels", PANELS_MAX);
        memmove(panels + k + 1 + more, panels + k + 1,
                (size_t)(picture.count - k - 1) * sizeof *panels);
        for (int32_t i = 1; i <= more; ++i) panels[k + i] = panels[k];
        for (int32_t i = 1; i <= more; ++i) panels[k + i].state = i;
        picture.count += more;
    }

    if (!figure || picture.count > 1) {
        // A page of panels with frames of one width, and numbers of U below the last of those that
        // share it. A coarse page, of which nothing else is wanted, tells how much room the widest
        // names and numbers take beside the frames.
        PictureStyle coarse = *style;
        Box frame[PANELS_MAX];
        double beside[2] = {0, 0};   // points
        coarse.dpi = SCRATCH_DPI;
        coarse.format = "png";
        def.height = page_shape(style, sum_shapes(&picture));
        PageDef scratch = def;
        scratch.style = &coarse;
        TRY(page_begin(&coarse_page, &scratch, err));
        TRY(panels_draw(&coarse_page, &picture, view, frame, err));
        for (int32_t k = 0; k < picture.count; ++k) {
            beside[0] = fmax(beside[0], frame[k].left / coarse_page.point);
            beside[1] =
                fmax(beside[1], (coarse_page.room.right - frame[k].right) / coarse_page.point);
        }
        beside[0] += LETTER_ROOM;
        TRY(page_begin(page, &def, err));
        for (int32_t side = 0; side < 2; ++side)
            page->beside[side] = ceil((beside[side] + SLACK) * page->point);
        TRY(panels_draw(page, &picture, view, frame, err));
    } else if (figure->kind->draw_whole) {
        TRY(figure->kind->draw_whole(page, &input, err));
    } else {
        def.height = page_shape(style, picture.panels[0].shape);
        TRY(page_begin(page, &def, err) && figure->kind->draw(page, view, err));
    }
    foot_draw(page, &foot);
cleanup:
    page_destroy(&coarse_page);
    error_context(err, "figure %s", figure ? figure->name : "panels");
    return error_is_clean(err);
}
