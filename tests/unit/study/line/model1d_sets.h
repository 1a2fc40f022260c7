// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's parameter sets for the 1D model, written out from its text.
#ifndef AMONTONS_TESTS_MODEL1D_SETS_H
#define AMONTONS_TESTS_MODEL1D_SETS_H

#include "near.h"
#include "study/line/model1d.h"

// E = rho = eta1 = eta2 = 1, d = H/L = 0.5, h = H/2, alpha = 0.2.
static inline Model1d paper_model(double poisson, FrictionLaw law, double pressure, double length)
{
    double confined = 1 / ((1 + poisson) * (1 - poisson));
    return (Model1d){.length = length,
                     .height = length / 2,
                     .drive = length / 4,
                     .alpha = 0.2,
                     .density = 1,
                     .elastic_x = confined,
                     .elastic_shear = 1 / (2 * (1 + poisson)),
                     .viscous_x = 2,
                     .viscous_shear = 0.5,
                     .pressure = pressure,
                     .velocity = 0.03 * law.critical_velocity,
                     .young = 1,
                     .speed = sqrt(confined),
                     .law = law};
}

static inline Model1d set_a(double pressure, double length)
{
    FrictionLaw law = {.kind = FRICTION_LINEAR_WEAKENING,
                       .mu_static = 0.38,
                       .mu_kinetic = 0.1,
                       .critical_velocity = 3.4e-4};
    return paper_model(0.34, law, pressure, length);
}

static inline Model1d set_b(double pressure, double length)
{
    FrictionLaw law = {.kind = FRICTION_LINEAR_WEAKENING,
                       .mu_static = 1.2,
                       .mu_kinetic = 0.2,
                       .critical_velocity = 3.9e-7};
    return paper_model(0.4, law, pressure, length);
}

#endif
