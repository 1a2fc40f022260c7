// SPDX-License-Identifier: GPL-2.0-or-later
// Every piece is done once, in several threads where they are to be had, else one after the other;
// pieces of pieces have the threads that are left; signals stay with the caller's thread, and what
// pieces allocate is counted there.
#include "base/parallel.h"

#include "base/memory.h"
#include "cases.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

enum { PIECES = 40, INNER = 5 };

typedef struct Rig {
    int32_t calls[PIECES], worker[PIECES], left[PIECES];
    atomic_int inner[PIECES];   // sums over pieces of a piece
    atomic_int elsewhere;   // pieces of pieces that another thread did
    pthread_t thread[PIECES];
    bool masked[PIECES];
    double *kept[PIECES];
} Rig;

typedef struct Inner {
    Rig *rig;
    int32_t outer;
} Inner;

static void count_inner(void *context, int32_t k, int32_t worker)
{
    const Inner *inner = context;
    assert_true(worker >= 0 && worker < inner->rig->left[inner->outer]);
    if (worker > 0) inner->rig->elsewhere++;
    inner->rig->inner[inner->outer] += k + 1;
    // Until the other thread has begun, 10 s at most: or this one might take all.
    for (int i = 0; i < 50000 && inner->rig->left[inner->outer] > 1 && !inner->rig->elsewhere; i++)
        nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
}

static void piece(void *context, int32_t k, int32_t worker)
{
    Rig *rig = context;
    Error err = {0};
    sigset_t mask;
    pthread_sigmask(SIG_SETMASK, NULL, &mask);
    rig->masked[k] = sigismember(&mask, SIGINT) && sigismember(&mask, SIGTERM);
    rig->thread[k] = pthread_self();
    rig->worker[k] = worker;
    rig->calls[k]++;
    rig->kept[k] = NEW_ARRAY(double, 3, &err);
    rig->left[k] = parallel_workers();
    parallel_for(INNER, count_inner, &(Inner){rig, k});
    nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);   // or one thread might take all
}

static Rig done(int32_t count)
{
    static Rig rig;
    rig = (Rig){0};
    int64_t live = memory_counters().live;
    parallel_for(count, piece, &rig);
    assert_int_equal(memory_counters().live, live + count);
    for (int32_t k = 0; k < count; k++) memory_free(rig.kept[k]);
    for (int32_t k = 0; k < PIECES; k++) {
        assert_int_equal(rig.calls[k], k < count);
        if (k >= count) continue;
        assert_int_equal(rig.inner[k], INNER * (INNER + 1) / 2);
        int32_t workers = parallel_workers(), most = count < workers ? count : workers;
        assert_int_equal(rig.left[k], workers / most);
        assert_true(rig.worker[k] >= 0 && rig.worker[k] < parallel_workers());
        bool here = pthread_equal(rig.thread[k], pthread_self());
        assert_true(here == (rig.worker[k] == 0));
        assert_true(here != rig.masked[k]);
    }
    return rig;
}

TEST(test_all_are_done)
{
    int32_t elsewhere = 0;
    for (int32_t count = 0; count <= PIECES; count += 8) {
        Rig rig = done(count);
        for (int32_t k = 0; k < count; k++) elsewhere += rig.worker[k] > 0;
    }
    assert_true(parallel_workers() == 1 || elsewhere > 0);
}

// Processes that share the processors have their part of them each, and one at least.
TEST(test_processors_are_shared)
{
    int32_t all = parallel_workers();
    parallel_share(2);
    assert_true(parallel_workers() == 1 || parallel_workers() >= all / 2);
    assert_true(all == 1 || parallel_workers() < all || all == PARALLEL_WORKERS_MAX);
    parallel_share(100000);
    assert_int_equal(parallel_workers(), 1);
    parallel_share(1);
    assert_int_equal(parallel_workers(), all);
}

// One piece alone has them all.
TEST(test_pieces_of_pieces)
{
    assert_true((done(1).elsewhere > 0) == (parallel_workers() > 1));
    assert_int_equal(done(PIECES).elsewhere, 0);   // more pieces than threads
}

static bool fail_from(void *context, int32_t k, Error *err)
{
    const int32_t *first = context;
    return k < *first || REFUSE(err, "piece %d", k);
}

// Whichever ends first.
TEST(test_first_failure)
{
    for (int32_t first = 0; first <= 4; first++) {
        char said[20];
        Error err = {0};
        assert_true(parallel_try(4, fail_from, &first, &err) == (first == 4));
        snprintf(said, sizeof said, "piece %d", first);
        assert_string_equal(err.message, first < 4 ? said : "");
    }
}

// As on a machine with one.
TEST(test_one_processor)
{
    cpu_set_t before, one;
    assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (size_t cpu = 0; CPU_COUNT(&one) == 0; cpu++)
        if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    assert_int_equal(parallel_workers(), 1);
    Rig rig = done(PIECES);
    assert_int_equal(sched_setaffinity(0, sizeof before, &before), 0);
    for (int32_t k = 0; k < PIECES; k++) assert_int_equal(rig.worker[k], 0);
}

// A stack that no machine has room for.
TEST(test_no_second_thread)
{
    pthread_attr_t before, endless;
    assert_int_equal(pthread_getattr_default_np(&before), 0);
    pthread_attr_init(&endless);
    assert_int_equal(pthread_attr_setstacksize(&endless, (size_t)1 << 60), 0);
    assert_int_equal(pthread_setattr_default_np(&endless), 0);
    Rig rig = done(PIECES);
    pthread_setattr_default_np(&before);
    pthread_attr_destroy(&before);
    pthread_attr_destroy(&endless);
    for (int32_t k = 0; k < PIECES; k++) assert_int_equal(rig.worker[k], 0);
}
