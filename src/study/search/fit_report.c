// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/fit.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "io/text/csv_writer.h"
#include "study/search/search_answer.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WORST_SHOWN = 3 };
static const double OFF = 2;   // errors, from which on a measurement is said not to fit
static const double HARDLY = 0.5;   // of ln of a combination of keys: known to no more than that

enum { PROFILE_POINTS = 81, REGION_POINTS = 97, PAIRS_KEYS_MAX = 4, CURVES_MAX = 6 };
static const char SERIES[] = "series/";
static const double BESIDE = 0.05;   // of the data's range, shown of a run's curve on either side
static const double BEYOND = 0.6;   // of a region's width that its figure shows on either side

// --- which combinations are known ---------------------------------------------------------------

// d ln key / d scaled, at the best; 0: the key is not above 0 there.
static double log_slope(const Fit *fit, int32_t k)
{
    const SearchKey *key = &fit->search.study->search.keys[k];
    double at = fit_unscaled(fit, k, fit->best[k]);
    if (key->scale == SEARCH_LOG) return log(key->most / key->least);
    return at > 0 ? (key->most - key->least) / at : 0;
}

// Products of powers of the keys, by how well they are known: eigenvectors of the curvature in
// logarithms.
static void print_combinations(const Fit *fit, FILE *out)
{
    int32_t n = fit->response.keys;
    double matrix[STUDY_SEARCH_MAX * STUDY_SEARCH_MAX], values[STUDY_SEARCH_MAX];
    double work[DENSE_EIGEN_WORK(STUDY_SEARCH_MAX)];
    if (n < 2) return;
    response_curvature(&fit->response, fit->best, matrix);
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = 0; k < n; k++) {
            if (log_slope(fit, k) == 0) return;
            matrix[i * n + k] /= log_slope(fit, i) * log_slope(fit, k);
        }
    if (!dense_eigen(matrix, n, values, work)) return;
    for (int32_t k = n - 1; k >= 0; k--) {
        double *vector = &matrix[k * n], largest = 0;
        for (int32_t i = 0; i < n; i++)
            if (fabs(vector[i]) > fabs(largest)) largest = vector[i];
        double error = sqrt(fit_threshold(fit, 1) / fmax(values[k], 0)) / fabs(largest);
        for (int32_t i = 0; i < n; i++) vector[i] /= largest;
        fprintf(out, k == n - 1 ? "  the data know " : k > 0 ? ", " : " and ");

        // "material.eta1 * friction.critical_velocity^-0.94": parts below a twentieth are left out.
        int32_t shown = 0;
        for (int32_t i = 0; i < n; i++) {
            double power = round(100 * vector[i]) / 100;
            if (fabs(power) < 0.05) continue;
            fprintf(out, "%s%s", shown++ ? " * " : "", fit->search.study->search.keys[i].key);
            if (power != 1) fprintf(out, "^%.2g", power);
        }
        fprintf(out, " ");
        if (error < HARDLY)
            fprintf(out, "to %.2g %%", 100 * error);
        else
            fprintf(out, error < 10 ? "to a factor of %.2g" : "not at all", exp(error));
        if (k == 0 && error >= HARDLY) fprintf(out, ": they do not tell these apart");
    }
    fprintf(out, "\n");
}

// --- words --------------------------------------------------------------------------------------

