// SPDX-License-Identifier: GPL-2.0-or-later
// Interface of the module amontons_libav.so: the calls of io/video/video_file.h, done by libav. It
// is a module because libav loads a hundred libraries, which takes 40 ms.
#ifndef AMONTONS_IO_VIDEO_VIDEO_FILE_MODULE_H
#define AMONTONS_IO_VIDEO_VIDEO_FILE_MODULE_H

#include "base/error.h"
#include "io/video/video_def.h"

typedef struct VideoFile VideoFile;   // begins with a pointer to its module's table

typedef struct VideoModule {
    VideoFile *(*create)(const VideoDef *def, Error *err);
    bool (*add)(VideoFile *film, const uint8_t *pixels, int32_t stride, Error *err);
    bool (*finish)(VideoFile *film, Error *err);
    void (*destroy)(VideoFile *film);
} VideoModule;

// The module's one entry, "amontons_video_module": a table that lasts as long as the program.
typedef const VideoModule *(*VideoModuleFunction)(void);
const VideoModule *amontons_video_module(void);

#endif
