// SPDX-License-Identifier: GPL-2.0-or-later
// Peaks of F_T/F_N and the regime they settle to. Slow passage through the instability makes the
// time of a burst depend on how small the disturbance was that it grew from, so at some loads the
// block slides a burst earlier or later: peaks then alternate between branches some per cent apart,
// with periods of 2 and more, or without any. A regime of period p is one in which each of the last
// peaks agrees with the last one of its phase, three times over.
#include "record/peaks.h"

#include "base/memory.h"
#include "record/repetition.h"

#include <math.h>

enum { FIRST_ROOM = 16 };
// Three rounds tell a period: with two branches, six peaks agree by chance once in 2^4 (period 2).
enum { REPETITIONS = 3, LONGEST_PERIOD = 8 };
enum { TRANSIENT_PART = 3 };   // where there is no period, the first of so many parts is left out

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

// `rising` joins the list. ERROR_MEMORY leaves the list as it was.
static bool push_peak(Peaks *peaks, Error *err)
{
    Peak *list = memory_grow(peaks->list, peaks->count, &peaks->room, sizeof(Peak), err);
    if (!list) return false;
    peaks->list = list;
    list[peaks->count++] = peaks->rising;
    return true;
}

// A peak is known when a leading event has crossed; while it slides, and in the step that ends it,
// nothing rises: the force then says nothing of static friction.
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

// Relative to the later one.
static bool peaks_agree(const void *series, int32_t k, int32_t later)
{
    const Peaks *peaks = series;
    double mu = peaks->list[later].mu;
    return fabs(peaks->list[k].mu - mu) <= peaks->tolerance * mu;
}

// The shortest period and the peaks in whole rounds of it; without one, all but the start's.
static void find_period(const Peaks *peaks, PeaksSummary *summary)
{
    for (int32_t period = 1; period <= LONGEST_PERIOD; period++) {
        int32_t agreeing = repetition_count(peaks->count, period, peaks_agree, peaks);
        if (agreeing < REPETITIONS * period) continue;
        summary->period = period;
        summary->counted = agreeing - agreeing % period;
        return;
    }
    int32_t transient = peaks->count / TRANSIENT_PART;
    if (transient == 0 && peaks->count > 1) transient = 1;
    summary->counted = peaks->count - transient;
}

// Means over the peaks counted, which are marked. l_sc where it was seen at all.
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

// All NaN without a peak. `low` and `high` leave the first out, which belongs to the start.
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
    find_period(peaks, &summary);
    average(peaks, &summary);
    for (int32_t k = peaks->count > 1 ? 1 : 0; k < peaks->count; k++) {
        summary.low = fmin(summary.low, peaks->list[k].mu);
        summary.high = fmax(summary.high, peaks->list[k].mu);
    }
    return summary;
}

// Single linkage: a branch grows upwards as long as the next peak is within the tolerance of its
// highest.
bool peaks_branch_above(const Peaks *peaks, double above, PeakBranch *branch)
{
    *branch = (PeakBranch){.low = INFINITY};
    for (int32_t k = 0; k < peaks->count; k++) {
        const Peak *peak = &peaks->list[k];
        if (peak->counts && peak->mu > above) branch->low = fmin(branch->low, peak->mu);
    }
    if (isinf(branch->low)) return false;
    branch->high = branch->low;
    for (int32_t found = -1; found != branch->count;) {   // until no further peak is near enough
        double reach = branch->high * (1 + peaks->tolerance), sum = 0;
        found = branch->count;
        branch->count = 0;
        for (int32_t k = 0; k < peaks->count; k++) {
            const Peak *peak = &peaks->list[k];
            if (!peak->counts || peak->mu < branch->low || peak->mu > reach) continue;
            branch->high = fmax(branch->high, peak->mu);
            branch->count++;
            sum += peak->mu;
        }
        branch->mu = sum / branch->count;
    }
    return true;
}
