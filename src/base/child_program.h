// SPDX-License-Identifier: GPL-2.0-or-later
// Runs another program and takes what it says. Called by study/sweep/computing/slurm_jobs.
#ifndef AMONTONS_BASE_CHILD_PROGRAM_H
#define AMONTONS_BASE_CHILD_PROGRAM_H

#include "base/error.h"

#include <stddef.h>

// words: the program, looked for in PATH, and its arguments; NULL at the end. It gets no input and
// no Ctrl-C of the terminal, and is waited for. output: what it wrote to standard output and
// standard error, cut to `size` bytes with the zero. *status: its exit status, or 128 + the signal
// that ended it. ERROR_LIBRARY: there is no such program.
bool child_program_run(const char *const *words, char *output, size_t size, int *status,
                       Error *err);

#endif
