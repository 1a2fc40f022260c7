// SPDX-License-Identifier: GPL-2.0-or-later
// Other programs, and how a process ended that this one had started. Called by base/child_process,
// study/sweep/computing/pool and study/sweep/computing/slurm_jobs.
#ifndef AMONTONS_BASE_PROCESS_H
#define AMONTONS_BASE_PROCESS_H

#include "base/error.h"

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

// Runs another program. words: the program, looked for in PATH, and its arguments; NULL at the end.
// It gets no input and no Ctrl-C of the terminal, and is waited for. output: what it wrote to
// standard output and standard error, cut to `size` bytes with the zero. *status: its exit status,
// or 128 + the signal that ended it. ERROR_LIBRARY: there is no such program.
bool process_run(const char *const *words, char *output, size_t size, int *status, Error *err);

#endif
