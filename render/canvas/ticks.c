// SPDX-License-Identifier: GPL-2.0-or-later
// Ticks at 1, 2 or 5 times a power of ten, and numbers with no more decimals than the step has.
// Integers count them: k * step is then the double nearest to what the label says.
#include "render/canvas/ticks.h"

#include <math.h>
#include <stdio.h>

// Numbers from 0.01 to 9999 need no power of ten beside the axis.
enum { EXPONENT_LOW = -2, EXPONENT_HIGH = 3, DECIMALS_MAX = 12 };

// A tick this close to the end of the axis, in steps, still belongs to it.
static const double END_SLACK = 1e-6;

// The step is the smallest of 1, 2 and 5 times a power of ten that gives no more ticks than wanted;
// minor ticks then divide it into handy parts (5, 4 and 5 of them).
Ticks ticks_choose(double low, double high, int32_t wanted)
{
    Ticks ticks = {0};
    double range = high - low, largest = fmax(fabs(low), fabs(high));
    if (!(range > 1e-12 * largest) || !isfinite(range) || wanted < 1) return ticks;
    double power = floor(log10(range / wanted));
    double mantissa = range / wanted / pow(10, power);
    int32_t nice = mantissa <= 1 + 1e-9   ? 1
                   : mantissa <= 2 + 1e-9 ? 2
                   : mantissa <= 5 + 1e-9 ? 5
                                          : 10;
    if (nice == 10) {
        nice = 1;
        power += 1;
    }
    ticks.step = nice * pow(10, power);
    if (!(ticks.step > 0) || !isfinite(ticks.step)) return (Ticks){0};
    ticks.minor = nice == 2 ? 4 : 5;
    ticks.first = (int64_t)ceil(low / ticks.step - END_SLACK);
    ticks.count = (int32_t)(floor(high / ticks.step + END_SLACK) - (double)ticks.first) + 1;
    int32_t magnitude = (int32_t)floor(log10(largest) + 1e-9);
    if (magnitude < EXPONENT_LOW || magnitude > EXPONENT_HIGH) ticks.exponent = magnitude;
    ticks.decimals = ticks.exponent - (int32_t)power;
    if (ticks.decimals < 0) ticks.decimals = 0;
    if (ticks.decimals > DECIMALS_MAX) ticks.decimals = DECIMALS_MAX;
    return ticks;
}

Ticks ticks_whole(const Ticks *ticks, double low, double high)
{
    Ticks whole = *ticks;
    if (whole.step > 0 && whole.step < 1)
        whole = ticks_choose(low, high, (int32_t)ceil(high - low));
    if (!(whole.step >= 1)) return *ticks;
    if (whole.step == 1) whole.minor = 1;
    if (whole.step == 2) whole.minor = 2;
    return whole;
}

// Every power of ten where there are few, else every second, third, ...; multiples of that
// distance, so that 10^0 is a tick whenever it is in range.
Ticks ticks_choose_log(double low, double high, int32_t wanted)
{
    Ticks ticks = {.is_log = true, .minor = 1};
    if (!(low > 0) || !(high > low) || !isfinite(high) || wanted < 1) return ticks;
    double from = ceil(log10(low) - END_SLACK), to = floor(log10(high) + END_SLACK);
    ticks.step = fmax(1, ceil((to - from + 1) / wanted));
    ticks.first = (int64_t)ceil(from / ticks.step);
    ticks.count = (int32_t)(floor(to / ticks.step) - (double)ticks.first) + 1;
    if (ticks.step == 1) ticks.minor = 9;
    return ticks;
}

// 1, 2 and 5 times the powers of ten, counted from 1: the value at k thirds of a decade.
static double third_value(int64_t k)
{
    static const double MANTISSA[] = {1, 2, 5};
    int64_t power = k >= 0 ? k / 3 : -((2 - k) / 3);
    return MANTISSA[k - 3 * power] * pow(10, (double)power);
}

Ticks ticks_choose_thirds(double low, double high)
{
    Ticks ticks = {.is_log = true, .thirds = true, .minor = 9};
    if (!(low > 0) || !(high > low) || !isfinite(high)) return ticks;
    ticks.first = 3 * (int64_t)floor(log10(low));
    while (third_value(ticks.first) < low * (1 - END_SLACK)) ++ticks.first;
    for (;;) {
        double value = third_value(ticks.first + ticks.count);   // infinite beyond the largest
        if (!isfinite(value) || value > high * (1 + END_SLACK)) return ticks;
        ++ticks.count;
    }
}

double ticks_minor_log(const Ticks *ticks, int32_t k)
{
    double first = ticks->thirds ? floor(log10(third_value(ticks->first)) + END_SLACK)
                                 : (double)ticks->first * ticks->step;
    double power = floor((double)k / ticks->minor);
    return (1 + k - power * ticks->minor) *
           pow(10, first + power * (ticks->thirds ? 1 : ticks->step));
}

double tick_value(const Ticks *ticks, int32_t k)
{
    if (ticks->thirds) return third_value(ticks->first + k);
    if (ticks->is_log) return pow(10, (double)(ticks->first + k) * ticks->step);
    return (double)(ticks->first + k) * ticks->step;
}

static int32_t power_of(double value)
{
    return (int32_t)floor(log10(value) + END_SLACK);
}

// The sign is written by hand: 0 must not become "-0", and a minus sign is not a hyphen.
void tick_label(const Ticks *ticks, int32_t k, char label[TICK_LABEL_SIZE])
{
    if (ticks->thirds) {
        // Numbers that stand for themselves, or all with a power of ten where one would be long.
        double value = tick_value(ticks, k);
        int32_t power = power_of(value), last = power_of(tick_value(ticks, ticks->count - 1));
        bool short_all = power_of(tick_value(ticks, 0)) >= EXPONENT_LOW - 1 &&
                         last <= EXPONENT_HIGH + 1;
        if (short_all)
            snprintf(label, TICK_LABEL_SIZE, "%.*f", power < 0 ? -power : 0, value);
        else
            snprintf(label, TICK_LABEL_SIZE, "%.0f\u00d710^{%d}", value / pow(10, power), power);

        return;
    }
    if (ticks->is_log) {
        snprintf(label, TICK_LABEL_SIZE, "10^{%.0f}", (double)(ticks->first + k) * ticks->step);
        return;
    }
    double value = tick_value(ticks, k) / pow(10, ticks->exponent);
    const char *sign = ticks->first + k < 0 ? "\u2212" : "";
    snprintf(label, TICK_LABEL_SIZE, "%s%.*f", sign, ticks->decimals, fabs(value));
}

void ticks_power(const Ticks *ticks, char words[TICK_LABEL_SIZE])
{
    words[0] = 0;
    if (ticks->exponent) snprintf(words, TICK_LABEL_SIZE, "\u00d710^{%d}", ticks->exponent);
}
