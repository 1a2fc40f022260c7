// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/fit_figures.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "study/search/search_figure.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PROFILE_POINTS = 81, REGION_POINTS = 97, PAIRS_KEYS_MAX = 4, CURVES_MAX = 6 };
static const char SERIES[] = "series/";
static const double BESIDE = 0.05;   // of the data's range, shown of a run's curve on either side
static const double BEYOND = 0.6;   // of a region's width that its figure shows on either side

// --- profiles -----------------------------------------------------------------------------------

// From the best outwards, so that each place begins beside the last.
static void fill_profile(const Fit *fit, int32_t k, double *x, double *y)
{
    const Region *region = &fit->regions[k];
    double wide = region->high - region->low, from = fmax(0, region->low - BEYOND * wide);
    double to = fmin(1, region->high + BEYOND * wide);
    int32_t middle = (int32_t)((fit->best[k] - from) / (to - from) * (PROFILE_POINTS - 1));
    bool fixed[STUDY_SEARCH_MAX] = {0};
    fixed[k] = true;
    for (int way = -1; way <= 1; way += 2) {
        double place[STUDY_SEARCH_MAX];
        memcpy(place, fit->best, sizeof place);
        for (int32_t i = way < 0 ? middle : middle + 1; i >= 0 && i < PROFILE_POINTS; i += way) {
            place[k] = from + (to - from) * i / (PROFILE_POINTS - 1);
            x[i] = fit_unscaled(fit, k, place[k]);
            y[i] = response_least(&fit->response, fixed, place) - fit->misfit;
        }
    }
}

// Designs that lie in the frame.
static int32_t fill_designs(const Fit *fit, int32_t k, const double *x, double top, double *at,
                            double *above)
{
    const Designs *designs = &fit->search.designs;
    int32_t n = fit->response.keys, count = 0;
    for (int32_t d = 0; d < designs->count; d++) {
        double place[STUDY_SEARCH_MAX], value = designs->list[d].x[k];
        if (isnan(designs->list[d].value) || value < x[0] || value > x[PROFILE_POINTS - 1])
            continue;
        for (int32_t i = 0; i < n; i++) place[i] = fit_scaled(fit, i, designs->list[d].x[i]);
        double misfit = response_misfit(&fit->response, place) - fit->misfit;
        if (misfit > top) continue;
        at[count] = value;
        above[count++] = misfit;
    }
    return count;
}

static bool draw_profile(const Fit *fit, int32_t k, Error *err)
{
    char name[STUDY_NAME_SIZE + 8], label[60];
    double x[PROFILE_POINTS], y[PROFILE_POINTS], limit[2], ends[2];
    double *at = NEW_ARRAY(double, 2 * (int64_t)fit->search.designs.count, err);
    TRY(at);
    double *above = at + fit->search.designs.count;
    fill_profile(fit, k, x, y);
    ends[0] = x[0], ends[1] = x[PROFILE_POINTS - 1];
    limit[0] = limit[1] = fit_threshold(fit, 1);
    int32_t count = fill_designs(fit, k, x, 3 * limit[0], at, above);
    snprintf(name, sizeof name, "profile_%s", fit->search.study->search.keys[k].key);
    snprintf(label, sizeof label, "below: %.0f %% sure", 100 * fit->search.study->search.sure);
    Curve curves[] = {search_dots("designs, other keys as they are", count, at, above),
                      search_line("least over the other keys", PROFILE_POINTS, x, y),
                      search_line(label, 2, ends, limit)};
    curves[2].line = "dashed";
    curves[2].color = COLOR_BEST;
    Frame frame = {name,
                   search_key_scale(&fit->search, k),
                   "linear",
                   search_key_label(&fit->search, k),
                   {.words = "misfit above its least"}};
    TRY(search_draw(&fit->search, &frame, count ? curves : curves + 1, count ? 3 : 2, err));
cleanup:
    memory_free(at);
    return error_is_clean(err);
}

// --- regions of two keys ------------------------------------------------------------------------

