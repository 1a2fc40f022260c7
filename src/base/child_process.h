// SPDX-License-Identifier: GPL-2.0-or-later
// A file of unknown content is read in a child process, with limits of time and memory: gmsh and
// HDF5 crash or hang on some damaged files, and who called them must still say which file it was. A
// child that only reads can be shut in besides (base/shut_in). Called by io/mesh/mesh_read and
// whatever draws: run/result/pictures, page/report, study/sweep/showing/render_sweep.
//
// Only where whoever owns the process has said so (amontons_use_child_processes, or the user by the
// variable AMONTONS_APART): a library does not fork in a process that it does not know.
#ifndef AMONTONS_BASE_CHILD_PROCESS_H
#define AMONTONS_BASE_CHILD_PROCESS_H

#include "base/error.h"

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

// Somebody who may end the child while it is waited for.
typedef struct ChildWatch {
    bool (*goes_on)(void *self, Error *err);   // false, with the reason: the child is ended
    void *self;   // not owned
} ChildWatch;

typedef struct ChildWork {
    const char *path;   // the file; messages begin with it
    const char *reader;   // whose fault it is when the process crashes: "gmsh"
    int32_t seconds;   // of processor time that it may take
    int32_t seconds_waited;   // that it may take by the clock, whatever it waits for; 0: no limit
    int kept;   // a descriptor that a child which is shut in keeps; below 1: none
    bool shut_in;   // it may only read, and write to `reply`; its standard output goes nowhere
    const char *advice;   // what to do when that is not enough
    const ChildWatch *watch;   // asked every tenth of a second; NULL: nobody; not owned
    // NULL, or a flag that the caller's handler of SIGINT and SIGTERM sets and `read` looks at: the
    // other process keeps this handler and is passed on SIGTERM, so that it ends in order.
    const volatile sig_atomic_t *stop;
    // Runs in the other process. What it writes to `reply` the caller gets; its error, too.
    bool (*read)(void *context, FILE *reply, Error *err);
    void *context;
} ChildWork;

typedef struct ChildReply {
    char *bytes;   // [size]; owned
    int64_t size;
} ChildReply;

void child_use(bool use);   // amontons_use_child_processes
bool child_is_wanted(void);

// In the other process: so many seconds in all from now on.
void child_allow(int32_t seconds);

// ERROR_INPUT where the process crashed or went beyond its limits: the file is damaged, or asks for
// too much. Memory: three quarters of what the machine has.
bool child_read(const ChildWork *work, ChildReply *reply, Error *err);

// The same of work that replies nothing, as it writes files; where no child is wanted `read` is
// called here, its `reply` NULL.
bool child_do(const ChildWork *work, Error *err);

void child_destroy(ChildReply *reply);

#endif
