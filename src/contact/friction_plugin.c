// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/friction_plugin.h"

#include "io/files/open_file.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *find_symbol(void *handle, const char *path, const char *name, Error *err)
{
    void *address = dlsym(handle, name);
    if (!address)
        error_set(err, ERROR_INPUT, __FILE__, __LINE__,
                  "%s has no function %s (amontons_friction.h)", path, name);
    return address;
}

// The loader looks for a name without a slash among the system's libraries.
bool friction_plugin_open(const char *path, FrictionPlugin *plugin, Error *err)
{
    const char *trust = getenv("AMONTONS_TRUST");
    char name[PATH_MAX];
    int (*interface)(void) = NULL;
    if (!trust || !*trust)
        FAIL(err, ERROR_INPUT,
             "%s is a program that would be run: give --trust, or set AMONTONS_TRUST=yes, if you "
             "know where it comes from",
             path);
    TRY(open_check(path, err));   // the loader would wait for a pipe
    snprintf(name, sizeof name, "%s%s", strchr(path, '/') ? "" : "./", path);
    void *handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!handle) FAIL(err, ERROR_INPUT, "cannot be opened: %s", dlerror());
    void *address[3] = {find_symbol(handle, path, "amontons_friction_interface", err),
                        find_symbol(handle, path, "amontons_friction_coefficient", err),
                        find_symbol(handle, path, "amontons_friction_slope", err)};
    if (!error_is_clean(err)) goto cleanup;
    memcpy(&interface, &address[0], sizeof interface);   // POSIX: object to function pointer
    memcpy(&plugin->coefficient, &address[1], sizeof plugin->coefficient);
    memcpy(&plugin->slope, &address[2], sizeof plugin->slope);
    if (interface() != AMONTONS_FRICTION_INTERFACE)
        FAIL(err, ERROR_INPUT, "%s was built for version %d of amontons_friction.h, not %d", path,
             interface(), AMONTONS_FRICTION_INTERFACE);
cleanup:
    return error_is_clean(err);
}
