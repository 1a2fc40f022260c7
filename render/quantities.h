// SPDX-License-Identifier: GPL-2.0-or-later
// The quantities that figures of a block and of its contact show, by their names. It includes
// nothing: whoever reads a name of a quantity or of its picture takes it from here.
#ifndef AMONTONS_RENDER_QUANTITIES_H
#define AMONTONS_RENDER_QUANTITIES_H

// Quantities that `field` may show: X(symbol, name, words, unit in SI, unit in normalised scenes).
// Stresses hold the viscous part.
#define BLOCK_QUANTITIES(X)                                                                        \
    X(BLOCK_VON_MISES, "von_mises", "von Mises stress", "Pa", "~{E}")                              \
    X(BLOCK_STRESS_XX, "stress_xx", "stress ~{\u03c3}_{xx}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_YY, "stress_yy", "stress ~{\u03c3}_{yy}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_ZZ, "stress_zz", "stress ~{\u03c3}_{zz}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_XZ, "stress_xz", "stress ~{\u03c3}_{xz}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_XY, "stress_xy", "stress ~{\u03c3}_{xy}", "Pa", "~{E}")                         \
    X(BLOCK_STRESS_YZ, "stress_yz", "stress ~{\u03c3}_{yz}", "Pa", "~{E}")                         \
    X(BLOCK_PRESSURE, "pressure", "pressure \u2212(~{\u03c3}_{xx} + ~{\u03c3}_{zz})/2", "Pa",      \
      "~{E}")                                                                                      \
    X(BLOCK_VELOCITY, "velocity", "velocity |~{v}|", "m/s", "(~{L}_{0} / ~{t}_{0})")               \
    X(BLOCK_DISPLACEMENT, "displacement", "displacement |~{u}|", "m", "~{L}_{0}")                  \
    X(BLOCK_ENERGY, "strain_energy", "strain energy density", "J/m^{3}", "~{E}")                   \
    X(BLOCK_DISSIPATION, "dissipation", "dissipation rate", "W/m^{3}", "(~{E} / ~{t}_{0})")

// Quantities that `contact-plane` may show, in the same way; a state also by its own name.
#define CONTACT_QUANTITIES(X)                                                                      \
    X(CONTACT_SLIP_RATE, "slip_rate", "slip rate", "m/s", "(~{L}_{0} / ~{t}_{0})")                 \
    X(CONTACT_DENSITY, "contact_density", "contact density ~{\u03c6}", "", "")                     \
    X(CONTACT_PRESSURE, "pressure", "pressure ~{p}", "Pa", "~{E}")                                 \
    X(CONTACT_SHEAR, "shear", "shear stress |~{\u03c4}|", "Pa", "~{E}")                            \
    X(CONTACT_RATIO, "shear_over_pressure", "|~{\u03c4}| / ~{p}", "", "")                          \
    X(CONTACT_SLIP, "slip", "slip since (a)", "m", "~{L}_{0}")                                     \
    X(CONTACT_GAP, "gap", "gap", "m", "~{L}_{0}")                                                  \
    X(CONTACT_STATE, "state", "", "", "")                                                          \
    X(CONTACT_ARRIVAL, "arrival", "arrival of rapid slip", "s", "~{t}_{0}")

#endif
