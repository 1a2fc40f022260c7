// SPDX-License-Identifier: GPL-2.0-or-later
// Friction of a law alone, without a scene or a contact.
#ifndef AMONTONS_TESTS_FRICTION_BY_HAND_H
#define AMONTONS_TESTS_FRICTION_BY_HAND_H

#include "friction/friction.h"

// A node with this law, and a contact of such nodes; the law must outlive them.
#define NODE_OF(one) (&(FrictionNode){.law = (one), .factor = 1})
#define FRICTION_OF(one) friction_everywhere(friction_node((one), 1))

#endif
