// SPDX-License-Identifier: GPL-2.0-or-later
// study read -> designs chosen, in rounds of as many as are computed side by side (search), in turn
// with those along each key through the best -> the best decided with smaller error bars ->
// answer, figures.
#include "study/search/optimise.h"

#include "base/clock.h"
#include "base/decimal_point.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

enum {
    // Parts of the search; between them designs along the keys through the best so far, which lead
    // out of where the library has settled. More parts find the best more often and take more
    // designs; a fourth one gains little.
    PARTS = 3,
    SECTION_POINTS = 5,   // along a key
    LEADERS = 4,   // computed with a smaller error at a time
    BESTS_MAX = 3,   // times that deciding may come to another design
};

// Largest ratio of a run's error bar to the error asked for. A run with a larger ratio was ended by
// its time (accuracy.within); asked for half the error, it would end with the same meshes.
static const double MISSED_BY_FAR = 2;

// --- what a design is worth ---------------------------------------------------------------------

static bool take_value(Search *search, int32_t d, int32_t c, const char *report, Error *err)
{
    (void)err;
    const Designs *designs = &search->designs;
    for (int32_t a = c; a < designs->aims; a += designs->conditions) {
        int32_t record = designs_aim(designs, a).record;
        designs_points(designs, d)[a] = point_value(report, search->study->records[record].path);
    }
    return true;
}

static void judge_design(Search *search, int32_t d)
{
    designs_judge(&search->designs, d);
}

// --- sections -----------------------------------------------------------------------------------

static bool compute_sections(Search *search, int32_t best, Error *err)
{
    int32_t first = search->designs.count;
    for (int32_t k = 0; k < search->study->search.key_count; k++) {
        // A section goes along key `k` through the best design, the other keys as in it.
        const SearchKey *key = &search->study->search.keys[k];
        double least = search_scaled(key, key->least), most = search_scaled(key, key->most);
        for (int32_t i = 0; i < SECTION_POINTS; i++) {
            double x[STUDY_SEARCH_MAX];
            int32_t added = -1;
            memcpy(x, search->designs.list[best].x, sizeof x);
            x[k] = search_unscaled(key, least + (most - least) * i / (SECTION_POINTS - 1));
            if (!search_add(search, x, &added, err)) return false;
        }
    }

    return search_compute_from(search, first, err);
}

// --- deciding -----------------------------------------------------------------------------------

// Half the error that was asked for or, where that is smaller, of the one that came out. false: it
// is as small as it may get, or as the time for a run makes it.
static bool next_accuracy(const Search *search, Design *design, double limit, Error *err)
{
    const Scene *scene = point_scene(search->sweep, design->point, err);
    if (!scene) return false;
    double came_out = design->bar / fabs(design->value);
    double asked = design->accuracy > 0 ? design->accuracy : scene->accuracy.mu;
    double has = fmin(asked, came_out);
    if (!design->has_bar || came_out > MISSED_BY_FAR * asked) design->settled = true;
    if (design->settled || has <= limit) return false;
    design->accuracy = fmax(has / 2, limit);
    return true;
}

// Rounds of smaller errors, as long as another design may be as good as the best. A design that
// comes to nothing with a smaller error keeps what it had.
static bool decide(Search *search, Error *err)
{
    bool again = search->study->rank.refine > 0;
    while (again) {
        int32_t leaders[LEADERS], count = 0, best = designs_best(&search->designs);
        Design before[LEADERS];
        bool taken[DESIGNS_MAX] = {false}, open = false;
        again = false;
        for (int32_t d = 0; d < search->designs.count; d++)
            open = open || designs_may_equal(&search->designs, best, d);
        if (!open) break;
        while (count < LEADERS) {
            // Chooses, among the designs not in `taken` that a smaller bar alone could make the
            // best, the one whose bar reaches furthest. A design that would need a better value,
            // too, is left out.
            double sign = search->designs.lowest ? -1 : 1, top = -INFINITY;
            int32_t d = -1;
            for (int32_t i = 0; i < search->designs.count; i++) {
                const Design *one = &search->designs.list[i];
                double reach = sign * one->value + one->bar;
                if (taken[i] || !designs_may_lead(&search->designs, best, i)) continue;
                if (reach > top) top = reach, d = i;
            }
            if (d < 0) break;
            Design *design = &search->designs.list[d];
            taken[d] = true;
            before[count] = *design;
            if (next_accuracy(search, design, search->study->rank.refine, err))
                leaders[count++] = d;
            if (!error_is_clean(err)) return false;
        }
        if (count == 0) break;
        if (!search_compute(search, leaders, count, err)) return false;
        for (int32_t k = 0; k < count; k++) {
            Design *design = &search->designs.list[leaders[k]];
            if (isnan(design->value)) *design = before[k], design->settled = true;
        }
        again = true;
    }
    return error_is_clean(err);
}

