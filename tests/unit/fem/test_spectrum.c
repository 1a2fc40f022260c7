// SPDX-License-Identifier: GPL-2.0-or-later
// Stiffness of branches at a real rate, against the moduli of an elastic solid with G(s) and K(s)
// (correspondence principle), in space, in plane strain and in plane stress.
#include "fem/spectrum.h"

#include <math.h>

#include "near.h"

static const Branch PRONY[] = {{.time = 0.003, .shear = 0.8, .bulk = 2},
                               {.time = 0.1, .shear = 0.3},
                               {.time = 4, .bulk = 0.7},
                               {.time = 50, .shear = 2, .bulk = 0.01}};
enum { PRONY_COUNT = sizeof PRONY / sizeof *PRONY };

static Material relaxing(bool plane_strain)
{
    Material material = {.young = 1, .poisson = 0.3, .density = 1, .plane_strain = plane_strain};
    material.branch_count = PRONY_COUNT;
    memcpy(material.branch, PRONY, sizeof PRONY);
    return material;
}

// An elastic material with the moduli that the branches and their spring have at the rate s.
static Material at_rate(const Material *material, double s)
{
    double shear = material->young / (2 * (1 + material->poisson));
    double bulk = material->young / (3 * (1 - 2 * material->poisson));
    for (int32_t k = 0; k < material->branch_count; k++) {
        double part = s * material->branch[k].time / (1 + s * material->branch[k].time);
        shear += part * material->branch[k].shear;
        bulk += part * material->branch[k].bulk;
    }
    return (Material){.young = 9 * bulk * shear / (3 * bulk + shear),
                      .poisson = (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear),
                      .density = 1,
                      .plane_strain = material->plane_strain};
}

// The stiffness of all that there is at the rate s, from the shape matrices' moduli.
static Moduli stiffness_at(const Material *material, const Spectrum *spectrum, double s)
{
    double weight[SPECTRUM_SHAPES_MAX];
    Moduli sum = material_elastic(material);
    double whole = spectrum_weights(spectrum, s, 1, weight);   // c/k = s, k = 1
    sum.deviator *= 1 + whole;
    sum.trace *= 1 + whole;
    for (int32_t j = 0; j < spectrum->matrix_count; j++) {
        sum.deviator += weight[j] * spectrum->shape[j].moduli.deviator;
        sum.trace += weight[j] * spectrum->shape[j].moduli.trace;
    }
    return sum;
}

static void check_rates(const Material *material, int32_t dim, Spectrum *spectrum)
{
    Error err = {0};
    Materials materials = materials_of(material);
    assert_true(spectrum_find(&materials, dim, spectrum, &err));
    for (double s = 1e-5; s < 1e6; s *= 3) {
        Material elastic = at_rate(material, s);
        Moduli wanted = material_elastic(&elastic), got = stiffness_at(material, spectrum, s);
        assert_near("deviator", got.deviator, wanted.deviator, 1e-12 * wanted.deviator);
        assert_near("trace", got.trace, wanted.trace, 1e-12 * wanted.deviator);
    }
    for (int32_t k = 0; k < spectrum->count; k++) {   // no branch feeds
        Moduli own = {0};
        for (int32_t j = 0; j < spectrum->shape_count; j++) {
            own.deviator += spectrum->share[k][j] * spectrum->shape[j].moduli.deviator;
            own.trace += spectrum->share[k][j] * spectrum->shape[j].moduli.trace;
        }
        assert_true(own.deviator >= -1e-15 && moduli_bulk(own, dim) >= -1e-15);
    }
}

TEST(test_space)
{
    Spectrum spectrum;
    Material material = relaxing(true);
    check_rates(&material, 3, &spectrum);
    assert_int_equal(spectrum.count, PRONY_COUNT);
    assert_int_equal(spectrum.shape_count, 2);
}

TEST(test_plane_strain)
{
    Spectrum spectrum;
    Material material = relaxing(true);
    check_rates(&material, 2, &spectrum);
    assert_int_equal(spectrum.count, PRONY_COUNT);
}

// The plate's areal modulus has further times: where shear alone or volume alone relaxes.
TEST(test_plane_stress)
{
    Spectrum spectrum;
    Material material = relaxing(false);
    check_rates(&material, 2, &spectrum);
    assert_true(spectrum.count > PRONY_COUNT);
}

