// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/window.h"

#include <math.h>

WindowDef scene_window(const Scene *scene)
{
    const SceneWindow *window = &scene->output.window;
    WindowDef def = {.from_U = window->from_U,
                     .to_U = window->to_U > 0 ? window->to_U : INFINITY,
                     .from_t = window->from_t,
                     .to_t = window->to_t > 0 ? window->to_t : INFINITY};
    def.given = def.from_U > 0 || def.from_t > 0 || isfinite(def.to_U) || isfinite(def.to_t);
    return def;
}