// The best of many is so by its luck, too: it is computed once more with half its bar. One whose
// bar comes out no shorter, as the time for a run makes it, keeps what it had.
static bool confirm(Search *search, Error *err)
{
    const Designs *designs = &search->designs;
    for (;;) {
        // Takes the best design. If that was computed once more already, it takes the next one
        // where its value is now the better one.
        int32_t best = designs_best(designs), next = -1;
        const Design *list = designs->list;
        for (int32_t d = 0; d < designs->count; d++)
            if (!list[d].confirmed && !isnan(list[d].value) &&
                (next < 0 || design_is_better(designs, &list[d], &list[next])))
                next = d;
        if (next < 0) break;
        double ahead = list[next].value - list[best].value;
        if (next != best && !((designs->lowest ? -ahead : ahead) > 0)) break;

        Design *design = &search->designs.list[next], before = *design;
        design->confirmed = before.confirmed = before.settled = true;
        if (!next_accuracy(search, design, 0, err)) continue;
        if (!search_compute(search, &next, 1, err)) return false;
        design->is_finer = design->has_bar && design->bar < before.bar;
        if (!design->is_finer) *design = before;
    }
    return error_is_clean(err);
}

static bool has_front(const Search *search)
{
    return search->study->search.over == OVER_FRONT;
}

// Makes `aim` the aim that counts and judges all designs by it; -1: the mean.
static void set_aim(Search *search, int32_t aim)
{
    search->designs.aim = aim;
    search->designs.lowest = designs_aim(&search->designs, aim < 0 ? 0 : aim).lowest;
    for (int32_t d = 0; d < search->designs.count; d++) designs_judge(&search->designs, d);
}

// --- the whole ----------------------------------------------------------------------------------

bool amontons_optimise(const char *path, const SweepOptions *options, OptimiseSummary *summary,
                       Error *err)
{
    NUMBERS_HAVE_A_POINT;
    *summary = (OptimiseSummary){.value = NAN, .bar = NAN, .start_value = NAN, .start_bar = NAN};
    Search *search = NEW_ARRAY(Search, 1, err);
    TRY(search);

    // The study must say which design is best.
    TRY(search_open(search, path, options, false, err));
    const StudyRank *rank = &search->study->rank;
    const StudySearch *keys = &search->study->search;
    if (!rank->wanted) FAIL(err, ERROR_INPUT, "%s: what is best? say `rank: {by: mu_hold}`", path);
    if (keys->over == OVER_DEVIATION && !rank->lowest)
        FAIL(err, ERROR_INPUT,
             "%s: best: of a deviation the least is best: say `order: lowest` in `rank`", path);
    if (keys->over == OVER_FRONT && rank->refine > 0)
        FAIL(err, ERROR_INPUT, "%s: best: `over: front` does not go with `refine`", path);
    search->judge = (SearchJudge){take_value, judge_design, NULL};
    TRY(search_begin(search, 0, NULL, err));
    Designs *designs = &search->designs;
    int32_t chosen = 0, wanted = keys->designs;
    // A front has a part for the mean of its aims and one for each aim.
    int32_t parts = has_front(search) ? 1 + designs->aims : PARTS;
    search->sweep->planned += designs->conditions * parts * (SECTION_POINTS - 1) * keys->key_count;

    // Parts of the search, and between them designs along the keys through the best.
    for (int32_t part = 1; part <= parts; part++) {
        int32_t until = wanted * part / parts;
        if (has_front(search)) set_aim(search, part - 2);
        TRY(search_designs(search, until - chosen, err));
        chosen = until;
        int32_t top = designs_best(designs);
        if (top >= 0) TRY(compute_sections(search, top, err));
    }
    if (has_front(search)) set_aim(search, -1);

    // The best is decided, which may make another one the best.
    int32_t best = designs_best(designs);
    for (int32_t k = has_front(search) ? BESTS_MAX : 0, last = -1;
         k < BESTS_MAX && best >= 0 && best != last; k++) {
        TRY(compute_sections(search, best, err));
        TRY(decide(search, err) && confirm(search, err));
        last = best;
        best = designs_best(designs);
    }
    if (best < 0)
        FAIL(err, ERROR_COMPUTE, "%s: no design of %d came to a value of %s; see sweep.csv",
             search->study->path, designs->count, search->study->records[rank->record].name);

    *summary = (OptimiseSummary){.computed = search->sweep->computed,
                                 .value = designs->list[best].value,
                                 .bar = designs->list[best].bar,
                                 .decided = true,
                                 .start_value = NAN,
                                 .start_bar = NAN,
                                 .seconds = clock_seconds() - search->sweep->started};
    design_words(search->study, &designs->list[best], summary->best);
    for (int32_t d = 0; d < designs->count; d++) {
        summary->designs += !isnan(designs->list[d].value);
        if (designs_may_equal(designs, best, d)) summary->decided = false;
    }
    if (search->start >= 0) {
        summary->start_value = designs->list[search->start].value;
        summary->start_bar = designs->list[search->start].bar;
    }
    TRY(optimise_report(search, summary, err));
cleanup:
    if (search) search_close(search, err);
    memory_free(search);
    return error_is_clean(err);
}
