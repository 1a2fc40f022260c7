// SPDX-License-Identifier: GPL-2.0-or-later
// What a file holds, in text: the kind is told by the name's end; a folder is a result.
#include "run/info.h"

#include "amontons.h"
#include "base/memory.h"
#include "run/scene_keys.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static bool info_scene(const char *path, FILE *out, Error *err)
{
    Scene *scene = NULL;
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    TRY(amontons_scene_read(path, NULL, 0, &scene, err));
    fprintf(out, "scene %s\n  %s\n\n", path, *scene->title ? scene->title : "(no title)");
    for (int32_t k = 0; k < count; k++) {
        char value[1200];
        scene_key_value(&keys[k], scene, value, sizeof value);
        bool absent = !keys[k].standard && !scene->given[k];
        fprintf(out, "  %-28s %s%s\n", keys[k].name, absent ? "-" : value,
                scene->given[k] ? "" : "   (default)");
    }
    fprintf(out, "\nThe mesh file is %s\n", scene->mesh.file);
cleanup:
    amontons_scene_destroy(scene);
    return error_is_clean(err);
}

static bool ends_with(const char *path, const char *end)
{
    size_t length = strlen(path), size = strlen(end);
    return length > size && strcmp(path + length - size, end) == 0;
}

bool amontons_info(const char *path, FILE *out, Error *err)
{
    struct stat status;
    if (stat(path, &status) != 0) FAIL(err, ERROR_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(status.st_mode))
        TRY(info_result(path, out, err));
    else if (ends_with(path, ".msh") || ends_with(path, ".geo"))
        TRY(info_mesh(path, out, err));
    else if (ends_with(path, ".yaml") || ends_with(path, ".yml"))
        TRY(info_scene(path, out, err));
    else
        FAIL(err, ERROR_INPUT,
             "%s: not known what this is; allowed: a mesh (.msh, .geo), a scene (.yaml, .yml) or "
             "a result folder",
             path);
    if (fflush(out) != 0 || ferror(out)) FAIL(err, ERROR_FILE, "cannot write: %s", strerror(errno));
cleanup:
    return error_is_clean(err);
}
