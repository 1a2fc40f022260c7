// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/states.h"

#include "scene/friction_law.h"

#include <ctype.h>
#include <string.h>

bool scene_state_may_be(const char *name)
{
    // Names that scene/friction_law or every formula uses already.
    static const char *const taken[] = {"v",     "p",   "sqrt", "exp", "log",   "tanh",
                                        "asinh", "abs", "min",  "max", "round", "points"};
    if (!isalpha((unsigned char)*name) || strlen(name) >= STATE_NAME_SIZE) return false;
    for (const char *at = name; *at; at++)
        if (!isalnum((unsigned char)*at) && *at != '_') return false;
    for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
        if (strcmp(name, taken[k]) == 0) return false;
    return scene_friction_number(name) < 0;
}
