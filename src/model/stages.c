// SPDX-License-Identifier: GPL-2.0-or-later
// Sliding at the rod's velocity V, the drive of mass M, yield y and damping C with the weakening
// W = -mu'(V) F_N is an oscillator, M x'' + (C - W) x' + x/y = 0:
//
//   * C well above W: it slides on without load drops, and steps become as long as they may;
//   * W above C, slip runs away: mu falls by about mu_S - mu_K, over and over;
//   * W above C by less than 2 sqrt(M/y): slip grows by exp(pi zeta / sqrt(1 - zeta^2)) in half a
//     period, zeta = (W - C)/(2 sqrt(M/y)), sticks and begins anew. At slow V these drops are far
//     smaller than mu_S - mu_K, and there are as many more of them.
//
// The constants were fitted to the runs of every other problem of validation/strangers, and judged
// by the others (its README).
#include "model/stages.h"

#include "model/step_rule.h"

#include <math.h>

// Force and h/L over E: less than the 3.2 of a block that is held below, fitted with model/choice.
static const double SHEAR_YIELD = 2;

// Of a run up to its first sliding; of steady sliding, however long; of each small oscillation.
static const double STAGES_REST = 100, STAGES_STEADY = 640, STAGES_CYCLE = 20;
// Of each sliding, at V = v_c and without damping. The slower the rod, the longer the way through
// states that are not certified; what is damped slides less far.
static const double STAGES_SLIDING = 240, BY_SLOWNESS = 0.25, BY_RUNAWAY = 1.0 / 3;
static const double RUNAWAY_LEAST = 0.05;
// Of each contact node in each sliding on a floor that is so soft that waves through it are slower
// than along the block: slip is slow and not certified there on most of its way, and followed.
static const double STAGES_WATCHED = 100;
static const double STAGES_STEP = 2;   // of SDIRK2
static const double PERIODIC_SLIDINGS = 8;   // after which a run that waits for it has its period

// C/W from which a block slides on; up to which W - C is known well enough to count oscillations.
static const double STEADY_FROM = 1.65, CYCLES_UP_TO = 0.5;

// What the rod pushes: the largest region, where the block stands on another, smaller one; else the
// mean of all.
static const Material *pushed_material(const Model *model)
{
    const Materials *materials = &model->materials;
    int32_t largest = 0;
    for (int32_t k = 1; k < materials->count; k++)
        if (materials->area[k] > materials->area[largest]) largest = k;
    bool other = materials->count > 1 && largest != model->contact_region;
    return other ? &materials->list[largest] : &materials->mean;
}

// A bar on friction is compressed by a force that falls along it; below the rod it is sheared and,
// as a beam that stands on the floor, bent.
static double block_yield(const Model *model)
{
    double length = model->length, height = model->height, middle, width;
    model_rod_strip(model->scene, height, &middle, &width);
    double slender = middle / length;
    double yield = 0.5 * length / height + SHEAR_YIELD * slender + 4 * pow(slender, 3);
    return yield / (pushed_material(model)->young * model->breadth);
}

// What touches the floor is a layer, or pads, of a material of its own: sheared over its height.
static double floor_yield(const Model *model)
{
    const Materials *materials = &model->materials;
    int32_t region = model->contact_region;
    const Material *material = &materials->list[region];
    double touching = 0, width = materials->width[region];
    for (int32_t i = 0; i < model->interface.contact_count; i++)
        touching += model->interface.weight[i];
    if (materials->count == 1 || !(width > 0) || !(touching > 0)) return 0;
    double shear = material->young / (2 * (1 + material->poisson));
    return materials->area[region] / width / (shear * touching);
}

Drive stages_drive(const Model *model)
{
    const Material *pushed = pushed_material(model);
    const Material *floor = &model->materials.list[model->contact_region];
    double stiffness = model_machine(model).stiffness;
    double block = block_yield(model), layer = floor_yield(model);
    double yield = block + layer + (stiffness > 0 ? 1 / stiffness : 0);
    double damped = block * pushed->eta1 / pushed->young + layer * floor->eta1 / floor->young;
    double slope = friction_slope(&model->law, model->scene->rod.velocity);
    return (Drive){.load = model->scales.load,
                   .yield = yield,
                   .damping = damped / (yield * yield),
                   .mass = model->materials.mean.density * model->length * model->breadth *
                           model->height,
                   .watched = model_floor_is_slow(model) ? model->interface.contact_count : 0,
                   .weakening = -slope * model->scales.load};
}

// The block slides when the rod has moved mu_S times its way, and again each time that it has moved
// `drop` times that.
static double count_slidings(const Scene *scene, const Drive *drive, double drop)
{
    double pushed = scene->rod.kind == ROD_NONE ? 0 : scene->rod.velocity * step_rule_end(scene);
    double beyond = pushed / (drive->load * drive->yield) - scene->friction.mu_static;
    if (!(drop > 0) || !(beyond > 0)) return 0;
    double slidings = beyond / drop;
    if (scene->time.until_slidings > 0) slidings = fmin(slidings, scene->time.until_slidings);
    return scene->time.until_periodic ? fmin(slidings, PERIODIC_SLIDINGS) : slidings;
}

// By how much mu falls in one of the oscillations that grow too slowly to run away; 0: none do.
static double cycle_drop(const Scene *scene, const Drive *drive)
{
    double impedance = sqrt(drive->mass / drive->yield);
    double zeta = (drive->weakening - drive->damping) / (2 * impedance);
    if (!(zeta < 1) || drive->damping > CYCLES_UP_TO * drive->weakening) return 0;
    double growth = exp(M_PI * zeta / sqrt(1 - zeta * zeta));
    return scene->rod.velocity * (1 + growth) * impedance / drive->load;
}

static double sliding_stages(const Scene *scene, const Drive *drive)
{
    const FrictionLaw *law = &scene->friction;
    double drop = law->mu_static - law->mu_kinetic;
    double slidings = count_slidings(scene, drive, drop > 0 ? drop : law->mu_static);
    double damped = drive->damping / drive->weakening;   // over weakening
    if (slidings == 0) return 0;
    if (!(drive->weakening > 0) || damped > STEADY_FROM)
        return fmin(slidings * STAGES_SLIDING, STAGES_STEADY);
    double slowness = fmax(law->critical_velocity / scene->rod.velocity, 1);
    double each = STAGES_SLIDING * pow(slowness, BY_SLOWNESS) *
                      pow(fmax(1 - damped, RUNAWAY_LEAST), BY_RUNAWAY) +
                  STAGES_WATCHED * drive->watched;
    double cycles = count_slidings(scene, drive, cycle_drop(scene, drive));
    return fmax(each * slidings, STAGES_CYCLE * cycles);
}

double stages_expect(const Scene *scene, const Drive *drive)
{
    double longest = scene->time.step_max;   // 0: the program's, which is part of the others
    double least = longest > 0 ? STAGES_STEP * step_rule_end(scene) / longest : 0;
    return fmax(STAGES_REST + sliding_stages(scene, drive), least);
}
