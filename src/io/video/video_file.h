// SPDX-License-Identifier: GPL-2.0-or-later
// Frames of a film into one file, .mp4 (H.264), .webm (VP9) or .gif, or each into a PNG, by libav,
// in a module opened with the first film. Knows nothing of what the frames show. Called by
// render/film.
//
//   check -> create -> add, a frame after the other -> finish     the file has its final name
//                                                   -> destroy    without finish no file is left,
//                                                                 of PNGs those written so far
#ifndef AMONTONS_IO_VIDEO_VIDEO_FILE_H
#define AMONTONS_IO_VIDEO_VIDEO_FILE_H

#include "base/error.h"

#include <stdint.h>

// Definition of a film.
typedef struct VideoDef {
    const char *path;   // its ending says what it becomes: .mp4, .webm, .gif; or a PNG a frame,
        // from 1, after a pattern with one number in its name: run-%04d.png
    int32_t width, height;   // pixels, even
    int32_t rate;   // frames a second; of a GIF a divisor of 100; PNGs have none
    const char *title;   // stored in the file; a GIF and PNGs have none
    // A GIF's colours, [256 * 3] red, green, blue; the last one is kept for what does not change.
    // Others: not asked.
    const uint8_t *palette;
    bool overwrite;   // as io/files/part_file has it
} VideoDef;

typedef struct VideoFile VideoFile;   // begins with a pointer to its module's table

// True if the name has this ending, in small or capital letters.
bool video_file_ends(const char *path, const char *ending);

// ERROR_INPUT: the name does not say which kind of film it is, or is too long. Nothing is made.
// ERROR_LIBRARY: libav cannot be had.
bool video_file_check_name(const char *path, Error *err);
// ERROR_LIBRARY where libav cannot be had or has no encoder for this. NULL: it failed.
VideoFile *video_file_create(const VideoDef *def, Error *err);
// pixels: [height * stride] bytes, four a pixel: blue, green, red, unused. Not kept.
bool video_file_add(VideoFile *file, const uint8_t *pixels, int32_t stride, Error *err);
// Writes what the encoder still holds, then gives the file its final name. PNGs have theirs when
// they are added.
bool video_file_finish(VideoFile *file, Error *err);
void video_file_destroy(VideoFile *file);   // NULL is fine

// --- the module ---------------------------------------------------------------------------------

// The module amontons_libav.so does these calls by libav, which loads a hundred libraries in 40 ms.
typedef struct VideoModule {
    bool (*check_name)(const char *path, Error *err);
    VideoFile *(*create)(const VideoDef *def, Error *err);
    bool (*add)(VideoFile *film, const uint8_t *pixels, int32_t stride, Error *err);
    bool (*finish)(VideoFile *film, Error *err);
    void (*destroy)(VideoFile *film);
} VideoModule;

// The module's one entry, "amontons_video_module": a table that lasts as long as the program.
typedef const VideoModule *(*VideoModuleFunction)(void);
const VideoModule *amontons_video_module(void);

#endif
