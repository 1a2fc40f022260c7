// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/measured.h"

#include "base/memory.h"
#include "base/order.h"
#include "base/units.h"
#include "io/text/csv_reader.h"
#include "render/figures/figure_axes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 32, MARKS_FEW = 40 };

static const double MARK_SMALL = 0.45;   // of the radius of one among few
static const double WHOLE_CONTACT = 0.995;   // of L: a length of slip that is a sliding

static const Color MEASURED_COLOR = {0.80f, 0.36f, 0.00f, 1};

const MeasuredWords MEASURED_WORDS[MEASURED_KINDS] = {
    [MEASURED_MU] = {"U", "m", "F_T/F_N", NULL, "", "", 0},
    [MEASURED_FRONT] = {"U", "m", "x", "m", "L", " ~{L}", NUMBER_LENGTH},
    [MEASURED_AREA] = {"U", "m", "A/A_0", NULL, "", "", 0},
    [MEASURED_LENGTH] = {"F_T/F_N", NULL, "l", "m", "L", " ~{L}", NUMBER_LENGTH},
    [MEASURED_SPEED] = {"x", "m", "v", "m/s", "c_R", " ~{c}_{R}", NUMBER_C_RAYLEIGH},
    [MEASURED_PROBE] = {"U", "m", "value", NULL, "", "", 0}};

// Quantities by which a column may be divided, in the place of a unit.
static const struct {
    const char *name, *dimension;
    ResultNumber number;
} OVER[] = {{"L", "length", NUMBER_LENGTH},
            {"c_R", "velocity", NUMBER_C_RAYLEIGH},
            {"c_S", "velocity", NUMBER_C_SHEAR},
            {"c_L", "velocity", NUMBER_C_LONGITUDINAL},
            {"V", "velocity", NUMBER_ROD_VELOCITY}};

typedef struct Column {
    int32_t index;   // -1: there is none
    int32_t under;   // the column that this one is over; -1: none
    double factor;   // to the result's unit
} Column;

static const Column NONE = {-1, -1, 1};

// Finds how many of the result's units one such unit is. Normalised results have none: L_0, t_0,
// L_0/t_0 are 1.
static bool unit_factor(const CsvTable *table, const ResultView *view, CsvUnit unit,
                        const char *dimension, Column *column, Error *err)
{
    bool bare = unit.length == 0 || memchr(unit.text, '_', (size_t)unit.length);
    if (bare && !view->si) return true;
    if (bare)
        return csv_refuse(table, -1, column->index, err,
                          "needs a unit beside a result in SI, as in U (mm)");
    if (!csv_to_si(table, column->index, unit, dimension, &column->factor, err)) return false;
    return view->si ||
           csv_refuse(table, -1, column->index, err,
                      "has a unit, and the result is normalised: give it over a length or speed of "
                      "the result, as in U/L, x/L, v/c_R");
}

// `name` with a unit, or over what the result knows; once in the table.
static bool find_quantity(const CsvTable *table, const char *name, const char *dimension,
                          const ResultView *view, Column *column, Error *err)
{
    char over[NAME_SIZE];
    CsvUnit unit;
    Column found = NONE;
    *column = NONE;
    for (size_t k = 0; k < sizeof OVER / sizeof *OVER; ++k) {
        snprintf(over, sizeof over, "%s/%s", name, OVER[k].name);
        int32_t index = strcmp(OVER[k].dimension, dimension) == 0 ? csv_column(table, over) : -1;
        if (index < 0) continue;
        if (column->index >= 0)
            return csv_refuse(table, -1, index, err, "is %s a second time, beside %s", name,
                              csv_name(table, column->index));
        *column = (Column){index, -1, fabs(view->number[OVER[k].number])};
    }
    if (!csv_find(table, name, &found.index, &unit, err)) return false;
    if (found.index < 0) return true;
    if (column->index >= 0)
        return csv_refuse(table, -1, found.index, err, "is %s a second time, beside %s", name,
                          csv_name(table, column->index));
    *column = found;
    return unit_factor(table, view, unit, dimension, column, err);
}

