// SPDX-License-Identifier: GPL-2.0-or-later
// The words that every command on a scene takes: SCENE, -o, --set, --overwrite, --quiet. A command
// names scene_words_argp as its argp's first child and hands over its SceneWords at ARGP_KEY_INIT:
//
//     case ARGP_KEY_INIT: state->child_inputs[0] = &options->words; return 0;
#ifndef AMONTONS_CLI_SCENE_WORDS_H
#define AMONTONS_CLI_SCENE_WORDS_H

#include "cli/commands.h"

enum { OVERRIDES_MAX = 200, OPTION_OWN = 2000 };   // a command's own long options: OPTION_OWN + ...

typedef struct SceneWords {
    const char *scene;   // NULL: not given
    const char *folder;   // of -o; NULL: not given
    const char *overrides[OVERRIDES_MAX];   // [override_count] as typed
    int32_t override_count;
    bool overwrite, quiet, too_many_scenes, too_many_overrides;
} SceneWords;

extern const struct argp_child scene_words_child[];   // for .children: one, and the end

// Says what is wrong with the words for `command` ("run"), with an example scene; status 0 or 2.
int scene_words_check(const SceneWords *words, const char *command, const char *example);

// Reads the scene with its overrides; on failure it says why. The exit status.
int scene_words_read(const SceneWords *words, Scene **scene);

// Set by the first Ctrl-C or SIGTERM, which then ends the work in order; a second one ends the
// program. Called once.
const volatile sig_atomic_t *stop_on_signals(void);

#endif
