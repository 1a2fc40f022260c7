// SPDX-License-Identifier: GPL-2.0-or-later
// A program that calls the library: one scene at three pressures.
//
//     cc pressures.c $(pkg-config --cflags --libs amontons) -o pressures
//     ./pressures SCENE KEY=VALUE ...
#include <amontons/amontons.h>

#include <stdio.h>

enum { SETTINGS_MAX = 20 };

int main(int argc, char **argv)
{
    const char *const pressures[] = {"load.pressure=0.002", "load.pressure=0.003",
                                     "load.pressure=0.006"};
    const char *settings[SETTINGS_MAX] = {NULL};
    int32_t count = 1;   // the first is the pressure
    for (int k = 2; k < argc && count < SETTINGS_MAX; k++) settings[count++] = argv[k];
    for (int k = 0; argc > 1 && k < 3; k++) {
        Error err = {0};
        Scene *scene = NULL;
        RunOptions options = {0};   // no folder: nothing is written
        RunSummary summary = {0};
        settings[0] = pressures[k];
        bool done = amontons_scene_read(argv[1], settings, count, &scene, &err) &&
                    amontons_run(scene, &options, &summary, &err);
        amontons_scene_destroy(scene);
        if (!done) return fprintf(stderr, "%s\n", err.message), amontons_error_exit_status(err.code);
        printf("%s: largest F_T/F_N %.6f, %lld steps\n", pressures[k], summary.mu_max,
               (long long)summary.counters.accepted);
    }
    return 0;
}
