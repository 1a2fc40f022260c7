// SPDX-License-Identifier: GPL-2.0-or-later
// What makes a scene's answer doubtful though it can be computed: what the scene alone tells
// (amontons_scene_warning), and weakening that is too fast for viscosity and mesh. Written to
// run.json (warnings), handed to the caller in RunSummary. Each says in a few words what is wrong,
// then a colon and the rest: the legend of a sweep's picture has room for the former. Called by
// run/simulation once its model stands.
#ifndef AMONTONS_RUN_WARNINGS_H
#define AMONTONS_RUN_WARNINGS_H

#include "amontons.h"
#include "contact/friction_law.h"
#include "stepping/certificate.h"

// Looks at law, damping and interface; load: F_N, force/width, taken as evenly spread.
// Appends to `warnings`.
void warnings_of_resolution(const Certificate *certificate, double load, RunWarnings *warnings);

void warnings_add(RunWarnings *warnings, const char *format, ...)
    __attribute__((format(printf, 2, 3)));   // what does not fit is left out

#endif
