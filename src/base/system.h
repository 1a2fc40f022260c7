// SPDX-License-Identifier: GPL-2.0-or-later
// Facts that Linux tells about this process, the program and its memory.
#ifndef AMONTONS_BASE_SYSTEM_H
#define AMONTONS_BASE_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

int32_t system_processors(void);   // that this process may use

// The path of the running program; false: not known. path: empty then.
bool system_program_path(char *path, size_t size);
// The path of the shared object that `address` lies in; false: it is in the program itself.
bool system_object_path(const void *address, char *path, size_t size);

int64_t system_address_space(void);   // bytes that this process has mapped; 0: not known
// True if so many more bytes could be mapped (ulimit -v, vm.overcommit_memory).
bool system_has_room(size_t bytes);
void system_use_large_pages(void *array, size_t bytes);   // where there are some

// True if the open or named `path` is a pipe that has no name in a folder (of a shell's `<(...)`):
// its other end is open. `mode`: of stat().
bool system_is_shell_pipe(const char *path, mode_t mode);

#endif
