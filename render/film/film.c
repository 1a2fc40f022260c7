// SPDX-License-Identifier: GPL-2.0-or-later
// Makes a film of a result frame by frame: chooses the part of the run and how fast its time goes,
// and puts the page into the file.
#include "render/canvas/color.h"
#include "render/film/film_page.h"
#include "render/film/film_times.h"
#include "render/picture_options.h"
#include "render/render.h"

#include "base/memory.h"
#include "io/files/folder.h"
#include "io/files/own_list.h"
#include "io/hdf5/result_tables.h"
#include "io/video/video_file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const double SECONDS = 20, SECONDS_MAX = 3600;

enum { RATE = 30, RATE_MAX = 240, FRAMES_MAX = 100000 };
enum { WIDTH = 1920, HEIGHT = 1080, WIDTH_LEAST = 640, HEIGHT_LEAST = 360 };
enum { GIF_RATE = 20, GIF_WIDTH = 800, GIF_HEIGHT = 450 };
enum { GIF_COLORS = 256, MAP_COLORS = 160, GREYS = 40, TINTS = 9 };   // of a GIF's palette

// Finds the film's name: that of the frames, frames/frame-%04d.png, where a folder is given.
// Nothing is made.
static bool path_find(const char *given, char path[PATH_MAX], bool *is_folder, Error *err)
{
    // A folder's name has no ending, ends in a slash, or is that of one.
    struct stat status;
    const char *slash = strrchr(given, '/'), *name = slash ? slash + 1 : given;
    bool is_there = stat(given, &status) == 0;
    *is_folder = is_there ? S_ISDIR(status.st_mode) : !name[0] || !strpbrk(name, ".%");
    int length = snprintf(path, PATH_MAX, "%s%s%s", given, *is_folder && name[0] ? "/" : "",
                          *is_folder ? "frame-%04d.png" : "");
    if (length >= PATH_MAX)
        return REFUSE(err, "the name of the film has %d bytes: at most %d are allowed", length,
                      PATH_MAX - 1);
    return video_file_check_name(path, err);
}

// Makes the folder of PNG frames.
static bool folder_prepare(const char *path, bool is_folder, Error *err)
{
    char folder[PATH_MAX];
    const char *last = strrchr(path, '/');
    if (!last || last == path || !video_file_ends(path, ".png")) return true;
    snprintf(folder, sizeof folder, "%.*s", (int)(last - path), path);
    return folder_make(folder, err) &&
           (!is_folder || (own_list_check(folder, err) && own_list_make(folder, err)));
}

// Fills in the parts of the request that were left open, and checks it. path, is_folder: as
// path_find has them.
static bool complete(const FilmRequest *request, FilmRequest *film, int32_t *frames,
                     char path[PATH_MAX], bool *is_folder, Error *err)
{
    *film = *request;
    if (!film->path || !film->path[0]) return REFUSE(err, "the film needs a name");
    bool gif = video_file_ends(film->path, ".gif");
    if (film->seconds == 0) film->seconds = SECONDS;
    if (film->rate == 0) film->rate = gif ? GIF_RATE : RATE;
    if (film->width == 0 && film->height == 0) {
        film->width = gif ? GIF_WIDTH : WIDTH;
        film->height = gif ? GIF_HEIGHT : HEIGHT;
    }
    bool fits = film->width >= WIDTH_LEAST && film->width <= CANVAS_SIZE_MAX &&
                film->height >= HEIGHT_LEAST && film->height <= CANVAS_SIZE_MAX;
    if (!fits || film->width % 2 || film->height % 2)
        return REFUSE(
            err, "a film of %d by %d pixels: even numbers from %d by %d to %d by %d are allowed",
            film->width, film->height, WIDTH_LEAST, HEIGHT_LEAST, CANVAS_SIZE_MAX, CANVAS_SIZE_MAX);
    if (film->rate < 1 || film->rate > RATE_MAX)
        return REFUSE(err, "%d frames a second: from 1 to %d are allowed", film->rate, RATE_MAX);
    double count = film->seconds * film->rate;
    if (!(film->seconds > 0 && film->seconds <= SECONDS_MAX && count >= 2 && count <= FRAMES_MAX))
        return REFUSE(err, "a film of %g s at %d frames a second: it must have from 2 to %d frames",
                      film->seconds, film->rate, FRAMES_MAX);
    if (!(film->magnification >= 0) || !isfinite(film->magnification))
        return REFUSE(err, "a magnification of %g: it must be above 0", film->magnification);
    *frames = (int32_t)lround(count);
    return picture_options_fit_taker(&film->style, TAKEN_BY_FILMS, err) &&
           path_find(film->path, path, is_folder, err);
}

