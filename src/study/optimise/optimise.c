// SPDX-License-Identifier: GPL-2.0-or-later
// study read -> designs chosen, in rounds of as many as are computed side by side -> those along
// each key through the best -> the best decided with smaller error bars -> answer and figures.
//
// A round is an ordinary sweep over all designs so far: what is finished is found again, so that a
// search that was stopped makes the same choices from the same values and goes on.
#include "base/clock.h"
#include "base/formula.h"
#include "base/memory.h"
#include "base/module.h"
#include "scene/formulas.h"
#include "study/optimise/search_report.h"
#include "study/sweep/reading/study_point.h"
#include "study/sweep/reading/study_read.h"
#include "study/sweep/reading/study_vary.h"
#include "study/sweep/sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    TRIES_MAX = 1000,   // choices that `where` refuses, one after the other
    SECTION_POINTS = 5,   // along a key
    LEADERS = 4,   // computed with a smaller error at a time
    BESTS_MAX = 3,   // times that deciding may come to another design
};
static const double REFUSED = 0.5;   // below the worst, in parts of what values differ by

static double scaled(const SearchKey *key, double value)
{
    return key->scale == SEARCH_LOG ? log(value) : value;
}

static double unscaled(const SearchKey *key, double value)
{
    return key->scale == SEARCH_LOG ? exp(value) : value;
}

// --- computing ----------------------------------------------------------------------------------

// For a SweepCallback: what is found again was told before.
static void take_point(const SweepView *view, void *context)
{
    Search *search = context;
    const SweepOptions *options = search->options;
    bool told = search->designs.known[view->point] && view->reused, has_bar = !isnan(view->bar);
    search->designs.known[view->point] = true;
    search->designs.points[view->point] =
        (DesignPoint){view->value, has_bar ? view->bar : view->known_to, has_bar};
    if (view->run && view->point == search->told_of)
        snprintf(search->run, sizeof search->run, "%s", view->run);
    search->computed += !view->reused;
    if (told || !options->on_point) return;
    SweepView shown = *view;
    shown.finished = ++search->told;
    shown.points = search->told > search->planned ? search->told : search->planned;
    shown.seconds_left = (clock_seconds() - search->started) / search->told *
                         (shown.points - search->told);
    options->on_point(&shown, options->context);
}