// Directions that a circle of `cos` and `sin` turns into the ellipse of the curvature; else the
// regions' widths.
static void find_axes(const Fit *fit, const int32_t keys[2], double axes[2][2])
{
    double inverse[STUDY_SEARCH_MAX * STUDY_SEARCH_MAX];
    int32_t n = fit->response.keys, a = keys[0], b = keys[1];
    memset(axes, 0, 4 * sizeof axes[0][0]);
    axes[0][0] = fit->regions[a].high - fit->regions[a].low;
    axes[1][1] = fit->regions[b].high - fit->regions[b].low;
    response_curvature(&fit->response, fit->best, inverse);
    if (!dense_cholesky(inverse, n) || !dense_invert_factored(inverse, n)) return;
    double first = sqrt(inverse[a * n + a]), both = inverse[a * n + b] / first;
    double second = inverse[b * n + b] - both * both;
    if (!(second > 0)) return;
    axes[0][0] = first;
    axes[0][1] = both;
    axes[1][1] = sqrt(second);
}

static bool draw_region(const Fit *fit, const int32_t keys[2], Error *err)
{
    const double full = 6.283185307179586;
    double x[REGION_POINTS], y[REGION_POINTS], best[2], axes[2][2];
    double most = fit->misfit + fit_threshold(fit, 2);
    char name[2 * STUDY_NAME_SIZE + 10], label[60];
    find_axes(fit, keys, axes);
    for (int32_t i = 0; i < REGION_POINTS; i++) {
        double angle = full * i / (REGION_POINTS - 1), ray[STUDY_SEARCH_MAX] = {0};
        double place[STUDY_SEARCH_MAX];
        for (int32_t k = 0; k < 2; k++)
            ray[keys[k]] = cos(angle) * axes[0][k] + sin(angle) * axes[1][k];
        for (int32_t k = 0; k < 2; k++)   // held, too, where it does not move
            if (ray[keys[k]] == 0) ray[keys[k]] = DBL_MIN;
        fit_walk(fit, ray, most, place);
        x[i] = fit_unscaled(fit, keys[0], place[keys[0]]);
        y[i] = fit_unscaled(fit, keys[1], place[keys[1]]);
    }
    for (int32_t i = 0; i < 2; i++) best[i] = fit_unscaled(fit, keys[i], fit->best[keys[i]]);
    snprintf(name, sizeof name, "region_%s_%s", fit->search.study->search.keys[keys[0]].key,
             fit->search.study->search.keys[keys[1]].key);
    snprintf(label, sizeof label, "%.0f %% sure, both together",
             100 * fit->search.study->search.sure);
    Curve curves[] = {search_line(label, REGION_POINTS, x, y),
                      search_dots("best", 1, &best[0], &best[1])};
    curves[1].marker = "square";
    curves[1].color = COLOR_BEST;
    Frame frame = {name, search_key_scale(&fit->search, keys[0]),
                   search_key_scale(&fit->search, keys[1]), search_key_label(&fit->search, keys[0]),
                   search_key_label(&fit->search, keys[1])};
    return search_draw(&fit->search, &frame, curves, 2, err);
}

// --- found beside measured ----------------------------------------------------------------------

// Where a datum was measured: along its curve, or by the one key that is its condition. key: out,
// what that is. false: it is neither.
static bool find_place(const Fit *fit, int32_t datum, double *x, char key[STUDY_NAME_SIZE])
{
    const Datum *one = &fit->measured.list[datum];
    const char *condition = fit->measured.conditions[one->condition];
    const char *colon = strstr(condition, ": ");
    *x = one->at;
    snprintf(key, STUDY_NAME_SIZE, "%s", one->along);
    if (*one->along) return true;
    if (!colon || strchr(condition, ',') || colon - condition >= STUDY_NAME_SIZE) return false;
    snprintf(key, STUDY_NAME_SIZE, "%.*s", (int)(colon - condition), condition);
    int32_t length = text_number(colon + 2, x);
    const char *unit = colon + 2 + length + strspn(colon + 2 + length, " ");
    return length > 0 && (!*unit || unit_to_si(unit, NULL, x));
}

