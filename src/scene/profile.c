// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/profile.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"
#include "scene/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char BLANKS[] = " \t\r", BETWEEN[] = " \t,;", AROUND[] = " \t\r\"'";
static const char BYTE_ORDER_MARK[] = "\xEF\xBB\xBF";   // before the first line, by some programs
enum { COLUMNS = 2, FIRST_ROOM = 64, HEAD_SIZE = 80 };

// A file on its way: `line` is cut out of it, with a zero byte at its end.
typedef struct Table {
    const char *path;
    SceneUnits units;
    char *line;
    int32_t number;   // of the line, from 1
    int32_t room;
    double unit[COLUMNS];   // what a 1 in the column is, length
} Table;

// Where in the line `at` stands, from 1.
static int column_of(const Table *table, const char *at)
{
    return (int)(at - table->line) + 1;
}

// The unit of "x [mm]", "x (mm)", "x/mm", "x_mm", "x in mm", "x mm" or "mm", which is cut where the
// unit ends; *unit NULL: "x" and "gap" alone. false: none of these.
static bool find_unit(char *head, char **unit)
{
    double one = 1;
    char *sign = strpbrk(head, "[(/"), *last = strpbrk(head, "_ ");
    if (sign) {
        char *end = *sign == '/' ? sign + strlen(sign) : sign + strcspn(sign, "])");
        if (*sign != '/' && (*end == 0 || end[1] != 0)) return false;
        *end = 0;
        *unit = sign + 1 + strspn(sign + 1, BLANKS);
        return true;
    }
    for (char *next = last; next; next = strpbrk(next + 1, "_ ")) last = next;
    *unit = last ? last + 1 : head;
    if (unit_to_si(*unit, "length", &one)) return true;
    *unit = NULL;
    return strcasecmp(head, "x") == 0 || strcasecmp(head, "gap") == 0;
}

// What heads a column, `length` bytes from `at` on, and the unit in it; the name alone leaves the
// unit as it is.
static bool read_head(const Table *table, const char *at, size_t length, double *scale, Error *err)
{
    char head[HEAD_SIZE], *unit = NULL;
    size_t before = strspn(at, AROUND);
    at += before;
    length -= before < length ? before : length;
    while (length > 0 && strchr(AROUND, at[length - 1])) length--;
    snprintf(head, sizeof head, "%.*s", (int)length, at);
    if (length == 0 || length >= sizeof head || !find_unit(head, &unit))
        FAIL(err, ERROR_INPUT,
             "%s:%d:%d: found `%.*s`; wanted: two numbers, x and gap, or names of the two columns: "
             "`x, gap`, or with units `x [mm], gap [um]`, `x/mm, gap/um`, `x_mm, gap_um`, `mm, um`",
             table->path, table->number, column_of(table, at), length < 60 ? (int)length : 60, at);
    if (!unit) return true;
    at += unit - head;
    if (table->units == UNITS_NORMALISED)
        FAIL(err, ERROR_INPUT,
             "%s:%d:%d: found a unit, `%s`; a normalised scene has plain numbers (units need "
             "`units: si`)",
             table->path, table->number, column_of(table, at), unit);
    *scale = 1;
    if (!unit_to_si(unit, "length", scale))
        FAIL(err, ERROR_INPUT, "%s:%d:%d: `%s` is no unit of length; allowed: %s", table->path,
             table->number, column_of(table, at), unit, unit_examples("length"));
cleanup:
    return error_is_clean(err);
}

// What heads the columns, from `at` on.
static bool read_heads(Table *table, const char *at, Error *err)
{
    double unit[COLUMNS] = {table->unit[0], table->unit[1]};
    const char *second = strpbrk(at, ",;\t");
    size_t length = second ? (size_t)(second - at) : strlen(at);
    TRY(read_head(table, at, length, &unit[0], err));
    if (!second) second = at + length - 1;   // nothing heads the gap
    TRY(read_head(table, second + 1, strlen(second + 1), &unit[1], err));
    memcpy(table->unit, unit, sizeof unit);
cleanup:
    return error_is_clean(err);
}

