// SPDX-License-Identifier: GPL-2.0-or-later
// A path of four points on which nothing grows, for tests that change it.
#ifndef AMONTONS_TESTS_PATH_BY_HAND_H
#define AMONTONS_TESTS_PATH_BY_HAND_H

#include "study/stability/stability.h"

#include "friction_by_hand.h"
#include "near.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { NODES = 11, POINTS = 4 };

typedef struct Rig {
    double x[NODES];
    int32_t pads[NODES];
    Scene scene;
    FrictionLaw law;   // everywhere
    Model model;
    StabilityOptions options;
    StabilityPoint points[POINTS];
    StabilityPath path;
    StabilitySummary summary;
} Rig;

// A block of length 2 whose front passes a node, 0.2, from point to point. Nothing grows.
static inline void start(Rig *rig)
{
    *rig = (Rig){.scene = {.rod.velocity = 1e-4}};
    for (int32_t i = 0; i < NODES; i++) rig->x[i] = 0.2 * i;
    rig->model = (Model){.scene = &rig->scene, .length = 2};
    rig->law = (FrictionLaw){.critical_velocity = 1e-3};
    rig->model.friction = FRICTION_OF(&rig->law);
    rig->model.interface = (Interface){
        .dim = 2, .contact_count = NODES, .x = rig->x, .pad = rig->pads, .pad_count = 1};
    for (int32_t k = 0; k < POINTS; k++)
        rig->points[k] = (StabilityPoint){.front = 0.2 + 0.2 * k,
                                          .slipping = 2 + k,
                                          .U = 0.1 * k,
                                          .mu = 0.2 + 0.05 * k,
                                          .mu_at_V = 0.19 + 0.05 * k,
                                          .rate_re = -1,
                                          .rate_im = 4,
                                          .load = 0.5,
                                          .certified = true};
    rig->path = (StabilityPath){.options = &rig->options,
                                .model = &rig->model,
                                .count = POINTS,
                                .points = rig->points,
                                .mu_snap = NAN};
}

#endif
