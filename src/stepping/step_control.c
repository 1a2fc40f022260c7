// SPDX-License-Identifier: GPL-2.0-or-later
// The level follows the error as dt ~ error^(-1/(p + 1)), p the scheme's order (Hairer and Wanner,
// Solving ODEs II, IV.8), rounded down to the levels of dt.
//
// A trial costs the scheme's stages and, in a state that is not certified, some small
// factorisations. What is undone is only `next`: `now` is not touched before a step is accepted,
// and accepting swaps the two.
#include "stepping/step_control.h"

#include "algebra/dense.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

// A longer step is tried only when its error is expected to be this fraction of the tolerance.
static const double SAFETY = 0.5;

// Numerics may use up this part of what the ledger of a run may miss: a step that would take more
// is taken shorter, down to the longest that resolves waves. (What hits something loses the energy
// of the nodes that hit, however short the step; still shorter ones only drive the force of the
// blow up.)
static const double LEDGER_SHARE = 0.5;

// Levels down from a long step into a state that is not certified, at most as far as waves are
// resolved: where slip first goes too far is closed in on by eighths.
enum { UNCERTIFIED_DROP = 3 };

// Part of v_c that oscillations may reach to be stepped over unseen. 0.01 keeps a rod at v_c/30, as
// in the paper, out of it: with 0.03 the second peak of Figure 1's block moved by up to 1 %.
static const double SMALL_OSCILLATION = 0.01;

// In space slip goes on by a node at a time among many: it is looked at anew where it has by a part
// of them all.
enum { SCANNED_PARTS = 200 };

// The antisymmetric part is stepped along where it is more than this part of the symmetric one:
// rounding. Where it is less in the problem and in all that acts on a reduced bulk, and decays, it
// is no part of the step.
static const double ANTISYMMETRIC_LIMIT = 1e-12;

// Steps to go, at which a run is given up. A thousand stick-slip cycles on 20 cells are 2e5 steps,
// and cost a minute.
static const double STEPS_LEFT_MAX = 1e8;

// The first level is step_max, doubled as often as relaxing may need; which level a run may take at
// the longest is `coarsest`.
bool step_control_create(const Block *block, const StepControlDef *def, StepControl *control,
                         Error *err)
{
    *control = (StepControl){.def = *def, .certified = true, .antisymmetric_decays = true};
    double longest = def->step_max;
    while (longest < def->relax_step) longest *= 2;   // so that step_max is a level
    dt_levels_init(block->system, longest, def->step_min, &control->dt_levels);
    control->dt_levels.run_from = dt_level_find(&control->dt_levels, def->step_max);
    TRY(sdirk_create(block, &control->dt_levels, &control->scheme, err));
    TRY(certificate_create(block, &control->certificate, err));
    if (def->use_certificate && !control->scheme.memory.node)
        TRY(half_step_create(block, &control->certificate, &control->half, err));
    if (control->half.exists) {
        control->dt_levels.half = &control->half.contact;
        certificate_lay_aside(&control->certificate);
    }
    control->scheme.half = &control->half;
    TRY(oscillation_record_create(block, def->watch_time, &control->oscillations, err));
    TRY(state_create(block->system, block->interface, &control->now, err));
    TRY(state_create(block->system, block->interface, &control->next, err));
    control->scheme.memory.slip_per_mu = def->slip_per_mu;
    friction_states_reset(&control->scheme.memory, &control->now);
    step_control_restart(control);
cleanup:
    return error_is_clean(err);
}

void step_control_destroy(StepControl *control)
{
    dt_levels_destroy(&control->dt_levels);
    sdirk_destroy(&control->scheme);
    certificate_destroy(&control->certificate);
    half_step_destroy(&control->half);
    oscillation_record_destroy(&control->oscillations);
    state_destroy(&control->now);
    state_destroy(&control->next);
    *control = (StepControl){0};
}

