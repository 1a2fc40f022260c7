// SPDX-License-Identifier: GPL-2.0-or-later
// Another process reads: its answer, its error, and every way in which it may end without one.
#include "base/child_process.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/shut_in.h"
#include "cases.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static bool fails_in(bool (*read)(void *, FILE *, Error *), Error *err)
{
    ChildReply reply = {0};
    ChildWork work = {.path = "stone.msh",
                      .reader = "a mason",
                      .seconds = 7,
                      .advice = "carve less",
                      .read = read};
    bool failed = !child_read(&work, &reply, err);
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
    ChildReply reply = {0};
    ChildWork work = {
        .path = "p", .reader = "r", .seconds = 7, .read = count_up, .context = &first};
    assert_true(child_read(&work, &reply, &err));
    assert_int_equal(first, 5);
    assert_int_equal(reply.size, COUNT * sizeof(int32_t));
    const int32_t *values = (const int32_t *)(const void *)reply.bytes;
    for (int32_t k = 0; k < COUNT; k++) assert_int_equal(values[k], k + 5);
    child_destroy(&reply);
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

// Whoever owns the process says it; the user's variable comes before that.
TEST(test_who_wants_it)
{
    unsetenv("AMONTONS_APART");
    assert_false(child_is_wanted());
    child_use(true);
    assert_true(child_is_wanted());
    setenv("AMONTONS_APART", "", 1);
    assert_false(child_is_wanted());
    child_use(false);
    setenv("AMONTONS_APART", "yes", 1);
    assert_true(child_is_wanted());
    unsetenv("AMONTONS_APART");
    assert_false(child_is_wanted());
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

// A stop that interrupts no call, as it came before the parent had begun to wait.
TEST(test_stop_before_it_waits)
{
    Error err = {0};
    ChildReply reply = {0};
    volatile sig_atomic_t *told =
        mmap(NULL, sizeof *told, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(told != MAP_FAILED);
    ChildWork work = {
        .path = "p", .reader = "r", .seconds = 7, .read = work_until_stopped, .stop = told};
    signal(SIGTERM, note_stop);
    alarm(30);   // ends a parent that waits for ever
    pid_t teller = fork();
    if (teller == 0) {
        usleep(200000);
        *told = 1;
        _exit(0);
    }
    assert_false(child_read(&work, &reply, &err));
    alarm(0);
    signal(SIGTERM, SIG_DFL);
    waitpid(teller, NULL, 0);
    munmap((void *)told, sizeof *told);
    assert_int_equal(err.code, ERROR_INTERRUPT);
}

// --- waiting for ever ---------------------------------------------------------------------------

// No processor time, but by the clock.
static bool wait_for_ever(void *context, FILE *reply, Error *err)
{
    (void)context;
    (void)reply;
    (void)err;
    while (pause() < 0) continue;
    return true;
}

// Its own child keeps the pipe open when it is ended.
static bool leave_somebody_waiting(void *context, FILE *reply, Error *err)
{
    if (fork() == 0) {
        sleep(8);
        _exit(0);
    }
    return wait_for_ever(context, reply, err);
}

TEST(test_waiting)
{
    bool (*const reads[])(void *, FILE *, Error *) = {wait_for_ever, leave_somebody_waiting};
    for (size_t k = 0; k < sizeof reads / sizeof *reads; k++) {
        Error err = {0};
        ChildReply reply = {0};
        ChildWork work = {.path = "stone.msh",
                          .reader = "a mason",
                          .seconds = 7,
                          .seconds_waited = 1,
                          .advice = "carve less",
                          .read = reads[k]};
        double started = clock_seconds();
        assert_false(child_read(&work, &reply, &err));
        assert_true(clock_seconds() - started < 5);
        says(&err,
             "stone.msh: a mason was still reading it after 1 seconds, and was ended; carve less");
    }
}

// Goes on twice, then no longer.
static bool goes_on_twice(void *self, Error *err)
{
    int *asked = self;
    if (++*asked <= 2) return true;
    error_set(err, ERROR_INTERRUPT, __FILE__, __LINE__, "time is up");
    return false;
}

TEST(test_watch_ends_it)
{
    Error err = {0};
    ChildReply reply = {0};
    int asked = 0;
    ChildWatch watch = {.goes_on = goes_on_twice, .self = &asked};
    ChildWork work = {
        .path = "p", .reader = "r", .seconds = 7, .watch = &watch, .read = wait_for_ever};
    double started = clock_seconds();
    assert_false(child_read(&work, &reply, &err));
    assert_true(clock_seconds() - started < 5);
    assert_int_equal(asked, 3);
    assert_int_equal(err.code, ERROR_INTERRUPT);
}

// --- shut in ------------------------------------------------------------------------------------

// OTHER is there, OUTSIDE is not: both in the folder of this test.
static const char OUTSIDE[] = "amontons_test_outside", OTHER[] = "amontons_test_other";

static void *nothing(void *unused)
{
    return unused;
}

// A letter for each attempt: "." where it failed with EPERM, else what it was. Where it succeeds it
// must not go on as two.
static bool try_all(void *context, FILE *reply, Error *err)
{
    char *const words[] = {"/bin/true", NULL};
    pid_t parent = getppid(), made;
    struct rlimit limit = {1, 1};
    (void)context;
    (void)err;
#define TRIED(letter, call) fputc((call) < 0 && errno == EPERM ? '.' : letter, reply)
    TRIED('w', open(OUTSIDE, O_WRONLY | O_CREAT, 0600));
    TRIED('W', open("/dev/null", O_RDWR));
    TRIED('t', open(".", O_TMPFILE | O_RDWR, 0600));
    TRIED('c', creat(OUTSIDE, 0600));
    TRIED('d', mkdir(OUTSIDE, 0700));
    TRIED('u', unlink(OTHER));
    TRIED('r', rename(OTHER, OUTSIDE));
    TRIED('l', link(OTHER, OUTSIDE));
    TRIED('s', symlink(OTHER, OUTSIDE));
    TRIED('m', chmod(OTHER, 0700));
    TRIED('p', mkfifo(OUTSIDE, 0700));
    TRIED('T', truncate(OTHER, 0));
    TRIED('n', socket(AF_INET, SOCK_STREAM, 0));
    TRIED('N', socket(AF_UNIX, SOCK_STREAM, 0));
    TRIED('k', kill(parent, SIGCONT));
    TRIED('K', kill(1, 0));
    TRIED('P', ptrace(PTRACE_ATTACH, parent, NULL, NULL));
    TRIED('L', prlimit(parent, RLIMIT_CPU, &limit, NULL));
    TRIED('x', execv("/bin/true", words));
    TRIED('y', prctl(PR_SET_NAME, "x"));
    TRIED('i', ioctl(STDERR_FILENO, TIOCSTI, "x"));
    made = fork();
    if (made == 0) _exit(0);
    errno = made < 0 ? errno : 0;
    fputc(made < 0 && errno == EPERM ? '.' : 'f', reply);
    return fputc(system("true") == 0 ? 'S' : '.', reply) != EOF;
}

// All that a reader needs works: files, memory, threads, clocks, an end by abort.
static bool work_as_usual(void *context, FILE *reply, Error *err)
{
    pthread_t thread;
    char line[100];
    FILE *file = fopen("/proc/self/stat", "r");
    (void)context;
    (void)err;
    fputc(file && fgets(line, sizeof line, file) ? 'r' : '-', reply);
    fputc(pthread_create(&thread, NULL, nothing, NULL) == 0 && pthread_join(thread, NULL) == 0
              ? 't'
              : '-',
          reply);
    char *much = malloc(100 << 20);
    if (much) memset(much, 1, 100 << 20);
    fputc(much ? 'm' : '-', reply);
    free(much);
    fputc(usleep(1000) == 0 ? 's' : '-', reply);
    fputc(write(STDOUT_FILENO, "lost", 4) == 4 ? 'o' : '-', reply);
    child_allow(90);
    return fputc(fcntl(12, F_GETFL) < 0 ? 'c' : '-', reply) != EOF;   // it was open in the parent
}

static void check_shut_in(bool (*read)(void *, FILE *, Error *), const char *wanted)
{
    Error err = {0};
    ChildReply reply = {0};
    char found[64] = "";
    ChildWork work = {.path = "p", .reader = "r", .seconds = 7, .shut_in = true, .read = read};
    int other = open(OTHER, O_WRONLY | O_CREAT, 0600);
    if (!child_read(&work, &reply, &err)) fail_msg("%s", err.message);
    assert_true(reply.size < (int64_t)sizeof found);
    memcpy(found, reply.bytes, (size_t)reply.size);
    assert_string_equal(found, wanted);
    assert_int_not_equal(access(OUTSIDE, F_OK), 0);
    assert_int_equal(unlink(OTHER), 0);
    close(other);
    child_destroy(&reply);
}

static bool tell_filter(void *context, FILE *reply, Error *err)
{
    (void)context;
    (void)err;
    return fputc(shut_in() ? '1' : '0', reply) != EOF;
}

TEST(test_shut_in)
{
    Error err = {0};
    ChildReply reply = {0};
    ChildWork work = {.path = "p", .reader = "r", .seconds = 7, .read = tell_filter};
    assert_true(child_read(&work, &reply, &err));
    bool can = reply.bytes[0] == '1';
    child_destroy(&reply);
    if (!can) skip();   // a kernel, or an emulator of one, without seccomp
    int file = dup2(STDERR_FILENO, 12);
    check_shut_in(try_all, ".......................");
    check_shut_in(work_as_usual, "rtmsoc");
    close(file);
    work.shut_in = true;
    work.read = crash;
    assert_false(child_read(&work, &reply, &err));
    says(&err, "(Aborted)");
}

// --- limits -------------------------------------------------------------------------------------

// The limits of the child; the parent stays as it was.
static bool tell_limits(void *context, FILE *reply, Error *err)
{
    struct rlimit limits[4];
    (void)context;
    (void)err;
    getrlimit(RLIMIT_CPU, &limits[0]);
    getrlimit(RLIMIT_AS, &limits[1]);
    getrlimit(RLIMIT_CORE, &limits[2]);
    child_allow(90);
    getrlimit(RLIMIT_CPU, &limits[3]);
    return fwrite(limits, sizeof limits, 1, reply) == 1;
}

TEST(test_limits)
{
    Error err = {0};
    struct rlimit before, after, limits[4];
    ChildReply reply = {0};
    ChildWork work = {.path = "p", .reader = "r", .seconds = 7, .read = tell_limits};
    getrlimit(RLIMIT_CPU, &before);
    assert_true(child_read(&work, &reply, &err));
    assert_int_equal(reply.size, sizeof limits);
    memcpy(limits, reply.bytes, sizeof limits);
    assert_int_equal(limits[0].rlim_cur, 7);
    assert_true(limits[1].rlim_cur < RLIM_INFINITY);
    assert_int_equal(limits[2].rlim_cur, 0);
    assert_int_equal(limits[3].rlim_cur, 90);
    getrlimit(RLIMIT_CPU, &after);
    assert_int_equal(before.rlim_cur, after.rlim_cur);
    child_destroy(&reply);
}
