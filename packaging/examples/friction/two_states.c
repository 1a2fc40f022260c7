// SPDX-License-Identifier: GPL-2.0-or-later
// A friction law that remembers, as a plug-in: rate and state with two ageing states, one that is
// lost over a short and one that is lost over a long slip (Ruina, J. Geophys. Res. 88, 1983),
//
//     mu = a asinh(v/(2 V_0) exp((f_0 + b_1 psi_1 + b_2 psi_2)/a))
//     d psi_k/dt = (V_0 exp(-psi_k) - v)/D_k,      parameters: [f_0, V_0, a, b_1, D_1, b_2, D_2]
//
// In a scene:
//
//     friction: {law: plugin, file: build/two_states.so,
//                parameters: [0.3, 1e-5, 0.01, 0.016, 1e-4, 0.004, 1e-3]}
#include <amontons/amontons_friction.h>

#include <math.h>

enum { STATES = 2, F_0 = 0, V_0 = 1, A = 2, FIRST = 3 };

int amontons_friction_interface(void)
{
    return AMONTONS_FRICTION_INTERFACE;
}

int amontons_friction_states(const AmontonsFriction *given)
{
    return given->parameter_count == FIRST + 2 * STATES ? STATES : 0;   // 0: refused
}

void amontons_friction_start(const AmontonsFriction *given, double speed, double rest,
                             double *state)
{
    for (int k = 0; k < STATES; k++) {
        double slip = given->parameters[FIRST + 2 * k + 1];
        state[k] = log(given->parameters[V_0] * (rest > 0 ? rest / slip : 1 / speed));
    }
}

void amontons_friction_rates(const AmontonsFriction *given, double speed, double pressure,
                             const double *state, AmontonsFrictionRates *rates)
{
    const double *p = given->parameters;
    double strength = p[F_0];
    (void)pressure;
    for (int k = 0; k < STATES; k++) strength += p[FIRST + 2 * k] * state[k];
    double scale = 2 * p[V_0] * exp(-strength / p[A]), root = hypot(speed, scale);
    rates->mu = p[A] * asinh(speed / scale);
    rates->mu_speed = p[A] / root;
    rates->mu_pressure = 0;
    for (int k = 0; k < STATES; k++) {
        double slip = p[FIRST + 2 * k + 1], heals = p[V_0] * exp(-state[k]);
        rates->mu_state[k] = p[FIRST + 2 * k] * speed / root;
        rates->rate[k] = (heals - speed) / slip;
        rates->rate_speed[k] = -1 / slip;
        for (int j = 0; j < STATES; j++) rates->rate_state[k][j] = j == k ? -heals / slip : 0;
    }
}
