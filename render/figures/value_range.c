// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/value_range.h"

#include "base/order.h"
#include "io/text/picture_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double LEFT_OUT = 0.01;   // of what is shown, at each end of the range: corners
static const double DECADES_FROM = 30;   // largest over least from which on powers are shown
static const double LEAST_SHOWN = 1e-15;   // of the largest: powers begin there at the least

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
    qsort(values, (size_t)kept, sizeof *values, order_doubles);
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

// What is above 0 spans decades, and nothing is below: *zeros of the values stand before it.
static bool spans_decades(const WeighedValue *sorted, int64_t count, int64_t *zeros)
{
    double weight = 0;
    *zeros = 0;
    while (*zeros < count && sorted[*zeros].value == 0) ++*zeros;
    if (*zeros == count || sorted[0].value < 0) return false;
    for (int64_t k = *zeros; k < count; ++k) weight += sorted[k].weight;
    const WeighedValue *above = sorted + *zeros;
    return value_at(above, count - *zeros, weight, 1 - LEFT_OUT) >
           DECADES_FROM * value_at(above, count - *zeros, weight, LEFT_OUT);
}

// Name and unit; the factor makes the numbers short, but of powers.
static Axis name_of(const ValueWords *words, const double range[2], bool powers)
{
    Axis axis = {.low = range[0], .high = range[1], .factor = 1};
    if (!words->normalised[0])
        snprintf(axis.label, sizeof axis.label, "%s", words->words);
    else if (!words->in_si)
        snprintf(axis.label, sizeof axis.label, "%s / %s", words->words, words->normalised);
    else if (powers)
        snprintf(axis.label, sizeof axis.label, "%s (%s)", words->words, words->si);
    else
        axis_set_unit(&axis, words->words, words->si);
    return axis;
}

bool value_bar_fit(WeighedValue *values, int64_t count, const ValueWords *words,
                   const PictureStyle *style, Colorbar *bar, Error *err)
{
    const PictureStyle none = {0};
    double weight = 0, range[2];
    int64_t kept = sort_values(values, count, &weight), zeros = 0;
    if (kept == 0) return FAULT(err, ERROR_FILE, "the field holds no number");
    bool powers = words->decades && spans_decades(values, kept, &zeros);
    for (int64_t k = 0; powers && k < zeros; ++k) weight -= values[k].weight;
    const WeighedValue *shown = powers ? values + zeros : values, *last = values + kept - 1;
    kept = last + 1 - shown;
    for (int32_t end = 0; end < 2; ++end)
        range[end] = range_end(shown, kept, weight, &none, end, 1);
    Axis axis = name_of(words, range, powers);
    *bar = (Colorbar){.factor = axis.factor, .powers = powers};
    snprintf(bar->label, sizeof bar->label, "%s", axis.label);
    for (int32_t end = 0; end < 2; ++end) {
        range[end] = axis.factor * range_end(shown, kept, weight,
                                             style && style->limits ? style : &none, end,
                                             axis.factor);
        if (powers) range[end] = log10(fmax(range[end], LEAST_SHOWN * last->value));
    }
    colorbar_fit(bar, range);
    double low = powers ? pow(10, bar->low) : bar->low;
    double high = powers ? pow(10, bar->high) : bar->high;
    bar->clipped = values[0].value * axis.factor < low;
    bar->clipped_above = last->value * axis.factor > high;
    return true;
}
