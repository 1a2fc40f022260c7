// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points as Slurm job arrays, an element a point, and waits for them. Slurm is
// spoken to by its commands: sbatch submits, squeue tells which elements are gone, scancel ends
// them. What a point came to stands in its run.json, as with the pool; only an element that left
// none is judged by what Slurm says of it. All arrays of a folder have one job name, made of the
// folder's place: by it a sweep finds what an earlier one, killed, left behind.
#include "study/sweep/sweep.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/program.h"
#include "io/text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <wordexp.h>

enum {
    LINE_SIZE = 160,   // of squeue for an element
    STATE_SIZE = 32,
    REASON_SIZE = 64,
    ANSWER_SIZE = 65536,   // of the other commands; `scontrol show config` says some 12 kB
    ARRAY_STANDARD = 1000,   // elements of an array where Slurm does not say
    SILENCE_MAX = 60,   // times that squeue may fail one after the other: a controller restarts
    ARGUMENTS_MAX = 100,
};

static const double LOOK_PAUSE = 2;   // s between two looks at the queue
static const double STOP_PAUSE = 0.1;   // s between two looks at the stop flag
static const double REPORT_PAUSE = 10;   // s that a file system shared by nodes may take to show a
    // run.json after its element has ended
static const double CANCEL_PAUSE = 60;   // s that cancelled elements may take to be gone

typedef struct Element {
    int32_t point;
    bool taken;   // its result is counted
    bool listed, ended;   // by squeue, at the last look
    char state[STATE_SIZE], reason[REASON_SIZE];   // as squeue says
    double gone_since;   // wall clock, s; 0: not gone
} Element;

typedef struct SlurmArray {
    char id[STATE_SIZE];
    int32_t first, count;   // elements
} SlurmArray;

typedef struct SlurmRun {
    Sweep *sweep;
    char folder[AMONTONS_PATH_SIZE];   // of the sweep, from the root
    char name[20 + HASH_TEXT_SIZE];   // of its jobs
    int32_t count, left;   // elements; those not taken
    Element *elements;   // [count]; owned, like the rest
    int32_t array_count;
    SlurmArray *arrays;   // [array_count]
    char *answer;   // [answer_size] of a command
    size_t answer_size;
    int32_t silence;   // times that squeue failed
} SlurmRun;

// --- Slurm's commands ---------------------------------------------------------------------------

// Runs one of Slurm's commands; its words, without the last line end, in run->answer.
static bool ask(SlurmRun *run, const char *const *words, int *status, Error *err)
{
    if (!program_run(words, run->answer, run->answer_size, status, err))
        error_context(err, "--slurm needs Slurm's commands (sbatch, squeue, scancel) in PATH");
    for (size_t used = strlen(run->answer); used && run->answer[used - 1] == '\n';)
        run->answer[--used] = 0;
    return error_is_clean(err);
}

// Whether any job of this folder is waiting or running. False also where squeue fails.
static bool any_alive(SlurmRun *run, Error *err)
{
    char name[sizeof run->name + 10];
    int status = 0;
    snprintf(name, sizeof name, "--name=%s", run->name);
    const char *const words[] = {"squeue", "-h", name, "-o", "%F", NULL};
    return ask(run, words, &status, err) && status == 0 && run->answer[0];
}

// A signal ends it early, which is what is wanted of a stop.
static void nap(double seconds)
{
    struct timespec time = {.tv_sec = (time_t)seconds,
                            .tv_nsec = (long)((seconds - floor(seconds)) * 1e9)};
    nanosleep(&time, NULL);
}

// Cancels all jobs of this folder and waits until they are gone: nobody writes into it then.
static bool cancel(SlurmRun *run, Error *err)
{
    char name[sizeof run->name + 10];
    int status = 0;
    double until = clock_seconds() + CANCEL_PAUSE;
    snprintf(name, sizeof name, "--name=%s", run->name);
    const char *const words[] = {"scancel", name, NULL};
    TRY(ask(run, words, &status, err));
    if (status != 0) FAIL(err, ERROR_LIBRARY, "scancel fails: %.1500s", run->answer);
    while (any_alive(run, err)) {
        if (clock_seconds() > until)
            FAIL(err, ERROR_LIBRARY, "jobs called %s are still there a minute after scancel",
                 run->name);
        nap(STOP_PAUSE);
    }
cleanup:
    return error_is_clean(err);
}

