// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a result whose history this process has written itself. Called by run/output
// and run/result/film.
#ifndef AMONTONS_RUN_RESULT_PICTURES_H
#define AMONTONS_RUN_RESULT_PICTURES_H

#include "amontons.h"

// Draws as amontons_render_result does, but always in this process.
bool pictures_draw(const char *folder, const PictureRequest *request, Error *err);

// ERROR_INPUT: it is no folder.
bool pictures_check_folder(const char *folder, Error *err);

#endif
