// SPDX-License-Identifier: GPL-2.0-or-later
// Kelvin-Voigt: sigma = D eps + D_eta eps', both isotropic. In the plane vectors are (xx, zz, 2 xz)
// for strains and (xx, zz, xz) for stresses, so that
//
//         [ d + t    t     0  ]
//     D = [   t    d + t   0  ]    d: deviator, E/(1+nu) or eta1;  t: trace, lambda or eta2
//         [   0      0    d/2 ]
#include "fem/material.h"

#include <math.h>
#include <string.h>

// E nu / ((1+nu)(1-2nu)); with sigma_yy = 0, in plane stress, E nu / (1 - nu^2).
static double lame_lambda(const Material *material)
{
    double nu = material->poisson, young = material->young;
    if (material->plane_strain) return young * nu / ((1 + nu) * (1 - 2 * nu));
    return young * nu / (1 - nu * nu);
}

void moduli_matrix(Moduli moduli, int32_t dim, double d[STRAINS_MAX][STRAINS_MAX])
{
    memset(d, 0, STRAINS_MAX * sizeof *d);
    for (int32_t i = 0; i < dim; i++)
        for (int32_t k = 0; k < dim; k++) d[i][k] = i == k ? moduli_axial(moduli) : moduli.trace;
    for (int32_t i = dim; i < strain_count(dim); i++) d[i][i] = moduli_shear(moduli);
}

Moduli material_elastic(const Material *material)
{
    return (Moduli){material->young / (1 + material->poisson), lame_lambda(material)};
}

Moduli material_viscous(const Material *material)
{
    return (Moduli){material->eta1, material->eta2};
}

double material_shear(const Material *material)
{
    return material->young / (2 * (1 + material->poisson));
}

double material_bulk(const Material *material)
{
    return material->young / (3 * (1 - 2 * material->poisson));
}

Material material_at_once(const Material *material)
{
    Material made = *material;
    double shear = material_shear(material), bulk = material_bulk(material);
    if (material->branch_count == 0) return made;
    for (int32_t k = 0; k < material->branch_count; k++) {
        shear += material->branch[k].shear;
        bulk += material->branch[k].bulk;
    }
    made.young = 9 * bulk * shear / (3 * bulk + shear);
    made.poisson = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear));
    made.branch_count = 0;
    return made;
}

// The stress that keeps the faces in place in plane strain.
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
    Material fast = material_at_once(material);
    Moduli elastic = material_elastic(&fast);
    double axial = moduli_axial(elastic), shear = moduli_shear(elastic);
    speeds.longitudinal = sqrt(axial / material->density);
    speeds.shear = sqrt(shear / material->density);
    double k = shear / axial, low = 0.05, high = 1.0;
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

// A plane wave in a Kelvin-Voigt solid, rho u'' = M k^2 u + N k^2 u': N k / (2 sqrt(rho M)).
double material_wave_damping(const Material *material, double length)
{
    const double pi = 3.14159265358979323846;
    Material fast = material_at_once(material);
    Moduli elastic = material_elastic(&fast), viscous = material_viscous(material);
    double axial = moduli_axial(viscous) / sqrt(moduli_axial(elastic) * material->density);
    double shear = moduli_shear(viscous) / sqrt(moduli_shear(elastic) * material->density);
    return fmin(axial, shear) * pi / (2 * length);
}

double material_gradient(const Material *material, double pressure, double shear)
{
    Moduli elastic = material_elastic(material);
    double axial = moduli_axial(elastic), uniaxial = axial - elastic.trace * elastic.trace / axial;
    return hypot(shear / moduli_shear(elastic), pressure / uniaxial);
}

double material_slip_speed(const Material *material)
{
    WaveSpeeds speeds = material_speeds(material);
    return fmin(speeds.longitudinal, 2 * speeds.shear);
}

// Kolosov's constant of the plane's two moduli, (lambda + 3 mu)/(lambda + mu).
static double kolosov(Moduli moduli)
{
    return (moduli.trace + 3 * moduli_shear(moduli)) / (moduli.trace + moduli_shear(moduli));
}

