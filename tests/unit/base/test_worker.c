// SPDX-License-Identifier: GPL-2.0-or-later
// The order of jobs, what waits for what, and what becomes of a failure.
#include "base/worker.h"

#include "base/memory.h"
#include "cases.h"

#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

enum { SLOTS = 3, JOBS = 200 };

// Values from the owner, and results of the thread.
typedef struct Rig {
    Worker *worker;
    int32_t job[SLOTS];
    int32_t done[JOBS], count, lasts;
    int32_t together, wrong;   // jobs met in line behind one; those not where they should be
    bool last;
    int32_t fails_at;   // job; -1: none
    useconds_t takes;
} Rig;

static bool work(void *context, int32_t slot, int32_t waiting, Error *err)
{
    Rig *rig = context;
    for (int32_t k = 0; k < waiting; k++)
        rig->wrong += rig->job[(slot + k) % SLOTS] != rig->job[slot] + k;
    rig->together += waiting - 1;
    rig->wrong += waiting < 1 || waiting > SLOTS;
    usleep(rig->takes);
    if (rig->job[slot] == rig->fails_at) FAIL(err, ERROR_FILE, "job %d", rig->fails_at);
    rig->done[rig->count++] = rig->job[slot];
    rig->last = waiting == 1;
    rig->lasts += rig->last;
cleanup:
    return error_is_clean(err);
}

static void start(Rig *rig, int32_t fails_at, useconds_t takes)
{
    Error err = {0};
    *rig = (Rig){.fails_at = fails_at, .takes = takes};
    WorkerDef def = {.slots = SLOTS, .work = work, .context = rig};
    assert_true(worker_create(&def, &rig->worker, &err));
}

// Returns how many were taken.
static int32_t hand_over(Rig *rig, int32_t jobs, Error *err)
{
    for (int32_t k = 0; k < jobs; k++) {
        int32_t slot;
        if (!worker_slot(rig->worker, &slot, err)) return k;
        rig->job[slot] = k;   // overwrites one that waits, if the slot is not free
        worker_submit(rig->worker);
    }
    return jobs;
}

static void expect_all(const Rig *rig, int32_t jobs)
{
    assert_int_equal(rig->count, jobs);
    for (int32_t k = 0; k < jobs; k++) assert_int_equal(rig->done[k], k);
}

TEST(jobs_are_done_in_order)
{
    int64_t live = memory_counters().live;
    for (useconds_t takes = 0; takes <= 100; takes += 100) {
        Rig rig;
        Error err = {0};
        start(&rig, -1, takes);
        assert_int_equal(hand_over(&rig, JOBS, &err), JOBS);
        assert_true(worker_wait(rig.worker, &err));
        expect_all(&rig, JOBS);
        assert_true(rig.last);
        if (takes > 0) assert_true(rig.lasts < JOBS && rig.together > JOBS / 2);
        assert_int_equal(rig.wrong, 0);
        worker_destroy(rig.worker);
    }
    assert_int_equal(memory_counters().live, live);
}

TEST(what_was_handed_over_is_done_before_it_ends)
{
    Rig rig;
    Error err = {0};
    start(&rig, -1, 2000);
    hand_over(&rig, SLOTS, &err);
    worker_destroy(rig.worker);
    expect_all(&rig, SLOTS);
    worker_destroy(NULL);
    assert_true(worker_wait(NULL, &err));
}

// The owner hears of it once the failed job's slot, at the latest, is asked for again.
TEST(after_a_failure_nothing_is_done)
{
    Rig rig;
    Error err = {0}, again = {0};
    start(&rig, 5, 100);
    int32_t taken = hand_over(&rig, JOBS, &err);
    assert_true(taken > 5 && taken <= 5 + SLOTS);
    assert_string_equal(err.message, "job 5");
    assert_false(worker_wait(rig.worker, &again));
    assert_int_equal(again.code, ERROR_FILE);
    worker_destroy(rig.worker);
    expect_all(&rig, 5);
}

TEST(memory_may_be_short)
{
    Rig rig = {0};
    Error err = {0};
    WorkerDef def = {.slots = SLOTS, .work = work, .context = &rig};
    memory_fail_after(0);
    assert_false(worker_create(&def, &rig.worker, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_null(rig.worker);
}
