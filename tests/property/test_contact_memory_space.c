// SPDX-License-Identifier: GPL-2.0-or-later
// This asks test_contact_memory.c's questions in space, where sweeps are on at every step.
#define HAND_DIM 3
#define HAND_NODES 12
#define SWEEPS_ON true
#include "test_contact_memory.c"
