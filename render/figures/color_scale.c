// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/color_scale.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/picture_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- slip rates ----------------------------------------------------------------------------------

static const double DECADE_LOW = -2;   // quasi-static slip is about V or a tenth of it
static const double DECADE_HIGH_MIN = 1;   // at least this range is shown
static const double DECADE_HIGH_MAX = 8;
static const Color STICK = {0.976f, 0.980f, 0.984f,
                            1};   // lighter than any slip, in grey print too

Colorbar slip_scale(const ResultView *view, double V)
{
    double largest = 0;
    for (int64_t k = 0; k < view->rows * view->nodes; ++k) {
        double rate = fabs(view->slip_rate[k]);
        if (rate > largest && isfinite(rate)) largest = rate;
    }
    return slip_scale_up_to(largest, V);
}

// The scale ends at the half decade above all slip.
Colorbar slip_scale_up_to(double largest, double V)
{
    double high = largest > V ? ceil(2 * log10(largest / V)) / 2 : DECADE_HIGH_MIN;
    return (Colorbar){.low = DECADE_LOW,
                      .high = fmin(fmax(high, DECADE_HIGH_MIN), DECADE_HIGH_MAX),
                      .factor = 1 / V,
                      .powers = true,
                      .label = "slip rate / ~{V}",
                      .neutral = "stick",
                      .neutral_color = STICK};
}

// --- values --------------------------------------------------------------------------------------

static const double LEFT_OUT = 0.01;   // of what is shown, at each end of the range: corners
static const double DECADES_FROM = 30;   // largest over least from which on powers are shown
static const double LEAST_SHOWN = 1e-15;   // of the largest: powers begin there at the least

// The value below which `part` of the weight lies.
static double value_at(const WeighedValue *sorted, int64_t count, double weight, double part)
{
    double below = 0;
    int64_t k = 0;
    while (k + 1 < count && (below += sorted[k].weight) < part * weight) ++k;
    return sorted[k].value;
}

// End of the range that the style asks for, or that leaves out LEFT_OUT of the values. factor: from
// values to numbers shown.
static double range_end(const WeighedValue *sorted, int64_t count, double weight,
                        const PictureStyle *style, int32_t end, double factor)
{
    bool is_part = false;
    double limit = picture_limit(style, end, &is_part);
    double part = is_part ? limit : end ? 1 - LEFT_OUT : LEFT_OUT;
    return isfinite(limit) && !is_part ? limit / factor : value_at(sorted, count, weight, part);
}

bool value_bar_fit(WeighedValue *values, int64_t count, const ValueWords *words,
                   const PictureStyle *style, Colorbar *bar, Error *err)
{
    const PictureStyle none = {0}, *limits = style && style->limits ? style : &none;

    // All that is finite, in order.
    double weight = 0;
    int64_t kept = 0;
    for (int64_t k = 0; k < count; ++k) {
        if (!isfinite(values[k].value)) continue;
        weight += values[k].weight;
        values[kept++] = values[k];
    }
    if (kept == 0) return FAULT(err, ERROR_FILE, "the field holds no number");
    qsort(values, (size_t)kept, sizeof *values, order_doubles);
    const WeighedValue *shown = values, *last = values + kept - 1;

    // Powers of ten where no value is below 0 and those above 0 span decades; zeros are not shown
    // then.
    bool powers = false;
    int64_t zeros = 0;
    while (zeros < kept && values[zeros].value == 0) ++zeros;
    if (words->decades && zeros < kept && values[0].value >= 0) {
        const WeighedValue *above = values + zeros;
        double sum = 0;
        for (const WeighedValue *value = above; value <= last; ++value) sum += value->weight;
        powers = value_at(above, kept - zeros, sum, 1 - LEFT_OUT) >
                 DECADES_FROM * value_at(above, kept - zeros, sum, LEFT_OUT);
    }
    for (int64_t k = 0; powers && k < zeros; ++k) weight -= values[k].weight;
    if (powers) shown += zeros;
    kept = last + 1 - shown;

    // Name and unit; the factor makes the numbers short, but of powers.
    Axis axis = {.low = range_end(shown, kept, weight, &none, 0, 1),
                 .high = range_end(shown, kept, weight, &none, 1, 1),
                 .factor = 1};
    if (!words->normalised[0])
        snprintf(axis.label, sizeof axis.label, "%s", words->words);
    else if (!words->in_si)
        snprintf(axis.label, sizeof axis.label, "%s / %s", words->words, words->normalised);
    else if (powers)
        snprintf(axis.label, sizeof axis.label, "%s (%s)", words->words, words->si);
    else
        axis_set_unit(&axis, words->words, words->si);

    // Ends of the bar, and what is beyond them.
    double range[2];
    *bar = (Colorbar){.factor = axis.factor, .powers = powers};
    snprintf(bar->label, sizeof bar->label, "%s", axis.label);
    for (int32_t end = 0; end < 2; ++end) {
        range[end] = axis.factor * range_end(shown, kept, weight, limits, end, axis.factor);
        if (powers) range[end] = log10(fmax(range[end], LEAST_SHOWN * last->value));
    }
    colorbar_fit(bar, range);
    double low = powers ? pow(10, bar->low) : bar->low;
    double high = powers ? pow(10, bar->high) : bar->high;
    bar->clipped = values[0].value * axis.factor < low;
    bar->clipped_above = last->value * axis.factor > high;
    return true;
}

enum { COUNTED_MOST = 200000 };   // of a long history every second row, or third, ...

bool history_bar_fit(const ResultView *view, const double U[2], const double *values,
                     const ValueWords *words, const PictureStyle *style, Colorbar *bar, Error *err)
{
    int64_t total = view->rows * view->nodes, every = 1 + total / COUNTED_MOST, count = 0;
    WeighedValue *counted = NEW_ARRAY(WeighedValue, total / every + view->nodes, err);
    TRY(counted);
    for (int64_t row = 0; row < view->rows; row += every)
        for (int32_t i = 0; i < view->nodes && view->U[row] >= U[0] && view->U[row] <= U[1]; ++i)
            counted[count++] = (WeighedValue){values[row * view->nodes + i], 1};
    TRY(value_bar_fit(counted, count, words, style, bar, err));
cleanup:
    memory_free(counted);
    return error_is_clean(err);
}

// In formulas a Greek letter stands for its name.
ValueWords state_words(const ResultView *view, char name[VIEW_STATE_SIZE])
{
    static const char *const greek[][2] = {
        {"theta", "~{\u03b8}"}, {"phi", "~{\u03c6}"}, {"chi", "~{\u03c7}"}, {"psi", "~{\u03c8}"}};
    bool time = strcmp(view->state_unit, "time") == 0;
    const char *letter = name;
    result_view_state_name(view, name);
    for (size_t k = 0; k < sizeof greek / sizeof *greek; ++k)
        if (strcmp(greek[k][0], name) == 0) letter = greek[k][1];
    return (ValueWords){.words = letter,
                        .si = time ? "s" : "",
                        .normalised = time ? "~{t}_{0}" : "",
                        .in_si = view->si,
                        .decades = strcmp(view->state_unit, "1") != 0};
}