Dundurs materials_dundurs(const Material *block, const Material *base)
{
    Moduli upper = material_elastic(block), lower = material_elastic(base);
    double m1 = moduli_shear(upper), m2 = moduli_shear(lower);
    double k1 = kolosov(upper), k2 = kolosov(lower), sum = m1 * (k2 + 1) + m2 * (k1 + 1);
    return (Dundurs){.alpha = (m1 * (k2 + 1) - m2 * (k1 + 1)) / sum,
                     .beta = (m1 * (k2 - 1) - m2 * (k1 - 1)) / sum};
}

// Trace over deviator, lambda (1 + nu)/E or eta2/eta1.
static const double AREA_RESISTS = 4;

static bool elastic_resists_area(const Material *material)
{
    double deviator = material->young / (1 + material->poisson);
    return lame_lambda(material) > AREA_RESISTS * deviator;
}

bool material_resists_area(const Material *material)
{
    Material fast = material_at_once(material);
    return elastic_resists_area(material) || elastic_resists_area(&fast) ||
           material->eta2 > AREA_RESISTS * material->eta1;
}

// --- several ------------------------------------------------------------------------------------

Materials materials_of(const Material *material)
{
    return (Materials){.count = 1, .list = {*material}, .mean = *material};
}

void materials_find_mean(Materials *materials)
{
    Material sum = {.plane_strain = materials->list[0].plane_strain};
    double area = 0, compliance = 0, at_once = 0;
    materials->mean = materials->list[0];
    if (materials->count == 1) return;
    for (int32_t k = 0; k < materials->count; k++) {
        const Material *one = &materials->list[k];
        double part = materials->area[k] - materials->base_area[k];
        area += part;
        compliance += part / one->young;
        at_once += part / material_at_once(one).young;
        sum.poisson += part * one->poisson;
        sum.density += part * one->density;
        sum.eta1 += part * one->eta1;
        sum.eta2 += part * one->eta2;
    }
    sum.young = area / compliance;
    sum.poisson /= area;
    sum.density /= area;
    sum.eta1 /= area;
    sum.eta2 /= area;
    double slowest = materials_relaxation_time(materials), stiffer = area / at_once - sum.young;
    if (slowest > 0) {
        sum.branch_count = 1;
        sum.branch[0] = (Branch){.time = slowest,
                                 .shear = stiffer / (2 * (1 + sum.poisson)),
                                 .bulk = stiffer / (3 * (1 - 2 * sum.poisson))};
    }
    materials->mean = sum;
}

double materials_relaxation_time(const Materials *materials)
{
    double longest = 0;
    for (int32_t k = 0; k < materials->count; k++)
        for (int32_t i = 0; materials_use(materials, k) && i < materials->list[k].branch_count; i++)
            longest = fmax(longest, materials->list[k].branch[i].time);
    return longest;
}

double materials_slip_speed(const Materials *materials)
{
    double fastest = 0;
    for (int32_t k = 0; k < materials->count; k++)
        if (materials_use(materials, k))
            fastest = fmax(fastest, material_slip_speed(&materials->list[k]));
    return fastest;
}

double materials_viscous_time(const Materials *materials)
{
    double longest = 0;
    for (int32_t k = 0; k < materials->count; k++) {
        const Material *one = &materials->list[k];
        if (materials_use(materials, k))
            longest = fmax(longest, (one->eta1 + one->eta2) / one->young);
    }
    return longest;
}

static ViscousTimes viscous_times(const Material *material)
{
    Moduli elastic = material_elastic(material), viscous = material_viscous(material);
    return (ViscousTimes){.volume = (moduli_axial(viscous) + viscous.trace) /
                                    (moduli_axial(elastic) + elastic.trace),
                          .shear = moduli_shear(viscous) / moduli_shear(elastic)};
}

ViscousTimes materials_viscous_range(const Materials *materials)
{
    ViscousTimes range = viscous_times(&materials->list[0]);
    bool first = true;
    if (materials->count == 1) return range;
    for (int32_t k = 0; k < materials->count; k++) {
        if (!materials_use(materials, k)) continue;
        ViscousTimes own = viscous_times(&materials->list[k]);
        double low = fmin(own.volume, own.shear), high = fmax(own.volume, own.shear);
        range.volume = first ? low : fmin(range.volume, low);
        range.shear = first ? high : fmax(range.shear, high);
        first = false;
    }
    return range;
}
