// SPDX-License-Identifier: GPL-2.0-or-later
// Frames wait in a ring of few: one is encoded, one is ready, one is being filled.
#include "render/film/film_sink.h"

#include "base/decimal_point.h"
#include "base/memory.h"
#include "io/files/folder.h"
#include "io/files/own_list.h"
#include "io/files/part_file.h"
#include "render/canvas/color.h"
#include "render/canvas/png_encode.h"

#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SLOTS = 3, DIGITS = 4, DIGITS_MAX = 9, PALETTE_SIZE = 256 };
enum { MAP_COLORS = 160, GREYS = 40, TINTS = 9 };   // of a GIF's palette

static const double DENSITY = 96 / 0.0254;   // pixels a metre: a film has no printed size
static const char ENDINGS[] =
    "a film ends in .mp4, .webm or .gif; PNG frames go into a folder (frames/) or after a pattern "
    "(frames/run-%04d.png)";

// Names of PNGs: before the number, its digits, behind it.
typedef struct Pattern {
    char before[PATH_MAX];
    int32_t digits;
    char behind[NAME_MAX + 1];
} Pattern;

struct FilmSink {
    VideoDef def;
    VideoFile *video;   // owned; NULL: PNGs
    Pattern pattern;
    uint8_t *slot[SLOTS];   // [height * width * 4] owned
    pthread_t thread;
    bool running;
    pthread_mutex_t lock;   // of what follows
    pthread_cond_t changed;
    int32_t filled, encoded;   // frames so far
    bool over;   // no frame follows
    Error failure;   // of the thread
};

// --- names ---------------------------------------------------------------------------------------

// Place in the name of a file, without its folder, where a number is to stand; NULL: there is none.
// A folder may be called `50% load`, and so may a film.
static const char *find_mark(const char *path)
{
    const char *slash = strrchr(path, '/');
    return video_file_is_known(path) ? NULL : strchr(slash ? slash : path, '%');
}

// "run-%04d.png" in its three parts; never handed to printf.
static bool pattern_read(const char *path, Pattern *pattern, Error *err)
{
    const char *mark = find_mark(path), *d = mark + 1;
    size_t length = (size_t)(mark - path);
    pattern->digits = 0;
    for (; *d >= '0' && *d <= '9' && pattern->digits <= DIGITS_MAX; ++d)
        pattern->digits = 10 * pattern->digits + (*d - '0');
    size_t ending = strlen(d);
    bool is_png = ending > 4 && strcmp(d + ending - 4, ".png") == 0;
    if (*d != 'd' || strchr(d, '%') || !is_png || pattern->digits > DIGITS_MAX ||
        ending > NAME_MAX || length >= PATH_MAX)
        return REFUSE(err, "%s: a pattern of frames has one number and ends in .png: run-%%04d.png",
                      path);
    memcpy(pattern->before, path, length);
    pattern->before[length] = '\0';
    snprintf(pattern->behind, sizeof pattern->behind, "%s", d + 1);
    return true;
}

bool film_sink_check(const char *path, Error *err)
{
    Pattern pattern;
    if (find_mark(path)) return pattern_read(path, &pattern, err);

    // A folder's name has no ending, ends in a slash, or is that of one.
    struct stat status;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    bool is_there = stat(path, &status) == 0;
    bool is_folder = is_there ? S_ISDIR(status.st_mode) : name[0] == '\0' || !strchr(name, '.');
    if (path[0] && (video_file_is_known(path) || is_folder)) return true;
    return REFUSE(err, "%s: %s", path, ENDINGS);
}

static void frame_path(const Pattern *pattern, int32_t frame, char path[2 * PATH_MAX])
{
    snprintf(path, 2 * PATH_MAX, "%s%0*d%s", pattern->before, pattern->digits, frame,
             pattern->behind);
}

// frames/frame-0001.png, or as the pattern says.
static bool frames_begin(FilmSink *sink, Error *err)
{
    const char *path = sink->def.path;
    Pattern *pattern = &sink->pattern;
    char folder[PATH_MAX], first[2 * PATH_MAX];
    if (find_mark(path)) {
        if (!pattern_read(path, pattern, err)) return false;
    } else {
        bool slash = path[strlen(path) - 1] == '/';
        snprintf(pattern->before, sizeof pattern->before, "%s%sframe-", path, slash ? "" : "/");
        snprintf(pattern->behind, sizeof pattern->behind, ".png");
        pattern->digits = DIGITS;
    }
    snprintf(folder, sizeof folder, "%s", pattern->before);
    char *last = strrchr(folder, '/');
    if (last && last != folder) {
        *last = '\0';
        if (!folder_make(folder, err)) return false;
    }
    if (!find_mark(path) && !(own_list_check(folder, err) && own_list_make(folder, err)))
        return false;
    frame_path(pattern, 1, first);
    if (access(first, F_OK) == 0 && !sink->def.overwrite)
        return REFUSE(
            err,
            "%s is there already: name another folder, say --overwrite, or remove those frames",
            first);
    return true;
}

// --- encoding ------------------------------------------------------------------------------------

typedef struct PngTarget {
    PartFile part;
    Error *err;
} PngTarget;

// The disk's own words come before those of png_encode, and stay.
static bool bytes_add(void *self, const uint8_t *bytes, size_t length)
{
    PngTarget *target = self;
    return part_file_write(&target->part, bytes, (int64_t)length, target->err);
}

