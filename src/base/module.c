// SPDX-License-Identifier: GPL-2.0-or-later
// dlopen counts its callers itself: a second call costs a look-up. Nothing is ever closed; modules
// end with the program.
#include "base/module.h"

#include "base/memory.h"
#include "base/system.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MODULE_PATH_SIZE = 2 * PATH_MAX + 128 };

// Purpose of a module, and the Debian packages that it is built with.
typedef struct ModulePart {
    const char *name, *part, *packages;
} ModulePart;

static const ModulePart PARTS[] = {
    {"gmsh", "meshes", "libgmsh-dev"},
    {"hdf5", "results", "libhdf5-dev"},
    {"vtk", "fields", "libvtk9-dev"},
    {"render", "pictures", "libcairo2-dev and libpng-dev"},
    {"libav", "films", "libavformat-dev, libavcodec-dev and libswscale-dev"},
    {"dlib", "optimise and fit", "libdlib-dev"},
};

static const ModulePart *part_of(const char *name)
{
    static const ModulePart other = {"", "this", "all of its packages"};
    for (size_t k = 0; k < sizeof PARTS / sizeof *PARTS; k++)
        if (strcmp(PARTS[k].name, name) == 0) return &PARTS[k];
    return &other;
}

// Finds the file of the module `name`: in the folder AMONTONS_MODULES, else where modules are
// installed, else beside this object, which is the build folder, or another module.
static bool module_find(const char *name, char path[MODULE_PATH_SIZE], Error *err)
{
    const ModulePart *part = part_of(name);
    const char *given = getenv("AMONTONS_MODULES");
    char folder[PATH_MAX], installed[PATH_MAX];
    const char *const places[] = {installed};
    bool named = given && given[0];
    snprintf(installed, sizeof installed, "amontons/amontons_%s.so", name);
    if (!named && system_find(places, 1, path, MODULE_PATH_SIZE)) return true;
    if (!named && !system_folder(folder, sizeof folder, err)) return false;
    snprintf(path, MODULE_PATH_SIZE, "%s/amontons_%s.so", named ? given : folder, name);
    if (access(path, F_OK) == 0) return true;
    return FAULT(err, ERROR_LIBRARY,
                 "%s: this build of amontons is without (there is no %s): build it with %s "
                 "installed",
                 part->part, path, part->packages);
}

bool module_check(const char *name, Error *err)
{
    char path[MODULE_PATH_SIZE];
    return module_find(name, path, err);
}

// The caller casts the result to the function's own type.
ModuleFunction module_function(const char *name, const char *symbol, Error *err)
{
    ModuleFunction function = NULL;
    char path[MODULE_PATH_SIZE];
    TRY(module_find(name, path, err));
    // The module's own calls are looked up at once (`-z now`), those inside of its libraries
    // lazily: to bind all of VTK's takes 2 ms more.
    void *handle = dlopen(path, RTLD_LAZY | RTLD_LOCAL);
    if (!handle) {   // in the loader's own words
        const char *first = getenv("LD_LIBRARY_PATH");
        bool set = first && first[0];
        FAIL(err, ERROR_LIBRARY, "%s: a library that %s needs cannot be loaded: %s%s%s",
             part_of(name)->part, path, dlerror(),
             set ? "; libraries are taken from LD_LIBRARY_PATH first, which is " : "",
             set ? first : "");
    }
    void *address = dlsym(handle, symbol);
    if (!address) FAIL(err, ERROR_LIBRARY, "the module %s has no %s", path, symbol);

    // A module that allocates counts where we do.
    void (*share)(MemoryTallyFunction) = NULL;
    void *tally = dlsym(handle, "amontons_module_tally");
    memcpy(&share, &tally, sizeof share);   // POSIX: object to function pointer
    if (share) share(memory_tally());
    memcpy(&function, &address, sizeof function);
cleanup:
    return function;
}
