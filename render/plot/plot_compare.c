// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/plot_compare.h"

#include "base/memory.h"
#include "io/text/csv_reader.h"
#include "io/text/csv_writer.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double MARGIN = 0.05;   // of the axis, beyond a measurement outside of it

// The column called `given`, with a unit or without, else the plain one. *factor: to SI where it
// has a unit, else the numbers are the plot's.
static bool find_column(const CsvTable *table, const char *given, const char *plain,
                        int32_t *column, double *factor, Error *err)
{
    CsvUnit unit = {"", 0};
    *factor = 1;
    *column = -1;
    if (given[0] && !csv_find(table, given, column, &unit, err)) return false;
    if (*column < 0 && !csv_find(table, plain, column, &unit, err)) return false;
    return unit.length == 0 || csv_to_si(table, *column, unit, NULL, factor, err);
}

static bool read_points(const Plot *plot, const CsvTable *table, PlotSeries *series, Error *err)
{
    CsvUnit unit;
    int32_t x = -1, y = -1, error = -1;
    double factor[3];   // of x, y, error
    if (!find_column(table, plot->column[0], "x", &x, &factor[0], err) ||
        !find_column(table, plot->column[1], "y", &y, &factor[1], err))
        return false;
    if (x < 0 || y < 0)
        return REFUSE(err, "%s: it needs the columns %s and %s", table->path,
                      plot->column[0][0] ? plot->column[0] : "x",
                      plot->column[1][0] ? plot->column[1] : "y");
    csv_find_error(table, y, &error, &unit);
    factor[2] = factor[1];   // in the unit of y where it has none
    if (error >= 0 && unit.length > 0 && !csv_to_si(table, error, unit, NULL, &factor[2], err))
        return false;
    if (table->rows == 0)
        return REFUSE(err, "%s: below the names of its columns there is no row", table->path);
    if (!(csv_check(table, x, false, err) && csv_check(table, y, false, err) &&
          csv_check(table, error, true, err)))
        return false;
    if (!(series->x = NEW_ARRAY(double, table->rows, err))) return false;
    if (!(series->y = NEW_ARRAY(double, table->rows, err))) return false;
    if (!(series->low = NEW_ARRAY(double, table->rows, err))) return false;
    if (!(series->high = NEW_ARRAY(double, table->rows, err))) return false;
    for (int32_t row = 0; row < table->rows; ++row) {
        double value = factor[1] * csv_value(table, row, y);
        double bar = error < 0 ? (double)NAN : factor[2] * csv_value(table, row, error);
        series->x[row] = factor[0] * csv_value(table, row, x);
        series->y[row] = value;
        series->low[row] = value - bar;
        series->high[row] = value + bar;
    }
    series->count = table->rows;
    return true;
}

static double on_axis(const Axis *axis, double value)
{
    return axis->is_log ? log10(value) : value;
}

// Widens an axis to values outside of it.
static void widen(Axis *axis, const double *values, int32_t count)
{
    double low = on_axis(axis, axis->low), high = on_axis(axis, axis->high);
    double margin = MARGIN * (high - low), least = low, most = high;
    for (int32_t k = 0; k < count; ++k) {
        double value = on_axis(axis, values[k]);
        if (!isfinite(value)) continue;
        least = fmin(least, value - (value < low ? margin : 0));
        most = fmax(most, value + (value > high ? margin : 0));
    }
    axis->low = axis->is_log ? pow(10, least) : least;
    axis->high = axis->is_log ? pow(10, most) : most;
}

