// SPDX-License-Identifier: GPL-2.0-or-later
// Errors are values. Every function that can fail returns bool (true: done) and takes an Error
// as its last argument. This is the one place that states the convention:
//
//   * The caller owns the Error and hands it in clean (`Error err = {0};`).
//   * The function that finds the fault sets it once, with FAIL; everybody above passes it on
//     with TRY. Both jump to the label `cleanup:` of the enclosing function, which frees what
//     is local and ends with `return error_is_clean(err);`.
//   * On the way up a caller may say what it was doing with error_context().
//   * Constructors start with `*out = (T){0};`; every destroy accepts zeroed and half-built
//     objects, so `cleanup:` may always destroy.
//   * The library never prints, exits or aborts. Only cli/ turns an Error into text and a status.
#ifndef AMONTONS_BASE_ERROR_H
#define AMONTONS_BASE_ERROR_H

#include <stdbool.h>
#include <stdint.h>

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

typedef struct Error {
    ErrorCode code;   // ERROR_NONE: clean
    int32_t line;   // of the FAIL that set it
    const char *file;   // of the FAIL that set it; static storage
    char message[ERROR_MESSAGE_SIZE];   // says what is wrong, where, and how to mend it
} Error;

// Sets a clean error; a set one keeps its first cause. `file`, `line`: the origin.
void error_set(Error *err, ErrorCode code, const char *file, int32_t line, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

// Puts "format: " before the message of a set error; does nothing to a clean one.
void error_context(Error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

void error_clear(Error *err);
bool error_is_clean(const Error *err);
int error_exit_status(ErrorCode code);   // 0 done, 1 the computation failed, 2 wrong input
const char *error_name(ErrorCode code);   // static storage

#define FAIL(err, code, ...)                                                                       \
    do {                                                                                           \
        error_set((err), (code), __FILE__, __LINE__, __VA_ARGS__);                                 \
        goto cleanup;                                                                              \
    } while (0)

#define TRY(call)                                                                                  \
    do {                                                                                           \
        if (!(call)) goto cleanup;                                                                 \
    } while (0)

#endif
