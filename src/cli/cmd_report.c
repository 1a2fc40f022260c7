// SPDX-License-Identifier: GPL-2.0-or-later
// `amontons report`: one page about results, to be opened in a browser or sent to somebody.
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/say.h"

#include <stdio.h>
#include <string.h>

int command_report(const Command *command, int argc, char **argv)
{
    const char *first = NULL, *file = NULL;
    char path[AMONTONS_PATH_SIZE];
    OptionWords results = {0};
    Command taken = *command;
    PictureStyle style = {0};
    Error err = {0};
    const Option options[] = {
        {"output", 'o', "FILE.html",
         "The page (default: RESULT/report.html; of several runs comparison.html, in the current "
         "folder)",
         .word = &file},
        option_pictures(&style, TAKEN_BY_PAGES),
        option_overwrite(&style.overwrite),
        {0}};
    taken.all = &results;
    int status = options_read(&taken, options, argc, argv, &first);
    if (status != 0) return status;
    if (file && !*file) return report_misuse("-o: the file has no name");
    if ((status = option_may_write(file, style.overwrite)) != 0) return status;

    if (!file) {
        // The page lies in the result's folder, whose path may end with slashes and has an
        // argument's length.
        const char *folder = results.list[0];
        size_t length = strlen(folder);
        while (length > 1 && folder[length - 1] == '/') length--;
        if (results.count > 1)
            snprintf(path, sizeof path, "comparison.html");
        else
            snprintf(path, sizeof path, "%.*s/report.html", (int)length, folder);
    }

    if (!file) file = path;
    if (!amontons_report(results.list, results.count, file, &style, &err))
        return report_error(&err);
    say("report written: %s\n", file);
    return 0;
}
