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

// One of a certificate, about a rung, the first of a range, or that range, and with a number.
typedef bool (*Question)(Certificate *certificate, const State *state, Ladder *ladder,
                         RungRange range, double number);

static bool ask(BothSides sides, const State *state, Question question, RungRange range,
                double number)
{
    HalfStep *half = sides.half;
    if (is_whole(sides)) return question(sides.whole, state, sides.ladder, range, number);
    const State *one = half_step_fold(half, state);
    bool yes = question(&half->even, one, sides.ladder, range, number);
    if (yes && !half->odd_decays) {
        sides.ladder->side = LADDER_ODD;
        yes = question(&half->odd, one, sides.ladder, range, number);
        sides.ladder->side = sides.ladder->half ? LADDER_EVEN : LADDER_WHOLE;
    }
    certificate_take_counts(sides.whole, &half->even);
    certificate_take_counts(sides.whole, &half->odd);
    return yes;
}

static bool resolves(Certificate *certificate, const State *state, Ladder *ladder, RungRange range,
                     double number)
{
    (void)number;
    ContactMatrix *rung = ladder_contact(ladder, range.first);
    double reach = ladder_reach(ladder, range.first);
    return rung && certificate_step_resolves(certificate, state, rung, reach);
}

static bool finds_no_runaway(Certificate *certificate, const State *state, Ladder *ladder,
                             RungRange range, double number)
{
    (void)number;
    return !certificate_finds_runaway(certificate, state, ladder, range.first);
}

static bool excludes_runaway(Certificate *certificate, const State *state, Ladder *ladder,
                             RungRange range, double number)
{
    (void)number;
    return certificate_excludes_runaway(certificate, state, ladder, range);
}

bool both_sides_resolve(BothSides sides, const State *state, int32_t k)
{
    return ask(sides, state, resolves, (RungRange){k, k + 1}, 0);
}

bool both_sides_run_away(BothSides sides, const State *state, int32_t resolved)
{
    return !ask(sides, state, finds_no_runaway, (RungRange){resolved, resolved + 1}, 0);
}

bool both_sides_oscillate_less(BothSides sides, const State *state, RungRange range, double growth)
{
    return ask(sides, state, certificate_oscillates_less, range, growth);
}

bool both_sides_exclude_runaway(BothSides sides, const State *state, RungRange range)
{
    return ask(sides, state, excludes_runaway, range, 0);
}
