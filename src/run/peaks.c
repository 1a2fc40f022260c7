// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/peaks.h"

#include "base/memory.h"

#include <math.h>

enum { FIRST_ROOM = 16, PERIODIC_PEAKS = 3 };

static const Peak NOTHING_SEEN = {
    .mu = -INFINITY, .front = NAN, .front_uncertified = NAN, .front_growth = NAN};

bool peaks_create(const Events *events, double tolerance, Peaks *peaks, Error *err)
{
    *peaks = (Peaks){.events = events,
                     .tolerance = tolerance,
                     .room = FIRST_ROOM,
                     .rising = NOTHING_SEEN,
                     .mu_max = -INFINITY};
    peaks->list = NEW_ARRAY(Peak, FIRST_ROOM, err);
    return error_is_clean(err);
}

void peaks_destroy(Peaks *peaks)
{
    memory_free(peaks->list);
    *peaks = (Peaks){0};
}

static bool push_peak(Peaks *peaks, Error *err)
{
    if (peaks->count == peaks->room) {
        Peak *longer =
            memory_resize(peaks->list, peaks->room, 2 * (int64_t)peaks->room, sizeof(Peak), err);
        if (!longer) goto cleanup;
        peaks->list = longer;
        peaks->room *= 2;
    }
    peaks->list[peaks->count++] = peaks->rising;
cleanup:
    return error_is_clean(err);
}

bool peaks_record(void *self, const Observation *seen, Error *err)
{
    Peaks *peaks = self;
    const Events *events = peaks->events;
    peaks->mu_max = fmax(peaks->mu_max, seen->mu);
    bool sliding = events->rapid >= 0 && events->list[events->rapid].kind == EVENT_LEADING;
    if (events->crossed) {
        peaks->rising.front = events->list[events->rapid].front_start;
        if (seen->grows && isnan(peaks->rising.front_growth))
            peaks->rising.front_growth = seen->front;
        TRY(push_peak(peaks, err));
    }
    if (sliding || (events->ended && events->list[events->count - 1].kind == EVENT_LEADING)) {
        peaks->rising = NOTHING_SEEN;
        goto cleanup;
    }
    if (seen->mu > peaks->rising.mu) {
        peaks->rising.mu = seen->mu;
        peaks->rising.U = seen->U;
    }
    if (!seen->certified && isnan(peaks->rising.front_uncertified))
        peaks->rising.front_uncertified = seen->front;
    if (seen->grows && isnan(peaks->rising.front_growth)) peaks->rising.front_growth = seen->front;
cleanup:
    return error_is_clean(err);
}

// Peaks from the end on that agree with the last one of their phase, the first peak of the run left
// out: how many, at least `period`. A slow drift does not agree.
static int32_t count_agreeing(const Peaks *peaks, int32_t period)
{
    int32_t first = peaks->count > 1 ? 1 : 0, last = peaks->count - 1, agreeing = period;
    for (int32_t k = last - period; k >= first; k--) {
        double mu = peaks->list[last - (last - k) % period].mu;
        if (fabs(peaks->list[k].mu - mu) > peaks->tolerance * mu) break;
        agreeing++;
    }
    return agreeing;
}

static void average(Peaks *peaks, PeaksSummary *summary)
{
    double low = INFINITY, high = -INFINITY, sum = 0, fronts = 0, losses = 0;
    int32_t with_loss = 0;
    for (int32_t k = peaks->count - summary->counted; k < peaks->count; k++) {
        Peak *peak = &peaks->list[k];
        peak->counts = true;
        sum += peak->mu;
        fronts += peak->front;
        low = fmin(low, peak->mu);
        high = fmax(high, peak->mu);
        if (isnan(peak->front_uncertified)) continue;
        losses += peak->front_uncertified;
        with_loss++;
    }
    summary->mu_M = sum / summary->counted;
    summary->critical_length = fronts / summary->counted;
    if (with_loss > 0) summary->subcritical_length = losses / with_loss;
    if (summary->counted > 1) summary->spread = high - low;
}

PeaksSummary peaks_summarise(Peaks *peaks)
{
    PeaksSummary summary = {.mu_M = NAN,
                            .spread = NAN,
                            .low = NAN,
                            .high = NAN,
                            .critical_length = NAN,
                            .subcritical_length = NAN};
    for (int32_t k = 0; k < peaks->count; k++) peaks->list[k].counts = false;
    if (peaks->count == 0) return summary;
    int32_t agreeing = count_agreeing(peaks, 1), alternating = count_agreeing(peaks, 2);
    summary.counted = agreeing;
    if (agreeing >= PERIODIC_PEAKS) {
        summary.period = 1;
    } else if (alternating >= 2 + PERIODIC_PEAKS) {
        summary.period = 2;
        summary.counted = alternating - alternating % 2;   // as many high ones as low ones
    }
    average(peaks, &summary);
    for (int32_t k = peaks->count > 1 ? 1 : 0; k < peaks->count; k++) {
        summary.low = fmin(summary.low, peaks->list[k].mu);
        summary.high = fmax(summary.high, peaks->list[k].mu);
    }
    return summary;
}
