// SPDX-License-Identifier: GPL-2.0-or-later
// Two counters: jobs `given` and `done`, each a ring's end. Whatever either side wrote before it
// moved its counter the other sees: both move under the lock.
#include "base/worker.h"

#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <string.h>

struct Worker {
    WorkerDef def;
    pthread_t thread;
    pthread_mutex_t lock;   // of all that follows
    pthread_cond_t changed;
    int64_t given, done;   // jobs
    bool ends;
    int64_t sound;   // jobs done before one failed
    Error failure;   // of the first job that failed
};

// The thread. The lock is held but during the work.
static void *run(void *self)
{
    Worker *worker = self;
    NUMBERS_HAVE_A_POINT;
    pthread_mutex_lock(&worker->lock);
    while (!worker->ends || worker->done < worker->given) {
        if (worker->done == worker->given) {
            pthread_cond_wait(&worker->changed, &worker->lock);
            continue;
        }
        bool works = error_is_clean(&worker->failure);
        int32_t waiting = (int32_t)(worker->given - worker->done);
        int32_t slot = (int32_t)(worker->done % worker->def.slots);
        Error failure = {0};
        pthread_mutex_unlock(&worker->lock);
        if (works) worker->def.work(worker->def.context, slot, waiting, &failure);
        pthread_mutex_lock(&worker->lock);
        if (works) worker->failure = failure;
        worker->done++;
        if (error_is_clean(&worker->failure)) worker->sound = worker->done;
        pthread_cond_broadcast(&worker->changed);
    }
    pthread_mutex_unlock(&worker->lock);
    if (worker->def.end) worker->def.end(worker->def.context);
    return NULL;
}

bool worker_create(const WorkerDef *def, Worker **out, Error *err)
{
    *out = NULL;
    Worker *worker = NEW_ARRAY(Worker, 1, err);
    if (!worker) return false;
    worker->def = *def;
    pthread_mutex_init(&worker->lock, NULL);
    pthread_cond_init(&worker->changed, NULL);
    int cause = thread_start(run, worker, &worker->thread);
    if (cause != 0) {
        memory_free(worker);
        return FAULT(err, ERROR_MEMORY, "no thread for work beside: %s", strerror(cause));
    }
    *out = worker;
    return error_is_clean(err);
}

// Waits until the first `jobs` are done.
static bool wait_for(Worker *worker, int64_t jobs, Error *err)
{
    pthread_mutex_lock(&worker->lock);
    while (worker->done < jobs) pthread_cond_wait(&worker->changed, &worker->lock);
    bool failed = worker->sound < jobs;
    if (failed) *err = worker->failure;
    pthread_mutex_unlock(&worker->lock);
    return !failed;
}

bool worker_slot(Worker *worker, int32_t *slot, Error *err)
{
    *slot = (int32_t)(worker->given % worker->def.slots);   // only the owner moves `given`
    return wait_for(worker, worker->given - worker->def.slots + 1, err);
}

void worker_submit(Worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    worker->given++;
    pthread_cond_broadcast(&worker->changed);
    pthread_mutex_unlock(&worker->lock);
}

bool worker_wait(Worker *worker, Error *err)
{
    return !worker || wait_for(worker, worker->given, err);
}

void worker_destroy(Worker *worker)
{
    if (!worker) return;
    pthread_mutex_lock(&worker->lock);
    worker->ends = true;
    pthread_cond_broadcast(&worker->changed);
    pthread_mutex_unlock(&worker->lock);
    pthread_join(worker->thread, NULL);
    pthread_cond_destroy(&worker->changed);
    pthread_mutex_destroy(&worker->lock);
    memory_free(worker);
}
