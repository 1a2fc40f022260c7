// SPDX-License-Identifier: GPL-2.0-or-later
// The module's entry: which figures, a fresh page and a file for each.
#include "render/render.h"

#include "io/files/folder.h"
#include "render/canvas/foot.h"
#include "render/figure_data.h"
#include "render/figures/figures.h"
#include "render/panels.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAMES_SIZE = 240 };

static const double FORCE_PLAIN = 0.62;   // of force without an inset: height over width

typedef enum FigureId {
#define X(symbol, name, title) symbol,
    RENDER_FIGURES(X) FIGURE_COUNT
#undef X
} FigureId;

typedef struct Figure {
    const char *name, *title;
    double height_over_width;
    FigureFunction draw;
    bool own_axes;   // no U along x: it cannot be a panel, and is drawn for who asks
    WholeFigureFunction draw_whole;   // in its place: begins the page itself, and needs fields
} Figure;

// The table of figures: names from the contract, shapes and functions from here.
static Figure figure_get(FigureId id)
{
    static const char *const name_title[FIGURE_COUNT][2] = {
#define X(symbol, name, title) {name, title},
        RENDER_FIGURES(X)
#undef X
    };
    Figure figure = {.name = name_title[id][0], .title = name_title[id][1]};
    switch (id) {
    case FIGURE_FORCE:
        figure.height_over_width = 0.85;
        figure.draw = figure_force;
        break;
    case FIGURE_SLIP_MAP:
        figure.height_over_width = 0.62;
        figure.draw = figure_slip_map;
        break;
    case FIGURE_CONTACT_DENSITY:
        figure.height_over_width = 0.62;
        figure.draw = figure_contact_density;
        break;
    case FIGURE_STATE_MAP:
        figure.height_over_width = 0.62;
        figure.draw = figure_state_map;
        break;
    case FIGURE_CONTACT_PLANE:
        figure.draw_whole = figure_contact_plane;
        break;
    case FIGURE_PRECURSORS:
    case FIGURE_FRONT_SPEED:
        figure.height_over_width = 0.62;
        figure.own_axes = true;
        figure.draw = id == FIGURE_PRECURSORS ? figure_precursors : figure_front_speed;
        break;
    case FIGURE_FIELD:
        figure.draw_whole = figure_field;
        break;
    case FIGURE_STRIP:
    case FIGURE_COUNT:
        figure.draw_whole = figure_strip;
        break;
    }
    return figure;
}

// Height over width on a column.
static double figure_shape(const Figure *figure, const ResultView *view, const PictureStyle *style)
{
    bool plain = figure->draw == figure_force && !figure_force_enlarges(view, style);
    return plain ? FORCE_PLAIN : figure->height_over_width;
}

// The figure called `name`, or ERROR_INPUT with the names there are.
static bool figure_find(const char *name, Figure *figure, Error *err)
{
    char names[NAMES_SIZE] = "";
    for (int32_t k = 0; k < FIGURE_COUNT; ++k) {
        *figure = figure_get((FigureId)k);
        if (strcmp(figure->name, name) == 0) return true;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "", figure->name);
    }
    FAIL(err, ERROR_INPUT, "there is no figure called \"%s\"; known are: %s", name, names);
cleanup:
    return false;
}

// "field", or "field-stress_xx" where that was asked for; of panels `figure` is NULL.
static bool figure_path(const char *folder, const PictureRequest *request, const Figure *figure,
                        char path[PATH_MAX], Error *err)
{
    const char *of = figure && figure->draw_whole ? request->field.of : NULL;
    int length =
        snprintf(path, PATH_MAX, "%s/figures/%s%s%s.%s", folder, figure ? figure->name : "panels",
                 of ? "-" : "", of ? of : "",
                 request->style.format ? request->style.format : canvas_ending(CANVAS_PNG));
    if (length < 0 || length >= PATH_MAX)
        FAIL(err, ERROR_INPUT, "the result folder's path is too long");
cleanup:
    return error_is_clean(err);
}

// The figures that `panels` names, separated by commas.
static bool panels_find(const char *names, PanelFigure list[PANELS_MAX], int32_t *count, Error *err)
{
    char name[32];
    Figure figure;
    *count = 0;
    for (const char *at = names; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        TRY(figure_find(name, &figure, err));
        if (!figure.draw || figure.own_axes)
            FAIL(err, ERROR_INPUT, "panels are figures over U: %s cannot be one", name);
        if (*count == PANELS_MAX) FAIL(err, ERROR_INPUT, "a page takes %d panels", PANELS_MAX);
        list[(*count)++] = (PanelFigure){figure.name, figure.height_over_width, figure.draw, 0};
    }
    if (*count == 0) FAIL(err, ERROR_INPUT, "no panel is named");
cleanup:
    return error_is_clean(err);
}

