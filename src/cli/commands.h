// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of the program; main.c calls the one that is given. Each takes the words from
// its own name on and returns the program's exit status: 0 done, 1 failed, 2 wrong input.
#ifndef AMONTONS_CLI_COMMANDS_H
#define AMONTONS_CLI_COMMANDS_H

int command_run(int argc, char **argv);
int command_static(int argc, char **argv);
int command_stability(int argc, char **argv);
int command_model1d(int argc, char **argv);
int command_sweep(int argc, char **argv);
int command_optimise(int argc, char **argv);
int command_fit(int argc, char **argv);
int command_render(int argc, char **argv);
int command_report(int argc, char **argv);
int command_film(int argc, char **argv);
int command_info(int argc, char **argv);
int command_cache(int argc, char **argv);

// Called by libraries (main.c): by OpenBLAS when it is loaded, by those with OpenMP in them.
int openblas_num_threads_env(void);
typedef void OpenRegion(void *data);
void GOMP_parallel(OpenRegion *region, void *data, unsigned threads, unsigned flags);

#endif
