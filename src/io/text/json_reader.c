// SPDX-License-Identifier: GPL-2.0-or-later
// A scanner over the text (RFC 8259): it steps over whole values until it stands at the one wanted.
//
// No tree is built, as libfyaml or json-c would do: of a run.json of some hundred kilobytes two or
// three values are wanted. It reads what io/text/json_writer writes; of wrong JSON it finds
// nothing, or something, but never reads beyond the text's end.
#include "io/text/json_reader.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 64 };

// Reports of thousands of points are gone through byte by byte: no calls of strspn and strcspn.
static bool is_space(char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

static const char *skip_space(const char *at)
{
    while (is_space(*at)) at++;
    return at;
}

static bool ends_scalar(char byte)
{
    return !byte || byte == ',' || byte == ':' || byte == ']' || byte == '}' || byte == '"' ||
           byte == '[' || byte == '{' || is_space(byte);
}

// Place behind the string that begins at `at`; NULL: there is none. A backslash escapes one
// character.
static const char *skip_string(const char *at)
{
    if (*at != '"') return NULL;
    for (at++; *at && *at != '"'; at++)
        if (*at == '\\' && at[1]) at++;
    return *at == '"' ? at + 1 : NULL;
}

// Place of the value of the next item of an object; *key: its key, in quotes, [*length] with them.
static const char *enter_item(const char *at, const char **key, int32_t *length)
{
    *key = skip_space(at);
    const char *end = skip_string(*key);
    if (!end) return NULL;
    *length = (int32_t)(end - *key);
    end = skip_space(end);
    return *end == ':' ? skip_space(end + 1) : NULL;
}

// Place behind a scalar, or behind the brackets of an object or list, whose strings are stepped
// over.
static const char *skip_value(const char *at)
{
    int32_t depth = 0;
    do {
        at = skip_space(at);
        if (*at == '"') {
            at = skip_string(at);
            if (!at) return NULL;
        } else if (*at == '{' || *at == '[') {
            if (++depth > DEPTH_MAX) return NULL;
            at++;
        } else if (*at == '}' || *at == ']') {
            if (--depth < 0) return NULL;
            at++;
        } else if ((*at == ',' || *at == ':') && depth > 0) {
            at++;
        } else {
            if (ends_scalar(*at)) return NULL;
            while (!ends_scalar(*at)) at++;
        }
    } while (depth > 0);
    return at;
}

// Place behind a value and its comma: of the next item or the bracket that ends the list; NULL: no
// JSON.
static const char *next_item(const char *at)
{
    at = skip_value(at);
    if (!at) return NULL;
    at = skip_space(at);
    return *at == ',' ? skip_space(at + 1) : at;
}

// Place of the child of the object or list at `at` that the first `length` bytes of `name` name.
static const char *enter_child(const char *at, const char *name, size_t length)
{
    char end = *at == '{' ? '}' : ']';
    bool is_object = *at == '{';
    if (!is_object && *at != '[') return NULL;
    char *rest = NULL;
    long wanted = is_object ? -1 : strtol(name, &rest, 10);
    if (!is_object && (!isdigit((unsigned char)*name) || rest != name + length)) return NULL;
    at = skip_space(at + 1);
    for (long k = 0; at && *at && *at != end; k++) {
        const char *key = NULL;
        int32_t size = 0;
        if (is_object) at = enter_item(at, &key, &size);
        if (!at) return NULL;
        bool found = is_object ? (size_t)size == length + 2 && strncmp(key + 1, name, length) == 0
                               : k == wanted;
        if (found) return at;
        at = next_item(at);
    }
    return NULL;
}

// path: "results.peaks.0.mu", keys and indices with dots between them. NULL: not there.
static const char *find(const char *text, const char *path)
{
    const char *at = skip_space(text);
    while (at && *path) {
        size_t length = strcspn(path, ".");
        at = enter_child(at, path, length);
        path += length;
        if (*path == '.') path++;
    }
    return at;
}

static bool may_hold(const char *at, const char *path, int32_t depth)
{
    size_t length = strcspn(path, ".");
    const char *rest = path + length + (path[length] == '.');
    if (!at || depth > DEPTH_MAX) return false;
    if (!*path) return *at != '{' && *at != '[';
    if (*at != '[') return may_hold(enter_child(at, path, length), rest, depth + 1);
    if (strspn(path, "0123456789") != length) return false;
    at = skip_space(at + 1);
    if (*at == ']') return true;
    for (; at && *at && *at != ']'; at = next_item(at))
        if (may_hold(at, rest, depth + 1)) return true;
    return false;
}

bool json_may_hold(const char *text, const char *path)
{
    return may_hold(skip_space(text), path, 0);
}

bool json_find_key(const char *text, const char *path, int32_t index, char *key, int32_t size)
{
    const char *at = find(text, path), *name = NULL;
    int32_t length = 0;
    if (!at || *at != '{') return false;
    at = skip_space(at + 1);
    for (int32_t k = 0; at && *at == '"'; k++, at = next_item(at)) {
        at = enter_item(at, &name, &length);
        if (!at) return false;
        if (k == index) snprintf(key, (size_t)size, "%.*s", length - 2, name + 1);
        if (k == index) return true;
    }
    return false;
}

bool json_find_number(const char *text, const char *path, double *value)
{
    const char *at = find(text, path);
    if (!at) return false;
    if (strncmp(at, "true", 4) == 0 || strncmp(at, "false", 5) == 0) {
        *value = *at == 't';
        return true;
    }
    if (strncmp(at, "null", 4) == 0) {
        *value = NAN;
        return true;
    }
    if (*at != '-' && !isdigit((unsigned char)*at)) return false;
    *value = strtod(at, NULL);
    return true;
}

// Escapes are undone; a text that does not fit is never cut in the middle of one.
bool json_find_text(const char *text, const char *path, char *value, int32_t size)
{
    static const char from[] = "nrtbf", to[] = "\n\r\t\b\f";
    const char *at = find(text, path);
    if (!at || *at != '"' || !skip_string(at) || size < 1) return false;
    int32_t length = 0;
    for (at++; *at != '"' && length + 1 < size; at++) {
        char letter = *at;
        if (letter == '\\') {
            const char *known = strchr(from, *++at);
            letter = *at && known ? to[known - from] : *at;
            if (*at == 'u') {
                // Only hexadecimal digits belong to it: the quote that ends the text may stand
                // where the fourth should.
                long code = 0;
                for (int32_t k = 0; k < 4 && isxdigit((unsigned char)at[1]); k++) {
                    char digit[2] = {*++at};
                    code = 16 * code + strtol(digit, NULL, 16);
                }
                letter = code > 0 && code < 0x80 ? (char)code : '?';
            }
        }
        value[length++] = letter;
    }
    value[length] = 0;
    return true;
}

const char *json_find_raw(const char *text, const char *path, int32_t *length)
{
    const char *at = find(text, path), *end = at ? skip_value(at) : NULL;
    if (end) *length = (int32_t)(end - at);
    return end ? at : NULL;
}

void json_drop(char *text, const char *path)
{
    char *at = (char *)find(text, path);   // a place in `text`
    const char *end = at ? skip_value(at) : NULL;
    if (!end || end - at < 4) return;
    memcpy(at, "null", 4);
    memmove(at + 4, end, strlen(end) + 1);
}

void json_compact(char *text)
{
    char *to = text;
    bool inside = false;
    for (const char *at = text; *at; at++) {
        if (!inside && strchr(" \t\r\n", *at)) continue;
        if (inside && *at == '\\' && at[1])
            *to++ = *at++;
        else if (*at == '"')
            inside = !inside;
        *to++ = *at;
    }
    *to = 0;
}

bool json_is_whole(const char *text)
{
    const char *end = skip_value(text);
    return end && !*skip_space(end);
}
