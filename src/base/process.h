// SPDX-License-Identifier: GPL-2.0-or-later
// How a process ended that this one had started. Called by base/child_process, base/child_program,
// study/sweep/computing/pool.
#ifndef AMONTONS_BASE_PROCESS_H
#define AMONTONS_BASE_PROCESS_H

#include <stddef.h>
#include <sys/resource.h>
#include <sys/types.h>

// The system does not say: SIGCHLD is ignored (the program takes it up again, cli/main; a library
// leaves a host's signals alone), or another part of a host has waited for it. It has failed.
enum { PROCESS_LOST = -1 };

// Waits for the end; as waitpid has it, or PROCESS_LOST. used: NULL, or what it took.
int process_wait(pid_t process, struct rusage *used);

// "by signal 11 (Segmentation fault)", "with status 3".
void process_describe(int ending, char *words, size_t size);

#endif
