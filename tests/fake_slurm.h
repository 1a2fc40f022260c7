// SPDX-License-Identifier: GPL-2.0-or-later
// Slurm's commands as scripts that say what a test tells them to: NAME prints the file NAME.says,
// and ends with the number in NAME.ends. sbatch counts the arrays from 1, prints that number, and
// from then on squeue says what is in the file `queue`, until scancel. (A real Slurm:
// tests/end_to_end/test_slurm.py.)
#ifndef AMONTONS_TESTS_FAKE_SLURM_H
#define AMONTONS_TESTS_FAKE_SLURM_H

#include "result_place.h"

static inline void fake_slurm_says(const char *place, const char *command, const char *says,
                                   const char *ends)
{
    char name[40];
    snprintf(name, sizeof name, "%s.says", command);
    place_write(place, name, says);
    snprintf(name, sizeof name, "%s.ends", command);
    place_write(place, name, ends);
}

// In `place`, which is put before all others in PATH.
static inline void fake_slurm_make(const char *place)
{
    static const char *const commands[] = {"sbatch", "squeue", "scancel", "scontrol"};
    static const char submit[] = "if [ \"$1\" = --parsable ]; then echo . >>arrays\n"
                                 "wc -l <arrays >>sbatch.says; cp queue squeue.says; fi\n";
    char path[4 * PLACE_SIZE], script[4 * PLACE_SIZE];
    for (size_t k = 0; k < sizeof commands / sizeof *commands; k++) {
        const char *first = k == 0 ? submit : k == 2 ? ": >squeue.says\n" : "";
        snprintf(script, sizeof script,
                 "#!/bin/sh\ncd %s\necho \"$@\" >>%s.asked\n%scat %s.says\nexit $(cat %s.ends)\n",
                 place, commands[k], first, commands[k], commands[k]);
        place_write(place, commands[k], script);
        chmod(place_path(place, commands[k]), 0700);
        fake_slurm_says(place, commands[k], "", "0");
    }
    place_write(place, "queue", "");
    snprintf(path, sizeof path, "%s:%s", place, getenv("PATH") ? getenv("PATH") : "");
    setenv("PATH", path, 1);
}

#endif
