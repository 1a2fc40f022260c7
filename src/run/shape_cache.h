// SPDX-License-Identifier: GPL-2.0-or-later
// The reduced bulk and the interface of a shape, kept on disk: the second run of a shape needs
// neither gmsh nor a factorisation. A shape is what the reduction depends on (mesh file and its
// parameters, groups, rod strip, Poisson's ratio, eta2/eta1, the pattern of the loads, how waves
// compare with viscosity to half a decade, tolerance, version); pressure, velocities, friction law
// and units of stress are not in it. Called by run/model.
//
//     CACHE/<key>.shape     interface, sizes, reduced M, C, K and load
//     CACHE/<key>.modes     u = modes [u_b; q], read only where fields of the bulk are asked for
//
// CACHE is $AMONTONS_CACHE, else $XDG_CACHE_HOME/amontons, else ~/.cache/amontons; empty: none.
#ifndef AMONTONS_RUN_SHAPE_CACHE_H
#define AMONTONS_RUN_SHAPE_CACHE_H

#include "base/hash.h"
#include "bulk/reduction.h"
#include "contact/interface.h"
#include "run/scene.h"

enum { SHAPE_NOTE_SIZE = 256 };

// Sizes that a run needs beside the arrays.
typedef struct ShapeSizes {
    double length, height;   // L, H, length
    double area;   // length^2
    double elements;   // of the mesh
    double load_size;   // largest nodal load per unit of load_reference()
    double load_resultant;   // F_N per unit of load_reference()
} ShapeSizes;

typedef struct Shape {
    ShapeSizes sizes;
    Interface interface;
    ReducedBulk reduced;
    double *rotation;   // [interface.count] of the unit rotation about the origin
} Shape;

// The stress the loads are measured with: the pressure, else the largest traction.
double load_reference(const Scene *scene);

// The key of the scene's shape; empty where it cannot be told without meshing (a .geo that includes
// others) or the scene wants no cache.
bool shape_key(const Scene *scene, double tolerance, char key[HASH_TEXT_SIZE], Error *err);

// Fills `shape`, arrays owned by it. *found: false when there is nothing, or nothing to be trusted:
// `note` then says why. with_modes: the modes must be there too.
bool shape_cache_load(const char *key, bool with_modes, Shape *shape, bool *found,
                      char note[SHAPE_NOTE_SIZE], Error *err);

// Never an error: what could not be stored is told in `note`.
void shape_cache_store(const char *key, const Shape *shape, char note[SHAPE_NOTE_SIZE]);

void shape_destroy(Shape *shape);

#endif
