// SPDX-License-Identifier: GPL-2.0-or-later
// measurements read -> designs chosen where the misfit may be small (search) -> each result as a
// polynomial of the keys (response) -> its least misfit and profile -> designs at the ends of the
// regions, until these stay -> answer and figures.
//
// Misfit: -2 ln of the likelihood, sum of (found - measured)^2 / (s^2 + e^2) + ln(1 + e^2 / s^2) with
// s the error of a measurement and e that of the program. Regions by its profile: Venzon and
// Moolgavkar, Appl. Stat. 37, 87 (1988).
#include "study/search/fit.h"

#include "base/clock.h"
#include "base/memory.h"
#include "study/search/fit_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ROUNDS_MAX = 6, WALK_MAX = 400, BISECTIONS = 40 };
static const double FAR = 5;   // thresholds above the least misfit, where designs count half
static const double STAYS = 0.1;   // of a region's width, which its ends may still move by
static const double FIRST_WALK = 0.1, WALK_GROWS = 1.15;   // steps along a profile, of its width

// --- what a design is worth ---------------------------------------------------------------------

double fit_scaled(const Fit *fit, int32_t k, double value)
{
    const SearchKey *key = &fit->search.study->search.keys[k];
    double least = search_scaled(key, key->least), most = search_scaled(key, key->most);
    return (search_scaled(key, value) - least) / (most - least);
}

double fit_unscaled(const Fit *fit, int32_t k, double scaled)
{
    const SearchKey *key = &fit->search.study->search.keys[k];
    double least = search_scaled(key, key->least), most = search_scaled(key, key->most);
    return search_unscaled(key, least + scaled * (most - least));
}

static bool take_results(Search *search, int32_t d, int32_t c, const char *report, Error *err)
{
    Fit *fit = search->judge.context;
    int32_t count = fit->measured.count;
    char history[AMONTONS_PATH_SIZE];
    search_run_path(search, d, c, history);
    size_t length = strlen(history);
    if (length > 8 && length < sizeof history - 8)
        strcpy(history + length - 8, "history.h5");   // beside run.json
    for (int32_t k = 0; k < count; k++) {
        const Datum *datum = &fit->measured.list[k];
        int64_t at = (int64_t)d * count + k;
        if (datum->condition != c) continue;
        TRY(measured_find(datum, report, history, &fit->found[at], &fit->own[at], err));
    }
cleanup:
    return error_is_clean(err);
}

// NaN where it lacks anything that was measured.
static void judge_misfit(Search *search, int32_t d)
{
    const Fit *fit = search->judge.context;
    Design *design = &search->designs.list[d];
    design->value = 0;
    for (int32_t k = 0; k < fit->measured.count; k++) {
        const Datum *datum = &fit->measured.list[k];
        int64_t at = (int64_t)d * fit->measured.count + k;
        double own = fit->own[at] / datum->error, square = 1 + own * own;
        double off = (fit->found[at] - datum->value) / datum->error;
        design->value += off * off / square + log(square);
    }
}

// Misfits differ by powers of ten.
static double tell_logarithm(double misfit)
{
    return log1p(misfit);
}

// --- regions ------------------------------------------------------------------------------------

int32_t fit_freedom(const Fit *fit)
{
    return fit->measured.count - fit->search.study->search.key_count;
}

double fit_threshold(const Fit *fit, int32_t keys)
{
    // Of chi^2 with one and with two degrees of freedom.
    static const double sure[] = {0.68, 0.90, 0.95, 0.99};
    static const double one[] = {0.989, 2.706, 3.841, 6.635};
    double share = fit->search.study->search.sure, wide = fit->widened * fit->widened;
    int32_t k = 0;
    while (k < 3 && sure[k] < share - 1e-9) k++;
    return wide * (keys == 1 ? one[k] : -2 * log(1 - share));
}

