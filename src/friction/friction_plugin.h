// SPDX-License-Identifier: GPL-2.0-or-later
// A law whose functions stand in a shared object that somebody else wrote (amontons_friction.h).
// Called by friction/friction_make.
#ifndef AMONTONS_FRICTION_FRICTION_PLUGIN_H
#define AMONTONS_FRICTION_FRICTION_PLUGIN_H

#include "amontons_friction.h"
#include "base/error.h"

// A law of speed alone has coefficient and slope, one that remembers has the rest; the others are
// NULL.
typedef struct FrictionPlugin {
    double (*coefficient)(const AmontonsFriction *given, double speed);
    double (*slope)(const AmontonsFriction *given, double speed);
    int (*states)(const AmontonsFriction *given);
    void (*start)(const AmontonsFriction *given, double speed, double rest, double *state);
    void (*rates)(const AmontonsFriction *given, double speed, double pressure, const double *state,
                  AmontonsFrictionRates *rates);
    AmontonsFriction given;
} FrictionPlugin;

// Opens the file, which stays open until the program ends: copies of a law may be anywhere.
// Runs its code: only of a scene that is trusted. ERROR_INPUT where it cannot be opened, or is no
// such plug-in.
bool friction_plugin_open(const char *path, FrictionPlugin *plugin, Error *err);

#endif
