// SPDX-License-Identifier: GPL-2.0-or-later
// All that commands print. Titles, names of files and groups, messages are words of others: what a
// terminal would obey in them (ESC, BEL, other control characters but the ends of lines, marks that
// turn the direction of writing) and bytes that are no UTF-8 are shown as \x1b is.
#ifndef AMONTONS_CLI_SAY_H
#define AMONTONS_CLI_SAY_H

#include <stdarg.h>

// Prints to standard output; returns the length of what was formatted.
int say(const char *format, ...) __attribute__((format(printf, 1, 2)));
// Prints to standard error.
void tell(const char *format, ...) __attribute__((format(printf, 1, 2)));
void tell_list(const char *format, va_list arguments);
// Prints on a terminal, in place of the line that stands there; at most `width` bytes of it.
void tell_over(const char *line, int width);

#endif
