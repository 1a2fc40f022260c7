// SPDX-License-Identifier: GPL-2.0-or-later
// The drops of one kind as a series, and the one before which slip was resolved worst.
#ifndef AMONTONS_ANSWERS_DROP_SERIES_H
#define AMONTONS_ANSWERS_DROP_SERIES_H

#include "record/drops.h"

// So many cells must slip before slow slip turns fast for mu to be sure; measured: run/warnings.
enum { SLIP_CELLS_ENOUGH = 8 };

// mu of the drops of one kind from number `first` of the list on, into drops->series, their kind
// the number of pads that slid, with the contact's state. Returns how many they are.
int32_t drops_series(const Drops *drops, DropKind kind, int32_t first);
// Among the load drops from number `first` of the list on, finds the event before which the fewest
// cells slipped on the pad where slow slip turned fast; NULL: no such drop.
const Event *drops_least_resolved(const Drops *drops, int32_t first);

#endif