// A number without a dimension, under one of two names.
static bool find_number(const CsvTable *table, const char *name, const char *other, Column *column,
                        Error *err)
{
    int32_t second = -1;
    CsvUnit unit, of_second = {"", 0};
    *column = NONE;
    if (!csv_find(table, name, &column->index, &unit, err)) return false;
    if (other && !csv_find(table, other, &second, &of_second, err)) return false;
    if (column->index >= 0 && second >= 0)
        return csv_refuse(table, -1, second, err, "is %s a second time", name);
    if (second >= 0) {
        column->index = second;
        unit = of_second;
    }
    return column->index < 0 || unit.length == 0 ||
           csv_to_si(table, column->index, unit, "1", &column->factor, err);
}

// mu or F_T/F_N; else F_T over F_N, both with a unit of the same kind or both without; else F_T in
// newtons over the load of the result.
static bool find_ratio(const CsvTable *table, const ResultView *view, Column *ratio, Error *err)
{
    char over[CSV_UNIT_SIZE], under[CSV_UNIT_SIZE];
    CsvUnit unit[2];
    if (!find_number(table, "mu", "F_T/F_N", ratio, err) || ratio->index >= 0)
        return error_is_clean(err);
    if (!csv_find(table, "F_T", &ratio->index, &unit[0], err) ||
        !csv_find(table, "F_N", &ratio->under, &unit[1], err))
        return false;

    // F_N of the whole block, N; NaN: in the plane its thickness is not known.
    bool space = view->number[NUMBER_FORMAT] > 1;
    double load = view->number[NUMBER_LOAD] * (space ? 1 : view->number[NUMBER_THICKNESS]);
    if (ratio->index >= 0 && ratio->under < 0 && view->si && load > 0) {
        if (!csv_to_si(table, ratio->index, unit[0], "force", &ratio->factor, err)) return false;
        ratio->factor /= load;
        return true;
    }
    if (ratio->index < 0 || ratio->under < 0) {
        *ratio = NONE;
        return true;
    }
    if (unit[0].length == 0 && unit[1].length == 0) return true;
    snprintf(over, sizeof over, "%.*s", unit[0].length, unit[0].text);
    snprintf(under, sizeof under, "%.*s", unit[1].length, unit[1].text);
    return unit_ratio(over, under, &ratio->factor) ||
           csv_refuse(table, -1, ratio->under, err,
                      "cannot stand under %s: both need units of the same kind, as in F_T (N) and "
                      "F_N (kN), or none",
                      csv_name(table, ratio->index));
}

// All that a file may hold.
typedef struct Columns {
    Column U, t, ratio, x, area, length, speed;
    Column probe;   // the first of those of probes, and its quantity
    ProbeQuantity quantity;
} Columns;

// The column of component c of a probe, as in figures/probes.csv: "gauge1 strain_xx". Strain is a
// number, a percentage, or in millionths, as gauges are read.
static bool find_probe(const CsvTable *table, const ResultView *view, ProbeQuantity quantity,
                       int32_t probe, int32_t c, Column *column, Error *err)
{
    static const char *const dimensions[PROBE_QUANTITY_COUNT] = {
        [PROBE_STRESS] = "stress", [PROBE_DISPLACEMENT] = "length", [PROBE_VELOCITY] = "velocity"};
    static const char *const millionths[] = {"um/m",  "\u00b5m/m", "\u03bcm/m",  "1e-6",
                                             "10^-6", "ustrain",   "microstrain"};
    char name[PROBE_COLUMN_SIZE];
    CsvUnit unit;
    *column = NONE;
    probe_column(view, probe, quantity, c, name);
    if (!csv_find(table, name, &column->index, &unit, err)) return false;
    if (column->index < 0) return true;
    if (quantity != PROBE_STRAIN)
        return unit_factor(table, view, unit, dimensions[quantity], column, err);
    for (size_t k = 0; k < sizeof millionths / sizeof *millionths; ++k)
        if (strlen(millionths[k]) == (size_t)unit.length &&
            strncmp(millionths[k], unit.text, (size_t)unit.length) == 0) {
            column->factor = 1e-6;
            return true;
        }
    return unit.length == 0 || csv_to_si(table, column->index, unit, "1", &column->factor, err);
}

