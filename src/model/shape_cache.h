// SPDX-License-Identifier: GPL-2.0-or-later
// The interface and sizes of a shape as a scene describes it (mesh file and its parameters, groups,
// rod strip, Poisson's ratio, eta2/eta1, the pattern of the loads, reduction), kept on disk
// together with the name of its basis (model/basis_cache): the second run needs neither gmsh nor a
// factorisation. Pressure, velocities, density, friction law and units of stress are not in the
// key. Called by model/obtain.
//
//     CACHE/<key>.shape     (io/cache/cache_folder says where CACHE is)
#ifndef AMONTONS_MODEL_SHAPE_CACHE_H
#define AMONTONS_MODEL_SHAPE_CACHE_H

#include "base/hash.h"
#include "fem/material.h"
#include "contact/interface.h"
#include "io/cache/store.h"
#include "model/model.h"
#include "scene/scene.h"

// Sizes that a run needs beside the arrays.
typedef struct ShapeSizes {
    double length, height, breadth;   // L, H, and along y (1 in the plane), length
    double area;   // length^2; in space the volume
    double elements;   // of the mesh
    double full_dofs;   // unknowns of the mesh
    double load_size;   // largest nodal load per unit of load_reference()
    double load_resultant;   // of the loads towards the plane, per unit of load_reference()
    double rod_reach;   // greatest x of a rod node from the trailing end, over L; 0: no rod
    double middle;   // x of the block's middle, length
    RodEnd rod_end[2];
    double contact_region;   // number of its material
    double region_area[MATERIALS_MAX];   // of one material 0, length^2
    double region_width[MATERIALS_MAX];   // likewise, length
} ShapeSizes;

typedef struct Shape {
    ShapeSizes sizes;
    Interface interface;
    char basis[HASH_TEXT_SIZE];   // its name; empty: none
} Shape;

// The stress the loads are measured with: the pressure, else the largest traction.
double load_reference(const Scene *scene);

// The key of the scene's shape; empty where it cannot be told without meshing (a .geo that includes
// others) or the scene wants no cache.
bool shape_key(const Scene *scene, double tolerance, char key[HASH_TEXT_SIZE], Error *err);

// Fills `shape`, arrays owned by it. *found: false when there is nothing, or nothing that is valid:
// `note` then says why.
bool shape_cache_load(const char *key, Shape *shape, bool *found, char note[CACHE_NOTE_SIZE],
                      Error *err);

// Never an error: what could not be stored is told in `note`.
void shape_cache_store(const char *key, const Shape *shape, char note[CACHE_NOTE_SIZE]);

void shape_destroy(Shape *shape);

#endif
