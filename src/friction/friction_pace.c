// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_pace.h"

bool friction_weakens_at_once(const FrictionLaw *law)
{
    if (!law->remembers || law->own.memory.creeps) return false;
    return law->kind == FRICTION_AGEING || law->steepest > 0;   // one's own: by friction_start
}

FrictionLaw friction_paced(const FrictionLaw *law, double pace)
{
    FrictionLaw paced = *law;
    if (!law->remembers) return paced;
    FrictionMemory *memory = &paced.own.memory;
    memory->paced = memory->kind;
    memory->kind = MEMORY_PACED;
    memory->pace = pace;
    memory->mu_pace = friction_weakens_at_once(law) ? 1 : pace;
    return paced;
}