void step_control_restart(StepControl *control)
{
    control->settles = control->scheme.memory.frozen = false;
    control->now.time = 0;
    control->counters = (StepCounters){0};
    control->looked_steps = 0;
    control->looked_time = 0;
    for (int32_t k = 0; k < DT_LEVELS_MAX; k++) control->dt_levels.accepted[k] = 0;
    control->ledger = energy_open(&control->now);
    oscillation_record_clear(&control->oscillations);
    control->coarsest = control->dt_levels.run_from;
    dt_levels_drop(&control->dt_levels, 0, control->coarsest);
    int32_t first =
        dt_level_find(&control->dt_levels, fmin(control->def.wave_step, control->def.step_max));
    control->level = first < control->dt_levels.level_count ? first
                                                            : control->dt_levels.level_count - 1;
}

static CertifiedParts parts_of(StepControl *control)
{
    return (CertifiedParts){.whole = &control->certificate,
                            .half = &control->half,
                            .dt_levels = &control->dt_levels,
                            .halved = control->scheme.part != PART_WHOLE};
}

typedef enum Verdict {
    STEP_ACCEPTED,
    STEP_UNSOLVED,
    STEP_INACCURATE,
    STEP_UNBALANCED,
    STEP_UNCERTIFIED
} Verdict;

// The ledger as it is if the step under trial is accepted.
static EnergyLedger book_step(const StepControl *control, int32_t k, const StepOutcome *outcome)
{
    EnergyLedger ledger = control->ledger;
    sdirk_add_energy(&control->scheme, outcome, dt_level_step(&control->dt_levels, k), &ledger);
    energy_store(&control->next, &ledger);
    return ledger;
}

// The longest step that resolves waves.
static int32_t wave_level(const StepControl *control)
{
    return dt_level_find(&control->dt_levels, control->def.wave_step);
}

void step_control_disturb(StepControl *control)
{
    int32_t resolving = wave_level(control), last = control->dt_levels.level_count - 1;
    oscillation_record_clear(&control->oscillations);
    if (control->level < resolving) control->level = resolving < last ? resolving : last;
}

// May `state` be left or reached by a step of level k, which does not resolve waves? What
// oscillates on is small, as certified or as seen so far, and nothing grows without oscillating.
// Where friction remembers, the step resolves what grows more slowly than 1/(gamma dt), and what
// grows more slowly than the time that was watched has not been seen: neither is asked about.
static bool may_skip_waves(StepControl *control, const State *state, int32_t k)
{
    const DtLevels *dt_levels = &control->dt_levels;
    double watched = control->oscillations.duration;
    if (watched == 0) return false;
    int32_t slowest = dt_level_find(dt_levels, watched / SDIRK2.gamma);   // that was seen
    LevelRange all = {k < slowest ? k : slowest, dt_levels->level_count};
    LevelRange unseen = {all.first, slowest + 1};
    bool seen = oscillation_record_covers(&control->oscillations, state), small = seen;
    if (control->scheme.memory.act)
        small = seen && k >= slowest;
    else
        all.first = 0;

    // No oscillation that a disturbance as fast as slip itself starts, at the s of these levels,
    // comes near v_c in half a period.
    if (!small) {
        double fastest = 0;
        for (int32_t i = 0; i < state->contact_count; i++)
            fastest = fmax(fastest, slip_size(control->scheme.interface, i, state->slip_rate));
        double growth = SMALL_OSCILLATION * control->scheme.friction->critical_velocity / fastest;
        small = growth > 1 && parts_ask(parts_of(control), state, PARTS_OSCILLATE_LESS,
                                        seen ? unseen : all, growth);
    }
    return small && parts_ask(parts_of(control), state, PARTS_EXCLUDE_RUNAWAY, all, 0);
}

