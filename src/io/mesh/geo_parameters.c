// SPDX-License-Identifier: GPL-2.0-or-later
// A scanner for one construct of gmsh's language:
//     DefineConstant[ nx = 80, shape = "quad", order = {1, Choices{1, 2}, Name "Mesh/order"} ];
// It knows comments, strings, brackets and Include; it does not evaluate anything. A DefineConstant
// inside an If counts, whether or not gmsh would reach it.
#include "io/mesh/geo_parameters.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/open_file.h"
#include "io/files/text_file.h"

#include <ctype.h>
#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// LIST_SIZE: of the list of names in a message; what is longer is cut.
enum { LIST_SIZE = 800 };
static const double LARGEST = 1e60;   // as for the numbers of a scene

void geo_parameters_destroy(GeoParameters *known)
{
    memory_free(known->items);
    *known = (GeoParameters){0};
}

// Place behind the comment or string that begins at `at`, or `at` itself.
static const char *skip_opaque(const char *at)
{
    if (at[0] == '/' && at[1] == '/') return at + strcspn(at, "\n");
    if (at[0] == '/' && at[1] == '*') {
        const char *end = strstr(at + 2, "*/");
        return end ? end + 2 : at + strlen(at);
    }
    if (at[0] == '"') {
        size_t length = strcspn(at + 1, "\"");
        return at[1 + length] ? at + length + 2 : at + length + 1;
    }
    return at;
}

// Past white space and comments.
static const char *skip_blank(const char *at)
{
    for (;;) {
        if (isspace((unsigned char)*at))
            at++;
        else if (at[0] == '/' && (at[1] == '/' || at[1] == '*'))
            at = skip_opaque(at);
        else
            return at;
    }
}

// Length of the name or number that begins at `at`; 0: there is none.
static size_t word_length(const char *at)
{
    size_t length = 0;
    while (isalnum((unsigned char)at[length]) || at[length] == '_') length++;
    return length;
}

// Reads the list whose opening bracket is at **at; leaves *at behind the closing one.
static bool read_list(const char **at, GeoParameters *known, Error *err)
{
    const char *now = *at + 1;
    int32_t depth = 1;
    bool expect_name = true;
    while (*now && depth > 0) {
        now = skip_blank(now);
        size_t length = word_length(now);
        if (expect_name && depth == 1 && length > 0) {
            const char *name = now;
            now = skip_blank(now + length);
            if (!memory_grow(&known->items, known->count, &known->room, sizeof *known->items, err))
                return false;
            // A name that is longer is cut: a MeshParameter has no room for it.
            GeoParameter *item = &known->items[known->count++];
            memcpy(item->name, name, length < sizeof item->name ? length : sizeof item->name - 1);
            // Its value is a string: "a", {"a", ...}, Str(...), StrCat(...).
            const char *value = *now == '=' ? skip_blank(now + 1) : "";
            if (*value == '{') value = skip_blank(value + 1);
            item->is_text = *value == '"' || strncmp(value, "Str", 3) == 0;
            expect_name = false;
        } else if (length > 0) {
            now += length;
        } else if (skip_opaque(now) != now) {
            now = skip_opaque(now);
        } else if (*now) {
            if (strchr("[({", *now)) depth++;
            if (strchr("])}", *now)) depth--;
            if (*now == ',' && depth == 1) expect_name = true;
            now++;
        }
    }
    *at = now;
    return true;
}

void geo_included_path(const char *path, const char *name, int length, char included[GEO_PATH_SIZE])
{
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%s", path);
    if (name[0] == '/')
        snprintf(included, GEO_PATH_SIZE, "%.*s", length, name);
    else
        snprintf(included, GEO_PATH_SIZE, "%s/%.*s", dirname(folder), length, name);
}

// Files read so far, the same one as often as it is included.
typedef struct Scan {
    int32_t files;
    int64_t bytes;
    GeoParameters *known;
} Scan;