// Branches that resist shear alone, and branches like the whole, have one shape matrix.
TEST(test_one_shape)
{
    Spectrum spectrum;
    Material material = relaxing(true);
    for (int32_t k = 0; k < material.branch_count; k++)
        material.branch[k] = (Branch){.time = 1 + k, .shear = 0.2};
    check_rates(&material, 2, &spectrum);
    assert_int_equal(spectrum.shape_count, 1);
    for (int32_t plane_strain = 0; plane_strain < 2; plane_strain++) {
        material.plane_strain = plane_strain;
        for (int32_t k = 0; k < material.branch_count; k++) {
            material.branch[k].shear = (0.2 + k) * material_shear(&material);
            material.branch[k].bulk = (0.2 + k) * material_bulk(&material);
        }
        check_rates(&material, 2, &spectrum);
        assert_int_equal(spectrum.shape_count, 1);
        assert_int_equal(spectrum.count, material.branch_count);
    }
}

// A single branch in plane stress by hand: the areal modulus relaxes later than shear does.
TEST(test_plate_by_hand)
{
    Error err = {0};
    Spectrum spectrum;
    Material material = {.young = 3, .poisson = 0, .density = 1, .branch_count = 1};   // G 3/2, K 1
    material.branch[0] = (Branch){.time = 2, .shear = 1.5};
    Materials materials = materials_of(&material);
    assert_true(spectrum_find(&materials, 2, &spectrum, &err));
    // H = 3 + 4 (3/2 + 3/2 x/(1 + x)) = 0, x = 2 s: 9 + 15 x = 0, s = -3/10.
    assert_int_equal(spectrum.count, 2);
    assert_near("time", spectrum.time[1], 10. / 3, 1e-14);
    // k from 9 1.5/9 = 1.5 to 9 3/15 = 1.8.
    assert_near("areal", spectrum.share[1][1] * moduli_bulk(spectrum.shape[1].moduli, 2), 0.3,
                1e-14);
    assert_near("shear", spectrum.share[0][0], 1.5, 1e-15);
}

TEST(test_regions)
{
    Error err = {0};
    Spectrum spectrum;
    Materials materials = {.count = 3, .area = {1, 0, 2}};
    for (int32_t k = 0; k < 3; k++) materials.list[k] = relaxing(true);
    materials.list[2].branch_count = 1;
    assert_true(spectrum_find(&materials, 3, &spectrum, &err));
    assert_int_equal(spectrum.count, PRONY_COUNT);   // the same times serve both
    assert_int_equal(spectrum.shape_count, 3);
    assert_int_equal(spectrum.shape[2].region, 2);
    assert_near("of the other region", spectrum.share[1][2], 0, 0);
    for (int32_t k = 0; k < 3; k++)
        for (int32_t i = 0; i < BRANCHES_MAX; i++)
            materials.list[k].branch[i] = (Branch){.time = 1 + k + 3 * i, .shear = 1};
    for (int32_t k = 0; k < 3; k++) materials.list[k].branch_count = BRANCHES_MAX;
    materials.area[1] = 1;
    assert_true(spectrum_find(&materials, 3, &spectrum, &err));
    materials.list[1].plane_strain = materials.list[2].plane_strain = false;
    assert_false(spectrum_find(&materials, 2, &spectrum, &err));   // 60 times and the plates' own
    assert_int_equal(err.code, ERROR_INPUT);
}

TEST(test_short_and_long)
{
    Material material = relaxing(true), fast = material_at_once(&material);
    assert_int_equal(fast.branch_count, 0);
    Material wanted = at_rate(&material, 1e18);
    assert_near("E at once", fast.young, wanted.young, 1e-14 * wanted.young);
    assert_near("nu at once", fast.poisson, wanted.poisson, 1e-14);
    // Waves are those of the short-time response.
    WaveSpeeds speeds = material_speeds(&material), stiff = material_speeds(&fast);
    assert_near("c_L", speeds.longitudinal, stiff.longitudinal, 0);
}

// A mean of regions has the short-time modulus that springs one above the other have.
TEST(test_mean)
{
    Materials materials = {.count = 2, .area = {1, 3}};
    materials.list[0] = relaxing(true);
    materials.list[1] = (Material){.young = 5, .poisson = 0.2, .density = 1, .plane_strain = true};
    materials_find_mean(&materials);
    double first = material_at_once(&materials.list[0]).young;
    assert_near("E at last", materials.mean.young, 4 / (1 + 3 / 5.), 1e-14);
    assert_near("E at once", material_at_once(&materials.mean).young, 4 / (1 / first + 3 / 5.),
                1e-13);
    assert_near("slowest", materials_relaxation_time(&materials), 50, 0);
}
