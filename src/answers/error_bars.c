// SPDX-License-Identifier: GPL-2.0-or-later
#include "answers/error_bars.h"

#include "answers/statistics.h"

#include <math.h>
#include <stddef.h>

const char *const ANSWER_NAMES[ANSWER_KINDS] = {"mu_M", "mu_hold", "mu_first"};

// Usual relative scatter of mu with the mesh, and usual distance to the limit of ever smaller
// cells, before levels tell. Both are divided by the number of cells that slip where slow slip
// turns fast (USUAL), or by the number of nodes along the contact (USUAL_LEAST); the larger
// quotient counts. From a tenth to ten times as much was met, on blocks as on pads
// (validation/benchmark/priors.md): so this knowledge counts as one level. In space the same holds
// (validation/space/priors.md).
static const double USUAL = 0.05, USUAL_LEAST = 0.2;
enum { USUAL_LEVELS = 1 };
static const double ROUNDING = 1e-9;   // of products of steps from mesh to mesh
static const double SPAN = 2;   // of cell size, of the levels behind a bar that is met
static const double CONFIRM = 4;   // likewise, of all levels, behind one that is confirmed
static const double ONE_MESH = 0.5;   // of mu, over nodes: nine of ten meshes are off by less
static const double ONE_MESH_IN_SPACE = 0.9;   // likewise, over nodes along the contact
static const double END_WAITS = 3;   // mu may rise so many times as much before they let go
// Part of the rise of mu since the last precursor. The block slides at one of the loads at which
// the contact lets go in part, and another mesh has other precursors: nine of ten differ by less.
static const double ONE_PRECURSOR = 0.3;
static const double STEPS = 0.002;   // of mu: what tolerances of steps and reduction leave
static const double BRANCH_WIDTH = 0.005;   // of mu: the next branch is twice as far and more
static const double CHANCE = 0.05;   // less likely differences of patterns are no chance

// --- which pads slide together ------------------------------------------------------------------

void patterns_add(Patterns *patterns, uint64_t pads)
{
    int32_t k = 0;
    patterns->drops++;
    while (k < patterns->count && patterns->list[k].pads != pads) k++;
    if (k == PATTERNS_MAX) return;
    if (k == patterns->count) patterns->list[patterns->count++] = (Pattern){.pads = pads};
    patterns->list[k].drops++;
}

void patterns_add_drops(Patterns *patterns, const Drops *drops, int32_t first)
{
    for (int32_t k = first; k < drops->count; k++) {
        const uint8_t *slid = &drops->slid[(int64_t)k * drops->pad_count];
        uint64_t pads = 0;
        if (!drop_is(&drops->list[k], DROP_LOAD)) continue;
        for (int32_t p = 0; p < drops->pad_count; p++) pads |= (uint64_t)(slid[p] != 0) << p % 64;
        patterns_add(patterns, pads);
    }
}

// All drops with a pattern are among those of `one`: the chance of that where both have it alike.
static bool lacks(const Patterns *other, const Patterns *one)
{
    for (int32_t k = 0; k < one->count; k++) {
        double chance = 1;
        bool has = other->count == PATTERNS_MAX;   // it may be one of those that are not listed
        for (int32_t i = 0; i < other->count; i++)
            has = has || other->list[i].pads == one->list[k].pads;
        if (has) continue;
        for (int32_t i = 0; i < one->list[k].drops; i++)
            chance *= (double)(one->drops - i) / (one->drops + other->drops - i);
        if (chance < CHANCE) return true;
    }
    return false;
}

bool patterns_differ(const Patterns *one, const Patterns *other)
{
    return lacks(one, other) || lacks(other, one);
}

// --- levels -------------------------------------------------------------------------------------

// NaN: a run has no such answer.
static double mean_of(const Level *level, AnswerKind kind)
{
    double sum = 0;
    for (int32_t k = 0; k < level->run_count; k++) sum += level->runs[k].answer[kind].value;
    return level->run_count > 0 ? sum / level->run_count : (double)NAN;
}

// The mean over branches; what the contact holds for sure it holds on the lowest of them.
double level_value(const Level *level, AnswerKind kind)
{
    double mean = mean_of(level, kind), low = INFINITY;
    if (kind != ANSWER_MU_HOLD || isnan(mean)) return mean;
    for (int32_t k = 0; k < level->run_count; k++)
        low = fmin(low, level->runs[k].answer[kind].value);
    return low;
}

