// SPDX-License-Identifier: GPL-2.0-or-later
// The two ends of a bulk's range of inertia, normalised as reduction/reduction has it. Called by
// reduction/reduction and reduction/far_field.
#ifndef AMONTONS_REDUCTION_INERTIAS_H
#define AMONTONS_REDUCTION_INERTIAS_H

#include "reduction/interface_operator.h"

// At which the slowest mode of the interior is in balance, K x = slowest M x. statics: `full` at
// K/E alone.
bool inertia_slowest(const BulkOperator *full, const BulkScales *scales, InterfaceOperator *statics,
                     double *slowest, Error *err);

// At which inertia takes over within one element: the largest K_jj / M_jj of the interface.
double inertia_element(const Bulk *bulk, const BulkScales *scales, const int32_t *interface_dofs,
                       int32_t interface_count);

#endif
