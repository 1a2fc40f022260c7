// SPDX-License-Identifier: GPL-2.0-or-later
// Programs of rod and load in a scene (rod.program, load.program) and output.window, as the
// definitions of the layers below. Used by model/step_rule, run/ and the checks of a scene.
#ifndef AMONTONS_SCENE_PROGRAMS_H
#define AMONTONS_SCENE_PROGRAMS_H

#include "contact/rod_course.h"
#include "record/observation.h"
#include "scene/scene.h"

static inline bool scene_has_program(const SceneProgram *program)
{
    return program->factor.count > 0;
}

// The table of a program; without one its factor is 1.
Schedule scene_schedule(const SceneProgram *program);

// The rod's drive as the scene has it.
RodCourse scene_rod_course(const Scene *scene);

// The part of the run that output.window names.
WindowDef scene_window(const Scene *scene);

#endif
