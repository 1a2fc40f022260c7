// SPDX-License-Identifier: GPL-2.0-or-later
// Friction laws of one's own, as a scene makes them.
#ifndef AMONTONS_TESTS_OWN_LAWS_H
#define AMONTONS_TESTS_OWN_LAWS_H

#include "contact/friction_look.h"
#include "contact/friction_make.h"
#include "near.h"

static inline FrictionLaw own_law(FrictionLaw law, const FrictionSource *source)
{
    Error err = {0};
    const char *key = NULL;
    if (!friction_own_law(source, &law, &key, &err) || !friction_look(&law, &err))
        fail_msg("%s: %s", key, err.message);
    return law;
}

static inline FrictionLaw own_table(int32_t count, const double *velocity, const double *mu,
                                    bool straight)
{
    FrictionSource source = {.velocity = velocity,
                             .velocity_count = count,
                             .mu = mu,
                             .mu_count = count,
                             .straight = straight};
    return own_law((FrictionLaw){.kind = FRICTION_TABLE}, &source);
}

static inline FrictionLaw own_formula(const char *text, double end)
{
    FrictionSource source = {.formula = text, .end = end};
    return own_law((FrictionLaw){.kind = FRICTION_FORMULA}, &source);
}

#endif
