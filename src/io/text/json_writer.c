// SPDX-License-Identifier: GPL-2.0-or-later
// The document grows in memory and goes to disk in one piece: run.json has some kilobytes.
#include "io/text/json_writer.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/part_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    DEPTH_MAX = 32,   // open objects and lists; run.json has five
    INDENT = 2   // columns a level
};

// An object or list that is not yet ended.
typedef struct JsonLevel {
    bool is_list;
    bool one_line;   // so far it holds plain values only
    int32_t count;   // items written
} JsonLevel;

struct JsonWriter {
    PartFile file;
    bool in_flow;   // json_create_flow
    Error first;   // the first failure
    FILE *out;   // into `text`
    char *text;   // [size] once `out` is closed; owned, of the C library
    size_t size;
    int32_t depth;   // open levels; levels[0] is the document itself
    JsonLevel levels[DEPTH_MAX + 1];
};

// Where memory is short the stream writes less, and does not remember it.
static void append(JsonWriter *json, const char *bytes, size_t size)
{
    if (fwrite(bytes, 1, size, json->out) != size)
        error_set(&json->first, ERROR_MEMORY, __FILE__, __LINE__, "no memory for a document");
}

static void append_text(JsonWriter *json, const char *text)
{
    append(json, text, strlen(text));
}

// And the indentation of the level that is open.
static void append_new_line(JsonWriter *json)
{
    static const char blanks[] = "                                                                ";
    append(json, "\n", 1);
    append(json, blanks, (size_t)(INDENT * json->depth));
}

