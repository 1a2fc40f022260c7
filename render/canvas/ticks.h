// SPDX-License-Identifier: GPL-2.0-or-later
// Where an axis has its ticks and what stands beside them. Numbers only; called by axes.
#ifndef AMONTONS_RENDER_CANVAS_TICKS_H
#define AMONTONS_RENDER_CANVAS_TICKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TICK_LABEL_SIZE = 32 };

// Ticks at first * step, (first + 1) * step, ...: `count` of them. On a logarithmic axis these are
// the logarithms of what stands at the ticks; `thirds` of a decade stand at 1, 2 and 5 times a
// power of ten (first 0 is 1, 4 is 20).
typedef struct Ticks {
    bool is_log, thirds;
    double step;   // 1, 2 or 5 times a power of ten
    int64_t first;   // multiple of the step
    int32_t count;
    int32_t minor;   // intervals of minor ticks in a step
    int32_t decimals;   // of a label
    int32_t exponent;   // labels are to be multiplied by ten to this; 0 for handy numbers
} Ticks;

// About `wanted` ticks (never more than wanted + 1) from low to high. None where the range is
// empty or not finite.
Ticks ticks_choose(double low, double high, int32_t wanted);
// The same ticks, of what is counted: none between whole numbers.
Ticks ticks_whole(const Ticks *ticks, double low, double high);
// Ticks at powers of ten from low to high, both > 0; every second or third where they are many.
// Minor ticks: 2 to 9 times each, where every power has a tick.
Ticks ticks_choose_log(double low, double high, int32_t wanted);
// Ticks of a logarithmic axis too short for two powers of ten: at 1, 2 and 5 times a power of ten.
Ticks ticks_choose_thirds(double low, double high);
// Minor tick k of a logarithmic axis: 1 to `minor` times a power of ten, from the one of the first
// tick on, or before it (k < 0).
double ticks_minor_log(const Ticks *ticks, int32_t k);
double tick_value(const Ticks *ticks, int32_t k);
// "0.25", "−3", "10^{-3}", "2×10^{-5}": without the power of ten, minus sign U+2212.
void tick_label(const Ticks *ticks, int32_t k, char label[TICK_LABEL_SIZE]);
// "×10^{-4}", by which all labels are to be multiplied; "": by nothing.
void ticks_power(const Ticks *ticks, char words[TICK_LABEL_SIZE]);

#endif
