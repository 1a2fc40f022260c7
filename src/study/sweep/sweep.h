// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep whose points come in rounds. Called by study/search; amontons_sweep is one of one round.
#ifndef AMONTONS_STUDY_SWEEP_SWEEP_H
#define AMONTONS_STUDY_SWEEP_SWEEP_H

#include "study/sweep/computing/point.h"

// Reads the study. options: used until sweep_close. Also of one half opened *sweep is the caller's
// to close.
bool sweep_open(const char *path, const SweepOptions *options, Sweep **sweep, Error *err);
// One more list of maps in YAML: each is a case, with all of `vary`. Their points are the next.
bool sweep_add(Sweep *sweep, const char *designs, Error *err);
// ERROR_INTERRUPT: stopped; a point that failed is none.
bool sweep_compute(Sweep *sweep, Error *err);
// The ranked table, and the figures that the study asks for, where it was not stopped (`whole`).
// out: of words; NULL: there are none.
bool sweep_show(const Sweep *sweep, FILE *out, bool whole, Error *err);
void sweep_close(Sweep *sweep);   // NULL is fine

#endif
