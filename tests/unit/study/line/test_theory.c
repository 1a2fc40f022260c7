// SPDX-License-Identifier: GPL-2.0-or-later
// The closed forms against the equations they solve, by differences and sums; against the paper's
// own forms of them; and against what the paper and its check say of particular states.
#include "model1d_sets.h"

#include <complex.h>

// E_1 u'' + [E_2 (U - u)/h - mu p] / (alpha H) by central differences, over its largest term.
static double equation_error(const Model1d *model, double l, double x)
{
    double step = 1e-3 * model1d_range(model), layer = model->alpha * model->height;
    double u[3], U = l > 0 ? model1d_rod(model, l) : 0;
    for (int k = 0; k < 3; k++) {
        double at = x + (k - 1) * step;
        u[k] = model1d_rest(model, at) + (l > 0 ? model1d_slip(model, l, at) : 0);
    }
    double mu = l > 0 ? model->law.mu_static : model->law.mu_kinetic;
    double bent = model->elastic_x * (u[0] - 2 * u[1] + u[2]) / (step * step);
    double driven = model->elastic_shear * (U - u[1]) / model->drive / layer;
    double rubbed = mu * model1d_pressure(model, x) / layer;
    return fabs(bent + driven - rubbed) / (fabs(bent) + fabs(driven) + fabs(rubbed));
}

static double slope(const Model1d *model, double l, double x, double step)
{
    double before = model1d_rest(model, x), after = model1d_rest(model, x + step);
    if (l > 0) {
        before += model1d_slip(model, l, x);
        after += model1d_slip(model, l, x + step);
    }
    return (after - before) / step;
}

TEST(test_adiabatic_equation)
{
    Model1d models[] = {set_a(0.003, 1), set_a(0.03, 4), set_b(5.75e-5, 0.04)};
    for (size_t m = 0; m < 3; m++) {
        const Model1d *model = &models[m];
        double length = model->length;
        double scale = fabs(model1d_rest(model, length)) / length;
        for (double part = 0.05; part < 1; part += 0.1) {
            assert_near("u_0", equation_error(model, 0, part * length), 0, 1e-5);
            for (double behind = 0.1; behind < 1; behind += 0.2)
                assert_near("u_1", equation_error(model, part * length, behind * part * length), 0,
                            1e-5);
            // Free at x = 0; ahead of the front and at it, u and du/dx are those of u_0.
            double step = 1e-6 * length, l = part * length;
            assert_near("u_1'(0)", slope(model, l, 0, step) / scale, 0, 1e-4);
            assert_near("u_1(l)", model1d_slip(model, l, l - 1e-9 * length), 0, 1e-13 * length);
            assert_near("u_1'(l)", slope(model, l, l - step, step) / scale,
                        slope(model, 0, l - step, step) / scale, 1e-4);
            assert_true(model1d_slip(model, l, l) == 0 && model1d_slip(model, l, length) == 0);
        }
        assert_near("u_0'(0)", slope(model, 0, 0, 1e-6 * length) / scale, 0, 1e-4);
        assert_near("u_0'(L)", slope(model, 0, length, -1e-6 * length) / scale, 0, 1e-4);
    }
}

// The paper's u_1, in which U and l stand side by side, with the U(l) of this file.
TEST(test_paper_form)
{
    Model1d model = set_a(0.01, 2);
    double q = sqrt(model.elastic_x / model.elastic_shear * 0.2 * model.drive * model.height);
    double c = 2 * 0.28 * model.drive * model.pressure / (model.elastic_shear * model.length);
    assert_near("kappa r", model1d_range(&model), q, 1e-15);
    for (double l = 0.1; l < 2; l += 0.3) {
        double U = model1d_rod(&model, l);
        for (double x = 0; x < l; x += l / 7) {
            double y = (l - x) / q;
            double paper = U * (1 - cosh(y)) + c * (l * cosh(y) - q * sinh(y) - x);
            assert_near("u_1 - u_0", model1d_slip(&model, l, x), paper, 1e-13 * c);
        }
    }
    // l ~ E_2 L U / ((mu_S - mu_K) h P) for small l
    double l = 1e-3, U = model1d_rod(&model, l);
    double paper = model.elastic_shear * model.length * U / (0.28 * model.drive * model.pressure);
    assert_near("small l", paper / l, 1, 1e-5);
}

