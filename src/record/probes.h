// SPDX-License-Identifier: GPL-2.0-or-later
// Points inside the bodies at which a run reads displacement, velocity, strain and stress, as a
// strain gauge or a laser does. Each value is a linear reading of the unknowns that are stepped:
// its coefficients are found once, also those of a reduced bulk, so that a step costs a few
// products. Strains are those of fem/recovery, means at the nodes, interpolated in the element by
// its shape functions, so that they are what the fields of ParaView show at the point. Called by
// run/output and record/history.
#ifndef AMONTONS_RECORD_PROBES_H
#define AMONTONS_RECORD_PROBES_H

#include "fem/material.h"
#include "record/observation.h"

// Place of a probe in the mesh.
typedef struct ProbePlace {
    int32_t element;
    MeshPlace at;   // reference coordinates in it, 1
} ProbePlace;

typedef struct Probe {
    int32_t region;   // number of its material
    int32_t column_count;   // unknowns that it depends on
    int32_t *column;   // [column_count] which; owned
    double *row;   // [column_count][dim + strains] coefficients of displacement, 1, and of strain,
        // 1/length; owned
} Probe;

typedef struct Probes {
    int32_t count;   // 0: there are none
    int32_t dim, strains;   // components of a displacement and of a strain
    Probe *list;   // [count] owned
    const Material *materials;   // not owned, like the next
    const Spectrum *spectrum;
    // Values of the step read last, owned. Components of strain and stress: xx, zz, xz; in space
    // xx, yy, zz, xy, yz, xz. Shears are those of the tensor, half the engineering ones.
    double *displacement, *velocity;   // [count * dim] length, velocity
    double *strain;   // [count * strains] 1
    double *stress;   // [count * strains] elastic, viscous and of the branches, stress
} Probes;

// places: [count]. materials, spectrum: of the bulk; must outlive the probes, as must nothing else.
// The modes of a reduced bulk must be at hand.
bool probes_create(const ProbePlace *places, int32_t count, const Mesh *mesh,
                   const BulkOperator *system, const Material *materials, const Spectrum *spectrum,
                   Probes *probes, Error *err);
void probes_destroy(Probes *probes);
void probes_read(Probes *probes, const State *state);   // fills the values

#endif