// How many elements an array may have: MaxArraySize of this Slurm.
static int32_t array_limit(SlurmRun *run)
{
    static const char *const words[] = {"scontrol", "show", "config", NULL};
    Error ignored = {0};
    int status = 0, limit = 0;
    if (!program_run(words, run->answer, run->answer_size, &status, &ignored))
        return ARRAY_STANDARD;
    const char *at = strstr(run->answer, "MaxArraySize");
    if (!at || sscanf(at, "MaxArraySize = %d", &limit) != 1 || limit < 2) return ARRAY_STANDARD;
    return limit - 1;   // the largest index is one below, and ours begin at 0
}

// --- submitting ---------------------------------------------------------------------------------

static void make_path(const SlurmRun *run, char path[POINT_PATH_SIZE], const char *ending)
{
    snprintf(path, POINT_PATH_SIZE, "%s/slurm/%.40s", run->folder, ending);
}

// `'` inside quotes of a shell is '\''.
static void print_quoted(FILE *file, const char *text)
{
    fputc('\'', file);
    for (; *text; text++) {
        if (*text == '\'') fputs("'\\'", file);
        fputc(*text, file);
    }
    fputc('\'', file);
}

// array-K.sh, which every element of array K runs: this program with array-K.json.
static bool write_script(const char *path, const char *list, Error *err)
{
    char program[PATH_MAX] = "";
    FILE *file = NULL;
    if (readlink("/proc/self/exe", program, sizeof program - 1) < 0)
        FAIL(err, ERROR_FILE, "cannot tell where the program stands (/proc/self/exe)");
    if (!(file = fopen(path, "w")))
        FAIL(err, ERROR_FILE, "cannot write %s: %s", path, strerror(errno));
    fprintf(file, "#!/bin/sh\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\nexec ");
    print_quoted(file, program);
    fprintf(file, " sweep --element ");
    print_quoted(file, list);
    fprintf(file, "\n");
    bool written = fclose(file) == 0;
    file = NULL;
    if (!written) FAIL(err, ERROR_FILE, "cannot write %s: %s", path, strerror(errno));
cleanup:
    return error_is_clean(err);
}

// sbatch with the user's words; ours behind them, but where the output goes. array->id: the job.
static bool submit(SlurmRun *run, SlurmArray *array, const char *script, Error *err)
{
    const char *words[ARGUMENTS_MAX] = {"sbatch", "--parsable"};
    char output[POINT_PATH_SIZE + 10], elements[60], name[sizeof run->name + 12];
    int32_t jobs = run->sweep->options->jobs, used = 2;
    int status = 0;
    wordexp_t given = {0};
    if (wordexp(run->sweep->options->slurm, &given, WRDE_NOCMD) != 0 ||
        given.we_wordc + 10 > ARGUMENTS_MAX)
        FAIL(err, ERROR_INPUT,
             "--slurm=%s: wanted are words for sbatch, as in "
             "--slurm=\"--partition=short --time=10\"",
             run->sweep->options->slurm);
    snprintf(output, sizeof output, "--output=%s/slurm/%%A_%%a.out", run->folder);
    snprintf(name, sizeof name, "--job-name=%s", run->name);
    snprintf(elements, sizeof elements, "--array=0-%d", array->count - 1);
    if (jobs > 0) snprintf(elements, sizeof elements, "--array=0-%d%%%d", array->count - 1, jobs);
    words[used++] = output;
    for (size_t k = 0; k < given.we_wordc; k++) words[used++] = given.we_wordv[k];
    words[used++] = elements;
    words[used++] = name;
    words[used++] = script;
    TRY(ask(run, words, &status, err));
    if (status != 0)
        FAIL(err, ERROR_LIBRARY, "sbatch does not take the array: %.1500s", run->answer);
    // "123" or "123;cluster", perhaps below a site's own words.
    const char *line = strrchr(run->answer, '\n');
    line = line ? line + 1 : run->answer;
    snprintf(array->id, sizeof array->id, "%.*s", (int)strcspn(line, "; "), line);
cleanup:
    wordfree(&given);
    return error_is_clean(err);
}

