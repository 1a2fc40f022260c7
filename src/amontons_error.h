// SPDX-License-Identifier: GPL-2.0-or-later
// Error of a failed call of the library. Part of amontons.h; base/error.h says how the library
// itself handles errors.
#ifndef AMONTONS_ERROR_H
#define AMONTONS_ERROR_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// code, exit status of the program, short name
#define ERROR_CODES(X)                                                                             \
    X(ERROR_NONE, 0, "none")                                                                       \
    X(ERROR_INPUT, 2, "wrong input")                                                               \
    X(ERROR_FILE, 1, "file")                                                                       \
    X(ERROR_MEMORY, 1, "out of memory")                                                            \
    X(ERROR_LIBRARY, 1, "library")                                                                 \
    X(ERROR_COMPUTE, 1, "computation failed")                                                      \
    X(ERROR_INTERRUPT, 1, "interrupted")

typedef enum ErrorCode {
#define X(code, status, name) code,
    ERROR_CODES(X)
#undef X
} ErrorCode;

enum { ERROR_MESSAGE_SIZE = 2000 };

// The caller owns it and hands it in zeroed; it must be zeroed again before it is used again.
typedef struct Error {
    ErrorCode code;   // ERROR_NONE: clean
    int32_t line;   // where in the library's source it was found
    const char *file;   // of that source; static storage
    char message[ERROR_MESSAGE_SIZE];   // says what is wrong, where, and how to mend it
} Error;

int amontons_error_exit_status(ErrorCode code);   // 0 done, 1 the computation failed, 2 wrong input
const char *amontons_error_name(ErrorCode code);   // static storage

#ifdef __cplusplus
}
#endif

#endif
