// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/profile.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/text/csv_reader.h"

#include <math.h>
#include <stdlib.h>

enum { COLUMNS_MAX = 3 };

typedef struct ProfilePoint {
    double column[COLUMNS_MAX];   // length
} ProfilePoint;

// A surface on its way.
typedef struct Table {
    const char *path;
    int32_t columns;   // 2: x and gap; 3: x, y and gap
    int32_t count;
    ProfilePoint *points;   // [count] as they stand in the file; owned
} Table;

static const char *const NAMES[COLUMNS_MAX][4] = {{"x", "X"}, {"y", "Y"}, {"gap", "Gap", "GAP"}};
static const char WANTED[] =
    "wanted: x and gap, of a height map x, y and gap, in any order: `x, gap`, or with units `x "
    "[mm], gap [um]`, `x/mm, gap/um`, `x_mm, gap_um` (a gap is how far the surface lies below its "
    "highest point: of heights z it is their largest less z)";

// place[x, y, gap]: which column of the file it is, -1: none; scale: what a 1 in it is, length.
static bool read_heads(const CsvTable *csv, SceneUnits units, int32_t place[COLUMNS_MAX],
                       double scale[COLUMNS_MAX], Error *err)
{
    int32_t error = -1;   // the column of the gap's errors, which says nothing of the shape
    CsvUnit unit[COLUMNS_MAX], ignored;
    for (int32_t k = 0; k < COLUMNS_MAX; k++) {
        place[k] = -1;
        scale[k] = 1;
        if (csv->named && !csv_find_any(csv, NAMES[k], &place[k], &unit[k], err)) return false;
    }
    if (place[0] < 0 || place[2] < 0) {
        // Names are needed where the first row is no numbers; a comment may be about anything.
        if (csv->named && !csv->named_by_comment)
            return REFUSE(err, "%s:%d: there is no column %s; %s", csv->path, csv->line[0],
                          place[0] < 0 ? "x" : "gap", WANTED);
        if (csv->columns < 2 || csv->columns > COLUMNS_MAX)
            return REFUSE(err, "%s:%d: %d column%s without names; %s", csv->path, csv->line[1],
                          csv->columns, csv->columns == 1 ? "" : "s", WANTED);
        place[0] = 0;
        place[1] = csv->columns == COLUMNS_MAX ? 1 : -1;
        place[2] = csv->columns - 1;
        return true;
    }
    csv_find_error(csv, place[2], &error, &ignored);
    for (int32_t k = 0; k < csv->columns; k++)
        if (k != place[0] && k != place[1] && k != place[2] && k != error)
            return csv_refuse(csv, -1, k, err, "is no column of a surface; %s", WANTED);
    for (int32_t k = 0; k < COLUMNS_MAX; k++)
        if (place[k] >= 0 &&
            !csv_to_scene(csv, place[k], unit[k], "length", units == UNITS_SI, &scale[k], err))
            return false;
    return true;
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

bool scene_profile_read(const Scene *scene, SceneProfile *profile, Error *err)
{
    Table table = {.path = scene->contact.profile};
    CsvTable csv = {0};
    int32_t place[COLUMNS_MAX];
    double scale[COLUMNS_MAX];
    *profile = (SceneProfile){0};
    if (!*table.path) return true;
    TRY(csv_read_bare(table.path, &csv, err));
    TRY(read_heads(&csv, scene->units, place, scale, err));
    table.columns = place[1] < 0 ? 2 : COLUMNS_MAX;
    if (csv.rows == 0)
        FAIL(err, ERROR_INPUT, "%s has 0 points; two or more are needed", table.path);

    // Points as they stand in the file. Along x alone they ascend.
    double before = -INFINITY;
    int32_t last = table.columns - 1;
    TRY((table.points = memory_array(csv.rows, sizeof *table.points, err)));
    for (int32_t row = 0; row < csv.rows; row++) {
        ProfilePoint *point = &table.points[table.count++];
        for (int32_t name = 0, k = 0; name < COLUMNS_MAX; name++) {
            if (place[name] < 0) continue;
            TRY(csv_read_number(&csv, row, place[name], &point->column[k], err));
            point->column[k++] *= scale[name];
        }
        double x = point->column[0], gap = point->column[last];
        if (table.columns == 2 && !(x > before))
            TRY(csv_refuse(&csv, row, place[0], err, "x = %g comes after %g; x must ascend", x,
                           before));
        if (!(gap >= 0))
            TRY(csv_refuse(&csv, row, place[COLUMNS_MAX - 1], err,
                           "at x = %g the gap is %g; a number >= 0 is needed", x, gap));
        before = x;
    }

    // The grid: of a map each pair of an x and a y needs its one point.
    profile->rows = 1;
    TRY(list_places(&table, 0, &profile->x, &profile->count, err));
    if (last == COLUMNS_MAX - 1) TRY(list_places(&table, 1, &profile->y, &profile->rows, err));
    if ((int64_t)profile->count * profile->rows != table.count)
        FAIL(err, ERROR_INPUT,
             "%s has %d points at %d different x and %d different y: a height map is a "
             "grid, with one point for each x and y",
             table.path, table.count, profile->count, profile->rows);
    TRY((profile->gap = NEW_ARRAY(double, table.count, err)));
    for (int32_t i = 0; i < table.count; i++) profile->gap[i] = NAN;
    for (int32_t i = 0; i < table.count; i++) {
        const double *point = table.points[i].column;
        int32_t k = place_before(profile->x, profile->count, point[0]), row = 0;
        k += point[0] > profile->x[k];
        if (profile->y) {
            row = place_before(profile->y, profile->rows, point[1]);
            row += point[1] > profile->y[row];
        }
        double *gap = &profile->gap[(int64_t)profile->count * row + k];
        if (!isnan(*gap))
            FAIL(err, ERROR_INPUT, "%s has two points at x = %g, y = %g", table.path, point[0],
                 point[1]);
        *gap = point[last];
    }
cleanup:
    memory_free(table.points);
    csv_destroy(&csv);
    if (!error_is_clean(err)) scene_profile_destroy(profile);
    return error_is_clean(err);
}

void scene_profile_destroy(SceneProfile *profile)
{
    memory_free_all(profile->x, profile->y, profile->gap);
    *profile = (SceneProfile){0};
}

// Position of `at` between place k and the next, from 0 to 1.
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
