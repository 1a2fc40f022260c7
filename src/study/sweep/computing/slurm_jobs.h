// SPDX-License-Identifier: GPL-2.0-or-later
// Slurm's commands, as far as a sweep needs them: sbatch submits arrays of jobs, squeue lists their
// elements, scancel ends them, scontrol tells the rest. All jobs of a sweep's folder have one name,
// made of the folder's place. Called by slurm.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_SLURM_JOBS_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_SLURM_JOBS_H

#include "amontons.h"
#include "base/hash.h"

enum { SLURM_WORD_SIZE = 32, SLURM_REASON_SIZE = 64, SLURM_JOB_SIZE = SLURM_WORD_SIZE + 16 };

typedef struct SlurmJobs {
    char folder[AMONTONS_PATH_SIZE];   // of the sweep, from the root
    char name[20 + HASH_TEXT_SIZE];   // of its jobs
    char *answer;   // [answer_size] of the last command; owned
    size_t answer_size;
    int32_t silence;   // times that squeue failed, one after the other
} SlurmJobs;

// A line of squeue.
typedef struct SlurmLine {
    char id[SLURM_WORD_SIZE];   // of the array
    int32_t index;   // of its element
    char state[SLURM_WORD_SIZE], reason[SLURM_REASON_SIZE];   // "PENDING", "Resources"
} SlurmLine;

// count: elements for which squeue may have a line. Nothing is asked yet.
bool slurm_jobs_open(const char *folder, int32_t count, SlurmJobs *jobs, Error *err);
void slurm_jobs_close(SlurmJobs *jobs);   // zeroed is fine

// A path in the folder's slurm/.
void slurm_path(const SlurmJobs *jobs, const char *name, char *path, size_t size);
// Elements that an array may have. ERROR_LIBRARY: there is no Slurm, here and below.
bool slurm_array_limit(SlurmJobs *jobs, int32_t *limit, Error *err);
// Writes the script that every element of an array runs: this program in this folder, with the same
// study and --set words; `sweep --element` takes its number from Slurm.
bool slurm_write_script(const SlurmJobs *jobs, const char *path, const char *study,
                        const SweepOptions *options, Error *err);
// options->slurm: the user's words for sbatch; options->jobs: elements at a time. id: of the job.
bool slurm_submit(SlurmJobs *jobs, const char *script, int32_t count, const SweepOptions *options,
                  char id[SLURM_WORD_SIZE], Error *err);
// Asks squeue; the lines are then read by slurm_next_line. *answered: it did, with or without
// lines. ERROR_LIBRARY: it has failed for minutes.
bool slurm_list(SlurmJobs *jobs, bool *answered, Error *err);
bool slurm_next_line(SlurmJobs *jobs, char **rest, SlurmLine *line);   // *rest: NULL at first
bool slurm_is_end(const char *state);   // of an element that is neither waiting nor running
// The signal that ended `job` ("123_4"); 0: none, or not known. squeue does not tell it.
int slurm_signal(SlurmJobs *jobs, const char *job);
// Cancels all jobs of the folder and waits until they have ended and write nothing any more.
bool slurm_cancel(SlurmJobs *jobs, Error *err);
void slurm_pause(double seconds);   // a signal ends it early

#endif