// The cheapest questions come first. *certified and *antisymmetric_decays are of the state that the
// step leads to; where the certificate is switched off they are true and false, without a look.
static Verdict judge_step(StepControl *control, int32_t k, const StepOutcome *outcome,
                          bool *certified, bool *antisymmetric_decays)
{
    *certified = true;
    *antisymmetric_decays = false;
    if (!outcome->solved || !isfinite(outcome->error)) return STEP_UNSOLVED;
    if (outcome->error > control->def.tolerance) return STEP_INACCURATE;

    // The ledger, down to the longest step that resolves waves. Where no shorter step is left the
    // run's own ledger decides (run/simulation).
    double part = LEDGER_SHARE * control->def.energy_tolerance;
    bool last = k + 1 >= control->dt_levels.level_count;
    if (!last && part != 0 && !control->settles && k <= wave_level(control)) {
        EnergyLedger after = book_step(control, k, outcome);
        double missing = fabs(energy_imbalance(&after));
        double before = fabs(energy_imbalance(&control->ledger));
        if (!(missing <= fmax(part * energy_turnover(&after), before))) return STEP_UNBALANCED;
    }

    if (!control->def.use_certificate) return STEP_ACCEPTED;
    double reach = dt_level_reach(&control->dt_levels, k);
    *certified = parts_hold(parts_of(control), &control->next, reach, antisymmetric_decays);
    if (*certified) return STEP_ACCEPTED;
    if (k < wave_level(control))
        return may_skip_waves(control, &control->next, k) ? STEP_ACCEPTED : STEP_UNCERTIFIED;
    LevelRange own = {k, k + 1};
    bool resolved = parts_ask(parts_of(control), &control->next, PARTS_RESOLVE, own, 0);
    return resolved ? STEP_ACCEPTED : STEP_UNCERTIFIED;
}

// The level after a rejection: at least one further down.
static int32_t shorter_level(const StepControl *control, int32_t k, Verdict verdict,
                             const StepOutcome *outcome)
{
    int32_t target = k + 1;
    if (verdict == STEP_INACCURATE) {
        double allowed = SAFETY * control->def.tolerance / outcome->error;
        double shrink = pow(allowed, 1 / LOCAL_ORDER);
        target = dt_level_find(&control->dt_levels, dt_level_step(&control->dt_levels, k) * shrink);
    }
    // With memory what a state withstands goes by the step: one half as long may do.
    if (verdict == STEP_UNCERTIFIED && !control->scheme.memory.act) {
        int32_t resolving = wave_level(control);
        target = resolving < k + UNCERTIFIED_DROP ? resolving : k + UNCERTIFIED_DROP;
    }
    return target > k ? target : k + 1;
}

// The level after an accepted step: one up when the error allows it and the certificate does.
static int32_t next_level(StepControl *control, int32_t k, double error, bool retried)
{
    double expected = error * exp2(LOCAL_ORDER);
    bool grows = !retried && k > control->coarsest && expected < SAFETY * control->def.tolerance;
    int32_t next = grows ? k - 1 : k, resolving = wave_level(control);
    // A state that a step longer than the waves led to was examined already.
    bool free = k < resolving || next >= resolving || control->certified ||
                may_skip_waves(control, &control->now, next);
    if (!free) return resolving;
    bool longer = next < k && next < resolving && control->scheme.memory.act &&
                  control->def.use_certificate;
    bool stays = longer &&
                 !certificate_holds(&control->certificate, &control->now,
                                    dt_level_reach(&control->dt_levels, next)) &&
                 !may_skip_waves(control, &control->now, next);
    return stays ? k : next;
}

// The coarsest built level that does not overshoot; the chosen one when none is, or one is made.
static int32_t fit_level(const StepControl *control, int32_t k, double remaining)
{
    const DtLevels *dt_levels = &control->dt_levels;
    remaining *= 1 + 1e-9;   // rounding must not cost the last step
    if (dt_level_step(dt_levels, k) <= remaining) return k;
    for (int32_t fit = k + 1; fit < dt_levels->level_count; fit++) {
        if (dt_levels->level[fit] && dt_level_step(dt_levels, fit) <= remaining) return fit;
    }
    int32_t made = dt_level_find(dt_levels, remaining);
    return control->lands && made < dt_levels->level_count ? made : k;
}

