// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/computing/slurm_jobs.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/process.h"
#include "base/system.h"
#include "io/text/text_writer.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <wordexp.h>

enum {
    LINE_SIZE = 160,   // of squeue for an element
    ANSWER_SIZE = 65536,   // of the other commands; `scontrol show config` prints some 12 kB
    ARRAY_STANDARD = 1000,   // elements of an array where Slurm gives no limit
    SILENCE_MAX = 60,   // a controller restarts
    ARGUMENTS_MAX = 100,
};

static const double CANCEL_LIMIT = 60;   // s that cancelled elements may take to leave the queue
static const double CANCEL_PAUSE = 0.1;   // s between two looks whether they are

bool slurm_jobs_open(const char *folder, int32_t count, SlurmJobs *jobs, Error *err)
{
    char *place = realpath(folder, NULL), text[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    *jobs = (SlurmJobs){.answer_size = ANSWER_SIZE + (size_t)count * LINE_SIZE};
    if (!place || strlen(place) + 40 > sizeof jobs->folder)
        FAIL(err, ERROR_FILE, "cannot find the path of %s", folder);
    memcpy(jobs->folder, place, strlen(place) + 1);
    hash_text(&hash, place);
    hash_write(&hash, text);
    snprintf(jobs->name, sizeof jobs->name, "amontons-%.12s", text);
    TRY((jobs->answer = NEW_ARRAY(char, (int64_t)jobs->answer_size, err)));
cleanup:
    free(place);
    return error_is_clean(err);
}

void slurm_jobs_close(SlurmJobs *jobs)
{
    memory_free(jobs->answer);
    *jobs = (SlurmJobs){0};
}

void slurm_path(const SlurmJobs *jobs, const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/slurm/%.40s", jobs->folder, name);
}

// Runs one of Slurm's commands; its output, without the last line end, in jobs->answer.
static bool ask(SlurmJobs *jobs, const char *const *words, int *status, Error *err)
{
    if (!process_run(words, jobs->answer, jobs->answer_size, status, err))
        error_context(err,
                      "--slurm needs Slurm's commands (sbatch, squeue, scancel, scontrol) in PATH");
    for (size_t used = strlen(jobs->answer); used && jobs->answer[used - 1] == '\n';)
        jobs->answer[--used] = 0;
    return error_is_clean(err);
}

// Returns the text behind `label` in scontrol's answer; NULL: there is none.
static const char *find_answer(SlurmJobs *jobs, const char *const *words, const char *label,
                               Error *err)
{
    int status = 0;
    const char *at = ask(jobs, words, &status, err) ? strstr(jobs->answer, label) : NULL;
    return at ? at + strlen(label) : NULL;
}

// MaxArraySize of this Slurm: the largest index is one below, and ours begin at 0.
bool slurm_array_limit(SlurmJobs *jobs, int32_t *limit, Error *err)
{
    static const char *const words[] = {"scontrol", "show", "config", NULL};
    const char *at = find_answer(jobs, words, "MaxArraySize", err);
    bool said = at && sscanf(at, " = %d", limit) == 1 && *limit >= 2;
    *limit = said ? *limit - 1 : ARRAY_STANDARD;
    return error_is_clean(err);
}

// "ExitCode=0:11": the second number.
int slurm_signal(SlurmJobs *jobs, const char *job)
{
    const char *const words[] = {"scontrol", "-o", "show", "job", job, NULL};
    Error ignored = {0};
    const char *at = find_answer(jobs, words, "ExitCode=", &ignored);
    int code = 0, number = 0;
    return at && sscanf(at, "%d:%d", &code, &number) == 2 ? number : 0;
}

// --- submitting ---------------------------------------------------------------------------------

// `'` inside quotes of a shell is '\''.
static void print_quoted(FILE *file, const char *before, const char *text)
{
    fprintf(file, "%s'", before);
    for (; *text; text++) {
        if (*text == '\'') fputs("'\\'", file);
        fputc(*text, file);
    }
    fputc('\'', file);
}

bool slurm_write_script(const SlurmJobs *jobs, const char *path, const char *study,
                        const SweepOptions *options, Error *err)
{
    static const char *const places[] = {AMONTONS_PROGRAM_FROM_LIBRARY, "amontons"};
    char program[PATH_MAX] = "", found[PATH_MAX], *here = getcwd(NULL, 0);
    TextWriter *script = NULL;

    // The program: this one, or where another (Python) calls the library, the one beside it.
    system_program_path(program, PATH_MAX);
    const char *name = strrchr(program, '/');
    bool is_ours = name && strncmp(name + 1, "amontons", 8) == 0;
    if (!is_ours && !(system_find(places, 2, found, sizeof found) && realpath(found, program)))
        FAIL(err, ERROR_FILE,
             "cannot find the program `amontons`, which Slurm is to run: it is neither beside the "
             "library nor in %s of its folder",
             AMONTONS_PROGRAM_FROM_LIBRARY);
    if (!here) FAIL(err, ERROR_FILE, "cannot find the path of this folder: %s", strerror(errno));
    TRY(script = text_writer_create(path, false, err));
    FILE *out = script->out;
    print_quoted(out, "#!/bin/sh\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\ncd ", here);
    print_quoted(out, " && exec ", program);
    print_quoted(out, " sweep --element -o ", jobs->folder);
    for (int32_t k = 0; k < options->override_count; k++)
        print_quoted(out, " --set ", options->overrides[k]);
    if (options->trust) fprintf(out, " --trust");
    print_quoted(out, " -- ", study);
    fprintf(out, "\n");
cleanup:
    free(here);
    return text_writer_finish(script, err);
}

// The user's words may set anything but the array and its name, which follow them.
bool slurm_submit(SlurmJobs *jobs, const char *script, int32_t count, const SweepOptions *options,
                  char id[SLURM_WORD_SIZE], Error *err)
{
    const char *words[ARGUMENTS_MAX] = {"sbatch", "--parsable"};
    char output[sizeof jobs->folder + 40], elements[60], name[sizeof jobs->name + 12];
    int32_t used = 2;
    int status = 0;
    wordexp_t given = {0};
    if (wordexp(options->slurm, &given, WRDE_NOCMD) != 0 || given.we_wordc + 10 > ARGUMENTS_MAX)
        FAIL(err, ERROR_INPUT,
             "--slurm=%s: expected options of sbatch, as in "
             "--slurm=\"--partition=short --time=10\"",
             options->slurm);
    snprintf(output, sizeof output, "--output=%s/slurm/%%A_%%a.out", jobs->folder);
    snprintf(name, sizeof name, "--job-name=%s", jobs->name);
    int length = snprintf(elements, sizeof elements, "--array=0-%d", count - 1);
    if (options->jobs > 0)
        snprintf(elements + length, sizeof elements - (size_t)length, "%%%d", options->jobs);
    words[used++] = output;
    for (size_t k = 0; k < given.we_wordc; k++) words[used++] = given.we_wordv[k];
    words[used++] = elements;
    words[used++] = name;
    words[used++] = script;
    TRY(ask(jobs, words, &status, err));
    if (status != 0) FAIL(err, ERROR_LIBRARY, "sbatch refuses the array: %.1500s", jobs->answer);
    // "123" or "123;cluster", perhaps below lines that a site adds.
    const char *line = strrchr(jobs->answer, '\n');
    line = line ? line + 1 : jobs->answer;
    snprintf(id, SLURM_WORD_SIZE, "%.*s", (int)strcspn(line, "; "), line);
cleanup:
    wordfree(&given);
    return error_is_clean(err);
}

// --- the queue ----------------------------------------------------------------------------------

// Elements that ended minutes ago are no longer listed; nor is anything when Slurm does not answer,
// which is why nothing is concluded from a squeue that fails.
bool slurm_list(SlurmJobs *jobs, bool *answered, Error *err)
{
    char name[sizeof jobs->name + 10];
    int status = 0;
    snprintf(name, sizeof name, "--name=%s", jobs->name);
    const char *const words[] = {"squeue", "-h", "-r",          "-t", "all",
                                 name,     "-o", "%F %K %T %r", NULL};
    if (!ask(jobs, words, &status, err)) return false;
    *answered = status == 0;
    jobs->silence = *answered ? 0 : jobs->silence + 1;
    if (jobs->silence > SILENCE_MAX)
        return FAULT(err, ERROR_LIBRARY, "squeue does not answer: %.1500s", jobs->answer);
    return true;
}

// Job of the array, index, state, reason; other lines are left out.
bool slurm_next_line(SlurmJobs *jobs, char **rest, SlurmLine *line)
{
    char *text = strtok_r(*rest ? NULL : jobs->answer, "\n", rest);
    for (; text; text = strtok_r(NULL, "\n", rest)) {
        *line = (SlurmLine){0};
        if (sscanf(text, "%31s %d %31s %63s", line->id, &line->index, line->state, line->reason) >=
            3)
            return true;
    }
    return false;
}

// All other states are of waiting or running elements, also states that are not in this list.
bool slurm_is_end(const char *state)
{
    static const char *const ends[] = {"BOOT_FAIL", "CANCELLED", "COMPLETED",     "DEADLINE",
                                       "FAILED",    "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED",
                                       "REVOKED",   "TIMEOUT"};
    for (size_t k = 0; k < sizeof ends / sizeof ends[0]; k++)
        if (strcmp(state, ends[k]) == 0) return true;
    return false;
}

// *none: no job of the folder is waiting or running. *status: of squeue, which may fail.
static bool find_none_alive(SlurmJobs *jobs, const char *name, bool *none, int *status, Error *err)
{
    const char *const words[] = {"squeue", "-h", name, "-o", "%F", NULL};
    if (!ask(jobs, words, status, err)) return false;
    *none = *status == 0 && !jobs->answer[0];
    return true;
}

void slurm_pause(double seconds)
{
    struct timespec time = {.tv_sec = (time_t)seconds,
                            .tv_nsec = (long)((seconds - floor(seconds)) * 1e9)};
    nanosleep(&time, NULL);
}

bool slurm_cancel(SlurmJobs *jobs, Error *err)
{
    char name[sizeof jobs->name + 10];
    int status = 0;
    bool none = false;
    double until = clock_seconds() + CANCEL_LIMIT;
    snprintf(name, sizeof name, "--name=%s", jobs->name);
    const char *const words[] = {"scancel", name, NULL};
    if (!ask(jobs, words, &status, err)) return false;
    if (status != 0) return FAULT(err, ERROR_LIBRARY, "scancel fails: %.1500s", jobs->answer);
    if (!find_none_alive(jobs, name, &none, &status, err)) return false;
    while (!none) {
        if (clock_seconds() > until && status != 0)
            return FAULT(
                err, ERROR_LIBRARY,
                "whether jobs called %s have ended is not known: squeue does not answer: %.1500s",
                jobs->name, jobs->answer);
        if (clock_seconds() > until)
            return FAULT(err, ERROR_LIBRARY,
                         "jobs called %s are still there a minute after scancel", jobs->name);
        slurm_pause(CANCEL_PAUSE);
        if (!find_none_alive(jobs, name, &none, &status, err)) return false;
    }
    return true;
}
