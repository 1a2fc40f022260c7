// SPDX-License-Identifier: GPL-2.0-or-later
// Wall time. Results never depend on it.
#ifndef AMONTONS_BASE_CLOCK_H
#define AMONTONS_BASE_CLOCK_H

double clock_seconds(void);   // monotonic, from an arbitrary origin

#endif
