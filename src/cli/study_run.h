// SPDX-License-Identifier: GPL-2.0-or-later
// Parts that the commands that compute a study's points share: their options, a line on standard
// error for each point, and an answer that is printed when the last of these lines has gone. Called
// by cmd_sweep and cmd_optimise.
#ifndef AMONTONS_CLI_STUDY_RUN_H
#define AMONTONS_CLI_STUDY_RUN_H

#include "cli/options.h"

enum { FAILURES_SHOWN = 10 };

typedef struct StudyWords {
    const char *study, *folder, *jobs, *slurm;
    OptionWords settings;
    bool has_slurm, is_element, retry, fresh, quiet, trust;
} StudyWords;

typedef struct StudyRun {
    SweepOptions options;   // to be handed to the library
    bool quiet, bar;   // a terminal: the last line is written over
    int32_t failures;
    char failed[FAILURES_SHOWN][500];
    char folder[256];   // where -o gives none
    char *answer;   // what the library wrote to options.out, once the run has ended; owned
    size_t answer_size;
} StudyRun;

// ending: of the folder where -o gives none, "-sweep". has_elements: points may be jobs of a
// cluster that are this command with --element. Status 0 or 2.
int study_words_read(const Command *command, const char *ending, bool has_elements, int argc,
                     char **argv, StudyWords *words);
// Signals are taken from here on. Status 0 or 2.
int study_run_begin(const StudyWords *words, const char *ending, StudyRun *run);
void study_run_end(StudyRun *run);   // the answer is whole, no line stands half written
// The exit status of a search, of which points may have failed; frees the answer.
int study_run_status(StudyRun *run, bool done, const Error *err);

#endif
