// SPDX-License-Identifier: GPL-2.0-or-later
// A short valid scene, line by line, for the tests of scenes: they change one line of it.
#ifndef AMONTONS_TESTS_SCENE_TEXTS_H
#define AMONTONS_TESTS_SCENE_TEXTS_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const char *const scene_lines[] = {
    "title: Test",   // line 1
    "units: normalised",   // 2
    "mesh: {file: block.geo, set: {nx: 4}}",   // 3
    "material: {poisson: 0.3}",   // 4
    "friction: {mu_static: 0.5, mu_kinetic: 0.2, critical_velocity: 1e-3}",   // 5
    "load: {pressure: 0.01}",   // 6
    "rod: {velocity: 1e-4}",   // 7
    "time: {until: {U: 0.1}}",   // 8
};

enum { SCENE_LINES = sizeof scene_lines / sizeof scene_lines[0], SCENE_TEXT_MAX = 4000 };

// The scene with line `line` (from 1) replaced by `text`; 0: `text` is added at the end.
static inline void scene_text_with(int32_t line, const char *text, char *out)
{
    out[0] = 0;
    for (int32_t i = 0; i < SCENE_LINES; i++) {
        strcat(out, i + 1 == line ? text : scene_lines[i]);
        strcat(out, "\n");
    }
    if (line == 0) strcat(out, text);
}

#endif
