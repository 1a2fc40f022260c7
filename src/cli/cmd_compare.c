// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons compare`: measurements beside a stored result, each figure that shows what was
// measured, and the misfit. Drawn by what `amontons render --compare` draws with.
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/say.h"

enum { WORDS_SIZE = 2000 };

int command_compare(const Command *command, int argc, char **argv)
{
    const char *first = NULL, *style_name = NULL;
    char words[WORDS_SIZE];
    OptionWords given = {0};
    Command taken = *command;
    PictureStyle style = {.format = "png"};
    Error err = {0};
    const Option options[] = {
        {"format", 0, "png|pdf|svg", "Of the files; png by default", .word = &style.format},
        {"style", 0, "NAME", "What they are for: column (default), columns, slide or poster",
         .word = &style_name},
        {"dark", 0, NULL, "Light lines on dark paper", .flag = &style.dark},
        option_overwrite(&style.overwrite),
        {0}};
    taken.all = &given;
    int status = options_read(&taken, options, argc, argv, &first);
    if (status != 0) return status;
    if (given.count != 2)
        return report_misuse("compare takes a result folder and a table: amontons compare RESULT "
                             "FILE.csv");
    if (style_name && !amontons_picture_option(&style, "style", style_name, &err))
        return report_misuse("--%s", err.message);
    if (!amontons_compare(given.list[0], given.list[1], &style, words, sizeof words, &err))
        return report_error(&err);
    say("%s beside %s:\n%s", given.list[1], given.list[0], words);
    say("pictures drawn: %s/figures\n", given.list[0]);
    return 0;
}
