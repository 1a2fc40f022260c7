// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/states.h"

#include "scene/friction_law.h"

#include <ctype.h>
#include <string.h>

// Returns true for names that scene/friction_law or every formula uses already.
static bool is_taken(const char *name)
{
    static const char *const taken[] = {"v",     "p",   "sqrt", "exp", "log",   "tanh",
                                        "asinh", "abs", "min",  "max", "round", "points"};
    for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
        if (strcmp(name, taken[k]) == 0) return true;
    return false;
}

static bool is_name(const char *name)
{
    if (!isalpha((unsigned char)*name) || strlen(name) >= STATE_NAME_SIZE) return false;
    for (; *name; name++)
        if (!isalnum((unsigned char)*name) && *name != '_') return false;
    return true;
}

bool scene_state_may_be(const char *name)
{
    return is_name(name) && !is_taken(name) && scene_friction_number(name) < 0;
}
