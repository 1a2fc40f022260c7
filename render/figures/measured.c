// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/measured.h"

#include "base/memory.h"
#include "io/text/csv_reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 32 };

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

// How many of the result's lengths a length in `unit` is.
static bool length_factor(const char *unit, size_t length, const ResultView *view, double *factor,
                          Error *err)
{
    static const struct {
        const char *name;
        double metres;
    } units[] = {{"m", 1},     {"cm", 1e-2},      {"mm", 1e-3},
                 {"um", 1e-6}, {"\u00b5m", 1e-6}, {"nm", 1e-9}};
    *factor = 1;
    if (length == 0 || (length == 3 && strncmp(unit, "L_0", length) == 0)) {
        if (!view->si) return true;
        FAIL(err, ERROR_INPUT, "lengths need a unit beside a result in SI: U (mm), or U/L");
    }
    for (size_t k = 0; k < sizeof units / sizeof *units; ++k) {
        if (strlen(units[k].name) != length || strncmp(units[k].name, unit, length) != 0) continue;
        *factor = units[k].metres;
        if (view->si) return true;
        FAIL(err, ERROR_INPUT, "the result is normalised: give lengths as U/L, x/L");
    }
    FAIL(err, ERROR_INPUT, "there is no unit \"%.*s\" of length; m, cm, mm, um, nm are known",
         (int)length, unit);
cleanup:
    return error_is_clean(err);
}

// A column of lengths: `name` with a unit, or name/L. *column -1: there is none.
static bool find_length(const CsvTable *table, const char *name, const ResultView *view,
                        int32_t *column, double *factor, Error *err)
{
    char over_length[NAME_SIZE];
    const char *unit = NULL;
    size_t length = 0;
    snprintf(over_length, sizeof over_length, "%s/L", name);
    *column = find_column(table, over_length, &unit, &length);
    *factor = view->number[NUMBER_LENGTH];
    if (*column >= 0) return true;
    *column = find_column(table, name, &unit, &length);
    return *column < 0 || length_factor(unit, length, view, factor, err);
}

// The load ratio at a row, from one column or as a quotient of two.
typedef struct Ratio {
    int32_t over, under;   // columns; under -1: `over` is the ratio
} Ratio;

static Ratio find_ratio(const CsvTable *table)
{
    const char *unit = NULL;
    size_t length = 0;
    Ratio ratio = {find_column(table, "mu", &unit, &length), -1};
    if (ratio.over < 0) ratio.over = find_column(table, "F_T/F_N", &unit, &length);
    if (ratio.over >= 0) return ratio;
    ratio.over = find_column(table, "F_T", &unit, &length);
    ratio.under = find_column(table, "F_N", &unit, &length);
    return ratio.over < 0 || ratio.under < 0 ? (Ratio){-1, -1} : ratio;
}

static bool take_rows(const CsvTable *table, MeasuredKind kind, const ResultView *view,
                      Measured *measured, Error *err)
{
    int32_t at = -1, x = -1, all = 0;
    double at_factor = 1, factor = 1;
    const char *unit = NULL;
    size_t length = 0;
    Ratio ratio = find_ratio(table);
    int32_t error = find_column(table, "error", &unit, &length);
    TRY(find_length(table, "U", view, &at, &at_factor, err));
    TRY(find_length(table, "x", view, &x, &factor, err));
    if (at < 0 || (x < 0 && ratio.over < 0))
        FAIL(err, ERROR_INPUT, "it needs the columns U and F_T/F_N, or U and x");
    if (kind == MEASURED_MU ? ratio.over < 0 : x < 0) return true;
    for (int32_t row = 0; row < table->rows; ++row) {
        double value = csv_value(table, row, kind == MEASURED_X ? x : ratio.over);
        if (kind == MEASURED_X) value *= factor;
        if (kind == MEASURED_MU && ratio.under >= 0) value /= csv_value(table, row, ratio.under);
        double U = csv_value(table, row, at) * at_factor;
        if (!isfinite(U + value)) continue;
        measured->U[all] = U;
        measured->value[all] = value;
        measured->error[all++] = error < 0 ? (double)NAN
                                           : csv_value(table, row, error) *
                                                 (kind == MEASURED_X ? factor : 1);
    }
    measured->count = all;
cleanup:
    return error_is_clean(err);
}

// NaN: beyond the history.
static double computed_at(const ResultView *view, const double *series, double U)
{
    for (int64_t row = 0; row + 1 < view->rows; ++row) {
        double low = view->U[row], high = view->U[row + 1];
        if (!(U >= low && U <= high)) continue;
        double part = high > low ? (U - low) / (high - low) : 1;
        return series[row] + part * (series[row + 1] - series[row]);
    }
    return NAN;
}

static void find_misfit(const char *path, MeasuredKind kind, const ResultView *view,
                        const double *series, Measured *measured)
{
    const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    double sum = 0, parts = 0, scale = kind == MEASURED_X ? view->number[NUMBER_LENGTH] : 1;
    int32_t count = 0;
    for (int32_t k = 0; k < measured->count; ++k) {
        double away = measured->value[k] - computed_at(view, series, measured->U[k]);
        if (!isfinite(away)) continue;
        sum += away * away;
        parts += away * away / (measured->error[k] * measured->error[k]);
        ++count;
    }
    int length = snprintf(measured->words, sizeof measured->words, "%.60s", name);
    if (count == 0) return;
    length += snprintf(measured->words + length, sizeof measured->words - (size_t)length,
                       ": misfit %.3g%s", sqrt(sum / count) / scale,
                       kind == MEASURED_X ? " ~{L}" : "");
    if (isfinite(parts))
        snprintf(measured->words + length, sizeof measured->words - (size_t)length,
                 ", %.3g of its errors", sqrt(parts / count));
}

bool measured_read(const char *path, MeasuredKind kind, const ResultView *view,
                   const double *series, Measured *measured, Error *err)
{
    CsvTable table = {0};
    *measured = (Measured){0};
    if (!path) return true;
    TRY(csv_read(path, &table, err));
    TRY(measured->U = NEW_ARRAY(double, table.rows, err));
    TRY(measured->value = NEW_ARRAY(double, table.rows, err));
    TRY(measured->error = NEW_ARRAY(double, table.rows, err));
    TRY(take_rows(&table, kind, view, measured, err));
    find_misfit(path, kind, view, series, measured);
cleanup:
    csv_destroy(&table);
    error_context(err, "measurements %s", path);
    if (!error_is_clean(err)) measured_destroy(measured);
    return error_is_clean(err);
}

void measured_destroy(Measured *measured)
{
    memory_free(measured->U);
    memory_free(measured->value);
    memory_free(measured->error);
    *measured = (Measured){0};
}