// A JSON string, escaped by RFC 8259, section 7, and DEL. A file name may hold any bytes: those
// that are not UTF-8, at which a parser would stop, become the replacement character.
static void append_escaped(JsonWriter *json, const char *value)
{
    // In YAML's flow style a word stands without quotes.
    static const char bare[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./";
    bool is_bare = json->in_flow && *value && !value[strspn(value, bare)];
    append_text(json, is_bare ? "" : "\"");
    const unsigned char *next = (const unsigned char *)value;
    while (*next) {
        int32_t length = text_utf8_length((const char *)next);
        char escaped[8] = {0};
        if (length == 0)
            snprintf(escaped, sizeof escaped, "\xEF\xBF\xBD");   // U+FFFD, replacement
        else if (*next == '"' || *next == '\\')
            snprintf(escaped, sizeof escaped, "\\%c", *next);
        else if (*next == '\n')
            snprintf(escaped, sizeof escaped, "\\n");
        else if (*next == '\t')
            snprintf(escaped, sizeof escaped, "\\t");
        else if (*next < 0x20 || *next == 0x7F)
            snprintf(escaped, sizeof escaped, "\\u%04x", *next);
        append(json, escaped[0] ? escaped : (const char *)next,
               escaped[0] ? strlen(escaped) : (size_t)length);
        next += length > 0 ? length : 1;
    }
    append_text(json, is_bare ? "" : "\"");
}

// Comma, line and key before a value or before the bracket of a level.
static void begin_item(JsonWriter *json, const char *key, bool is_plain)
{
    JsonLevel *level = &json->levels[json->depth];
    if (!is_plain && !json->in_flow) level->one_line = false;   // from here on
    if (level->count > 0) append_text(json, level->one_line ? ", " : ",");
    if (json->depth > 0 && !level->one_line) append_new_line(json);
    level->count++;
    if (key) {
        append_escaped(json, key);
        append_text(json, ": ");
    }
}

// Beyond DEPTH_MAX the document has failed, and `depth` stays.
static void begin_level(JsonWriter *json, const char *key, bool is_list)
{
    begin_item(json, key, false);
    append_text(json, is_list ? "[" : "{");
    if (json->depth == DEPTH_MAX) {
        error_set(&json->first, ERROR_LIBRARY, __FILE__, __LINE__,
                  "%s: more than %d levels of nesting", json->file.path, DEPTH_MAX);
        return;
    }
    json->levels[++json->depth] =
        (JsonLevel){.is_list = is_list, .one_line = is_list || json->in_flow};
}

// The file is opened at once: a folder that cannot be written to shows before anything is computed.
JsonWriter *json_create(const char *path, Error *err)
{
    JsonWriter *json = NEW_ARRAY(JsonWriter, 1, err);
    if (!json) return NULL;
    if (path) TRY(part_file_create(&json->file, path, err));
    if (!(json->out = open_memstream(&json->text, &json->size)))
        FAIL(err, ERROR_MEMORY, "no memory for a document");
    return json;
cleanup:
    json_abandon(json);
    return NULL;
}

JsonWriter *json_create_flow(Error *err)
{
    JsonWriter *json = json_create(NULL, err);
    if (json) json->in_flow = true;
    return json;
}

void json_begin_object(JsonWriter *json, const char *key)
{
    begin_level(json, key, false);
}

void json_begin_list(JsonWriter *json, const char *key)
{
    begin_level(json, key, true);
}

// A list of plain values ends on its line.
void json_end(JsonWriter *json)
{
    if (json->depth == 0) return;   // closes a level that was not opened beyond DEPTH_MAX
    JsonLevel level = json->levels[json->depth--];
    if (level.count > 0 && !level.one_line) append_new_line(json);
    append_text(json, level.is_list ? "]" : "}");
}

void json_text(JsonWriter *json, const char *key, const char *value)
{
    begin_item(json, key, true);
    if (value)
        append_escaped(json, value);
    else
        append_text(json, "null");
}

void json_number(JsonWriter *json, const char *key, double value)
{
    char digits[NUMBER_TEXT_SIZE] = "null";
    // 15 digits are always right. As words, 1e+06 is shorter than 1000000.
    if (isfinite(value)) text_shortest(value, json->in_flow ? 6 : 15, digits);
    begin_item(json, key, true);
    append_text(json, digits);
}

void json_integer(JsonWriter *json, const char *key, int64_t value)
{
    begin_item(json, key, true);
    char digits[24];
    snprintf(digits, sizeof digits, "%" PRId64, value);
    append_text(json, digits);
}

void json_boolean(JsonWriter *json, const char *key, bool value)
{
    begin_item(json, key, true);
    append_text(json, value ? "true" : "false");
}

void json_numbers(JsonWriter *json, const JsonNumber *numbers, int32_t count)
{
    for (int32_t k = 0; k < count; k++) json_number(json, numbers[k].key, numbers[k].value);
}

void json_number_list(JsonWriter *json, const char *key, const double *values, int32_t count)
{
    json_begin_list(json, key);
    for (int32_t k = 0; k < count; k++) json_number(json, NULL, values[k]);
    json_end(json);
}

// A missing end is a bug of the caller; the file would not be JSON.
static bool end_document(JsonWriter *json, const char *last, Error *err)
{
    append_text(json, last);
    if (json->depth != 0 || json->levels[0].count != 1)
        error_set(&json->first, ERROR_LIBRARY, __FILE__, __LINE__, "%s: the document is not whole",
                  json->file.path);
    if (fclose(json->out) != 0 || !json->text)
        error_set(&json->first, ERROR_MEMORY, __FILE__, __LINE__, "no memory for a document");
    json->out = NULL;
    if (!error_is_clean(&json->first) && error_is_clean(err)) *err = json->first;
    return error_is_clean(err);
}

bool json_finish(JsonWriter *json, Error *err)
{
    bool done = end_document(json, "\n", err) &&
                part_file_write(&json->file, json->text, (int64_t)json->size, err) &&
                part_file_commit(&json->file, err);
    json_abandon(json);
    return done;
}

char *json_take(JsonWriter *json, Error *err)
{
    bool whole = end_document(json, json->in_flow ? "" : "\n", err);
    char *text = whole ? memory_text(json->text, err) : NULL;
    json_abandon(json);
    return text;
}

void json_abandon(JsonWriter *json)
{
    if (!json) return;
    if (json->out) fclose(json->out);
    part_file_discard(&json->file);
    free(json->text);
    memory_free(json);
}
