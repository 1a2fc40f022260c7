// SPDX-License-Identifier: GPL-2.0-or-later
// Coupled modes against differences of the same equation, against the paper's single modes, and
// against stepping/growth on the line that is stepped.
#include "algebra/dense.h"
#include "base/memory.h"
#include "model1d_sets.h"

static Model1dRates rates_of(const Model1d *model, double l, int32_t count)
{
    Error err = {0};
    Model1dRates rates;
    double *work = NEW_ARRAY(double, model1d_rates_work(count), &err);
    assert_true(model1d_rates(model, l, count, work, &rates));
    memory_free(work);
    return rates;
}

TEST(test_one_mode)
{
    Model1d model = set_a(0.01, 1);
    for (double l = 0.1; l < 1; l += 0.1) {
        Model1dRates rates = rates_of(&model, l, 1);
        GrowthRate omega = model1d_omega(&model, 0, l);
        assert_near("re", rates.rightmost.re, omega.re, 1e-10 * (1 + fabs(omega.re)));
        assert_near("im", rates.rightmost.im, omega.im, 1e-10 * (1 + fabs(omega.re)));
        assert_near("real", rates.real, omega.im == 0 && omega.re > 0 ? omega.re : 0, 1e-10);
    }
}

// rho w^2 u = w D u + B u by second differences on [0, l], u' = 0 at 0, u = 0 at l; the companion
// matrix's rightmost eigenvalue.
static GrowthRate by_differences(const Model1d *model, double l, int32_t n)
{
    Error err = {0};
    int32_t size = 2 * n;
    double *matrix = NEW_ARRAY(double, (int64_t)size *size, &err);
    double *vectors = NEW_ARRAY(double, (int64_t)size *size, &err);
    double *re = NEW_ARRAY(double, size, &err), *im = NEW_ARRAY(double, size, &err);
    double *work = NEW_ARRAY(double, DENSE_EIGEN_WORK(size), &err);
    double step = l / n, layer = model->alpha * model->height, held = layer * model->drive;
    double drop = model->law.mu_static - model->law.mu_kinetic;
    for (int32_t i = 0; i < n; i++) {
        double weakening = drop / model->law.critical_velocity * 2 * model->pressure * i * step /
                           model->length / layer;
        matrix[(n + i) * size + i] = 1;
        for (int32_t j = i - 1; j <= i + 1; j++) {
            int32_t column = j < 0 ? 1 : j;   // u(-h) = u(h)
            if (column == n) continue;
            double bend = (j == i ? -2 : 1) / (step * step);
            matrix[column * size + n + i] += model->elastic_x * bend / model->density;
            matrix[(n + column) * size + n + i] += model->viscous_x * bend / model->density;
        }
        matrix[i * size + n + i] -= model->elastic_shear / held / model->density;
        matrix[(n + i) * size + n + i] += (weakening - model->viscous_shear / held) /
                                          model->density;
    }
    assert_true(dense_eigen_general(matrix, size, re, im, vectors, work));
    GrowthRate found = {.re = -INFINITY};
    for (int32_t k = 0; k < size; k++)
        if (re[k] > found.re) found = (GrowthRate){.re = re[k], .im = fabs(im[k])};
    double *arrays[] = {matrix, vectors, re, im, work};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) memory_free(arrays[k]);
    return found;
}

TEST(test_against_differences)
{
    Model1d models[] = {set_a(0.01, 1), set_a(0.01, 4), set_b(1.15e-4, 0.04)};
    for (size_t m = 0; m < 3; m++) {
        Model1dLosses losses;
        Error err = {0};
        assert_true(model1d_losses(&models[m], &losses, &err));
        double fronts[] = {0.5 * (losses.l_sc + losses.l_c), 1.1 * losses.l_c};
        for (size_t k = 0; k < 2; k++) {
            Model1dRates rates = rates_of(&models[m], fronts[k], MODEL1D_MODES);
            GrowthRate coarse = by_differences(&models[m], fronts[k], 40);
            GrowthRate fine = by_differences(&models[m], fronts[k], 80);
            double scale = hypot(rates.rightmost.re, rates.rightmost.im);
            double error = hypot(fine.re - rates.rightmost.re, fine.im - rates.rightmost.im);
            double before = hypot(coarse.re - rates.rightmost.re, coarse.im - rates.rightmost.im);
            assert_near("rightmost", error / scale, 0, 3e-3);
            assert_near("of second order", log2(before / error), 2, 0.15);
            assert_true(k == 0 ? rates.real == 0 && rates.rightmost.im > 0
                               : rates.real == rates.rightmost.re);
        }
    }
}

