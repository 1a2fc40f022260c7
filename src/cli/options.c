// SPDX-License-Identifier: GPL-2.0-or-later
// Words are only gathered while argp reads them, and judged afterwards.
#include "cli/options.h"

#include "cli/say.h"

#include <argp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Keys of argp without a letter: from KEY_FIRST on; those of pictures from KEY_PICTURES on.
enum { KEY_FIRST = 1000, KEY_PICTURES = 2000, OPTIONS_MAX = 40 };

static const struct {
    const char *name, *argument, *meaning;
    int32_t taker;
} PICTURES[] = {
#define X(name, kind, low, high, figures, taker, allowed, argument, meaning)                       \
    {#name, argument, meaning, taker},
    PICTURE_OPTIONS(X)
#undef X
};
enum { PICTURES_COUNT = sizeof PICTURES / sizeof *PICTURES };

typedef struct Reading {
    const Option *options;
    const char *argument;
    OptionWords *all;   // arguments; NULL: one is taken
    bool too_many;   // of them
    Error wrong;   // the first option of a picture that is
} Reading;

static int option_key(const Option *options, int32_t k)
{
    return options[k].letter ? options[k].letter : KEY_FIRST + k;
}

// The word is not copied: argv outlives everything.
static void add_word(OptionWords *words, const char *word)
{
    if (words->count == OPTION_WORDS_MAX)
        words->too_many = true;
    else
        words->list[words->count++] = word;
}

static error_t take_word(int key, char *word, struct argp_state *state)
{
    Reading *reading = state->input;
    if (key == ARGP_KEY_ARG) {
        // `--set a=1 b=2`: further words that have a `=` and are no file; `RESULT --figure a b`:
        // any.
        for (const Option *option = reading->options; option->name; option++) {
            if (!option->words || option->words->count == 0) continue;
            bool goes_on = strchr(option->argument, '=')
                               ? strchr(word, '=') && access(word, F_OK) != 0
                               : reading->argument != NULL;
            if (!goes_on) continue;
            add_word(option->words, word);
            return 0;
        }
        if (reading->all)
            add_word(reading->all, word);
        else if (reading->argument)
            reading->too_many = true;
        if (!reading->all || !reading->argument) reading->argument = word;
        return 0;
    }
    for (int32_t k = 0; reading->options[k].name; k++) {
        const Option *option = &reading->options[k];
        int32_t p = key - KEY_PICTURES;   // argp's own keys lie beyond them
        if (option->style && p >= 0 && p < PICTURES_COUNT) {
            if (!reading->wrong.code)
                amontons_picture_option(option->style, PICTURES[p].name, word, &reading->wrong);
            return 0;
        }
        if (option_key(reading->options, k) != key) continue;
        if (option->flag) *option->flag = true;
        if (option->word) *option->word = word ? word : "";
        if (option->words) add_word(option->words, word);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static pid_t guarded_process;   // 0: the program may end

// Nothing of ours calls exit: a plug-in or a library does, and its status would be taken for ours.
static void meet_strange_end(void)
{
    if (!guarded_process) return;
    if (getpid() == guarded_process) {   // else the process that waits for this one says so
        tell("amontons: error: a plug-in or library ended the program in the middle of its work "
             "(it called exit)\n");
    }
    _exit(1);
}

void guard_end(bool guarded)
{
    if (guarded && !guarded_process) atexit(meet_strange_end);
    guarded_process = guarded ? getpid() : 0;
}

// argp leaves the program by itself where an option is unknown, with the status set here.
int options_read(const Command *command, const Option *options, int argc, char **argv,
                 const char **argument)
{
    struct argp_option known[OPTIONS_MAX + PICTURES_COUNT + 1] = {0};
    char name[40];   // what usage lines begin with
    Reading reading = {.options = options, .all = command->all};
    struct argp argp = {
        .options = known, .parser = take_word, .args_doc = command->argument, .doc = command->help};
    for (int32_t k = 0, count = 0; options[k].name && k < OPTIONS_MAX; k++) {
        for (int32_t p = 0; options[k].style && p < PICTURES_COUNT; p++)
            if (PICTURES[p].taker >= options[k].taker)
                known[count++] = (struct argp_option){.name = PICTURES[p].name,
                                                      .key = KEY_PICTURES + p,
                                                      .arg = PICTURES[p].argument,
                                                      .doc = PICTURES[p].meaning};
        if (options[k].style) continue;
        known[count++] = (struct argp_option){
            .name = options[k].name,
            .key = option_key(options, k),
            .arg = options[k].argument,
            .flags = (options[k].flag && options[k].word ? OPTION_ARG_OPTIONAL : 0) |
                     (options[k].meaning ? 0 : OPTION_HIDDEN),
            .doc = options[k].meaning};
    }
    argp_err_exit_status = amontons_error_exit_status(ERROR_INPUT);
    snprintf(name, sizeof name, "amontons %s", command->name);
    argv[0] = name;
    argp_parse(&argp, argc, argv, 0, NULL, &reading);
    *argument = reading.argument;
    guard_end(true);   // argp itself may end the program until here
    if (reading.wrong.code) return report_misuse("--%s", reading.wrong.message);
    if (!command->argument && reading.argument)
        return report_misuse("%s takes no argument, `%s` is one", command->name, reading.argument);
    if (!command->argument) return 0;
    if (!reading.argument)
        return report_misuse("%s needs a %s, as in `%s`", command->name, command->what,
                             command->example);
    if (reading.all && reading.all->too_many)
        return report_misuse("%s takes %d arguments at most", command->name, OPTION_WORDS_MAX);
    if (reading.too_many) return report_misuse("%s takes one %s", command->name, command->what);
    for (const Option *option = options; option->name; option++)
        if (option->words && option->words->too_many)
            return report_misuse("--%s is given more than %d times", option->name,
                                 OPTION_WORDS_MAX);
    return 0;
}

void default_folder(const char *file, const char *ending, char *folder, size_t size)
{
    const char *slash = strrchr(file, '/'), *name = slash ? slash + 1 : file;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    snprintf(folder, size, "%.*s%s", (int)(length < 200 ? length : 200), name, ending);
}

// Digits and nothing else: "3.5", "3x" and "" are misuse. *count is set on success only.
int option_count(const char *name, const char *word, int32_t low, int32_t high, int32_t *count)
{
    char *end = NULL;
    long value = strtol(word, &end, 10);
    if (!*word || *end || value < low || value > high)
        return report_misuse("%s %s: a whole number from %d to %d is allowed", name, word, low,
                             high);
    *count = (int32_t)value;
    return 0;
}

// --- reports ------------------------------------------------------------------------------------

Option option_overwrite(bool *overwrite)
{
    return (Option){"overwrite", 0, NULL, "Replace what lies there, whoever wrote it",
                    .flag = overwrite};
}

// A folder takes files; whether these may be written is asked of each.
int option_may_write(const char *named, bool overwrite)
{
    struct stat status;
    if (!named || overwrite || lstat(named, &status) != 0 || S_ISDIR(status.st_mode)) return 0;
    return report_misuse("%s is there already: name another file, or say --overwrite", named);
}

Option option_pictures(PictureStyle *style, int32_t taker)
{
    return (Option){.name = "", .style = style, .taker = taker};
}

Option option_trust(bool *trust)
{
    return (Option){
        "trust", 0, NULL,
        "Also use a .geo that runs commands or writes files, and a friction law that is a plug-in",
        .flag = trust};
}

// Standard output is flushed first, here and below: in a file that takes both, lines stand in the
// order in which they were printed.
int report_error(const Error *err)
{
    fflush(stdout);
    tell("amontons: error: %s\n", err->message);
    return amontons_error_exit_status(err->code);
}

void report_warnings(const RunWarnings *warnings)
{
    fflush(stdout);
    for (int32_t k = 0; k < warnings->count; k++)
        tell("amontons: warning: %s\n", warnings->text[k]);
}

// Reports a fault of the command line alone; a fault in a file is an Error of the library.
int report_misuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fflush(stdout);
    tell("amontons: error: ");
    tell_list(format, arguments);
    tell("\n");
    va_end(arguments);
    return amontons_error_exit_status(ERROR_INPUT);
}

// --- the words that every command on a scene takes ----------------------------------------------

enum { OWN_MAX = 8, COMMON_COUNT = 5 };

int scene_words_read(const Command *command, const Option *own, int argc, char **argv,
                     SceneWords *words)
{
    Option options[COMMON_COUNT + OWN_MAX + 1] = {
        {"output", 'o', "DIR", "The folder for the results", .word = &words->folder},
        {"set", 0, "KEY=VALUE", "Use this value instead of the scene's; may be given several times",
         .words = &words->settings},
        {"overwrite", 0, NULL, "Replace an earlier result in DIR", .flag = &words->overwrite},
        {"quiet", 'q', NULL, "Print nothing but warnings and errors", .flag = &words->quiet},
        option_trust(&words->trust)};
    for (int32_t k = 0; k < OWN_MAX && own[k].name; k++) options[COMMON_COUNT + k] = own[k];
    int status = options_read(command, options, argc, argv, &words->scene);
    if (status == 0 && words->folder && !*words->folder)
        return report_misuse("-o: the folder has no name");
    return status;
}

// *scene is the caller's to destroy.
int scene_words_open(const SceneWords *words, Scene **scene)
{
    Error err = {0};
    *scene = NULL;
    bool (*read)(const char *, const char *const *, int32_t, Scene **, Error *) =
        words->trust ? amontons_scene_read_trusted : amontons_scene_read;
    if (read(words->scene, words->settings.list, words->settings.count, scene, &err)) return 0;
    return report_error(&err);
}

// --- signals ------------------------------------------------------------------------------------

// A signal handler can reach nothing but a variable of the file.
static volatile sig_atomic_t stop_wanted = 0, work_begun = 0;

// All that a signal handler may safely do: the loop of steps looks at the flag. Before it has begun
// nobody looks, a mesh may take minutes, and there is nothing to keep: the signal ends the program.
static void want_stop(int signal_number)
{
    static const char words[] = "amontons: stopped before the first step; nothing was computed\n";
    stop_wanted = 1;
    if (work_begun) return;
    ssize_t written = write(STDERR_FILENO, words, sizeof words - 1);
    (void)written;
    raise(signal_number);   // by its default, once this handler returns
}

void stop_in_order(void)
{
    work_begun = 1;
}

// SA_RESETHAND gives the signal its default back: a second Ctrl-C ends the program at once. Who
// reads our progress may go away (`2>&1 | head -1`): that ends our talking, not the computation.
const volatile sig_atomic_t *stop_on_signals(void)
{
    struct sigaction action = {.sa_handler = want_stop, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    signal(SIGPIPE, SIG_IGN);
    return &stop_wanted;
}
