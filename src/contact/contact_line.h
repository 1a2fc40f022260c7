// SPDX-License-Identifier: GPL-2.0-or-later
// The contact as a line along the drive. In the plane its nodes stand one behind the other. In space
// those along its middle are such a line: fronts, and how far slip reaches, are read off it; what
// lies beside it counts by its area.
#ifndef AMONTONS_CONTACT_CONTACT_LINE_H
#define AMONTONS_CONTACT_CONTACT_LINE_H

#include "contact/interface.h"

// Fills interface->line, in space; the places, weights and count of its nodes are there.
bool contact_line_find(Interface *interface, Error *err);

#endif
