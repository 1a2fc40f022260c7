// SPDX-License-Identifier: GPL-2.0-or-later
// For a test that file_faults.c is linked into.
#ifndef AMONTONS_TESTS_FILE_FAULTS_H
#define AMONTONS_TESTS_FILE_FAULTS_H

enum { FILE_FAULT_SIZE = 24 };

// From here on, as FILE_FAULT has it: "write:12" (kept by the caller); "count:" to list all calls;
// NULL: none fails.
void file_faults_start(const char *fault);

// No call fails from here on, in this process.
void file_faults_end(void);

// After "count:", one fault for each chain of callers, the first of their calls. Returns how many.
int file_faults_list(char (*faults)[FILE_FAULT_SIZE], int room);

#endif