bool plot_compare(Plot *plot, const char *path, Error *err)
{
    CsvTable table = {0};
    if (plot->main.y.names) return true;   // a ranking
    TRY(csv_read(path, &table, err));
    if (plot->main.has_map || (plot->panel_count > 0 && plot->panels[0].has_map))
        FAIL(err, ERROR_INPUT, "measurements are drawn over curves, not over a map");
    if (plot->main.series_count == PLOT_SERIES_MAX)
        FAIL(err, ERROR_INPUT, "the plot has %d curves, and no room for measurements",
             PLOT_SERIES_MAX);

    // The curve to compare with: the one with a line through several points, if it is one alone.
    PlotSeries *series = &plot->main.series[plot->main.series_count], *curve = NULL;
    int32_t curves = 0;
    for (int32_t k = 0; k < plot->main.series_count; ++k) {
        PlotSeries *other = &plot->main.series[k];
        if (other->line == LINE_NONE || other->count < 2) continue;
        curve = other;
        ++curves;
    }
    if (plot->panel_count > 0 || curves > 1) curve = NULL;
    plot->main.series_count++;
    *series = (PlotSeries){.marker = MARKER_CROSS, .filled = true, .line = LINE_NONE};
    TRY(read_points(plot, &table, series, err));

    // Name of the file and misfit, where there is one curve.
    const char *slash = strrchr(path, '/');
    int length = snprintf(series->label, sizeof series->label, "%.40s", slash ? slash + 1 : path);
    if (curve) {
        double sum = 0, parts = 0;
        int32_t count = 0;
        if (!curve->label[0]) snprintf(curve->label, sizeof curve->label, "computed");
        TRY(plot->computed = NEW_ARRAY(double, series->count, err));
        for (int32_t k = 0; k < series->count; ++k) {
            // Between two points of the curve, on its axis; NaN: the curve does not come to x.
            const Axis *axis = &plot->main.x;
            double x = series->x[k];
            plot->computed[k] = NAN;
            for (int32_t i = 0; i + 1 < curve->count; ++i) {
                double low = curve->x[i], high = curve->x[i + 1];
                if (!(x >= fmin(low, high) && x <= fmax(low, high))) continue;
                double span = on_axis(axis, high) - on_axis(axis, low);
                double part = span != 0 ? (on_axis(axis, x) - on_axis(axis, low)) / span : 1;
                plot->computed[k] = curve->y[i] + part * (curve->y[i + 1] - curve->y[i]);
                break;
            }
            double away = series->y[k] - plot->computed[k];
            double error = (series->high[k] - series->low[k]) / 2;
            if (!isfinite(away)) continue;
            sum += away * away;
            parts += away * away / (error * error);
            ++count;
        }
        size_t room = sizeof series->label;
        if (count > 0)
            length += snprintf(series->label + length, room - (size_t)length, ": misfit %.3g",
                               sqrt(sum / count));
        if (count > 0 && isfinite(parts))
            snprintf(series->label + length, room - (size_t)length, ", %.3g of its errors",
                     sqrt(parts / count));
    }

    // The ends of the axes were those of what was computed.
    widen(&plot->main.x, series->x, series->count);
    widen(&plot->main.y, series->y, series->count);
    widen(&plot->main.y, series->low, series->count);
    widen(&plot->main.y, series->high, series->count);
cleanup:
    csv_destroy(&table);
    error_context(err, "measurements");
    return error_is_clean(err);
}

bool plot_compare_write(const Plot *plot, const char *picture, Error *err)
{
    static const char *const plain[2] = {"x", "y"};
    char path[PATH_MAX];
    const char *dot = strrchr(picture, '.');
    if (!plot->computed) return true;
    const PlotSeries *series = &plot->main.series[plot->main.series_count - 1];
    int length = snprintf(path, sizeof path, "%.*s-compared.csv", (int)(dot - picture), picture);
    if (length >= (int)sizeof path) return REFUSE(err, "the picture's path is too long");
    CsvWriter *csv = csv_create(path, err);
    if (!csv) return false;
    for (int32_t c = 0; c < 2; ++c) csv_text(csv, plot->column[c][0] ? plot->column[c] : plain[c]);
    csv_text(csv, "error");
    csv_text(csv, "computed");
    csv_end_row(csv);
    for (int32_t k = 0; k < series->count; ++k) {
        csv_number(csv, series->x[k]);
        csv_number(csv, series->y[k]);
        csv_rounded(csv, (series->high[k] - series->low[k]) / 2);   // a difference: digits are lost
        csv_number(csv, plot->computed[k]);
        csv_end_row(csv);
    }
    return csv_finish(csv, err);
}
