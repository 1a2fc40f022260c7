// SPDX-License-Identifier: GPL-2.0-or-later
// amontons with one thing wrong, for the negative controls of validation/run: a suite that never
// fails proves nothing. The linker puts the functions __wrap_NAME of this folder in the place of
// the library's NAME (ld --wrap; __real_NAME is the library's own), so that the product holds no
// trace of it and everything else, from scene to result, is the program that is validated.
//
//   AMONTONS_MISTAKE=viscous-sign amontons_mistaken run SCENE ...
//
// validation/mistakes/CMakeLists.txt lists the functions; the names here are those of the report.
#ifndef AMONTONS_VALIDATION_MISTAKE_H
#define AMONTONS_VALIDATION_MISTAKE_H

// symbol, name in AMONTONS_MISTAKE
#define MISTAKES(X)                                                                                \
    X(MISTAKE_NONE, "none")                                                                        \
    X(MISTAKE_VISCOUS_SIGN, "viscous-sign") /* sigma_xx = ... - eta2 eps_zz' */                    \
    X(MISTAKE_SHEAR_VISCOSITY, "shear-viscosity") /* eta1 2 eps_xz' in place of eta1 eps_xz' */    \
    X(MISTAKE_WRONG_PLANE, "wrong-plane") /* strain for stress and the reverse */                  \
    X(MISTAKE_UNLUMPED_CONTACT, "unlumped-contact") /* gap, slip, reaction by consistent mass */   \
    X(MISTAKE_CONSISTENT_SLIP, "consistent-slip") /* slip and shear only */                        \
    X(MISTAKE_SMOOTHED_STICK, "smoothed-stick") /* mu(v) tanh(v/v_0) in place of stick */          \
    X(MISTAKE_GLUED_CONTACT, "glued-contact") /* what touched does not leave */                    \
    X(MISTAKE_HALF_SLIP_RATE, "half-slip-rate") /* mu(v/2) */                                      \
    X(MISTAKE_STAGE_MATRIX, "stage-matrix") /* K twice in the matrix of a stage */                 \
    X(MISTAKE_LAST_DIRECTION, "last-direction") /* friction along the slip of the solve before */  \
    X(MISTAKE_NO_ACROSS, "no-across") /* no friction across the drive */                           \
    X(MISTAKE_HALF_WEIGHT, "half-weight") /* of one contact node */                                \
    X(MISTAKE_FLOOR_BESIDE, "floor-beside") /* P of the neighbour */                               \
    X(MISTAKE_FLOOR_WEIGHT, "floor-weight") /* P weighed by the floor in place of the contact */   \
    X(MISTAKE_LIGHT_BASE, "light-base") /* a base without mass */                                  \
    X(MISTAKE_MASS_APART, "mass-apart") /* M of jumps without what couples them to the floor */    \
    X(MISTAKE_ONE_SIDED, "one-sided") /* displacements of the block without the floor's */         \
    X(MISTAKE_BENT_CORNERS, "bent-corners") /* corners of curved T6 faces touch, too */            \
    /* of scenes.c, in words in scenes.py */                                                       \
    X(MISTAKE_REGION_DENSITY, "region-density")                                                    \
    X(MISTAKE_REGION_VISCOSITY, "region-viscosity")                                                \
    X(MISTAKE_REGION_KEY, "region-key")                                                            \
    X(MISTAKE_ONE_LAW, "one-law")                                                                  \
    X(MISTAKE_FLAT_FLOOR, "flat-floor")                                                            \
    X(MISTAKE_FLAT_MESH, "flat-mesh")                                                              \
    X(MISTAKE_PROFILE_STEPS, "profile-steps")                                                      \
    X(MISTAKE_PROFILE_NAME, "profile-name")                                                        \
    X(MISTAKE_MAP_TURNED, "map-turned")                                                            \
    X(MISTAKE_LOAD_STAIRS, "load-stairs")                                                          \
    X(MISTAKE_LOAD_POINTS, "load-points")                                                          \
    X(MISTAKE_ROD_WAY, "rod-way")                                                                  \
    X(MISTAKE_MACHINE_RIGID, "machine-rigid")                                                      \
    X(MISTAKE_MACHINE_FORCE, "machine-force")                                                      \
    X(MISTAKE_WINDOW_FORGOTTEN, "window-forgotten")                                                \
    X(MISTAKE_MEMORY_LAGGED, "memory-lagged")                                                      \
    X(MISTAKE_MEMORY_KEPT, "memory-kept")                                                          \
    X(MISTAKE_MEMORY_GROWS, "memory-grows")                                                        \
    X(MISTAKE_MEMORY_BLIND, "memory-blind")                                                        \
    X(MISTAKE_MEMORY_CLOCK, "memory-clock")                                                        \
    X(MISTAKE_MEMORY_FRESH, "memory-fresh")                                                        \
    X(MISTAKE_MEMORY_EVOLUTION, "memory-evolution")                                                \
    X(MISTAKE_STATES_START, "states-start")                                                        \
    X(MISTAKE_STATES_FRESH, "states-fresh")                                                        \
    X(MISTAKE_STATES_LAGGED, "states-lagged")                                                      \
    X(MISTAKE_STATES_KEPT, "states-kept")                                                          \
    X(MISTAKE_STATES_APART, "states-apart")                                                        \
    X(MISTAKE_STATES_PRESSURE, "states-pressure")                                                  \
    X(MISTAKE_STATES_CUT, "states-cut")                                                            \
    X(MISTAKE_STATES_DERIVATIVE, "states-derivative")                                              \
    X(MISTAKE_STATES_GROWS, "states-grows")                                                        \
    X(MISTAKE_STATES_ALONE, "states-alone")                                                        \
    X(MISTAKE_STATES_UNSOLVED, "states-unsolved")                                                  \
    X(MISTAKE_STATES_CLOCK, "states-clock")                                                        \
    X(MISTAKE_STATES_STEADY, "states-steady")                                                      \
    X(MISTAKE_BRANCH_BESIDE, "branch-beside")                                                      \
    X(MISTAKE_BRANCH_LATE, "branch-late")                                                          \
    X(MISTAKE_BRANCH_ENERGY, "branch-energy")

typedef enum Mistake {
#define X(symbol, name) symbol,
    MISTAKES(X)
#undef X
} Mistake;

// The library's own NAME as its header has it, and what stands in its place.
#define REPLACED(name) __typeof__(name) __real_##name, __wrap_##name

// By the environment; an unknown name ends the program, for a control that makes no mistake would
// be worse than none.
Mistake mistake_made(void);

#endif
