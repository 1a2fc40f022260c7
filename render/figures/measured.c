// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/measured.h"

#include "base/memory.h"
#include "io/text/csv_reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 32 };

static const Color MEASURED_COLOR = {0.80f, 0.36f, 0.00f, 1};

typedef enum Dimension { NO_DIMENSION, OF_LENGTH, OF_TIME, OF_VELOCITY } Dimension;

static const struct {
    const char *name;
    Dimension dimension;
    double factor;   // of its SI unit
} UNITS[] = {{"m", OF_LENGTH, 1},         {"cm", OF_LENGTH, 1e-2},      {"mm", OF_LENGTH, 1e-3},
             {"um", OF_LENGTH, 1e-6},     {"\u00b5m", OF_LENGTH, 1e-6}, {"nm", OF_LENGTH, 1e-9},
             {"s", OF_TIME, 1},           {"ms", OF_TIME, 1e-3},        {"us", OF_TIME, 1e-6},
             {"\u00b5s", OF_TIME, 1e-6},  {"min", OF_TIME, 60},         {"m/s", OF_VELOCITY, 1},
             {"mm/s", OF_VELOCITY, 1e-3}, {"um/s", OF_VELOCITY, 1e-6},  {"km/s", OF_VELOCITY, 1e3}};

// What a quantity may be over, in the place of a unit.
static const struct {
    const char *name;
    Dimension dimension;
    ResultNumber number;
} OVER[] = {{"L", OF_LENGTH, NUMBER_LENGTH},
            {"c_R", OF_VELOCITY, NUMBER_C_RAYLEIGH},
            {"c_S", OF_VELOCITY, NUMBER_C_SHEAR},
            {"c_L", OF_VELOCITY, NUMBER_C_LONGITUDINAL},
            {"V", OF_VELOCITY, NUMBER_ROD_VELOCITY}};

typedef struct Column {
    int32_t index;   // -1: there is none
    int32_t under;   // the column that this one is over; -1: none
    double factor;   // to the result's unit
} Column;

// "U (mm)", "U/L" or " U": the name's length, and behind it the unit.
static size_t name_length(const char *heading, const char **unit, size_t *unit_length)
{
    size_t length = strcspn(heading, " (");
    const char *open = strchr(heading, '(');
    *unit = open ? open + 1 : "";
    *unit_length = open ? strcspn(open + 1, ")") : 0;
    return length;
}

// -1: no column is called so.
static int32_t find_column(const CsvTable *table, const char *name, const char **unit,
                           size_t *unit_length)
{
    for (int32_t k = 0; k < table->columns; ++k) {
        const char *heading = csv_name(table, k) + strspn(csv_name(table, k), " ");
        size_t length = name_length(heading, unit, unit_length);
        if (length == strlen(name) && strncmp(heading, name, length) == 0) return k;
    }
    return -1;
}

static int32_t find_bare(const CsvTable *table, const char *name)
{
    const char *unit = NULL;
    size_t length = 0;
    return find_column(table, name, &unit, &length);
}

// A quantity with a unit behind it, as a heading has it.
typedef struct Heading {
    const char *name, *unit;
    size_t length;   // of the unit
    Dimension dimension;
} Heading;

// How many of the result's units one is. Normalised results have none.
static bool unit_factor(const Heading *heading, const ResultView *view, double *factor, Error *err)
{
    const char *name = heading->name, *unit = heading->unit;
    size_t length = heading->length;
    *factor = 1;
    bool bare = length == 0 || memchr(unit, '_', length);   // L_0, t_0, L_0/t_0
    if (bare && !view->si) return true;
    if (bare) return REFUSE(err, "%s needs a unit beside a result in SI, as in U (mm)", name);
    for (size_t k = 0; k < sizeof UNITS / sizeof *UNITS; ++k) {
        if (UNITS[k].dimension != heading->dimension || strlen(UNITS[k].name) != length ||
            strncmp(UNITS[k].name, unit, length) != 0)
            continue;
        *factor = UNITS[k].factor;
        if (view->si) return true;
        return REFUSE(
            err,
            "the result is normalised: give %s over a length or speed of it, as in U/L, x/L, "
            "v/c_R",
            name);
    }
    return REFUSE(err,
                  "%s: there is no unit \"%.*s\" for it; m, cm, mm, um, nm, s, ms, us, "
                  "min, m/s, mm/s, um/s, km/s are known",
                  name, (int)length, unit);
}