static bool make_response(Fit *fit, Error *err)
{
    const Designs *designs = &fit->search.designs;
    int32_t n = fit->search.study->search.key_count, data = fit->measured.count, count = 0;
    double *room = NEW_ARRAY(double, (int64_t)designs->count *(n + 2 * data + 1) + 2 * data, err);
    TRY(room);
    double *places = room, *found = places + (int64_t)designs->count * n;
    double *own = found + (int64_t)designs->count * data;
    double *misfit = own + (int64_t)designs->count * data, *measured = misfit + designs->count;
    for (int32_t d = 0; d < designs->count; d++) {
        if (isnan(designs->list[d].value)) continue;
        for (int32_t k = 0; k < n; k++)
            places[count * n + k] = fit_scaled(fit, k, designs->list[d].x[k]);
        memcpy(&found[(int64_t)count * data], &fit->found[(int64_t)d * data],
               (size_t)data * sizeof *found);
        memcpy(&own[(int64_t)count * data], &fit->own[(int64_t)d * data],
               (size_t)data * sizeof *own);
        misfit[count++] = designs->list[d].value;
    }
    for (int32_t k = 0; k < data; k++) {
        measured[k] = fit->measured.list[k].value;
        measured[data + k] = fit->measured.list[k].error;
    }
    response_destroy(&fit->response);
    ResponseDef def = {n,   count,  data,     places,          found,
                       own, misfit, measured, measured + data, FAR * fit_threshold(fit, 1)};
    TRY(response_make(&def, &fit->response, err));
cleanup:
    memory_free(room);
    return error_is_clean(err);
}

// From the best design on, and from the best place before.
static void find_best(Fit *fit)
{
    const Designs *designs = &fit->search.designs;
    int32_t n = fit->response.keys, first = designs_best(designs), freedom = fit_freedom(fit);
    double other[STUDY_SEARCH_MAX];
    memcpy(other, fit->best, sizeof other);
    double least = response_least(&fit->response, NULL, other);
    for (int32_t k = 0; k < n; k++) fit->best[k] = fit_scaled(fit, k, designs->list[first].x[k]);
    fit->misfit = response_least(&fit->response, NULL, fit->best);
    if (least < fit->misfit) {
        memcpy(fit->best, other, sizeof other);
        fit->misfit = least;
    }
    fit->widened = freedom > 0 ? sqrt(fmax(1, fit->misfit / freedom)) : 1;
}

// The least misfit with key `k` at `value`; place: of all keys, begins near.
static double profile_at(const Fit *fit, int32_t k, double value, double *place)
{
    bool fixed[STUDY_SEARCH_MAX] = {0};
    fixed[k] = true;
    place[k] = value;
    return response_least(&fit->response, fixed, place);
}

// Along key `k` from the best on, up (way: 1) or down (-1), until the misfit is beyond `most`; then
// between the last two. *open: the range ends before. place: of all keys, at the end.
static double walk(const Fit *fit, int32_t k, int way, double most, double *place, bool *open)
{
    double step = FIRST_WALK, at = fit->best[k], inside = at;
    double curvature[STUDY_SEARCH_MAX * STUDY_SEARCH_MAX], last[STUDY_SEARCH_MAX];
    response_curvature(&fit->response, fit->best, curvature);
    double stiff = curvature[k * fit->response.keys + k];
    step *= stiff > 0 ? fmin(1, sqrt((most - fit->misfit) / stiff)) : 1;
    memcpy(last, fit->best, sizeof last);
    memcpy(place, last, sizeof last);
    *open = true;
    for (int32_t i = 0; i < WALK_MAX && *open && (way > 0 ? at < 1 : at > 0); i++) {
        at = fmin(fmax(inside + way * step, 0), 1);
        *open = profile_at(fit, k, at, place) <= most;
        if (*open) inside = at, memcpy(last, place, sizeof last);
        step *= WALK_GROWS;
    }
    for (int32_t i = 0; i < BISECTIONS && !*open; i++) {
        double middle = (inside + at) / 2;
        memcpy(place, last, sizeof last);
        bool within = profile_at(fit, k, middle, place) <= most;
        if (within) memcpy(last, place, sizeof last);
        *(within ? &inside : &at) = middle;
    }
    memcpy(place, last, sizeof last);
    place[k] = inside;
    return inside;
}

// *stays: no end has moved by more than a part of the region.
static void find_regions(Fit *fit, bool *stays)
{
    double most = fit->misfit + fit_threshold(fit, 1);
    *stays = true;
    for (int32_t k = 0; k < fit->response.keys; k++) {
        Region *region = &fit->regions[k], before = *region;
        region->low = walk(fit, k, -1, most, region->low_place, &region->low_open);
        region->high = walk(fit, k, 1, most, region->high_place, &region->high_open);
        double moved = fmax(fabs(region->low - before.low), fabs(region->high - before.high));
        *stays = *stays && moved <= STAYS * (region->high - region->low);
    }
}

