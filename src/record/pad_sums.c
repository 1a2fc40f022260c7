// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/pad_sums.h"

#include "contact/slip.h"

#include <math.h>
#include <string.h>

void pad_sums(const Observation *seen, PadSum *sums)
{
    const Interface *interface = seen->interface;
    const State *state = seen->state;
    memset(sums, 0, (size_t)interface->pad_count * sizeof *sums);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        PadSum *sum = &sums[interface->pad[i]];
        sum->normal_force += state->reaction[interface_normal(interface, i)];
        sum->shear -= state->reaction[interface_tangent(interface, i)];
        if (interface->y) sum->shear_across -= state->reaction[interface_tangent(interface, i) + 1];
        if (!status_slips(seen_status(seen, i))) continue;
        sum->slipping += interface->weight[i];
        // Neighbours along the contact belong to the same pad where there is contact between them.
        int32_t pad = interface->pad[i], last = interface->contact_count - 1;
        double before = i > 0 && interface->pad[i - 1] == pad ? 0.5 : 0;
        double after = i < last && interface->pad[i + 1] == pad ? 0.5 : 0;
        sum->slipping_cells += before + after;
        sum->fastest = fmax(sum->fastest, slip_size(interface, i, state->slip_rate));
    }
}

PadSize pad_size(const Interface *interface, int32_t p)
{
    PadSize size = {.x_from = INFINITY, .x_to = -INFINITY, .breadth = 1};
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double y = interface->y ? interface->y[i] : 0;
        if (interface->pad[i] != p) continue;
        size.x_from = fmin(size.x_from, interface->x[i]);
        size.x_to = fmax(size.x_to, interface->x[i]);
        size.y_from = size.nodes == 0 ? y : fmin(size.y_from, y);
        size.y_to = size.nodes == 0 ? y : fmax(size.y_to, y);
        size.weight += interface->weight[i];
        size.nodes++;
    }
    if (interface->y && size.x_to > size.x_from)
        size.breadth = size.weight / (size.x_to - size.x_from);
    return size;
}

void pad_sums_archive(PadSum *sums, int32_t count, Archive *archive)
{
    const int64_t numbers = sizeof *sums / sizeof(double);   // which is all that there is in one
    archive_numbers(archive, &sums->normal_force, numbers * count);
}
