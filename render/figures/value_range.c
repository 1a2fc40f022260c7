// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/value_range.h"

#include "io/text/picture_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double LEFT_OUT = 0.01;   // of what is shown, at each end of the range: corners

static int compare_values(const void *left, const void *right)
{
    double a = ((const WeighedValue *)left)->value, b = ((const WeighedValue *)right)->value;
    return a < b ? -1 : a > b;
}

// In order, without those that are not finite: how many, and the weight of all.
static int64_t sort_values(WeighedValue *values, int64_t count, double *weight)
{
    int64_t kept = 0;
    *weight = 0;
    for (int64_t k = 0; k < count; ++k) {
        if (!isfinite(values[k].value)) continue;
        *weight += values[k].weight;
        values[kept++] = values[k];
    }
    qsort(values, (size_t)kept, sizeof *values, compare_values);
    return kept;
}

// The value below which `part` of the weight lies.
static double value_at(const WeighedValue *sorted, int64_t count, double weight, double part)
{
    double below = 0;
    int64_t k = 0;
    while (k + 1 < count && (below += sorted[k].weight) < part * weight) ++k;
    return sorted[k].value;
}

// What the style asks for, or where all but LEFT_OUT lies. factor: from values to numbers shown.
static double range_end(const WeighedValue *sorted, int64_t count, double weight,
                        const PictureStyle *style, int32_t end, double factor)
{
    bool is_part = false;
    double limit = picture_limit(style, end, &is_part);
    double part = is_part ? limit : end ? 1 - LEFT_OUT : LEFT_OUT;
    return isfinite(limit) && !is_part ? limit / factor : value_at(sorted, count, weight, part);
}

bool value_bar_fit(WeighedValue *values, int64_t count, const ValueWords *words,
                   const PictureStyle *style, ValueBar *bar, Error *err)
{
    const PictureStyle none = {0};
    double weight = 0, range[2];
    int64_t kept = sort_values(values, count, &weight);
    if (kept == 0) FAIL(err, ERROR_FILE, "the field holds no number");
    for (int32_t end = 0; end < 2; ++end)
        range[end] = range_end(values, kept, weight, &none, end, 1);
    Axis axis = {.low = range[0], .high = range[1], .factor = 1};
    if (words->in_si)
        axis_set_unit(&axis, words->words, words->si);
    else
        snprintf(axis.label, sizeof axis.label, "%s / %s", words->words, words->normalised);
    for (int32_t end = 0; end < 2; ++end)
        range[end] = axis.factor * range_end(values, kept, weight,
                                             style && style->limits ? style : &none, end,
                                             axis.factor);
    bar->factor = axis.factor;
    bar->bar = (Colorbar){.label = bar->label};
    colorbar_fit(&bar->bar, range);
    bar->bar.clipped = values[0].value * axis.factor < bar->bar.low;
    bar->bar.clipped_above = values[kept - 1].value * axis.factor > bar->bar.high;
    snprintf(bar->label, sizeof bar->label, "%s", axis.label);
cleanup:
    return error_is_clean(err);
}
