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
                      .powers = true,
                      .label = "slip rate / ~{V}",
                      .neutral = "stick",
                      .neutral_color = STICK};
}

float slip_scale_level(const Colorbar *bar, double V, double rate)
{
    if (isnan(rate)) return HEAT_MISSING;
    if (!(rate > 0)) return HEAT_BELOW;   // of most pixels; the logarithm of 0 takes long
    double level = (log10(rate / V) - bar->low) / (bar->high - bar->low);
    return level < 0 ? HEAT_BELOW : (float)fmin(level, 1);
}

void slip_scale_levels(const Colorbar *bar, double V, PixelGrid *grid)
{
    int64_t count = (int64_t)grid->bands * grid->columns;
    for (int64_t k = 0; k < count; ++k)
        grid->values[k] = slip_scale_level(bar, V, (double)grid->values[k]);
}
