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

// One of a certificate, about rung k or with a number.
typedef bool (*Question)(Certificate *certificate, const State *state, Ladder *ladder, int32_t k,
                         double number);

static bool ask(BothSides sides, const State *state, Question question, int32_t k, double number)
{
    HalfStep *half = sides.half;
    if (is_whole(sides)) return question(sides.whole, state, sides.ladder, k, number);
    const State *one = half_step_fold(half, state);
    bool yes = question(&half->even, one, sides.ladder, k, number);
    if (yes && !half->odd_decays) {
        sides.ladder->side = LADDER_ODD;
        yes = question(&half->odd, one, sides.ladder, k, number);
        sides.ladder->side = sides.ladder->half ? LADDER_EVEN : LADDER_WHOLE;
    }
    certificate_take_counts(sides.whole, &half->even);
    certificate_take_counts(sides.whole, &half->odd);
    return yes;
}

static bool resolves(Certificate *certificate, const State *state, Ladder *ladder, int32_t k,
                     double number)
{
    (void)number;
    ContactMatrix *rung = ladder_contact(ladder, k);
    return rung && certificate_step_resolves(certificate, state, rung, ladder_reach(ladder, k));
}

static bool finds_no_runaway(Certificate *certificate, const State *state, Ladder *ladder,
                             int32_t resolved, double number)
{
    (void)number;
    return !certificate_finds_runaway(certificate, state, ladder, resolved);
}

static bool oscillates_less(Certificate *certificate, const State *state, Ladder *ladder, int32_t k,
                            double growth)
{
    (void)k;
    return certificate_oscillates_less(certificate, state, ladder, growth);
}

static bool excludes_runaway(Certificate *certificate, const State *state, Ladder *ladder,
                             int32_t k, double number)
{
    (void)k;
    (void)number;
    return certificate_excludes_runaway(certificate, state, ladder);
}

bool both_sides_resolve(BothSides sides, const State *state, int32_t k)
{
    return ask(sides, state, resolves, k, 0);
}

bool both_sides_run_away(BothSides sides, const State *state, int32_t resolved)
{
    return !ask(sides, state, finds_no_runaway, resolved, 0);
}

bool both_sides_oscillate_less(BothSides sides, const State *state, double growth)
{
    return ask(sides, state, oscillates_less, -1, growth);
}

bool both_sides_exclude_runaway(BothSides sides, const State *state)
{
    return ask(sides, state, excludes_runaway, -1, 0);
}
