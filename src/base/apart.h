// SPDX-License-Identifier: GPL-2.0-or-later
// A file of unknown content is read in a process of its own, with limits of time and memory: gmsh
// and HDF5 crash or hang on some damaged files, and who called them must still say which file it
// was. Called by io/mesh/mesh_apart, run/info/info_result, and whatever draws: run/result/pictures,
// page/report, study/sweep/showing/render_sweep.
//
// Only where the variable AMONTONS_APART is set, as the program does: a library does not fork in a
// process that it does not know.
#ifndef AMONTONS_BASE_APART_H
#define AMONTONS_BASE_APART_H

#include "base/error.h"

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct ApartWork {
    const char *path;   // the file; messages begin with it
    const char *reader;   // whose fault it is when the process crashes: "gmsh"
    int32_t seconds;   // of processor time that it may take
    const char *advice;   // what to do when that is not enough
    // NULL, or a flag that the caller's handler of SIGINT and SIGTERM sets and `read` looks at: the
    // other process keeps this handler and is passed on SIGTERM, so that it ends in order.
    const volatile sig_atomic_t *stop;
    // Runs in the other process. What it writes to `reply` the caller gets; its error, too.
    bool (*read)(void *context, FILE *reply, Error *err);
    void *context;
} ApartWork;

typedef struct ApartReply {
    char *bytes;   // [size]; owned
    int64_t size;
} ApartReply;

bool apart_is_wanted(void);

// In the other process: so many seconds in all from now on.
void apart_allow(int32_t seconds);

// ERROR_INPUT where the process crashed or went beyond its limits: the file is damaged, or asks for
// too much. Memory: three quarters of what the machine has.
bool apart_read(const ApartWork *work, ApartReply *reply, Error *err);

// The same of work that replies nothing, as it writes files; where apart is not wanted `read` is
// called here, its `reply` NULL.
bool apart_do(const ApartWork *work, Error *err);

void apart_destroy(ApartReply *reply);

#endif
