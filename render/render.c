// SPDX-License-Identifier: GPL-2.0-or-later
// The module's entry: which figures, a fresh page and a file for each.
#include "render/render.h"

#include "io/files/folder.h"
#include "io/text/picture_options.h"
#include "render/canvas/foot.h"
#include "render/figure_data.h"
#include "render/figures/figures.h"
#include "render/panels.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { NAMES_SIZE = 240 };

static const double FORCE_PLAIN = 0.62;   // of force without an inset: height over width

typedef enum FigureId {
#define X(symbol, name, title) symbol,
    RENDER_FIGURES(X) FIGURE_COUNT
#undef X
} FigureId;

// Height over width is that of a column.
static const struct FigureShape {
    double height_over_width;
    FigureFunction draw;
    bool own_axes;   // no U along x: it cannot be a panel, and is drawn for who asks
    WholeFigureFunction draw_whole;   // in its place: begins the page itself, and needs fields
} SHAPES[FIGURE_COUNT] = {[FIGURE_FORCE] = {0.85, .draw = figure_force},
                          [FIGURE_SLIP_MAP] = {0.62, .draw = figure_slip_map},
                          [FIGURE_CONTACT_DENSITY] = {0.62, .draw = figure_contact_density},
                          [FIGURE_STATE_MAP] = {0.62, .draw = figure_state_map},
                          [FIGURE_CONTACT_PLANE] = {.draw_whole = figure_contact_plane},
                          [FIGURE_PRECURSORS] = {0.62, figure_precursors, .own_axes = true},
                          [FIGURE_FRONT_SPEED] = {0.62, figure_front_speed, .own_axes = true},
                          [FIGURE_FIELD] = {.draw_whole = figure_field},
                          [FIGURE_STRIP] = {.draw_whole = figure_strip}};

typedef struct Figure {
    FigureId id;
    const char *name, *title;
    const struct FigureShape *shape;
} Figure;

static const Figure FIGURES[FIGURE_COUNT] = {
#define X(symbol, name, title) {symbol, name, title, &SHAPES[symbol]},
    RENDER_FIGURES(X)
#undef X
};

// Height over width on a column.
static double figure_shape(const Figure *figure, const ResultView *view, const PictureStyle *style)
{
    bool plain = figure->id == FIGURE_FORCE && !figure_force_enlarges(view, style);
    return plain ? FORCE_PLAIN : figure->shape->height_over_width;
}

// The figure called `name`, or ERROR_INPUT with the names there are.
static bool figure_find(const char *name, const Figure **figure, Error *err)
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

// One picture: a figure, or several as panels.
typedef struct Picture {
    const Figure *figure;   // NULL: panels
    int32_t count;
    PanelFigure parts[PANELS_MAX];   // [count]
} Picture;

static void add_part(Picture *picture, const Figure *figure)
{
    picture->parts[picture->count++] =
        (PanelFigure){.name = figure->name, .figure = (int32_t)figure->id};
}

// The figures that `names` has, separated by commas.
static bool find_panels(const char *names, Picture *picture, Error *err)
{
    char name[32];
    for (const char *at = names; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        const Figure *figure = NULL;
        if (!figure_find(name, &figure, err)) return false;
        if (!figure->shape->draw || figure->shape->own_axes)
            return REFUSE(err, "panels are figures over U: %s cannot be one", name);
        if (picture->count == PANELS_MAX) return REFUSE(err, "a page takes %d panels", PANELS_MAX);
        add_part(picture, figure);
    }
    return picture->count > 0 || REFUSE(err, "no panel is named");
}

// Finds the k-th picture of those that are asked for; if none is named, of all that there are.
static bool find_picture(const PictureRequest *request, int32_t k, Picture *picture, Error *err)
{
    *picture = (Picture){0};
    if (request->panels) return find_panels(request->panels, picture, err);
    picture->figure = &FIGURES[k % FIGURE_COUNT];
    if (request->figure_count > 0 && !figure_find(request->figures[k], &picture->figure, err))
        return false;
    add_part(picture, picture->figure);
    return true;
}

static int32_t picture_count(const PictureRequest *request)
{
    return request->panels ? 1 : request->figure_count > 0 ? request->figure_count : FIGURE_COUNT;
}

// "field", or "field-stress_xx" where that was asked for.
static bool picture_path(const char *folder, const PictureRequest *request, const Figure *figure,
                         char path[PATH_MAX], Error *err)
{
    const char *of = figure && figure->shape->draw_whole ? request->field.of : NULL;
    int length =
        snprintf(path, PATH_MAX, "%s/figures/%s%s%s.%s", folder, figure ? figure->name : "panels",
                 of ? "-" : "", of ? of : "",
                 request->style.format ? request->style.format : canvas_ending(CANVAS_PNG));
    return (length >= 0 && length < PATH_MAX) ||
           REFUSE(err, "the result folder's path is too long");
}