// Chooses the columns that `kind` has: over what, and the value. false: the file does not have it.
static bool choose(const Columns *found, MeasuredKind kind, Column *at, Column *value)
{
    const Column moment = found->U.index >= 0 ? found->U : found->t;
    const Column ats[MEASURED_KINDS] = {moment, moment, moment, found->ratio, found->x, moment};
    const Column values[MEASURED_KINDS] = {found->ratio,  found->x,     found->area,
                                           found->length, found->speed, found->probe};
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

// The errors of a value, in a unit of their own or in that of the value.
static bool find_error(const CsvTable *table, const Column *value, Column *error, Error *err)
{
    CsvUnit unit, own;
    char of_error[CSV_UNIT_SIZE], of_value[CSV_UNIT_SIZE];
    int32_t length = 0;
    double ratio = 1;
    *error = NONE;
    if (value->under >= 0) {   // of a ratio of two columns
        error->index = csv_column(table, "error");
        return csv_check(table, error->index, true, err);
    }
    csv_find_error(table, value->index, &error->index, &unit);
    if (error->index < 0) return true;
    csv_split(table, value->index, &length, &own);
    snprintf(of_error, sizeof of_error, "%.*s", unit.length, unit.text);
    snprintf(of_value, sizeof of_value, "%.*s", own.length, own.text);
    if (*of_error && *of_value && !unit_ratio(of_error, of_value, &ratio))
        return csv_refuse(table, -1, error->index, err, "has `%s`, and its values have `%s`",
                          of_error, of_value);
    error->factor = value->factor * ratio;
    return csv_check(table, error->index, true, err);
}

static bool make_lists(Measured *measured, int64_t room, Error *err)
{
    double **lists[] = {&measured->at, &measured->x, &measured->value, &measured->error,
                        &measured->computed};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; ++k)
        if (!(*lists[k] = NEW_ARRAY(double, room, err))) return false;
    return true;
}

// Adds the rows of two columns that have both numbers. id: of a probe's column; -1: the column x is
// read instead. A column `event` says what a row belongs to, as in figures/precursors.csv and
// front-speed.csv. Speeds of precursors stand beside no sliding; the farthest slip so far stands
// beside no event, where the table has events.
static bool take_points(const CsvTable *table, const Columns *found, const Column *at,
                        const Column *value, int32_t id, const ResultView *view, Measured *measured,
                        Error *err)
{
    const ViewCurve way = {view->rows, view->t, view->U};
    MeasuredKind kind = measured->kind;
    Column error;
    int32_t events = csv_column(table, "event");
    bool has_events = false;
    if (!find_error(table, value, &error, err)) return false;
    for (int32_t row = 0; row < table->rows; ++row)
        if (strcmp(csv_cell(table, row, events), MEASURED_FARTHEST) != 0) has_events = true;
    for (int32_t row = 0; row < table->rows; ++row) {
        int32_t k = measured->count;
        double moment = read_cell(table, row, at), number = read_cell(table, row, value);
        measured->at[k] = at->index == found->t.index ? curve_value(&way, moment) : moment;
        measured->x[k] = id >= 0 ? id : read_cell(table, row, &found->x);
        measured->value[k] = kind == MEASURED_SPEED ? fabs(number) : number;
        measured->error[k] = read_cell(table, row, &error);
        measured->computed[k] = NAN;
        const char *event = csv_cell(table, row, events);
        bool shown = kind != MEASURED_AREA || isfinite(measured->x[k]);
        if (kind == MEASURED_SPEED) shown = !*event || strcmp(event, VIEW_WORD_SLIDING) == 0;
        if (kind == MEASURED_LENGTH && strcmp(event, MEASURED_FARTHEST) == 0) shown = !has_events;
        if (isfinite(measured->at[k] + number) && shown) ++measured->count;
    }
    return true;
}

// Adds the rows of the columns that the kind has, of probes all columns of one quantity.
static bool take_rows(const CsvTable *table, const Columns *found, const ResultView *view,
                      Measured *measured, Error *err)
{
    Column at, value;
    int32_t components = probe_components(view, found->quantity);
    if (!choose(found, measured->kind, &at, &value)) return true;
    if (!make_lists(measured, (int64_t)table->rows * table->columns, err)) return false;
    measured->quantity = found->quantity;
    if (measured->kind != MEASURED_PROBE)
        return take_points(table, found, &at, &value, -1, view, measured, err);
    for (int32_t k = 0; k < view->probes * components; ++k) {
        int32_t probe = k / components, c = k % components, id = PROBE_COMPONENTS_MAX * probe + c;
        if (!find_probe(table, view, found->quantity, probe, c, &value, err)) return false;
        if (value.index < 0) continue;
        if (!csv_check(table, value.index, false, err) ||
            !take_points(table, found, &at, &value, id, view, measured, err))
            return false;
    }
    return true;
}