static bool has_value(const Level *level, AnswerKind kind)
{
    return !level->undamped && !isnan(mean_of(level, kind));
}

static bool is_known(const Level *level, AnswerKind kind)
{
    return has_value(level, kind) && !level->other_drops;
}

// Known, and its last nodes do not hold the block up by more than the bar that is wanted.
static bool counts(const Levels *levels, const Level *level, AnswerKind kind)
{
    bool held = END_WAITS * level->end_wait > levels->wanted * level_value(level, kind);
    return is_known(level, kind) && !held;
}

int32_t levels_known(const Levels *levels, AnswerKind kind)
{
    int32_t known = 0;
    for (int32_t l = 0; l < levels->count; l++) known += counts(levels, &levels->list[l], kind);
    return known;
}

double levels_span_left(const Levels *levels, AnswerKind kind)
{
    const Level *first = levels->list, *last = &first[levels->count - 1];
    while (first < last && !counts(levels, first, kind)) first++;
    double left = SPAN * first->refine / last->refine;
    return left < 1 + ROUNDING ? 1 : left;
}

double levels_confirm_left(const Levels *levels)
{
    const Level *last = &levels->list[levels->count - 1];
    double left = CONFIRM * levels->list[0].refine / last->refine;
    return left < 1 + ROUNDING ? 1 : left;
}

bool levels_may_differ(const Levels *levels)
{
    return levels->list[levels->count - 1].pads > 1 || levels->list[0].other_drops;
}

// Single runs about their level's mean: from the levels at least as fine as number `from`, or if
// these have one run each from the finest one with several; NaN: none has.
static double spread_of_runs(const Levels *levels, int32_t from, AnswerKind kind)
{
    double square = 0;
    int32_t freedoms = 0;
    for (int32_t l = levels->count - 1; l >= 0 && (l >= from || freedoms == 0); l--) {
        const Level *level = &levels->list[l];
        double mean = mean_of(level, kind);
        if (!is_known(level, kind)) continue;
        for (int32_t k = 0; k < level->run_count; k++) {
            double off = level->runs[k].answer[kind].value - mean;
            square += off * off;
        }
        freedoms += level->run_count - 1;
    }
    return freedoms > 0 ? sqrt(square / freedoms) : (double)NAN;
}

static double difference(const Levels *levels, int32_t level, AnswerKind kind)
{
    return fabs(level_value(&levels->list[level], kind) -
                level_value(&levels->list[level - 1], kind));
}

// Part of the contact that slips where slow slip turns fast, from all meshes that resolve slip: on
// one of them the smallest part may belong to an unusual event.
static double slipping_part(const Levels *levels)
{
    double nodes = 0, cells = 0;
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        if (level->undamped) continue;
        nodes += level->nodes_along;
        cells += isnan(level->slip_cells)
                     ? level->nodes_along - 1
                     : fmax(level->slip_cells, 0.5);   // a node went from rest to fast slip at once
    }
    return nodes > 0 ? cells / nodes : 1;
}

double levels_cells(const Levels *levels)
{
    return slipping_part(levels) * levels->list[levels->count - 1].nodes_along;
}

// Variance of a level's mean, from the spread of its runs over branches.
static double variance_of_runs(const Level *level, double spread)
{
    return isnan(spread) ? 0 : spread * spread / level->run_count;
}

// Fit through all levels: value = a + b / n for n nodes along the contact. Each level is off by a
// scatter that falls like 1 / n, and by the part of the spread over branches that its few runs
// leave. Before anything is known, b is about 0 within the usual size.
typedef struct Limit {
    double value;   // a: in the limit of ever smaller cells
    double mesh;   // of a, 95 %, from scatter and b; NaN: one level
    double runs, drops;   // of a: variance by branches; error by drops
} Limit;

// Parts that go along with each level's weight in a. The drops' part is the error of the mean over
// runs, from the error that each run states; a run that states none counts as 0.
static void add_level(const Level *level, AnswerKind kind, double weight, double spread,
                      Limit *limit)
{
    double square = 0;
    for (int32_t k = 0; k < level->run_count; k++) {
        double error = level->runs[k].answer[kind].error;
        if (!isnan(error)) square += error * error;
    }
    limit->runs += weight * weight * variance_of_runs(level, spread);
    limit->drops = hypot(limit->drops, weight * (sqrt(square) / level->run_count));
}

