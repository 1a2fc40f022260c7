// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/programs.h"

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
