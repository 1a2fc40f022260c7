// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/optimise.h"

#include "base/memory.h"
#include "base/order.h"
#include "study/search/search_answer.h"
#include "study/sweep/reading/study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// True if `a` is at least as good as `b` at each aim, and better at one.
static bool dominates(const Designs *designs, int32_t a, int32_t b)
{
    const PointValue *one = designs_points(designs, a), *other = designs_points(designs, b);
    bool better = false;
    for (int32_t k = 0; k < designs->aims; k++) {
        double sign = designs_aim(designs, k).lowest ? -1 : 1;
        double ahead = sign * (one[k].value - other[k].value);
        if (!(ahead >= 0)) return false;
        better = better || ahead > 0;
    }
    return better;
}

bool pareto_front_holds(const Designs *designs, int32_t design)
{
    bool holds = !isnan(designs->list[design].value);
    for (int32_t other = 0; other < designs->count && holds; other++)
        holds = isnan(designs->list[other].value) || !dominates(designs, other, design);
    return holds;
}

typedef struct Placed {
    double first;   // value at the first aim
    int32_t design;
} Placed;

// Lists those on the front by their first value; *front: [count], owned by the caller.
static bool list_front(const Designs *designs, Placed **front, int32_t *count, Error *err)
{
    *count = 0;
    if (!(*front = NEW_ARRAY(Placed, designs->count, err))) return false;
    for (int32_t d = 0; d < designs->count; d++)
        if (pareto_front_holds(designs, d))
            (*front)[(*count)++] = (Placed){designs_points(designs, d)->value, d};
    qsort(*front, (size_t)*count, sizeof **front, order_doubles);
    return true;
}

// "load.pressure=0.004" of the point of `vary` of an aim; "": there is one alone.
static bool aim_words(const Search *search, int32_t aim, char words[POINT_WORDS_SIZE], Error *err)
{
    const Study *study = search->study;
    words[0] = 0;
    int32_t c = aim % search->designs.conditions;
    if (!study_scene(study, &(PointChoice){.point = c}, search->scene, err)) return false;
    for (int32_t k = 0; k < study->axis_count; k++)
        study_add_words(search->scene, study->axes[k].key, words, POINT_WORDS_SIZE);
    return true;
}

bool pareto_front_print(const Search *search, FILE *out, Error *err)
{
    const Designs *designs = &search->designs;
    Placed *front = NULL;
    int32_t count = 0;
    char words[POINT_WORDS_SIZE];
    TRY(list_front(designs, &front, &count, err));
    fprintf(out, "%d aims:\n", designs->aims);
    for (int32_t a = 0; a < designs->aims; a++) {
        StudyAim aim = designs_aim(designs, a);
        TRY(aim_words(search, a, words, err));
        fprintf(out, "  %d: the %s %s%s%s\n", a + 1, aim.lowest ? "lowest" : "highest",
                search->study->records[aim.record].name, *words ? " at " : "", words);
    }
    fprintf(
        out,
        "%d designs of %d, none of which another is better than at all aims, by values alone:\n",
        count, designs->count);
    for (int32_t k = 0; k < count; k++) {
        const PointValue *points = designs_points(designs, front[k].design);
        design_words(search->study, &designs->list[front[k].design], words);
        fprintf(out, "  %s:", words);
        for (int32_t a = 0; a < designs->aims; a++) {
            char text[ESTIMATE_SIZE];
            amontons_estimate(points[a].value, points[a].bar, points[a].known_to, text);
            fprintf(out, "%s %s", a ? "," : "", text);
        }
        fprintf(out, "%s\n", front[k].design == search->start ? " (the scene as it is)" : "");
    }
cleanup:
    memory_free(front);
    return error_is_clean(err);
}

// "mu_hold at load.pressure=0.004".
static bool aim_label(const Search *search, int32_t aim, QuantityLabel *label, Error *err)
{
    char words[POINT_WORDS_SIZE];
    *label = quantity_label(search->study->records[designs_aim(&search->designs, aim).record].name,
                            false);
    if (!aim_words(search, aim, words, err)) return false;
    // The label takes as many words as it has room for.
    size_t used = strlen(label->words);
    int room = (int)(sizeof label->words - used - sizeof " at ");
    if (*words && room > 0)
        snprintf(label->words + used, sizeof label->words - used, " at %.*s", room, words);
    return true;
}

bool pareto_front_draw(const Search *search, Error *err)
{
    const Designs *designs = &search->designs;
    int32_t count = 0, all = designs->count;
    Placed *front = NULL;
    double *x = NEW_ARRAY(double, 4 * (int64_t)all, err);
    if (designs->aims < 2) goto cleanup;
    TRY(x);
    double *y = x + all, *front_x = y + all, *front_y = front_x + all;
    TRY(list_front(designs, &front, &count, err));
    for (int32_t d = 0; d < all; d++) {
        const PointValue *points = designs_points(designs, d);
        x[d] = points[0].value, y[d] = points[1].value;
    }
    for (int32_t k = 0; k < count; k++)
        front_x[k] = x[front[k].design], front_y[k] = y[front[k].design];
    Frame frame = {.name = "front", .x_scale = "linear", .y_scale = "linear"};
    TRY(aim_label(search, 0, &frame.x, err));
    TRY(aim_label(search, 1, &frame.y, err));
    Curve curves[] = {search_dots("designs", all, x, y),
                      search_dots("none is better at all", count, front_x, front_y)};
    curves[1].color = COLOR_BEST;
    curves[1].marker = "square";
    TRY(search_draw(search, &frame, curves, 2, err));
cleanup:
    memory_free_all(front, x);
    return error_is_clean(err);
}
