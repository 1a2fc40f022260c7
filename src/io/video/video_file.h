// SPDX-License-Identifier: GPL-2.0-or-later
// Frames of a film into one file: .mp4 (H.264), .webm (VP9) or .gif, by libav, in a module opened
// with the first film. Knows nothing of what the frames show. Called by render/film/film_sink.
//
//   create -> add, a frame after the other -> finish     the file has its final name
//                                          -> destroy    without finish nothing is left
#ifndef AMONTONS_IO_VIDEO_VIDEO_FILE_H
#define AMONTONS_IO_VIDEO_VIDEO_FILE_H

#include "base/error.h"
#include "io/video/video_def.h"

typedef struct VideoFile VideoFile;

// Whether the name ends as one of the three.
bool video_file_is_known(const char *path);
bool video_file_is_gif(const char *path);

// ERROR_LIBRARY where libav cannot be had or has no encoder for this. NULL: it failed.
VideoFile *video_file_create(const VideoDef *def, Error *err);
// pixels: [height * stride] bytes, four a pixel: blue, green, red, unused. Not kept.
bool video_file_add(VideoFile *file, const uint8_t *pixels, int32_t stride, Error *err);
// Writes what the encoder still holds, then gives the file its final name.
bool video_file_finish(VideoFile *file, Error *err);
void video_file_destroy(VideoFile *file);   // NULL is fine

#endif
