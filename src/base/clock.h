// SPDX-License-Identifier: GPL-2.0-or-later
// Wall time and processor time. Results never depend on them.
#ifndef AMONTONS_BASE_CLOCK_H
#define AMONTONS_BASE_CLOCK_H

double clock_seconds(void);   // monotonic, from an arbitrary origin: only differences count

// User and system, all threads, since the process began; with children that have ended, as the one
// that read a mesh.
double clock_processor_seconds(void);

#endif
