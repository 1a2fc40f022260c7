// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/profile.h"

#include "base/memory.h"
#include "base/order.h"
#include "base/text.h"
#include "io/files/text_file.h"
#include "scene/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char BLANKS[] = " \t\r", BETWEEN[] = " \t,;", AROUND[] = " \t\r\"'";
enum { COLUMNS_MAX = 3, HEAD_SIZE = 80 };

typedef struct ProfilePoint {
    double column[COLUMNS_MAX];   // length
} ProfilePoint;

// A file on its way: `line` is cut out of it, with a zero byte at its end.
typedef struct Table {
    const char *path;
    SceneUnits units;
    char *line;
    int32_t number;   // of the line, from 1
    int32_t columns;   // 2: x and gap; 3: x, y and gap; 0: not seen yet
    double unit[COLUMNS_MAX];   // what a 1 in the column is, length
    int32_t count, room;
    ProfilePoint *points;   // [count] as they stand in the file; owned
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
    return strcasecmp(head, "x") == 0 || strcasecmp(head, "y") == 0 || strcasecmp(head, "gap") == 0;
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
        return REFUSE(err,
                      "%s:%d:%d: found `%.*s`; wanted: two numbers, x and gap, or names of the two "
                      "columns: `x, gap`, or with units `x [mm], gap [um]`, `x/mm, gap/um`, `x_mm, "
                      "gap_um`, `mm, um`; of a height map three: x, y and gap",
                      table->path, table->number, column_of(table, at),
                      length < 60 ? (int)length : 60, at);
    if (!unit) return true;
    at += unit - head;
    if (table->units == UNITS_NORMALISED)
        return REFUSE(err,
                      "%s:%d:%d: found a unit, `%s`; a normalised scene has plain numbers (units "
                      "need `units: si`)",
                      table->path, table->number, column_of(table, at), unit);
    *scale = 1;
    if (!unit_to_si(unit, "length", scale))
        return REFUSE(err, "%s:%d:%d: `%s` is no unit of length; allowed: %s", table->path,
                      table->number, column_of(table, at), unit, unit_examples("length"));
    return true;
}

// What heads the columns, from `at` on.
static bool read_heads(Table *table, const char *at, Error *err)
{
    double unit[COLUMNS_MAX];
    int32_t heads = 0;
    memcpy(unit, table->unit, sizeof unit);
    for (const char *next = at; next; heads++) {
        size_t length = strcspn(next, ",;\t");
        const char *behind = next[length] ? next + length + 1 : NULL;
        if (!behind && heads == 0) behind = next + length;   // nothing heads the gap
        if (heads == COLUMNS_MAX - 1) length = strlen(next);
        if (!read_head(table, next, length, &unit[heads], err)) return false;
        next = heads < COLUMNS_MAX - 1 ? behind : NULL;
    }
    table->columns = heads;
    memcpy(table->unit, unit, sizeof unit);
    return true;
}

static bool add_point(Table *table, const double *column, Error *err)
{
    ProfilePoint point;
    int32_t last = table->columns - 1;
    bool finite = true;
    for (int32_t k = 0; k <= last; k++) {
        point.column[k] = column[k] * table->unit[k];
        finite = finite && isfinite(point.column[k]);
    }
    double x = point.column[0], gap = point.column[last];
    double before = table->count > 0 ? table->points[table->count - 1].column[0] : -INFINITY;
    if (last == 1 && !(x > before))
        return REFUSE(err, "%s:%d: x = %g comes after %g; x must ascend", table->path,
                      table->number, x, before);
    if (!(gap >= 0 && finite))
        return REFUSE(err, "%s:%d: at x = %g the gap is %g; a number >= 0 is needed", table->path,
                      table->number, x, gap);
    if (!memory_grow(&table->points, table->count, &table->room, sizeof point, err)) return false;
    table->points[table->count++] = point;
    return error_is_clean(err);
}

// How many numbers stand in the line from *at on, `most` of them at most; *at is left behind them.
static int32_t read_numbers(const char **at, int32_t most, double number[COLUMNS_MAX])
{
    int32_t read = 0;
    while (read < most) {
        int32_t length = text_number(*at, &number[read]);
        size_t blanks = strspn(*at + length, BLANKS), between = strspn(*at + length, BETWEEN);
        if (length == 0) break;
        read++;
        bool ends = (*at)[length + (int32_t)blanks] == 0;
        *at += length + (int32_t)(ends ? blanks : between);
        if (ends || between == 0) break;
    }
    return read;
}

