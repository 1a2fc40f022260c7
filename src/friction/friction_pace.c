// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_pace.h"

FrictionLaw friction_paced(const FrictionLaw *law, double pace)
{
    FrictionLaw paced = *law;
    if (!law->remembers) return paced;
    FrictionMemory *memory = &paced.own.memory;
    memory->reference_velocity *= pace;
    memory->healing_time /= pace;
    memory->start[0] = friction_paced_state(law, memory->start[0], pace);
    return paced;
}

// theta of `ageing` is a time; psi and phi are pure numbers.
double friction_paced_state(const FrictionLaw *law, double state, double pace)
{
    return law->kind == FRICTION_AGEING ? state / pace : state;
}
