// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/stretches.h"

#include "base/memory.h"
#include "record/pad_sums.h"

#include <math.h>
#include <string.h>

enum { STRETCHES = 16 };   // about so many, and no fewer than pads

// A pad of so many nodes out of `all` is cut into parts with as many nodes each, as far as it goes.
static int32_t parts_of(int32_t nodes, int32_t all)
{
    int32_t parts = (int32_t)lround((double)STRETCHES * nodes / all);
    return parts < 1 ? 1 : (parts > nodes ? nodes : parts);
}

bool stretches_create(const Interface *interface, Stretches *stretches, Error *err)
{
    int32_t nodes = interface->contact_count;
    *stretches = (Stretches){.contact_count = nodes, .stuck = nodes};
    stretches->of_node = NEW_ARRAY(int32_t, nodes, err);
    stretches->slipped = NEW_ARRAY(uint8_t, nodes, err);
    stretches->nodes = NEW_ARRAY(double, nodes, err);
    if (!error_is_clean(err)) return false;
    for (int32_t p = 0; p < interface->pad_count; p++) {
        int32_t own = pad_size(interface, p).nodes, seen = 0;
        if (own == 0) continue;
        int32_t parts = parts_of(own, nodes);
        for (int32_t i = 0; i < nodes; i++) {
            if (interface->pad[i] != p) continue;
            int32_t stretch = stretches->count + seen++ * parts / own;
            stretches->of_node[i] = stretch;
            stretches->nodes[stretch]++;
        }
        stretches->count += parts;
    }
    return true;
}

void stretches_destroy(Stretches *stretches)
{
    memory_free_all(stretches->of_node, stretches->nodes, stretches->slipped);
    *stretches = (Stretches){0};
}

void stretches_follow(Stretches *stretches, const Observation *seen)
{
    if (stretches->stuck == 0) return;
    for (int32_t i = 0; i < stretches->contact_count; i++) {
        if (seen_status(seen, i) == CONTACT_STICK || stretches->slipped[i]) continue;
        stretches->slipped[i] = 1;
        stretches->stuck--;
    }
}

void stretches_read(const Stretches *stretches, const Observation *seen, double *state)
{
    const State *now = seen->state;
    double *shear = state, *lag = state + stretches->count, normal = 0;
    memset(state, 0, 2 * (size_t)stretches->count * sizeof *state);
    for (int32_t i = 0; i < stretches->contact_count; i++) {
        int32_t s = stretches->of_node[i], t = interface_tangent(seen->interface, i);
        normal += now->reaction[interface_normal(seen->interface, i)];
        shear[s] -= now->reaction[t];
        lag[s] += seen->U - now->displacement[seen->system->interface_dofs[t]];
    }
    for (int32_t s = 0; s < stretches->count; s++) {
        shear[s] = normal > 0 ? shear[s] / normal : 0;
        lag[s] /= stretches->nodes[s];
    }
}

void stretches_archive(Stretches *stretches, Archive *archive)
{
    archive_octets(archive, stretches->slipped, stretches->contact_count);
    archive_index(archive, &stretches->stuck, 0, stretches->contact_count + 1);
}