// `name` with a unit, or over what the result knows.
static bool find_quantity(const CsvTable *table, const char *name, Dimension dimension,
                          const ResultView *view, Column *column, Error *err)
{
    char over[NAME_SIZE];
    const char *unit = NULL;
    size_t length = 0;
    *column = (Column){-1, -1, 1};
    for (size_t k = 0; k < sizeof OVER / sizeof *OVER; ++k) {
        snprintf(over, sizeof over, "%s/%s", name, OVER[k].name);
        int32_t index = OVER[k].dimension == dimension ? find_bare(table, over) : -1;
        if (index < 0) continue;
        *column = (Column){index, -1, fabs(view->number[OVER[k].number])};
        return true;
    }
    column->index = find_column(table, name, &unit, &length);
    const Heading heading = {name, unit, length, dimension};
    return column->index < 0 || dimension == NO_DIMENSION ||
           unit_factor(&heading, view, &column->factor, err);
}

static Column find_ratio(const CsvTable *table)
{
    Column ratio = {find_bare(table, "mu"), -1, 1};
    if (ratio.index < 0) ratio.index = find_bare(table, "F_T/F_N");
    if (ratio.index >= 0) return ratio;
    ratio = (Column){find_bare(table, "F_T"), find_bare(table, "F_N"), 1};
    return ratio.under < 0 ? (Column){-1, -1, 1} : ratio;
}

// All that a file may hold.
typedef struct Columns {
    Column U, t, ratio, x, area, length, speed, error;
} Columns;

static bool find_columns(const CsvTable *table, const ResultView *view, Columns *found, Error *err)
{
    *found = (Columns){.ratio = find_ratio(table), .error = {find_bare(table, "error"), -1, 1}};
    return find_quantity(table, "U", OF_LENGTH, view, &found->U, err) &&
           find_quantity(table, "t", OF_TIME, view, &found->t, err) &&
           find_quantity(table, "x", OF_LENGTH, view, &found->x, err) &&
           find_quantity(table, "A/A_0", NO_DIMENSION, view, &found->area, err) &&
           find_quantity(table, "l", OF_LENGTH, view, &found->length, err) &&
           find_quantity(table, "v", OF_VELOCITY, view, &found->speed, err);
}

// Which columns `kind` has: over what, and the value. false: the file does not have it.
static bool choose(const Columns *found, MeasuredKind kind, Column *at, Column *value)
{
    const Column moment = found->U.index >= 0 ? found->U : found->t;
    const Column ats[MEASURED_KINDS] = {moment, moment, moment, found->ratio, found->x};
    const Column values[MEASURED_KINDS] = {found->ratio, found->x, found->area, found->length,
                                           found->speed};
    *at = ats[kind];
    *value = values[kind];
    if (kind == MEASURED_FRONT && (found->area.index >= 0 || found->speed.index >= 0)) return false;
    if (kind == MEASURED_AREA && found->x.index < 0) return false;
    return at->index >= 0 && value->index >= 0;
}

static double read_cell(const CsvTable *table, int32_t row, const Column *column)
{
    if (column->index < 0) return NAN;
    double value = csv_value(table, row, column->index) * column->factor;
    return column->under < 0 ? value : value / csv_value(table, row, column->under);
}

static bool take_rows(const CsvTable *table, const Columns *found, const ResultView *view,
                      Measured *measured, Error *err)
{
    Column at, value, error = found->error;
    const ViewCurve way = {view->rows, view->t, view->U};
    if (!choose(found, measured->kind, &at, &value)) return true;
    double **lists[] = {&measured->at, &measured->x, &measured->value, &measured->error,
                        &measured->computed};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; ++k)
        if (!(*lists[k] = NEW_ARRAY(double, table->rows, err))) return false;
    error.factor = value.factor;
    bool is_time = measured->kind <= MEASURED_AREA && found->U.index < 0;
    for (int32_t row = 0; row < table->rows; ++row) {
        int32_t k = measured->count;
        measured->at[k] = read_cell(table, row, &at);
        if (is_time) measured->at[k] = curve_value(&way, measured->at[k]);
        measured->x[k] = read_cell(table, row, &found->x);
        measured->value[k] = read_cell(table, row, &value);
        measured->error[k] = read_cell(table, row, &error);
        measured->computed[k] = NAN;
        bool placed = measured->kind != MEASURED_AREA || isfinite(measured->x[k]);
        if (isfinite(measured->at[k] + measured->value[k]) && placed) ++measured->count;
    }
    return true;
}

static bool has_any(const Columns *found)
{
    Column at, value;
    for (int32_t kind = 0; kind < MEASURED_KINDS; ++kind)
        if (choose(found, (MeasuredKind)kind, &at, &value)) return true;
    return false;
}

