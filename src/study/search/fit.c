// SPDX-License-Identifier: GPL-2.0-or-later
// measurements read -> designs chosen where the misfit may be small (search) -> each result as a
// polynomial of the keys (response) -> its least misfit and profile -> designs at the ends of the
// regions, until these stay -> answer and figures.
//
// Misfit: -2 ln of the likelihood, sum of (found - measured)^2 / (s^2 + e^2) + ln(1 + e^2 / s^2),
// with s the error of a measurement and e that of the program.
#include "study/search/fit.h"

#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ROUNDS_MAX = 6 };
static const double FAR = 5;   // thresholds above the least misfit, where designs count half
// Designs that differ by less in every key are computed once: the responses learn nothing from the
// second. Parts of a key's range while it is searched; of its region, whose ends may still move by
// twice that (STAYS), when the region is known.
static const double NEAR_IN_RANGE = 5e-3, NEAR_IN_REGION = 0.05;

// --- what a design is worth ---------------------------------------------------------------------

static bool take_results(Search *search, int32_t d, int32_t c, const char *report, Error *err)
{
    Fit *fit = search->judge.context;
    int32_t count = fit->measured.count;
    char history[POINT_PATH_SIZE + 16];
    point_path(search->sweep, search->designs.list[d].point + c, "history.h5", history);
    for (int32_t k = 0; k < count; k++) {
        const Datum *datum = &fit->measured.list[k];
        int64_t at = (int64_t)d * count + k;
        if (datum->condition != c) continue;
        if (!measurements_find(datum, report, history, &fit->found[at], &fit->own[at], err))
            return false;
    }
    return true;
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

// --- regions ------------------------------------------------------------------------------------

// Makes the responses through the designs so far, and finds the least misfit from the best design
// on, and from the best place before.
static bool find_best(Fit *fit, Error *err)
{
    const Designs *designs = &fit->search.designs;
    int32_t n = fit->search.study->search.key_count, data = fit->measured.count, count = 0;
    int32_t first = designs_best(designs), freedom = fit_freedom(fit);
    double other[STUDY_SEARCH_MAX];
    ResponseDesign *list = NEW_ARRAY(ResponseDesign, designs->count, err);
    TRY(list);
    for (int32_t d = 0; d < designs->count; d++) {
        if (isnan(designs->list[d].value)) continue;
        ResponseDesign *one = &list[count++];
        for (int32_t k = 0; k < n; k++) one->place[k] = fit_scaled(fit, k, designs->list[d].x[k]);
        one->found = &fit->found[(int64_t)d * data];
        one->own = &fit->own[(int64_t)d * data];
        one->misfit = designs->list[d].value;
    }
    response_destroy(&fit->response);
    ResponseDef def = {.keys = n,
                       .designs = count,
                       .data = data,
                       .list = list,
                       .measured = fit->measured.list,
                       .far = FAR * fit_threshold(fit, 1),
                       .failed = fit->search.failed,
                       .failure = fit->search.failure};
    TRY(response_make(&def, &fit->response, err));

    memcpy(other, fit->best, sizeof other);
    double least = response_least(&fit->response, NULL, other);
    for (int32_t k = 0; k < n; k++) fit->best[k] = fit_scaled(fit, k, designs->list[first].x[k]);
    fit->misfit = response_least(&fit->response, NULL, fit->best);
    if (least < fit->misfit) {
        memcpy(fit->best, other, sizeof other);
        fit->misfit = least;
    }
    fit->widened = freedom > 0 ? sqrt(fmax(1, fit->misfit / freedom)) : 1;
cleanup:
    memory_free(list);
    return error_is_clean(err);
}

// place: scaled. One that is new and allowed is added.
static bool add_place(Fit *fit, const double *place, Error *err)
{
    double x[STUDY_SEARCH_MAX] = {0};
    int32_t added = -1;
    for (int32_t k = 0; k < fit->response.keys; k++) x[k] = fit_unscaled(fit, k, place[k]);
    return search_add(&fit->search, x, &added, err);
}

// --- the whole ----------------------------------------------------------------------------------

bool amontons_fit(const char *path, const SweepOptions *options, FitSummary *summary, Error *err)
{
    NUMBERS_HAVE_A_POINT;
    *summary = (FitSummary){.misfit = NAN};
    Fit *fit = NEW_ARRAY(Fit, 1, err);
    TRY(fit);

    // The study and its measurements.
    Search *search = &fit->search;
    TRY(search_open(search, path, options, true, err));
    const StudySearch *keys = &search->study->search;
    TRY(measurements_read(search->study, &fit->measured, err));
    int32_t data = fit->measured.count;
    if (data < keys->key_count)
        FAIL(err, ERROR_INPUT, "%s: %d measurements cannot tell %d keys", path, data,
             keys->key_count);
    search->judge = (SearchJudge){take_results, judge_misfit, fit};
    TRY(search_begin(search, fit->measured.condition_count, fit->measured.conditions, err));
    search->designs.origins = fit->measured.origins;
    for (int32_t k = 0; k < keys->key_count; k++) search->designs.near[k] = NEAR_IN_RANGE;
    TRY(fit->found = NEW_ARRAY(double, (int64_t)DESIGNS_MAX *data, err));
    TRY(fit->own = NEW_ARRAY(double, (int64_t)DESIGNS_MAX *data, err));
    search->sweep->planned += search->designs.conditions * 2 * (1 + 2 * keys->key_count);

    // The designs that the search chooses are computed.
    TRY(search_designs(search, keys->designs, err));

    // The regions of the keys, with designs at the best place and at the ends of the regions, where
    // polynomials would be guesses.
    bool stays = false;
    fit->widened = 1;
    for (int32_t round = 0; round <= ROUNDS_MAX; round++) {
        int32_t first = search->designs.count;
        TRY(find_best(fit, err));
        fit_find_regions(fit, &stays);
        if ((stays && round > 0) || round == ROUNDS_MAX) break;
        for (int32_t k = 0; k < fit->response.keys; k++)
            search->designs.near[k] = NEAR_IN_REGION * (fit->regions[k].high - fit->regions[k].low);
        TRY(add_place(fit, fit->best, err));
        for (int32_t k = 0; k < fit->response.keys; k++) {
            TRY(add_place(fit, fit->regions[k].low_place, err));
            TRY(add_place(fit, fit->regions[k].high_place, err));
        }
        if (search->designs.count == first) break;
        TRY(search_compute_from(search, first, err));
    }

    *summary = (FitSummary){.parameter_count = fit->response.keys,
                            .measurements = data,
                            .computed = search->sweep->computed,
                            .misfit = fit->misfit,
                            .widened = fit->widened,
                            .seconds = clock_seconds() - search->sweep->started};
    for (int32_t k = 0; k < fit->response.keys; k++) {
        const Region *region = &fit->regions[k];
        FitParameter *parameter = &summary->parameters[k];
        snprintf(parameter->key, sizeof parameter->key, "%s", keys->keys[k].key);
        parameter->value = fit_unscaled(fit, k, fit->best[k]);
        parameter->low = fit_unscaled(fit, k, region->low);
        parameter->high = fit_unscaled(fit, k, region->high);
        parameter->low_open = region->low_open;
        parameter->high_open = region->high_open;
    }
    for (int32_t d = 0; d < search->designs.count; d++)
        summary->designs += !isnan(search->designs.list[d].value);
    for (int32_t k = 0; k < data; k++) {
        double own = pow(fit->response.own[k], 2), error = fit->measured.list[k].error;
        summary->own_share += own / (own + error * error) / data;
    }
    TRY(fit_report(fit, summary, err));
cleanup:
    if (fit) {
        search_close(&fit->search, err);
        measurements_destroy(&fit->measured);
        response_destroy(&fit->response);
        memory_free_all(fit->found, fit->own);
    }
    memory_free(fit);
    return error_is_clean(err);
}
