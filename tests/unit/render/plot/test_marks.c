// SPDX-License-Identifier: GPL-2.0-or-later
// Colours of curves as eyes see them that lack one kind of cones (matrices of Machado, Oliveira and
// Fernandes, IEEE Trans. Vis. Comput. Graph. 15, 2009): any two differ in CIELAB.
#include "render/plot/marks.h"

#include "near.h"

static const double LEAST = 25;   // apart; 2 can be told side by side

static const double SEEN[4][3][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                     {{0.152286, 1.052583, -0.204868},
                                      {0.114503, 0.786281, 0.099216},
                                      {-0.003882, -0.048116, 1.051998}},
                                     {{0.367322, 0.860646, -0.227968},
                                      {0.280085, 0.672501, 0.047413},
                                      {-0.011820, 0.042940, 0.968881}},
                                     {{1.255528, -0.076749, -0.178779},
                                      {-0.078411, 0.930809, 0.147602},
                                      {0.004733, 0.691367, 0.303900}}};

static const double XYZ[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                 {0.2126729, 0.7151522, 0.0721750},
                                 {0.0193339, 0.1191920, 0.9503041}};
static const double WHITE[3] = {0.95047, 1, 1.08883};

static void multiply(const double matrix[3][3], const double from[3], double to[3])
{
    for (int32_t i = 0; i < 3; i++)
        to[i] = matrix[i][0] * from[0] + matrix[i][1] * from[1] + matrix[i][2] * from[2];
}

static void lab_seen(Color color, const double seen[3][3], double lab[3])
{
    const double srgb[3] = {(double)color.red, (double)color.green, (double)color.blue};
    double linear[3], light[3], xyz[3], root[3];
    for (int32_t i = 0; i < 3; i++)
        linear[i] = srgb[i] <= 0.04045 ? srgb[i] / 12.92 : pow((srgb[i] + 0.055) / 1.055, 2.4);
    multiply(seen, linear, light);
    for (int32_t i = 0; i < 3; i++) light[i] = fmin(fmax(light[i], 0), 1);
    multiply(XYZ, light, xyz);
    for (int32_t i = 0; i < 3; i++) {
        double part = xyz[i] / WHITE[i];
        root[i] = part > 216.0 / 24389 ? cbrt(part) : part * 841 / 108 + 4.0 / 29;
    }
    lab[0] = 116 * root[1] - 16;
    lab[1] = 500 * (root[0] - root[1]);
    lab[2] = 200 * (root[1] - root[2]);
}

TEST(colors_are_told_apart)
{
    for (int32_t eye = 0; eye < 4; eye++)
        for (int32_t i = 0; i < PLOT_COLORS; i++)
            for (int32_t j = 0; j < i; j++) {
                PlotSeries one = {.color = i}, other = {.color = j};
                double a[3], b[3];
                lab_seen(mark_color(&one), SEEN[eye], a);
                lab_seen(mark_color(&other), SEEN[eye], b);
                double apart =
                    sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
                if (apart < LEAST) fail_msg("eye %d: %d and %d are %.1f apart", eye, i, j, apart);
            }
}
