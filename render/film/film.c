// SPDX-License-Identifier: GPL-2.0-or-later
// A film of a result, frame by frame: which part of the run, how fast its time goes, the page, and
// the file it goes into.
#include "render/film/film_page.h"
#include "render/film/film_sink.h"
#include "render/picture_options.h"
#include "render/render.h"

#include "base/memory.h"
#include "io/hdf5/result_tables.h"

#include <math.h>

static const double SECONDS = 20, SECONDS_MAX = 3600;
static const double EASE = 0.5, EASE_SHARE = 1.0 / 40;   // s of film; of all of it, at most

enum { RATE = 30, RATE_MAX = 240, FRAMES_MAX = 100000 };
enum { WIDTH = 1920, HEIGHT = 1080, WIDTH_LEAST = 640, HEIGHT_LEAST = 360 };
enum { GIF_RATE = 20, GIF_WIDTH = 800, GIF_HEIGHT = 450 };

// Fills in the parts of the request that were left open, and checks it.
static bool complete(const FilmRequest *request, FilmRequest *film, int32_t *frames, Error *err)
{
    *film = *request;
    if (!film->path || !film->path[0]) return REFUSE(err, "the film needs a name");
    if (!film_sink_check(film->path, err)) return false;
    bool gif = video_file_is_gif(film->path);
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
    return picture_options_fit_taker(&film->style, TAKEN_BY_FILMS, err);
}

__attribute__((visibility("default"))) bool
amontons_render_film(const char *folder, const FilmRequest *request, Error *err)
{
    FilmRequest film;
    FilmClock clock = {0};
    ResultView view = {0};
    FilmPage *page = NULL;
    FilmSink *sink = NULL;
    double *fastest = NULL, t[2] = {0, 0};
    int32_t frames = 0;
    TRY(complete(request, &film, &frames, err));
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
                        .rate = film.rate,
                        .ease = fmin(EASE, EASE_SHARE * film.seconds)};
    TRY(film_clock_create(&run, &clock, err));

    // The page, the file, and frame by frame from one to the other.
    FilmPageDef def = {folder, &view, &clock, &film, page_title(style, view.title, true)};
    TRY(page = film_page_create(&def, err));
    VideoDef file = {film.path,  film.width, film.height,     film.rate,
                     view.title, NULL,       style->overwrite};
    TRY(sink = film_sink_create(&file, err));
    for (int32_t k = 0; k < frames; ++k) {
        const uint8_t *pixels = NULL;
        int32_t stride = 0;
        if (film.stop && *film.stop)
            FAIL(err, ERROR_INTERRUPT, "stopped after %d of %d frames; there is no film", k,
                 frames);
        TRY(film_page_show(page, k, &pixels, &stride, err));
        TRY(film_sink_add(sink, pixels, stride, err));
        if (film.on_frame) film.on_frame(k + 1, frames, film.context);
    }
    TRY(film_sink_finish(sink, err));
    if (film.still) *film.still = (double)film_page_still(page) / film.rate;
cleanup:
    memory_free(fastest);
    film_sink_destroy(sink);
    film_page_destroy(page);
    film_clock_destroy(&clock);
    result_view_close(&view);
    return error_is_clean(err);
}