static bool read_table(const char *path, const ResultView *view, CsvTable *table, Columns *found,
                       Error *err)
{
    if (!csv_read(path, table, err)) return false;
    TRY(find_ratio(table, view, &found->ratio, err) &&
        find_quantity(table, "U", "length", view, &found->U, err) &&
        find_quantity(table, "t", "time", view, &found->t, err) &&
        find_quantity(table, "x", "length", view, &found->x, err) &&
        find_number(table, "A/A_0", NULL, &found->area, err) &&
        find_quantity(table, "l", "length", view, &found->length, err) &&
        find_quantity(table, "v", "velocity", view, &found->speed, err));

    // The first column of a probe, whose quantity is that of all.
    found->probe = NONE;
    for (int32_t q = 0; q < PROBE_QUANTITY_COUNT && found->probe.index < 0; ++q) {
        found->quantity = (ProbeQuantity)q;
        int32_t components = probe_components(view, found->quantity);
        for (int32_t k = 0; k < view->probes * components && found->probe.index < 0; ++k)
            TRY(find_probe(table, view, found->quantity, k / components, k % components,
                           &found->probe, err));
    }

    bool any = false;
    for (int32_t kind = 0; kind < MEASURED_KINDS; ++kind) {
        Column at, value;
        any = any || choose(found, (MeasuredKind)kind, &at, &value);
    }
    if (!any)
        FAIL(err, ERROR_INPUT,
             "%s: it needs the columns U (or t) and mu, F_T/F_N, F_T and F_N, or F_T in newtons "
             "where the scene has its `thickness`; U and x; U, x and A/A_0; F_T/F_N and l; x and "
             "v; or U and those of probes of the result, as gauge1 strain_xx. A column called "
             "`force` alone may be either force: call it F_T",
             path);
    if (table->rows == 0)
        FAIL(err, ERROR_INPUT, "%s: below the names of its columns there is no row", path);
    const Column *const columns[] = {&found->U,    &found->t,      &found->ratio, &found->x,
                                     &found->area, &found->length, &found->speed};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; ++k)
        TRY(csv_check(table, columns[k]->index, false, err));
    TRY(csv_check(table, found->ratio.under, true, err));
cleanup:
    error_context(err, "measurements");
    return error_is_clean(err);
}

// Sets beside each measured length that of the precursor whose load is nearest, whose load becomes
// `x`; no farther from it than neighbouring precursors are apart. What slipped over the whole
// contact is a sliding, and stands beside one. Without precursors nothing is done.
static bool match_events(Measured *measured, ResultView *view, Error *err)
{
    ViewCurve precursors = {0}, slidings = {0};
    double gap = 0;
    TRY(computed_events(view, VIEW_BOUNDED, &precursors, err));
    TRY(computed_events(view, VIEW_LEADING, &slidings, err));

    // gap: how far the loads of neighbouring events lie apart at most; infinite: there is one.
    double *loads = NEW_ARRAY(double, precursors.count, err);
    gap = precursors.count > 1 ? 0 : INFINITY;
    TRY(loads);
    for (int64_t k = 0; k < precursors.count; ++k) loads[k] = precursors.at[k];
    qsort(loads, (size_t)precursors.count, sizeof *loads, order_doubles);
    for (int64_t k = 0; k + 1 < precursors.count; ++k) gap = fmax(gap, loads[k + 1] - loads[k]);
    memory_free(loads);

    measured->matched = precursors.count > 0;
    for (int32_t k = 0; k < measured->count && measured->matched; ++k) {
        bool whole = measured->value[k] >= WHOLE_CONTACT * view->number[NUMBER_LENGTH];
        const ViewCurve *events = whole ? &slidings : &precursors;
        double nearest = whole ? INFINITY : nextafter(gap, INFINITY);
        for (int64_t i = 0; i < events->count; ++i) {
            double away = fabs(events->at[i] - measured->at[k]);
            if (!(away < nearest)) continue;
            nearest = away;
            measured->x[k] = events->at[i];
            measured->computed[k] = events->value[i];
        }
    }
cleanup:
    memory_free_all(precursors.at, precursors.value, slidings.at, slidings.value);
    return error_is_clean(err);
}

