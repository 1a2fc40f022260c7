// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef AMONTONS_TESTS_PAPER_MATERIAL_H
#define AMONTONS_TESTS_PAPER_MATERIAL_H

#include "fem/material.h"

// The paper's set A, normalised, in plane stress.
static inline Material paper_material(void)
{
    return (Material){.young = 1, .poisson = 0.34, .density = 1, .eta1 = 1, .eta2 = 1};
}

#endif