// --- the whole ----------------------------------------------------------------------------------

// place: scaled. One that is new and allowed is added.
static bool add_place(Fit *fit, const double *place, Error *err)
{
    double x[STUDY_SEARCH_MAX] = {0};
    int32_t added = -1;
    for (int32_t k = 0; k < fit->response.keys; k++) x[k] = fit_unscaled(fit, k, place[k]);
    return search_add(&fit->search, x, &added, err);
}

// Designs at the best place and at the ends of the regions, where polynomials would else be guesses.
static bool refine_regions(Fit *fit, Error *err)
{
    bool stays = false;
    fit->widened = 1;
    for (int32_t round = 0; round <= ROUNDS_MAX; round++) {
        int32_t first = fit->search.designs.count;
        TRY(make_response(fit, err));
        find_best(fit);
        find_regions(fit, &stays);
        if ((stays && round > 0) || round == ROUNDS_MAX) break;
        TRY(add_place(fit, fit->best, err));
        for (int32_t k = 0; k < fit->response.keys; k++) {
            TRY(add_place(fit, fit->regions[k].low_place, err));
            TRY(add_place(fit, fit->regions[k].high_place, err));
        }
        if (fit->search.designs.count == first) break;
        TRY(search_compute_from(&fit->search, first, err));
    }
cleanup:
    return error_is_clean(err);
}

static bool open_fit(Fit *fit, const char *path, const SweepOptions *options, Error *err)
{
    Search *search = &fit->search;
    TRY(search_open(search, path, options, true, err));
    TRY(measured_read(search->study, &fit->measured, err));
    if (fit->measured.count < search->study->search.key_count)
        FAIL(err, ERROR_INPUT, "%s: %d measurements cannot tell %d keys", path, fit->measured.count,
             search->study->search.key_count);
    search->judge = (SearchJudge){take_results, judge_misfit, tell_logarithm, fit};
    TRY(search_begin(search, fit->measured.condition_count, fit->measured.conditions, err));
    int64_t room = (int64_t)DESIGNS_MAX * fit->measured.count;
    TRY(fit->found = NEW_ARRAY(double, room, err));
    TRY(fit->own = NEW_ARRAY(double, room, err));
    search->planned += search->designs.conditions * 2 * (1 + 2 * search->study->search.key_count);
cleanup:
    return error_is_clean(err);
}

static void summarise(const Fit *fit, FitSummary *summary)
{
    const Search *search = &fit->search;
    int32_t data = fit->measured.count;
    *summary = (FitSummary){.parameter_count = fit->response.keys,
                            .measurements = data,
                            .computed = search->computed,
                            .misfit = fit->misfit,
                            .widened = fit->widened,
                            .seconds = clock_seconds() - search->started};
    for (int32_t k = 0; k < fit->response.keys; k++) {
        const Region *region = &fit->regions[k];
        FitParameter *parameter = &summary->parameters[k];
        snprintf(parameter->key, sizeof parameter->key, "%s", search->study->search.keys[k].key);
        parameter->value = fit_unscaled(fit, k, fit->best[k]);
        parameter->low = fit_unscaled(fit, k, region->low);
        parameter->high = fit_unscaled(fit, k, region->high);
        parameter->low_open = region->low_open;
        parameter->high_open = region->high_open;
    }
    for (int32_t d = 0; d < search->designs.count; d++)
        summary->designs += !isnan(search->designs.list[d].value);
    for (int32_t k = 0; k < data; k++) {
        double own = fit->response.own[k] * fit->response.own[k];
        summary->own_share += own / (own + fit->response.error[k] * fit->response.error[k]) / data;
    }
}

bool amontons_fit(const char *path, const SweepOptions *options, FitSummary *summary, Error *err)
{
    *summary = (FitSummary){.misfit = NAN};
    Fit *fit = NEW_ARRAY(Fit, 1, err);
    TRY(fit);
    TRY(open_fit(fit, path, options, err));
    TRY(search_designs(&fit->search, err));
    TRY(refine_regions(fit, err));
    summarise(fit, summary);
    TRY(fit_report(fit, summary, err));
cleanup:
    if (fit) {
        search_close(&fit->search, err);
        measured_destroy(&fit->measured);
        response_destroy(&fit->response);
        memory_free(fit->found);
        memory_free(fit->own);
    }
    memory_free(fit);
    return error_is_clean(err);
}
