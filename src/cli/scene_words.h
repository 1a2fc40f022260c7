// SPDX-License-Identifier: GPL-2.0-or-later
// The words that every command on a scene takes: SCENE, -o, --set, --overwrite, --quiet,
// --trust.
#ifndef AMONTONS_CLI_SCENE_WORDS_H
#define AMONTONS_CLI_SCENE_WORDS_H

#include "cli/options.h"

typedef struct SceneWords {
    const char *scene;
    const char *folder;   // of -o; NULL: not given
    OptionWords settings;   // "load.pressure=0.006"
    bool overwrite, quiet, trust;
} SceneWords;

// Reads them, and the command's own options (a table that ends with {0}). The exit status, 0 or 2.
int scene_words_read(const Command *command, const Option *own, int argc, char **argv,
                     SceneWords *words);

// Reads the scene with its settings; on failure it says why, and *scene is NULL. The exit status.
int scene_words_open(const SceneWords *words, Scene **scene);

#endif