static Limit limit_of(const Levels *levels, AnswerKind kind)
{
    const Level *last = &levels->list[levels->count - 1];
    double origin = level_value(last, kind);   // all in parts of it
    double usual = fmax(USUAL / slipping_part(levels), USUAL_LEAST);   // over nodes
    double S = 0, Sx = 0, Sxx = 1 / (usual * usual), Sv = 0, Sxv = 0, Svv = 0;
    double weight[LEVELS_MAX] = {0}, spread[LEVELS_MAX] = {0};
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        double x = 1.0 / level->nodes_along, v = level_value(level, kind) / origin - 1;
        if (!is_known(level, kind)) continue;
        spread[l] = spread_of_runs(levels, l, kind);
        double runs = variance_of_runs(level, spread[l]) / (origin * origin);
        double own = hypot(usual / level->nodes_along, level->end_wait / origin);   // scatter
        double w = weight[l] = 1 / (own * own + runs);
        S += w, Sx += w * x, Sxx += w * x * x;
        Sv += w * v, Sxv += w * x * v, Svv += w * v * v;
    }
    double determinant = S * Sxx - Sx * Sx;
    double a = (Sxx * Sv - Sx * Sxv) / determinant, b = (S * Sxv - Sx * Sv) / determinant;
    double square = fmax(Svv - a * Sv - b * Sxv, 0);   // of what is off, b's own part included
    Limit limit = {.value = origin * (1 + a)};
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        double c = weight[l] * (Sxx - Sx / level->nodes_along) / determinant;
        if (weight[l] > 0) add_level(level, kind, c, spread[l], &limit);
    }
    int32_t free = levels_known(levels, kind) - 1;
    int32_t freedoms = (free > 0 ? free : 0) + USUAL_LEVELS;
    double variance = origin * origin * Sxx / determinant - limit.runs;
    limit.mesh = student(freedoms) * sqrt((square + USUAL_LEVELS) / freedoms * variance);
    return limit;
}

static double known(double part)
{
    return isnan(part) ? 0 : part;
}

static ErrorBar bar_of(const Levels *levels, AnswerKind kind)
{
    const Level *last = &levels->list[levels->count - 1];
    double spread = spread_of_runs(levels, levels->count - 1, kind);
    if (isnan(level_value(last, kind))) return (ErrorBar){NAN, NAN, {NAN, NAN, NAN}, false};

    // The last level alone has an answer, or it is one that does not count: of the error that its
    // mesh leaves nothing is known. Coarser ones with other drops say that it is no coarse one:
    // what is usual of one level then tells its error.
    const Level *first = levels->list;
    while (first < last && !has_value(first, kind)) first++;
    bool alone = !has_value(last, kind) || first->nodes_along == last->nodes_along;
    Limit limit = {.value = level_value(last, kind), .mesh = NAN};
    if (alone)
        add_level(last, kind, 1, spread, &limit);
    else
        limit = limit_of(levels, kind);
    double mesh = fmax(hypot(limit.mesh, END_WAITS * last->end_wait), STEPS * limit.value);
    // A mean over branches is known the better the more runs there are; the first sliding of a
    // block is on one of them.
    double runs = limit.runs + (kind == ANSWER_MU_FIRST ? spread * spread : 0);
    ErrorBar bar = {.value = limit.value,
                    .parts = {.mesh = alone ? NAN : mesh,
                              .branches = isnan(spread) ? NAN : ERROR_BAR * sqrt(runs),
                              .drops = limit.drops}};
    double others = hypot(known(bar.parts.branches), bar.parts.drops);
    bar.apart = fabs(limit.value - level_value(last, kind)) > hypot(mesh, others);
    if (bar.apart && !alone)
        bar.parts.mesh = sqrt(pow(limit.value - level_value(last, kind), 2) - others * others);
    bar.bar = hypot(bar.parts.mesh, others);
    return bar;
}

void levels_estimate(Levels *levels)
{
    Level *last = &levels->list[levels->count - 1];
    // Levels have other drops if they are coarser than all on which the same pads slide as on the
    // last one.
    bool other = true;
    for (int32_t l = 0; l < levels->count; l++) {
        other = other && patterns_differ(&levels->list[l].patterns, &last->patterns);
        levels->list[l].other_drops = other;
    }
    for (AnswerKind kind = 0; kind < ANSWER_KINDS; kind++)
        last->answer[kind] = bar_of(levels, kind);
    bool hold = levels->of_hold || isnan(last->answer[ANSWER_MU_M].value);
    levels->asked = hold ? ANSWER_MU_HOLD : ANSWER_MU_M;
}

