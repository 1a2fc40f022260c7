// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/path_bounds.h"

#include "contact/rod.h"

#include <math.h>

enum { CONDITIONS = 4 };   // of a node, at most

double path_condition(const PathTrace *trace, int32_t node, int32_t kind, const double *v,
                      const double *r, double one)
{
    const ContactProblem *problem = trace->system.problem;
    const Interface *interface = problem->interface;
    if (node >= interface->contact_count) {
        int32_t j = node - interface->contact_count, x = interface_rod(interface, j);
        if (kind > 0 || problem->rod_kind != ROD_PUSHES) return INFINITY;
        return trace->system.at->rod_touches[j]
                   ? r[x] / trace->scales.force
                   : (v[x] - one * problem->bound[x]) / trace->scales.velocity;
    }
    const FrictionLaw *law = friction_at(problem->law, node);
    int32_t t = interface_tangent(interface, node), n = interface_normal(interface, node);
    uint8_t status = trace->system.at->status[node];
    if (status == CONTACT_OPEN)
        return kind == 0 ? (v[n] - one * problem->bound[n]) / trace->scales.velocity : INFINITY;
    if (status == CONTACT_STICK && kind > 1) return INFINITY;
    if (status == CONTACT_STICK)
        return (law->mu_static * r[n] + (kind == 0 ? r[t] : -r[t])) / trace->scales.force;
    double speed = status_direction(status) * v[t];
    if (kind == 0) return speed / trace->scales.velocity;
    if (kind == 1) return r[n] / trace->scales.force;
    // Above the lower end of its piece of the law, where there is one; below the upper.
    int32_t piece = trace->system.piece[node];
    bool lower = kind == 2 && piece > 0;
    double kink = kind == 3 && piece == 0 ? INFINITY : friction_kink(law, piece - lower);
    if (!isfinite(kink)) return INFINITY;
    return (lower ? 1 : -1) * (speed - one * kink) / trace->scales.velocity;
}

PathBound path_nearest_bound(const PathTrace *trace)
{
    const Interface *interface = trace->system.problem->interface;
    PathBound nearest = {.node = PATH_AT_END, .distance = INFINITY};
    if (trace->tau_rate < 0) nearest.distance = trace->tau / -trace->tau_rate;
    for (int32_t node = 0; node < interface->contact_count + interface->rod_count; node++) {
        for (int32_t kind = 0; kind < CONDITIONS; kind++) {
            double value = path_condition(trace, node, kind, trace->system.at->velocity,
                                          trace->system.at->reaction, 1);
            if (value == INFINITY) break;
            double rate =
                path_condition(trace, node, kind, trace->velocity_rate, trace->reaction_rate, 0);
            if (!(rate < 0) || fmax(value, 0) >= -rate * nearest.distance) continue;
            nearest = (PathBound){node, kind, fmax(value, 0) / -rate};
        }
    }
    return nearest;
}

double path_worst_condition(const PathTrace *trace, PathBound *worst)
{
    const Interface *interface = trace->system.problem->interface;
    double least = trace->tau / trace->scales.velocity;
    *worst = (PathBound){.node = PATH_AT_END};
    for (int32_t node = 0; node < interface->contact_count + interface->rod_count; node++) {
        for (int32_t kind = 0; kind < CONDITIONS; kind++) {
            double value = path_condition(trace, node, kind, trace->system.at->velocity,
                                          trace->system.at->reaction, 1);
            if (value >= least) continue;
            least = value;
            *worst = (PathBound){.node = node, .kind = kind};
        }
    }
    return least;
}
