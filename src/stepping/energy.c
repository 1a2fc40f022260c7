// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/energy.h"

#include "algebra/dense.h"
#include "contact/slip.h"

#include <math.h>

// Computes the energies from the products that a state keeps.
void energy_store(const State *state, EnergyLedger *ledger)
{
    ledger->kinetic = 0.5 * dense_dot(state->velocity, state->momentum, state->dof_count);
    ledger->elastic = state_elastic_energy(state);
    for (int32_t k = 0; k < state->branch_count; k++)
        ledger->branch[k].stored = state_branch_energy(state, k);
}

// Opens a ledger: the energy stored now counts as given; works begin at 0.
EnergyLedger energy_open(const State *state)
{
    EnergyLedger ledger = {0};
    energy_store(state, &ledger);
    ledger.stored_at_start = ledger.elastic + ledger.kinetic;
    return ledger;
}

// Friction takes -v_t r_t; normals are left out, as the plane does not move; the rod gives v_x r_x.
// Forces are per width, so powers are, too.
StagePower energy_stage(const Interface *interface, const double *velocity,
                        const double *viscous_force, int32_t dof_count,
                        const ContactSolution *contact)
{
    StagePower power = {.viscous = dense_dot(velocity, viscous_force, dof_count)};
    for (int32_t i = 0; i < interface->contact_count; i++)
        power.frictional -= slip_dot(interface, i, contact->velocity, contact->reaction);
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        power.rod += contact->velocity[x] * contact->reaction[x];
    }
    return power;
}

double energy_imbalance(const EnergyLedger *ledger)
{
    return ledger->rod_work + ledger->load_work - ledger->viscous - ledger->frictional -
           (ledger->elastic + ledger->kinetic - ledger->stored_at_start);
}

double energy_turnover(const EnergyLedger *ledger)
{
    return fabs(ledger->rod_work) + fabs(ledger->load_work) + ledger->viscous + ledger->frictional +
           ledger->elastic + ledger->kinetic + ledger->stored_at_start;
}

void energy_archive(EnergyLedger *ledger, Archive *archive)
{
    archive_section(archive, "energy");
    archive_numbers_of(archive, &ledger->rod_work, &ledger->load_work, &ledger->viscous,
                       &ledger->frictional, &ledger->elastic, &ledger->kinetic,
                       &ledger->stored_at_start);
    for (int32_t k = 0; k < SPECTRUM_TIMES_MAX; k++)
        archive_numbers_of(archive, &ledger->branch[k].stored, &ledger->branch[k].dissipated);
}
