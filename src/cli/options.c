// SPDX-License-Identifier: GPL-2.0-or-later
// What all commands share in reading options and reporting errors.
#include "cli/commands.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// argp leaves the program by itself where an option is unknown, with the status set here.
// name: what usage lines begin with, as in "amontons run"; argv[0] is the command's own word.
void options_parse(const struct argp *argp, int argc, char **argv, const char *name, void *input)
{
    argp_err_exit_status = error_exit_status(ERROR_INPUT);
    argv[0] = (char *)name;   // argp shows it, and does not write to it
    argp_parse(argp, argc, argv, 0, NULL, input);
}

void default_folder(const char *file, const char *ending, char *folder, size_t size)
{
    const char *slash = strrchr(file, '/'), *name = slash ? slash + 1 : file;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    snprintf(folder, size, "%.*s%s", (int)(length < 200 ? length : 200), name, ending);
}

// Digits and nothing else, from low to high: "3.5", "3x" and "" are misuse. *count is set on
// success only.
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

// Standard output is flushed first, here and below: in a file that takes both, lines stand in the
// order in which they were said.
// One line on standard error, whatever it is: a caller's script can take it as it is.
int report_error(const Error *err)
{
    fflush(stdout);
    fprintf(stderr, "amontons: error: %s\n", err->message);
    return error_exit_status(err->code);
}

void report_warnings(const RunWarnings *warnings)
{
    fflush(stdout);
    for (int32_t k = 0; k < warnings->count; k++)
        fprintf(stderr, "amontons: warning: %s\n", warnings->text[k]);
}

// For words alone; what is wrong in a file is an Error of the library and goes through
// report_error.
int report_misuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fflush(stdout);
    fprintf(stderr, "amontons: error: ");
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\n");
    va_end(arguments);
    return error_exit_status(ERROR_INPUT);
}
