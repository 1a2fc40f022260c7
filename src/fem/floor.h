// SPDX-License-Identifier: GPL-2.0-or-later
// A floor that deforms: the surface of a second body, the base, under the contact. Over it the
// unknown of a contact node is its jump w against the floor,
//
//     u_c = w + P u_f,      P_if = int psi_i N_f dA / int psi_i dA,
//
// with u_f the displacements of the floor's nodes and psi_i the dual shape function of contact node
// i, which is orthogonal to the shape functions of all other contact nodes (Wohlmuth, SIAM J.
// Numer. Anal. 38, 2000). So each contact node keeps one weight and one reaction, a constant stress
// passes from one mesh to the other without error, and where both meshes match P is the identity.
// Integrals are taken over the shadows of both surfaces on z = 0, piece by piece of where a face of
// one lies over a face of the other. What works with w sees contact, friction and reactions as over
// a rigid floor. Called by model/assemble (finds it), fem/assembly (the matrices of w) and whoever
// shows displacements of the mesh.
#ifndef AMONTONS_FEM_FLOOR_H
#define AMONTONS_FEM_FLOOR_H

#include "fem/mesh.h"

// Fills mesh->floor from the contact of these names (as of mesh_contact) and the boundary called
// `floor`, which must lie under all of it, once; without a base there is nothing to do.
// ERROR_INPUT: it does not, or a contact node is below it, or none stands on it.
bool floor_find(const char (*names)[GROUP_NAME_SIZE], int32_t name_count, const char *floor,
                Mesh *mesh, Error *err);
void floor_destroy(Floor *floor);

// Jumps to displacements: u_c = w + P u_f, in place. field: [dim * nodes], or velocities.
void floor_displace(const Mesh *mesh, double *field);
// The same backwards.
void floor_find_jumps(const Mesh *mesh, double *field);
// Forces on nodes to forces on the unknowns: f_f += P' f_c, in place.
void floor_gather(const Mesh *mesh, double *force);
// The same backwards.
void floor_scatter(const Mesh *mesh, double *force);

#endif
