// SPDX-License-Identifier: GPL-2.0-or-later
// A friction law of one's own as a plug-in: a shared object that defines functions below, named in
// a scene by
//
//     friction: {law: plugin, file: mylaw.so, parameters: [0.4, 0.1, 3.4e-4]}
//
// and used only with --trust (it is code). The functions are called from several threads at once
// and very often: they keep nothing from call to call. Speeds are slip rates >= 0 in the scene's
// units. The law must be continuous and not negative: this is looked at when the scene is read.
// Examples with their CMakeLists.txt: share/doc/amontons/examples/friction.
//
// All plug-ins define amontons_friction_interface; a law of slip rate alone the coefficient and the
// slope; a law that remembers states, start and rates in their place.
#ifndef AMONTONS_FRICTION_H
#define AMONTONS_FRICTION_H

#ifdef __cplusplus
extern "C" {
#endif

// Changes when something is added; plug-ins that were built for an earlier one are used as before.
#define AMONTONS_FRICTION_INTERFACE 2
#define AMONTONS_FRICTION_PARAMETERS_MAX 16
#define AMONTONS_FRICTION_STATES_MAX 8

// Values of the scene's map `friction`; a number that it does not give is 0.
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

// --- laws that remember (since interface 2) -----------------------------------------------------

// mu and the rate g of each state, d state/dt = g, with their derivatives.
typedef struct AmontonsFrictionRates {
    int states;   // how many; not to be set
    double mu, mu_speed, mu_pressure;
    double mu_state[AMONTONS_FRICTION_STATES_MAX];
    double rate[AMONTONS_FRICTION_STATES_MAX];
    double rate_speed[AMONTONS_FRICTION_STATES_MAX];
    // [k][j]: of the rate of state k by state j.
    double rate_state[AMONTONS_FRICTION_STATES_MAX][AMONTONS_FRICTION_STATES_MAX];
} AmontonsFrictionRates;

// Number of states of a contact node, 1 to AMONTONS_FRICTION_STATES_MAX.
int amontons_friction_states(const AmontonsFriction *given);

// The states when the rod begins to move: those of steady slip at `speed`, or, where rest > 0, of
// contacts that have rested so long (friction.rest).
void amontons_friction_start(const AmontonsFriction *given, double speed, double rest,
                             double *state);

// Fills all of *rates but `states`, as many entries as there are states. pressure: r_n over the
// node's part of the contact, >= 0. Also asked at states that a step far too long would lead to:
// what is not finite there makes it shorter.
void amontons_friction_rates(const AmontonsFriction *given, double speed, double pressure,
                             const double *state, AmontonsFrictionRates *rates);

#ifdef __cplusplus
}
#endif

#endif