bool step_control_fits(const StepControl *control, double remaining)
{
    const DtLevels *dt_levels = &control->dt_levels;
    for (int32_t k = dt_levels->level_count - 1; k >= 0; k--) {
        if (dt_levels->level[k]) return dt_level_step(dt_levels, k) <= remaining * (1 + 1e-9);
    }
    return remaining > 0;
}

bool step_control_gets_on(StepControl *control, double end, Error *err)
{
    int64_t steps = control->counters.accepted - control->looked_steps;
    if (steps < STEPS_LOOKED) return true;
    double step = (control->now.time - control->looked_time) / (double)steps;
    bool resolves_waves = control->def.wave_step > 0 && step > control->def.wave_step / 2;
    if (resolves_waves)   // an event, which may be long: the pace of the whole run counts
        step = control->now.time / (double)control->counters.accepted;
    double left = (end - control->now.time) / step;
    control->looked_steps = control->counters.accepted;
    control->looked_time = control->now.time;
    if (left > STEPS_LEFT_MAX)
        FAIL(err, ERROR_COMPUTE,
             "steps of %.2g are the longest that are accepted, and the end is %.1e of "
             "them away: slip has come to a state that weakens faster than viscosity can damp on "
             "an element. Smaller elements at the contact, less pressure or a larger "
             "friction.critical_velocity would help",
             step, left);
cleanup:
    return error_is_clean(err);
}

