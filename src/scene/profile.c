// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/profile.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/text_file.h"
#include "scene/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char BLANKS[] = " \t\r", BETWEEN[] = " \t,;";
enum { COLUMNS = 2, FIRST_ROOM = 64 };

// A file on its way: `line` is cut out of it, with a zero byte at its end.
typedef struct Table {
    const char *path;
    SceneUnits units;
    char *line;
    int32_t number;   // of the line, from 1
    int32_t room;
    double unit[COLUMNS];   // what a 1 in the column is, length
} Table;

// The unit in brackets behind a column's name; the name alone: the scene's own.
static bool read_unit(const Table *table, const char *column, double *unit, Error *err)
{
    char text[24] = "";
    const char *open = strpbrk(column, "[("), *close = open ? strpbrk(open, "])") : NULL;
    *unit = 1;
    if (!close) return true;
    snprintf(text, sizeof text, "%.*s", (int)(close - open - 1), open + 1);
    if (table->units == UNITS_NORMALISED)
        FAIL(err, ERROR_INPUT,
             "%s:%d: found a unit, `%s`; a normalised scene has plain numbers (units need `units: "
             "si`)",
             table->path, table->number, text);
    if (!unit_to_si(text, "length", unit))
        FAIL(err, ERROR_INPUT, "%s:%d: `%s` is no unit of length; allowed: %s", table->path,
             table->number, text, unit_examples("length"));
cleanup:
    return error_is_clean(err);
}

// "x [mm], gap [um]"
static bool read_names(Table *table, Error *err)
{
    char *second = strpbrk(table->line, ",;\t");
    if (!second)
        FAIL(err, ERROR_INPUT,
             "%s:%d: found `%.60s`; wanted: two numbers, x and gap, or names of the two columns, "
             "as in `x [mm], gap [um]`",
             table->path, table->number, table->line);
    *second++ = 0;
    TRY(read_unit(table, table->line, &table->unit[0], err));
    TRY(read_unit(table, second, &table->unit[1], err));
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
    if (*at == 0 || *at == '#') return true;
    for (int k = 0; k < COLUMNS; k++) {
        int32_t length = text_number(at, &point[k]);
        if (length == 0 && k == 0 && table->room == 0) return read_names(table, err);
        at += length;
        size_t gap = strspn(at, k == 0 ? BETWEEN : BLANKS);
        bool ends = k == 0 ? gap > 0 : at[gap] == 0;
        if (length == 0 || !ends)
            FAIL(err, ERROR_INPUT, "%s:%d: found `%.60s`; wanted: two numbers, x and gap",
                 table->path, table->number, table->line);
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
    for (char *next = bytes; next;) {
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
    memory_free(profile->x);
    memory_free(profile->gap);
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
