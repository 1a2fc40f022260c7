// SPDX-License-Identifier: GPL-2.0-or-later
// Adiabatic slip and its linear stability in closed form (Otsuki and Matsukawa 2013, supplement).
// With U(l) put in, the slip behind the front reads, with q = kappa r and c = 2 (mu_S - mu_K) h P /
// (E_2 L),
//
//     u_1 - u_0 = c [ l - x - q tanh(l/2q) + q sinh((x - l/2)/q) / cosh(l/2q) ],
//     U(l)      = c [ l - q tanh(l/2q) ],
//
// which, unlike the paper's form, does not cancel or overflow. Ahead of the front u stays u_0 and
// the shear E_2 U/h goes into friction, so
//
//     F_T/F_N = mu_K + (mu_S - mu_K) [ (l/L)^2 + 2 (1 - l/L) (l - q tanh(l/2q))/L ],
//
// at least mu_K + (mu_S - mu_K) l/L, and equal to it for l << q only.
#include "study/line/model1d.h"

#include <math.h>

double model1d_pressure(const Model1d *model, double x)
{
    return 2 * model->pressure * x / model->length;
}

// r^2 = alpha h H
static double spring_area(const Model1d *model)
{
    return model->alpha * model->drive * model->height;
}

double model1d_range(const Model1d *model)
{
    return sqrt(model->elastic_x / model->elastic_shear * spring_area(model));
}

// cosh(a)/sinh(b) for 0 <= a <= b, without overflow
static double cosh_over_sinh(double a, double b)
{
    return (exp(a - b) + exp(-a - b)) / -expm1(-2 * b);
}

// u_0 of the supplement: E_1 u'' + [ -E_2 u/h - mu_K p ]/(alpha H) = 0 with u' = 0 at both ends.
double model1d_rest(const Model1d *model, double x)
{
    double q = model1d_range(model), length = model->length;
    double scale = 2 * model->law.mu_kinetic * model->drive * model->pressure /
                   (model->elastic_shear * length);
    double ends = cosh_over_sinh(x / q, length / q) - cosh_over_sinh((length - x) / q, length / q);
    return scale * (q * ends - x);
}

// c of the head, 1: slip per length of front
static double slip_scale(const Model1d *model)
{
    return 2 * friction_law_drop(&model->law) * model->drive * model->pressure /
           (model->elastic_shear * model->length);
}

// Halves and folds keep every exponent at or below 0: fronts of any length over q.
double model1d_slip(const Model1d *model, double l, double x)
{
    if (x >= l) return 0;
    double q = model1d_range(model), half = l / (2 * q), y = x / q - half;
    double fold = (exp(fabs(y) - half) - exp(-fabs(y) - half)) / (1 + exp(-2 * half));
    return slip_scale(model) * (l - x - q * tanh(half) + copysign(q * fold, y));
}

double model1d_rod(const Model1d *model, double l)
{
    double q = model1d_range(model);
    return slip_scale(model) * (l - q * tanh(l / (2 * q)));
}

double model1d_mu(const Model1d *model, double l)
{
    double q = model1d_range(model), part = l / model->length;
    double ahead = 2 * (1 - part) * (part - q / model->length * tanh(l / (2 * q)));
    return model->law.mu_kinetic + friction_law_drop(&model->law) * (part * part + ahead);
}

double model1d_mu_line(const Model1d *model, double l)
{
    return model->law.mu_kinetic + friction_law_drop(&model->law) * l / model->length;
}

// --- growth rates -------------------------------------------------------------------------------

// rho omega^2 + damping omega + stiffness = 0 for cos(k_n x/l), k_n = (n + 1/2) pi.
typedef struct ModeTerms {
    double damping, weakening;   // weakening is to be taken off damping
    double stiffness;
} ModeTerms;

// The paper's equation 3, dimensional, mode n alone. The factor 1 - 1/k_n^2 is what the pressure's
// growth with x leaves of the mode's diagonal; l/L what it has reached at the front.
static ModeTerms mode_terms(const Model1d *model, int32_t n, double l)
{
    double k = (n + 0.5) * M_PI, wave = (k / l) * (k / l), springs = 1 / spring_area(model);
    double slope = -model1d_friction_slope(model);
    double layer = model->alpha * model->height;
    return (ModeTerms){.damping = model->viscous_x * wave + model->viscous_shear * springs,
                       .stiffness = model->elastic_x * wave + model->elastic_shear * springs,
                       .weakening = slope * model->pressure / layer * (l / model->length) *
                                    (1 - 1 / (k * k))};
}

// The root of larger real part, without cancellation: where damping wins, by the product of roots.
GrowthRate model1d_omega(const Model1d *model, int32_t n, double l)
{
    ModeTerms terms = mode_terms(model, n, l);
    double half = (terms.damping - terms.weakening) / (2 * model->density);
    double square = half * half - terms.stiffness / model->density;
    if (square < 0) return (GrowthRate){.re = -half, .im = sqrt(-square)};
    if (half < 0) return (GrowthRate){.re = -half + sqrt(square)};
    return (GrowthRate){.re = -terms.stiffness / model->density / (half + sqrt(square))};
}

// Resistance less weakening at l; decreases with l. critical: resistance to a real rate.
static double resistance_left(const Model1d *model, int32_t n, bool critical, double l)
{
    ModeTerms terms = mode_terms(model, n, l);
    double inertia = critical ? 2 * sqrt(model->density * terms.stiffness) : 0;
    return terms.damping + inertia - terms.weakening;
}

// Bisection to rounding between a front where resistance exceeds weakening and one where it does
// not. The theory has no end of the line: l may be beyond L.
static double find_loss(const Model1d *model, int32_t n, bool critical)
{
    double low = model->length, high = model->length;
    if (!(model1d_friction_slope(model) < 0)) return NAN;
    while (resistance_left(model, n, critical, low) <= 0) low /= 2;
    while (resistance_left(model, n, critical, high) > 0) high *= 2;
    while (high - low > 1e-15 * high) {
        double middle = 0.5 * (low + high);
        *(resistance_left(model, n, critical, middle) > 0 ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

double model1d_l_sc(const Model1d *model, int32_t n)
{
    return find_loss(model, n, false);
}

double model1d_l_c(const Model1d *model)
{
    return find_loss(model, 0, true);
}

double model1d_l_c_small(const Model1d *model)
{
    double k = M_PI / 2, slope = -model1d_friction_slope(model);
    double layer = model->alpha * model->height;
    if (!(slope > 0)) return NAN;
    return cbrt(model->viscous_x * k * k * layer * model->length /
                (slope * model->pressure * (1 - 1 / (k * k))));
}
