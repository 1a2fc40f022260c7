// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/optimise.h"

#include "base/memory.h"
#include "io/text/json_reader.h"
#include "study/search/search_answer.h"
#include "study/sweep/computing/point.h"

#include <math.h>
#include <stdio.h>

enum { OTHERS_SHOWN = 5 };
enum { COST_LEAST = 2, COST_MOST = 4 };   // what half an error costs, over what it cost

static const char *quantity(const Search *search)
{
    return search->study->records[search->study->rank.record].name;
}

static bool is_on_section(const Search *search, int32_t best, int32_t k, int32_t d)
{
    const Design *one = &search->designs.list[d], *top = &search->designs.list[best];
    if (isnan(one->value)) return false;
    for (int32_t i = 0; i < search->study->search.key_count; i++)
        if (i != k && one->x[i] != top->x[i]) return false;
    return true;
}

// --- words --------------------------------------------------------------------------------------

// Prints a value without an error bar in the digits that are known.
static void print_estimate(const Design *design, FILE *out)
{
    char text[ESTIMATE_SIZE];
    double bar = design->has_bar ? design->bar : (double)NAN;
    amontons_estimate(design->value, bar, design->bar, text);
    fprintf(out, "%s", text);
    if (design->has_bar || isnan(design->value)) return;
    amontons_known_to(design->value, design->bar, text);
    fprintf(out, ", %s", text);
}

// Time of a design's points, s.
static double design_seconds(const Search *search, int32_t d)
{
    double sum = 0;
    for (int32_t c = 0; c < search->designs.conditions; c++) {
        Error ignored = {0};
        double seconds = 0;
        char *report = point_report(search->sweep, search->designs.list[d].point + c, &ignored);
        if (report && json_find_number(report, "timing_s.total", &seconds)) sum += seconds;
        memory_free(report);
    }
    return sum;
}

static void print_open(const Search *search, int32_t best, FILE *out)
{
    int32_t open = 0, settled = 0, left = 0;
    double seconds = design_seconds(search, best);
    for (int32_t d = 0; d < search->designs.count; d++) {
        char words[OPTIMISE_WORDS_SIZE];
        if (!designs_may_equal(&search->designs, best, d)) continue;
        seconds += design_seconds(search, d);
        bool leads = designs_may_lead(&search->designs, best, d);
        left += !leads;
        settled += leads && search->designs.list[d].settled;
        if (open++ >= OTHERS_SHOWN) continue;
        design_words(search->study, &search->designs.list[d], words);
        fprintf(out, "%s    %s: ", open == 1 ? "  may be as good, within the bars of both:\n" : "",
                words);
        print_estimate(&search->designs.list[d], out);
        fprintf(out, "\n");
    }
    if (open > OTHERS_SHOWN) fprintf(out, "    ... and %d more\n", open - OTHERS_SHOWN);
    if (open == 0) fprintf(out, "  better than every other design, with the bars of both\n");
    if (open == 0) return;
    if (settled > 0)
        fprintf(
            out,
            "  %d of them missed the error bar asked for by far, or have none: only more time "
            "for a run (accuracy.within), or a bar asked of what is ranked (accuracy.of), would "
            "tell\n",
            settled);
    if (left > 0)
        fprintf(out,
                "  %d of them would have to come out above their own values, too: left as they "
                "are\n",
                left);
    if (open == settled + left) return;
    if (search->study->rank.refine > 0)
        fprintf(out,
                "  telling them apart needs a smaller `refine` than %g %% (half the error of all "
                "takes some %.0f to %.0f s of one processor), or does not matter\n",
                100 * search->study->rank.refine, COST_LEAST * seconds, COST_MOST * seconds);
    else
        fprintf(out, "  `rank: {refine: 1%%}` with `set: {accuracy.mu: 4%%}` computes them again "
                     "until they are told apart\n");
}

