// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/picture.h"

#include "render/canvas/foot.h"

#include <stdio.h>
#include <string.h>

enum { NAMES_SIZE = 320 };

static const double FORCE_PLAIN = 0.62;   // height over width of force without an inset

static const FigureShape SHAPES[FIGURE_COUNT] = {
    [FIGURE_FORCE] = {0.85, .draw = figure_force},
    [FIGURE_SLIP_MAP] = {0.62, .draw = figure_slip_map},
    [FIGURE_CONTACT_DENSITY] = {0.62, .draw = figure_contact_density},
    [FIGURE_CONTACT_AREA] = {0.62, .draw = figure_contact_area},
    [FIGURE_STATE_MAP] = {0.62, .draw = figure_state_map},
    [FIGURE_CONTACT_PLANE] = {.draw_whole = figure_contact_plane},
    [FIGURE_PRECURSORS] = {0.62, figure_precursors, .own_axes = true},
    [FIGURE_FRONT_SPEED] = {0.62, figure_front_speed, .own_axes = true},
    [FIGURE_PROBES] = {.draw_whole = figure_probes},
    [FIGURE_PADS] = {.draw_whole = figure_pads},
    [FIGURE_PROFILE] = {.draw_whole = figure_profile, .own_axes = true},
    [FIGURE_FIELD] = {.draw_whole = figure_field},
    [FIGURE_STRIP] = {.draw_whole = figure_strip}};

static const Figure FIGURES[FIGURE_COUNT] = {
#define X(symbol, name, title) {symbol, name, title, &SHAPES[symbol]},
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

bool figure_is_there(const char *name, const ResultView *view)
{
    if (strcmp(name, FIGURES[FIGURE_STATE_MAP].name) == 0) return view->states > 0;
    if (strcmp(name, FIGURES[FIGURE_CONTACT_AREA].name) == 0)
        return figure_contact_area_shows(view);
    if (strcmp(name, FIGURES[FIGURE_PADS].name) == 0) return figure_pads_shows(view);
    if (strcmp(name, FIGURES[FIGURE_PROBES].name) == 0) return view->probes > 0;
    return strcmp(name, FIGURES[FIGURE_CONTACT_PLANE].name) != 0 ||
           (view->line && view->rapid_count > 0 && result_file_has_faces(view->file));
}

bool picture_add(Picture *picture, const Figure *figure, Error *err)
{
    if (picture->count == PANELS_MAX) return REFUSE(err, "a page takes %d panels", PANELS_MAX);
    picture->parts[picture->count++] = (PanelFigure){.name = figure->name, .figure = figure->id};
    return true;
}

// Makes a panel for each of several states, and sets the shapes of all panels.
static bool spread_states(const ResultView *view, const PictureStyle *style, Picture *picture,
                          Error *err)
{
    int32_t more = view->states - 1;
    PanelFigure *parts = picture->parts;
    for (int32_t k = picture->count - 1; k >= 0; --k) {
        const Figure *figure = &FIGURES[parts[k].figure];
        bool plain = figure->id == FIGURE_FORCE && !figure_force_enlarges(view, style);
        parts[k].draw = figure->shape->draw;
        parts[k].shape = plain ? FORCE_PLAIN : figure->shape->height_over_width;
        if (figure->id != FIGURE_STATE_MAP || more < 1) continue;
        if (picture->count + more > PANELS_MAX)
            return REFUSE(err, "a page takes %d panels", PANELS_MAX);
        memmove(parts + k + 1 + more, parts + k + 1,
                (size_t)(picture->count - k - 1) * sizeof *parts);
        for (int32_t i = 1; i <= more; ++i) parts[k + i] = parts[k];
        for (int32_t i = 1; i <= more; ++i) parts[k + i].state = i;
        picture->count += more;
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
    TRY(spread_states(view, style, &picture, err));
    if (!figure || picture.count > 1) {
        TRY(panels_draw(page, &def, picture.parts, picture.count, view, err));
    } else if (figure->shape->draw_whole) {
        TRY(figure->shape->draw_whole(page, &input, err));
    } else {
        def.height = page_shape(style, picture.parts[0].shape);
        TRY(page_begin(page, &def, err) && figure->shape->draw(page, view, err));
    }
    foot_draw(page, &foot);
cleanup:
    error_context(err, "figure %s", figure ? figure->name : "panels");
    return error_is_clean(err);
}

bool figure_draw(const char *name, ResultView *view, const PictureStyle *style, Page *page,
                 Error *err)
{
    Picture picture = {0};
    const PictureRequest request = {.style = *style, .figures = &name, .figure_count = 1};
    return figure_find(name, &picture.figure, err) && picture_add(&picture, picture.figure, err) &&
           picture_draw(&picture, "", &request, view, page, err);
}
