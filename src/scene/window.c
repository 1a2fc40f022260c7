// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/window.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

static const char AROUND[] = "sliding ";
enum { NUMBER_MAX = 100000 };   // of slidings in a run

// The whole number from 1 to `most` that the text begins with; 0: none. *rest: what follows.
static int32_t read_whole(const char *text, int32_t most, const char **rest)
{
    double number = 0;
    *rest = text + text_number(text, &number);
    return number >= 1 && number <= most && number == floor(number) ? (int32_t)number : 0;
}

WindowDef scene_window(const Scene *scene)
{
    const SceneWindow *window = &scene->output.window;
    WindowDef def = {.from_U = window->from_U,
                     .to_U = window->to_U > 0 ? window->to_U : INFINITY,
                     .from_t = window->from_t,
                     .to_t = window->to_t > 0 ? window->to_t : INFINITY};
    const char *rest;
    size_t length = strlen(AROUND);
    if (strncmp(window->around, AROUND, length) == 0) {
        int32_t number = read_whole(window->around + length, NUMBER_MAX, &rest);
        if (*rest == 0) def.around = number;
    }
    int32_t last = read_whole(window->last, WINDOW_SLIDINGS_MAX, &rest);
    if (strcmp(rest, last == 1 ? " sliding" : " slidings") == 0) def.last = last;
    def.given = def.around > 0 || def.last > 0 || def.from_U > 0 || def.from_t > 0 ||
                isfinite(def.to_U) || isfinite(def.to_t);
    return def;
}
