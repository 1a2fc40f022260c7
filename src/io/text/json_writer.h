// SPDX-License-Identifier: GPL-2.0-or-later
// Writes one JSON document into a file, atomically: the final name appears when all is on disk.
// Numbers keep 17 digits where needed; NaN and infinities, which JSON does not have, become null.
// Indented by two spaces; a list of plain values stands on one line (RFC 8259).
#ifndef AMONTONS_IO_TEXT_JSON_WRITER_H
#define AMONTONS_IO_TEXT_JSON_WRITER_H

#include "base/error.h"

#include <stdint.h>

typedef struct JsonWriter JsonWriter;

// `key` is NULL inside a list and at the top. The first failure is kept and reported by finish.
JsonWriter *json_create(const char *path, Error *err);   // path NULL: for json_take
// Writes one line that YAML reads, for json_take: {group: top, x: 0.5}.
JsonWriter *json_create_flow(Error *err);
void json_begin_object(JsonWriter *json, const char *key);
void json_begin_list(JsonWriter *json, const char *key);
void json_end(JsonWriter *json);   // of the innermost object or list
void json_text(JsonWriter *json, const char *key, const char *value);   // NULL: null
void json_number(JsonWriter *json, const char *key, double value);
void json_integer(JsonWriter *json, const char *key, int64_t value);
void json_boolean(JsonWriter *json, const char *key, bool value);
// Several numbers, {key, value} each; whole ones, below 10^15, as integers are. And an object of
// them alone.
#define json_numbers_of(json, ...)                                                                 \
    json_numbers((json), (const JsonNumber[]){__VA_ARGS__},                                        \
                 (int32_t)(sizeof((const JsonNumber[]){__VA_ARGS__}) / sizeof(JsonNumber)))
#define json_object_of(json, key, ...)                                                             \
    (json_begin_object((json), (key)), json_numbers_of((json), __VA_ARGS__), json_end((json)))
typedef struct JsonNumber {
    const char *key;
    double value;
} JsonNumber;
void json_numbers(JsonWriter *json, const JsonNumber *numbers, int32_t count);
void json_number_list(JsonWriter *json, const char *key, const double *values, int32_t count);
bool json_finish(JsonWriter *json, Error *err);   // flush, fsync, rename; frees `json` either way
// Is called in place of finish: the document in memory (memory_free), NULL on failure. Frees `json`
// either way.
char *json_take(JsonWriter *json, Error *err);
void json_abandon(JsonWriter *json);   // removes what was written; NULL is fine

#endif
