// SPDX-License-Identifier: GPL-2.0-or-later
// Another process reads: its answer, its error, and every way in which it may end without one.
#include "base/apart.h"

#include "base/memory.h"
#include "cases.h"

#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static bool fails_in(bool (*read)(void *, FILE *, Error *), Error *err)
{
    ApartReply reply = {0};
    ApartWork work = {.path = "stone.msh",
                      .reader = "a mason",
                      .seconds = 7,
                      .advice = "carve less",
                      .read = read};
    bool failed = !apart_read(&work, &reply, err);
    assert_null(reply.bytes);
    return failed;
}

static void says(const Error *err, const char *words)
{
    if (!strstr(err->message, words)) fail_msg("'%s' is not in: %s", words, err->message);
}

// --- answers ------------------------------------------------------------------------------------

// More than the pipe holds at once.
enum { COUNT = 300000 };

static bool count_up(void *context, FILE *reply, Error *err)
{
    (void)err;
    for (int32_t k = 0; k < COUNT; k++) {
        int32_t value = k + *(int32_t *)context;
        fwrite(&value, sizeof value, 1, reply);
    }
    *(int32_t *)context = -1;   // nobody but the child sees it
    return true;
}

TEST(test_reply)
{
    Error err = {0};
    int32_t first = 5;
    int64_t live = memory_counters().live;
    ApartReply reply = {0};
    ApartWork work = {
        .path = "p", .reader = "r", .seconds = 7, .read = count_up, .context = &first};
    assert_true(apart_read(&work, &reply, &err));
    assert_int_equal(first, 5);
    assert_int_equal(reply.size, COUNT * sizeof(int32_t));
    const int32_t *values = (const int32_t *)(const void *)reply.bytes;
    for (int32_t k = 0; k < COUNT; k++) assert_int_equal(values[k], k + 5);
    apart_destroy(&reply);
    assert_int_equal(memory_counters().live, live);
}

static bool refuse(void *context, FILE *reply, Error *err)
{
    (void)context;
    fprintf(reply, "half an answer");
    error_set(err, ERROR_FILE, __FILE__, __LINE__, "line 3: no stone");
    return false;
}

TEST(test_error_comes_back)
{
    Error err = {0};
    assert_true(fails_in(refuse, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_string_equal(err.message, "line 3: no stone");
}

// Only the program asks for it, by the environment.
TEST(test_who_wants_it)
{
    unsetenv("AMONTONS_APART");
    assert_false(apart_is_wanted());
    setenv("AMONTONS_APART", "", 1);
    assert_false(apart_is_wanted());
    setenv("AMONTONS_APART", "yes", 1);
    assert_true(apart_is_wanted());
}

// --- no answer ----------------------------------------------------------------------------------

static bool crash(void *context, FILE *reply, Error *err)
{
    (void)context;
    (void)err;
    fprintf(reply, "half an answer");
    abort();
}

static bool leave(void *context, FILE *reply, Error *err)
{
    (void)context;
    (void)reply;
    (void)err;
    _exit(0);
}

static bool take_too_long(void *context, FILE *reply, Error *err)
{
    (void)context;
    (void)reply;
    (void)err;
    return raise(SIGXCPU) == 0;   // what the kernel sends at the limit
}

static bool be_killed(void *context, FILE *reply, Error *err)
{
    (void)context;
    (void)reply;
    (void)err;
    return raise(SIGKILL) == 0;   // what the kernel sends when memory runs out
}

TEST(test_ends_without_answer)
{
    static const struct {
        bool (*read)(void *, FILE *, Error *);
        const char *words;
    } rows[] = {{crash, "stone.msh: a mason crashes while reading it (Aborted)"},
                {leave, "stone.msh: a mason crashes while reading it (without a word)"},
                {take_too_long, "stone.msh: a mason had not read it after 1 seconds; carve less"},
                {be_killed, "stone.msh: a mason was ended while reading it, at"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Error err = {0};
        assert_true(fails_in(rows[k].read, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        says(&err, rows[k].words);
    }
}

// A crash was called a damaged file "without a word".
TEST(test_ignored_children)
{
    Error err = {0};
    signal(SIGCHLD, SIG_IGN);
    assert_true(fails_in(crash, &err));
    signal(SIGCHLD, SIG_DFL);
    says(&err,
         "stone.msh: the process in which a mason reads it ended in a way that nobody can say");
}

// --- stopped ------------------------------------------------------------------------------------

static volatile sig_atomic_t stopped;

static void note_stop(int number)
{
    (void)number;
    stopped = 1;
}

static bool work_until_stopped(void *context, FILE *reply, Error *err)
{
    (void)context;
    stopped = 0;   // its copy; the parent is told meanwhile
    fputc('r', reply);
    fflush(reply);
    while (!stopped) usleep(1000);
    error_set(err, ERROR_INTERRUPT, __FILE__, __LINE__, "stopped");
    return false;
}

static void *tell_without_a_signal(void *unused)
{
    usleep(200000);
    stopped = 1;
    return unused;
}

// A stop that interrupts no call, as it came before the parent had begun to wait.
TEST(test_stop_before_it_waits)
{
    Error err = {0};
    ApartReply reply = {0};
    ApartWork work = {
        .path = "p", .reader = "r", .seconds = 7, .read = work_until_stopped, .stop = &stopped};
    pthread_t teller;
    signal(SIGTERM, note_stop);
    alarm(30);   // ends a parent that waits for ever
    stopped = 0;
    assert_int_equal(pthread_create(&teller, NULL, tell_without_a_signal, NULL), 0);
    assert_false(apart_read(&work, &reply, &err));
    alarm(0);
    signal(SIGTERM, SIG_DFL);
    pthread_join(teller, NULL);
    assert_int_equal(err.code, ERROR_INTERRUPT);
}

// --- limits -------------------------------------------------------------------------------------

// What the child may use; the parent stays as it was.
static bool tell_limits(void *context, FILE *reply, Error *err)
{
    struct rlimit limits[4];
    (void)context;
    (void)err;
    getrlimit(RLIMIT_CPU, &limits[0]);
    getrlimit(RLIMIT_AS, &limits[1]);
    getrlimit(RLIMIT_CORE, &limits[2]);
    apart_allow(90);
    getrlimit(RLIMIT_CPU, &limits[3]);
    return fwrite(limits, sizeof limits, 1, reply) == 1;
}

TEST(test_limits)
{
    Error err = {0};
    struct rlimit before, after, limits[4];
    ApartReply reply = {0};
    ApartWork work = {.path = "p", .reader = "r", .seconds = 7, .read = tell_limits};
    getrlimit(RLIMIT_CPU, &before);
    assert_true(apart_read(&work, &reply, &err));
    assert_int_equal(reply.size, sizeof limits);
    memcpy(limits, reply.bytes, sizeof limits);
    assert_int_equal(limits[0].rlim_cur, 7);
    assert_true(limits[1].rlim_cur < RLIM_INFINITY);
    assert_int_equal(limits[2].rlim_cur, 0);
    assert_int_equal(limits[3].rlim_cur, 90);
    getrlimit(RLIMIT_CPU, &after);
    assert_int_equal(before.rlim_cur, after.rlim_cur);
    apart_destroy(&reply);
}
