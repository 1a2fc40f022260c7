// SPDX-License-Identifier: GPL-2.0-or-later
// Functions that POSIX does not have, or that each system has in its own way: a port changes
// system.c alone. There each function has the way of Linux with glibc, and a plain one for the rest
// (musl, macOS), where a function that only saves time or memory does nothing.
//
// Other things are not POSIX either: argp in cli/options (elsewhere a library of its own,
// argp-standalone), memfd_create in io/mesh, the kernels of OpenBLAS in base/kernels, how cli/main
// sets the allocator, and options of the linker in src/CMakeLists.txt (version scripts). Two things
// are for x86 alone, target_clones in algebra/lanes.h and the names of processors in base/kernels;
// both have a twin for the others.
#ifndef AMONTONS_BASE_SYSTEM_H
#define AMONTONS_BASE_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/types.h>

// --- processes -----------------------------------------------------------------------------------

// Is called in a child process: the system ends it when its parent ends. Elsewhere nothing: it ends
// when it next finds the pipe to its parent closed.
void system_end_with_parent(void);
int system_pipe(
    int ends[2]);   // as pipe(), closed in programs that are started; 0, or -1 with errno
int32_t system_processors(void);   // that this process may use

// --- places --------------------------------------------------------------------------------------

// The path of the running program; false: not known. path: empty then.
bool system_program_path(char *path, size_t size);
// The path of the shared object that `address` lies in; false: it is in the program itself.
bool system_object_path(const void *address, char *path, size_t size);

// --- limits --------------------------------------------------------------------------------------

// Argument of getrlimit, an enumeration in glibc.
#ifdef __GLIBC__
typedef __rlimit_resource_t SystemLimit;
#else
typedef int SystemLimit;
#endif

// --- memory --------------------------------------------------------------------------------------

int64_t system_address_space(void);   // bytes that this process has mapped; 0: not known
// True if so many more bytes could be mapped (ulimit -v, vm.overcommit_memory).
bool system_has_room(size_t bytes);
void system_use_large_pages(void *array, size_t bytes);   // where there are some
void system_give_back_memory(void);   // what is freed, and the C library keeps

// --- files ---------------------------------------------------------------------------------------

// True if the open or named `path` is a pipe that has no name in a folder (of a shell's `<(...)`):
// its other end is open. `mode`: of stat().
bool system_is_shell_pipe(const char *path, mode_t mode);

typedef ssize_t (*SystemWrite)(void *context, const char *bytes, size_t count);
FILE *system_stream(void *context,
                    SystemWrite write);   // whose bytes go to `write`; NULL: no memory

// --- order ---------------------------------------------------------------------------------------

// qsort with a context that comes third, and no state outside the call.
void system_sort(void *items, size_t count, size_t size,
                 int (*compare)(const void *, const void *, void *), void *context);

#endif