// F_T = integral of E_2 (U - u)/h by Simpson's rule, behind and ahead of the front apart.
static double shear_force(const Model1d *model, double l, double from, double to)
{
    enum { PARTS = 400 };
    double sum = 0, step = (to - from) / PARTS, U = model1d_rod(model, l);
    for (int k = 0; k <= PARTS; k++) {
        double x = from + k * step;
        double stress = model->elastic_shear / model->drive *
                        (U - model1d_rest(model, x) - model1d_slip(model, l, x));
        sum += stress * (k == 0 || k == PARTS ? 1 : k % 2 ? 4 : 2);
    }
    return sum * step / 3;
}

TEST(test_force)
{
    Model1d models[] = {set_a(0.003, 1), set_b(5.75e-5, 0.04)};
    for (size_t m = 0; m < 2; m++) {
        const Model1d *model = &models[m];
        double load = model->pressure * model->length;
        for (double part = 0.1; part < 1.05; part += 0.1) {
            double l = fmin(part, 1) * model->length;
            double force = shear_force(model, l, 0, l) + shear_force(model, l, l, model->length);
            assert_near("F_T/F_N", model1d_mu(model, l), force / load, 1e-9);
            assert_true(model1d_mu(model, l) >= model1d_mu_line(model, l) - 1e-15);
        }
        assert_near("all slips", model1d_mu(model, model->length), model->law.mu_static, 1e-14);
        double l = 1e-3 * model->length, drop = model->law.mu_static - model->law.mu_kinetic;
        assert_near("the line", (model1d_mu(model, l) - model1d_mu_line(model, l)) / drop, 0, 1e-6);
    }
}

// A line far longer than its range: cosh(L/q) alone would overflow.
TEST(test_stiff_line)
{
    Model1d model = set_a(0.003, 1);
    model.alpha = 1e-8;
    double q = model1d_range(&model);
    assert_true(model.length / q > 1000);
    for (double x = 0; x <= 1; x += 0.125) {
        assert_true(isfinite(model1d_rest(&model, x)));
        double slip = model1d_slip(&model, 0.5, x);
        double c = 2 * 0.28 * model.drive * model.pressure / model.elastic_shear;
        assert_near("local slip", slip, fmax(c * (0.5 - x), 0), 2.001 * q * c);
    }
}

// The paper's equation 3, in its own terms (lengths over L, d, kappa, r).
static double complex paper_equation(const Model1d *model, int32_t n, double l,
                                     double complex omega)
{
    double L = model->length, d = 0.5, part = l / L, k = (n + 0.5) * M_PI;
    double r2 = model->alpha * model->drive * model->height / (L * L);
    double kappa2 = model->elastic_x / model->elastic_shear;
    double drop = model->law.mu_static - model->law.mu_kinetic;
    return omega * omega * L * L + (2 * k * k / (part * part) + 0.5 / r2) * omega +
           model->elastic_x * (k * k / (part * part) + 1 / (kappa2 * r2)) -
           drop / (model->law.critical_velocity * model->alpha * d) * (1 - 1 / (k * k)) *
               model->pressure * L * part * omega;
}

