// SPDX-License-Identifier: GPL-2.0-or-later
// The module's entry: which figures, a fresh page and a file for each.
#include "render/render.h"

#include "io/files/folder.h"
#include "render/figure_data.h"
#include "render/figures/picture.h"
#include "render/picture_options.h"
#include "render/view/zoom.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

// The figures that `names` has, separated by commas.
static bool find_panels(const char *names, Picture *picture, Error *err)
{
    char name[32];
    for (const char *at = names; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        const Figure *figure = NULL;
        if (!figure_find(name, &figure, err)) return false;
        if (!figure->kind->draw || figure->kind->own_axes)
            return REFUSE(err, "panels are figures over U: %s cannot be one", name);
        if (!picture_add(picture, figure, err)) return false;
    }
    return picture->count > 0 || REFUSE(err, "no panel is named");
}

// Finds the k-th picture of those that are asked for; if none is named, of all that there are.
static bool find_picture(const PictureRequest *request, int32_t k, Picture *picture, Error *err)
{
    *picture = (Picture){0};
    if (request->panels) return find_panels(request->panels, picture, err);
    picture->figure = figure_get((FigureId)(k % FIGURE_COUNT));
    if (request->figure_count > 0 && !figure_find(request->figures[k], &picture->figure, err))
        return false;
    return picture_add(picture, picture->figure, err);
}

// The one name "measured": all figures that show what the measurements have, and no others.
static bool wants_measured(const PictureRequest *request)
{
    return request->figure_count == 1 && strcmp(request->figures[0], "measured") == 0;
}

static int32_t picture_count(const PictureRequest *request)
{
    return request->panels ? 1 : request->figure_count > 0 ? request->figure_count : FIGURE_COUNT;
}

// One picture from nothing to its file. Whatever fails, all that was made for it is freed.
static bool make_picture(const char *folder, const PictureRequest *request, const Picture *picture,
                         ResultView *view, Error *err)
{
    Page page = {0};
    char path[PATH_MAX];
    const Figure *figure = picture->figure;

    // "field", or "field-stress_xx" where that was asked for.
    bool takes = figure && figure->kind->draw_whole && figure->id != FIGURE_PROFILE;
    const char *of = takes ? request->field.of : NULL;
    int length =
        snprintf(path, PATH_MAX, "%s/figures/%s%s%s.%s", folder, figure ? figure->name : "panels",
                 of ? "-" : "", of ? of : "",
                 request->style.format ? request->style.format : canvas_ending(CANVAS_PNG));
    TRY((length >= 0 && length < PATH_MAX) || REFUSE(err, "the result folder's path is too long"));

    TRY(picture_draw(picture, folder, request, view, &page, err));
    TRY(page_finish(&page, path, figure ? figure->title : view->title, err));
    for (int32_t k = 0; k < picture->count; ++k)
        TRY(figure_data_write(folder, picture->panels[k].figure, view, &request->field,
                              request->style.compare, err));
cleanup:
    page_destroy(&page);
    return error_is_clean(err);
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
    for (int32_t k = 0; request->panels && k < picture.count; ++k)
        names[k] = picture.panels[k].figure->name;
    const char *const *asked = request->panels ? names : request->figures;
    int32_t count = request->panels ? picture.count : request->figure_count;
    if (count > 0 && !picture_options_fit(&request->style, &request->field, asked, count, err))
        return false;
    if (stat(folder, &about) != 0)
        return REFUSE(err, "cannot find the result folder %s: %s", folder, strerror(errno));
    return S_ISDIR(about.st_mode) || REFUSE(err, "%s is not a folder", folder);
}

// Who asks for all figures gets those that there are, and of fields those that have what is asked
// for.
static bool is_drawn(const char *folder, const Figure *figure, const PictureRequest *request,
                     ResultView *view, bool *drawn, Error *err)
{
    const char *of = request->field.of;
    bool measured = false;
    if (!figure_data_measured(figure, request->style.compare, view, &measured, err)) return false;
    *drawn = figure_is_there(figure, view) && (measured || !figure->kind->asked_only);
    if (figure->id == FIGURE_CONTACT_PLANE)
        *drawn = *drawn && (!of || figure_contact_plane_shows(view, of));
    bool probes = of && view->probes > 0 && figure_probes_show(of);
    if (figure->id == FIGURE_PROBES) *drawn = *drawn && (!of || probes);
    if (figure->id == FIGURE_FIELD)
        *drawn = figure_field_shows(folder, of) || (figure_field_shows(folder, NULL) && !probes &&
                                                    !figure_contact_plane_shows(view, of));
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
            if (!figure_data_measured(picture.panels[i].figure, compare, view, &shows, err))
                return false;
    }
    for (int32_t k = 0; k < FIGURE_COUNT && !shows; ++k) {
        const Figure *figure = figure_get((FigureId)k);
        if (!figure_data_measured(figure, compare, view, &shows, err)) return false;
        if (shows)
            return REFUSE(err, "measurements %s: the figure that shows them is %s", compare,
                          figure->name);
    }
    return true;
}

// One open result serves all pictures.
__attribute__((visibility("default"))) bool amontons_render(const char *folder,
                                                            const PictureRequest *asked, Error *err)
{
    ResultView view = {0};
    PictureRequest taken = *asked;
    const PictureRequest *request = &taken;
    bool measured = wants_measured(asked);
    if (measured) taken.figure_count = 0;
    if (measured && !asked->style.compare)
        return REFUSE(err, "`measured` are the figures that show measurements: none are given");
    TRY(request_check(folder, request, err));
    TRY(result_view_open(folder, &view, err));
    TRY(check_compare(request, &view, err));
    if (request->style.line) TRY(result_view_choose_line(&view, request->style.line, err));
    if (request->style.cycle) TRY(zoom_choose_cycle(&view, request->style.cycle, err));
    TRY(make_figures_folder(folder, err));
    for (int32_t k = 0; k < picture_count(request); ++k) {
        Picture picture;
        bool drawn = true;
        TRY(find_picture(request, k, &picture, err));
        if (request->figure_count == 0 && !request->panels)
            TRY(is_drawn(folder, picture.figure, request, &view, &drawn, err));
        if (measured)
            TRY(figure_data_measured(picture.figure, request->style.compare, &view, &drawn, err));
        if (drawn) TRY(make_picture(folder, request, &picture, &view, err));
    }
    if (measured) TRY(figure_data_misfits(folder, &view, request->style.compare, err));
cleanup:
    result_view_close(&view);
    return error_is_clean(err);
}
