// SPDX-License-Identifier: GPL-2.0-or-later
// dlopen counts its callers itself: a second call costs a look-up. Nothing is ever closed; modules
// end with the program.
#include "base/module.h"

#include "base/memory.h"
#include "base/place.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Of the module `name`: in the folder AMONTONS_MODULES, else where modules are installed, else
// beside this object, which is the build folder, or another module.
static bool module_path(const char *name, char *path, size_t size, Error *err)
{
    const char *given = getenv("AMONTONS_MODULES");
    char folder[PATH_MAX], installed[PATH_MAX];
    const char *const places[] = {installed};
    snprintf(installed, sizeof installed, "amontons/amontons_%s.so", name);
    if (!(given && given[0])) {
        if (place_find(places, 1, path, size)) return true;
        if (!place_folder(folder, sizeof folder, err)) return false;
        given = folder;
    }
    snprintf(path, size, "%s/amontons_%s.so", given, name);
    return true;
}

// A module that allocates counts where we do.
static void share_tally(void *handle)
{
    void (*share)(MemoryTallyFunction) = NULL;
    void *address = dlsym(handle, "amontons_module_tally");
    memcpy(&share, &address, sizeof share);   // POSIX: object to function pointer
    if (share) share(memory_tally());
}

// NULL with ERROR_LIBRARY, which has the loader's own words: most often that a library is not
// installed. The caller casts the result to the function's own type.
ModuleFunction module_function(const char *name, const char *symbol, Error *err)
{
    ModuleFunction function = NULL;
    char path[2 * PATH_MAX + 128];
    TRY(module_path(name, path, sizeof path, err));
    // Lazy, as programs are linked: to bind all of VTK's functions at once takes 2 ms more.
    void *handle = dlopen(path, RTLD_LAZY | RTLD_LOCAL);
    if (!handle) FAIL(err, ERROR_LIBRARY, "cannot open the module %s: %s", path, dlerror());
    void *address = dlsym(handle, symbol);
    if (!address) FAIL(err, ERROR_LIBRARY, "the module %s has no %s", path, symbol);
    share_tally(handle);
    memcpy(&function, &address, sizeof function);
cleanup:
    return function;
}