// A trend is part of the error; before all of the contact goes along there is no answer.
static bool has_answer(RunIn run_in)
{
    return run_in == RUN_IN_OVER || run_in == RUN_IN_TREND;
}

bool levels_run_in(const Levels *levels)
{
    const Level *last = &levels->list[levels->count - 1];
    for (int32_t k = 0; k < last->run_count; k++)
        if (!has_answer(last->runs[k].run_in)) return true;
    return false;
}

void levels_add_run(Levels *levels, double pressure, double way, const Answers *answers,
                    int64_t steps)
{
    Level *last = &levels->list[levels->count - 1];
    LevelRun *run = &last->runs[last->run_count++];
    *run = (LevelRun){.pressure = pressure,
                      .way = way,
                      .answer = {{NAN, NAN}, {NAN, NAN}, answers->first_loading.mu},
                      .peaks = answers->peaks_counted,
                      .period = answers->period,
                      .run_in = answers->regime.run_in,
                      .steps = steps};
    if (answers->steady || has_answer(run->run_in)) {
        run->answer[ANSWER_MU_M] = answers->mu_M;
        run->answer[ANSWER_MU_HOLD] = answers->mu_hold;
    }
    levels_estimate(levels);
}

bool levels_reach(const Levels *levels, double way)
{
    const Level *last = &levels->list[levels->count - 1];
    for (int32_t k = 0; k < last->run_count; k++)
        if (last->runs[k].way <= way) return true;
    return false;
}

const Level *levels_last(const Levels *levels)
{
    return levels->count > 0 ? &levels->list[levels->count - 1] : NULL;
}

bool levels_have_runs(const Levels *levels)
{
    return levels->count > 0 && levels_last(levels)->run_count > 0;
}

const ErrorBar *levels_answer(const Levels *levels, AnswerKind kind)
{
    return levels->count > 0 ? &levels_last(levels)->answer[kind] : NULL;
}

// Usual error of one mesh, over the value. NaN: cells are too long for slip.
static double usual_of_one(const Level *level)
{
    double usual = level->space ? ONE_MESH_IN_SPACE : ONE_MESH;
    return level->undamped ? (double)NAN : fmax(usual / level->nodes_along, STEPS);
}

double levels_known_to(const Levels *levels, AnswerKind kind)
{
    const ErrorBar *answer = levels_answer(levels, kind);
    double others = hypot(known(answer->parts.branches), known(answer->parts.drops));
    double usual = usual_of_one(&levels->list[levels->count - 1]);
    return isnan(answer->bar) ? hypot(usual * answer->value, others) : answer->bar;
}

// Error of a first loading on one mesh, or several without a bar: that of any answer, and what
// other precursors change.
static double first_known_to(const FirstLoading *first, double known_to)
{
    return hypot(known_to, ONE_PRECURSOR * first->since_precursor);
}

void level_answer_for(const Level *level, Answers *answers)
{
    double usual = usual_of_one(level);
    answers->mu_M_known_to = hypot(usual * answers->mu_M.value, known(answers->mu_M.error));
    answers->mu_hold_known_to =
        hypot(usual * answers->mu_hold.value, known(answers->mu_hold.error));
    answers->mu_max_known_to = hypot(usual * answers->mu_max, answers->mu_max_jump);
    answers->first_loading.known_to =
        first_known_to(&answers->first_loading, usual * answers->first_loading.mu.value);
}

void levels_answer_for(const Levels *levels, Answers *answers)
{
    const ErrorBar *mu_M = levels_answer(levels, ANSWER_MU_M);
    const ErrorBar *mu_hold = levels_answer(levels, ANSWER_MU_HOLD);
    const ErrorBar *mu_first = levels_answer(levels, ANSWER_MU_FIRST);
    if (!levels_have_runs(levels)) {
        answers->mu_M.error = answers->mu_hold.error = NAN;
        answers->mu_M_parts = answers->mu_hold_parts = (ErrorParts){NAN, NAN, NAN};
        return;
    }
    answers->mu_M = (Estimate){mu_M->value, mu_M->bar};
    answers->mu_M_parts = mu_M->parts;
    answers->mu_hold = (Estimate){mu_hold->value, mu_hold->bar};
    answers->mu_hold_parts = mu_hold->parts;
    answers->first_loading.mu = (Estimate){mu_first->value, mu_first->bar};
    answers->first_loading.parts = mu_first->parts;
    // If no run of the last level had a peak, its mu_M is that of steady sliding.
    const Level *last = levels_last(levels);
    answers->steady = !isnan(last->answer[ANSWER_MU_M].value);
    for (int32_t k = 0; k < last->run_count; k++)
        answers->steady = answers->steady && last->runs[k].peaks == 0;
    answers->mu_M_known_to = levels_known_to(levels, ANSWER_MU_M);
    answers->mu_hold_known_to = levels_known_to(levels, ANSWER_MU_HOLD);
    answers->first_loading.known_to = levels_known_to(levels, ANSWER_MU_FIRST);
    if (isnan(mu_first->bar))
        answers->first_loading.known_to =
            first_known_to(&answers->first_loading, answers->first_loading.known_to);
}

