// SPDX-License-Identifier: GPL-2.0-or-later
// Where a basis is asked: levels from well below the slowest mode to an element, with one between
// two each, all viscosities at each, and between two of them at the lowest.
#include "reduction/training_points.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "near.h"

static TrainingPoints list(const Material *material, double slowest, double element,
                           ReductionErrors *errors)
{
    Materials materials = materials_of(material);
    BulkScales scales = {.stiffness = material->young,
                         .damping = material->eta1 + material->eta2,
                         .mass = 1,
                         .load = 1};
    TrainingPoints training;
    Spectrum none = {0};
    training_points_list(&materials, &scales, &none, slowest, element, errors, &training);
    return training;
}

static int32_t visits_of(const TrainingPoints *training, int32_t level, double viscosity)
{
    int32_t found = 0;
    for (int32_t k = 0; k < training->count; k++)
        found += training->points[k].level == level &&
                 training->points[k].point.viscosity == viscosity;
    return found;
}

TEST(test_one_material)
{
    const Material paper = {.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1};
    ReductionErrors errors = {0};
    TrainingPoints training = list(&paper, 3.6, 4e4, &errors);
    int32_t top = errors.count - 2;
    assert_near("lowest", errors.inertia[0], 0.36, 1e-12);
    assert_near("element", errors.inertia[top], 4e4, 1e-8);
    assert_near("element", training.element_inertia, 4e4, 0);
    assert_true(errors.inertia[top + 1] > 1e5 * 4e4);
    assert_true(top % 2 == 0);   // levels and those between
    for (int32_t k = 0; k < top; k++) {
        double ratio = errors.inertia[k + 1] / errors.inertia[k];
        assert_near("alike", ratio, pow(4e4 / 0.36, 1.0 / top), 1e-9 * ratio);
        assert_true(ratio <= 10 * 1.000001);
    }
    for (int32_t k = 0; k <= top; k++)
        assert_true(visits_of(&training, k, 0) == 1 && visits_of(&training, k, 1) == 1);
    assert_int_equal(training.count, 2 * (top + 1) + 1);   // one between elastic and viscous
    for (int32_t k = 0; k < training.count; k++) {
        TrainingPoint now = training.points[k];
        assert_near("inertia", now.point.inertia, errors.inertia[now.level], 0);
        assert_true(now.point.viscosity == 0 || now.point.viscosity == 1 || now.level == 0);
    }
}

// The quotient of the two moduli goes from that of K to that of C by at most 2 from one viscosity
// to the next; on a mesh of a few elements the levels do not begin above its slowest mode.
TEST(test_unlike_damping)
{
    const Material unlike = {.young = 2, .poisson = 0.3, .density = 1, .eta1 = 0.2, .eta2 = 4};
    ReductionErrors errors = {0};
    TrainingPoints training = list(&unlike, 50, 100, &errors);
    double k_volume = 2 / (2 * (1 - 0.3)), k_shear = 2 / (2 * (1 + 0.3));
    double c_volume = 0.2 / 2 + 4, c_shear = 0.2 / 2, before = 0, unit = 2 / 4.2;
    int32_t found = 0;
    assert_near("lowest", errors.inertia[0], 100.0 / 100, 1e-12);   // 0.1 * 50 would be above
    for (int32_t k = 0; k < training.count; k++) {
        TrainingPoint now = training.points[k];
        if (now.level != errors.count - 2) continue;
        double v = now.point.viscosity;
        double volume = (1 - v) * k_volume + v * unit * c_volume;
        double shear = (1 - v) * k_shear + v * unit * c_shear;
        if (found++ > 0) assert_true(volume / shear / before < 2.0001);
        before = volume / shear;
    }
    assert_true(found > 3);
    assert_near("all viscous", before, c_volume / c_shear, 1e-9 * before);
}
