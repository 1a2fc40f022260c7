// SPDX-License-Identifier: GPL-2.0-or-later
// Curves that `amontons info SCENE --picture` draws of a scene's laws beside what was measured.
#ifndef AMONTONS_RUN_INFO_INFO_CURVES_H
#define AMONTONS_RUN_INFO_INFO_CURVES_H

#include "amontons.h"

// mu of the scene's friction law over the slip rate, with the points that it was made of; of a law
// that remembers in steady slip.
bool info_draw_friction(const Scene *scene, const InfoOptions *options, Error *err);

// Moduli that a file of the scene gives (material.from, or that of the first region that has one)
// beside what was fitted to them, over frequency or time, with the band of rates of a run.
bool info_draw_material(const Scene *scene, const InfoOptions *options, Error *err);
// The same in lines: branches, misfit, how far the data go.
bool info_write_material(const Scene *scene, FILE *out, Error *err);

// The picture's name without its folder and ending is `name`, or ends in it: "steel-friction.png".
bool info_picture_is_of(const char *picture, const char *name);

#endif
