// SPDX-License-Identifier: GPL-2.0-or-later
// Slow passage through the instability makes the time of a burst depend on how small the
// disturbance was that it grew from, so at some loads the block slides a burst earlier or later:
// peaks then lie on branches some per cent apart, with periods of 2 and more, or without any.
#include "answers/answers.h"

#include "answers/statistics.h"
#include "record/drops.h"

#include <math.h>
#include <stddef.h>

static const double MEAN_ERROR = 0.02;

// Length that slipped when slip turned fast, over the length of the front from the trailing end.
// Above this ratio most of it slipped elsewhere, and the front says nothing of when the block
// slides.
static const double ELSEWHERE = 2;

// --- the first loading, and the cycles after it -------------------------------------------------

// Number of the first sliding of the whole block from event number `from` on; without one the
// number of events.
static int32_t next_sliding(const Events *events, int32_t from)
{
    int32_t k = from;
    while (k < events->count && events->list[k].kind != EVENT_LEADING) k++;
    return k;
}

// Distance from the trailing end of the block to which a rapid event came, length.
static double precursor_length(const Events *events, const Event *event)
{
    return event->reach - events->trailing;
}

// Counts the precursors among the events from number `from` to the one before `to`. *longest: the
// largest of their lengths, 0 without any.
static int32_t count_precursors(const Events *events, int32_t from, int32_t to, double *longest)
{
    int32_t count = 0;
    *longest = 0;
    for (int32_t k = from; k < to; k++) {
        if (events->list[k].kind != EVENT_BOUNDED) continue;
        *longest = fmax(*longest, precursor_length(events, &events->list[k]));
        count++;
    }
    return count;
}

FirstLoading first_loading_of(const Drops *drops)
{
    FirstLoading first = {.mu = {NAN, NAN},
                          .parts = {NAN, NAN, NAN},
                          .known_to = NAN,
                          .U = NAN,
                          .critical_length = NAN,
                          .critical_part = NAN};
    const Events *events = drops->events;
    if (!events) return first;   // a run that failed early
    int32_t sliding = next_sliding(events, 0);
    first.precursors = count_precursors(events, 0, sliding, &first.longest);

    // A block that moves from t = 0 on has slid without a peak before: no drop belongs to that.
    for (int32_t k = 0; k < drops->count && !first.slid; k++) {
        if (!drops->list[k].bulk || drops->list[k].event != sliding) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        first.slid = true;
        first.mu.value = peak.mu;
        first.U = peak.U;
        for (int32_t i = 0; i < sliding; i++)
            if (events->list[i].kind == EVENT_BOUNDED && events->list[i].U_start < peak.U &&
                isfinite(events->list[i].mu_start))
                first.since_precursor = fmax(peak.mu - events->list[i].mu_start, 0);
        const Event *event = &events->list[sliding];
        bool elsewhere = event->slip_length > ELSEWHERE * peak.critical_length;
        first.critical_length = elsewhere ? (double)NAN : peak.critical_length;
        first.critical_part = peak.critical_part;
    }
    return first;
}

LaterCycles later_cycles_of(const Drops *drops, int32_t first)
{
    LaterCycles later = {.way = NAN, .precursors = NAN, .longest = NAN};
    const Events *events = drops->events;
    double U = NAN, way = 0, precursors = 0, longest = 0;
    int32_t before = -1;   // number of the sliding before
    for (int32_t k = 0; k < drops->count; k++) {
        if (!drops->list[k].bulk) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        if (k >= first && before >= 0) {
            double most;
            precursors += count_precursors(events, before + 1, peak.event, &most);
            longest += most;
            way += peak.U - U;
            later.count++;
        }
        before = peak.event;
        U = peak.U;
    }
    if (later.count == 0) return later;
    later.way = way / later.count;
    later.precursors = precursors / later.count;
    later.longest = longest / later.count;
    return later;
}

// --- the regime ---------------------------------------------------------------------------------

// The lowest of the series and the range of its branch.
static Estimate lowest_branch(const Drops *drops, int32_t count)
{
    SeriesBranch branch, lowest = {.low = INFINITY};
    series_sort(drops->series, count);
    for (int32_t k = 0; k < count;) {
        k = series_branch(drops->series, count, k, drops->tolerance, &branch);
        if (branch.low < lowest.low) lowest = branch;
    }
    return (Estimate){lowest.low, (lowest.high - lowest.low) / 2};
}

