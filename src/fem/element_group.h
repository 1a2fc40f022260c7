// SPDX-License-Identifier: GPL-2.0-or-later
// Elements that share one areal strain. A linear element of a nearly incompressible material locks:
// a T3 can hardly move without changing its area, as can no quadrature point of a Q4. So there
// the areal strain is a mean over a Q4 or over a pair of T3 (Nagtegaal, Parks and Rice, Comp. Meth.
// Appl. Mech. Eng. 4, 1974; Hughes, The Finite Element Method, 4.4; pairs: de Souza Neto, Andrade
// Pires and Owen, Int. J. Numer. Meth. Eng. 62, 2005),
//
//     K = sum of int B' D_dev B  +  k/A g g',      g = int (N_a,x  N_a,z),  k = (D_xx + D_xz)/2,
//
// A the group's area; C likewise. The mean over a pair is a function of its four corners alone, the
// same as of the Q4 in its place: there are as many conditions as nodes, on twice as many unknowns.
// In space likewise the change of volume, k = (D_xx + 2 D_xy)/3, over one HEX8 or WEDGE6; a TET4
// has one change of volume as it is, and locks. Called by model/assemble (finds them),
// fem/assembly, fem/recovery and run/static/static_solve.
#ifndef AMONTONS_FEM_ELEMENT_GROUP_H
#define AMONTONS_FEM_ELEMENT_GROUP_H

#include "fem/element.h"
#include "fem/mesh.h"

// A pair of T3 whose four edges have each taken in a T3 that was left over.
enum { GROUP_ELEMENTS_MAX = 6 };

// One element, or all that share its areal strain.
typedef struct ElementGroup {
    int32_t count;
    int32_t element[GROUP_ELEMENTS_MAX];   // [count], the lowest number first
    bool is_mean;   // the areal strain is a mean
    int32_t node_count;
    int32_t node[ELEMENT_NODES_MAX];   // [node_count] each once
} ElementGroup;

// Groups the Q4 and T3 of the regions that `is_mean` [regions] marks, in each region for itself:
// fills mesh->mean_next. T3 are joined by their longest edges first; one that is left over joins
// the smallest group beside it.
bool element_groups_find(const uint8_t *is_mean, Mesh *mesh, Error *err);

// The group that begins with element e; false: e is in one that begins with another.
bool element_group_at(const Mesh *mesh, int32_t e, ElementGroup *group);

// The group that element e is in.
void element_group_of(const Mesh *mesh, int32_t e, ElementGroup *group);

// materials: by region. The matrices' nodes are the group's.
void element_group_matrices(const Mesh *mesh, const Material *materials, const ElementGroup *group,
                            ElementMatrices *out);

// g [dim * node_count] of the group's nodes over its area: its mean areal strain is g u.
void element_group_areal(const Mesh *mesh, const ElementGroup *group, double *g);

#endif
