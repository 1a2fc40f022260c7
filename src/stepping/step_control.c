// SPDX-License-Identifier: GPL-2.0-or-later
// The rung follows the error as dt ~ error^(-1/3), the order of the estimate (Hairer and Wanner,
// Solving ODEs II, IV.8), rounded down to the ladder.
#include "stepping/step_control.h"

#include <math.h>

// A longer step is tried only when its error is expected to be this fraction of the tolerance.
static const double SAFETY = 0.5;
static const double ESTIMATE_ORDER = 3;

// A step may leave the first part of what it turned over unaccounted, in units of the ledger's
// tolerance; or the second part of all that was turned over so far. Nothing is asked of steps below
// the third part of the wave step: what hits something loses the energy of the nodes that hit,
// however short the step, and shorter ones only drive the force of the blow up.
static const double STEP_BALANCE = 0.5, TOTAL_BALANCE = 1e-4, SHORTEST_BALANCED = 0.25;

// A rung that slip outgrew is not tried again for a while, twice as long each time: it would fail
// again. Without this half of all steps were repeated where growth limits the step (set B).
enum { HOLD_FIRST = 4, HOLD_MAX = 256 };

bool step_control_create(const Block *block, const StepControlDef *def, StepControl *control,
                         Error *err)
{
    *control = (StepControl){.def = *def, .certified = true};
    double longest = def->step_max;
    while (longest < def->relax_step) longest *= 2;   // so that step_max is a rung
    ladder_init(block->system, longest, def->step_min, &control->ladder);
    TRY(sdirk2_create(block, &control->ladder, &control->scheme, err));
    TRY(certificate_create(block, &control->certificate, err));
    TRY(state_create(block->system, block->interface, &control->now, err));
    TRY(state_create(block->system, block->interface, &control->next, err));
    step_control_restart(control);
cleanup:
    return error_is_clean(err);
}

void step_control_destroy(StepControl *control)
{
    ladder_destroy(&control->ladder);
    sdirk2_destroy(&control->scheme);
    certificate_destroy(&control->certificate);
    state_destroy(&control->now);
    state_destroy(&control->next);
    *control = (StepControl){0};
}

void step_control_restart(StepControl *control)
{
    control->now.time = 0;
    control->counters = (StepCounters){0};
    for (int32_t k = 0; k < LADDER_RUNGS_MAX; k++) control->ladder.accepted[k] = 0;
    control->ledger = energy_open(&control->now);
    control->coarsest = ladder_find(&control->ladder, control->def.step_max);
    int32_t first =
        ladder_find(&control->ladder, fmin(control->def.wave_step, control->def.step_max));
    control->rung = first < control->ladder.rung_count ? first : control->ladder.rung_count - 1;
}

typedef enum Verdict {
    STEP_ACCEPTED,
    STEP_UNSOLVED,
    STEP_INACCURATE,
    STEP_UNBALANCED,
    STEP_UNCERTIFIED
} Verdict;

// The ledger after the step under trial.
static EnergyLedger book_step(const StepControl *control, int32_t k, const StepOutcome *outcome)
{
    EnergyLedger ledger = control->ledger;
    sdirk2_add_energy(outcome, ladder_step(&control->ladder, k), &ledger);
    energy_store(&control->next, &ledger);
    return ledger;
}

static bool step_balances(const StepControl *control, int32_t k, const StepOutcome *outcome)
{
    double tolerance = control->def.energy_tolerance;
    bool short_enough = ladder_step(&control->ladder, k) <
                        SHORTEST_BALANCED * control->def.wave_step;
    if (tolerance == 0 || short_enough) return true;
    EnergyLedger before = control->ledger, after = book_step(control, k, outcome);
    double missing = fabs(energy_imbalance(&after) - energy_imbalance(&before));
    if (missing <= TOTAL_BALANCE * tolerance * energy_turnover(&after)) return true;
    return missing <= STEP_BALANCE * tolerance * energy_turned_over(&before, &after);
}

static Verdict judge_step(StepControl *control, int32_t k, const StepOutcome *outcome,
                          bool *certified)
{
    *certified = true;
    if (!outcome->solved || !isfinite(outcome->error)) return STEP_UNSOLVED;
    if (outcome->error > control->def.tolerance) return STEP_INACCURATE;
    // Where no shorter step is left the run's own ledger decides (run/simulation).
    bool last = k + 1 >= control->ladder.rung_count;
    if (!last && !step_balances(control, k, outcome)) return STEP_UNBALANCED;
    if (!control->def.use_certificate) return STEP_ACCEPTED;
    *certified = certificate_holds(&control->certificate, &control->next);
    if (*certified) return STEP_ACCEPTED;
    if (ladder_step(&control->ladder, k) > control->def.wave_step * (1 + 1e-12))
        return STEP_UNCERTIFIED;
    if (!certificate_step_resolves(&control->certificate, &control->next, control->ladder.rung[k]))
        return STEP_UNCERTIFIED;
    return STEP_ACCEPTED;
}

