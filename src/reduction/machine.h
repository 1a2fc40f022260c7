// SPDX-License-Identifier: GPL-2.0-or-later
// The machine behind the rod: a spring of stiffness k between the drive, which goes where the scene
// says, and a rod without mass, whose own way R then follows from the forces at its nodes,
//
//     sum_j r_j = k (U - R).
//
// Contact sees how the nodes move against the rod: y = v - e v_R, where e is 1 at rod nodes and 0
// elsewhere. With S v = g + r, s = S e and the spring's force f - kappa v_R at the end of a stage
// (kappa = k times what a displacement is of a velocity), v_R is eliminated:
//
//     S' y = g' + r,       S' = S - s s'/p,    g' = g - s (f + e'g)/p,    p = kappa + e's,
//     v_R = (f + e'g - s'y)/p
//
// S' has the size and the properties of S, and the conditions of the rod are those of a rigid one
// for y: whoever solves or judges a contact problem need not know of the machine. For a stiff
// spring S' tends to S. Kept with each condensed operator by reduction/interface_operator.
#ifndef AMONTONS_REDUCTION_MACHINE_H
#define AMONTONS_REDUCTION_MACHINE_H

#include "base/error.h"

#include <stdint.h>

typedef struct Machine {
    double stiffness;   // k, force/width over length; 0: rigid, nothing here is used
    int32_t first;   // interface unknowns from here on are the rod's
} Machine;

typedef struct MachineColumn {
    double *column;   // s [count], NULL: there is no spring; owned
    int32_t first, count;   // rod's first unknown; all of the interface
    double pivot;   // p
    double force;   // f, force/width
    double given;   // f + e'g of the last machine_refer
} MachineColumn;

// Makes S' of S in `schur` [count^2]. reach: of the operator (OperatorTerms.stiffness); 0 or very
// short: S' would leave a rod that touches nothing undetermined, see machine.c.
bool machine_soften(const Machine *machine, double reach, int32_t count, double *schur,
                    MachineColumn *column, Error *err);
void machine_column_destroy(MachineColumn *column);

void machine_refer(MachineColumn *column, double *g);   // g' in the place of g [count]
// v in the place of y [count]; returns v_R, velocity.
double machine_release(const MachineColumn *column, double *velocity);

#endif
