// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/designs.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_SIZE = 32 };

bool designs_create(const Study *study, int32_t conditions, char *const *texts, Designs *designs,
                    Error *err)
{
    *designs = (Designs){.study = study,
                         .lowest = study->rank.lowest || study->search.fits,
                         .conditions = conditions > 0 ? conditions : 1,
                         .texts = texts,
                         .aim = -1};
    for (int32_t k = 0; k < study->axis_count; k++) designs->conditions *= study->axes[k].count;
    designs->aims = designs->conditions * (1 + study->rank.also_count);
    return (designs->list = NEW_ARRAY(Design, DESIGNS_MAX, err)) &&
           (designs->points = NEW_ARRAY(PointValue, (int64_t)DESIGNS_MAX * designs->aims, err));
}

void designs_destroy(Designs *designs)
{
    memory_free_all(designs->list, designs->points);
    *designs = (Designs){0};
}

static void number_text(const Study *study, int32_t k, double value, char text[NUMBER_SIZE])
{
    bool whole = study->search.keys[k].scale == SEARCH_WHOLE;
    int digits = study->search.fits ? 5 : 3;
    if (whole)
        snprintf(text, NUMBER_SIZE, "%.0f", value);
    else
        snprintf(text, NUMBER_SIZE, "%.*g", digits, value);
}

// Rounds so that a value can be quoted; an end of the range is met exactly.
void designs_round(const Study *study, double *x)
{
    for (int32_t k = 0; k < study->search.key_count; k++) {
        const SearchKey *key = &study->search.keys[k];
        char text[NUMBER_SIZE];
        number_text(study, k, x[k], text);
        x[k] = fmin(fmax(strtod(text, NULL), key->least), key->most);
    }
}

int32_t designs_add(Designs *designs, const double *x, int32_t choice)
{
    Design *design = &designs->list[designs->count];
    *design = (Design){.choice = choice, .point = -1, .value = NAN, .bar = NAN};
    memcpy(design->x, x, (size_t)designs->study->search.key_count * sizeof *x);
    return designs->count++;
}

int32_t designs_find(const Designs *designs, const double *x)
{
    const StudySearch *search = &designs->study->search;
    for (int32_t d = 0; d < designs->count; d++) {
        bool same = true;
        for (int32_t k = 0; k < search->key_count && same; k++) {
            const SearchKey *key = &search->keys[k];
            double other = designs->list[d].x[k];
            double by = key->scale == SEARCH_LOG ? log(x[k] / other) / log(key->most / key->least)
                                                 : (x[k] - other) / (key->most - key->least);
            same = x[k] == other || (key->scale != SEARCH_WHOLE && fabs(by) <= designs->near[k]);
        }
        if (same) return d;
    }
    return -1;
}

char *designs_text(const Designs *designs, const Design *list, int32_t count, Error *err)
{
    int32_t cases = designs->texts ? designs->conditions : 1;
    char *text = NULL, *owned = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) FAIL(err, ERROR_MEMORY, "no memory for designs");
    for (int32_t k = 0; k < count * cases; k++) {
        const Design *design = &list[k / cases];
        fprintf(out, "%s{", k ? ", " : "[");   // "{mesh.set.n: 4, rod.height: 0.2"
        for (int32_t i = 0; i < designs->study->search.key_count; i++) {
            const SearchKey *key = &designs->study->search.keys[i];
            char number[NUMBER_SIZE];
            number_text(designs->study, i, design->x[i], number);
            fprintf(out, "%s%s: %s%s", i ? ", " : "", key->key, number, key->unit);
        }
        if (design->accuracy > 0) fprintf(out, ", accuracy.mu: %.2g", design->accuracy);
        if (designs->texts) fprintf(out, ", %s", designs->texts[k % cases]);
        fprintf(out, "}");
    }
    fprintf(out, "]");
    if (fclose(out) != 0) FAIL(err, ERROR_MEMORY, "no memory for designs");
    owned = memory_text(text, err);
cleanup:
    free(text);
    return owned;
}

