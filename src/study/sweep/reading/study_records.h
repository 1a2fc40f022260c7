// SPDX-License-Identifier: GPL-2.0-or-later
// Results that a study may name by one word, in `record`, `rank` and `plot`.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_RECORDS_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_RECORDS_H

// X(name in `record`, path in run.json, recorded by default, meaning)
#define STUDY_RECORDS(X)                                                                           \
    X("mu_M", "results.mu_M", true, "macroscopic static friction coefficient")                     \
    X("mu_M_error", "results.mu_M_error", false, "its error")                                      \
    X("spread", "results.mu_M_spread", true, "largest minus smallest of the peaks in mu_M")        \
    X("period", "results.period", true, "peaks repeat after so many slidings; 0: not")             \
    X("low", "results.mu_M_low", true, "lowest of the peaks in mu_M")                              \
    X("high", "results.mu_M_high", true, "highest of them")                                        \
    X("peaks", "results.mu_M_peaks", true, "how many they are")                                    \
    X("l_c", "results.l_c_over_L", true, "critical length over L, from the dynamics")              \
    X("l_sc", "results.l_sc_over_L", true, "front over L where the certificate is lost")           \
    X("slip_cells", "results.slip_cells", false, "cells that slipped where slow slip turned fast") \
    X("steps", "steps.accepted", true, "steps accepted")                                           \
    X("unsolved", "steps.unsolved_retries", true, "steps undone, the contact without solution")    \
    X("solve_s", "timing_s.solve", true, "time in the loop of steps, s")                           \
    X("total_s", "timing_s.total", true, "wall time of the point, s")                              \
    X("energy_error", "errors.energy", true, "energy ledger, relative")                            \
    X("contact_error", "errors.complementarity", true, "contact conditions, relative")             \
    X("moment_error", "errors.moment", true, "balance of moments, relative")                       \
    X("reduction_error", "errors.reduction", true, "reduced bulk against the full one")            \
    X("mu_max", "results.mu_max", true, "largest mu of the whole run")                             \
    X("F_N", "results.F_N", false, "normal force of the whole block")                              \
    X("F_T_M", "results.F_T_M", false, "force of the rod at mu_M, of the whole block")             \
    X("F_T_hold", "results.F_T_hold", false, "that at mu_hold")                                    \
    X("mu_hold", "results.mu_hold", true, "holding coefficient")                                   \
    X("mu_hold_error", "results.mu_hold_error", false, "its error")                                \
    X("mu_drops", "results.drops.mean", false, "mean of the load drops")                           \
    X("mu_drops_error", "results.drops.mean_error", false, "error of that mean")                   \
    X("drops", "results.drops.counted", false, "load drops in mu_hold")                            \
    X("drops_period", "results.drops.period", false, "they repeat after so many; 0: not")          \
    X("drops_enough", "results.drops.enough", false, "1: they repeat, or mean known to 2 %")       \
    X("run_in_over", "results.run_in.over", false, "1: the whole contact has come to a regime")    \
    X("mu_steady", "results.mu_steady", false, "mu at which the block slides at the end")          \
    X("mu_first_pad", "results.mu_first_pad", false, "lowest mu at which a whole pad slides")      \
    X("first_mu", "results.peaks.0.mu", false, "first peak, from the start state")                 \
    X("contact_nodes", "model.contact_nodes", false, "nodes on the interface")                     \
    X("reduced_dofs", "model.reduced_dofs", false, "unknowns stepped; 0: the full mesh")

#endif