static void print_answer(const Search *search, const OptimiseSummary *summary, int32_t best,
                         FILE *out)
{
    static const char *const over[] = {[OVER_WORST] = "worst",
                                       [OVER_MEAN] = "mean",
                                       [OVER_DEVIATION] = "standard deviation",
                                       [OVER_FRONT] = "mean"};
    const Designs *designs = &search->designs;
    Error ignored = {0};
    if (search->study->search.over == OVER_FRONT) pareto_front_print(search, out, &ignored);
    fprintf(out, "%s, %s%s of %d designs", quantity(search),
            search->study->rank.lowest ? "the lowest" : "the highest",
            designs->has_bars ? " for sure (by its bar)" : "", summary->designs);
    if (designs->conditions > 1)
        fprintf(out, ", %s of %d points each", over[search->study->search.over],
                designs->conditions);
    fprintf(out, ":\n  %s: ", summary->best);
    print_estimate(&designs->list[best], out);
    fprintf(out, "\n");
    int32_t finer = 0;
    for (int32_t d = 0; d < designs->count; d++) finer += designs->list[d].is_finer;
    if (designs->list[best].is_finer)
        fprintf(out,
                "  computed once more for half its bar, as the best of many is so by luck, too%s\n",
                finer > 1 ? "; what was better before came out worse" : "");
    if (best == search->start && !isnan(summary->start_value))
        fprintf(out, "  this is the scene as it is\n");
    else if (!isnan(summary->start_value)) {
        const Design *start = &designs->list[search->start];
        char words[OPTIMISE_WORDS_SIZE];
        double ratio = summary->value / summary->start_value;
        double error = fabs(ratio) * hypot(summary->bar / summary->value,
                                           summary->start_bar / summary->start_value);
        design_words(search->study, start, words);
        fprintf(out, "  the scene as it is, %s: ", words);
        print_estimate(start, out);
        fprintf(out, "; the best differs by %+.1f %%", 100 * (ratio - 1));
        if (isnan(error))
            fprintf(out, ", whose error is not known\n");
        else
            fprintf(out, " +- %.1f %%\n", 100 * error);
    }
    print_open(search, best, out);

    // The designs that differ from the best in one key alone.
    for (int32_t k = 0; k < search->study->search.key_count; k++) {
        const SearchKey *key = &search->study->search.keys[k];
        double last = -INFINITY;
        fprintf(out, "  along %s:", key->key);
        for (;;) {   // by value: the next larger one each time
            int32_t next = -1;
            for (int32_t d = 0; d < designs->count; d++)
                if (is_on_section(search, best, k, d) && designs->list[d].x[k] > last &&
                    (next < 0 || designs->list[d].x[k] < designs->list[next].x[k]))
                    next = d;
            if (next < 0) break;
            fprintf(out, "%s %.4g: ", isinf(last) ? "" : ",", designs->list[next].x[k]);
            print_estimate(&designs->list[next], out);
            last = designs->list[next].x[k];
        }
        bool edge = designs->list[best].x[k] == key->least || designs->list[best].x[k] == key->most;
        fprintf(out, "%s\n", edge ? "; the best is at the edge of the range: look beyond" : "");
    }
    search_print_exhausted(search, out);
    if (search->refused > 0)
        fprintf(out, "  %d more have no scene, the first: %s\n", search->refused,
                search->refusal.message);
    fprintf(out,
            "  its run again, with pictures: amontons run %s/best.yaml --set "
            "output.history=true output.figures=[force,slip-map] -o best\n",
            search->options->folder);
}

// --- the whole ----------------------------------------------------------------------------------

bool optimise_report(const Search *search, const OptimiseSummary *summary, Error *err)
{
    const Designs *designs = &search->designs;
    int32_t best = designs_best(designs), all = designs->count;
    double *x = NULL;
    SearchAnswer answer;
    TRY(search_answer_begin(&answer, err));
    print_answer(search, summary, best, answer.out);
    TRY(search_answer_end(search, &answer, err));

    // Draws every design in the order of its choice, and the best so far.
    TRY(x = NEW_ARRAY(double, 4 * (int64_t)all, err));
    double *y = x + all, *error = y + all, *so_far = error + all;
    const Design *leader = NULL;
    for (int32_t d = 0; d < all; d++) {
        const Design *one = &designs->list[d];
        if (!isnan(one->value) && (!leader || design_is_better(designs, one, leader))) leader = one;
        x[d] = d + 1, y[d] = one->value, error[d] = one->bar;
        so_far[d] = leader ? leader->value : (double)NAN;
    }
    Curve course[] = {search_dots("designs", all, x, y),
                      search_line("best so far", all, x, so_far)};
    course[0].error = error;
    Frame over_designs = {
        "course", "linear", "linear", {.words = "design"}, quantity_label(quantity(search), false)};
    TRY(search_draw(search, &over_designs, course, 2, err));
    if (search->study->search.over == OVER_FRONT) TRY(pareto_front_draw(search, err));

    // Draws the designs that differ from the best in one key alone, over that key.
    const Design *best_design = &designs->list[best];
    for (int32_t k = 0; k < search->study->search.key_count; k++) {
        char name[STUDY_NAME_SIZE + 8];
        int32_t count = 0;
        for (int32_t d = 0; d < all; d++) {
            if (!is_on_section(search, best, k, d)) continue;
            x[count] = designs->list[d].x[k], y[count] = designs->list[d].value;
            error[count++] = designs->list[d].bar;
        }
        snprintf(name, sizeof name, "along_%s", search->study->search.keys[k].key);
        Frame frame = {name, search_key_scale(search, k), "linear", search_key_label(search, k),
                       quantity_label(quantity(search), false)};
        Curve curves[] = {search_dots("others as in the best", count, x, y),
                          search_dots("the best", 1, &best_design->x[k], &best_design->value)};
        curves[0].error = error;
        curves[1].marker = "square";
        curves[1].color = COLOR_BEST;
        TRY(search_draw(search, &frame, curves, 2, err));
    }
    TRY(search_leave_best(search, best, best_design->deciding, err));
cleanup:
    memory_free(x);
    return error_is_clean(err);
}
