// SPDX-License-Identifier: GPL-2.0-or-later
// A friction law as a plug-in: exponential weakening, and a film that strengthens with slip rate,
//
//     mu_K + (mu_S - mu_K) exp(-v / v_c) + a log(1 + v / v_a),    parameters: [a, v_a]
//
// Without parameters it is amontons' own exponential law. In a scene:
//
//     friction: {law: plugin, file: build/stribeck.so, mu_static: 0.38, mu_kinetic: 0.1,
//                critical_velocity: 3.4e-4, parameters: [0.02, 1e-3], velocity_max: 0.01}
//
//     amontons run SCENE --trust
#include <amontons/amontons_friction.h>

#include <math.h>

int amontons_friction_interface(void)
{
    return AMONTONS_FRICTION_INTERFACE;
}

double amontons_friction_coefficient(const AmontonsFriction *given, double speed)
{
    double drop = given->mu_static - given->mu_kinetic;
    double mu = given->mu_kinetic + drop * exp(-speed / given->critical_velocity);
    if (given->parameter_count < 2) return mu;
    return mu + given->parameters[0] * log1p(speed / given->parameters[1]);
}

double amontons_friction_slope(const AmontonsFriction *given, double speed)
{
    double drop = given->mu_static - given->mu_kinetic;
    double slope = -drop / given->critical_velocity * exp(-speed / given->critical_velocity);
    if (given->parameter_count < 2) return slope;
    return slope + given->parameters[0] / (given->parameters[1] + speed);
}
