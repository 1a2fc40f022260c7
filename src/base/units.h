// SPDX-License-Identifier: GPL-2.0-or-later
// Units written after a number in an SI scene ("10 um/s", "3 kPa", "1200 kg/m3", "1e4 Pa s").
// Called by scene/value and by who reads tables (io/text/csv_reader).
#ifndef AMONTONS_BASE_UNITS_H
#define AMONTONS_BASE_UNITS_H

#include <stdbool.h>

// Turns *value, given in the unit `suffix`, into SI base units. A suffix is a product of m, s, g,
// N, Pa, J, Hz, rad, bar (and min, h), each with an SI prefix (n u m c k M G) and an integer power
// ("m3", "m^3", "s-1"), separated by spaces, dots or `*`; after a `/` they divide. False: not a
// unit, or not one of `dimension`.
// dimension NULL: any will do. "-" and "1" are units of numbers without a dimension, "%" is 1/100.
bool unit_to_si(const char *suffix, const char *dimension, double *value);

// Finds how many of the unit `b` one of `a` is. Returns false where their dimensions differ.
bool unit_ratio(const char *a, const char *b, double *ratio);

// Returns the dimension by which a number in the unit `suffix` must be divided to become one of
// `dimension`: "area" for kN where a stress is wanted. *times: it must be multiplied by it instead.
// NULL: none is known.
const char *unit_quotient(const char *suffix, const char *dimension, bool *times);

// Units that fit, for an error message: "m, mm, um"; "" for a plain number ("1").
const char *unit_examples(const char *dimension);

#endif
