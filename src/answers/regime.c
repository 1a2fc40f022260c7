// SPDX-License-Identifier: GPL-2.0-or-later
// The block is elastic and its load is given: so the state of the contact at rest comes back only
// if all of it has slipped as far as the drive went. A drift of mu by less than the tolerance from
// drop to drop, with most of the contact stuck, is thus no period, however long it goes on.
#include "answers/regime.h"

#include "record/drops.h"
#include "answers/statistics.h"

#include <math.h>

// Part of the drive's way over the drops that count: a segment that lags by more is left behind. A
// segment that sticks lags by all of it; in a regime the lag is only scatter, over several rounds.
static const double LAG = 0.25;
enum { TREND_DROPS = 8 };   // that a drift is told from while parts stick

const char *run_in_name(RunIn run_in)
{
    static const char *const names[] = {
#define X(symbol, name) name,
        RUN_INS(X)
#undef X
    };
    return names[run_in];
}

static double U_of(const Drops *drops, const SeriesItem *item)
{
    return drops->list[(item->state - drops->states) / (2 * drops->segments.count)].U;
}

// Some segment moved by less, or more, than the drive over these drops. Where they are not whole
// rounds it may still make good the way of one with the next.
static bool lags(const Drops *drops, const SeriesItem *items, int32_t count, bool rounds)
{
    double way = 0, longest = 0;
    for (int32_t k = 1; k < count; k++) {
        double step = fabs(U_of(drops, &items[k]) - U_of(drops, &items[k - 1]));
        longest = fmax(longest, step);
        way += step;
    }
    double allowed = LAG * way + (rounds ? 0 : longest);
    const double *from = items[0].state + drops->segments.count;
    const double *to = items[count - 1].state + drops->segments.count;
    for (int32_t s = 0; s < drops->segments.count; s++)
        if (fabs(to[s] - from[s]) > allowed) return true;
    return false;
}

// Number of load drops until the change that lies ahead is below the tolerance, or mu can rise no
// more.
static double drops_left(const Drops *drops, double mu, double fading, const Regime *regime)
{
    double left = NAN, rises = regime->drift * mu;
    if (isfinite(fading)) left = fading * fmax(log(regime->ahead / drops->tolerance), 0);
    if (rises > 0 && drops->mu_static > mu)
        left = fmin(left, (drops->mu_static - mu) / rises);   // fmin passes a NaN over
    return ceil(left);
}

static SeriesTrend trend_of_last(const SeriesItem *last, int32_t count, const Regime *regime)
{
    bool stuck = regime->run_in == RUN_IN_STUCK;
    return series_trend(last + 1 - count, count, stuck ? 1 : regime->period);
}

// A trend that stands out from the scatter of the last so many load drops.
static void note_trend(const Drops *drops, const SeriesItem *last, int32_t count, Regime *regime)
{
    int32_t round = regime->period > 0 ? regime->period : 1;
    SeriesTrend trend = trend_of_last(last, count, regime);
    if (!series_trend_stands_out(&trend)) return;
    regime->drift = trend.slope / last->value;
    regime->ahead = fabs(regime->drift) * DROPS_ENOUGH * round;

    // Load drops over which the trend falls to 1/e of itself, as it did over these; infinite: it
    // does not.
    int32_t third = count / 3 / round * round;
    double fades = third > 0 ? series_fading(last + 1 - 3 * third, third) : (double)NAN;
    double fading = fades > 0 && fades < 1 ? third / -log(fades) : INFINITY;
    regime->drops_left = drops_left(drops, last->value, fading, regime);
}

Regime regime_of(const Drops *drops)
{
    // The load drops up to the one in which the last node slipped for the first time do not count.
    int32_t all = drops_series(drops, DROP_LOAD, 0), settled = 0;
    for (int32_t k = 0; k < drops->count && k <= drops->settled; k++)
        settled += drops->list[k].load;
    int32_t from = settled > 0 ? settled - 1 : 0, count = all - from;   // one belongs to the start
    if (count < 1) from = 0, count = all;
    SeriesRegime found =
        series_regime(drops->series + from, count, drops->tolerance, drops->segments.count);
    Regime regime = {.count = found.count, .drift = NAN, .drops_left = NAN};
    const SeriesItem *last = all > 0 ? &drops->series[all - 1] : NULL;
    if (drops->settled < 0) {
        int32_t told = found.count < TREND_DROPS ? found.count : TREND_DROPS;
        regime.run_in = RUN_IN_STUCK;
        if (told > 2) note_trend(drops, last, told, &regime);
    } else if (found.count > 1) {
        int32_t looked = found.period > 0 ? 2 * found.period + 1 : found.count;
        regime.period = found.period;
        regime.run_in = lags(drops, last + 1 - looked, looked, found.period > 0) ? RUN_IN_LAGS
                                                                                 : RUN_IN_OVER;

        // The trend over all load drops since every node has slipped, also those that agree with
        // the last no more: a slow rise is seen best from afar. As long as the later half of them
        // shows for certain that the trend has become less, what came before belongs to the run-in.
        if (found.count > 2) {
            int32_t looked_back = count - 1;
            int32_t round = regime.period > 0 ? regime.period : 1;
            for (int32_t half = looked_back; half > round; looked_back = half) {
                SeriesTrend whole = trend_of_last(last, looked_back, &regime);
                if (!series_trend_stands_out(&whole)) break;
                half = (looked_back / 2 + round - 1) / round * round;
                SeriesTrend later = trend_of_last(last, half, &regime);
                double most = fabs(later.slope) + student(later.freedoms) * later.error;
                if (!(most < fabs(whole.slope))) break;
            }
            note_trend(drops, last, looked_back, &regime);
            if (looked_back < regime.count) regime.count = looked_back;
            if (regime.ahead > drops->tolerance && regime.run_in == RUN_IN_OVER)
                regime.run_in = RUN_IN_TREND;
        }
        if (regime.run_in != RUN_IN_OVER) regime.period = 0;
    }
    int32_t before = all - regime.count;
    while (regime.first < drops->count && !(drops->list[regime.first].load && before-- == 0))
        regime.first++;
    return regime;
}
