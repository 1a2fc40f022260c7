// SPDX-License-Identifier: GPL-2.0-or-later
// Made from a smooth path in CIELAB (CIE 15:2004, white D65) through a few stations, walked at
// constant speed and turned to sRGB (IEC 61966-2-1). The stations are ours: lightness falls in
// nearly equal steps while the hue goes from yellowish white through red to violet, with as much
// chroma as sRGB holds there.
#include "render/colormap.h"

#include <math.h>

enum { STATIONS = 6, PATH_POINTS = 4000 };

typedef struct Lab {
    double L, a, b;
} Lab;

typedef struct Station {
    double lightness, chroma, hue;   // CIELAB; hue in degrees
} Station;

static const Station STATION[STATIONS] = {{96, 20, 97}, {80, 56, 76},  {63, 72, 51},
                                          {46, 66, 24}, {29, 52, 352}, {14, 36, 310}};

// From lightness, chroma, hue to Cartesian CIELAB.
static Lab station_place(int32_t k)
{
    double hue = STATION[k].hue * 3.14159265358979323846 / 180;
    return (Lab){STATION[k].lightness, STATION[k].chroma * cos(hue), STATION[k].chroma * sin(hue)};
}

// The cubic from q at s = 0 to r at s = 1 whose slopes there are (r - p) / 2 and (t - q) / 2.
static double spline(double p, double q, double r, double t, double s)
{
    double slope_q = (r - p) / 2, slope_r = (t - q) / 2;
    double bend = 3 * (r - q) - 2 * slope_q - slope_r, twist = 2 * (q - r) + slope_q + slope_r;
    return q + s * (slope_q + s * (bend + s * twist));
}

// The path at `place` stations; beyond the ends it is continued straight.
static Lab path_at(double place)
{
    int32_t k = (int32_t)fmin(fmax(floor(place), 0), STATIONS - 2);
    double s = place - k;
    Lab q = station_place(k), r = station_place(k + 1);
    Lab p = {2 * q.L - r.L, 2 * q.a - r.a, 2 * q.b - r.b};
    Lab t = {2 * r.L - q.L, 2 * r.a - q.a, 2 * r.b - q.b};
    if (k > 0) p = station_place(k - 1);
    if (k < STATIONS - 2) t = station_place(k + 2);
    return (Lab){spline(p.L, q.L, r.L, t.L, s), spline(p.a, q.a, r.a, t.a, s),
                 spline(p.b, q.b, r.b, t.b, s)};
}

// Inverse of CIELAB's cube root with its linear foot.
static double lab_inverse(double f)
{
    const double knee = 6.0 / 29;
    return f > knee ? f * f * f : 3 * knee * knee * (f - 4.0 / 29);
}

// The transfer function of sRGB; what is outside its gamut by rounding is clipped.
static uint8_t srgb_byte(double linear)
{
    double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (uint8_t)lround(255 * fmin(fmax(value, 0), 1));
}

static void lab_to_srgb(Lab lab, uint8_t color[3])
{
    double f = (lab.L + 16) / 116;
    double x = 0.95047 * lab_inverse(f + lab.a / 500), y = lab_inverse(f);
    double z = 1.08883 * lab_inverse(f - lab.b / 200);
    color[0] = srgb_byte(3.2404542 * x - 1.5371385 * y - 0.4985314 * z);
    color[1] = srgb_byte(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z);
    color[2] = srgb_byte(0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
}

static double lab_distance(Lab from, Lab to)
{
    return sqrt((to.L - from.L) * (to.L - from.L) + (to.a - from.a) * (to.a - from.a) +
                (to.b - from.b) * (to.b - from.b));
}

static Lab path_point(int32_t k)
{
    return path_at((double)k * (STATIONS - 1) / PATH_POINTS);
}

// Walks the path twice: for its length, then to drop an entry each 1 / (MAP_SIZE - 1) of it.
void colormap_fill(uint8_t *colors)
{
    double length = 0, walked = 0;
    for (int32_t k = 0; k < PATH_POINTS; ++k)
        length += lab_distance(path_point(k), path_point(k + 1));
    int32_t entry = 0;
    for (int32_t k = 0; k <= PATH_POINTS && entry < MAP_SIZE; ++k) {
        Lab here = path_point(k);
        if (k > 0) walked += lab_distance(path_point(k - 1), here);
        if (walked < length * entry / (MAP_SIZE - 1) && k < PATH_POINTS) continue;
        lab_to_srgb(here, colors + 3 * entry++);
    }
}
