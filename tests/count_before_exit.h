// SPDX-License-Identifier: GPL-2.0-or-later
// Before the first line of every file under the preset `coverage`: what a child process ran is
// counted too. gcov writes its counts when exit() is called, which _exit() leaves out.
#ifndef AMONTONS_COUNT_BEFORE_EXIT_H
#define AMONTONS_COUNT_BEFORE_EXIT_H

#include <unistd.h>

void __gcov_dump(void);

__attribute__((noreturn)) static inline void count_before_exit(int status)
{
    __gcov_dump();
    _exit(status);
}

#define _exit count_before_exit

#endif