// Adds the error that a trend leaves beside scatter.
static void add_ahead(const Regime *regime, Estimate *estimate)
{
    estimate->error = hypot(estimate->error, regime->ahead * estimate->value);
}

Answers answers_of(const Drops *drops)
{
    double mu_max = isfinite(drops->mu_max) ? drops->mu_max : (double)NAN;   // before any step
    Answers answers = {.regime = regime_of(drops),
                       .mu_M_low = NAN,
                       .mu_M_high = NAN,
                       .mu_M_spread = NAN,
                       .mu_max = mu_max,
                       .mu_max_jump = mu_max - drops->mu_beside,
                       .mu_M_known_to = NAN,
                       .mu_hold_known_to = NAN,
                       .mu_max_known_to = NAN,
                       .critical_length = NAN,
                       .critical_part = NAN,
                       .subcritical_length = NAN};
    const Regime *regime = &answers.regime;
    answers.first = regime->first;
    answers.first_loading = first_loading_of(drops);
    answers.later_cycles = later_cycles_of(drops, answers.first);

    // Load drops: their mean, whether more would tell more, what the contact holds for sure.
    int32_t count = drops_series(drops, DROP_LOAD, answers.first);
    Estimate *mean = &answers.mu_drops;
    *mean = series_mean(drops->series, count, regime->period > 0 ? regime->period : 1);
    bool known = regime->count >= DROPS_ENOUGH && mean->error <= MEAN_ERROR * mean->value;
    answers.enough = regime->run_in == RUN_IN_OVER && (regime->period > 0 || known);
    mean->error *= ERROR_BAR;
    answers.mu_hold = regime->run_in == RUN_IN_STUCK ? (Estimate){NAN, NAN}
                      : regime->period > 0           ? lowest_branch(drops, count)
                                                     : series_lowest_decile(drops->series, count);
    if (regime->period == 0) answers.mu_hold.error *= ERROR_BAR;
    add_ahead(regime, &answers.mu_hold);
    answers.mu_hold_parts = (ErrorParts){NAN, NAN, answers.mu_hold.error};

    // Peaks before bulk slidings: mean and range.
    count = drops_series(drops, DROP_BULK, answers.first);
    answers.peaks = drops_count(drops, DROP_BULK);
    answers.peaks_counted = count;
    if (regime->period > 0) answers.period = count / (regime->count / regime->period);
    answers.mu_M = series_mean(drops->series, count, answers.period > 0 ? answers.period : 1);
    answers.mu_M.error *= ERROR_BAR;
    add_ahead(regime, &answers.mu_M);
    answers.mu_M_parts = (ErrorParts){NAN, NAN, answers.mu_M.error};
    for (int32_t k = 0; k < count; k++) {
        answers.mu_M_low = fmin(answers.mu_M_low, drops->series[k].value);
        answers.mu_M_high = fmax(answers.mu_M_high, drops->series[k].value);
    }
    if (count > 1) answers.mu_M_spread = answers.mu_M_high - answers.mu_M_low;

    // Lengths: means over the peaks that count, of l_c and l_sc where they were seen at all.
    double critical = 0, part = 0, subcritical = 0;
    int32_t slid = 0, with_critical = 0, with_subcritical = 0;
    for (int32_t k = answers.first; k < drops->count; k++) {
        if (!drops->list[k].bulk) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        part += peak.critical_part;
        slid++;
        if (!isnan(peak.critical_length)) {
            critical += peak.critical_length;
            with_critical++;
        }
        if (isnan(peak.front_uncertified)) continue;
        subcritical += peak.front_uncertified;
        with_subcritical++;
    }
    if (with_critical > 0) answers.critical_length = critical / with_critical;
    if (slid > 0) answers.critical_part = part / slid;
    if (with_subcritical > 0) answers.subcritical_length = subcritical / with_subcritical;
    return answers;
}

void steady_answer(const Steady *steady, Answers *answers)
{
    answers->steady = answers->peaks_counted == 0 && !isnan(steady_mu(steady).value);
    if (!answers->steady) return;
    answers->mu_M = steady_mu(steady);
    answers->mu_M_parts = (ErrorParts){NAN, NAN, answers->mu_M.error};
}

// --- run.json -----------------------------------------------------------------------------------

