// SPDX-License-Identifier: GPL-2.0-or-later
// With weights w, places (x, y) from their mean and slip (s_x, s_y): the rotation that leaves least
// of slip is sum w (x s_y - y s_x) / sum w (x^2 + y^2).
#include "record/rotation.h"

#include <math.h>

static const double ROUNDING = 1e-12;   // of the contact's breadth: what went no farther is held

static void keep_largest(double *largest, double value)
{
    if (fabs(value) > fabs(*largest)) *largest = value;
}

bool rotation_record(void *self, const Observation *seen, Error *err)
{
    (void)err;
    Rotation *rotation = self;
    const ContactArrays *contact = rotation->contact;
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
        keep_largest(&rotation->across, slip[1]);
    }
    rotation->breadth = high - low;
    keep_largest(&rotation->angle, turned / inertia);
    keep_largest(&rotation->drift, mean_slip[1]);
    keep_largest(&rotation->way, mean_slip[0]);
    return true;
}

double rotation_share(const Rotation *rotation)
{
    double sides = 0.5 * rotation->breadth * fabs(rotation->angle);
    double way = fabs(rotation->way);
    return way > ROUNDING * rotation->breadth ? fmax(sides, fabs(rotation->drift)) / way : 0;
}

void rotation_write_json(const Rotation *rotation, JsonWriter *json)
{
    json_object_of(json, "turning", {"angle", rotation->angle}, {"drift", rotation->drift},
                   {"across", rotation->across}, {"way", rotation->way});
}

void rotation_archive(Rotation *rotation, Archive *archive)
{
    archive_section(archive, "turning");
    archive_numbers_of(archive, &rotation->angle, &rotation->drift, &rotation->across,
                       &rotation->way, &rotation->breadth);
}
