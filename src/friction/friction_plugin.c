// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_plugin.h"

#include "base/child_process.h"
#include "io/files/open_file.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The symbols of a plug-in and where their addresses go; those of laws that remember come last.
enum { SPEED_ALONE = 2, SYMBOLS = 5, SECONDS_MAX = 20 };

static bool find_symbols(void *handle, const char *path, FrictionPlugin *plugin, Error *err)
{
    static const char *const names[SYMBOLS] = {"coefficient", "slope", "states", "start", "rates"};
    void *places[SYMBOLS] = {&plugin->coefficient, &plugin->slope, &plugin->states, &plugin->start,
                             &plugin->rates};
    bool remembers = dlsym(handle, "amontons_friction_rates") != NULL;
    for (int32_t k = remembers ? SPEED_ALONE : 0; k < (remembers ? SYMBOLS : SPEED_ALONE); k++) {
        char name[64];
        snprintf(name, sizeof name, "amontons_friction_%s", names[k]);
        void *address = dlsym(handle, name);
        if (!address) return REFUSE(err, "%s has no function %s (amontons_friction.h)", path, name);
        memcpy(places[k], &address, sizeof address);   // POSIX: object to function pointer
    }
    return true;
}

// The loader looks for a name without a slash among the system's libraries.
static bool load(const char *path, FrictionPlugin *plugin, Error *err)
{
    char name[PATH_MAX];
    int (*interface)(void) = NULL;
    snprintf(name, sizeof name, "%s%s", strchr(path, '/') ? "" : "./", path);
    void *handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!handle) return REFUSE(err, "cannot be opened: %s", dlerror());
    void *version = dlsym(handle, "amontons_friction_interface");
    if (!version)
        return REFUSE(err, "%s has no function amontons_friction_interface (amontons_friction.h)",
                      path);
    memcpy(&interface, &version, sizeof interface);
    if (interface() < 1 || interface() > AMONTONS_FRICTION_INTERFACE)
        return REFUSE(err, "%s was built for version %d of amontons_friction.h, not 1 to %d", path,
                      interface(), AMONTONS_FRICTION_INTERFACE);
    return find_symbols(handle, path, plugin, err);
}

static bool try_load(void *path, FILE *reply, Error *err)
{
    FrictionPlugin plugin;
    (void)reply;
    return load(path, &plugin, err);
}

// A plug-in that was cut short ends the process that loads it, and so may one that is whole: a
// process of its own tries it first, where there may be one.
bool friction_plugin_open(const char *path, FrictionPlugin *plugin, Error *err)
{
    ChildWork work = {.path = path,
                      .reader = "the system's loader",
                      .seconds = SECONDS_MAX,
                      .advice = "it does not come to an end",
                      .read = try_load,
                      .context = (void *)path};
    if (!open_check(path, err)) return false;   // the loader would wait for a pipe
    if (child_is_wanted() && !child_do(&work, err)) return false;
    return load(path, plugin, err);
}