TEST(test_growth_rates)
{
    Model1d models[] = {set_a(0.003, 1), set_a(0.03, 4), set_b(5.75e-5, 0.04)};
    int32_t complexes = 0, reals = 0;
    for (size_t m = 0; m < 3; m++) {
        for (int32_t n = 0; n < 4; n++) {
            for (double part = 0.02; part < 1.6; part += 0.02) {
                double l = part * models[m].length;
                GrowthRate rate = model1d_omega(&models[m], n, l);
                double complex omega = rate.re + I * rate.im;
                double size = fabs(models[m].elastic_x / models[m].alpha / part / part) +
                              cabs(omega * omega) * models[m].length * models[m].length;
                assert_near("equation 3", cabs(paper_equation(&models[m], n, l, omega)) / size, 0,
                            1e-10);
                complexes += rate.im > 0;
                reals += rate.im == 0;
            }
        }
    }
    assert_true(complexes > 20 && reals > 20);
}

TEST(test_losses)
{
    Model1d models[] = {set_a(0.003, 1), set_a(0.03, 4), set_b(5.75e-5, 0.04)};
    for (size_t m = 0; m < 3; m++) {
        const Model1d *model = &models[m];
        double L = model->length, l = model1d_l_c(model), d = 0.5, alpha = model->alpha;
        double drop = model->law.mu_static - model->law.mu_kinetic, wave = M_PI * L / (2 * l);
        // The supplement's P(l_c)
        double paper =
            M_PI * M_PI / (M_PI * M_PI - 4) * model->law.critical_velocity * alpha * d / drop / l *
            (2 * wave * wave + 1 / (alpha * d * d) +
             2 * L *
                 sqrt(model->elastic_x * wave * wave + 2 * model->elastic_shear / (alpha * d * d)));
        assert_near("P(l_c)", paper / model->pressure, 1, 1e-12);
        assert_true(model1d_omega(model, 0, l * (1 - 1e-6)).im > 0);
        GrowthRate beyond = model1d_omega(model, 0, l * (1 + 1e-6));
        assert_true(beyond.im == 0 && beyond.re > 0);
        for (int32_t n = 0; n < 3; n++) {
            double lost = model1d_l_sc(model, n);
            assert_true(model1d_omega(model, n, lost * (1 - 1e-9)).re < 0);
            assert_true(model1d_omega(model, n, lost * (1 + 1e-9)).re > 0);
            assert_true(n == 0 || lost > model1d_l_sc(model, n - 1));
        }
        assert_true(model1d_l_sc(model, 0) < l);
    }
    Model1d still = set_a(0.003, 1);
    still.law.kind = FRICTION_COULOMB;
    assert_true(isnan(model1d_l_c(&still)) && isnan(model1d_l_sc(&still, 0)));
    assert_true(isnan(model1d_l_c_small(&still)));
}

// l_c/L goes as (L P)^(-1/3) where it is small, and the law's own prefactor is the limit.
TEST(test_small_law)
{
    double last = 0;
    for (double pressure = 1; pressure < 1e7; pressure *= 10) {
        Model1d model = set_a(pressure, 1), larger = set_a(8 * pressure, 1);
        double ratio = model1d_l_c(&model) / model1d_l_c_small(&model);
        assert_true(ratio > 1 && (last == 0 || ratio < last));
        assert_near("law", model1d_l_c_small(&larger) / model1d_l_c_small(&model), 0.5, 1e-12);
        last = ratio;
    }
    assert_near("limit", last, 1, 2e-3);
    Model1d one = set_a(0.01, 4), other = set_a(0.04, 1);   // L P alone counts
    assert_near("L P", model1d_l_c_small(&one) / 4, model1d_l_c_small(&other), 1e-12);
}

// Known particular states: at Figure 1's the formula gives l_c > L; set B at P L =
// 2.3e-6 gives mu_M = 1.0.
TEST(test_known_states)
{
    Model1d figure1 = set_a(0.003, 1), pmma = set_b(2.3e-6 / 0.04, 0.04);
    assert_true(model1d_l_c(&figure1) > 1);
    assert_near("set B", model1d_mu_line(&pmma, model1d_l_c(&pmma)), 1.0, 0.01);
}