// As many arrays as MaxArraySize asks for; array k's elements are `count` from `first` on.
static bool submit_all(SlurmRun *run, Error *err)
{
    int32_t limit = array_limit(run), *points = NULL;
    char script[POINT_PATH_SIZE], list[POINT_PATH_SIZE], name[40];
    run->array_count = (run->count + limit - 1) / limit;
    TRY((run->arrays = NEW_ARRAY(SlurmArray, run->array_count, err)));
    TRY((points = NEW_ARRAY(int32_t, run->count, err)));
    for (int32_t k = 0; k < run->count; k++) points[k] = run->elements[k].point;
    for (int32_t k = 0; k < run->array_count; k++) {
        SlurmArray *array = &run->arrays[k];
        array->first = k * limit;
        array->count = run->count - array->first < limit ? run->count - array->first : limit;
        snprintf(name, sizeof name, "array-%d.json", k);
        make_path(run, list, name);
        snprintf(name, sizeof name, "array-%d.sh", k);
        make_path(run, script, name);
        TRY(elements_write(run->sweep, list, &points[array->first], array->count, err));
        TRY(write_script(script, list, err));
        TRY(submit(run, array, script, err));
    }
cleanup:
    memory_free(points);
    return error_is_clean(err);
}

// --- waiting ------------------------------------------------------------------------------------

// All others are waiting or at work, also those this list does not know.
static bool is_ended(const char *state)
{
    static const char *const ended[] = {"BOOT_FAIL", "CANCELLED", "COMPLETED",     "DEADLINE",
                                        "FAILED",    "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED",
                                        "REVOKED",   "TIMEOUT"};
    for (size_t k = 0; k < sizeof ended / sizeof ended[0]; k++)
        if (strcmp(state, ended[k]) == 0) return true;
    return false;
}

// A line of squeue: job of the array, index, state, reason.
static void note_line(SlurmRun *run, const char *line)
{
    char id[STATE_SIZE], state[STATE_SIZE], reason[REASON_SIZE] = "";
    int index = 0;
    if (sscanf(line, "%31s %d %31s %63s", id, &index, state, reason) < 3) return;
    for (int32_t k = 0; k < run->array_count; k++) {
        const SlurmArray *array = &run->arrays[k];
        if (strcmp(array->id, id) != 0 || index < 0 || index >= array->count) continue;
        Element *element = &run->elements[array->first + index];
        element->listed = true;
        element->ended = is_ended(state);
        memcpy(element->state, state, sizeof state);
        memcpy(element->reason, reason, sizeof reason);
    }
}