static bool png_write(const FilmSink *sink, const uint8_t *pixels, int32_t frame, Error *err)
{
    char path[2 * PATH_MAX];
    PngTarget target = {.err = err};
    PngPicture picture = {.width = sink->def.width,
                          .height = sink->def.height,
                          .stride = 4 * sink->def.width,
                          .pixels = pixels,
                          .pixels_per_metre = DENSITY,
                          .title = sink->def.title};
    frame_path(&sink->pattern, frame, path);
    TRY(part_file_replace(&target.part, path, sink->def.overwrite, err));
    TRY(png_encode(&picture, bytes_add, &target, err));
    TRY(part_file_commit(&target.part, err));
cleanup:
    part_file_discard(&target.part);
    return error_is_clean(err);
}

// Takes one frame after the other until none follows, or one fails.
static void *encode(void *self)
{
    NUMBERS_HAVE_A_POINT;
    FilmSink *sink = self;
    Error err = {0};
    pthread_mutex_lock(&sink->lock);
    while (error_is_clean(&err)) {
        while (sink->encoded == sink->filled && !sink->over)
            pthread_cond_wait(&sink->changed, &sink->lock);
        if (sink->encoded == sink->filled) break;
        const uint8_t *pixels = sink->slot[sink->encoded % SLOTS];
        pthread_mutex_unlock(&sink->lock);
        if (sink->video)
            video_file_add(sink->video, pixels, 4 * sink->def.width, &err);
        else
            png_write(sink, pixels, sink->encoded + 1, &err);
        pthread_mutex_lock(&sink->lock);
        ++sink->encoded;
        sink->failure = err;
        pthread_cond_broadcast(&sink->changed);
    }
    pthread_mutex_unlock(&sink->lock);
    return NULL;
}

// --- the sink ------------------------------------------------------------------------------------

FilmSink *film_sink_create(const VideoDef *def, Error *err)
{
    uint8_t palette[3 * PALETTE_SIZE];
    VideoDef video = *def;
    FilmSink *sink = NULL;
    TRY(film_sink_check(def->path, err));
    TRY(sink = NEW_ARRAY(FilmSink, 1, err));
    sink->def = *def;
    pthread_mutex_init(&sink->lock, NULL);
    pthread_cond_init(&sink->changed, NULL);

    // Colours of the pictures: the colour map, greys, and six tints up to white.
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
    for (; n < PALETTE_SIZE; ++n) memset(palette + 3 * n, 255, 3);
    video.palette = palette;
    for (int32_t k = 0; k < SLOTS; ++k)
        TRY(sink->slot[k] = memory_bytes(4 * (int64_t)def->width * def->height, err));
    if (video_file_is_known(def->path))
        TRY(sink->video = video_file_create(&video, err));
    else
        TRY(frames_begin(sink, err));
    if (pthread_create(&sink->thread, NULL, encode, sink) != 0)
        FAIL(err, ERROR_MEMORY, "no thread to encode the film in");
    sink->running = true;
    return sink;
cleanup:
    film_sink_destroy(sink);
    return NULL;
}

bool film_sink_add(FilmSink *sink, const uint8_t *pixels, int32_t stride, Error *err)
{
    pthread_mutex_lock(&sink->lock);
    while (sink->filled - sink->encoded == SLOTS && error_is_clean(&sink->failure))
        pthread_cond_wait(&sink->changed, &sink->lock);
    *err = sink->failure;
    pthread_mutex_unlock(&sink->lock);
    if (!error_is_clean(err)) return false;
    uint8_t *slot = sink->slot[sink->filled % SLOTS];
    size_t line = 4 * (size_t)sink->def.width;
    for (int32_t row = 0; row < sink->def.height; ++row)
        memcpy(slot + (size_t)row * line, pixels + (int64_t)row * stride, line);
    pthread_mutex_lock(&sink->lock);
    ++sink->filled;
    pthread_cond_broadcast(&sink->changed);
    pthread_mutex_unlock(&sink->lock);
    return true;
}

static void thread_end(FilmSink *sink)
{
    if (!sink->running) return;
    pthread_mutex_lock(&sink->lock);
    sink->over = true;
    pthread_cond_broadcast(&sink->changed);
    pthread_mutex_unlock(&sink->lock);
    pthread_join(sink->thread, NULL);
    sink->running = false;
}

bool film_sink_finish(FilmSink *sink, Error *err)
{
    thread_end(sink);
    *err = sink->failure;
    if (!error_is_clean(err)) return false;
    if (sink->video) return video_file_finish(sink->video, err);

    // Frames of a longer film of ours, in a folder of ours, would seem to be of this one.
    for (int32_t frame = sink->filled + 1; sink->def.overwrite; ++frame) {
        char path[2 * PATH_MAX];
        bool ours = false;
        Error unseen = {0};
        frame_path(&sink->pattern, frame, path);
        if (!own_list_has(path, &ours, &unseen) || !ours || unlink(path) != 0) break;
    }
    return true;
}

void film_sink_destroy(FilmSink *sink)
{
    if (!sink) return;
    thread_end(sink);
    video_file_destroy(sink->video);
    for (int32_t k = 0; k < SLOTS; ++k) memory_free(sink->slot[k]);
    pthread_cond_destroy(&sink->changed);
    pthread_mutex_destroy(&sink->lock);
    memory_free(sink);
}
