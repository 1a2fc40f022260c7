// SPDX-License-Identifier: GPL-2.0-or-later
// Before the first line of every file under the preset `coverage`. gcov writes its counts when a
// process exits; here also when it does so by _exit(), as children do, and never while calls to the
// system are made to fail (tests/faults/file_faults.c).
#ifndef AMONTONS_COUNT_BEFORE_EXIT_H
#define AMONTONS_COUNT_BEFORE_EXIT_H

#include <unistd.h>

void __gcov_dump(void);
__attribute__((weak)) void file_faults_end(void);

// gcov's own destructor has a priority and comes later.
__attribute__((destructor)) static void end_of_faults(void)
{
    if (file_faults_end) file_faults_end();
}

__attribute__((noreturn)) static inline void count_before_exit(int status)
{
    end_of_faults();
    __gcov_dump();
    _exit(status);
}

#define _exit count_before_exit

#endif