static bool add_point(Table *table, const double *point, SceneProfile *profile, Error *err)
{
    double x = point[0] * table->unit[0], gap = point[1] * table->unit[1];
    if (profile->count > 0 && !(x > profile->x[profile->count - 1]))
        FAIL(err, ERROR_INPUT, "%s:%d: x = %g comes after %g; x must ascend", table->path,
             table->number, x, profile->x[profile->count - 1]);
    if (!(gap >= 0 && isfinite(gap) && isfinite(x)))
        FAIL(err, ERROR_INPUT, "%s:%d: at x = %g the gap is %g; a number >= 0 is needed",
             table->path, table->number, x, gap);
    if (profile->count == table->room) {
        int32_t more = table->room > 0 ? 2 * table->room : FIRST_ROOM;
        double *longer = memory_resize(profile->x, table->room, more, sizeof(double), err);
        TRY(longer);
        profile->x = longer;
        longer = memory_resize(profile->gap, table->room, more, sizeof(double), err);
        TRY(longer);
        profile->gap = longer;
        table->room = more;
    }
    profile->x[profile->count] = x;
    profile->gap[profile->count++] = gap;
cleanup:
    return error_is_clean(err);
}

static bool read_line(Table *table, SceneProfile *profile, Error *err)
{
    double point[COLUMNS];
    const char *at = table->line + strspn(table->line, BLANKS);
    Error no_heads = {0};
    if (*at == '#' && table->room == 0) read_heads(table, at + 1, &no_heads);   // or other words
    if (*at == 0 || *at == '#') return true;
    for (int k = 0; k < COLUMNS; k++) {
        int32_t length = text_number(at, &point[k]);
        if (length == 0 && k == 0 && table->room == 0) return read_heads(table, at, err);
        at += length;
        size_t gap = strspn(at, k == 0 ? BETWEEN : BLANKS);
        bool ends = k == 0 ? gap > 0 : at[gap] == 0;
        if (length == 0 || !ends)
            FAIL(err, ERROR_INPUT, "%s:%d:%d: found `%.60s`; wanted: two numbers, x and gap",
                 table->path, table->number, column_of(table, length ? at + gap : at), table->line);
        at += gap;
    }
    TRY(add_point(table, point, profile, err));
cleanup:
    return error_is_clean(err);
}

bool scene_profile_read(const Scene *scene, SceneProfile *profile, Error *err)
{
    Table table = {.path = scene->contact.profile, .units = scene->units, .unit = {1, 1}};
    char *bytes = NULL;
    int32_t size = 0;
    *profile = (SceneProfile){0};
    if (!*table.path) return true;
    TRY(text_file_read(table.path, SCENE_PROFILE_BYTES_MAX, &bytes, &size, err));
    if (memchr(bytes, 0, (size_t)size)) FAIL(err, ERROR_INPUT, "%s is no text", table.path);
    char *first = bytes;
    if (strncmp(first, BYTE_ORDER_MARK, strlen(BYTE_ORDER_MARK)) == 0)
        first += strlen(BYTE_ORDER_MARK);
    for (char *next = first; next;) {
        table.line = next;
        table.number++;
        next = strchr(next, '\n');
        if (next) *next++ = 0;
        TRY(read_line(&table, profile, err));
    }
    if (profile->count < 2)
        FAIL(err, ERROR_INPUT, "%s has %d point%s; two or more are needed", table.path,
             profile->count, profile->count == 1 ? "" : "s");
cleanup:
    memory_free(bytes);
    if (!error_is_clean(err)) scene_profile_destroy(profile);
    return error_is_clean(err);
}

void scene_profile_destroy(SceneProfile *profile)
{
    memory_free_all(profile->x, profile->gap);
    *profile = (SceneProfile){0};
}

double scene_profile_at(const SceneProfile *profile, double x)
{
    int32_t low = 0, high = profile->count - 1;   // x lies between these two
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        *(profile->x[middle] <= x ? &low : &high) = middle;
    }
    double part = (x - profile->x[low]) / (profile->x[high] - profile->x[low]);
    part = fmin(fmax(part, 0), 1);
    return profile->gap[low] + part * (profile->gap[high] - profile->gap[low]);
}