void design_words(const Study *study, const Design *design, char words[OPTIMISE_WORDS_SIZE])
{
    size_t used = 0;
    words[0] = 0;
    for (int32_t k = 0; k < study->search.key_count; k++) {
        char number[NUMBER_SIZE];
        number_text(study, k, design->x[k], number);
        int length = snprintf(words + used, OPTIMISE_WORDS_SIZE - used, "%s%s=%s", k ? " " : "",
                              study->search.keys[k].key, number);
        if (length < 0 || (size_t)length >= OPTIMISE_WORDS_SIZE - used) break;
        used += (size_t)length;
    }
}

double design_sure(const Designs *designs, const Design *design)
{
    double open = design->has_bar ? design->bar : fabs(design->value);
    if (!designs->has_bars) return design->value;
    return designs->lowest ? design->value + open : design->value - open;
}

bool design_is_better(const Designs *designs, const Design *a, const Design *b)
{
    double one = design_sure(designs, a), other = design_sure(designs, b);
    if (isnan(one) || isnan(other)) return !isnan(one);
    return designs->lowest ? one < other : one > other;
}

PointValue *designs_points(const Designs *designs, int32_t design)
{
    return &designs->points[(int64_t)design * designs->aims];
}

StudyAim designs_aim(const Designs *designs, int32_t aim)
{
    const StudyRank *rank = &designs->study->rank;
    int32_t which = aim / designs->conditions;
    return which > 0 ? rank->also[which - 1] : (StudyAim){rank->record, rank->lowest};
}

void designs_judge(Designs *designs, int32_t d)
{
    Design *design = &designs->list[d];
    const PointValue *points = designs_points(designs, d);
    SearchOver over = designs->study->search.over;
    int32_t n = designs->conditions;
    design->value = design->bar = NAN;
    design->deciding = 0;
    design->has_bar = true;
    for (int32_t c = 0; c < n; c++) design->has_bar = design->has_bar && !isnan(points[c].bar);
    for (int32_t a = 0; a < designs->aims; a++)
        if (isnan(points[a].value)) return;
    designs->has_bars = designs->has_bars || design->has_bar;

    if (over == OVER_WORST) {
        // The bar covers the interval in which the worst value may lie, with the bars of all
        // conditions.
        double sign = designs->lowest ? -1 : 1, low = INFINITY, high = INFINITY, worst = INFINITY;
        for (int32_t c = 0; c < n; c++) {
            double value = sign * points[c].value;
            if (value < worst) worst = value, design->deciding = c;
            low = fmin(low, value - points[c].known_to);
            high = fmin(high, value + points[c].known_to);
        }
        design->value = sign * worst;
        design->bar = fmax(worst - low, high - worst);
        return;
    }
    if (over == OVER_FRONT && designs->aim >= 0) {
        design->deciding = designs->aim % n;
        design->value = points[designs->aim].value;
        design->bar = points[designs->aim].known_to;
        return;
    }

    double sum = 0, bars = 0, square = 0, bar = 0;   // the mean
    for (int32_t c = 0; c < n; c++) {
        sum += points[c].value;
        bars += points[c].known_to * points[c].known_to;
    }
    double mean = sum / n;
    design->value = mean;
    design->bar = sqrt(bars) / n;
    if (over != OVER_DEVIATION) return;

    // The deviation s. From s^2 = sum (v_i - mean)^2 / n follows ds/dv_i = (v_i - mean)/(n s).
    for (int32_t c = 0; c < n; c++) square += pow(points[c].value - mean, 2) / n;
    for (int32_t c = 0; c < n; c++) {
        double share = square > 0 ? pow(points[c].value - mean, 2) / (n * square) : 1.0 / n;
        bar += share * points[c].known_to * points[c].known_to / n;
    }
    design->value = sqrt(square);
    design->bar = sqrt(bar);
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

bool designs_may_lead(const Designs *designs, int32_t best, int32_t d)
{
    double value = designs->list[d].value;
    double sure = design_sure(designs, &designs->list[best]);
    return designs->lowest ? value <= sure : value >= sure;
}
