// SPDX-License-Identifier: GPL-2.0-or-later
// Arrival times as seismology takes them: the first passage of a threshold. With |v| known at both
// ends of a step the moment is found by linear interpolation, so that speeds are better than the
// contact's spacing over the step.
#include "record/front_path.h"

#include "base/memory.h"
#include "contact/slip.h"

#include <math.h>

// Distance so near to a node that the next one does not count: the front may have stopped there.
static const double AT_NODE = 1e-6;   // of the way to the next

bool front_path_create(const Interface *interface, double threshold, FrontPath *path, Error *err)
{
    *path = (FrontPath){.threshold = threshold, .t_before = NAN};
    path->rate_before = NEW_ARRAY(double, interface->contact_count, err);
    path->arrival = NEW_ARRAY(double, interface->contact_count, err);
    if (!error_is_clean(err)) return false;
    front_path_restart(interface, path);

    int32_t last = interface_line_count(interface) - 1, i = 0;
    double start = interface_line_x(interface, 0);
    double length = interface_line_x(interface, last) - start;
    path->spacing = length / (FRONT_STATIONS - 1);
    for (int32_t k = 0; k < FRONT_STATIONS; k++) {
        double place = start + length * k / (FRONT_STATIONS - 1);
        while (i < last - 1 && interface_line_x(interface, i + 1) <= place) i++;
        int32_t node = interface_line_node(interface, i);   // place within [x_i, x_i+1]
        int32_t behind = last > 0 ? interface_line_node(interface, i + 1) : node;
        const double *x = interface->x;
        double part = last > 0 ? (place - x[node]) / (x[behind] - x[node]) : 0;
        FrontStation *station = &path->station[k];
        *station =
            (FrontStation){.node = {node, behind}, .part = part, .pad = interface->pad[node]};
        if (part < AT_NODE) continue;
        int32_t next = interface->pad[behind];
        if (part > 1 - AT_NODE)
            station->pad = next;
        else if (next != station->pad)
            station->pad = -1;
    }

    return true;
}

void front_path_destroy(FrontPath *path)
{
    memory_free_all(path->rate_before, path->arrival);
    *path = (FrontPath){0};
}

void front_path_restart(const Interface *interface, FrontPath *path)
{
    for (int32_t i = 0; i < interface->contact_count; i++) path->arrival[i] = NAN;
}

void front_path_follow(FrontPath *path, const Observation *seen)
{
    for (int32_t i = 0; i < seen->interface->contact_count; i++) {
        double rate = slip_size(seen->interface, i, seen->state->slip_rate);
        if (!(rate > path->threshold) || !isnan(path->arrival[i])) continue;
        // The time when the rate passed the threshold on its way from `before` to now.
        double before = path->rate_before[i];
        double part = (path->threshold - before) / (rate - before);
        bool at_once = isnan(path->t_before) || before >= path->threshold;
        path->arrival[i] = at_once ? seen->t : path->t_before + part * (seen->t - path->t_before);
    }
}

// Called in every step, also in those without a rapid event, so that its first step can be
// interpolated.
void front_path_keep(FrontPath *path, const Observation *seen)
{
    for (int32_t i = 0; i < seen->interface->contact_count; i++)
        path->rate_before[i] = slip_size(seen->interface, i, seen->state->slip_rate);
    path->t_before = seen->t;
}

// Where one of two neighbours was never reached, stations between them are NaN.
void front_path_stations(const FrontPath *path, double origin, double times[FRONT_STATIONS])
{
    for (int32_t k = 0; k < FRONT_STATIONS; k++) {
        const FrontStation *station = &path->station[k];
        double first = path->arrival[station->node[0]], second = path->arrival[station->node[1]];
        double part = station->part;
        if (station->pad < 0)
            times[k] = NAN;
        else if (part < AT_NODE)
            times[k] = first - origin;
        else if (part > 1 - AT_NODE)
            times[k] = second - origin;
        else
            times[k] = (1 - part) * first + part * second - origin;
    }
}

double front_path_speed(const FrontPath *path, const double times[FRONT_STATIONS], int32_t k)
{
    double elapsed = times[k + 1] - times[k];
    bool together = path->station[k].pad == path->station[k + 1].pad;
    return together && elapsed != 0 ? path->spacing / elapsed : NAN;
}

void front_path_archive(FrontPath *path, int32_t contact_count, Archive *archive)
{
    archive_number(archive, &path->t_before);
    archive_numbers(archive, path->rate_before, contact_count);
    archive_numbers(archive, path->arrival, contact_count);
}
