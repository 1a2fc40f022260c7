// SPDX-License-Identifier: GPL-2.0-or-later
// Regions by the profile of the misfit: Venzon and Moolgavkar, Appl. Stat. 37, 87 (1988).
#include "study/search/fit.h"

#include "algebra/dense.h"

#include <math.h>
#include <string.h>

enum { WALK_MAX = 400, BISECTIONS = 40 };
static const double STAYS = 0.1;   // of a region's width, which its ends may still move by
static const double FIRST_WALK = 0.1, WALK_GROWS = 1.15;   // steps along a profile, of its width

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

double fit_errors_off(const Fit *fit, int32_t datum)
{
    const Datum *measured = &fit->measured.list[datum];
    double error = hypot(measured->error, fit->response.own[datum]);
    return (response_at(&fit->response, datum, fit->best) - measured->value) / error;
}

int32_t fit_freedom(const Fit *fit)
{
    return fit->measured.count - fit->search.study->search.key_count;
}

double fit_threshold(const Fit *fit, int32_t keys)
{
    // Quantiles of chi^2; with two degrees of freedom they are -2 ln(1 - share).
    const StudySearch *search = &fit->search.study->search;
    double quantile = keys == 1 ? search->quantile : -2 * log(1 - search->sure);
    return fit->widened * fit->widened * quantile;
}

// The misfit so far along `ray`, the least over the keys that it leaves out. place: of all keys,
// begins near.
static double misfit_at(const Fit *fit, const double *ray, double reach, double *place)
{
    bool fixed[STUDY_SEARCH_MAX];
    for (int32_t k = 0; k < fit->response.keys; k++) {
        fixed[k] = ray[k] != 0;
        if (fixed[k]) place[k] = fmin(fmax(fit->best[k] + reach * ray[k], 0), 1);
    }
    return response_least(&fit->response, fixed, place);
}

// Goes in steps until the misfit is beyond `most`; then between the last two.
bool fit_walk(const Fit *fit, const double *ray, double most, double *place)
{
    double curvature[STUDY_SEARCH_MAX * STUDY_SEARCH_MAX], last[STUDY_SEARCH_MAX];
    double inside = 0, at = 0, end = INFINITY, stiff = 0;
    bool within = true;
    int32_t n = fit->response.keys;
    response_curvature(&fit->response, fit->best, curvature);
    for (int32_t k = 0; k < n; k++) {
        stiff += ray[k] * dense_dot(&curvature[k * n], ray, n);
        if (ray[k] != 0) end = fmin(end, ((ray[k] > 0) - fit->best[k]) / ray[k]);
    }
    double step = FIRST_WALK * (stiff > 0 ? fmin(1, sqrt((most - fit->misfit) / stiff)) : 1);
    memcpy(last, fit->best, sizeof last);
    for (int32_t i = 0; i < WALK_MAX && within && inside < end; i++, step *= WALK_GROWS) {
        at = fmin(inside + step, end);
        memcpy(place, last, sizeof last);
        within = misfit_at(fit, ray, at, place) <= most;
        if (within) inside = at, memcpy(last, place, sizeof last);
    }
    for (int32_t i = 0; i < BISECTIONS && !within; i++) {
        double middle = (inside + at) / 2;
        memcpy(place, last, sizeof last);
        bool below = misfit_at(fit, ray, middle, place) <= most;
        if (below) memcpy(last, place, sizeof last);
        *(below ? &inside : &at) = middle;
    }
    memcpy(place, last, sizeof last);
    return within;
}

void fit_find_regions(Fit *fit, bool *stays)
{
    double most = fit->misfit + fit_threshold(fit, 1);
    *stays = true;
    for (int32_t k = 0; k < fit->response.keys; k++) {
        Region *region = &fit->regions[k], before = *region;
        double up[STUDY_SEARCH_MAX] = {0}, down[STUDY_SEARCH_MAX] = {0};
        up[k] = 1, down[k] = -1;
        region->low_open = fit_walk(fit, down, most, region->low_place);
        region->high_open = fit_walk(fit, up, most, region->high_place);
        region->low = region->low_place[k];
        region->high = region->high_place[k];
        double moved = fmax(fabs(region->low - before.low), fabs(region->high - before.high));
        *stays = *stays && moved <= STAYS * (region->high - region->low);
    }
}
