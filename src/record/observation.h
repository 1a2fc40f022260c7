// SPDX-License-Identifier: GPL-2.0-or-later
// Quantities of an accepted step, computed once for all recorders: forces, front, rates, and how
// well the step keeps its balances. The recorders get them in the order in which they were added:
// events first (the others read them), then drops, pads, history, fields, the caller.
#ifndef AMONTONS_RECORD_OBSERVATION_H
#define AMONTONS_RECORD_OBSERVATION_H

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

#endif