// Elements that ended minutes ago are no longer listed; nor is anything when Slurm does not answer,
// which is why a failing squeue says nothing about them. *answered: it spoke.
static bool look_at_queue(SlurmRun *run, bool *answered, Error *err)
{
    char name[sizeof run->name + 10];
    int status = 0;
    snprintf(name, sizeof name, "--name=%s", run->name);
    const char *const words[] = {"squeue", "-h", "-r",          "-t", "all",
                                 name,     "-o", "%F %K %T %r", NULL};
    TRY(ask(run, words, &status, err));
    *answered = status == 0;
    run->silence = *answered ? 0 : run->silence + 1;
    if (run->silence > SILENCE_MAX)
        FAIL(err, ERROR_LIBRARY, "squeue does not answer: %.1500s", run->answer);
    if (!*answered) return true;
    for (int32_t k = 0; k < run->count; k++)
        run->elements[k].listed = run->elements[k].ended = false;
    char *rest = NULL;
    for (char *line = strtok_r(run->answer, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        note_line(run, line);
cleanup:
    return error_is_clean(err);
}

// "123_4", what Slurm calls element `k`.
static void job_name(const SlurmRun *run, int32_t k, char name[STATE_SIZE + 16])
{
    for (int32_t a = 0; a < run->array_count; a++) {
        const SlurmArray *array = &run->arrays[a];
        if (k < array->first || k >= array->first + array->count) continue;
        snprintf(name, STATE_SIZE + 16, "%s_%d", array->id, k - array->first);
    }
}

// The last line of what element `k` printed; "" where there is none.
static void last_words(const SlurmRun *run, int32_t k, char *words, size_t size)
{
    Error ignored = {0};
    char path[POINT_PATH_SIZE], name[STATE_SIZE + 16], file[STATE_SIZE + 24], *text = NULL;
    int32_t length = 0;
    *words = 0;
    job_name(run, k, name);
    snprintf(file, sizeof file, "%s.out", name);
    make_path(run, path, file);
    if (access(path, R_OK) != 0 || !text_file_read(path, 1 << 20, &text, &length, &ignored)) return;
    while (length && text[length - 1] == '\n') text[--length] = 0;
    const char *line = strrchr(text, '\n');
    if (*text) snprintf(words, size, ": %.1000s", line ? line + 1 : text);
    memory_free(text);
}

// The signal that ended element `k`, from "ExitCode=0:11"; 0: none. squeue does not tell it.
static int last_signal(SlurmRun *run, int32_t k)
{
    char name[STATE_SIZE + 16];
    int status = 0, code = 0, number = 0;
    Error ignored = {0};
    job_name(run, k, name);
    const char *const words[] = {"scontrol", "-o", "show", "job", name, NULL};
    if (!program_run(words, run->answer, run->answer_size, &status, &ignored)) return 0;
    const char *at = strstr(run->answer, "ExitCode=");
    return at && sscanf(at, "ExitCode=%d:%d", &code, &number) == 2 ? number : 0;
}

// Element `k` is gone and left no run.json: its failure is taken. One cancelled before it began is
// no longer listed.
static bool take_lost(SlurmRun *run, int32_t k, Error *err)
{
    const Element *element = &run->elements[k];
    char message[ERROR_MESSAGE_SIZE], state[STATE_SIZE + REASON_SIZE + 40], words[1100];
    bool has_reason = *element->reason && strcmp(element->reason, "None") != 0;
    int number = last_signal(run, k);
    bool waited = strcmp(element->state, "PENDING") == 0;
    bool cancelled = waited || strcmp(element->state, "CANCELLED") == 0;
    if (number > 0)
        snprintf(state, sizeof state, "%s by signal %d (%s)", element->state, number,
                 strsignal(number));
    else if (has_reason)
        snprintf(state, sizeof state, "%s (%s)", element->state, element->reason);
    else
        snprintf(state, sizeof state, "%s", *element->state ? element->state : "unknown");
    last_words(run, k, words, sizeof words);
    if (element->ended)
        snprintf(message, sizeof message, "the Slurm job ended as %s%s", state, words);
    else
        snprintf(message, sizeof message,
                 "the Slurm job left the queue without a result, last seen as %s%s", state,
                 waited ? ": cancelled before it began" : words);
    return sweep_take_lost(run->sweep, element->point, NAN, cancelled ? "cancelled" : "crashed",
                           message, err);
}

// Takes the result of element `k`, which is gone, once its run.json can be seen or need not be
// waited for.
static bool take_element(SlurmRun *run, int32_t k, Error *err)
{
    Element *element = &run->elements[k];
    bool left = false;
    TRY(sweep_take_ended(run->sweep, element->point, NAN, &left, err));
    if (!left) {
        // Unless Slurm ended it, it wrote one.
        bool comes = !element->ended || strcmp(element->state, "COMPLETED") == 0 ||
                     strcmp(element->reason, "NonZeroExitCode") == 0;
        if (element->gone_since == 0) element->gone_since = clock_seconds();
        if (comes && clock_seconds() - element->gone_since < REPORT_PAUSE) goto cleanup;
        TRY(take_lost(run, k, err));
    }
    element->taken = true;
    run->left--;
cleanup:
    return error_is_clean(err);
}

// squeue is asked every LOOK_PAUSE seconds, the stop flag far more often.
static bool wait_for_all(SlurmRun *run, Error *err)
{
    bool answered = false;
    while (run->left > 0) {
        TRY(look_at_queue(run, &answered, err));
        for (int32_t k = 0; answered && k < run->count; k++) {
            const Element *element = &run->elements[k];
            bool gone = !element->listed || element->ended;
            if (!element->taken && gone) TRY(take_element(run, k, err));
        }
        double until = clock_seconds() + LOOK_PAUSE;
        while (run->left > 0 && clock_seconds() < until) {
            TRY(sweep_check_stop(run->sweep, err));
            nap(STOP_PAUSE);
        }
    }
cleanup:
    return error_is_clean(err);
}

// A point that was written before the elements were cancelled is finished like any other.
static void take_finished(SlurmRun *run)
{
    for (int32_t k = 0; k < run->count; k++) {
        Error ignored = {0};   // the caller tells why the sweep ends
        bool left = false;
        if (!run->elements[k].taken)
            sweep_take_ended(run->sweep, run->elements[k].point, NAN, &left, &ignored);
    }
}

// --- the whole ----------------------------------------------------------------------------------

// Where the folder lies, the name of its jobs, room for answers.
static bool begin(SlurmRun *run, Sweep *sweep, Error *err)
{
    char *folder = realpath(sweep->folder, NULL), text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    run->sweep = sweep;
    if (!folder || strlen(folder) + 40 > sizeof run->folder)
        FAIL(err, ERROR_FILE, "cannot tell where %s lies", sweep->folder);
    memcpy(run->folder, folder, strlen(folder) + 1);
    hash_text(&hash, folder);
    hash_write(&hash, text);
    snprintf(run->name, sizeof run->name, "amontons-%.12s", text);
    run->answer_size = ANSWER_SIZE + (size_t)sweep->study.point_count * LINE_SIZE;
    TRY((run->answer = NEW_ARRAY(char, (int64_t)run->answer_size, err)));
cleanup:
    free(folder);
    return error_is_clean(err);
}

static void end(SlurmRun *run)
{
    memory_free(run->elements);
    memory_free(run->arrays);
    memory_free(run->answer);
}

// The file `running` stands as long as jobs may be out.
static bool mark_running(const SlurmRun *run, Error *err)
{
    char path[POINT_PATH_SIZE];
    make_path(run, path, "");
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        FAIL(err, ERROR_FILE, "cannot make the folder %s: %s", path, strerror(errno));
    make_path(run, path, "running");
    int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) FAIL(err, ERROR_FILE, "cannot write %s: %s", path, strerror(errno));
    close(file);
cleanup:
    return error_is_clean(err);
}

bool slurm_end_leftovers(Sweep *sweep, Error *err)
{
    SlurmRun run = {0};
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/slurm/running", sweep->folder);
    if (access(path, F_OK) != 0) return true;
    TRY(begin(&run, sweep, err));
    TRY(cancel(&run, err));
    unlink(path);
cleanup:
    end(&run);
    return error_is_clean(err);
}

// Room for all points: how many are pending is known only afterwards.
static bool list_elements(SlurmRun *run, Error *err)
{
    const Sweep *sweep = run->sweep;
    TRY((run->elements = NEW_ARRAY(Element, sweep->study.point_count, err)));
    for (int32_t k = 0; k < sweep->study.point_count; k++)
        if (sweep_is_waiting(sweep, k)) run->elements[run->count++].point = k;
    run->left = run->count;
cleanup:
    return error_is_clean(err);
}

// Whatever goes wrong, nothing of ours stays in the queue: the file `running` is removed only when
// that is known, and otherwise tells the next sweep to look.
bool slurm_run(Sweep *sweep, Error *err)
{
    static const char *const version[] = {"sbatch", "--version", NULL};
    SlurmRun run = {0};
    Error ignored = {0};
    char path[POINT_PATH_SIZE];
    bool out = false;   // jobs may be
    int status = 0;
    TRY(begin(&run, sweep, err));
    TRY(list_elements(&run, err));
    if (run.count == 0) goto cleanup;
    TRY(ask(&run, version, &status, err));   // is there a Slurm at all?
    TRY(mark_running(&run, err));
    out = true;
    TRY(submit_all(&run, err));
    TRY(wait_for_all(&run, err));
cleanup:
    if (!error_is_clean(err) && out) {
        out = !cancel(&run, &ignored);
        take_finished(&run);
    } else {
        out = false;
    }
    make_path(&run, path, "running");
    if (run.folder[0] && !out) unlink(path);
    end(&run);
    return error_is_clean(err);
}
