// SPDX-License-Identifier: GPL-2.0-or-later
// Work in two halves that know nothing of each other, on two cores where there are two. What comes
// out does not depend on whether a second thread was to be had. Called by base/sparse,
// base/largest_eigen, base/dense_threaded and several of reduction/.
#ifndef AMONTONS_BASE_SHARE_H
#define AMONTONS_BASE_SHARE_H

#include <stdint.h>

// Calls half(context, 0) here and half(context, 1) in a thread; returns when both are done.
void share_in_two(void (*half)(void *context, int32_t which), void *context);

#endif
