// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/segments.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { SEGMENTS = 16 };   // about so many, and no fewer than pads

bool segments_create(const Interface *interface, Segments *segments, Error *err)
{
    int32_t nodes = interface->contact_count;
    *segments = (Segments){.contact_count = nodes, .stuck = nodes};
    segments->of_node = NEW_ARRAY(int32_t, nodes, err);
    segments->slipped = NEW_ARRAY(uint8_t, nodes, err);
    segments->nodes = NEW_ARRAY(double, nodes, err);
    if (!error_is_clean(err)) return false;
    for (int32_t p = 0; p < interface->pad_count; p++) {
        int32_t own = 0, seen = 0;
        for (int32_t i = 0; i < nodes; i++) own += interface->pad[i] == p;
        if (own == 0) continue;
        // Parts with as many nodes each, as far as it goes.
        int32_t parts = (int32_t)lround((double)SEGMENTS * own / nodes);
        parts = parts < 1 ? 1 : (parts > own ? own : parts);
        for (int32_t i = 0; i < nodes; i++) {
            if (interface->pad[i] != p) continue;
            int32_t segment = segments->count + seen++ * parts / own;
            segments->of_node[i] = segment;
            segments->nodes[segment]++;
        }
        segments->count += parts;
    }
    return true;
}

void segments_destroy(Segments *segments)
{
    memory_free_all(segments->of_node, segments->nodes, segments->slipped);
    *segments = (Segments){0};
}

void segments_follow(Segments *segments, const Observation *seen)
{
    if (segments->stuck == 0) return;
    for (int32_t i = 0; i < segments->contact_count; i++) {
        if (seen_status(seen, i) == CONTACT_STICK || segments->slipped[i]) continue;
        segments->slipped[i] = 1;
        segments->stuck--;
    }
}

void segments_read(const Segments *segments, const Observation *seen, double *state)
{
    const State *now = seen->state;
    double *shear = state, *lag = state + segments->count, normal = 0;
    memset(state, 0, 2 * (size_t)segments->count * sizeof *state);
    for (int32_t i = 0; i < segments->contact_count; i++) {
        int32_t s = segments->of_node[i], t = interface_tangent(seen->interface, i);
        normal += now->reaction[interface_normal(seen->interface, i)];
        shear[s] -= now->reaction[t];
        lag[s] += seen->U - now->displacement[seen->system->interface_dofs[t]];
    }
    for (int32_t s = 0; s < segments->count; s++) {
        shear[s] = normal > 0 ? shear[s] / normal : 0;
        lag[s] /= segments->nodes[s];
    }
}

void segments_archive(Segments *segments, Archive *archive)
{
    archive_octets(archive, segments->slipped, segments->contact_count);
    archive_index(archive, &segments->stuck, 0, segments->contact_count + 1);
}
