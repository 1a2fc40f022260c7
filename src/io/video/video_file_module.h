// SPDX-License-Identifier: GPL-2.0-or-later
// What the module amontons_libav.so offers: frames become the bytes of a file that is open already.
// A module, because libav loads a hundred libraries, for 40 ms.
#ifndef AMONTONS_IO_VIDEO_VIDEO_FILE_MODULE_H
#define AMONTONS_IO_VIDEO_VIDEO_FILE_MODULE_H

#include "base/error.h"
#include "io/video/video_def.h"

typedef struct VideoStream VideoStream;   // the module's own; a VideoFile owns one

// The file, open for reading and writing, and its name as long as it is not finished.
typedef struct VideoTarget {
    int descriptor;
    const char *part;
} VideoTarget;

typedef struct VideoModule {
    VideoStream *(*create)(const VideoDef *def, const VideoTarget *target, Error *err);
    bool (*add)(VideoStream *stream, const uint8_t *pixels, int32_t stride, Error *err);
    bool (*finish)(VideoStream *stream, Error *err);   // all is written, but not on the disk yet
    void (*destroy)(VideoStream *stream);   // NULL is fine
} VideoModule;

// The module's one entry, "amontons_video_module": a table that lasts as long as the program.
typedef const VideoModule *(*VideoModuleFunction)(void);
const VideoModule *amontons_video_module(void);

#endif
