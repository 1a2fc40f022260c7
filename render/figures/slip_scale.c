// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/slip_scale.h"

#include <math.h>

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
