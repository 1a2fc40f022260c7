// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's scene on a coarse mesh, without pictures and cache: a whole run in some hundredths of
// a second.
#ifndef AMONTONS_TESTS_SMALL_SCENE_H
#define AMONTONS_TESTS_SMALL_SCENE_H

#include "amontons.h"
#include "near.h"

enum { SMALL_SETTINGS_MAX = 24 };

// `more`: further settings, a NULL at their end. They come last, so they win.
static inline Scene *small_scene(const char *const *more)
{
    Error err = {0};
    Scene *scene = NULL;
    const char *source = getenv("AMONTONS_SOURCE");
    const char *settings[SMALL_SETTINGS_MAX] = {"mesh.set.nx=10",         "mesh.set.nz=10",
                                                "time.until={U: 0.0055}", "output.fields=none",
                                                "output.figures=[]",      "reduction.cache=false"};
    int32_t count = 6;
    while (*more) settings[count++] = *more++;
    char path[1000];
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", source ? source : ".");
    if (!amontons_scene_read(path, settings, count, &scene, &err)) fail_msg("%s", err.message);
    return scene;
}

#endif
