// SPDX-License-Identifier: GPL-2.0-or-later
// With T(x, y) the time when the front comes to a place, its speed there is 1/|grad T|, and by the
// coarea formula the integral of |grad T| over an area is that of the front's length on it over
// time (Federer 1959). grad T is one vector a face: the plane nearest to the times of its nodes, so
// that faces of any kind are taken alike, those of TET10 by their mid-sides.
#include "record/front_area.h"

#include <math.h>

typedef struct Place {
    double x, y;
} Place;

static Place point_place(const Interface *interface, int32_t point)
{
    int32_t touch = interface->contact_count;
    if (point < touch) return (Place){interface->x[point], interface->y[point]};
    const double *corner = interface->faces.corner + 2 * (int64_t)(point - touch);
    return (Place){corner[0], corner[1]};
}

// |grad T| of a face, time over length.
static double slowness(const Interface *interface, const int32_t *point, int32_t count,
                       const double *arrival)
{
    double n = 0, x = 0, y = 0, t = 0, xx = 0, xy = 0, yy = 0, xt = 0, yt = 0;
    for (int32_t k = 0; k < count; k++) {
        int32_t i = point[k];
        if (i >= interface->contact_count) continue;
        n++;
        x += interface->x[i];
        y += interface->y[i];
        t += arrival[i];
    }
    for (int32_t k = 0; k < count; k++) {
        int32_t i = point[k];
        if (i >= interface->contact_count) continue;
        double dx = interface->x[i] - x / n, dy = interface->y[i] - y / n, dt = arrival[i] - t / n;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
        xt += dx * dt;
        yt += dy * dt;
    }
    double determinant = xx * yy - xy * xy;
    return hypot(yy * xt - xy * yt, xx * yt - xy * xt) / determinant;
}

double front_area_speed(const Interface *interface, const double *arrival, double origin)
{
    const ContactFaces *faces = &interface->faces;
    double swept = 0, length_time = 0;
    for (int32_t f = 0; f < faces->count; f++) {
        const int32_t *point = faces->point + (int64_t)f * faces->width;
        int32_t count = contact_face_points(faces, f);

        // Faces that the front came to all of, and not all of it by `origin`.
        bool everywhere = true, later = false;
        for (int32_t k = 0; k < count; k++) {
            int32_t i = point[k];
            if (i >= interface->contact_count) continue;   // a corner that touches nothing
            everywhere = everywhere && isfinite(arrival[i]);
            later = later || arrival[i] > origin;
        }
        if (!everywhere || !later) continue;

        // Area from the corners, which are the first of the points: three of 3 or 6, four of 4 or
        // 9.
        int32_t corners = count % 3 == 0 && count < 9 ? 3 : 4;
        double twice = 0;
        for (int32_t k = 0; k < corners; k++) {
            Place a = point_place(interface, point[k]);
            Place b = point_place(interface, point[(k + 1) % corners]);
            twice += a.x * b.y - b.x * a.y;
        }
        double area = 0.5 * fabs(twice);
        swept += area;
        length_time += area * slowness(interface, point, count, arrival);
    }
    return length_time > 0 ? swept / length_time : NAN;
}