// Writes the branches of the drops of one kind that count; by the number of pads that slid, then
// the lowest first.
static void write_branches(const Drops *drops, DropKind kind, int32_t first, double tolerance,
                           JsonWriter *json)
{
    int32_t count = drops_series(drops, kind, first);
    series_sort(drops->series, count);
    json_begin_list(json, "branches");
    for (int32_t k = 0; k < count;) {
        SeriesBranch branch;
        k = series_branch(drops->series, count, k, tolerance, &branch);
        json_object_of(json, NULL, {"mu", branch.mean}, {"low", branch.low}, {"high", branch.high},
                       {"pads_slid", branch.kind}, {"count", branch.count});
    }
    json_end(json);
}

// A run that failed early has no events.
static bool is_in_space(const Drops *drops)
{
    return drops->events && drops->events->in_space;
}

// l_sc and l_c as the dynamics saw them, and from the growth rates (l_c_growth_over_L).
void answers_write_peaks(const Answers *answers, const Drops *drops, double length,
                         JsonWriter *json)
{
    json_begin_list(json, "peaks");
    for (int32_t k = 0; k < drops->count; k++) {
        if (!drops->list[k].bulk) continue;
        Drop peak = drops_as(drops, DROP_BULK, k);
        json_begin_object(json, NULL);
        json_numbers_of(json, {"U", peak.U}, {"mu", peak.mu});
        json_boolean(json, "counts", k >= answers->first);
        json_numbers_of(json, {"l_sc_over_L", peak.front_uncertified / length},
                        {"l_c_over_L", peak.critical_length / length},
                        {"l_c_growth_over_L", peak.front_growth / length});
        if (is_in_space(drops)) json_number(json, "A_c_over_A", peak.critical_part);
        json_end(json);
    }
    json_end(json);
}

static void write_list(const Drops *drops, DropKind kind, const char *key, JsonWriter *json)
{
    json_begin_list(json, key);
    for (int32_t k = 0; k < drops->count; k++) {
        if (!drop_is(&drops->list[k], kind)) continue;
        Drop drop = drops_as(drops, kind, k);
        json_begin_object(json, NULL);
        json_numbers_of(json, {"U", drop.U}, {"mu", drop.mu}, {"mu_after", drop.mu_after});
        json_begin_list(json, "pads");
        for (int32_t p = 0; drops->pad_name && p < drops->pad_count; p++)
            if (drops->slid[(int64_t)k * drops->pad_count + p])
                json_text(json, NULL, drops->pad_name[p]);
        json_end(json);
        json_end(json);
    }
    json_end(json);
}

void error_parts_write(const ErrorParts *parts, JsonWriter *json)
{
    json_numbers_of(json, {"mesh", parts->mesh}, {"branches", parts->branches},
                    {"drops", parts->drops});
}

static void write_parts(JsonWriter *json, const char *name, const ErrorParts *parts)
{
    json_begin_object(json, name);
    error_parts_write(parts, json);
    json_end(json);
}

// Writes `first` and `later_cycles`. length: L.
static void write_first_loading(const FirstLoading *first, const LaterCycles *later,
                                const Events *events, double length, JsonWriter *json)
{
    json_begin_object(json, "first");
    json_boolean(json, "slid", first->slid);
    json_numbers_of(json, {"mu", first->mu.value}, {"mu_error", first->mu.error});
    json_begin_object(json, "mu_error_parts");
    json_numbers_of(json, {"mesh", first->parts.mesh}, {"branches", first->parts.branches});
    json_end(json);
    json_numbers_of(json, {"mu_known_to", first->known_to}, {"U", first->U});
    json_integer(json, "precursors", first->precursors);
    json_number(json, "longest_over_L", first->longest / length);
    json_number(json, "l_c_over_L", first->critical_length / length);
    if (events && events->in_space) json_number(json, "A_c_over_A", first->critical_part);
    int32_t sliding = events ? next_sliding(events, 0) : 0;
    json_begin_list(json, "list");
    for (int32_t k = 0; k < sliding; k++) {
        const Event *event = &events->list[k];
        if (event->kind != EVENT_BOUNDED) continue;
        json_object_of(json, NULL, {"U", event->U_start}, {"mu", event->mu_start},
                       {"length_over_L", precursor_length(events, event) / length},
                       {"slipped_over_A", event->slipped / events->size},
                       {"peak_slip_rate", event->peak_slip_rate});
    }
    json_end(json);
    json_end(json);
    json_object_of(json, "later_cycles", {"count", later->count}, {"U", later->way},
                   {"precursors", later->precursors}, {"longest_over_L", later->longest / length});
}

