// SPDX-License-Identifier: GPL-2.0-or-later
// Modules: the parts that need a heavy library (gmsh, HDF5, VTK, what draws, libav) are shared
// objects of their own, opened on first use, because loading all of them costs more than a whole
// run. Called by io/mesh/mesh_read, io/hdf5/array_file, io/fields/field_file,
// io/video/video_file, run/result/pictures and run/info/info.
#ifndef AMONTONS_BASE_MODULE_H
#define AMONTONS_BASE_MODULE_H

#include "base/error.h"

typedef void (*ModuleFunction)(void);

// Finds `symbol` in the module `amontons_<name>.so` beside the program or library that this is part
// of, or in the folder `amontons` beside it, as installed (tests: in the folder AMONTONS_MODULES).
// A module stays open until the program ends; a second call is a look-up.
// NULL with ERROR_LIBRARY set: the build left it out (says which packages it is built with), or a
// library that it needs cannot be loaded (says what the loader said).
ModuleFunction module_function(const char *name, const char *symbol, Error *err);

// Checks that the build has that module, without opening it, where long work needs it at its end.
bool module_check(const char *name, Error *err);

#endif
