// SPDX-License-Identifier: GPL-2.0-or-later
// Threads are made for each call and take the next piece until none is left. Where none is to be
// had the caller's does all.
#include "base/parallel.h"

#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/system.h"

#include <signal.h>
#include <stdatomic.h>

// Address space for one thread more: its stack, what malloc sets aside for it, and the buffer of
// 128 MB that OpenBLAS asks for again and again where it gets none.
static const size_t THREAD_ROOM = (size_t)256 << 20;

static int32_t sharing = 1;   // processes that share the processors
static _Thread_local int32_t left_to_piece;   // threads; 0: not within a piece

typedef struct Work {
    void (*piece)(void *context, int32_t k, int32_t worker);
    void *context;
    int32_t count;
    int32_t left_to_piece;
    atomic_int next;
} Work;

typedef struct Helper {
    Work *work;
    int32_t number;
    pthread_t thread;
    MemoryCounters counted;   // of the thread, at its end
} Helper;

// A thread begins with its maker's mask.
int thread_start(void *(*run)(void *self), void *self, pthread_t *thread)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int cause = pthread_create(thread, NULL, run, self);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return cause;
}

int32_t parallel_workers(void)
{
    if (left_to_piece > 0) return left_to_piece;
    int32_t count = system_processors() / sharing;
    return count < 1 ? 1 : count < PARALLEL_WORKERS_MAX ? count : PARALLEL_WORKERS_MAX;
}

void parallel_share(int32_t processes)
{
    sharing = processes;
}

static void do_pieces(Work *work, int32_t worker)
{
    int32_t before = left_to_piece;
    left_to_piece = work->left_to_piece;
    for (int32_t k = atomic_fetch_add(&work->next, 1); k < work->count;
         k = atomic_fetch_add(&work->next, 1))
        work->piece(work->context, k, worker);
    left_to_piece = before;
}

static void *help(void *self)
{
    NUMBERS_HAVE_A_POINT;
    Helper *helper = self;
    do_pieces(helper->work, helper->number);
    helper->counted = memory_counters();
    return NULL;
}

void parallel_for(int32_t count, void (*piece)(void *context, int32_t k, int32_t worker),
                  void *context)
{
    int32_t workers = memory_may_fail() ? 1 : parallel_workers(), made = 1;
    int32_t wanted = count < workers ? count : workers;
    while (wanted > 1 && !system_has_room((size_t)(wanted - 1) * THREAD_ROOM)) wanted--;
    Work work = {piece, context, count, wanted > 0 ? workers / wanted : 1, 0};
    Helper helpers[PARALLEL_WORKERS_MAX];
    for (; made < wanted; made++) {
        helpers[made] = (Helper){.work = &work, .number = made};
        if (thread_start(help, &helpers[made], &helpers[made].thread) != 0) break;
    }
    do_pieces(&work, 0);
    for (int32_t k = 1; k < made; k++) {
        pthread_join(helpers[k].thread, NULL);
        memory_take_over(helpers[k].counted);
    }
}

void parallel_where(bool worth, int32_t count,
                    void (*piece)(void *context, int32_t k, int32_t worker), void *context)
{
    if (worth) parallel_for(count, piece, context);
    for (int32_t k = 0; !worth && k < count; k++) piece(context, k, 0);
}

typedef struct Tries {
    bool (*piece)(void *context, int32_t k, Error *err);
    void *context;
    Error error[PARALLEL_WORKERS_MAX];
} Tries;

static void try_piece(void *self, int32_t k, int32_t worker)
{
    Tries *tries = self;
    (void)worker;
    tries->piece(tries->context, k, &tries->error[k]);
}

bool parallel_try(int32_t count, bool (*piece)(void *context, int32_t k, Error *err), void *context,
                  Error *err)
{
    Tries tries = {.piece = piece, .context = context};
    parallel_for(count, try_piece, &tries);
    for (int32_t k = 0; k < count && error_is_clean(err); k++) *err = tries.error[k];
    return error_is_clean(err);
}
