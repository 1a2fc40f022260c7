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

// Where the scale ends: the half decade above all slip.
static double decade_high(double largest, double V)
{
    if (!(largest > V)) return DECADE_HIGH_MIN;
    return fmin(fmax(ceil(2 * log10(largest / V)) / 2, DECADE_HIGH_MIN), DECADE_HIGH_MAX);
}

Colorbar slip_scale_up_to(double largest, double V)
{
    return (Colorbar){.low = DECADE_LOW,
                      .high = decade_high(largest, V),
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

// Returns true if the values above 0 span decades and no value is below 0. The *zeros values that
// are 0 stand before them.
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

// --- states --------------------------------------------------------------------------------------

enum { COUNTED_MOST = 200000 };   // of a long history every second row, or third, ...

// As it is written in formulas: a Greek letter by its name.
static const char *letter_of(const char *name)
{
    static const char *const greek[][2] = {
        {"theta", "~{\u03b8}"}, {"phi", "~{\u03c6}"}, {"chi", "~{\u03c7}"}, {"psi", "~{\u03c8}"}};
    for (size_t k = 0; k < sizeof greek / sizeof *greek; ++k)
        if (strcmp(greek[k][0], name) == 0) return greek[k][1];
    return name;
}

ValueWords state_words(const ResultView *view, char name[VIEW_STATE_SIZE])
{
    bool time = strcmp(view->state_unit, "time") == 0;
    result_view_state_name(view, name);
    return (ValueWords){.words = letter_of(name),
                        .si = time ? "s" : "",
                        .normalised = time ? "~{t}_{0}" : "",
                        .in_si = view->si,
                        .decades = strcmp(view->state_unit, "1") != 0};
}

bool state_scale(const ResultView *view, const double range[2], const double *states,
                 const PictureStyle *style, Colorbar *bar, Error *err)
{
    char name[VIEW_STATE_SIZE];
    ValueWords words = state_words(view, name);
    int64_t total = view->rows * view->nodes, every = 1 + total / COUNTED_MOST, count = 0;
    WeighedValue *values = NEW_ARRAY(WeighedValue, total / every + view->nodes, err);
    TRY(values);
    for (int64_t row = 0; row < view->rows; row += every)
        for (int32_t i = 0; i < view->nodes && view->U[row] >= range[0] && view->U[row] <= range[1];
             ++i)
            values[count++] = (WeighedValue){states[row * view->nodes + i], 1};
    TRY(value_bar_fit(values, count, &words, style, bar, err));
cleanup:
    memory_free(values);
    return error_is_clean(err);
}
