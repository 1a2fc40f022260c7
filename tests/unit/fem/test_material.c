// SPDX-License-Identifier: GPL-2.0-or-later
// Elastic and viscous moduli against closed forms, speeds against published ones.
#include "fem/material.h"

#include "near.h"
#include "paper_material.h"

static const double RATIOS[] = {-0.5, 0, 0.1, 0.25, 0.34, 0.4, 0.49};
enum { RATIO_COUNT = sizeof RATIOS / sizeof *RATIOS };

// Stresses of one stress state must give back the strains of Hooke's law in three dimensions:
// E eps_xx = s_xx - nu (s_zz + s_yy), s_yy = 0 in plane stress, nu (s_xx + s_zz) in plane strain.
TEST(test_hooke)
{
    for (int32_t k = 0; k < 2 * RATIO_COUNT; k++) {
        double nu = RATIOS[k / 2], young = 7;
        Material material = {.young = young, .poisson = nu, .density = 1, .plane_strain = k % 2};
        double d[STRAINS_MAX][STRAINS_MAX], strain[3] = {0.3, -1.1, 0.7}, rate[3] = {0},
                                            stress[3] = {0};
        moduli_matrix(material_elastic(&material), 2, d);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) stress[r] += d[r][c] * strain[c];
        double yy = material_out_of_plane(&material, strain, rate);
        assert_near("s_yy", yy, k % 2 ? nu * (stress[0] + stress[1]) : 0, 1e-12 * young / 0.02);
        assert_near("xx", stress[0] - nu * (stress[1] + yy), young * strain[0], 1e-11);
        assert_near("zz", stress[1] - nu * (stress[0] + yy), young * strain[1], 1e-11);
        assert_near("xz", stress[2] * 2 * (1 + nu), young * strain[2], 1e-12);
    }
}

// Plane strain is plane stress of E/(1 - nu^2), nu/(1 - nu).
TEST(test_plane_strain_is_plane_stress)
{
    for (int32_t k = 0; k < RATIO_COUNT; k++) {
        double nu = RATIOS[k];
        Material wide = {.young = 3, .poisson = nu, .density = 2, .plane_strain = true};
        Material plate = {.young = 3 / (1 - nu * nu), .poisson = nu / (1 - nu), .density = 2};
        Moduli strain = material_elastic(&wide), stress = material_elastic(&plate);
        assert_near("axial", moduli_axial(strain), moduli_axial(stress), 1e-13);
        assert_near("trace", strain.trace, stress.trace, 1e-13);
        assert_near("shear", moduli_shear(strain), moduli_shear(stress), 1e-13);
        assert_near("c_R", material_speeds(&wide).rayleigh, material_speeds(&plate).rayleigh,
                    1e-12);
    }
}

// sigma = eta1 eps' + eta2 tr(eps') I: in shear eta1/2 on the engineering strain.
TEST(test_viscous)
{
    Material material = {.young = 1, .poisson = 0.3, .density = 1, .eta1 = 2, .eta2 = 5};
    const double wanted[3][3] = {{7, 5, 0}, {5, 7, 0}, {0, 0, 1}};
    double d[STRAINS_MAX][STRAINS_MAX], none[3] = {0}, rate[3] = {0.5, -0.2, 9};
    moduli_matrix(material_viscous(&material), 2, d);
    for (int r = 0; r < 3; r++) assert_all_near("D", d[r], wanted[r], 3, 0);
    assert_near("plate", material_out_of_plane(&material, none, rate), 0, 0);
    material.plane_strain = true;
    assert_near("wide", material_out_of_plane(&material, none, rate), 5 * 0.3, 1e-15);
}

