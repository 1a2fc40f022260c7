// SPDX-License-Identifier: GPL-2.0-or-later
// The contact problem in space, where friction is a disc of forces: a semismooth Newton method
// (Alart and Curnier, Comp. Meth. Appl. Mech. Eng. 92, 1991). Before each step the status of a node
// follows from r - rho v, rho the node's own entry of S:
//
//     p = r_n - rho (v_n - bound) <= 0       open
//     z = r_t - rho v_t, |z| <= mu p         sticks
//     else                                   slips along d = -z/|z|, e across it, |v_t| = s
//
// and a slipping node has two equations,
//
//     along      d.r_t + mu(s) r_n = 0
//     across     (1 - theta) e.r_t + theta rho e.v_t = 0,      theta = mu p/(mu p + rho s),
//
// which say r_t = -mu(s) r_n v_t/s. The second is e.(r_t + mu r_n v_t/s) by (1 - theta): so a
// node that only starts, s = 0, holds its direction, and one that slips fast turns as its force
// does. Their derivatives beside S: mu'(s) r_n along the slip, theta rho across. What is open is
// condensed out as in the plane (contact/contact_newton).
// Factors are in single precision, after sweeps in double. A step that leaves more than there was
// is halved. Where steps do not settle, sweeps over the nodes come next (contact/contact_sweeps),
// then steps again, then more sweeps. Called by contact/contact_solver.
#ifndef AMONTONS_CONTACT_CONTACT_DISCS_H
#define AMONTONS_CONTACT_CONTACT_DISCS_H

#include "contact/contact_newton.h"
#include "contact/slip.h"

// The two equations of a slipping node.
typedef struct DiscRow {
    double d[TANGENTS_MAX];   // along z, against friction; e = (-d[1], d[0])
    double mu;
    double theta, rho;   // rho: force/width per velocity
    double along[TANGENTS_MAX];   // mu' r_n v_t/s: how friction along d answers to v_t
} DiscRow;

// LU of the derivative in single precision: Newton's residual is of double precision, so that it
// takes hardly a step more, and a factor half the time.
typedef struct DiscFactors {
    float *lu;   // [rows^2] of the derivative over the largest entry of S; owned, like what follows
    int32_t *pivots;   // [rows]
    float *single;   // [interface->count] work
    double *column;   // [interface->count] work
    int32_t rows;   // 0: there are none
} DiscFactors;

typedef struct ContactDiscs {
    ContactNewton *newton;   // lists, products with S and factors; not owned
    DiscRow *row;   // [contact_count] of slipping nodes, at the velocities as they are; owned
    DiscRow *kept;   // [contact_count] of the derivative that was factored; owned
    double *taken;   // [interface->count] work: the last step of what is free; owned
    DiscFactors factors;   // of that derivative, where there were no sweeps; owned
    int64_t iterations;   // counted, Newton steps
    int64_t sweeps;   // counted
    int64_t swept;   // counted, solves that needed any
} ContactDiscs;

bool contact_discs_create(const Interface *interface, ContactNewton *newton, ContactDiscs *discs,
                          Error *err);
void contact_discs_destroy(ContactDiscs *discs);

// Solves from the velocities, reactions and statuses in `solution`, which may be those of another
// g: the first step's derivative is theirs. tolerance: of residual forces, relative to the largest
// force. Allocates nothing. Returns false where it stays unsolved.
bool contact_discs_solve(ContactDiscs *discs, double tolerance, const ContactProblem *problem,
                         ContactSolution *solution);

// First-order change of the solution just found under small changes of g and of the bounds:
// `problem` has the changes, and it may have another matrix of as many unknowns; `solution` the
// statuses, which stay. To first order, by `newton`, in which nothing is kept. false: the
// derivative is singular.
bool contact_discs_follow(ContactDiscs *discs, ContactNewton *newton, const ContactProblem *problem,
                          ContactSolution *solution);

void contact_discs_archive(ContactDiscs *discs, const Interface *interface, Archive *archive);

#endif
