// SPDX-License-Identifier: GPL-2.0-or-later
// Friction laws that need more than their numbers, as a scene makes them.
#ifndef AMONTONS_TESTS_OWN_LAWS_H
#define AMONTONS_TESTS_OWN_LAWS_H

#include "friction/friction_make.h"
#include "friction_by_hand.h"
#include "near.h"

#include <string.h>

// mu_static and its like, of the law that is made.
static inline bool own_number(const void *context, const char *name, double *value)
{
    const FrictionLaw *law = context;
    *value = strcmp(name, "mu_static") == 0           ? law->mu_static
             : strcmp(name, "mu_kinetic") == 0        ? law->mu_kinetic
             : strcmp(name, "critical_velocity") == 0 ? law->critical_velocity
                                                      : 0;
    return *value > 0;
}

static inline FrictionLaw own_law(FrictionLaw law, const FrictionSource *source)
{
    Error err = {0};
    const char *key = NULL;
    FrictionLaw given = law;
    FrictionSource full = *source;
    if (!full.look_up) full.look_up = own_number;
    if (!full.context) full.context = &given;
    if (!friction_make(&full, &law, &key, &err)) fail_msg("%s: %s", key, err.message);
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

// Cubics over ln v. mu_static 0: not given.
static inline FrictionLaw own_log_table(int32_t count, const double *velocity, const double *mu,
                                        double mu_static)
{
    FrictionSource source = {
        .velocity = velocity, .velocity_count = count, .mu = mu, .mu_count = count, .by_log = true};
    return own_law((FrictionLaw){.kind = FRICTION_TABLE, .mu_static = mu_static}, &source);
}

static inline FrictionLaw own_formula(const char *text, double end)
{
    FrictionSource source = {.formula = text, .end = end};
    return own_law((FrictionLaw){.kind = FRICTION_FORMULA}, &source);
}

// A built-in law with a state, whose contacts slip steadily at 1e-5.
static inline FrictionLaw law_with_state(FrictionLaw law)
{
    FrictionSource source = {.rod_velocity = 1e-5, .end = 1};
    return own_law(law, &source);
}

#endif
