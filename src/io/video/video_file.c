// SPDX-License-Identifier: GPL-2.0-or-later
// The file is ours (io/files/part_file), its bytes are libav's.
#include "io/video/video_file.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/files/part_file.h"
#include "io/video/video_file_module.h"

#include <string.h>
#include <strings.h>

struct VideoFile {
    const VideoModule *module;
    VideoStream *stream;   // owned
    PartFile part;
};

static bool ends_in(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ending) == 0;
}

bool video_file_is_gif(const char *path)
{
    return ends_in(path, ".gif");
}

bool video_file_is_known(const char *path)
{
    return ends_in(path, ".mp4") || ends_in(path, ".webm") || video_file_is_gif(path);
}

VideoFile *video_file_create(const VideoDef *def, Error *err)
{
    VideoFile *file = NULL;
    VideoModuleFunction module =
        (VideoModuleFunction)module_function("libav", "amontons_video_module", err);
    TRY(module);
    TRY(file = NEW_ARRAY(VideoFile, 1, err));
    file->module = module();
    TRY(part_file_replace(&file->part, def->path, def->overwrite, err));
    VideoTarget target = {file->part.descriptor, file->part.part};
    TRY(file->stream = file->module->create(def, &target, err));
    return file;
cleanup:
    video_file_destroy(file);
    return NULL;
}

bool video_file_add(VideoFile *file, const uint8_t *pixels, int32_t stride, Error *err)
{
    if (!file->module->add(file->stream, pixels, stride, err))
        error_context(err, "film %s", file->part.path);
    return error_is_clean(err);
}

bool video_file_finish(VideoFile *file, Error *err)
{
    if (!file->module->finish(file->stream, err)) {
        error_context(err, "film %s", file->part.path);
        return false;
    }
    return part_file_commit(&file->part, err);
}

void video_file_destroy(VideoFile *file)
{
    if (!file) return;
    file->module->destroy(file->stream);
    part_file_discard(&file->part);
    memory_free(file);
}