TEST(test_enough_modes)
{
    Model1d models[] = {set_a(0.01, 1), set_a(0.03, 4), set_b(1.15e-4, 0.04)};
    for (size_t m = 0; m < 3; m++) {
        Model1dLosses losses;
        Error err = {0};
        assert_true(model1d_losses(&models[m], &losses, &err));
        Model1dRates few = rates_of(&models[m], 1.05 * losses.l_c, MODEL1D_MODES);
        Model1dRates many = rates_of(&models[m], 1.05 * losses.l_c, 2 * MODEL1D_MODES);
        assert_near("twice as many", few.real / many.real, 1, 1e-4);
        // l_c itself: with twice as many modes the pair is born within 1e-5 of the same place
        assert_true(rates_of(&models[m], losses.l_c * (1 + 1e-5), 2 * MODEL1D_MODES).real > 0);
        assert_true(rates_of(&models[m], losses.l_c * (1 - 1e-5), 2 * MODEL1D_MODES).real == 0);
    }
}

TEST(test_losses)
{
    Error err = {0};
    Model1dLosses losses;
    Model1d model = set_a(0.01, 1);
    assert_true(model1d_losses(&model, &losses, &err));
    assert_true(0 < losses.l_sc && losses.l_sc < losses.l_rod && losses.l_rod < losses.l_c);
    assert_true(rates_of(&model, losses.l_sc + 1e-6, MODEL1D_MODES).rightmost.re > 0);
    assert_true(rates_of(&model, losses.l_sc - 1e-6, MODEL1D_MODES).rightmost.re < 0);
    GrowthRate at = rates_of(&model, losses.l_rod, MODEL1D_MODES).rightmost;
    double ratio = model.law.critical_velocity / model.velocity;
    assert_near("half a period", exp(M_PI * at.re / at.im) / ratio, 1, 1e-3);
    // Coupled modes feel the larger weakening near the front: less than the paper's l_c.
    assert_true(losses.l_c < model1d_l_c(&model));
    Model1d slow = model;   // V -> 0: the two meet
    slow.velocity = 1e-40;
    Model1dLosses slower;
    assert_true(model1d_losses(&slow, &slower, &err));
    assert_true(slower.l_rod > losses.l_rod && slower.l_rod <= slower.l_c);
    assert_near("l_c knows no V", slower.l_c, losses.l_c, 1e-12);
    Model1d figure1 = set_a(0.003, 1);
    assert_true(model1d_losses(&figure1, &losses, &err));
    assert_true(isnan(losses.l_c) && isnan(losses.l_rod));
}

// The stepped line with the nodes behind a front slipping: stepping/growth knows the same rates.
TEST(test_against_growth)
{
    enum { NODES = 121, FRONT = 80 };
    Error err = {0};
    Model1d model = set_a(0.01, 1);
    Chain chain;
    State line;
    assert_true(chain_build(&model, NODES, &chain, &err));
    assert_true(state_create(&chain.system, &chain.interface, &line, &err));
    chain_rest(&model, &chain, &line);
    for (int32_t i = 0; i < FRONT; i++) line.status[i] = CONTACT_SLIP_FORWARD;
    GrowthDef def = growth_def(model.length, model.speed, NODES);
    Growth *growth = growth_create(&chain.block, &def, &err);
    GrowthRates found;
    assert_non_null(growth);
    assert_true(growth_rates(growth, &line, &found, &err));
    // The first node that sticks is where u = u_0.
    Model1dRates rates = rates_of(&model, chain.interface.x[FRONT], MODEL1D_MODES);
    double scale = hypot(rates.rightmost.re, rates.rightmost.im);
    assert_near("re", found.rate[0].re / scale, rates.rightmost.re / scale, 2e-3);
    assert_near("im", found.rate[0].im / scale, rates.rightmost.im / scale, 2e-3);
    growth_destroy(growth);
    state_destroy(&line);
    chain_destroy(&chain);
}

TEST(test_memory)
{
    Model1d model = set_a(0.01, 1);
    Model1dLosses losses;
    Error err = {0};
    int64_t live = memory_counters().live;
    memory_fail_after(0);
    assert_false(model1d_losses(&model, &losses, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_int_equal(memory_counters().live, live);
}

FIXTURE(group_begin)
{
    dense_use_one_thread();
    return 0;
}

GROUP_BETWEEN(group_begin, NULL);
