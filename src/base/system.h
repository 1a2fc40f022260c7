// SPDX-License-Identifier: GPL-2.0-or-later
// Facts that Linux tells about this process, the program, the library's folder and memory.
#ifndef AMONTONS_BASE_SYSTEM_H
#define AMONTONS_BASE_SYSTEM_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

int32_t system_processors(void);   // that this process may use

// The path of the running program; false: not known. path: empty then.
bool system_program_path(char *path, size_t size);
// The folder of the shared library, or of the program or module, that this code is linked into. It
// is found from that file, so that an installed tree may be moved.
bool system_folder(char *folder, size_t size, Error *err);
// The first of `names` ([count], "../share/amontons") below that folder that is there, with the
// folder before it. false: none is; `path` is then empty.
bool system_find(const char *const *names, int32_t count, char *path, size_t size);

int64_t system_address_space(void);   // bytes that this process has mapped; 0: not known
double system_memory(void);   // bytes of this computer, or what a limit leaves of them
// True if so many more bytes could be mapped (ulimit -v, vm.overcommit_memory).
bool system_has_room(size_t bytes);
void system_use_large_pages(void *array, size_t bytes);   // where there are some

// True if `path` is what a shell calls a descriptor of this process: /dev/fd/63, /proc/self/fd/63,
// /dev/stdin. By its letters: a link that leads there is none.
bool system_is_descriptor(const char *path);
// True if `path` is such a name of a pipe that has no name in a folder (of a shell's `<(...)`): its
// other end is open. `mode`: of stat().
bool system_is_shell_pipe(const char *path, mode_t mode);

#endif