static bool read_table(const char *path, const ResultView *view, CsvTable *table, Columns *found,
                       Error *err)
{
    if (!csv_read(path, table, err)) return false;
    TRY(find_columns(table, view, found, err));
    if (!has_any(found))
        FAIL(err, ERROR_INPUT,
             "it needs the columns U and F_T/F_N, U and x, U, x and A/A_0, F_T/F_N and l, or x "
             "and v");
    if (table->rows == 0) FAIL(err, ERROR_INPUT, "below the names of its columns there is no row");
    const Column *const columns[] = {&found->U,    &found->t,      &found->ratio, &found->x,
                                     &found->area, &found->length, &found->speed};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; ++k)
        TRY(csv_check(table, columns[k]->index, false, err));
    TRY(csv_check(table, found->ratio.under, true, err));
    TRY(csv_check(table, found->error.index, true, err));
cleanup:
    error_context(err, "measurements %s", path);
    return error_is_clean(err);
}

// The misfit in words.
static void describe(Measured *measured, const ResultView *view)
{
    static const struct {
        const char *words;
        int32_t number;   // that the misfit is over; -1: none
    } scales[MEASURED_KINDS] = {{"", -1},
                                {" ~{L}", NUMBER_LENGTH},
                                {"", -1},
                                {" ~{L}", NUMBER_LENGTH},
                                {" ~{c}_{R}", NUMBER_C_RAYLEIGH}};
    double sum = 0, parts = 0;
    int32_t count = 0, number = scales[measured->kind].number;
    for (int32_t k = 0; k < measured->count; ++k) {
        double away = measured->value[k] - measured->computed[k];
        if (!isfinite(away)) continue;
        sum += away * away;
        parts += away * away / (measured->error[k] * measured->error[k]);
        ++count;
    }
    if (count == 0) return;
    size_t length = strlen(measured->words);
    double misfit = sqrt(sum / count) / (number < 0 ? 1 : view->number[number]);
    length += (size_t)snprintf(measured->words + length, sizeof measured->words - length,
                               ": misfit %.3g%s", misfit, scales[measured->kind].words);
    if (isfinite(parts))
        snprintf(measured->words + length, sizeof measured->words - length, ", %.3g of its errors",
                 sqrt(parts / count));
}

static bool compare(Measured *measured, ResultView *view, Error *err)
{
    ViewCurve curve;
    bool area = measured->kind == MEASURED_AREA;
    if (area && !(result_view_read_slip_rate(view, err) && result_view_read_status(view, err)))
        return false;
    if (!computed_curve(view, measured->kind, &curve, err)) return false;
    for (int32_t k = 0; k < measured->count; ++k)
        measured->computed[k] = area ? computed_area(view, measured->at[k], measured->x[k])
                                     : curve_value(&curve, measured->at[k]);
    describe(measured, view);
    return true;
}

bool measured_read(const char *path, MeasuredKind kind, ResultView *view, Measured *measured,
                   Error *err)
{
    CsvTable table = {0};
    Columns found;
    *measured = (Measured){.kind = kind, .path = path};
    if (!path) return true;
    const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    snprintf(measured->words, sizeof measured->words, "%.60s", name);
    TRY(read_table(path, view, &table, &found, err));
    TRY(take_rows(&table, &found, view, measured, err));
    if (measured->count > 0) TRY(compare(measured, view, err));
cleanup:
    csv_destroy(&table);
    if (!error_is_clean(err)) measured_destroy(measured);
    return error_is_clean(err);
}

bool measured_has(const char *path, MeasuredKind kind, const ResultView *view, bool *has,
                  Error *err)
{
    CsvTable table = {0};
    Columns found;
    Column at, value;
    TRY(read_table(path, view, &table, &found, err));
    *has = choose(&found, kind, &at, &value);
cleanup:
    csv_destroy(&table);
    return error_is_clean(err);
}

int32_t measured_key(const Measured *measured, KeyMark mark, KeyEntry *entries, int32_t count)
{
    Color color = mark == KEY_RING ? INK : MEASURED_COLOR;
    if (measured->count > 0) entries[count++] = (KeyEntry){mark, color, measured->words};
    return count;
}

void measured_draw(const Page *page, const Measured *measured, const Axes *axes)
{
    Stroke stroke = {.color = MEASURED_COLOR, .width = 0.5 * page->point};
    double radius = KEY_RADIUS * page->point;
    canvas_clip(page->canvas, &axes->box);
    for (int32_t k = 0; k < measured->count; ++k) {
        double at = measured->at[k], value = measured->value[k], error = measured->error[k];
        if (isfinite(error))
            draw_segment(page->canvas, &stroke, axes_place(axes, at, value - error),
                         axes_place(axes, at, value + error));
        draw_disc(page->canvas, PAPER, axes_place(axes, at, value), 1.25 * radius);
        draw_disc(page->canvas, MEASURED_COLOR, axes_place(axes, at, value), radius);
    }
    canvas_clip(page->canvas, NULL);
}

void measured_destroy(Measured *measured)
{
    memory_free_all(measured->at, measured->x, measured->value, measured->error,
                    measured->computed);
    *measured = (Measured){0};
}
