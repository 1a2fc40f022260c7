// SPDX-License-Identifier: GPL-2.0-or-later
// Where the frames of a film go: one file (io/video/video_file), or PNGs in a folder. A thread of
// its own encodes while the next frame is drawn. Called by film.
#ifndef AMONTONS_RENDER_FILM_FILM_SINK_H
#define AMONTONS_RENDER_FILM_FILM_SINK_H

#include "io/video/video_file.h"

typedef struct FilmSink FilmSink;

// ERROR_INPUT lists the endings there are.
bool film_sink_check(const char *path, Error *err);

// path: film.mp4, .webm, .gif; of PNGs a folder, which is made, or a pattern with one number:
// run-%04d.png. Refuses one that has frames already (ERROR_INPUT). The palette is the sink's.
FilmSink *film_sink_create(const VideoDef *def, Error *err);
// pixels: as io/video/video_file has them. Not kept. The error may be that of an earlier frame.
bool film_sink_add(FilmSink *sink, const uint8_t *pixels, int32_t stride, Error *err);
// Waits for all frames; a file gets its final name.
bool film_sink_finish(FilmSink *sink, Error *err);
// Without finish no file is left, of PNGs those that are whole. NULL is fine.
void film_sink_destroy(FilmSink *sink);

#endif
