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

// Finds the k-th picture of those that are asked for; if none is named, of all that there are.
static bool find_picture(const PictureRequest *request, int32_t k, Picture *picture, Error *err)
{
    *picture = (Picture){0};
    for (const char *at = request->panels; at && *at;) {   // names, separated by commas
        char name[32];
        size_t length = strcspn(at, ",");
        const Figure *figure = NULL;
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (!figure_find(name, &figure, err)) return false;
        if (!figure->kind->draw || figure->kind->own_axes)
            return REFUSE(err, "panels are figures over U: %s cannot be one", name);
        if (!picture_add(picture, figure, err)) return false;
        at += length + (at[length] == ',');
    }
    if (request->panels) return picture->count > 0 || REFUSE(err, "no panel is named");
    picture->figure = figure_get((FigureId)(k % FIGURE_COUNT));
    if (request->figure_count > 0 && !figure_find(request->figures[k], &picture->figure, err))
        return false;
    return picture_add(picture, picture->figure, err);
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
    const char *compare = asked->style.compare, *of = asked->field.of;
    Picture picture;
    struct stat about;

    // The one name "measured": all figures that show what the measurements have, and no others.
    bool measured = asked->figure_count == 1 && strcmp(asked->figures[0], "measured") == 0;
    if (measured) taken.figure_count = 0;
    if (measured && !compare)
        return REFUSE(err, "`measured` are the figures that show measurements: none are given");

    // All names are checked before anything is read or drawn.
    const char *names[PANELS_MAX];
    for (int32_t k = 0; k < picture_count(request); ++k)
        TRY(find_picture(request, k, &picture, err));
    for (int32_t k = 0; request->panels && k < picture.count; ++k)
        names[k] = picture.panels[k].figure->name;
    const char *const *named = request->panels ? names : request->figures;
    int32_t count = request->panels ? picture.count : request->figure_count;
    if (count > 0) TRY(picture_options_fit(&request->style, &request->field, named, count, err));
    if (stat(folder, &about) != 0)
        FAIL(err, ERROR_INPUT, "cannot find the result folder %s: %s", folder, strerror(errno));
    if (!S_ISDIR(about.st_mode)) FAIL(err, ERROR_INPUT, "%s is not a folder", folder);
    TRY(result_view_open(folder, &view, err));
    TRY(check_compare(request, &view, err));
    if (request->style.line) TRY(result_view_choose_line(&view, request->style.line, err));
    if (request->style.cycle) TRY(zoom_choose_cycle(&view, request->style.cycle, err));
    TRY(folder_make_inside(folder, "figures", err));
    for (int32_t k = 0; k < picture_count(request); ++k) {
        bool drawn = true;
        TRY(find_picture(request, k, &picture, err));
        const Figure *figure = picture.figure;
        if (request->figure_count == 0 && !request->panels) {
            // Who asks for all figures gets those that there are, and of fields those that have
            // what is asked for.
            bool of_probes = of && view.probes > 0 && figure_probes_show(of), shows = false;
            TRY(figure_data_measured(figure, compare, &view, &shows, err));
            drawn = figure_is_there(figure, &view) && (shows || !figure->kind->asked_only);
            if (figure->id == FIGURE_CONTACT_PLANE)
                drawn = drawn && (!of || figure_contact_plane_shows(&view, of));
            if (figure->id == FIGURE_PROBES) drawn = drawn && (!of || of_probes);
            if (figure->id == FIGURE_FIELD)
                drawn = figure_field_shows(folder, of) ||
                        (figure_field_shows(folder, NULL) && !of_probes &&
                         !figure_contact_plane_shows(&view, of));
        }
        if (measured) TRY(figure_data_measured(figure, compare, &view, &drawn, err));
        if (drawn) TRY(make_picture(folder, request, &picture, &view, err));
    }
    if (measured) TRY(figure_data_misfits(folder, &view, compare, err));
cleanup:
    result_view_close(&view);
    return error_is_clean(err);
}