static bool read_line(Table *table, Error *err)
{
    double number[COLUMNS_MAX];
    const char *at = table->line + strspn(table->line, BLANKS);
    bool first = table->count == 0;
    Error no_heads = {0};
    if (*at == '#' && first) read_heads(table, at + 1, &no_heads);   // or other words
    if (*at == 0 || *at == '#') return true;
    if (first && text_number(at, number) == 0) return read_heads(table, at, err);
    int32_t read = read_numbers(&at, table->columns ? table->columns : COLUMNS_MAX, number);
    if (table->columns == 0) table->columns = read == COLUMNS_MAX ? read : COLUMNS_MAX - 1;
    if (*at || read != table->columns)
        return REFUSE(err, "%s:%d:%d: found `%.60s`; wanted: %s", table->path, table->number,
                      column_of(table, at), table->line,
                      table->columns == COLUMNS_MAX ? "three numbers, x, y and gap"
                                                    : "two numbers, x and gap");
    return add_point(table, number, err);
}

// The places along a column, ascending, each once.
static bool list_places(const Table *table, int32_t column, double **places, int32_t *count,
                        Error *err)
{
    double *place = *places = NEW_ARRAY(double, table->count, err);
    if (!place) return false;
    for (int32_t i = 0; i < table->count; i++) place[i] = table->points[i].column[column];
    qsort(place, (size_t)table->count, sizeof *place, order_doubles);
    *count = 0;
    for (int32_t i = 0; i < table->count; i++)
        if (i == 0 || place[i] > place[*count - 1]) place[(*count)++] = place[i];
    const char *axis = column == 0 ? " along x" : " along y";
    if (*count < 2)
        return REFUSE(err, "%s has %d point%s%s; two or more are needed", table->path, *count,
                      *count == 1 ? "" : "s", table->columns == COLUMNS_MAX ? axis : "");
    return error_is_clean(err);
}

// The last of `places` [count] that lies at or before `at`, but never the last of all.
static int32_t place_before(const double *places, int32_t count, double at)
{
    int32_t low = 0, high = count - 1;   // it lies between these two
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        *(places[middle] <= at ? &low : &high) = middle;
    }
    return low;
}

// Points into rows: of a map each pair of an x and a y needs its one.
static bool lay_out(const Table *table, SceneProfile *profile, Error *err)
{
    int32_t last = table->columns - 1;
    profile->rows = 1;
    if (!list_places(table, 0, &profile->x, &profile->count, err)) return false;
    if (last == COLUMNS_MAX - 1 && !list_places(table, 1, &profile->y, &profile->rows, err))
        return false;
    if ((int64_t)profile->count * profile->rows != table->count)
        return REFUSE(err,
                      "%s has %d points at %d different x and %d different y: a height map is a "
                      "grid, with one point for each x and y",
                      table->path, table->count, profile->count, profile->rows);
    if (!(profile->gap = NEW_ARRAY(double, table->count, err))) return false;
    for (int32_t i = 0; i < table->count; i++) profile->gap[i] = NAN;
    for (int32_t i = 0; i < table->count; i++) {
        const double *point = table->points[i].column;
        int32_t k = place_before(profile->x, profile->count, point[0]), row = 0;
        k += point[0] > profile->x[k];
        if (profile->y) {
            row = place_before(profile->y, profile->rows, point[1]);
            row += point[1] > profile->y[row];
        }
        double *gap = &profile->gap[(int64_t)profile->count * row + k];
        if (!isnan(*gap))
            return REFUSE(err, "%s has two points at x = %g, y = %g", table->path, point[0],
                          point[1]);
        *gap = point[last];
    }
    return true;
}

bool scene_profile_read(const Scene *scene, SceneProfile *profile, Error *err)
{
    Table table = {.path = scene->contact.profile, .units = scene->units, .unit = {1, 1, 1}};
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
        TRY(read_line(&table, err));
    }
    if (table.count == 0)
        FAIL(err, ERROR_INPUT, "%s has 0 points; two or more are needed", table.path);
    TRY(lay_out(&table, profile, err));
cleanup:
    memory_free_all(bytes, table.points);
    if (!error_is_clean(err)) scene_profile_destroy(profile);
    return error_is_clean(err);
}

void scene_profile_destroy(SceneProfile *profile)
{
    memory_free_all(profile->x, profile->y, profile->gap);
    *profile = (SceneProfile){0};
}

// How far from place k to the next `at` lies, from 0 to 1.
static double part_between(const double *places, int32_t k, double at)
{
    double part = (at - places[k]) / (places[k + 1] - places[k]);
    return fmin(fmax(part, 0), 1);
}

static double row_at(const SceneProfile *profile, int32_t row, double x)
{
    const double *gap = &profile->gap[(int64_t)profile->count * row];
    int32_t k = place_before(profile->x, profile->count, x);
    return gap[k] + part_between(profile->x, k, x) * (gap[k + 1] - gap[k]);
}

double scene_profile_at(const SceneProfile *profile, double x, double y)
{
    if (!profile->y) return row_at(profile, 0, x);
    int32_t row = place_before(profile->y, profile->rows, y);
    double here = row_at(profile, row, x), beside = row_at(profile, row + 1, x);
    return here + part_between(profile->y, row, y) * (beside - here);
}
