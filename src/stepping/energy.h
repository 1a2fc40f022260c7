// SPDX-License-Identifier: GPL-2.0-or-later
// The energy ledger: work of rod and loads = elastic + kinetic + viscous + frictional. Works and
// dissipations are summed over the stages with the scheme's own weights, stored energies are taken
// from the states, so the imbalance is the integrator's error (and goes down at its order) or a
// bug. All per width, of the block. Filled by stepping/sdirk, judged by run/simulation.
#ifndef AMONTONS_STEPPING_ENERGY_H
#define AMONTONS_STEPPING_ENERGY_H

#include "stepping/state.h"

typedef struct EnergyLedger {
    double rod_work;   // by the rod on the block
    double load_work;   // by pressure and tractions
    double viscous;   // dissipated in the bulk, >= 0
    double frictional;   // dissipated on the interface, >= 0
    double elastic;   // stored now
    double kinetic;   // now
    double stored_at_start;   // elastic + kinetic when the ledger was opened
} EnergyLedger;

EnergyLedger energy_open(const State *state);
void energy_store(const State *state, EnergyLedger *ledger);

// Adds `weight` (time) times the powers of one stage: C v [dof_count], v and r on the interface.
typedef struct StagePower {
    double rod, viscous, frictional;   // energy/time
} StagePower;
StagePower energy_stage(const Interface *interface, const double *velocity,
                        const double *viscous_force, int32_t dof_count,
                        const ContactSolution *contact);

double energy_imbalance(const EnergyLedger *ledger);   // work - stored - dissipated
// Of the imbalance: everything that was moved, summed by magnitude.
double energy_turnover(const EnergyLedger *ledger);
// What was moved between two times, summed by magnitude.
double energy_turned_over(const EnergyLedger *before, const EnergyLedger *after);

#endif
