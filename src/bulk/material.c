// SPDX-License-Identifier: GPL-2.0-or-later
// Kelvin-Voigt: sigma = D eps + D_eta eps', both isotropic. Vectors are (xx, zz, 2 xz) for strains
// and (xx, zz, xz) for stresses, so that
//
//         [ d + t    t     0  ]
//     D = [   t    d + t   0  ]    d: deviator, E/(1+nu) or eta1;  t: trace, lambda or eta2
//         [   0      0    d/2 ]
#include "bulk/material.h"

#include <math.h>
#include <string.h>

// E nu / ((1+nu)(1-2nu)); with sigma_yy = 0, in plane stress, E nu / (1 - nu^2).
static double lame_lambda(const Material *material)
{
    double nu = material->poisson, young = material->young;
    if (material->plane_strain) return young * nu / ((1 + nu) * (1 - 2 * nu));
    return young * nu / (1 - nu * nu);
}

// sigma = deviator * eps + trace * tr(eps) I; the third strain is the engineering shear 2 eps_xz.
static void fill_isotropic(double deviator, double trace, double d[3][3])
{
    memset(d, 0, 9 * sizeof(double));
    d[0][0] = d[1][1] = deviator + trace;
    d[0][1] = d[1][0] = trace;
    d[2][2] = 0.5 * deviator;
}

void material_elastic(const Material *material, double d[3][3])
{
    fill_isotropic(material->young / (1 + material->poisson), lame_lambda(material), d);
}

void material_viscous(const Material *material, double d[3][3])
{
    fill_isotropic(material->eta1, material->eta2, d);
}

// In plane strain the stress that keeps the faces in place.
double material_out_of_plane(const Material *material, const double strain[3],
                             const double strain_rate[3])
{
    if (!material->plane_strain) return 0.0;
    return lame_lambda(material) * (strain[0] + strain[1]) +
           material->eta2 * (strain_rate[0] + strain_rate[1]);
}

// (2 - s)^2 - 4 sqrt(1 - s) sqrt(1 - s k), s = (c_R / c_S)^2, k = (c_S / c_L)^2: negative below the
// root, positive at s = 1.
static double rayleigh_function(double s, double k)
{
    return (2 - s) * (2 - s) - 4 * sqrt(1 - s) * sqrt(1 - s * k);
}

// c_L = sqrt(D_xx / rho), c_S = sqrt(G / rho), of the plane problem at hand: in plane stress c_L is
// that of a plate. c_R by bisection of the Rayleigh function to the last bit.
WaveSpeeds material_speeds(const Material *material)
{
    WaveSpeeds speeds;
    double d[3][3];
    material_elastic(material, d);
    speeds.longitudinal = sqrt(d[0][0] / material->density);
    speeds.shear = sqrt(d[2][2] / material->density);
    double k = d[2][2] / d[0][0], low = 0.05, high = 1.0;
    for (int bisection = 0; bisection < 60; bisection++) {
        double middle = 0.5 * (low + high);
        if (rayleigh_function(middle, k) < 0)
            low = middle;
        else
            high = middle;
    }
    speeds.rayleigh = speeds.shear * sqrt(0.5 * (low + high));
    return speeds;
}

double material_slip_speed(const Material *material)
{
    WaveSpeeds speeds = material_speeds(material);
    return fmin(speeds.longitudinal, 2 * speeds.shear);
}