TEST(test_speeds)
{
    for (int32_t k = 0; k < RATIO_COUNT; k++) {
        double nu = RATIOS[k], young = 5, density = 3;
        Material material = {.young = young, .poisson = nu, .density = density};
        WaveSpeeds speeds = material_speeds(&material);
        assert_near("c_S", speeds.shear, sqrt(young / (2 * (1 + nu) * density)), 1e-14);
        assert_near("c_L", speeds.longitudinal, sqrt(young / ((1 - nu * nu) * density)), 1e-14);
        material.plane_strain = true;
        speeds = material_speeds(&material);
        double modulus = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
        assert_near("c_L wide", speeds.longitudinal, sqrt(modulus / density), 1e-12);
    }
}

// Rayleigh: textbook ratios to c_S in plane strain; in plane stress the paper's two materials.
TEST(test_rayleigh)
{
    const struct {
        double nu, ratio;
    } wide[] = {{0, 0.8740}, {0.25, 0.9194}, {0.4999999, 0.9553}};
    for (int32_t k = 0; k < 3; k++) {
        Material material = {.young = 1, .poisson = wide[k].nu, .density = 1, .plane_strain = true};
        WaveSpeeds speeds = material_speeds(&material);
        assert_near("c_R / c_S", speeds.rayleigh / speeds.shear, wide[k].ratio, 5e-5);
    }
    const double paper[][4] = {{0.34, 1.06335, 0.61085, 0.56199}, {0.4, 1.09109, 0.59761, 0.55289}};
    for (int32_t k = 0; k < 2; k++) {
        Material material = paper_material();
        material.poisson = paper[k][0];
        WaveSpeeds speeds = material_speeds(&material);
        assert_near("c_L", speeds.longitudinal, paper[k][1], 5e-6);
        assert_near("c_S", speeds.shear, paper[k][2], 5e-6);
        assert_near("c_R", speeds.rayleigh, paper[k][3], 5e-6);
    }
}

// A wave exp(s t + i k x) has rho s^2 + N k^2 s + M k^2 = 0: at a damping of 1 the discriminant of
// the less damped of the two kinds is 0, and the other's is above it.
TEST(test_wave_damping)
{
    Material material = {
        .young = 3e9, .poisson = 0.4, .density = 1190, .eta1 = 0.2e6, .eta2 = 0.7e6};
    double pi = acos(-1), long_wave = material_wave_damping(&material, 2);
    assert_near("length", material_wave_damping(&material, 1), 2 * long_wave, 1e-12 * long_wave);
    double k = pi / (2 * long_wave), least = INFINITY;   // of the length at which it is 1
    const Moduli elastic = material_elastic(&material), viscous = material_viscous(&material);
    const double m[] = {moduli_axial(elastic), moduli_shear(elastic)};
    const double n[] = {moduli_axial(viscous), moduli_shear(viscous)};
    for (int i = 0; i < 2; i++) {
        double square = pow(n[i] * k * k, 2), discriminant = square - 4 * 1190 * m[i] * k * k;
        assert_true(discriminant > -1e-9 * square);
        least = fmin(least, fabs(discriminant) / square);
    }
    assert_near("critical", least, 0, 1e-12);
}

// c_L while that is below 2 c_S: in plane stress for every nu (c_L^2/c_S^2 = 2/(1 - nu)), in plane
// strain up to nu = 1/3 (2 (1 - nu)/(1 - 2 nu)).
TEST(test_slip_speed)
{
    for (int strain = 0; strain < 2; strain++) {
        for (double nu = -0.5; nu < 0.5; nu += 0.04) {
            Material material = paper_material();
            material.poisson = nu;
            material.plane_strain = strain;
            double shear = sqrt(0.5 / (1 + nu));
            double square = strain ? 2 * (1 - nu) / (1 - 2 * nu) : 2 / (1 - nu);
            assert_near("speed", material_slip_speed(&material), shear * sqrt(fmin(square, 4)),
                        1e-12);
        }
    }
}

TEST(test_default_is_the_paper)
{
    Material material = paper_material();
    assert_true(material.young == 1 && material.density == 1 && material.poisson == 0.34);
    assert_true(material.eta1 == 1 && material.eta2 == 1 && !material.plane_strain);
}