// A step that was shortened only to end where the run ends does not choose the next level.
bool step_control_advance(StepControl *control, double remaining, Error *err)
{
    static const char *const reasons[] = {
        [STEP_UNSOLVED] =
            "its contact problem has no solution that could be found, or its error is "
            "not a number",
        [STEP_INACCURATE] = "its local error is above the tolerance",
        [STEP_UNBALANCED] = "its energies do not balance",
        [STEP_UNCERTIFIED] = "slip grows faster than it resolves"};
    StepCounters *counters = &control->counters;
    DtLevels *dt_levels = &control->dt_levels;
    StepOutcome outcome;
    bool certified = true, antisymmetric_decays, retried = false;
    int32_t k = fit_level(control, control->level, remaining);
    bool shortened = k != control->level;

    // Steps are tried that are shorter and shorter until one is accepted.
    for (;;) {
        // Sweeps over the contact cost as much as some hundred steps on a large interface, and
        // shorter steps need none: only where none is left. In space they earn their time at every
        // level (a block on a soft law took four times as many steps without).
        control->scheme.solver.sweeps_on = control->scheme.interface->dim > 2 ||
                                           k == dt_levels->level_count - 1;
        // The whole contact is solved, or its symmetric part alone, with the antisymmetric one
        // where that does not decay.
        bool halved = dt_levels->half && !control->asymmetric &&
                      half_step_take_friction(&control->half, control->scheme.friction);
        control->scheme.part = halved ? PART_SYMMETRIC : PART_WHOLE;
        control->scheme.antisymmetric_acts = !control->antisymmetric_decays ||
                                             control->half.asymmetry > ANTISYMMETRIC_LIMIT;
        control->scheme.symmetric_alone =
            halved && !control->scheme.antisymmetric_acts &&
            half_step_is_symmetric(&control->half, &control->now, ANTISYMMETRIC_LIMIT);

        TRY(sdirk_step(&control->scheme, k, &control->now, &control->next, &outcome, err));
        if (outcome.asymmetric) {
            control->asymmetric = true;
            dt_levels_drop_halves(dt_levels);
            continue;
        }
        Verdict verdict = judge_step(control, k, &outcome, &certified, &antisymmetric_decays);
        if (verdict == STEP_ACCEPTED) break;

        counters->unsolved += verdict == STEP_UNSOLVED;
        counters->rejected_error += verdict == STEP_INACCURATE;
        counters->rejected_energy += verdict == STEP_UNBALANCED;
        counters->rejected_uncertified += verdict == STEP_UNCERTIFIED;
        retried = true;
        k = shorter_level(control, k, verdict, &outcome);
        if (k < dt_levels->level_count) continue;
        double speed, mu;
        if (!friction_states_hold(&control->scheme.memory, control->now.slip_rate, &speed, &mu))
            FAIL(err, ERROR_COMPUTE,
                 "at t = %.9g friction comes to states, or to a mu (%g at velocity %g), that no "
                 "law may have: its formulas must hold wherever its states go",
                 control->now.time, mu, speed);
        FAIL(err, ERROR_COMPUTE, "at t = %.9g the step went below time.step_min = %g: %s",
             control->now.time, control->def.step_min, reasons[verdict]);
    }

    // An antisymmetric part that is rounding and decays is dropped: friction would hold it, and the
    // next event begin with what earlier ones have made of it.
    if (control->scheme.part == PART_SYMMETRIC && antisymmetric_decays)
        half_step_symmetrise(&control->half, &control->next, control->scheme.bound);

    // Accepted: the ledger is booked, and `now` and `next` exchange their arrays.
    control->ledger = book_step(control, k, &outcome);
    State accepted = control->next;
    control->next = control->now;
    control->now = accepted;
    control->outcome = outcome;
    control->last_step = dt_level_step(dt_levels, k);
    control->certified = certified;
    control->antisymmetric_decays = antisymmetric_decays;
    counters->accepted++;
    dt_levels->accepted[k]++;
    if (k >= wave_level(control))
        oscillation_record_add(&control->oscillations, &control->now, control->last_step,
                               certified);
    else
        counters->stepped_over_oscillations += !certified;

    // Real growth is looked for in `now` on the levels that are built: some small factorisations,
    // so only when the slip set is larger than all that were looked at since the last certified
    // state. judge_step has looked at level k where that resolves waves.
    if (certified) {
        control->grows = false;
        control->scanned = 0;
    } else {
        int32_t contacts = control->now.contact_count, slipping = 0;
        int32_t more = control->scheme.interface->dim > 2 ? contacts / SCANNED_PARTS : 0;
        for (int32_t i = 0; i < contacts; i++) slipping += control->now.status[i] != CONTACT_STICK;
        if (slipping > control->scanned + more) {
            LevelRange known = {k < wave_level(control) ? -1 : k, k + 1};
            control->scanned = slipping;
            control->grows =
                !parts_ask(parts_of(control), &control->now, PARTS_FIND_NO_RUNAWAY, known, 0);
        }
    }

    // The level of the next step.
    if (!shortened || retried) control->level = next_level(control, k, outcome.error, retried);
cleanup:
    return error_is_clean(err);
}

// One level, which needs no matrix.
void step_control_use_explicit(StepControl *control, const ExplicitReference *scheme)
{
    BulkOperator *system = control->dt_levels.system;
    dt_levels_destroy(&control->dt_levels);
    dt_levels_init(system, scheme->def.step, scheme->def.step, &control->dt_levels);
    control->def.step_max = control->def.step_min = scheme->def.step;
    control->level = control->coarsest = 0;
}

