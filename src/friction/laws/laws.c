// SPDX-License-Identifier: GPL-2.0-or-later
// The tables of operations by kind, in the order of FRICTION_LAWS.
#include "friction/laws/law.h"

const FrictionOperations *const FRICTION_OPERATIONS[] = {
#define X(symbol, name, operations) [symbol] = &operations,
    FRICTION_LAWS(X)
#undef X
};
