// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/programs.h"

#include <math.h>
#include <string.h>

_Static_assert((int)SCENE_NUMBERS_MAX <= (int)SCHEDULE_POINTS_MAX, "a schedule is too short");

Schedule scene_schedule(const SceneProgram *program)
{
    const SceneNumbers *at = program->U.count > 0 ? &program->U : &program->t;
    Schedule schedule = {.count = program->factor.count, .repeats = program->repeat};
    memcpy(schedule.at, at->value, sizeof at->value);
    memcpy(schedule.factor, program->factor.value, sizeof program->factor.value);
    return schedule;
}

RodCourse scene_rod_course(const Scene *scene)
{
    Schedule table = scene_schedule(&scene->rod.program);
    return rod_course(&table, scene->rod.program.U.count > 0, scene->rod.velocity);
}

WindowDef scene_window(const Scene *scene)
{
    const SceneWindow *window = &scene->output.window;
    WindowDef def = {.from_U = window->from_U,
                     .to_U = window->to_U > 0 ? window->to_U : INFINITY,
                     .from_t = window->from_t,
                     .to_t = window->to_t > 0 ? window->to_t : INFINITY};
    def.given = def.from_U > 0 || def.from_t > 0 || isfinite(def.to_U) || isfinite(def.to_t);
    return def;
}
