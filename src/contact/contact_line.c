// SPDX-License-Identifier: GPL-2.0-or-later
// On a grid the line is the row of nodes nearest to the middle; elsewhere nodes of a strip around
// it, as wide as a mean cell is long.
#include "contact/contact_line.h"

#include "base/memory.h"

#include <math.h>

static const double ROUNDING = 1e-6;   // of places, over the length of a cell

// y of the node nearest to the middle; of two as near the lower one.
static double line_place(const Interface *interface, double rounding)
{
    double low = INFINITY, high = -INFINITY, place = INFINITY;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        low = fmin(low, interface->y[i]);
        high = fmax(high, interface->y[i]);
    }
    double middle = 0.5 * (low + high);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double nearer = fabs(place - middle) - fabs(interface->y[i] - middle);
        bool lower = fabs(nearer) <= rounding && interface->y[i] < place;
        if (nearer > rounding || lower) place = interface->y[i];
    }
    return place;
}

bool contact_line_find(Interface *interface, Error *err)
{
    double area = 0;
    if (!interface->y) return true;
    interface->line = NEW_ARRAY(int32_t, interface->contact_count, err);
    if (!interface->line) return false;
    for (int32_t i = 0; i < interface->contact_count; i++) area += interface->weight[i];
    double cell = sqrt(area / interface->contact_count), rounding = ROUNDING * cell;
    double place = line_place(interface, rounding);
    interface->line_count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t *last = interface->line + interface->line_count - 1;
        double off = fabs(interface->y[i] - place);
        if (off > 0.5 * cell + rounding) continue;
        bool beside = interface->line_count > 0 && interface->x[i] - interface->x[*last] <= rounding;
        if (!beside)
            interface->line[interface->line_count++] = i;
        else if (off < fabs(interface->y[*last] - place))
            *last = i;
    }
    return true;
}