// Of several states each is a panel.
static bool spread_states(const ResultView *view, PanelFigure list[PANELS_MAX], int32_t *count,
                          Error *err)
{
    int32_t more = view->states - 1;
    for (int32_t k = *count - 1; k >= 0 && more > 0; --k) {
        if (list[k].draw != figure_state_map) continue;
        if (*count + more > PANELS_MAX)
            FAIL(err, ERROR_INPUT, "a page takes %d panels", PANELS_MAX);
        memmove(list + k + 1 + more, list + k + 1, (size_t)(*count - k - 1) * sizeof *list);
        for (int32_t i = 1; i <= more; ++i) list[k + i] = list[k];
        for (int32_t i = 1; i <= more; ++i) list[k + i].state = i;
        *count += more;
    }
cleanup:
    return error_is_clean(err);
}

// On a fresh page, to be finished.
static bool draw(const char *folder, const PictureRequest *request, const Figure *figure,
                 ResultView *view, Page *page, Error *err)
{
    const PictureStyle *style = &request->style;
    bool warns = !style->warnings || strcmp(style->warnings, "none") != 0;
    Foot foot = foot_wrap(warns ? view->warnings : "", page_width(style));
    PageDef def = {
        .style = style, .title = page_title(style, view->title, false), .foot = foot_height(&foot)};
    FigureInput input = {.view = view, .folder = folder, .field = &request->field};
    PanelFigure panels[PANELS_MAX];
    Figure known;
    int32_t count = 0;
    if (!figure || (figure->draw == figure_state_map && view->states > 1)) {
        TRY(panels_find(figure ? figure->name : request->panels, panels, &count, err));
        TRY(spread_states(view, panels, &count, err));
        for (int32_t k = 0; k < count; ++k) {
            TRY(figure_find(panels[k].name, &known, err));
            panels[k].shape = figure_shape(&known, view, style);
        }
        TRY(panels_draw(page, &def, panels, count, view, err));
    } else if (figure->draw_whole) {
        input.def = def;
        TRY(figure->draw_whole(page, &input, err));
    } else {
        def.height = page_shape(style, figure_shape(figure, view, style));
        TRY(page_begin(page, &def, err));
        TRY(figure->draw(page, view, err));
    }
    foot_draw(page, &foot);
cleanup:
    error_context(err, "figure %s", figure ? figure->name : "panels");
    return error_is_clean(err);
}

static bool write_data(const char *folder, const PictureRequest *request, const Figure *figure,
                       ResultView *view, Error *err)
{
    PanelFigure panels[PANELS_MAX] = {{.name = figure ? figure->name : NULL}};
    int32_t count = 1;
    if (!figure) TRY(panels_find(request->panels, panels, &count, err));
    for (int32_t k = 0; k < count; ++k)
        TRY(figure_data_write(folder, panels[k].name, view, request->style.compare, err));
cleanup:
    return error_is_clean(err);
}

// One picture from nothing to its file. Whatever fails, all that was made for it is freed.
static bool figure_make(const char *folder, const PictureRequest *request, const Figure *figure,
                        ResultView *view, Error *err)
{
    Page page = {0};
    char path[PATH_MAX];
    TRY(figure_path(folder, request, figure, path, err));
    TRY(draw(folder, request, figure, view, &page, err));
    TRY(page_finish(&page, path, figure ? figure->title : view->title, err));
    TRY(write_data(folder, request, figure, view, err));
cleanup:
    page_destroy(&page);
    return error_is_clean(err);
}

bool figure_draw(const char *name, ResultView *view, const PictureStyle *style, Page *page,
                 Error *err)
{
    Figure figure;
    PictureRequest request = {.style = *style};
    return figure_find(name, &figure, err) && draw("", &request, &figure, view, page, err);
}

static bool make_figures_folder(const char *result, Error *err)
{
    char folder[PATH_MAX];
    int length = snprintf(folder, sizeof folder, "%s/figures", result);
    if (length < 0 || length >= (int)sizeof folder)
        FAIL(err, ERROR_INPUT, "the result folder's path is too long");
    TRY(folder_make(folder, err));
cleanup:
    return error_is_clean(err);
}

