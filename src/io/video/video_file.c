// SPDX-License-Identifier: GPL-2.0-or-later
// All is handed on to the module amontons_libav.so, which is opened with the first film.
#include "io/video/video_file.h"

#include "base/module.h"

#include <string.h>
#include <strings.h>

bool video_file_ends(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ending) == 0;
}

static const VideoModule *module_of(const VideoFile *file)
{
    return *(const VideoModule *const *)(const void *)file;
}

static VideoModuleFunction module_open(Error *err)
{
    return (VideoModuleFunction)module_function("libav", "amontons_video_module", err);
}

bool video_file_check_name(const char *path, Error *err)
{
    VideoModuleFunction module = module_open(err);
    return module && module()->check_name(path, err);
}

VideoFile *video_file_create(const VideoDef *def, Error *err)
{
    VideoModuleFunction module = module_open(err);
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
