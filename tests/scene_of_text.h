// SPDX-License-Identifier: GPL-2.0-or-later
// A scene from a text: written where its path says, read as any other, and removed.
#ifndef AMONTONS_TESTS_SCENE_OF_TEXT_H
#define AMONTONS_TESTS_SCENE_OF_TEXT_H

#include "io/files/folder.h"
#include "near.h"
#include "scene/scene.h"

#include <limits.h>
#include <unistd.h>

// path: a relative one stands in a folder of its own, and is called like that in errors.
static inline bool scene_of_text(const char *path, const char *text, Scene *scene, Error *err)
{
    char place[PATH_MAX], folder[] = "/tmp/amontons-scene-XXXXXX", parent[PATH_MAX];
    bool relative = path[0] != '/';
    assert_non_null(getcwd(place, sizeof place));
    if (relative) assert_true(mkdtemp(folder) && chdir(folder) == 0);
    snprintf(parent, sizeof parent, "%s", path);
    char *slash = strrchr(parent, '/');
    if (slash) {
        *slash = 0;
        assert_true(folder_make(parent, err));
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    bool done = scene_read(path, NULL, 0, false, scene, err);
    assert_int_equal(unlink(path), 0);
    if (relative && slash) assert_int_equal(rmdir(parent), 0);
    if (relative) assert_true(chdir(place) == 0 && rmdir(folder) == 0);
    return done;
}

#endif
