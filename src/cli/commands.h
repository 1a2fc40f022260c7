// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of the program; main.c finds the one that is asked for. Each takes the words from
// its own name on and returns the program's exit status: 0 done, 1 failed, 2 wrong input.
#ifndef AMONTONS_CLI_COMMANDS_H
#define AMONTONS_CLI_COMMANDS_H

#include "amontons.h"

#include <argp.h>

int command_run(int argc, char **argv);
int command_static(int argc, char **argv);
int command_stability(int argc, char **argv);
int command_model1d(int argc, char **argv);
int command_sweep(int argc, char **argv);
int command_render(int argc, char **argv);
int command_info(int argc, char **argv);

// argp_parse with our exit status for wrong options; `--help` ends the program.
void options_parse(const struct argp *argp, int argc, char **argv, const char *name, void *input);

// The folder for results where -o gives none, here: "validation/paper/fig1.yaml" and "-result" give
// "fig1-result".
void default_folder(const char *file, const char *ending, char *folder, size_t size);

// The value `word` of an option called `name`, a whole number from low to high. Status 0 or 2.
int option_count(const char *name, const char *word, int32_t low, int32_t high, int32_t *count);

// Prints "amontons: error: ..." and gives the exit status that belongs to it.
int report_error(const Error *err);
void report_warnings(const RunWarnings *warnings);   // "amontons: warning: ...", a line each
int report_misuse(const char *format, ...) __attribute__((format(printf, 1, 2)));   // status 2

#endif