// Computes what the result has where each measurement lies, and the misfit.
static bool compare(Measured *measured, ResultView *view, Error *err)
{
    ViewCurve curve = {0};
    double *values = NULL;   // of the probes
    bool probe = measured->kind == MEASURED_PROBE, area = measured->kind == MEASURED_AREA;
    int32_t components = probe ? probe_components(view, measured->quantity) : 0;
    int64_t stride = (int64_t)components * view->probes;
    if (probe) TRY(probe_read(view, measured->quantity, &values, err));
    if (area) TRY(computed_area_read(view, err) && result_view_read_status(view, err));
    if (measured->kind == MEASURED_LENGTH) TRY(match_events(measured, view, err));
    TRY(computed_curve(view, measured->kind, &curve, err));
    for (int32_t k = 0; k < measured->count && !measured->matched; ++k) {
        double at = measured->at[k], *computed = &measured->computed[k];
        if (probe) {
            // Linear between steps.
            int32_t id = (int32_t)measured->x[k];
            if (!(at >= view->U[0] && at <= view->U[view->rows - 1])) continue;
            int64_t row = curve_place(view->U, view->rows, at);
            double span = view->U[row + 1] - view->U[row];
            double part = span > 0 ? (at - view->U[row]) / span : 1;
            const double *now = values + row * stride + (id / PROBE_COMPONENTS_MAX) * components +
                                id % PROBE_COMPONENTS_MAX;
            *computed = now[0] + part * (now[stride] - now[0]);
        } else if (area) {
            *computed = computed_area(view, at, measured->x[k]);
        } else if (measured->kind == MEASURED_SPEED) {
            *computed = computed_speed(view, &curve, at);
        } else {
            *computed = curve_value(&curve, at);
        }
    }

    // Computes the misfit, and says in words what it is.
    double sum = 0, parts = 0;
    int32_t count = 0;
    const MeasuredWords *words = &MEASURED_WORDS[measured->kind];
    for (int32_t k = 0; k < measured->count; ++k) {
        double away = measured->value[k] - measured->computed[k];
        if (!isfinite(away)) continue;
        sum += away * away;
        parts += away * away / (measured->error[k] * measured->error[k]);
        ++count;
    }
    measured->compared = count;
    measured->misfit = measured->in_errors = NAN;
    if (count == 0) goto cleanup;
    size_t length = strlen(measured->words);
    double misfit = sqrt(sum / count) / (*words->over ? view->number[words->number] : 1);
    measured->misfit = misfit;
    if (isfinite(parts)) measured->in_errors = sqrt(parts / count);
    length += (size_t)snprintf(measured->words + length, sizeof measured->words - length,
                               ": misfit %.3g%s", misfit, words->over_words);
    if (isfinite(parts))
        snprintf(measured->words + length, sizeof measured->words - length, ", %.3g of its errors",
                 sqrt(parts / count));
cleanup:
    memory_free(values);
    return error_is_clean(err);
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

void measured_draw(const Page *page, const Measured *measured, int32_t component, const Axes *axes)
{
    bool probes = component >= 0;
    bool many = measured->count > MARKS_FEW;   // a halo each would hide the curve below
    double radius = KEY_RADIUS * page->point * (many ? MARK_SMALL : 1);
    canvas_clip(page->canvas, &axes->box);
    for (int32_t k = 0; k < measured->count; ++k) {
        int32_t id = probes ? (int32_t)measured->x[k] : 0;
        if (probes && id % PROBE_COMPONENTS_MAX != component) continue;
        Stroke stroke = {.color = probes ? stack_color(id / PROBE_COMPONENTS_MAX) : MEASURED_COLOR,
                         .width = 0.5 * page->point};
        double at = measured->at[k], value = measured->value[k], error = measured->error[k];
        if (isfinite(error))
            draw_segment(page->canvas, &stroke, axes_place(axes, at, value - error),
                         axes_place(axes, at, value + error));
        if (!probes && !many)
            draw_disc(page->canvas, PAPER, axes_place(axes, at, value), 1.25 * radius);
        draw_disc(page->canvas, stroke.color, axes_place(axes, at, value), radius);
    }
    canvas_clip(page->canvas, NULL);
}

void measured_destroy(Measured *measured)
{
    memory_free_all(measured->at, measured->x, measured->value, measured->error,
                    measured->computed);
    *measured = (Measured){0};
}
