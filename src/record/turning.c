// SPDX-License-Identifier: GPL-2.0-or-later
// With weights w, places (x, y) from their mean and slip (s_x, s_y): the rotation that leaves least
// of slip is sum w (x s_y - y s_x) / sum w (x^2 + y^2).
#include "record/turning.h"

#include <math.h>

static const double ROUNDING = 1e-12;   // of the contact's breadth: what went no farther is held

static void keep_largest(double *largest, double value)
{
    if (fabs(value) > fabs(*largest)) *largest = value;
}

bool turning_record(void *self, const Observation *seen, Error *err)
{
    (void)err;
    Turning *turning = self;
    const ContactArrays *contact = turning->contact;
    const Interface *interface = seen->interface;
    if (contact->tangents < 2) return true;

    // Means over the contact, of places and of slip.
    double weight = 0, mean_x = 0, mean_y = 0, mean_slip[2] = {0};
    for (int32_t i = 0; i < contact->count; i++) weight += interface->weight[i];
    for (int32_t i = 0; i < contact->count; i++) {
        double part = interface->weight[i] / weight;
        mean_x += part * interface->x[i];
        mean_y += part * interface->y[i];
        for (int32_t c = 0; c < 2; c++) mean_slip[c] += part * contact->slip[2 * i + c];
    }
    double turned = 0, inertia = 0, low = INFINITY, high = -INFINITY;
    for (int32_t i = 0; i < contact->count; i++) {
        double w = interface->weight[i];
        double x = interface->x[i] - mean_x, y = interface->y[i] - mean_y;
        const double *slip = &contact->slip[contact->tangents * i];
        turned += w * (x * slip[1] - y * slip[0]);
        inertia += w * (x * x + y * y);
        low = fmin(low, interface->y[i]);
        high = fmax(high, interface->y[i]);
        keep_largest(&turning->across, slip[1]);
    }
    turning->breadth = high - low;
    keep_largest(&turning->angle, turned / inertia);
    keep_largest(&turning->drift, mean_slip[1]);
    keep_largest(&turning->way, mean_slip[0]);
    return true;
}

double turning_share(const Turning *turning)
{
    double sides = 0.5 * turning->breadth * fabs(turning->angle);
    double way = fabs(turning->way);
    return way > ROUNDING * turning->breadth ? fmax(sides, fabs(turning->drift)) / way : 0;
}

void turning_write_json(const Turning *turning, JsonWriter *json)
{
    json_object_of(json, "turning", {"angle", turning->angle}, {"drift", turning->drift},
                   {"across", turning->across}, {"way", turning->way});
}

void turning_archive(Turning *turning, Archive *archive)
{
    archive_section(archive, "turning");
    archive_numbers_of(archive, &turning->angle, &turning->drift, &turning->across, &turning->way,
                       &turning->breadth);
}