static void print_answer(const Fit *fit, const FitSummary *summary, FILE *out)
{
    int32_t freedom = fit_freedom(fit), best = designs_best(&fit->search.designs);
    char words[OPTIMISE_WORDS_SIZE];
    fprintf(out, "%d measurements, %d keys, %d designs: misfit %.4g", summary->measurements,
            summary->parameter_count, summary->designs, summary->misfit);
    if (freedom > 0)
        fprintf(out, " (%d +- %.1f where scene and errors are right)", freedom,
                sqrt(2.0 * freedom));
    fprintf(out, "\n");
    for (int32_t k = 0; k < summary->parameter_count; k++) {
        const FitParameter *parameter = &summary->parameters[k];
        bool open = parameter->low_open || parameter->high_open;
        if (parameter->low_open && parameter->high_open)
            fprintf(out, "  %s: anything from %.4g to %.4g fits\n", parameter->key, parameter->low,
                    parameter->high);
        else
            fprintf(out, "  %s: %.4g, %.0f %% from %.4g to %.4g%s\n", parameter->key,
                    parameter->value, 100 * fit->search.study->search.sure, parameter->low,
                    parameter->high, open ? ", an end of the range: it may be beyond" : "");
    }
    print_combinations(fit, out);

    // The measurements that are off, the worst first.
    double before = INFINITY;
    int32_t count = 0, off = 0;
    for (int32_t k = 0; k < fit->measured.count; k++) off += fabs(fit_errors_off(fit, k)) > OFF;
    fprintf(
        out,
        "  %d of %d measurements are off by more than %g errors (1 in 20 is to be expected)%s\n",
        off, fit->measured.count, OFF, off ? ":" : "");
    while (count < WORST_SHOWN) {
        int32_t worst = -1;
        for (int32_t k = 0; k < fit->measured.count; k++) {
            double by = fabs(fit_errors_off(fit, k));
            if (by < before && by > OFF && (worst < 0 || by > fabs(fit_errors_off(fit, worst))))
                worst = k;
        }
        if (worst < 0) break;
        const Datum *datum = &fit->measured.list[worst];
        const char *condition = fit->measured.conditions[datum->condition];
        fprintf(out, "    %s%s%s", condition, *condition ? ": " : "", datum->name);
        if (*datum->along) fprintf(out, " at %s = %.4g", datum->along, datum->at);
        fprintf(out, " measured %.4g +- %.2g, found %.4g: off by %.1f errors\n", datum->value,
                datum->error, response_at(&fit->response, worst, fit->best),
                fabs(fit_errors_off(fit, worst)));
        before = fabs(fit_errors_off(fit, worst));
        count++;
    }

    if (summary->widened > 1)
        fprintf(out, "  regions are %.2g times as wide as the errors make them, as the misfit is\n",
                summary->widened);
    fprintf(out, "  %.2g %% of the errors' squares are the program's own%s\n",
            100 * summary->own_share,
            summary->own_share > 0.2 ? "; a smaller accuracy.mu makes regions smaller" : "");
    search_print_exhausted(&fit->search, out);
    if (fit->search.refused > 0)
        fprintf(out, "  %d more designs have no scene, the first: %s\n", fit->search.refused,
                fit->search.refusal.message);
    if (fit->search.designs.count > summary->designs)
        fprintf(out,
                "  %d more designs failed or lack what was measured, and do not count; --retry "
                "computes failed points again\n",
                fit->search.designs.count - summary->designs);
    design_words(fit->search.study, &fit->search.designs.list[best], words);
    fprintf(out, "  nearest design: %s; its first run again: amontons run %s/best.yaml -o fitted\n",
            words, fit->search.options->folder);
}

// --- profiles -----------------------------------------------------------------------------------

