// SPDX-License-Identifier: GPL-2.0-or-later
// Before the first line of every file under the preset `coverage`. gcov writes its counts when a
// process exits; here also when it does so by _exit(), as children do, those of modules too, and
// never while calls to the system are made to fail (tests/faults/file_faults.c).
#ifndef AMONTONS_COUNT_BEFORE_EXIT_H
#define AMONTONS_COUNT_BEFORE_EXIT_H

#include <stdlib.h>
#include <unistd.h>

void __gcov_dump(void);   // of the program, library or module that calls it, once
__attribute__((weak)) void file_faults_end(void);

// gcov's own destructor has a priority and comes later.
__attribute__((destructor)) static void end_of_faults(void)
{
    if (file_faults_end) file_faults_end();
}

static void count_now(void)
{
    end_of_faults();
    __gcov_dump();
}

__attribute__((constructor)) static void count_at_quick_exit(void)
{
    at_quick_exit(count_now);
}

// Runs nothing but these.
#define _exit quick_exit

#endif
