// SPDX-License-Identifier: GPL-2.0-or-later
// Errors are values. Every function that can fail returns bool (true: done) and takes an Error
// as its last argument. This is the one place that states the convention:
//
//   * The caller owns the Error and hands it in clean (`Error err = {0};`).
//   * The function that finds the fault sets it once, everybody above passes it on. Who has nothing
//     to free returns at once: `return REFUSE(err, "...");` for what the user gave, `return
//     FAULT(err, CODE, "...");` for the rest, `if (!call) return false;`, `return a && b;`.
//   * Who has something to free does it with FAIL and TRY: both jump to the label `cleanup:` of the
//     enclosing function, which frees what is local and ends with `return error_is_clean(err);`.
//   * On the way up a caller may say what it was doing with error_context().
//   * Constructors start with `*out = (T){0};`; every destroy accepts zeroed and half-built
//     objects, so `cleanup:` may always destroy.
//   * The library never prints, exits or aborts. Only cli/ turns an Error into text and a status.
#ifndef AMONTONS_BASE_ERROR_H
#define AMONTONS_BASE_ERROR_H

#include "amontons_error.h"

#include <stdbool.h>
#include <stdint.h>

// Sets a clean error; a set one keeps its first cause. `file`, `line`: the origin.
void error_set(Error *err, ErrorCode code, const char *file, int32_t line, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

// Puts "format: " before the message of a set error; does nothing to a clean one.
void error_context(Error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

void error_clear(Error *err);

static inline bool error_is_clean(const Error *err)
{
    return err->code == ERROR_NONE;
}

// Clang's analyzer needs this, as it sees one file at a time: whoever failed has set the error.
#ifdef __clang_analyzer__
#define ERROR_IS_SET(err)                                                                          \
    do {                                                                                           \
        if (error_is_clean(_Generic((err), Error * : (err), Error : &(err))))                      \
            __builtin_unreachable();                                                               \
    } while (0)
#else
#define ERROR_IS_SET(err) ((void)0)
#endif

// Sets the error; false.
#define FAULT(err, code, ...) (error_set((err), (code), __FILE__, __LINE__, __VA_ARGS__), false)
#define REFUSE(err, ...) FAULT((err), ERROR_INPUT, __VA_ARGS__)

// Functions that take `const char **key` set it to the key of the scene that an error is about, and
// leave it as it is without an error. REFUSE_AT sets both; ERROR_AT gives the error of a call that
// knows nothing of keys its key. Both return false, ERROR_AT true where the call does.
#define REFUSE_AT(err, key, name, ...) (*(key) = (name), REFUSE((err), __VA_ARGS__))
#define ERROR_AT(key, name, call) ((call) || (*(key) = (name), false))

#define FAIL(err, code, ...)                                                                       \
    do {                                                                                           \
        error_set((err), (code), __FILE__, __LINE__, __VA_ARGS__);                                 \
        ERROR_IS_SET(err);                                                                         \
        goto cleanup;                                                                              \
    } while (0)

#define TRY(call)                                                                                  \
    do {                                                                                           \
        if (!(call)) {                                                                             \
            ERROR_IS_SET(err);                                                                     \
            goto cleanup;                                                                          \
        }                                                                                          \
    } while (0)

#endif
