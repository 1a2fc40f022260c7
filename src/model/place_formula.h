// SPDX-License-Identifier: GPL-2.0-or-later
// Formulas of a place in the contact, such as friction.along and contact.gap: of x, in space also
// of y. Used by model/gaps and model/node_laws.
#ifndef AMONTONS_MODEL_PLACE_FORMULA_H
#define AMONTONS_MODEL_PLACE_FORMULA_H

#include "base/formula.h"

// Its value along x where it is made for; y: NULL in the plane, where there is no such name.
bool place_formula_read(const char *text, const double *y, Formula *formula, Error *err);

#endif
