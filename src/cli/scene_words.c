// SPDX-License-Identifier: GPL-2.0-or-later
// Words are only gathered while argp reads them and judged afterwards by scene_words_check, so that
// an error is one line in our own form, and `--help` works whatever else is wrong.
#include "cli/scene_words.h"

#include <string.h>
#include <unistd.h>

enum { OPTION_SET = 1000, OPTION_OVERWRITE };

// The word is not copied: argv outlives everything.
static void add_override(SceneWords *words, const char *word)
{
    if (words->override_count == OVERRIDES_MAX)
        words->too_many_overrides = true;
    else
        words->overrides[words->override_count++] = word;
}

// `--set a=1 b=2`: words behind a --set that have a `=` and are no file are settings too.
static void take_word(SceneWords *words, const char *word)
{
    bool is_setting = words->override_count && strchr(word, '=') && access(word, F_OK) != 0;
    if (is_setting)
        add_override(words, word);
    else if (words->scene)
        words->too_many_scenes = true;
    else
        words->scene = word;
}

static error_t take_option(int key, char *word, struct argp_state *state)
{
    SceneWords *words = state->input;
    switch (key) {
    case 'o':
        words->folder = word;
        return 0;
    case 'q':
        words->quiet = true;
        return 0;
    case OPTION_SET:
        add_override(words, word);
        return 0;
    case OPTION_OVERWRITE:
        words->overwrite = true;
        return 0;
    case ARGP_KEY_ARG:
        take_word(words, word);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option known[] = {
    {"output", 'o', "DIR", 0, "The folder for the results", 0},
    {"set", OPTION_SET, "KEY=VALUE", 0,
     "Use this value in the place of the scene's; may be given several times", 0},
    {"overwrite", OPTION_OVERWRITE, NULL, 0, "Replace an earlier result in DIR", 0},
    {"quiet", 'q', NULL, 0, "Print nothing but warnings and errors", 0},
    {0}};
static const struct argp scene_words_argp = {.options = known, .parser = take_option};
const struct argp_child scene_words_child[] = {{&scene_words_argp, 0, NULL, 0}, {0}};

int scene_words_check(const SceneWords *words, const char *command, const char *example)
{
    if (!words->scene)
        return report_misuse("%s needs a scene, as in `amontons %s %s`", command, command, example);
    if (words->too_many_scenes) return report_misuse("%s takes one scene", command);
    if (words->too_many_overrides)
        return report_misuse("more than %d settings by --set", OVERRIDES_MAX);
    if (words->folder && !*words->folder) return report_misuse("-o: the folder has no name");
    return 0;
}

// *scene is the caller's to destroy; NULL where the status is not 0.
int scene_words_read(const SceneWords *words, Scene **scene)
{
    Error err = {0};
    if (amontons_scene_read(words->scene, words->overrides, words->override_count, scene, &err))
        return 0;
    return report_error(&err);
}

// A signal can reach nothing but a variable of the file.
static volatile sig_atomic_t stop_wanted = 0;

// All that a signal handler may safely do: the loop of steps looks at the flag.
static void want_stop(int signal_number)
{
    (void)signal_number;
    stop_wanted = 1;
}

// SA_RESETHAND gives the signal its default back: a second Ctrl-C ends the program at once.
const volatile sig_atomic_t *stop_on_signals(void)
{
    struct sigaction action = {.sa_handler = want_stop, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    return &stop_wanted;
}