// Fills in the colours of the pictures: the colour map, greys, and six tints up to white.
static void palette_fill(uint8_t palette[3 * GIF_COLORS])
{
    static const uint8_t tint[][3] = {{13, 69, 140}, {191, 31, 31},  {237, 148, 20},
                                      {20, 89, 179}, {77, 158, 217}, {140, 20, 77}};
    uint8_t map[3 * MAP_SIZE];
    int32_t n = 0;
    color_map_fill(map);
    for (int32_t k = 0; k < MAP_COLORS; ++k, ++n)
        memcpy(palette + 3 * n, map + 3 * (k * (MAP_SIZE - 1) / (MAP_COLORS - 1)), 3);
    for (int32_t k = 0; k < GREYS; ++k, ++n) memset(palette + 3 * n, k * 255 / (GREYS - 1), 3);
    for (size_t c = 0; c < sizeof tint / sizeof *tint; ++c)
        for (int32_t k = 0; k < TINTS; ++k, ++n)
            for (int32_t part = 0; part < 3; ++part)
                palette[3 * n + part] =
                    (uint8_t)(tint[c][part] + (255 - tint[c][part]) * k / TINTS);
    for (; n < GIF_COLORS; ++n) memset(palette + 3 * n, 255, 3);
}

__attribute__((visibility("default"))) bool
amontons_render_film(const char *folder, const FilmRequest *request, Error *err)
{
    FilmRequest film;
    FilmClock clock = {0};
    ResultView view = {0};
    FilmPage *page = NULL;
    VideoFile *video = NULL;
    char path[PATH_MAX];
    uint8_t palette[3 * GIF_COLORS];
    double *fastest = NULL, t[2] = {0, 0};
    int32_t frames = 0;
    bool is_folder = false;
    TRY(complete(request, &film, &frames, path, &is_folder, err));
    TRY(result_view_open(folder, &view, err));
    TRY(result_view_read_slip_rate(&view, err));
    TRY(result_view_read_status(&view, err));
    double V = fabs(view.number[NUMBER_ROD_VELOCITY]);
    if (!(V > 0)) FAIL(err, ERROR_INPUT, "the result does not say how fast the rod moves");

    // The clock. fastest: the largest |slip rate| at each step, of nodes in contact: one that has
    // lifted off does not slip.
    const PictureStyle *style = &film.style;
    FilmSpan span = {style->from, style->to, style->cycle};
    TRY(film_span_find(&view, &span, t, err));
    TRY((fastest = NEW_ARRAY(double, view.rows, err)));
    for (int64_t row = 0; row < view.rows; ++row)
        for (int64_t i = row * view.nodes; i < (row + 1) * view.nodes; ++i)
            if (view.status[i] != STATUS_OPEN)
                fastest[row] = fmax(fastest[row], fabs(view.slip_rate[i]));
    FilmClockDef run = {.rows = view.rows,
                        .t = view.t,
                        .fastest = fastest,
                        .V = V,
                        .low = t[0],
                        .high = t[1],
                        .frames = frames,
                        .rate = film.rate};
    TRY(film_clock_create(&run, &clock, err));

    // The page, the file, and frame by frame from one to the other.
    FilmPageDef def = {folder, &view, &clock, &film, page_title(style, view.title, true)};
    TRY(page = film_page_create(&def, err));
    TRY(folder_prepare(path, is_folder, err));
    palette_fill(palette);
    VideoDef file = {path,       film.width, film.height,     film.rate,
                     view.title, palette,    style->overwrite};
    TRY(video = video_file_create(&file, err));
    for (int32_t k = 0; k < frames; ++k) {
        const uint8_t *pixels = NULL;
        int32_t stride = 0;
        if (film.stop && *film.stop)
            FAIL(err, ERROR_INTERRUPT, "stopped after %d of %d frames; %s", k, frames,
                 video_file_ends(path, ".png") ? "those that are written stay"
                                               : "there is no film");
        TRY(film_page_show(page, k, &pixels, &stride, err));
        TRY(video_file_add(video, pixels, stride, err));
        if (film.on_frame) film.on_frame(k + 1, frames, film.context);
    }
    TRY(video_file_finish(video, err));
    if (film.still) *film.still = (double)film_page_still(page) / film.rate;
cleanup:
    memory_free(fastest);
    video_file_destroy(video);
    film_page_destroy(page);
    film_clock_destroy(&clock);
    result_view_close(&view);
    return error_is_clean(err);
}