// One result over the one thing that differs; curves under one condition.
static bool has_places(const Fit *fit, double *x, char key[STUDY_NAME_SIZE])
{
    char other[STUDY_NAME_SIZE];
    const Measurements *measured = &fit->measured;
    for (int32_t k = 0; k < measured->count; k++) {
        if (!find_place(fit, k, &x[k], k ? other : key)) return false;
        if (strcmp(measured->list[k].name, measured->list[0].name) != 0) return false;
        if (k && strcmp(key, other) != 0) return false;
        if (*measured->list[k].along && measured->condition_count > 1) return false;
    }
    return measured->count > 0;
}

static bool draw_places(const Fit *fit, const double *x, const char *key, Error *err)
{
    int32_t count = fit->measured.count;
    double *room = NEW_ARRAY(double, 3 * (int64_t)count, err);
    TRY(room);
    double *value = room, *error = room + count, *found = error + count;
    for (int32_t k = 0; k < count; k++) {
        value[k] = fit->measured.list[k].value;
        error[k] = fit->measured.list[k].error;
        found[k] = response_at(&fit->response, k, fit->best);
    }
    Curve curves[] = {search_dots("measured, with one error", count, x, value),
                      search_dots("found, at the best", count, x, found)};
    curves[0].error = error;
    curves[1].marker = "square";
    curves[1].color = COLOR_BEST;
    bool is_si = fit->search.sweep->scene->units == UNITS_SI;
    bool is_series = strncmp(key, "series/", 7) == 0;
    Frame frame = {"measured", "linear", "linear", label_of_key(key, is_si),
                   label_of_record(fit->measured.list[0].name)};
    if (is_series) {
        frame.x = (QuantityLabel){0};
        snprintf(frame.x.words, sizeof frame.x.words, "%.60s (%s)", key + 7,
                 is_si ? "SI" : "normalised");
        snprintf(frame.y.words, sizeof frame.y.words, "%.60s", fit->measured.list[0].name + 7);
    }
    TRY(search_draw(&fit->search, &frame, curves, 2, err));
cleanup:
    memory_free(room);
    return error_is_clean(err);
}

// Draws the measurements over their condition. If there are several results, or conditions of
// several keys, it draws how far each measurement is off.
static bool draw_measured(const Fit *fit, Error *err)
{
    int32_t count = fit->measured.count;
    char key[STUDY_NAME_SIZE];
    double *room = NEW_ARRAY(double, 3 * (int64_t)count, err);
    TRY(room);
    double *number = room, *off = room + count, *error = off + count;
    if (has_places(fit, number, key)) {
        TRY(draw_places(fit, number, key, err));
        goto cleanup;
    }
    for (int32_t k = 0; k < count; k++) {
        number[k] = k + 1;
        off[k] = fit_errors_off(fit, k);
        error[k] = 1;
    }
    double ends[] = {0, count + 1}, none[] = {0, 0};
    Curve curves[] = {search_line("measured", 2, ends, none),
                      search_dots("found, with one error", count, number, off)};
    curves[1].error = error;
    Frame frame = {"measured",
                   "linear",
                   "linear",
                   {.words = "measurement, in the order of fit.csv"},
                   {.words = "found less measured, over the error"}};
    TRY(search_draw(&fit->search, &frame, curves, 2, err));
cleanup:
    memory_free(room);
    return error_is_clean(err);
}

// --- the best curves on the data -----------------------------------------------------------------

// Whether a datum lies on the curve of datum `first`, under the same condition.
static bool is_on_curve(const Datum *datum, const Datum *first, bool under_same)
{
    return strcmp(datum->along, first->along) == 0 && strcmp(datum->name, first->name) == 0 &&
           (!under_same || datum->condition == first->condition);
}

// Measurements on the curve of datum `first`: place, value, error. Returns how many.
static int32_t fill_data(const Fit *fit, const Datum *first, double *x, double *y, double *error)
{
    int32_t count = 0;
    for (int32_t k = 0; k < fit->measured.count; k++) {
        const Datum *one = &fit->measured.list[k];
        if (!is_on_curve(one, first, true)) continue;
        x[count] = one->at;
        y[count] = one->value;
        error[count++] = one->error;
    }
    return count;
}

