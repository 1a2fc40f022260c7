// SPDX-License-Identifier: GPL-2.0-or-later
// One thread beside its owner, for what takes long and is waited for by nobody: jobs are done in
// the order in which they were handed over. A job is the number of a slot, of which there are few:
// its owner keeps what it needs there. Called by record/fields.
//
//   slot -> (the owner fills it) -> submit ... -> wait -> destroy
#ifndef AMONTONS_BASE_WORKER_H
#define AMONTONS_BASE_WORKER_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct Worker Worker;

typedef struct WorkerDef {
    int32_t slots;   // jobs that may be under way; whoever hands over more waits
    // Works in the thread. `waiting`: jobs handed over and not done, in the slots from `slot` on;
    // 1: this is the last. After a failure no job is done any more.
    bool (*work)(void *context, int32_t slot, int32_t waiting, Error *err);
    // Is called in the thread after the last job: frees what jobs made; or NULL.
    void (*end)(void *context);
    void *context;   // not owned
} WorkerDef;

bool worker_create(const WorkerDef *def, Worker **worker, Error *err);
// The slot to fill for the next job, once it is free. false: one that is waited for failed, here
// and below.
bool worker_slot(Worker *worker, int32_t *slot, Error *err);
void worker_submit(Worker *worker);
bool worker_wait(Worker *worker, Error *err);   // until every job is done
void worker_destroy(Worker *worker);   // does what was handed over first

#endif