// The rung after a rejection: at least one further down.
static int32_t smaller_rung(const StepControl *control, int32_t k, Verdict verdict,
                            const StepOutcome *outcome)
{
    int32_t target = k + 1;
    if (verdict == STEP_INACCURATE) {
        double shrink = pow(SAFETY * control->def.tolerance / outcome->error, 1 / ESTIMATE_ORDER);
        target = ladder_find(&control->ladder, ladder_step(&control->ladder, k) * shrink);
    }
    if (verdict == STEP_UNCERTIFIED) target = ladder_find(&control->ladder, control->def.wave_step);
    return target > k ? target : k + 1;
}

static void hold_rung(StepControl *control)
{
    control->hold = control->hold == 0 ? HOLD_FIRST : 2 * control->hold;
    if (control->hold > HOLD_MAX) control->hold = HOLD_MAX;
    control->hold_end = control->counters.accepted + control->hold;
}

// The rung after an accepted step: one up when the error allows it and the certificate does.
static int32_t next_rung(const StepControl *control, int32_t k, double error, bool retried)
{
    double stretch = control->def.growth_max;
    double expected = error * pow(stretch, ESTIMATE_ORDER);
    bool held = control->counters.accepted < control->hold_end;
    bool grows = !retried && !held && k > control->coarsest &&
                 expected < SAFETY * control->def.tolerance;
    int32_t next = grows ? k - 1 : k;
    if (control->certified) return next;
    int32_t wave_rung = ladder_find(&control->ladder, control->def.wave_step);
    return next > wave_rung ? next : wave_rung;
}

// The coarsest built rung that does not overshoot; the chosen one when none is.
static int32_t fit_rung(const StepControl *control, int32_t k, double remaining)
{
    const Ladder *ladder = &control->ladder;
    remaining *= 1 + 1e-9;   // rounding must not cost the last step
    if (ladder_step(ladder, k) <= remaining) return k;
    for (int32_t fit = k + 1; fit < ladder->rung_count; fit++) {
        if (ladder->rung[fit] && ladder_step(ladder, fit) <= remaining) return fit;
    }
    return k;
}

bool step_control_fits(const StepControl *control, double remaining)
{
    const Ladder *ladder = &control->ladder;
    for (int32_t k = ladder->rung_count - 1; k >= 0; k--) {
        if (ladder->rung[k]) return ladder_step(ladder, k) <= remaining * (1 + 1e-9);
    }
    return remaining > 0;
}

// Looks for real growth in `now` on the rungs that are built: some small factorisations, so only
// when the slip set is larger than all that were looked at since the last certified state.
static void scan_growth(StepControl *control)
{
    int32_t slipping = 0;
    for (int32_t i = 0; i < control->now.contact_count; i++)
        slipping += control->now.status[i] != CONTACT_STICK;
    if (control->certified) {
        control->grows = false;
        control->scanned = 0;
    }
    if (control->certified || slipping <= control->scanned) return;
    control->scanned = slipping;
    control->grows = false;
    for (int32_t k = 0; k < control->ladder.rung_count && !control->grows; k++) {
        const InterfaceOperator *rung = control->ladder.rung[k];
        control->grows = rung &&
                         !certificate_step_resolves(&control->certificate, &control->now, rung);
    }
}

static void accept_step(StepControl *control, int32_t k, const StepOutcome *outcome)
{
    control->ledger = book_step(control, k, outcome);
    State accepted = control->next;
    control->next = control->now;
    control->now = accepted;
    control->outcome = *outcome;
    control->last_step = ladder_step(&control->ladder, k);
    control->counters.accepted++;
    control->ladder.accepted[k]++;
}

bool step_control_advance(StepControl *control, double remaining, Error *err)
{
    static const char *const reasons[] = {
        [STEP_ACCEPTED] = "",
        [STEP_UNSOLVED] = "its contact problem has no solution that could be found",
        [STEP_INACCURATE] = "its local error is above the tolerance",
        [STEP_UNBALANCED] = "its energies do not balance",
        [STEP_UNCERTIFIED] = "slip grows faster than it resolves"};
    StepCounters *counters = &control->counters;
    int32_t k = fit_rung(control, control->rung, remaining);
    bool shortened = k != control->rung, retried = false, certified = true;
    for (;;) {
        StepOutcome outcome;
        TRY(sdirk2_step(&control->scheme, k, &control->now, &control->next, &outcome, err));
        Verdict verdict = judge_step(control, k, &outcome, &certified);
        if (verdict == STEP_ACCEPTED) {
            control->certified = certified;
            if (certified) control->hold = control->hold_end = 0;
            accept_step(control, k, &outcome);
            scan_growth(control);
            if (!shortened || retried)
                control->rung = next_rung(control, k, outcome.error, retried);
            break;
        }
        counters->unsolved += verdict == STEP_UNSOLVED;
        counters->rejected_error += verdict == STEP_INACCURATE;
        counters->rejected_energy += verdict == STEP_UNBALANCED;
        counters->rejected_uncertified += verdict == STEP_UNCERTIFIED;
        retried = true;
        if (verdict == STEP_UNCERTIFIED || verdict == STEP_UNBALANCED) hold_rung(control);
        k = smaller_rung(control, k, verdict, &outcome);
        if (k >= control->ladder.rung_count)
            FAIL(err, ERROR_COMPUTE, "at t = %.9g the step went below time.step_min = %g: %s",
                 control->now.time, control->def.step_min, reasons[verdict]);
    }
cleanup:
    return error_is_clean(err);
}
