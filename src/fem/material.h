// SPDX-License-Identifier: GPL-2.0-or-later
// The linear viscoelastic bulk of the paper (Kelvin-Voigt):
//
//     sigma = E/(1+nu) eps + lambda tr(eps) I  +  eta1 eps' + eta2 tr(eps') I
//     lambda = E nu/(1-nu^2) in plane stress,  E nu/((1+nu)(1-2nu)) in plane strain and in space.
//
// Used by fem/element and fem/recovery; its wave speeds by model/ and run/. Beside these terms it
// may have branches of a generalised Maxwell solid (fem/spectrum).
#ifndef AMONTONS_FEM_MATERIAL_H
#define AMONTONS_FEM_MATERIAL_H

#include "io/mesh/mesh_file.h"

#include <stdbool.h>
#include <stdint.h>

enum { BRANCHES_MAX = 20 };

// A spring behind a dashpot, beside all else: stress 2 G e_dev + K tr(e) I, e' = eps' - e/tau.
typedef struct Branch {
    double time;   // tau, time
    double shear, bulk;   // G and K of its spring, in space, stress
} Branch;

typedef struct Material {
    double young;   // E, stress; of the long-time response
    double poisson;   // nu, 1, of the same; in (-1, 1) in plane stress, (-1, 1/2) in plane strain
    double density;   // rho, mass per volume
    double eta1, eta2;   // viscosities, stress * time
    bool plane_strain;   // in space always true: nothing is free of stress across
    int32_t branch_count;
    Branch branch[BRANCHES_MAX];   // [branch_count]; then nu is below 1/2
} Material;

// G and K in space of the long-time response.
double material_shear(const Material *material);
double material_bulk(const Material *material);

// The material as it is at rates that no branch follows: its E and nu are those of the short-time
// response, and it has no branches.
Material material_at_once(const Material *material);

// stress = deviator * strain + trace * tr(strain) I, stress; of the viscous part, * time.
typedef struct Moduli {
    double deviator, trace;
} Moduli;
Moduli material_elastic(const Material *material);
Moduli material_viscous(const Material *material);

// Moduli against a strain along one axis alone, against shear, and against the same strain along
// all axes.
static inline double moduli_axial(Moduli moduli)
{
    return moduli.deviator + moduli.trace;
}
static inline double moduli_shear(Moduli moduli)
{
    return 0.5 * moduli.deviator;
}
static inline double moduli_bulk(Moduli moduli, int32_t dim)
{
    return (moduli_axial(moduli) + (dim - 1) * moduli.trace) / dim;
}

enum { STRAINS_MAX = DIM_MAX * (DIM_MAX + 1) / 2 };
static inline int32_t strain_count(int32_t dim)
{
    return dim * (dim + 1) / 2;
}

// The pairs of axes in the order of shears: in the plane the first, xz.
static const int32_t SHEAR_AXES[3][2] = {{0, 1}, {1, 2}, {0, 2}};

// stress = D strain, of an entry for each axis, then one for each pair of axes: xx, zz, 2 xz in the
// plane, xx, yy, zz, 2 xy, 2 yz, 2 xz in space (VTK's order); stresses without the 2. Symmetric;
// entries beyond are 0.
void moduli_matrix(Moduli moduli, int32_t dim, double d[STRAINS_MAX][STRAINS_MAX]);

// sigma_yy of a strain in the plane, with its viscous part, for the stress of von Mises: 0 in plane
// stress.
double material_out_of_plane(const Material *material, const double strain[3],
                             const double strain_rate[3]);

typedef struct WaveSpeeds {
    double longitudinal, shear, rayleigh;   // velocity, elastic limit
} WaveSpeeds;
// Wave speeds of the short-time response. Rayleigh's equation is solved to rounding (Achenbach,
// Wave Propagation in Elastic Solids, 5.11).
WaveSpeeds material_speeds(const Material *material);

// Damping over critical damping of the least damped wave of `length` (half a wave long): above 1 no
// wave of this length or shorter runs, as damping grows with the wave number. Branches stiffen it
// as they do at once, and damp nothing.
double material_wave_damping(const Material *material, double length);

// The norm of the displacement gradient under a pressure across it and a shear stress along it:
// (tau/G, p/E'), E' that of uniaxial stress in the plane.
double material_gradient(const Material *material, double pressure, double shear);

// Speed that sets the time scales of slip: c_L, but at most 2 c_S. (c_L grows without bound towards
// nu = 1/2 in plane strain, while slip does not get faster.)
double material_slip_speed(const Material *material);

// Linear elements would lock in it: area resists so much more than shape, in K or in C, that it is
// to be a mean (fem/element_group).
bool material_resists_area(const Material *material);

// Dundurs' numbers of a block on a base (J. Appl. Mech. 36, 1969): alpha > 0 where the block is
// stiffer; beta, 0 for like bodies, is by how much slip changes the pressure.
typedef struct Dundurs {
    double alpha, beta;
} Dundurs;
Dundurs materials_dundurs(const Material *block, const Material *base);

enum { MATERIALS_MAX = 17 };

// The materials of a block: one, or one in each region of its mesh (Mesh.region).
typedef struct Materials {
    int32_t count;
    Material list[MATERIALS_MAX];   // [count] by number of the region
    double area[MATERIALS_MAX];   // [count] of the region, length^2; 0: of no element; of one
        // material it need not be known
    double base_area[MATERIALS_MAX];   // [count] of the part of it that is of a base, length^2
    double width[MATERIALS_MAX];   // [count] of the region on the mean, area over extent along z,
        // length; 0 likewise
    Material mean;   // what scales are measured with; the material itself, where there is one
} Materials;

Materials materials_of(const Material *material);   // a block of one
// Sets the mean of the block, without its base: by area of density, Poisson's ratio and
// viscosities; of E that of regions one above the other, 1/E = mean of 1/E. Of several regions'
// branches it has a single one, which makes its short-time E such a mean, too.
void materials_find_mean(Materials *materials);

// Region k has elements, or there is only one material.
static inline bool materials_use(const Materials *materials, int32_t k)
{
    return materials->count == 1 || materials->area[k] > 0;
}

// The longest relaxation time of a branch; 0: there are none.
double materials_relaxation_time(const Materials *materials);

// Over the regions that there are: the fastest material_slip_speed, and the longest viscous time
// (eta1 + eta2)/E.
double materials_slip_speed(const Materials *materials);
double materials_viscous_time(const Materials *materials);

// Viscous over elastic modulus of a material: of the plane's volume, and of shear.
typedef struct ViscousTimes {
    double volume, shear;
} ViscousTimes;
// The shortest and the longest of these times in all regions together; of one material its own, in
// that order.
ViscousTimes materials_viscous_range(const Materials *materials);

#endif
