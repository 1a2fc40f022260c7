// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/both_sides.h"

#include <stddef.h>

static bool is_whole(BothSides sides)
{
    return sides.ladder->side == LADDER_WHOLE;
}

bool both_sides_hold(BothSides sides, const State *state, double reach, bool *odd_decays)
{
    HalfStep *half = sides.half;
    *odd_decays = false;
    if (is_whole(sides)) return certificate_holds(sides.whole, state, reach);
    const State *one = half_step_fold(half, state);
    half->odd_decays = *odd_decays = certificate_holds(&half->odd, one, reach);
    bool holds = certificate_holds(&half->even, one, reach);
    certificate_take_counts(sides.whole, &half->even);
    certificate_take_counts(sides.whole, &half->odd);
    return holds && *odd_decays;
}

// The answer of one certificate.
static bool answer(Certificate *certificate, const State *state, Ladder *ladder,
                   BothSidesAsked asked, RungRange range, double growth)
{
    int32_t k = range.first;
    switch (asked) {
    case SIDES_RESOLVE: {
        ContactMatrix *rung = ladder_contact(ladder, k);
        return rung && certificate_step_resolves(certificate, state, rung, ladder_reach(ladder, k));
    }
    case SIDES_FIND_NO_RUNAWAY:
        return !certificate_finds_runaway(certificate, state, ladder, k);
    case SIDES_OSCILLATE_LESS:
        return certificate_oscillates_less(certificate, state, ladder, range, growth);
    case SIDES_EXCLUDE_RUNAWAY:
        return certificate_excludes_runaway(certificate, state, ladder, range);
    }
    return false;
}

bool both_sides_ask(BothSides sides, const State *state, BothSidesAsked asked, RungRange range,
                    double growth)
{
    HalfStep *half = sides.half;
    Ladder *ladder = sides.ladder;
    if (is_whole(sides)) return answer(sides.whole, state, ladder, asked, range, growth);
    const State *one = half_step_fold(half, state);
    bool yes = answer(&half->even, one, ladder, asked, range, growth);
    if (yes && !half->odd_decays) {
        ladder->side = LADDER_ODD;
        yes = answer(&half->odd, one, ladder, asked, range, growth);
        ladder->side = ladder->half ? LADDER_EVEN : LADDER_WHOLE;
    }
    certificate_take_counts(sides.whole, &half->even);
    certificate_take_counts(sides.whole, &half->odd);
    return yes;
}
