// SPDX-License-Identifier: GPL-2.0-or-later
// All is handed on to the module amontons_libav.so, which is opened with the first film.
#include "io/video/video_file.h"

#include "base/module.h"

#include <string.h>
#include <strings.h>

bool video_file_is_gif(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".gif") == 0;
}

static const VideoModule *module_of(const VideoFile *file)
{
    return *(const VideoModule *const *)(const void *)file;
}

VideoFile *video_file_create(const VideoDef *def, Error *err)
{
    VideoModuleFunction module =
        (VideoModuleFunction)module_function("libav", "amontons_video_module", err);
    return module ? module()->create(def, err) : NULL;
}

bool video_file_add(VideoFile *file, const uint8_t *pixels, int32_t stride, Error *err)
{
    return module_of(file)->add(file, pixels, stride, err);
}

bool video_file_finish(VideoFile *file, Error *err)
{
    return module_of(file)->finish(file, err);
}

void video_file_destroy(VideoFile *file)
{
    if (file) module_of(file)->destroy(file);
}
