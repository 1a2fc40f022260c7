// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk is linear; only the interface is not. So it is reduced once, before time stepping, to
// the interface's own unknowns and a small interior basis (component mode synthesis: Craig and
// Bampton, AIAA J. 6, 1968, with responses at real shifts in place of vibration modes, because C is
// not proportional to K). reduction/reduced_bulk draws the result: Psi = -K_ii^-1 K_ib are the
// static constraint modes, Phi is what the responses of the full mesh hold beyond them. A Galerkin
// projection, so M, C, K stay symmetric and positive.
//
// A step of any size of a block of any length asks for the interface operator S of
//
//     A = (1 - viscosity) K + viscosity C + inertia M,     0 <= viscosity <= 1,  inertia >= 0,
//
// up to a factor, M, C and K normalised, and the basis is built to respond on all of that domain:
// one serves every L, rho, E and eta of a shape, every load of the same pattern, every step. From
// the slowest mode of the interior to the inertia that takes over within one element, and from all
// elastic to all viscous, S is compared with the full mesh, and the directions in which its error
// is more than
//
//     tolerance^2 + 2.5 tolerance * inertia / (that of one element)
//
// get their responses added (reduction/reduction.c). The first term: an energy goes with the square
// of what is left out. The second: where inertia acts within an element the mesh itself is no
// better. Called by model/obtain; used through reduction/interface_operator; stored
// by model/basis_cache.
#ifndef AMONTONS_REDUCTION_REDUCTION_H
#define AMONTONS_REDUCTION_REDUCTION_H

#include "fem/assembly.h"
#include "reduction/reduced_bulk.h"

typedef struct ReductionDef {
    double tolerance;   // of responses, relative, in the energy norm
    BulkScales scales;   // of the bulk to reduce
    Materials materials;   // likewise
    bool modes;   // of the whole mesh are wanted, to see what happens inside
    bool one_by_one;   // parts of a block that is its own mirror image are built one after another,
        // in 0.8 of the memory, else two at a time
    bool no_patches;   // what is far is not replaced: in space too little is for patches to pay
    int32_t *const
        *node_image;   // [DIM_MAX - 1] of the block (reduction/reduction_block); NULL: none
    const double
        *position;   // [dof_count] of its nodes, for rigid motions; NULL: none are asked for
    // Asked at every training point, from several threads; false ends the reduction. NULL: nobody.
    bool (*goes_on)(void *self, Error *err);
    void *self;   // of goes_on; not owned
} ReductionDef;

// Reduces the block as it is or, where it is its own mirror image, as two or four parts
// (reduction/mirror), each for itself. What is taken out of the border afterwards makes no error
// larger: it is below the largest of the parts'. interface_dofs: [m] unknowns of `bulk`.
bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t m,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err);

#endif
