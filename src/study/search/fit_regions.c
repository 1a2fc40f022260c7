// SPDX-License-Identifier: GPL-2.0-or-later
// Regions by the profile of the misfit: Venzon and Moolgavkar, Appl. Stat. 37, 87 (1988).
#include "study/search/fit_regions.h"

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

void fit_find_regions(Fit *fit, bool *stays)
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
