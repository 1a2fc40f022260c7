// SPDX-License-Identifier: GPL-2.0-or-later
// dlopen counts its callers itself: a second call costs a look-up. Nothing is ever closed; modules
// end with the program.
#include "base/module.h"

#include <dlfcn.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The folder of the modules: AMONTONS_MODULES, else where the executable stands.
static bool module_folder(char *folder, size_t size, Error *err)
{
    const char *given = getenv("AMONTONS_MODULES");
    if (given && given[0]) {
        snprintf(folder, size, "%s", given);
        return true;
    }
    char executable[PATH_MAX] = {0};
    if (readlink("/proc/self/exe", executable, sizeof executable - 1) < 0)
        FAIL(err, ERROR_LIBRARY, "cannot tell where the program stands (/proc/self/exe)");
    snprintf(folder, size, "%s", dirname(executable));
cleanup:
    return error_is_clean(err);
}

// NULL with ERROR_LIBRARY, which has the loader's own words: most often that a library is not
// installed. The caller casts the result to the function's own type.
ModuleFunction module_function(const char *name, const char *symbol, Error *err)
{
    ModuleFunction function = NULL;
    char folder[PATH_MAX] = {0};
    char path[PATH_MAX + 128];
    TRY(module_folder(folder, sizeof folder, err));
    snprintf(path, sizeof path, "%s/amontons_%s.so", folder, name);
    // Lazy, as programs are linked: to bind all of VTK's functions at once takes 2 ms more.
    void *handle = dlopen(path, RTLD_LAZY | RTLD_LOCAL);
    if (!handle) FAIL(err, ERROR_LIBRARY, "cannot open the module %s: %s", path, dlerror());
    void *address = dlsym(handle, symbol);
    if (!address) FAIL(err, ERROR_LIBRARY, "the module %s has no %s", path, symbol);
    memcpy(&function, &address, sizeof function);   // POSIX: object to function pointer
cleanup:
    return function;
}