double levels_order(const Levels *levels)
{
    int32_t last = levels->count - 1;
    if (last < 2) return NAN;
    double ratio = levels->list[last].nodes_along / levels->list[last - 1].nodes_along;
    return log(difference(levels, last - 1, levels->asked) /
               difference(levels, last, levels->asked)) /
           log(ratio);
}

// --- run.json -----------------------------------------------------------------------------------

void levels_write_json(const Levels *levels, JsonWriter *json)
{
    json_begin_object(json, "accuracy");
    json_number(json, "wanted", levels->wanted);
    json_boolean(json, "met", levels->met);
    json_text(json, "of", ANSWER_NAMES[levels->asked]);
    json_text(json, "ended", levels->ended);

    // All values of the run that was cut are null if none was.
    static const LevelCut none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const LevelCut *cut = levels->cut.mesh == 0 ? &none : &levels->cut;
    json_object_of(json, "cut", {"mesh", cut->mesh}, {"run", cut->run},
                   {"contact_nodes", cut->contact_nodes}, {"U", cut->U}, {"part", cut->part},
                   {"seconds", cut->seconds}, {"seconds_expected", cut->seconds_expected},
                   {"mu_M", cut->mu_M}, {"mu_hold", cut->mu_hold});
    json_number(json, "observed_order", levels_order(levels));

    // Values to which the runs of the last level come, and which part of them.
    SeriesItem sorted[LEVEL_RUNS_MAX];
    const Level *last = levels_last(levels);
    int32_t count = 0;
    for (int32_t k = 0; last && k < last->run_count; k++) {
        double value = last->runs[k].answer[levels->asked].value;
        if (!isnan(value)) sorted[count++] = (SeriesItem){.value = value};
    }
    series_sort(sorted, count);
    json_begin_list(json, "branches");
    for (int32_t k = 0; k < count;) {
        SeriesBranch branch;
        k = series_branch(sorted, count, k, BRANCH_WIDTH, &branch);
        json_object_of(json, NULL, {"mu", branch.mean}, {"share", (double)branch.count / count});
    }
    json_end(json);

    json_begin_list(json, "levels");
    for (int32_t l = 0; l < levels->count; l++) {
        const Level *level = &levels->list[l];
        json_begin_object(json, NULL);
        json_numbers_of(json, {"refine", level->refine}, {"contact_nodes", level->contact_nodes},
                        {"seconds", level->seconds}, {"seconds_expected", level->seconds_expected});
        json_boolean(json, "undamped", level->undamped);
        json_boolean(json, "other_drops", level->other_drops);
        json_numbers_of(json, {"slip_cells", level->slip_cells}, {"end_wait", level->end_wait});
        for (AnswerKind kind = 0; kind < ANSWER_KINDS; kind++) {
            const ErrorBar *bar = &level->answer[kind];
            json_begin_object(json, ANSWER_NAMES[kind]);
            json_numbers_of(json, {"value", bar->value}, {"bar", bar->bar});
            error_parts_write(&bar->parts, json);
            json_end(json);
        }
        json_begin_list(json, "runs");
        for (int32_t k = 0; k < level->run_count; k++) {
            const LevelRun *run = &level->runs[k];
            json_begin_object(json, NULL);
            json_numbers_of(json, {"pressure", run->pressure},
                            {"mu_M", run->answer[ANSWER_MU_M].value},
                            {"mu_hold", run->answer[ANSWER_MU_HOLD].value},
                            {"mu_first", run->answer[ANSWER_MU_FIRST].value}, {"peaks", run->peaks},
                            {"period", run->period});
            json_text(json, "run_in", run_in_name(run->run_in));
            json_integer(json, "steps", run->steps);
            json_end(json);
        }
        json_end(json);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}
