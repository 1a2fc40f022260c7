// SPDX-License-Identifier: GPL-2.0-or-later
// The map is made from a smooth path in CIELAB (CIE 15:2004, white D65) through a few stations,
// walked at constant speed and turned to sRGB (IEC 61966-2-1). The stations are ours: lightness
// falls in nearly equal steps while the hue goes from yellowish white through red to violet, with
// as much chroma as sRGB holds there.
#include "render/canvas/color.h"

#include <math.h>

enum { STATIONS = 6, PATH_POINTS = 4000 };

static const double DARK_PAPER = 9, DARK_INK = 97;   // CIELAB lightness of what was white, black

typedef struct Lab {
    double L, a, b;
} Lab;

typedef struct Station {
    double lightness, chroma, hue;   // CIELAB; hue in degrees
} Station;

static const Station STATION[STATIONS] = {{96, 20, 97}, {80, 56, 76},  {63, 72, 51},
                                          {46, 66, 24}, {29, 52, 352}, {14, 36, 310}};

// Turns lightness, chroma and hue into Cartesian CIELAB.
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

// CIELAB's cube root with its linear foot.
static double lab_root(double part)
{
    const double knee = 6.0 / 29;
    return part > knee * knee * knee ? cbrt(part) : part / (3 * knee * knee) + 4.0 / 29;
}

// The transfer function of sRGB; what is outside its gamut is clipped.
static double srgb_value(double linear)
{
    double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return fmin(fmax(value, 0), 1);
}

static double srgb_linear(double value)
{
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static Color color_of_lab(Lab lab)
{
    double f = (lab.L + 16) / 116;
    double x = 0.95047 * lab_inverse(f + lab.a / 500), y = lab_inverse(f);
    double z = 1.08883 * lab_inverse(f - lab.b / 200);
    return (Color){(float)srgb_value(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
                   (float)srgb_value(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
                   (float)srgb_value(0.0556434 * x - 0.2040259 * y + 1.0572252 * z), 1};
}

Color color_on_dark(Color color)
{
    double red = srgb_linear((double)color.red), green = srgb_linear((double)color.green);
    double blue = srgb_linear((double)color.blue);
    double x = lab_root((0.4124564 * red + 0.3575761 * green + 0.1804375 * blue) / 0.95047);
    double y = lab_root(0.2126729 * red + 0.7151522 * green + 0.0721750 * blue);
    double z = lab_root((0.0193339 * red + 0.1191920 * green + 0.9503041 * blue) / 1.08883);
    Lab lab = {116 * y - 16, 500 * (x - y), 200 * (y - z)};
    lab.L = DARK_INK + (DARK_PAPER - DARK_INK) * lab.L / 100;
    Color turned = color_of_lab(lab);
    turned.alpha = color.alpha;
    return turned;
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
void color_map_fill(uint8_t *colors)
{
    double length = 0, walked = 0;
    for (int32_t k = 0; k < PATH_POINTS; ++k)
        length += lab_distance(path_point(k), path_point(k + 1));
    int32_t entry = 0;
    for (int32_t k = 0; k <= PATH_POINTS && entry < MAP_SIZE; ++k) {
        Lab here = path_point(k);
        if (k > 0) walked += lab_distance(path_point(k - 1), here);
        if (walked < length * entry / (MAP_SIZE - 1) && k < PATH_POINTS) continue;
        Color color = color_of_lab(here);
        colors[3 * entry] = (uint8_t)lroundf(255 * color.red);
        colors[3 * entry + 1] = (uint8_t)lroundf(255 * color.green);
        colors[3 * entry++ + 2] = (uint8_t)lroundf(255 * color.blue);
    }
}