// All names are checked before anything is read or drawn.
static bool request_check(const char *folder, const PictureRequest *request, Error *err)
{
    struct stat about;
    Figure figure;
    for (int32_t k = 0; k < request->figure_count; ++k)
        TRY(figure_find(request->figures[k], &figure, err));
    PanelFigure panels[PANELS_MAX];
    int32_t count = 0;
    if (request->panels) TRY(panels_find(request->panels, panels, &count, err));
    if (stat(folder, &about) != 0)
        FAIL(err, ERROR_INPUT, "cannot find the result folder %s: %s", folder, strerror(errno));
    if (!S_ISDIR(about.st_mode)) FAIL(err, ERROR_INPUT, "%s is not a folder", folder);
cleanup:
    return error_is_clean(err);
}

static bool has_fields(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/fields.pvd", folder);
    return access(path, R_OK) == 0;
}

// Who asks for all figures gets those that there are. field-strip needs a sliding with several
// times: for who asks. Likewise contact-plane without an event.
static bool is_there(FigureId id, const char *folder, const PictureRequest *request,
                     ResultView *view)
{
    const char *of = request->field.of;
    if (id == FIGURE_FIELD)
        return has_fields(folder) &&
               (!of || figure_field_shows(of) || !figure_contact_plane_shows(view, of));
    if (id != FIGURE_CONTACT_PLANE || (of && !figure_contact_plane_shows(view, of))) return false;
    return view->line && view->rapid_count > 0 && result_file_has_faces(view->file);
}

// Where no figure is named: a strip needs a sliding with several times, and figures with axes of
// their own are of interest beside measurements.
static bool is_drawn(const char *folder, FigureId id, const PictureRequest *request,
                     ResultView *view, bool *drawn, Error *err)
{
    Figure figure = figure_get(id);
    bool measured = false;
    TRY(figure_data_measured(figure.name, request->style.compare, view, &measured, err));
    *drawn = figure.draw_whole ? is_there(id, folder, request, view) : measured || !figure.own_axes;
    if (id == FIGURE_STATE_MAP) *drawn = view->states > 0;
cleanup:
    return error_is_clean(err);
}

// Measurements that none of the figures named would show were given for nothing.
static bool check_compare(const PictureRequest *request, ResultView *view, Error *err)
{
    const char *compare = request->style.compare;
    PanelFigure panels[PANELS_MAX];
    int32_t count = request->figure_count;
    bool shows = !compare || (count == 0 && !request->panels);
    if (request->panels) TRY(panels_find(request->panels, panels, &count, err));
    for (int32_t k = 0; k < count && !shows; ++k) {
        const char *name = request->panels ? panels[k].name : request->figures[k];
        TRY(figure_data_measured(name, compare, view, &shows, err));
    }
    for (int32_t k = 0; k < FIGURE_COUNT && !shows; ++k) {
        const char *name = figure_get((FigureId)k).name;
        TRY(figure_data_measured(name, compare, view, &shows, err));
        if (shows)
            FAIL(err, ERROR_INPUT, "measurements %s: the figure that shows them is %s", compare,
                 name);
    }
cleanup:
    return error_is_clean(err);
}

// One open result serves all pictures.
__attribute__((visibility("default"))) bool
amontons_render(const char *folder, const PictureRequest *request, Error *err)
{
    ResultView view = {0};
    bool drawn = true;
    int32_t count = request->figure_count > 0 ? request->figure_count : FIGURE_COUNT;
    TRY(request_check(folder, request, err));
    TRY(result_view_open(folder, &view, err));
    TRY(check_compare(request, &view, err));
    if (request->style.line) TRY(result_view_choose_line(&view, request->style.line, err));
    TRY(make_figures_folder(folder, err));
    if (request->panels) {
        TRY(figure_make(folder, request, NULL, &view, err));
        count = 0;
    }
    for (int32_t k = 0; k < count; ++k) {
        Figure figure = figure_get((FigureId)k);
        if (request->figure_count > 0) TRY(figure_find(request->figures[k], &figure, err));
        if (request->figure_count == 0)
            TRY(is_drawn(folder, (FigureId)k, request, &view, &drawn, err));
        if (!drawn) continue;
        TRY(figure_make(folder, request, &figure, &view, err));
    }
cleanup:
    result_view_close(&view);
    return error_is_clean(err);
}
