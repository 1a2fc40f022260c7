// SPDX-License-Identifier: GPL-2.0-or-later
// Locks between processes: waited for, given up after the limit, free after a kill; counted by many
// processes that each add one to a number in a file.
#include "io/files/file_lock.h"

#include "base/clock.h"
#include "cases.h"

#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/amontons_lock_XXXXXX", path[64], number[64];

// A process that holds the lock until it is killed, or this one dies; returns when it does.
static pid_t start_holder(void)
{
    int ends[2];
    char byte = 0;
    assert_int_equal(pipe(ends), 0);
    pid_t holder = fork();
    if (holder == 0) {
        FileLock lock;
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        byte = (char)file_lock_take(&lock, path, 1);
        if (write(ends[1], &byte, 1) != 1) _exit(1);
        for (;;) pause();
    }
    assert_true(holder > 0);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    assert_int_equal(byte, 1);
    close(ends[0]);
    close(ends[1]);
    return holder;
}

TEST(held_until_released)
{
    FileLock lock, other;
    assert_true(file_lock_take(&lock, path, 0));
    assert_int_equal(access(path, F_OK), 0);
    assert_false(file_lock_take(&other, path, 0));
    assert_false(other.held);
    file_lock_release(&other);   // not held: touches nothing
    assert_int_equal(access(path, F_OK), 0);
    file_lock_release(&lock);
    file_lock_release(&lock);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_true(file_lock_take(&other, path, 0));
    file_lock_release(&other);
}

TEST(given_up_after_the_limit)
{
    FileLock lock;
    pid_t holder = start_holder();
    double before = clock_seconds();
    assert_false(file_lock_take(&lock, path, 0.1));
    double waited = clock_seconds() - before;
    assert_true(waited >= 0.1 && waited < 5);
    kill(holder, SIGKILL);
    waitpid(holder, NULL, 0);
}

// The file that a killed holder left is there, and free.
TEST(free_after_a_kill)
{
    FileLock lock;
    pid_t holder = start_holder(), killer = fork();
    if (killer == 0) {
        usleep(50000);
        kill(holder, SIGKILL);
        _exit(0);
    }
    assert_true(file_lock_take(&lock, path, 30));   // waits for the kill
    assert_true(file_is_named(path, lock.descriptor));
    file_lock_release(&lock);
    assert_int_not_equal(access(path, F_OK), 0);
    waitpid(killer, NULL, 0);
    waitpid(holder, NULL, 0);
}

// Reading the number and writing it back are far apart: without the lock additions are lost.
static void add_one(void)
{
    FileLock lock;
    int value = 0;
    if (!file_lock_take(&lock, path, 60)) _exit(1);
    FILE *file = fopen(number, "r");
    if (!file || fscanf(file, "%d", &value) != 1) _exit(2);
    fclose(file);
    usleep(300);
    file = fopen(number, "w");
    if (!file || fprintf(file, "%d\n", value + 1) < 0 || fclose(file) != 0) _exit(3);
    file_lock_release(&lock);
}

// The file comes and goes between them, so that some lock a file that has no name any more.
TEST(one_at_a_time)
{
    enum { PROCESSES = 6, TIMES = 20 };
    pid_t process[PROCESSES];
    int value = 0, ending = 0;
    FILE *file = fopen(number, "w");
    fprintf(file, "0\n");
    fclose(file);
    for (int k = 0; k < PROCESSES; k++) {
        process[k] = fork();
        if (process[k] != 0) continue;
        for (int32_t time = 0; time < TIMES; time++) add_one();
        _exit(0);
    }
    for (int k = 0; k < PROCESSES; k++) {
        waitpid(process[k], &ending, 0);
        assert_int_equal(ending, 0);
    }
    file = fopen(number, "r");
    assert_int_equal(fscanf(file, "%d", &value), 1);
    fclose(file);
    assert_int_equal(value, PROCESSES * TIMES);
    assert_int_not_equal(access(path, F_OK), 0);
}

// A file that was opened before its name went to another file guards nothing.
TEST(a_name_may_lead_elsewhere)
{
    int old = open(number, O_RDWR | O_CREAT, 0600);
    assert_true(file_is_named(number, old));
    unlink(number);
    assert_false(file_is_named(number, old));
    int new = open(number, O_RDWR | O_CREAT, 0600);
    assert_false(file_is_named(number, old));
    assert_true(file_is_named(number, new));
    close(old);
    close(new);
}

TEST(nowhere_to_lock)
{
    FileLock lock;
    double before = clock_seconds();
    assert_false(file_lock_take(&lock, "/tmp/amontons_no_such_folder/lock", 30));
    assert_false(file_lock_take(&lock, "/proc/self/lock", 30));
    assert_true(clock_seconds() - before < 5);
    file_lock_release(&lock);
}

FIXTURE(make_folder)
{
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/x.lock", folder);
    snprintf(number, sizeof number, "%s/number", folder);
    return 0;
}

FIXTURE(remove_folder)
{
    unlink(number);
    return rmdir(folder);
}

GROUP_BETWEEN(make_folder, remove_folder);