// All designs; the sweep computes those that wait.
static bool compute(Search *search, bool pictures, Error *err)
{
    Designs *designs = &search->designs;
    SweepOptions options = *search->options;
    SweepSummary summary;
    char *text = designs_text(designs, designs->list, designs->count, err);
    TRY(text);
    options.on_point = take_point;
    options.context = search;
    options.out = NULL;
    SweepCases cases = {text, search->begun ? designs->known : NULL, pictures};
    search->begun = true;
    TRY(sweep_cases(search->study.path, &cases, &options, &summary, err));
    for (int32_t d = 0; d < designs->count; d++) designs_judge(designs, d);
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

// --- designs ------------------------------------------------------------------------------------

// Whether it keeps all of `where`, at the first point of `vary`.
static bool is_allowed(Search *search, const double *x, bool *allowed, Error *err)
{
    Study *study = &search->study;
    Design design = {.choice = -1};
    memcpy(design.x, x, sizeof design.x);
    char *text = designs_text(&search->designs, &design, 1, err);
    *allowed = true;
    TRY(text);
    TRY(study_set_cases(study, text, err));
    TRY(study_point_scene(study, 0, search->scene, err));
    for (int32_t k = 0; k < study->search.limit_count && *allowed; k++) {
        const SearchLimit *limit = &study->search.limits[k];
        double value = 0;
        const char *formula = strchr(yaml_text(study->file, limit->formula), '=') + 1;
        if (!formula_value(formula, scene_number, search->scene, &value, err)) {
            error_context(err, "%s:%d: where", study->path, yaml_line(study->file, limit->formula));
            goto cleanup;
        }
        *allowed = value >= limit->least && value <= limit->most;
    }
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

// The scene with `set`, at the first point of `vary`, if all that is searched has a value there
// within its range.
static bool add_start(Search *search, Error *err)
{
    const StudySearch *keys = &search->study.search;
    double x[STUDY_SEARCH_MAX] = {0};
    bool allowed = true;
    TRY(study_point_scene(&search->study, 0, search->scene, err));
    for (int32_t k = 0; k < keys->key_count; k++) {
        char words[SCENE_TEXT_SIZE];
        study_scene_value(search->scene, keys->keys[k].key, words, sizeof words, &x[k]);
        allowed = allowed && x[k] >= keys->keys[k].least && x[k] <= keys->keys[k].most;
    }
    if (!allowed) goto cleanup;
    designs_round(&search->study, x);
    TRY(is_allowed(search, x, &allowed, err));
    if (allowed) search->start = designs_add(&search->designs, x, -1);
cleanup:
    return error_is_clean(err);
}

// What the chooser is told of a design that is refused or comes to nothing.
static double below_the_worst(const Search *search)
{
    double low = INFINITY, high = -INFINITY, sign = search->study.rank.lowest ? -1 : 1;
    for (int32_t d = 0; d < search->designs.count; d++) {
        double value = sign * search->designs.list[d].value;
        if (isnan(value)) continue;
        low = fmin(low, value);
        high = fmax(high, value);
    }
    return low <= high ? low - REFUSED * (high - low) : 0;
}

static bool tell(Search *search, int32_t choice, double value, Error *err)
{
    double sign = search->study.rank.lowest ? -1 : 1;
    double told = isnan(value) ? below_the_worst(search) : sign * value;
    return search->module->tell(search->chooser, choice, told, err);
}

// The next design that is allowed and new. *added: there is one.
static bool choose(Search *search, bool *added, Error *err)
{
    const StudySearch *keys = &search->study.search;
    *added = false;
    for (int32_t k = 0; k < TRIES_MAX && !*added; k++) {
        double x[STUDY_SEARCH_MAX] = {0};
        int32_t number = 0;
        bool allowed = true;
        TRY(search->module->choose(search->chooser, x, &number, err));
        for (int32_t i = 0; i < keys->key_count; i++) x[i] = unscaled(&keys->keys[i], x[i]);
        designs_round(&search->study, x);
        int32_t known = designs_find(&search->designs, x);
        if (known < 0) TRY(is_allowed(search, x, &allowed, err));
        *added = known < 0 && allowed;
        if (*added)
            designs_add(&search->designs, x, number);
        else
            TRY(tell(search, number, known < 0 ? NAN : search->designs.list[known].value, err));
    }
cleanup:
    return error_is_clean(err);
}

static bool search_designs(Search *search, Error *err)
{
    int32_t chosen = 0;
    bool added = true;
    if (search->start >= 0) TRY(compute(search, false, err));
    while (chosen < search->study.search.designs && added) {
        int32_t first = search->designs.count;
        for (int32_t k = 0; k < search->side_by_side && added; k++) {
            if (chosen == search->study.search.designs) break;
            TRY(choose(search, &added, err));
            chosen += added;
        }
        TRY(compute(search, false, err));
        for (int32_t d = first; d < search->designs.count; d++)
            TRY(tell(search, search->designs.list[d].choice, search->designs.list[d].value, err));
    }
cleanup:
    return error_is_clean(err);
}

// Along key `k` through the best design, the others as in it.
static bool add_section(Search *search, int32_t best, int32_t k, Error *err)
{
    const SearchKey *key = &search->study.search.keys[k];
    double least = scaled(key, key->least), most = scaled(key, key->most);
    for (int32_t i = 0; i < SECTION_POINTS; i++) {
        double x[STUDY_SEARCH_MAX];
        bool allowed = true;
        memcpy(x, search->designs.list[best].x, sizeof x);
        x[k] = unscaled(key, least + (most - least) * i / (SECTION_POINTS - 1));
        designs_round(&search->study, x);
        if (designs_find(&search->designs, x) >= 0 || search->designs.count == DESIGNS_MAX)
            continue;
        TRY(is_allowed(search, x, &allowed, err));
        if (allowed) designs_add(&search->designs, x, -1);
    }
cleanup:
    return error_is_clean(err);
}

static bool compute_sections(Search *search, int32_t best, Error *err)
{
    for (int32_t k = 0; k < search->study.search.key_count; k++)
        TRY(add_section(search, best, k, err));
    TRY(compute(search, false, err));
cleanup:
    return error_is_clean(err);
}

// --- deciding -----------------------------------------------------------------------------------

// With another accuracy its points are others.
static void forget(Search *search, const Design *design)
{
    Designs *designs = &search->designs;
    bool *known = &designs->known[designs_point(designs, (int32_t)(design - designs->list))];
    memset(known, 0, (size_t)designs->conditions * sizeof *known);
}

// Half the error that was asked for or, where that is smaller, of the one that came out. false: it
// is as small as it may get.
static bool next_accuracy(Search *search, Design *design)
{
    double limit = search->study.rank.refine, came_out = design->bar / fabs(design->value);
    double asked = design->accuracy > 0 ? design->accuracy : search->accuracy;
    double next = fmax(fmin(asked, came_out) / 2, limit);
    if (design->settled || !(limit > 0) || asked <= limit) return false;
    design->accuracy = next;
    forget(search, design);
    return true;
}

// Of those not in `taken` the design that may be the highest, if it may be above the value of the
// best: one below may still be as good, by the bar of the best, but computing it does not tell.
static int32_t next_leader(const Search *search, int32_t best, const bool *taken)
{
    double sign = search->study.rank.lowest ? -1 : 1, top = -INFINITY;
    int32_t leader = -1;
    for (int32_t d = 0; d < search->designs.count; d++) {
        const Design *one = &search->designs.list[d];
        double reach = sign * one->value + one->bar;
        if (taken[d] || !(reach >= sign * search->designs.list[best].value)) continue;
        if (reach > top) top = reach, leader = d;
    }
    return leader;
}

// A design that comes to nothing with a smaller error keeps what it had.
static bool decide_round(Search *search, int32_t best, bool *again, Error *err)
{
    bool *taken = NEW_ARRAY(bool, DESIGNS_MAX, err);
    int32_t leaders[LEADERS], count = 0;
    Design before[LEADERS];
    TRY(taken);
    *again = false;
    for (int32_t d; count < LEADERS && (d = next_leader(search, best, taken)) >= 0;) {
        Design *design = &search->designs.list[d];
        taken[d] = true;
        before[count] = *design;
        if (next_accuracy(search, design)) leaders[count++] = d;
    }
    if (count == 0) goto cleanup;
    TRY(compute(search, false, err));
    for (int32_t k = 0; k < count; k++) {
        Design *design = &search->designs.list[leaders[k]];
        if (isnan(design->value)) *design = before[k], design->settled = true;
        *again = true;
    }
cleanup:
    memory_free(taken);
    return error_is_clean(err);
}

static bool decide(Search *search, Error *err)
{
    bool again = true;
    while (again) {
        int32_t best = designs_best(&search->designs);
        bool open = false;
        for (int32_t d = 0; d < search->designs.count; d++)
            open = open || designs_may_equal(&search->designs, best, d);
        again = false;
        if (open) TRY(decide_round(search, best, &again, err));
    }
cleanup:
    return error_is_clean(err);
}

static bool finish_search(Search *search, Error *err)
{
    int32_t best = designs_best(&search->designs);
    for (int32_t k = 0, last = -1; k < BESTS_MAX && best >= 0 && best != last; k++) {
        TRY(compute_sections(search, best, err));
        TRY(decide(search, err));
        last = best;
        best = designs_best(&search->designs);
    }
    if (best < 0)
        FAIL(err, ERROR_COMPUTE, "%s: no design of %d came to a value of %s; see sweep.csv",
             search->study.path, search->designs.count,
             search->study.records[search->study.rank.record].name);
cleanup:
    return error_is_clean(err);
}

// --- the whole ----------------------------------------------------------------------------------

static bool open_chooser(Search *search, Error *err)
{
    const StudySearch *keys = &search->study.search;
    double least[STUDY_SEARCH_MAX], most[STUDY_SEARCH_MAX];
    bool whole[STUDY_SEARCH_MAX];
    for (int32_t k = 0; k < keys->key_count; k++) {
        least[k] = scaled(&keys->keys[k], keys->keys[k].least);
        most[k] = scaled(&keys->keys[k], keys->keys[k].most);
        whole[k] = keys->keys[k].scale == SEARCH_WHOLE;
    }
    ChooserSpace space = {keys->key_count, least, most, whole, keys->seed};
    ChooserModuleFunction module =
        (ChooserModuleFunction)module_function("dlib", "amontons_chooser_module", err);
    TRY(module);
    search->module = module();
    TRY(search->chooser = search->module->create(&space, err));
cleanup:
    return error_is_clean(err);
}

static bool open_search(Search *search, const char *path, Error *err)
{
    Study *study = &search->study;
    const SweepOptions *options = search->options;
    TRY(study_read(path, options->overrides, options->override_count, study, err));
    if (study->search.node == YAML_NO_NODE)
        FAIL(err, ERROR_INPUT,
             "%s: nothing to search: a study for `optimise` has `search`, as in `search: "
             "{mesh.set.n: {whole: [1, 12]}}`",
             path);
    if (!study->rank.wanted)
        FAIL(err, ERROR_INPUT, "%s: what is best? say `rank: {by: mu_hold}`", path);
    TRY(search->scene = NEW_ARRAY(Scene, 1, err));
    TRY(designs_create(study, &search->designs, err));
    TRY(open_chooser(search, err));
    TRY(add_start(search, err));
    search->accuracy = search->scene->accuracy.mu;
    if (study->rank.refine > 0 && !(search->accuracy > 0))
        FAIL(err, ERROR_INPUT,
             "%s: rank: `refine` halves accuracy.mu, which must be given to begin with, as in "
             "`set: {accuracy.mu: 3%%}`",
             path);
    int64_t cores = options->jobs > 0 ? options->jobs : sysconf(_SC_NPROCESSORS_ONLN);
    search->side_by_side = (int32_t)fmax(1, floor((double)cores / search->designs.conditions));
    search->planned = search->designs.conditions *
                      (study->search.designs + (SECTION_POINTS - 1) * study->search.key_count +
                       (search->start >= 0));
cleanup:
    return error_is_clean(err);
}

static void summarise(const Search *search, OptimiseSummary *summary)
{
    const Designs *designs = &search->designs;
    int32_t best = designs_best(designs);
    const Design *top = &designs->list[best];
    *summary = (OptimiseSummary){.computed = search->computed,
                                 .value = top->value,
                                 .bar = top->bar,
                                 .decided = true,
                                 .start_value = NAN,
                                 .start_bar = NAN,
                                 .seconds = clock_seconds() - search->started};
    design_words(&search->study, top, summary->best);
    for (int32_t d = 0; d < designs->count; d++) {
        summary->designs += !isnan(designs->list[d].value);
        if (designs_may_equal(designs, best, d)) summary->decided = false;
    }
    if (search->start < 0) return;
    summary->start_value = designs->list[search->start].value;
    summary->start_bar = designs->list[search->start].bar;
}

bool amontons_optimise(const char *path, const SweepOptions *options, OptimiseSummary *summary,
                       Error *err)
{
    *summary = (OptimiseSummary){.value = NAN, .bar = NAN, .start_value = NAN, .start_bar = NAN};
    Search *search = NEW_ARRAY(Search, 1, err);
    TRY(search);
    search->options = options;
    search->started = clock_seconds();
    search->start = -1;
    search->told_of = -1;
    TRY(open_search(search, path, err));
    TRY(search_designs(search, err));
    TRY(finish_search(search, err));
    int32_t best = designs_best(&search->designs);
    search->told_of = designs_point(&search->designs, best) + search->designs.list[best].deciding;
    TRY(compute(search, true, err));
    summarise(search, summary);
    TRY(search_report(search, summary, err));
cleanup:
    if (search) {
        if (search->module) search->module->destroy(search->chooser);
        designs_destroy(&search->designs);
        study_destroy(&search->study);
        memory_free(search->scene);
    }
    memory_free(search);
    return error_is_clean(err);
}