// Makes a panel for each of several states, and sets the shapes of all panels.
static bool spread_states(const ResultView *view, const PictureStyle *style, Picture *picture,
                          Error *err)
{
    int32_t more = view->states - 1;
    PanelFigure *parts = picture->parts;
    for (int32_t k = picture->count - 1; k >= 0; --k) {
        const Figure *figure = &FIGURES[parts[k].figure];
        parts[k].draw = figure->shape->draw;
        parts[k].shape = figure_shape(figure, view, style);
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

// On a fresh page, to be finished.
static bool draw(const char *folder, const PictureRequest *request, const Picture *asked,
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

// One picture from nothing to its file. Whatever fails, all that was made for it is freed.
static bool make_picture(const char *folder, const PictureRequest *request, const Picture *picture,
                         ResultView *view, Error *err)
{
    Page page = {0};
    char path[PATH_MAX];
    const Figure *figure = picture->figure;
    TRY(picture_path(folder, request, figure, path, err));
    TRY(draw(folder, request, picture, view, &page, err));
    TRY(page_finish(&page, path, figure ? figure->title : view->title, err));
    for (int32_t k = 0; k < picture->count; ++k)
        TRY(figure_data_write(folder, picture->parts[k].name, view, request->style.compare, err));
cleanup:
    page_destroy(&page);
    return error_is_clean(err);
}

bool figure_draw(const char *name, ResultView *view, const PictureStyle *style, Page *page,
                 Error *err)
{
    Picture picture;
    const PictureRequest request = {.style = *style, .figures = &name, .figure_count = 1};
    return find_picture(&request, 0, &picture, err) &&
           draw("", &request, &picture, view, page, err);
}

static bool make_figures_folder(const char *result, Error *err)
{
    char folder[PATH_MAX];
    int length = snprintf(folder, sizeof folder, "%s/figures", result);
    if (length < 0 || length >= (int)sizeof folder)
        return REFUSE(err, "the result folder's path is too long");
    return folder_make(folder, err);
}

// All names are checked before anything is read or drawn.
static bool request_check(const char *folder, const PictureRequest *request, Error *err)
{
    struct stat about;
    Picture picture;
    const char *names[PANELS_MAX];
    for (int32_t k = 0; k < picture_count(request); ++k)
        if (!find_picture(request, k, &picture, err)) return false;
    for (int32_t k = 0; request->panels && k < picture.count; ++k) names[k] = picture.parts[k].name;
    const char *const *asked = request->panels ? names : request->figures;
    int32_t count = request->panels ? picture.count : request->figure_count;
    if (count > 0 && !picture_options_fit(&request->style, &request->field, asked, count, err))
        return false;
    if (stat(folder, &about) != 0)
        return REFUSE(err, "cannot find the result folder %s: %s", folder, strerror(errno));
    return S_ISDIR(about.st_mode) || REFUSE(err, "%s is not a folder", folder);
}

bool figure_is_there(const char *name, const ResultView *view)
{
    if (strcmp(name, FIGURES[FIGURE_STATE_MAP].name) == 0) return view->states > 0;
    return strcmp(name, FIGURES[FIGURE_CONTACT_PLANE].name) != 0 ||
           (view->line && view->rapid_count > 0 && result_file_has_faces(view->file));
}

// Who asks for all figures gets those that there are, and of fields those that have what is asked
// for. A strip needs a sliding with several times, and figures with axes of their own are of
// interest beside measurements: for who asks.
static bool is_drawn(const char *folder, const Figure *figure, const PictureRequest *request,
                     ResultView *view, bool *drawn, Error *err)
{
    const char *of = request->field.of;
    bool measured = false;
    if (!figure_data_measured(figure->name, request->style.compare, view, &measured, err))
        return false;
    *drawn = figure_is_there(figure->name, view) && (measured || !figure->shape->own_axes);
    if (figure->id == FIGURE_STRIP) *drawn = false;
    if (figure->id == FIGURE_CONTACT_PLANE)
        *drawn = *drawn && (!of || figure_contact_plane_shows(view, of));
    if (figure->id == FIGURE_FIELD)
        *drawn = figure_field_shows(folder, of) ||
                 (figure_field_shows(folder, NULL) && !figure_contact_plane_shows(view, of));
    return true;
}

// Measurements that none of the figures named would show were given for nothing.
static bool check_compare(const PictureRequest *request, ResultView *view, Error *err)
{
    const char *compare = request->style.compare;
    bool shows = !compare || (request->figure_count == 0 && !request->panels);
    for (int32_t k = 0; k < picture_count(request) && !shows; ++k) {
        Picture picture;
        if (!find_picture(request, k, &picture, err)) return false;
        for (int32_t i = 0; i < picture.count && !shows; ++i)
            if (!figure_data_measured(picture.parts[i].name, compare, view, &shows, err))
                return false;
    }
    for (int32_t k = 0; k < FIGURE_COUNT && !shows; ++k) {
        if (!figure_data_measured(FIGURES[k].name, compare, view, &shows, err)) return false;
        if (shows)
            return REFUSE(err, "measurements %s: the figure that shows them is %s", compare,
                          FIGURES[k].name);
    }
    return true;
}

// One open result serves all pictures.
__attribute__((visibility("default"))) bool
amontons_render(const char *folder, const PictureRequest *request, Error *err)
{
    ResultView view = {0};
    TRY(request_check(folder, request, err));
    TRY(result_view_open(folder, &view, err));
    TRY(check_compare(request, &view, err));
    if (request->style.line) TRY(result_view_choose_line(&view, request->style.line, err));
    TRY(make_figures_folder(folder, err));
    for (int32_t k = 0; k < picture_count(request); ++k) {
        Picture picture;
        bool drawn = true;
        TRY(find_picture(request, k, &picture, err));
        if (request->figure_count == 0 && !request->panels)
            TRY(is_drawn(folder, picture.figure, request, &view, &drawn, err));
        if (drawn) TRY(make_picture(folder, request, &picture, &view, err));
    }
cleanup:
    result_view_close(&view);
    return error_is_clean(err);
}
