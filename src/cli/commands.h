// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of the program; commands.c calls the one that is given. Each takes the words from
// its own name on and returns the program's exit status: 0 done, 1 failed, 2 wrong input.
#ifndef AMONTONS_CLI_COMMANDS_H
#define AMONTONS_CLI_COMMANDS_H

#include "cli/options.h"

int command_run(const Command *command, int argc, char **argv);
int command_static(const Command *command, int argc, char **argv);
int command_stability(const Command *command, int argc, char **argv);
int command_model1d(const Command *command, int argc, char **argv);
int command_sweep(const Command *command, int argc, char **argv);
int command_search(const Command *command, int argc, char **argv);   // optimise, fit
int command_render(const Command *command, int argc, char **argv);
int command_compare(const Command *command, int argc, char **argv);
int command_report(const Command *command, int argc, char **argv);
int command_film(const Command *command, int argc, char **argv);
int command_info(const Command *command, int argc, char **argv);
int command_cache(const Command *command, int argc, char **argv);

// main.c looks up this function in the module. Returns the exit status.
int amontons_command(int argc, char **argv);
// The kernels of OpenBLAS that the processor could run, where those in use are less; else NULL.
const char *amontons_better_kernels(void);

#endif
