// SPDX-License-Identifier: GPL-2.0-or-later
// Where the frames of a film go: one file (io/video/video_file), or PNGs in a folder. A thread of
// its own encodes while the next frame is drawn. Called by film.
#ifndef AMONTONS_RENDER_FILM_FILM_SINK_H
#define AMONTONS_RENDER_FILM_FILM_SINK_H

#include "base/error.h"

typedef struct FilmSink FilmSink;

typedef struct FilmSinkDef {
    // film.mp4, .webm, .gif; of PNGs a folder, or a pattern with one number: run-%04d.png
    const char *path;
    int32_t width, height, rate;   // pixels; frames a second
    const char *title;
    bool overwrite;   // also files that are not ours; frames of PNG that are there
} FilmSinkDef;

// ERROR_INPUT lists the endings there are.
bool film_sink_check(const char *path, Error *err);

// Makes the folder of PNGs; refuses one that has frames already (ERROR_INPUT).
FilmSink *film_sink_create(const FilmSinkDef *def, Error *err);
// pixels: as io/video/video_file has them. Not kept. The error may be that of an earlier frame.
bool film_sink_add(FilmSink *sink, const uint8_t *pixels, int32_t stride, Error *err);
// Waits for all frames; a file gets its final name.
bool film_sink_finish(FilmSink *sink, Error *err);
// Without finish no file is left, of PNGs those that are whole. NULL is fine.
void film_sink_destroy(FilmSink *sink);

#endif