void answers_write_json(const Answers *answers, const Drops *drops, double length, JsonWriter *json)
{
    json_numbers_of(json, {"mu_M", answers->mu_M.value}, {"mu_M_error", answers->mu_M.error});
    write_parts(json, "mu_M_error_parts", &answers->mu_M_parts);
    json_numbers_of(json, {"mu_M_known_to", answers->mu_M_known_to},
                    {"mu_M_spread", answers->mu_M_spread}, {"mu_M_low", answers->mu_M_low},
                    {"mu_M_high", answers->mu_M_high}, {"mu_M_peaks", answers->peaks_counted});
    json_boolean(json, "periodic", answers->period > 0);
    json_integer(json, "period", answers->period);
    write_branches(drops, DROP_BULK, answers->first, drops->tolerance, json);
    json_numbers_of(json, {"mu_hold", answers->mu_hold.value},
                    {"mu_hold_error", answers->mu_hold.error});
    write_parts(json, "mu_hold_error_parts", &answers->mu_hold_parts);
    json_numbers_of(json, {"mu_hold_known_to", answers->mu_hold_known_to},
                    {"mu_max", answers->mu_max}, {"mu_max_known_to", answers->mu_max_known_to},
                    {"l_sc_over_L", answers->subcritical_length / length},
                    {"l_c_over_L", answers->critical_length / length});
    if (is_in_space(drops)) json_number(json, "A_c_over_A", answers->critical_part);
    write_first_loading(&answers->first_loading, &answers->later_cycles, drops->events, length,
                        json);
    answers_write_peaks(answers, drops, length, json);

    // Drops that do not repeat scatter: their branches are the numbers of pads that slid.
    json_begin_object(json, "drops");
    json_numbers_of(json, {"least_drop", LEAST_DROP}, {"period", answers->regime.period},
                    {"counted", answers->regime.count});
    json_boolean(json, "enough", answers->enough);
    json_numbers_of(json, {"mean", answers->mu_drops.value},
                    {"mean_error", answers->mu_drops.error});
    write_branches(drops, DROP_LOAD, answers->first,
                   answers->regime.period > 0 ? drops->tolerance : (double)INFINITY, json);
    write_list(drops, DROP_LOAD, "list", json);
    json_end(json);

    json_begin_object(json, "run_in");
    json_boolean(json, "over", answers->regime.run_in == RUN_IN_OVER);
    json_text(json, "state", run_in_name(answers->regime.run_in));
    json_numbers_of(json, {"drift", answers->regime.drift},
                    {"drops_left", answers->regime.drops_left});
    json_end(json);
    // The lowest of the later half of the pad slidings: the effect of the start is gone by then.
    int32_t count = drops_series(drops, DROP_PADS, 0);
    double low = NAN;
    for (int32_t k = count / 2; k < count; k++)
        low = fmin(low, drops->series[k].value);   // fmin of NaN and a number is the number
    json_number(json, "mu_first_pad", low);
    write_list(drops, DROP_PADS, "pad_slidings", json);
}

const char *steady_words(const Steady *steady, const Answers *answers)
{
    if (!steady->events) return "none: the run failed before its first step";
    if (answers->steady) return "steady sliding";
    if (!isnan(answers->mu_M.value)) return "peaks";
    if (steady->slides) return "none: the block slides slowly, and F_T/F_N is not steady yet";
    if (answers->peaks > 0)
        return "none: what slidings of the whole block there were belong to the start or run-in";
    if (steady->events->kinds[EVENT_LEADING] > 0)
        return "none: the block slid from the start on, and not once from rest";
    if (answers->regime.count > 0) return "none: only parts of the block slid in this run";
    return "none: the block as a whole did not slide in this run";
}

void steady_write_json(const Steady *steady, const Answers *answers, JsonWriter *json)
{
    Estimate mu = steady_mu(steady);
    json_text(json, "mu_M_is", steady_words(steady, answers));
    json_numbers_of(json, {"mu_steady", mu.value}, {"mu_steady_error", mu.error},
                    {"mu_steady_from_U", isnan(mu.value) ? NAN : steady->from});
}
