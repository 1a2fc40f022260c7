// SPDX-License-Identifier: GPL-2.0-or-later
// The exponents are those of the algorithms: with n unknowns on a mesh of two dimensions, of which
// m lie on the interface, a sparse factor has about n log n entries and takes n^1.5 operations; a
// basis takes some factors and products of n x m answers; it has some 3 m unknowns, a stage passes
// through a dense matrix of them, a rung factors one. The seconds before them were fitted to
// processor times of thirty shapes by validation/benchmark/choice.py.
#include "model/choice.h"

#include "model/step_rule.h"

#include <math.h>

// s, each for one of what its comment says.
static const double FULL_FACTOR = 1.45e-8;   // rung and n^1.5
static const double FULL_STAGE = 1.25e-8;   // stage and n log2 n: a pass down and one up
static const double FULL_BORDER = 3e-9;   // stage and m^2, on the mesh
static const double REDUCTION_ANSWERS = 3.1e-7;   // n m
static const double REDUCTION_PRODUCTS = 3e-10;   // n m^2
static const double REDUCED_RUNG = 8e-10;   // rung and m^3
static const double REDUCED_STAGE = 1.3e-9;   // stage and m^2

static const double RUNGS = 11;   // used by a run with a sliding

// Below that a basis is built in any case: what it might cost now the next run of the shape saves;
// s.
static const double NOT_WORTH_ASKING = 0.05;

// Bytes of memory for each entry of n x m, and in all.
static const double REDUCTION_BYTES = 36, REDUCTION_BYTES_MAX = 6e9;

// Of a run up to its first sliding, and of each sliding.
static const double STAGES_REST = 100, STAGES_SLIDING = 380;
static const double STAGES_STEP = 2;   // of SDIRK2
static const double PERIODIC_SLIDINGS = 8;   // after which a run that waits for it has its period

ExpectedCost choice_expect(const ChoiceSizes *sizes, const Processor *processor)
{
    double n = sizes->unknowns, m = sizes->interface, stages = sizes->stages;
    double factors = FULL_FACTOR * RUNGS * pow(n, 1.5) * processor->factor;
    double passes = (FULL_STAGE * n * log2(n) + FULL_BORDER * m * m) * processor->pass;
    double rungs = REDUCED_RUNG * RUNGS * m * m * m * processor->factor;
    double reduction = (REDUCTION_ANSWERS + REDUCTION_PRODUCTS * m) * n * m * processor->factor;
    return (ExpectedCost){.reduction = reduction,
                          .reduced = rungs + stages * REDUCED_STAGE * m * m * processor->pass,
                          .full = factors + stages * passes};
}

bool choice_reduces(const ChoiceSizes *sizes, const ExpectedCost *cost)
{
    if (sizes->held) return true;
    if (REDUCTION_BYTES * sizes->unknowns * sizes->interface > REDUCTION_BYTES_MAX) return false;
    return cost->reduction < NOT_WORTH_ASKING ||
           cost->reduction / sizes->runs + cost->reduced < cost->full;
}

// The block slides when the rod has moved mu_S times `way`, and again each time that it has moved
// the drop of mu times that.
static double count_slidings(const Scene *scene, double way)
{
    const FrictionLaw *law = &scene->friction;
    double drop = law->mu_static - law->mu_kinetic;
    double pushed = scene->rod.kind == ROD_NONE ? 0 : scene->rod.velocity * step_rule_end(scene);
    double beyond = pushed / way - law->mu_static;
    if (!(law->mu_static > 0) || !(beyond > 0)) return 0;
    double slidings = beyond / (drop > 0 ? drop : law->mu_static);
    if (scene->time.until_slidings > 0) slidings = fmin(slidings, scene->time.until_slidings);
    return scene->time.until_periodic ? fmin(slidings, PERIODIC_SLIDINGS) : slidings;
}

double choice_stages(const Scene *scene, double way)
{
    double longest = scene->time.step_max;   // 0: the program's, which is part of the others
    double least = longest > 0 ? STAGES_STEP * step_rule_end(scene) / longest : 0;
    return fmax(STAGES_REST + STAGES_SLIDING * count_slidings(scene, way), least);
}