static bool draw_profile(const Fit *fit, int32_t k, Error *err)
{
    char name[STUDY_NAME_SIZE + 8], label[60];
    double x[PROFILE_POINTS], y[PROFILE_POINTS], limit[2], ends[2];
    double *at = NEW_ARRAY(double, 2 * (int64_t)fit->search.designs.count, err);
    TRY(at);
    const Designs *designs = &fit->search.designs;
    const Region *region = &fit->regions[k];
    double *above = at + designs->count, place[STUDY_SEARCH_MAX];
    double wide = region->high - region->low, from = fmax(0, region->low - BEYOND * wide);
    double to = fmin(1, region->high + BEYOND * wide);

    // The profile from the best outwards, so that each place begins beside the last.
    int32_t middle = (int32_t)((fit->best[k] - from) / (to - from) * (PROFILE_POINTS - 1));
    bool fixed[STUDY_SEARCH_MAX] = {0};
    fixed[k] = true;
    for (int way = -1; way <= 1; way += 2) {
        memcpy(place, fit->best, sizeof place);
        for (int32_t i = way < 0 ? middle : middle + 1; i >= 0 && i < PROFILE_POINTS; i += way) {
            place[k] = from + (to - from) * i / (PROFILE_POINTS - 1);
            x[i] = fit_unscaled(fit, k, place[k]);
            y[i] = response_least(&fit->response, fixed, place) - fit->misfit;
        }
    }
    ends[0] = x[0], ends[1] = x[PROFILE_POINTS - 1];
    limit[0] = limit[1] = fit_threshold(fit, 1);

    // Designs that lie in the frame.
    int32_t count = 0;
    for (int32_t d = 0; d < designs->count; d++) {
        double value = designs->list[d].x[k];
        if (isnan(designs->list[d].value) || value < x[0] || value > x[PROFILE_POINTS - 1])
            continue;
        for (int32_t i = 0; i < fit->response.keys; i++)
            place[i] = fit_scaled(fit, i, designs->list[d].x[i]);
        double misfit = response_misfit(&fit->response, place) - fit->misfit;
        if (misfit > 3 * limit[0]) continue;
        at[count] = value;
        above[count++] = misfit;
    }
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

static bool draw_region(const Fit *fit, const int32_t keys[2], Error *err)
{
    const double full = 6.283185307179586;
    double x[REGION_POINTS], y[REGION_POINTS], best[2], axes[2][2];
    double most = fit->misfit + fit_threshold(fit, 2);
    char name[2 * STUDY_NAME_SIZE + 10], label[60];

    // Directions that a circle of `cos` and `sin` turns into the ellipse of the curvature; else the
    // regions' widths.
    double inverse[STUDY_SEARCH_MAX * STUDY_SEARCH_MAX];
    int32_t n = fit->response.keys, a = keys[0], b = keys[1];
    response_curvature(&fit->response, fit->best, inverse);
    bool regular = dense_cholesky(inverse, n) && dense_invert_factored(inverse, n);
    double first = regular ? sqrt(inverse[a * n + a]) : 0;
    double both = regular ? inverse[a * n + b] / first : 0;
    double second = regular ? inverse[b * n + b] - both * both : 0;
    axes[0][0] = second > 0 ? first : fit->regions[a].high - fit->regions[a].low;
    axes[0][1] = second > 0 ? both : 0;
    axes[1][0] = 0;
    axes[1][1] = second > 0 ? sqrt(second) : fit->regions[b].high - fit->regions[b].low;
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

// True if one result was measured over the one thing that differs: along a curve under one
// condition, or by the one key that is its condition. x, key: out, where each was measured, and
// what that is.
static bool has_places(const Fit *fit, double *x, char key[STUDY_NAME_SIZE])
{
    const Measurements *measured = &fit->measured;
    for (int32_t k = 0; k < measured->count; k++) {
        const Datum *one = &measured->list[k];
        const char *condition = measured->conditions[one->condition];
        char own_key[STUDY_NAME_SIZE];
        x[k] = one->at;
        snprintf(own_key, sizeof own_key, "%s", one->along);
        if (!*one->along) {
            const char *colon = strstr(condition, ": ");
            if (!colon || strchr(condition, ',') || colon - condition >= STUDY_NAME_SIZE)
                return false;
            snprintf(own_key, sizeof own_key, "%.*s", (int)(colon - condition), condition);
            int32_t length = text_number(colon + 2, &x[k]);
            const char *unit = colon + 2 + length + strspn(colon + 2 + length, " ");
            if (length <= 0 || (*unit && !unit_to_si(unit, NULL, &x[k]))) return false;
        }
        if (k == 0) snprintf(key, STUDY_NAME_SIZE, "%s", own_key);
        if (strcmp(one->name, measured->list[0].name) != 0 || strcmp(key, own_key) != 0)
            return false;
        if (*one->along && measured->condition_count > 1) return false;
    }
    return measured->count > 0;
}

// Draws the measurements over their condition. If there are several results, or conditions of
// several keys, it draws how far each measurement is off.
static bool draw_measured(const Fit *fit, Error *err)
{
    int32_t count = fit->measured.count;
    const Datum *list = fit->measured.list;
    char key[STUDY_NAME_SIZE];
    double *room = NEW_ARRAY(double, 4 * (int64_t)count, err);
    TRY(room);
    double *x = room, *value = x + count, *error = value + count, *found = error + count;
    bool is_si = fit->search.sweep->scene->units == UNITS_SI, placed = has_places(fit, x, key);
    for (int32_t k = 0; k < count; k++) {
        if (!placed) x[k] = k + 1;
        value[k] = list[k].value;
        error[k] = placed ? list[k].error : 1;
        found[k] = placed ? response_at(&fit->response, k, fit->best) : fit_errors_off(fit, k);
    }
    if (placed) {
        Curve curves[] = {search_dots("measured, with one error", count, x, value),
                          search_dots("found, at the best", count, x, found)};
        curves[0].error = error;
        curves[1].marker = "square";
        curves[1].color = COLOR_BEST;
        Frame frame = {"measured", "linear", "linear", quantity_label(key, is_si),
                       quantity_label(list[0].name, false)};
        if (strncmp(key, SERIES, strlen(SERIES)) == 0) {
            frame.x = (QuantityLabel){0};
            snprintf(frame.x.words, sizeof frame.x.words, "%.60s (%s)", key + strlen(SERIES),
                     is_si ? "SI" : "normalised");
            snprintf(frame.y.words, sizeof frame.y.words, "%.60s", list[0].name + strlen(SERIES));
        }
        TRY(search_draw(&fit->search, &frame, curves, 2, err));
    } else {
        double ends[] = {0, count + 1}, none[] = {0, 0};
        Curve curves[] = {search_line("measured", 2, ends, none),
                          search_dots("found, with one error", count, x, found)};
        curves[1].error = error;
        Frame frame = {"measured",
                       "linear",
                       "linear",
                       {.words = "measurement, in the order of fit.csv"},
                       {.words = "found less measured, over the error"}};
        TRY(search_draw(&fit->search, &frame, curves, 2, err));
    }
cleanup:
    memory_free(room);
    return error_is_clean(err);
}

// --- the best curves on the data -----------------------------------------------------------------

// True if a datum lies on the curve of datum `first`, under the same condition.
static bool is_on_curve(const Datum *datum, const Datum *first, bool under_same)
{
    return strcmp(datum->along, first->along) == 0 && strcmp(datum->name, first->name) == 0 &&
           (!under_same || datum->condition == first->condition);
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
        double low = INFINITY, high = -INFINITY;
        int32_t points = 0, kept = 0;
        for (int32_t i = 0; i < measured->count; i++) {   // measurements on the curve
            const Datum *datum = &measured->list[i];
            if (!is_on_curve(datum, one, true)) continue;
            at[used + points] = datum->at;
            value[used + points] = datum->value;
            error[used + points++] = datum->error;
            low = fmin(low, datum->at);
            high = fmax(high, datum->at);
        }
        point_path(fit->search.sweep, fit->search.designs.list[best].point + one->condition,
                   "history.h5", history);
        TRY(measurements_curve(one, history, &x[k], &y[k], &rows, err));

        // A run's curve is shown over the data and a little beside them.
        double beside = BESIDE * (high > low ? high - low : fabs(high));
        for (int64_t i = 0; i < rows; i++) {
            if (!(x[k][i] >= low - beside && x[k][i] <= high + beside)) continue;
            x[k][kept] = x[k][i];
            y[k][kept++] = y[k][i];
        }
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

// --- the whole ----------------------------------------------------------------------------------

bool fit_report(const Fit *fit, const FitSummary *summary, Error *err)
{
    int32_t n = fit->response.keys;
    SearchAnswer answer;
    if (!search_answer_begin(&answer, err)) return false;
    print_answer(fit, summary, answer.out);
    if (!search_answer_end(&fit->search, &answer, err)) return false;

    // fit.csv: each measurement, and what was found.
    static const char *const names[] = {"condition", "name",  "along",     "at", "measured",
                                        "error",     "found", "own_error", "off"};
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/fit.csv", fit->search.options->folder);
    TextWriter *csv = text_writer_create(path, false, err);
    if (!csv) return false;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) csv_text(csv, names[k]);
    csv_end_row(csv);
    for (int32_t k = 0; k < fit->measured.count; k++) {
        const Datum *datum = &fit->measured.list[k];
        csv_text(csv, fit->measured.conditions[datum->condition]);
        csv_text(csv, datum->name);
        csv_text(csv, datum->along);
        csv_number(csv, *datum->along ? datum->at : (double)NAN);
        csv_number(csv, datum->value);
        csv_number(csv, datum->error);
        csv_number(csv, response_at(&fit->response, k, fit->best));
        csv_number(csv, fit->response.own[k]);
        csv_number(csv, fit_errors_off(fit, k));
        csv_end_row(csv);
    }
    if (!text_writer_finish(csv, err)) return false;

    // Figures.
    if (!draw_measured(fit, err) || !draw_fitted(fit, err)) return false;
    for (int32_t k = 0; k < n; k++)
        if (!draw_profile(fit, k, err)) return false;
    for (int32_t k = 0; k < n && n <= PAIRS_KEYS_MAX; k++)
        for (int32_t i = k + 1; i < n; i++)
            if (!draw_region(fit, (int32_t[2]){k, i}, err)) return false;
    return search_leave_best(&fit->search, designs_best(&fit->search.designs), 0, err);
}
