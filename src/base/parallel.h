// SPDX-License-Identifier: GPL-2.0-or-later
// Work in pieces that know nothing of each other, in as many threads as the process may use. Pieces
// follow from the work's size alone, so that what comes out does not depend on the threads. Called
// by algebra/dense, algebra/sparse_factor and several of reduction/.
#ifndef AMONTONS_BASE_PARALLEL_H
#define AMONTONS_BASE_PARALLEL_H

#include "base/error.h"

#include <pthread.h>
#include <stdint.h>

enum {
    PARALLEL_WORKERS_MAX = 8,
    PARALLEL_OPERATIONS =
        20000000,   // some ms: with less, threads (20 us each to begin) save little
    PARALLEL_ENTRIES = 4000000   // of a matrix that is read once and comes from memory: the same
};

// Starts a thread as those below are, for base/worker, too: signals are for the threads of whoever
// calls. 0, or what pthread_create says.
int thread_start(void *(*run)(void *self), void *self, pthread_t *thread);

// Processors of this process, PARALLEL_WORKERS_MAX at most; from within a piece: those left to it.
int32_t parallel_workers(void);
// From now on so many processes like this one share the processors.
void parallel_share(int32_t processes);

// Calls piece(context, k, worker) for k from 0 to count - 1; returns when all are done. worker:
// which thread it is, for room of its own; 0 is the caller's. From within a piece: those that are
// left to it share in the same way.
void parallel_for(int32_t count, void (*piece)(void *context, int32_t k, int32_t worker),
                  void *context);

// The same, but by the caller's thread alone where it is not worth others.
void parallel_where(bool worth, int32_t count,
                    void (*piece)(void *context, int32_t k, int32_t worker), void *context);

// As parallel_for, of at most PARALLEL_WORKERS_MAX pieces that may fail: each has an error of its
// own, the caller's becomes that of the first piece that failed, by its number.
bool parallel_try(int32_t count, bool (*piece)(void *context, int32_t k, Error *err), void *context,
                  Error *err);

#endif
