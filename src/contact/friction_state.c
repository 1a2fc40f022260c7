// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/friction_state.h"

bool friction_remembers(const FrictionLaw *law, int32_t count)
{
    for (int32_t i = 0; law->each && i < count; i++)
        if (friction_has_memory(&law->each[i])) return true;
    return friction_has_memory(law);
}

void friction_set_stage(FrictionLaw *law, double from, double reach)
{
    double ignored;
    if (!friction_has_memory(law)) return;
    law->own.memory.from = from;
    law->own.memory.reach = reach;
    law->mu_static = memory_coefficient(&law->own.memory, 0, &ignored);
}

double friction_state(const FrictionLaw *law, double speed)
{
    return friction_has_memory(law) ? memory_state(&law->own.memory, speed) : 0;
}

FrictionRates friction_rates(const FrictionLaw *law, double speed, double state)
{
    if (friction_has_memory(law)) return memory_rates(&law->own.memory, speed, state);
    return (FrictionRates){.mu = friction_coefficient(law, speed),
                           .mu_speed = friction_slope(law, speed)};
}

double friction_follow(const FrictionLaw *law, double velocity, double step)
{
    return memory_follow(&law->own.memory, velocity, step);
}

double friction_start_state(const FrictionLaw *law)
{
    return friction_has_memory(law) ? law->own.memory.start : 0;
}

double friction_shown_state(const FrictionLaw *law, double state)
{
    return friction_has_memory(law) ? memory_shown(&law->own.memory, state) : 0;
}
