// SPDX-License-Identifier: GPL-2.0-or-later
// The command line of each command: a table of options, read by argp. An error is one line in our
// own form, and `--help` works whatever else is wrong.
#ifndef AMONTONS_CLI_OPTIONS_H
#define AMONTONS_CLI_OPTIONS_H

#include "amontons.h"

enum { OPTION_WORDS_MAX = 200 };

// The arguments of an option that may be given several times.
typedef struct OptionWords {
    const char *list[OPTION_WORDS_MAX];   // [count] as typed
    int32_t count;
    bool too_many;
} OptionWords;

typedef struct Option {
    const char *name;   // "output": --output; NULL ends a table
    char letter;   // 'o': also -o; 0: none
    const char *argument;   // "DIR"; NULL: it has none
    const char *meaning;   // for --help; NULL: not shown there
    // Place that the option's value goes to. With a flag and a word its argument may be left out.
    bool *flag;
    const char **word;   // the last one given
    OptionWords *words;   // all of them, also `--set a=1 b=2`
    // A row of this kind stands for all of PICTURE_OPTIONS that `taker` takes; its name is "".
    PictureStyle *style;
    int32_t taker;
} Option;

typedef struct Command Command;
struct Command {
    const char *name;   // "run"
    int (*run)(const Command *command, int argc, char **argv);   // the exit status
    const char *argument;   // "SCENE", or several forms, a line each; NULL: none is taken
    const char *sentence;   // in the list of commands
    const char *what;   // "scene", of which one must be given
    const char *example;   // `amontons run validation/paper/fig1.yaml`
    const char *help;   // before the list of options; and behind it, after a \v
    OptionWords *all;   // all arguments, where several are taken; NULL: one is
};

// Puts the options given to where `options` say, and what the command works on into *argument.
// `--help` and unknown options end the program. The exit status, 0 or 2.
int options_read(const Command *command, const Option *options, int argc, char **argv,
                 const char **argument);

// After true, until false, an exit that is not ours ends the program with an error.
void guard_end(bool guarded);

// The folder for results where -o gives none, here: "validation/paper/fig1.yaml" and "-result" give
// "fig1-result".
void default_folder(const char *file, const char *ending, char *folder, size_t size);

// The value `word` of an option called `name`, a whole number from low to high. Status 0 or 2.
int option_count(const char *name, const char *word, int32_t low, int32_t high, int32_t *count);

// --- the words of every command on a scene: SCENE, -o, --set, --overwrite, --quiet, --trust ------

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

// --- single options -----------------------------------------------------------------------------

// `--overwrite`, of every command that writes one file; and the refusal of a file that is there and
// was named by -o, as `named`: it may be anybody's. Status 0 or 2.
Option option_overwrite(bool *overwrite);
int option_may_write(const char *named, bool overwrite);

// `--trust`, of every command that reads meshes: a .geo may run commands.
Option option_trust(bool *trust);

// The options of a picture, film or page, which go into `style`.
Option option_pictures(PictureStyle *style, int32_t taker);

// Prints "amontons: error: ..." and gives the exit status that belongs to it.
int report_error(const Error *err);
int report_misuse(const char *format, ...) __attribute__((format(printf, 1, 2)));   // status 2
void report_warnings(const RunWarnings *warnings);   // "amontons: warning: ...", a line each

// Set by the first Ctrl-C or SIGTERM, which ends the work in order once it has begun (at the first
// step, or where stop_in_order says so). Before that, and when it is the second, a signal ends the
// program. Called once.
const volatile sig_atomic_t *stop_on_signals(void);
void stop_in_order(void);

#endif
