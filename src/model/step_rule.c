// SPDX-License-Identifier: GPL-2.0-or-later
// A driven model needs no step longer than the rod takes to move a part of the slip that the drop
// of friction drives. Levels of dt halve the longest step: it is raised so that the wave step,
// at which most steps are taken, is a level and not up to twice as long as the next one.
#include "model/step_rule.h"

#include "scene/programs.h"

#include <math.h>

static const double STEP_MAX_SLIP = 0.2;   // level 0: the drive moves this part of that slip, and
    // of what the machine yields meanwhile
static const double STEPS_LEAST_LIMIT = 50;   // without a rod a run has at least so many
static const double STEP_RANGE_LIMIT = 1e-10;   // step_min over step_max

// Time; 0 where the scene says neither.
double step_rule_end(const Scene *scene)
{
    double by_rod = scene->time.until_U > 0 ? scene->time.until_U / scene->rod.velocity : 0;
    double by_time = scene->time.until_t;
    if (by_rod > 0 && scene_has_program(&scene->rod.program)) {
        RodCourse course = scene_rod_course(scene);
        by_rod = rod_course_arrival(&course, scene->time.until_U);
    }
    if (by_rod > 0 && by_time > 0) return fmin(by_rod, by_time);
    return by_rod > 0 ? by_rod : by_time;
}

// relax_step is 0: it is the caller's. Keys of the scene replace what follows from sizes; before an
// explicit run, whose steps they mean, the block relaxes without them.
StepControlDef step_rule(const Scene *scene, const StepSizes *sizes)
{
    bool driven = scene->rod.kind != ROD_NONE;
    bool implicit = scene->time.scheme != SCHEME_EXPLICIT;   // the keys mean the scheme named
    double tolerance = scene->time.tolerance > 0 ? scene->time.tolerance : sizes->tolerance;
    StepControlDef def = {.tolerance = tolerance * sizes->slip,
                          .step_max = step_rule_end(scene) / STEPS_LEAST_LIMIT,
                          .wave_step = scene->time.wave_step * sizes->crossing,
                          .watch_time = scene->time.watch * sizes->crossing,
                          .energy_tolerance = scene->time.energy_tolerance,
                          .use_certificate = scene->time.certificate};
    if (driven) {
        Schedule program = scene_schedule(&scene->rod.program);
        double fastest = scene->rod.velocity * schedule_largest(&program);
        // A stiff block behind a stiff machine loses what it remembers over more than that slip.
        double way = fmax(sizes->slip + sizes->yield, sizes->memory);
        double longest = STEP_MAX_SLIP * way / fastest;
        def.step_max = def.wave_step * exp2(ceil(log2(longest / def.wave_step)));
    }
    if (implicit && scene->time.step_max > 0) def.step_max = scene->time.step_max;
    def.step_min = STEP_RANGE_LIMIT * fmin(def.step_max, def.wave_step);
    if (implicit && scene->time.step_min > 0) def.step_min = scene->time.step_min;
    return def;
}
