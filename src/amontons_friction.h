// SPDX-License-Identifier: GPL-2.0-or-later
// A friction law of one's own as a plug-in: a shared object that defines the three functions below,
// named in a scene by
//
//     friction: {law: plugin, file: mylaw.so, parameters: [0.4, 0.1, 3.4e-4]}
//
// and used only with --trust (it is code). The functions are called from several threads at once
// and very often: they keep no state. Speeds are slip rates >= 0 in the scene's units. The law must
// be continuous and not negative: this is looked at when the scene is read. An example
// with its CMakeLists.txt: share/doc/amontons/examples/friction.
#ifndef AMONTONS_FRICTION_H
#define AMONTONS_FRICTION_H

#ifdef __cplusplus
extern "C" {
#endif

// Changes when a plug-in that was built before could no longer be used.
#define AMONTONS_FRICTION_INTERFACE 1
#define AMONTONS_FRICTION_PARAMETERS_MAX 16

// What the scene's map `friction` gives; a number that it does not give is 0.
typedef struct AmontonsFriction {
    double mu_static, mu_kinetic, critical_velocity;
    double parameters[AMONTONS_FRICTION_PARAMETERS_MAX];
    int parameter_count;
} AmontonsFriction;

// Returns AMONTONS_FRICTION_INTERFACE as it was when the plug-in was built.
int amontons_friction_interface(void);

// mu at this speed.
double amontons_friction_coefficient(const AmontonsFriction *given, double speed);

// d mu / d speed. At a kink either side's will do.
double amontons_friction_slope(const AmontonsFriction *given, double speed);

#ifdef __cplusplus
}
#endif

#endif
