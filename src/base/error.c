// SPDX-License-Identifier: GPL-2.0-or-later
// The first cause is kept, also when clean-up after it fails again. Messages live in the Error
// itself: reporting that memory ran out must not need any.
#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Called by FAIL, which adds the place. A message that is too long is cut at its end.
void error_set(Error *err, ErrorCode code, const char *file, int32_t line, const char *format, ...)
{
    if (err->code != ERROR_NONE) return;
    err->code = code;
    err->file = file;
    err->line = line;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(err->message, sizeof err->message, format, arguments);
    va_end(arguments);
}

// Where context and cause do not fit together the end of the cause is cut; a context that would
// leave no room for it is dropped.
void error_context(Error *err, const char *format, ...)
{
    if (err->code == ERROR_NONE) return;
    char cause[ERROR_MESSAGE_SIZE];
    memcpy(cause, err->message, sizeof cause);
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(err->message, sizeof err->message, format, arguments);
    va_end(arguments);
    if (length < 0 || length >= ERROR_MESSAGE_SIZE - 2) length = 0;
    size_t room = sizeof err->message - (size_t)length;
    snprintf(err->message + length, room, ": %.*s", (int)room - 3, cause);
}

void error_clear(Error *err)
{
    *err = (Error){0};
}

// The table of codes in the header has it; a number that is no code gives 1.
int amontons_error_exit_status(ErrorCode code)
{
    switch (code) {
#define X(symbol, status, name)                                                                    \
    case symbol:                                                                                   \
        return status;
        ERROR_CODES(X)
#undef X
    }
    return 1;
}

const char *amontons_error_name(ErrorCode code)
{
    switch (code) {
#define X(symbol, status, name)                                                                    \
    case symbol:                                                                                   \
        return name;
        ERROR_CODES(X)
#undef X
    }
    return "unknown";
}
