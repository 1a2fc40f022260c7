// SPDX-License-Identifier: GPL-2.0-or-later
// A fall is a drawdown of mu(U) within one rapid event: from the largest mu, that of the step
// before included, down to the smallest after it. In set A on up to 12 pads drops of single pads
// stay below 0.025 of mu and falls begin at 0.08; in set B they stay below 0.01 and begin at 0.045.
#include "record/falls.h"

#include "base/memory.h"
#include "record/repetition.h"
#include "record/sample.h"

#include <math.h>

enum { FIRST_ROOM = 16, REPEATING_PART = 3 };

static const double LEAST_DROP = 0.05, MEAN_ERROR = 0.02;
static const Fall NOTHING_SEEN = {.mu = -INFINITY, .mu_after = INFINITY};

bool falls_create(const Events *events, const Pads *pads, double tolerance, Falls *falls,
                  Error *err)
{
    *falls = (Falls){.events = events,
                     .pads = pads,
                     .least = LEAST_DROP,
                     .tolerance = tolerance,
                     .rising = NOTHING_SEEN,
                     .top = -INFINITY,
                     .room = FIRST_ROOM};
    falls->list = NEW_ARRAY(Fall, FIRST_ROOM, err);
    return error_is_clean(err);
}

void falls_destroy(Falls *falls)
{
    memory_free(falls->list);
    *falls = (Falls){0};
}

static bool push_fall(Falls *falls, Error *err)
{
    Fall *list = memory_grow(falls->list, falls->count, &falls->room, sizeof(Fall), err);
    if (!list) return false;
    falls->list = list;
    list[falls->count++] = falls->rising;
    falls->rising = NOTHING_SEEN;
    return true;
}

// Relative to the top, at least `least` of it. A run without a rod has mu 0, and no falls.
static bool has_fallen(const Falls *falls)
{
    return falls->drop > 0 && falls->drop >= falls->least * falls->top;
}

// Events first (record/events), pads second: both have looked at this step already. rising->mu
// stops rising once the force has fallen in this event.
bool falls_record(void *self, const Observation *seen, Error *err)
{
    Falls *falls = self;
    const Events *events = falls->events;
    Fall *rising = &falls->rising;
    bool in_event = events->rapid >= 0 || events->ended;
    if (seen->mu > rising->mu && !has_fallen(falls)) {
        rising->mu = seen->mu;
        rising->U = seen->U;
    }
    falls->top = in_event ? fmax(falls->top, seen->mu) : seen->mu;
    if (in_event) {
        falls->drop = fmax(falls->drop, falls->top - seen->mu);
        rising->mu_after = fmin(rising->mu_after, seen->mu);
    }
    if (!events->ended) goto cleanup;
    rising->pads = falls->pads->slid;
    if (has_fallen(falls)) TRY(push_fall(falls, err));
    falls->rising.mu_after = INFINITY;
    falls->drop = 0;
cleanup:
    return error_is_clean(err);
}

// --- period and branches ------------------------------------------------------------------------

// An ItemsAgree (record/repetition): the same number of pads slid, at the same mu within the
// tolerance.
static bool falls_agree(const void *series, int32_t k, int32_t later)
{
    const Falls *falls = series;
    const Fall *a = &falls->list[k], *b = &falls->list[later];
    return a->pads == b->pads && fabs(a->mu - b->mu) <= falls->tolerance * b->mu;
}

// The branch that fall k belongs to, by its place or by the pads that slid; NULL: no room.
static FallBranch *branch_of(const Falls *falls, FallsSummary *summary, int32_t k)
{
    int32_t pads = falls->list[k].pads, b = 0;
    if (summary->period > 0) {
        b = (falls->count - 1 - k) % summary->period;
    } else {
        while (b < summary->branch_count && summary->branches[b].pads != pads) b++;
    }
    if (b >= FALL_BRANCHES_MAX) return NULL;
    for (; summary->branch_count <= b; summary->branch_count++)
        summary->branches[summary->branch_count] =
            (FallBranch){.low = INFINITY, .high = -INFINITY, .pads = pads};
    summary->branches[b].pads = pads;
    return &summary->branches[b];
}

