// SPDX-License-Identifier: GPL-2.0-or-later
// A plug-in as it was built with the first version of amontons_friction.h, whose declarations stand
// here as they were: mu = 0.4 / (1 + v / v_c). Its two functions must be used as ever.
typedef struct AmontonsFriction {
    double mu_static, mu_kinetic, critical_velocity;
    double parameters[16];
    int parameter_count;
} AmontonsFriction;

int amontons_friction_interface(void);
double amontons_friction_coefficient(const AmontonsFriction *given, double speed);
double amontons_friction_slope(const AmontonsFriction *given, double speed);

int amontons_friction_interface(void)
{
    return 1;
}

double amontons_friction_coefficient(const AmontonsFriction *given, double speed)
{
    return given->parameters[0] / (1 + speed / given->critical_velocity);
}

double amontons_friction_slope(const AmontonsFriction *given, double speed)
{
    double part = 1 + speed / given->critical_velocity;
    return -given->parameters[0] / (given->critical_velocity * part * part);
}
