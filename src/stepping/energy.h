// SPDX-License-Identifier: GPL-2.0-or-later
// The energy ledger: work of rod and loads = elastic + kinetic + viscous + frictional. Works and
// dissipations are summed over the stages with the scheme's own weights, stored energies are taken
// from the states, so the imbalance is the integrator's error (and goes down at its order) or a
// bug, which shows as an imbalance that does not go down with the step. All per width, of the
// block. Filled by stepping/sdirk, judged by stepping/step_control and run/simulation.
#ifndef AMONTONS_STEPPING_ENERGY_H
#define AMONTONS_STEPPING_ENERGY_H

#include "stepping/state.h"

// Energy of the branches of one relaxation time (fem/spectrum), a part of `elastic` and of
// `viscous`.
typedef struct BranchEnergy {
    double stored;   // now, in their springs
    double dissipated;   // in their dashpots, >= 0
} BranchEnergy;

typedef struct EnergyLedger {
    double rod_work;   // by the rod on the block
    double load_work;   // by pressure and tractions
    double viscous;   // dissipated in the bulk, by C and by branches, >= 0
    double frictional;   // dissipated on the interface, >= 0
    double elastic;   // stored now, in branches, too
    double kinetic;   // now
    double stored_at_start;   // elastic + kinetic when the ledger was opened
    BranchEnergy branch[SPECTRUM_TIMES_MAX];   // of each relaxation time
} EnergyLedger;

EnergyLedger energy_open(const State *state);
void energy_store(const State *state, EnergyLedger *ledger);

// Powers of one stage, from C v [dof_count] and from v and r on the interface.
typedef struct StagePower {
    double rod, viscous, frictional;   // energy/time
} StagePower;
StagePower energy_stage(const Interface *interface, const double *velocity,
                        const double *viscous_force, int32_t dof_count,
                        const ContactSolution *contact);

double energy_imbalance(const EnergyLedger *ledger);   // work - stored - dissipated
// The measure of an imbalance: all energy that was moved since the ledger was opened, summed
// by magnitude, and what was stored then.
double energy_turnover(const EnergyLedger *ledger);

void energy_archive(EnergyLedger *ledger, Archive *archive);

#endif