// By mu, the lowest first: that is the one to trust.
static void sort_branches(FallsSummary *summary)
{
    for (int32_t a = 1; a < summary->branch_count; a++) {
        FallBranch moved = summary->branches[a];
        int32_t b = a;
        for (; b > 0 && summary->branches[b - 1].mu > moved.mu; b--)
            summary->branches[b] = summary->branches[b - 1];
        summary->branches[b] = moved;
    }
}

// Adds the counted falls to their branches, with the range of them all.
static void fill_branches(const Falls *falls, FallsSummary *summary)
{
    for (int32_t k = falls->count - 1; k >= falls->count - summary->counted; k--) {
        double mu = falls->list[k].mu;
        summary->low = fmin(summary->low, mu);   // fmin of NaN and a number is the number
        summary->high = fmax(summary->high, mu);
        FallBranch *branch = branch_of(falls, summary, k);
        if (!branch) continue;
        branch->mu = (branch->mu * branch->count + mu) / (branch->count + 1);
        branch->count++;
        branch->low = fmin(branch->low, mu);
        branch->high = fmax(branch->high, mu);
    }
    sort_branches(summary);
}

static double fall_mu(const void *series, int32_t k)
{
    return ((const Falls *)series)->list[k].mu;
}

// What repeats must have come back twice and be a third of the run: of many falls without a period
// some few agree by chance. Without a period the first quarter is left to the start.
FallsSummary falls_summarise(const Falls *falls)
{
    FallsSummary summary = {
        .low = NAN, .high = NAN, .trusted_error = NAN, .counted = falls->count - falls->count / 4};
    for (int32_t period = 1; period <= FALL_PERIOD_MAX && summary.period == 0; period++) {
        int32_t agreeing = repetition_count(falls->count, period, falls_agree, falls);
        if (falls->count <= period || agreeing < 2 * period + 1) continue;
        if (REPEATING_PART * agreeing < falls->count) continue;
        summary.period = period;
        summary.counted = agreeing - (period > 1 ? agreeing % period : 0);
    }
    fill_branches(falls, &summary);
    SampleSummary sample =
        sample_summarise(falls, fall_mu, falls->count - summary.counted, summary.counted);
    summary.mean = sample.mean;
    summary.mean_error = sample.mean_error;
    summary.trusted = summary.low;
    if (summary.period > 0) {
        summary.trusted_error = (summary.branches[0].high - summary.branches[0].low) / 2;
    } else if (falls->count > 0) {
        summary.trusted = sample.decile;
        summary.trusted_error = sample.decile_error;
    }
    summary.enough = summary.period > 0 || (summary.counted >= FALLS_ENOUGH &&
                                            sample.mean_error <= MEAN_ERROR * sample.mean);
    return summary;
}

bool falls_are_settled(const Falls *falls)
{
    return falls->count > 2 && falls_summarise(falls).enough;
}

// --- run.json -----------------------------------------------------------------------------------

static void write_branches(const FallsSummary *summary, JsonWriter *json)
{
    json_begin_list(json, "branches");
    for (int32_t b = 0; b < summary->branch_count; b++) {
        const FallBranch *branch = &summary->branches[b];
        json_begin_object(json, NULL);
        json_number(json, "mu", branch->mu);
        json_number(json, "low", branch->low);
        json_number(json, "high", branch->high);
        json_integer(json, "pads", branch->pads);
        json_integer(json, "count", branch->count);
        json_end(json);
    }
    json_end(json);
}

void falls_write_json(const Falls *falls, JsonWriter *json)
{
    FallsSummary summary = falls_summarise(falls);
    json_number(json, "mu_trusted", summary.trusted);
    json_number(json, "mu_trusted_error", summary.trusted_error);
    json_begin_object(json, "falls");
    json_number(json, "least_drop", falls->least);
    json_integer(json, "period", summary.period);
    json_integer(json, "counted", summary.counted);
    json_boolean(json, "enough", summary.enough);
    json_number(json, "mean", summary.mean);
    json_number(json, "mean_error", summary.mean_error);
    json_number(json, "mu_low", summary.low);
    json_number(json, "mu_high", summary.high);
    write_branches(&summary, json);
    json_begin_list(json, "list");
    for (int32_t k = 0; k < falls->count; k++) {
        const Fall *fall = &falls->list[k];
        json_begin_object(json, NULL);
        json_number(json, "U", fall->U);
        json_number(json, "mu", fall->mu);
        json_number(json, "mu_after", fall->mu_after);
        json_integer(json, "pads", fall->pads);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}
