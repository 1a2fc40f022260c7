// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/optimise/designs.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_SIZE = 32 };

bool designs_create(const Study *study, Designs *designs, Error *err)
{
    *designs = (Designs){.study = study, .conditions = 1};
    for (int32_t k = 0; k < study->axis_count; k++) designs->conditions *= study->axes[k].count;
    TRY(designs->list = NEW_ARRAY(Design, DESIGNS_MAX, err));
    int64_t points = (int64_t)DESIGNS_MAX * designs->conditions;
    TRY(designs->points = NEW_ARRAY(DesignPoint, points, err));
    TRY(designs->known = NEW_ARRAY(bool, points, err));
cleanup:
    return error_is_clean(err);
}

void designs_destroy(Designs *designs)
{
    memory_free(designs->list);
    memory_free(designs->points);
    memory_free(designs->known);
    *designs = (Designs){0};
}

static void number_text(const SearchKey *key, double value, char text[NUMBER_SIZE])
{
    snprintf(text, NUMBER_SIZE, key->scale == SEARCH_WHOLE ? "%.0f" : "%.3g", value);
}

// So that a value can be quoted; an end of the range is met exactly.
void designs_round(const Study *study, double *x)
{
    for (int32_t k = 0; k < study->search.key_count; k++) {
        const SearchKey *key = &study->search.keys[k];
        char text[NUMBER_SIZE];
        number_text(key, x[k], text);
        x[k] = fmin(fmax(strtod(text, NULL), key->least), key->most);
    }
}

int32_t designs_add(Designs *designs, const double *x, int32_t choice)
{
    Design *design = &designs->list[designs->count];
    *design = (Design){.choice = choice, .value = NAN, .bar = NAN};
    memcpy(design->x, x, (size_t)designs->study->search.key_count * sizeof *x);
    return designs->count++;
}

int32_t designs_find(const Designs *designs, const double *x)
{
    for (int32_t d = 0; d < designs->count; d++) {
        bool same = true;
        for (int32_t k = 0; k < designs->study->search.key_count; k++)
            same = same && designs->list[d].x[k] == x[k];
        if (same) return d;
    }
    return -1;
}

char *designs_text(const Designs *designs, const Design *list, int32_t count, Error *err)
{
    const StudySearch *search = &designs->study->search;
    int64_t size = (int64_t)count * (search->key_count + 1) * (STUDY_NAME_SIZE + NUMBER_SIZE) + 8;
    char *text = NEW_ARRAY(char, size, err), number[NUMBER_SIZE];
    if (!text) return NULL;
    int64_t used = snprintf(text, (size_t)size, "[");
    for (int32_t d = 0; d < count; d++) {
        used += snprintf(text + used, (size_t)(size - used), "%s{", d ? ", " : "");
        for (int32_t k = 0; k < search->key_count; k++) {
            number_text(&search->keys[k], list[d].x[k], number);
            used += snprintf(text + used, (size_t)(size - used), "%s%s: %s", k ? ", " : "",
                             search->keys[k].key, number);
        }
        if (list[d].accuracy > 0)
            used += snprintf(text + used, (size_t)(size - used), ", accuracy.mu: %.2g",
                             list[d].accuracy);
        used += snprintf(text + used, (size_t)(size - used), "}");
    }
    snprintf(text + used, (size_t)(size - used), "]");
    return text;
}

void design_words(const Study *study, const Design *design, char words[OPTIMISE_WORDS_SIZE])
{
    size_t used = 0;
    words[0] = 0;
    for (int32_t k = 0; k < study->search.key_count; k++) {
        char number[NUMBER_SIZE];
        number_text(&study->search.keys[k], design->x[k], number);
        int length = snprintf(words + used, OPTIMISE_WORDS_SIZE - used, "%s%s=%s", k ? " " : "",
                              study->search.keys[k].key, number);
        if (length < 0 || (size_t)length >= OPTIMISE_WORDS_SIZE - used) break;
        used += (size_t)length;
    }
}

bool design_is_better(const Designs *designs, const Design *a, const Design *b)
{
    if (isnan(a->value) || isnan(b->value)) return !isnan(a->value);
    return designs->study->rank.lowest ? a->value < b->value : a->value > b->value;
}

// Of the worst: the interval in which the worst of all may be, with the bars of each.
static void judge_worst(const Designs *designs, const DesignPoint *points, Design *design)
{
    double sign = designs->study->rank.lowest ? -1 : 1, low = INFINITY, high = INFINITY;
    double worst = INFINITY;
    for (int32_t c = 0; c < designs->conditions; c++) {
        double value = sign * points[c].value;
        if (value < worst) worst = value, design->deciding = c;
        low = fmin(low, value - points[c].bar);
        high = fmin(high, value + points[c].bar);
    }
    design->value = sign * worst;
    design->bar = fmax(worst - low, high - worst);
}

static void judge_mean(const Designs *designs, const DesignPoint *points, Design *design)
{
    double sum = 0, square = 0;
    for (int32_t c = 0; c < designs->conditions; c++) {
        sum += points[c].value;
        square += points[c].bar * points[c].bar;
    }
    design->value = sum / designs->conditions;
    design->bar = sqrt(square) / designs->conditions;
}

int64_t designs_point(const Designs *designs, int32_t design)
{
    return (int64_t)design * designs->conditions;
}

void designs_judge(Designs *designs, int32_t d)
{
    Design *design = &designs->list[d];
    const DesignPoint *points = &designs->points[designs_point(designs, d)];
    const bool *known = &designs->known[designs_point(designs, d)];
    design->value = design->bar = NAN;
    design->deciding = 0;
    design->has_bar = true;
    for (int32_t c = 0; c < designs->conditions; c++)
        design->has_bar = design->has_bar && points[c].has_bar;
    for (int32_t c = 0; c < designs->conditions; c++)
        if (!known[c] || isnan(points[c].value)) return;
    (designs->study->search.mean ? judge_mean : judge_worst)(designs, points, design);
}

int32_t designs_best(const Designs *designs)
{
    int32_t best = -1;
    for (int32_t d = 0; d < designs->count; d++)
        if (!isnan(designs->list[d].value) &&
            (best < 0 || design_is_better(designs, &designs->list[d], &designs->list[best])))
            best = d;
    return best;
}

bool designs_may_equal(const Designs *designs, int32_t best, int32_t d)
{
    const Design *one = &designs->list[d], *top = &designs->list[best];
    if (d == best || isnan(one->value)) return false;
    return !(fabs(top->value - one->value) > one->bar + top->bar);
}