// Calls itself for each `Include "name"`; the name is relative to the file that includes it.
static bool scan_file(const char *path, int32_t depth, Scan *scan, Error *err)
{
    char *text = NULL;
    int32_t size = 0;
    if (depth > GEO_INCLUDE_DEPTH_MAX)
        FAIL(err, ERROR_INPUT, "%s: files include each other more than %d deep", path,
             GEO_INCLUDE_DEPTH_MAX);
    if (scan->files++ >= GEO_FILES_MAX)
        FAIL(err, ERROR_INPUT, "%s: more than %d files are included", path, GEO_FILES_MAX);
    TRY(text_file_read(path, GEO_BYTES_MAX, &text, &size, err));
    if ((scan->bytes += size) > GEO_BYTES_MAX)
        FAIL(err, ERROR_INPUT, "%s: the .geo and what it includes are larger than %d MB", path,
             GEO_BYTES_MAX >> 20);
    // Word by word: a name inside a longer one, a string or a comment must not count.
    const char *at = text;
    while (*at) {
        size_t length = word_length(at);
        bool defines = length == strlen("DefineConstant") &&
                       strncmp(at, "DefineConstant", length) == 0;
        bool includes = length == strlen("Include") && strncmp(at, "Include", length) == 0;
        // Not of every word: what lies between would be gone over again and again.
        const char *next = defines || includes ? skip_blank(at + length) : "";
        if (defines && (*next == '[' || *next == '(')) {
            TRY(read_list(&next, scan->known, err));
            at = next;
        } else if (includes && *next == '"') {
            char other[GEO_PATH_SIZE];
            geo_included_path(path, next + 1, (int)strcspn(next + 1, "\""), other);
            if (!open_check_named(other, err) || !scan_file(other, depth + 1, scan, err)) {
                error_context(err, "included by %s", path);
                goto cleanup;
            }
            at = skip_opaque(next);
        } else if (length > 0) {
            at += length;
        } else {
            const char *end = skip_opaque(at);
            at = end != at ? end : at + 1;
        }
    }
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

bool geo_parameters_read(const char *path, GeoParameters *known, Error *err)
{
    *known = (GeoParameters){0};
    Scan scan = {.known = known};
    return scan_file(path, 0, &scan, err);
}

// Always fails: lists the names there are, and the one that was probably meant.
static bool fail_unknown(const GeoParameters *known, const char *path, const char *name, Error *err)
{
    char list[LIST_SIZE] = "none at all", hint[GROUP_NAME_SIZE + 32] = "";
    size_t length = 0;
    const char **names = NEW_ARRAY(const char *, known->count, err);
    if (!names) goto cleanup;
    for (int32_t k = 0; k < known->count; k++) {
        names[k] = known->items[k].name;
        if (length < sizeof list)
            length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", k ? ", " : "",
                                       names[k]);
    }
    int32_t nearest = text_nearest(name, names, known->count);
    if (nearest >= 0) snprintf(hint, sizeof hint, "; did you mean '%s'?", names[nearest]);
    FAIL(err, ERROR_INPUT, "%s: takes no parameter '%s'; its DefineConstant lists: %s%s", path,
         name, list, hint);
cleanup:
    memory_free(names);
    return error_is_clean(err);
}

bool geo_parameters_check(const GeoParameters *known, const char *path, const MeshParameter *given,
                          int32_t given_count, Error *err)
{
    for (int32_t k = 0; k < given_count; k++) {
        const GeoParameter *item = NULL;   // by its name
        for (int32_t i = 0; !item && i < known->count; i++)
            if (strcmp(known->items[i].name, given[k].name) == 0) item = &known->items[i];
        bool is_text = given[k].text[0] != '\0';
        if (!item) return fail_unknown(known, path, given[k].name, err);
        if (item->is_text && !is_text)
            return REFUSE(err, "%s: parameter '%s' is a text, found the number %g", path,
                          item->name, given[k].value);
        if (!item->is_text && is_text)
            return REFUSE(err, "%s: parameter '%s' is a number, found the text '%s'", path,
                          item->name, given[k].text);
        if (strpbrk(given[k].text, "\"\n\\"))
            return REFUSE(err,
                          "%s: the text of parameter '%s' holds a quote, a backslash or a line end",
                          path, item->name);
        if (!is_text && !isfinite(given[k].value))
            return REFUSE(err, "%s: parameter '%s' is not a finite number", path, item->name);
        if (!is_text && fabs(given[k].value) > LARGEST)
            return REFUSE(err, "%s: parameter '%s' is %g; at most %g is allowed", path, item->name,
                          given[k].value, LARGEST);
        for (int32_t j = 0; j < k; j++)
            if (strcmp(given[j].name, given[k].name) == 0)
                return REFUSE(err, "%s: parameter '%s' is given twice", path, item->name);
    }
    return error_is_clean(err);
}