// Keeps of a run's curve what lies over the data, and a little beside them.
static int32_t crop(const double *at, int32_t data, double *x, double *y, int64_t rows)
{
    double low = INFINITY, high = -INFINITY;
    int32_t kept = 0;
    for (int32_t k = 0; k < data; k++) {
        low = fmin(low, at[k]);
        high = fmax(high, at[k]);
    }
    double beside = BESIDE * (high > low ? high - low : fabs(high));
    for (int64_t k = 0; k < rows; k++) {
        if (!(x[k] >= low - beside && x[k] <= high + beside)) continue;
        x[kept] = x[k];
        y[kept++] = y[k];
    }
    return kept;
}

// Draws measured curves with the whole curves of the best design's runs over them, which are no
// polynomials.
static bool draw_fitted(const Fit *fit, Error *err)
{
    int32_t first[CURVES_MAX], count = 0, best = designs_best(&fit->search.designs), used = 0;
    int64_t data = fit->measured.count;
    double *x[CURVES_MAX] = {0}, *y[CURVES_MAX] = {0}, *room = NULL;
    Curve curves[2 * CURVES_MAX];
    char history[POINT_PATH_SIZE + 16];

    // The first datum of each curve of the same two series, one a condition, in first [count]: at
    // most CURVES_MAX of them. Nothing was measured along a series: count is 0.
    const Measurements *measured = &fit->measured;
    count = 0;
    for (int32_t k = 0; k < measured->count && count < CURVES_MAX; k++) {
        const Datum *one = &measured->list[k];
        bool is_new = strncmp(one->along, SERIES, strlen(SERIES)) == 0 &&
                      (count == 0 || is_on_curve(one, &measured->list[first[0]], false));
        for (int32_t i = 0; i < count && is_new; i++)
            is_new = !is_on_curve(one, &measured->list[first[i]], true);
        if (is_new) first[count++] = k;
    }

    if (count == 0 || best < 0) return true;
    TRY(room = NEW_ARRAY(double, 3 * data, err));
    double *at = room, *value = room + data, *error = room + 2 * data;
    for (int32_t k = 0; k < count; k++) {
        const Datum *one = &fit->measured.list[first[k]];
        int64_t rows = 0;
        int32_t points = fill_data(fit, one, at + used, value + used, error + used);
        point_path(fit->search.sweep, fit->search.designs.list[best].point + one->condition,
                   "history.h5", history);
        TRY(measurements_curve(one, history, &x[k], &y[k], &rows, err));
        int32_t kept = crop(at + used, points, x[k], y[k], rows);
        const char *condition = fit->measured.conditions[one->condition];
        curves[k] = search_dots("measured, with one error", points, at + used, value + used);
        curves[k].error = error + used;
        if (count > 1 && *condition) curves[k].label = condition;
        curves[count + k] = search_line(k == 0 ? "run of the best design" : "", kept, x[k], y[k]);
        curves[k].color = curves[count + k].color = count > 1 ? k : COLOR_DESIGNS;
        if (count == 1) curves[count + k].color = COLOR_BEST;
        used += points;
    }
    const Datum *one = &fit->measured.list[first[0]];
    const char *units = fit->search.sweep->scene->units == UNITS_SI ? "SI" : "normalised";
    Frame frame = {.name = "fitted", .x_scale = "linear", .y_scale = "linear"};
    snprintf(frame.x.words, sizeof frame.x.words, "%.60s (%s)", one->along + strlen(SERIES), units);
    snprintf(frame.y.words, sizeof frame.y.words, "%.60s", one->name + strlen(SERIES));
    TRY(search_draw(&fit->search, &frame, curves, 2 * count, err));
cleanup:
    memory_free_list((void *const *)x, CURVES_MAX);
    memory_free_list((void *const *)y, CURVES_MAX);
    memory_free(room);
    return error_is_clean(err);
}

bool fit_figures(const Fit *fit, Error *err)
{
    int32_t n = fit->response.keys;
    if (!draw_measured(fit, err) || !draw_fitted(fit, err)) return false;
    for (int32_t k = 0; k < n; k++)
        if (!draw_profile(fit, k, err)) return false;
    for (int32_t k = 0; k < n && n <= PAIRS_KEYS_MAX; k++)
        for (int32_t i = k + 1; i < n; i++)
            if (!draw_region(fit, (int32_t[2]){k, i}, err)) return false;
    return true;
}