// The contact conditions of the last step stand where those of an implicit stage would. The
// certificate limits nothing here; it says where l_sc is.
bool step_control_advance_explicit(StepControl *control, ExplicitReference *scheme, int64_t steps,
                                   double rate, Error *err)
{
    int64_t look = (int64_t)fmax(1, fmin(control->def.wave_step / scheme->def.step, (double)steps));
    int64_t end = scheme->steps + steps - scheme->steps % steps;
    double fastest;   // slip rate of a node
    do {
        int64_t part = end - scheme->steps < look ? end - scheme->steps : look;
        TRY(explicit_reference_advance(scheme, part, &control->now, &control->ledger, err));
        fastest = 0;
        for (int32_t i = 0; i < control->now.contact_count; i++)
            fastest = fmax(fastest, slip_size(scheme->def.interface, i, control->now.slip_rate));
    } while (scheme->steps < end && !(fastest > rate));
    control->last_step = scheme->def.step;
    control->counters.accepted = control->dt_levels.accepted[0] = scheme->steps;
    control->outcome.residual = scheme->residual;
    memcpy(control->scheme.bound, scheme->bound,
           (size_t)control->now.interface_count * sizeof(double));
    control->scheme.reach = scheme->def.step;
    if (control->def.use_certificate)
        control->certified =
            certificate_holds(&control->certificate, &control->now, scheme->def.step);
cleanup:
    return error_is_clean(err);
}

// The largest velocity on the interface, or the root mean square over the block if that is larger.
// v'M v over the block's mass is the mean square of |v|, twice the kinetic energy over the mass.
static double fastest(const StepControl *control)
{
    const State *state = &control->now;
    double mean_square = dense_dot(state->velocity, state->momentum, state->dof_count) /
                         control->scheme.system->mass_total;
    return fmax(sqrt(mean_square), dense_max_abs(state->slip_rate, state->interface_count));
}

bool relax(StepControl *control, const RelaxationDef *def, int64_t *steps, Error *err)
{
    double speed = INFINITY;

    // Until the next restart only the state reached in the end matters: steps may be as long as
    // relax_step, and nothing is asked of energy.
    control->settles = control->scheme.memory.frozen = true;
    control->coarsest = 0;
    for (*steps = 0; speed > def->speed_max; (*steps)++) {
        if (control->now.time > def->duration_max)
            FAIL(err, ERROR_COMPUTE,
                 "the block has not settled under its load after t = %g: the fastest point moves "
                 "at %g, start.tolerance asks for %g (does it tip over, or is start.duration_max "
                 "too short?)",
                 control->now.time, speed, def->speed_max);
        TRY(step_control_advance(control, INFINITY, err));
        // Steps get longer, and those before are hardly taken once more.
        dt_levels_drop(&control->dt_levels, control->level + 1, control->dt_levels.run_from);
        if (def->may_go_on) TRY(def->may_go_on(def->self, err));
        speed = fastest(control);
    }
cleanup:
    if (!error_is_clean(err)) error_context(err, "while relaxing before the rod moves");
    return error_is_clean(err);
}

bool step_control_archive(StepControl *control, Archive *archive, Error *err)
{
    state_archive(&control->now, archive);
    energy_archive(&control->ledger, archive);
    sdirk_archive(&control->scheme, archive);
    oscillation_record_archive(&control->oscillations, archive);
    certificate_archive(&control->certificate, archive);
    half_step_archive(&control->half, archive);
    archive_section(archive, "step control");
    archive_numbers_of(archive, &control->outcome.residual, &control->last_step);
    archive_flag(archive, &control->certified);
    archive_flag(archive, &control->antisymmetric_decays);
    archive_flag(archive, &control->asymmetric);
    archive_flag(archive, &control->grows);
    archive_flag(archive, &control->settles);
    archive_integer(archive, &control->scanned);
    archive_index(archive, &control->level, 0, control->dt_levels.level_count);
    archive_index(archive, &control->coarsest, 0, control->dt_levels.level_count + 1);
    archive_count(archive, &control->looked_steps);
    archive_number(archive, &control->looked_time);
    StepCounters *counters = &control->counters;
    archive_counts_of(archive, &counters->accepted, &counters->rejected_error,
                      &counters->rejected_energy, &counters->rejected_uncertified,
                      &counters->unsolved, &counters->stepped_over_oscillations);
    int64_t last = control->scheme.solver.newton.factorisations;
    int64_t last_halved = control->half.solver.newton.factorisations;
    return dt_levels_archive(&control->dt_levels, last, last_halved, archive, err);
}
