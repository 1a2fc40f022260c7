// SPDX-License-Identifier: GPL-2.0-or-later
// Quantities of an accepted step, computed once for all recorders: forces, front, rates, and how
// well the step keeps its balances. The recorders get them in the order in which they were added:
// events first (the others read them), then drops, pads, history, fields, the caller.
#ifndef AMONTONS_RECORD_OBSERVATION_H
#define AMONTONS_RECORD_OBSERVATION_H

#include "base/archive.h"
#include "contact/contact_check.h"
#include "contact/slip.h"
#include "stepping/step_control.h"

typedef struct Observation {
    const State *state;   // not owned
    const BulkOperator *system;   // not owned: where the interface stands in the state
    const Interface *interface;   // not owned
    double t, U;   // time, displacement of the drive, length
    double rod_way;   // R: of the rod itself, less than U where it is driven by a spring; length
    double step_size;   // of the step that ended here; 0 at the start
    double rod_force;   // F_T, force/width
    double normal_force;   // resultant of the contact pressure, force/width
    double mu;   // F_T / F_N, F_N the applied load
    double
        front;   // x to which slip reaches without a gap from the trailing edge, along the line of
    // the contact
    bool front_slips;   // some node up to the front slips; false: these are all open, or the front
        // stands at the trailing edge, and its place is no length of slip
    double trailing;   // x of the block's trailing end: l is front - trailing
    double max_slip_rate;   // velocity
    const Friction *friction;   // of the nodes; not owned
    double creep;   // a node that never sticks counts as at rest while it slips slower; velocity
    bool certified;
    bool grows;   // slip runs away, as step_control saw it
    double energy_imbalance;   // energy/width, since the start
    // The same, relative to the energy turned over, or to the block's kinetic energy at the rod's
    // speed if that is more.
    double energy_error;
    double moment_error;   // of all forces and inertia about the origin, relative to F_N L
    double moment_static_error;   // the same without inertia
    double penetration;   // deepest contact node below the plane, length; 0: none
    double contact_error;   // largest violation of the contact conditions, relative
    double equation_error;   // largest residual of M a + C v + K u = f + r, relative to F_N
} Observation;

// Scales that the observation is measured against.
typedef struct ObservationScales {
    double load;   // F_N, force/width
    double length;   // L, length
    double trailing;   // x of the block's trailing end, length
    double time;   // wave crossing plus viscous time, time
    double slip_velocity;   // velocity
} ObservationScales;

// Status of node i as events, fronts and pictures count it: slow creep counts as stick.
static inline uint8_t seen_status(const Observation *seen, int32_t i)
{
    uint8_t status = seen->state->status[i];
    bool slow = status_slips(status) &&
                slip_size(seen->interface, i, seen->state->slip_rate) < seen->creep;
    return slow && friction_at(seen->friction, i)->law->creeps ? CONTACT_STICK : status;
}

Observation observe(const StepControl *control, const ObservationScales *scales);

// Forces and slip of each pad in one accepted step, summed over its nodes.
typedef struct PadSum {
    double normal_force;   // force/width
    double shear;   // positive where the plane holds the block back, force/width
    double shear_across;   // towards -y; 0 in the plane, force
    double slipping;   // how much of the pad slips, length, in space length^2
    double slipping_cells;   // in the plane the same counted in nodes, an end of the pad as half a
        // one: cells of the contact, halves of them where elements are of order 2
    double fastest;   // largest |slip rate|, velocity
} PadSum;

// sums: [pad_count], overwritten. Open nodes carry nothing and do not count as slipping.
void pad_sums(const Observation *seen, PadSum *sums);

// Size of a pad.
typedef struct PadSize {
    int32_t nodes;
    double x_from, x_to;   // length
    double y_from, y_to;   // 0 in the plane
    double weight;   // sum of its nodes': length, in space length^2
    double breadth;   // its weight over its extent along the drive, length; 1 in the plane
} PadSize;
PadSize pad_size(const Interface *interface, int32_t p);

void pad_sums_archive(PadSum *sums, int32_t count, Archive *archive);

typedef struct Recorder {
    void *self;   // not owned
    bool (*record)(void *self, const Observation *seen, Error *err);
} Recorder;

enum { RECORDERS_MAX = 16 };

typedef struct Recorders {
    int32_t count;
    Recorder list[RECORDERS_MAX];
} Recorders;

void recorders_add(Recorders *recorders, void *self,
                   bool (*record)(void *self, const Observation *seen, Error *err));
bool recorders_record(const Recorders *recorders, const Observation *seen, Error *err);

// The part of a run that a scene wants written, output.window. A recorder that hands steps on to
// those inside of it while it is open.
typedef struct WindowDef {
    bool given;   // else all of the run
    double from_U, to_U, from_t, to_t;   // length, time; to: INFINITY where not asked
} WindowDef;

typedef struct Window {
    WindowDef def;
    Recorders inside;
    int32_t steps;   // handed on inside
} Window;

bool window_record(void *self, const Observation *seen, Error *err);   // a Recorder
void window_archive(Window *window, Archive *archive);

#endif
