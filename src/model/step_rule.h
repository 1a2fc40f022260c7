// SPDX-License-Identifier: GPL-2.0-or-later
// Which steps a scene is given, from its keys and a few sizes of the model. Called by run/start and
// run/accuracy for the block and by study/line/steps for the line.
#ifndef AMONTONS_MODEL_STEP_RULE_H
#define AMONTONS_MODEL_STEP_RULE_H

#include "scene/scene.h"
#include "stepping/step_control.h"

typedef struct StepSizes {
    double slip;   // that the drop of friction drives, (mu_S - mu_K) p H / E, length
    double yield;   // of the machine at that drop, (mu_S - mu_K) F_N / k; 0: rigid; length
    double memory;   // over which friction loses what it remembers, D_c; 0: nothing; length
    double crossing;   // of the model by a longitudinal wave, L / c_L, time
    double tolerance;   // of the local error over `slip`, where the scene has no time.tolerance
} StepSizes;

// Time when the scene ends, by time.until.U or time.until.t, whichever comes first.
double step_rule_end(const Scene *scene);

// Tolerance, longest, shortest and wave-resolving step and watch; relaxing is the caller's.
StepControlDef step_rule(const Scene *scene, const StepSizes *sizes);

#endif
