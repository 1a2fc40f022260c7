// SPDX-License-Identifier: GPL-2.0-or-later
// Results of a run for amontons.h: counters from the parts that keep them, phases with their times,
// answers. Nothing is computed here that is not known already.
#include "run/simulation_state.h"

#include "record/drops.h"
#include "answers/program_results.h"
#include "answers/answers.h"
#include "base/decimal_point.h"
#include "base/memory.h"
#include "base/text.h"
#include "io/hdf5/result_tables.h"
#include "model/loads.h"
#include "run/warnings.h"

// Callers are handed the statuses that a history holds.
_Static_assert((int)NODE_OPEN == STATUS_OPEN && (int)NODE_STICKS == STATUS_STICKS &&
                   (int)NODE_WEAKENS == STATUS_WEAKENS && (int)NODE_SLIPS == STATUS_SLIPS,
               "statuses of amontons.h and of a history");

#include <math.h>
#include <stdio.h>
#include <string.h>

StepView step_view(const Observation *seen, const Events *events, const ContactArrays *contact,
                   double t_end)
{
    const int32_t *kinds = events->kinds;
    return (StepView){.t = seen->t,
                      .U = seen->U,
                      .rod_way = seen->rod_way,
                      .mu = seen->mu,
                      .step_size = seen->step_size,
                      .front = seen->front - seen->trailing,
                      .max_slip_rate = seen->max_slip_rate,
                      .fraction = fmin(seen->t / t_end, 1),
                      .certified = seen->certified,
                      .events = kinds[EVENT_BOUNDED] + kinds[EVENT_LEADING],
                      .slidings = kinds[EVENT_LEADING],
                      .contact = {.count = contact->count,
                                  .tangents = contact->tangents,
                                  .x = seen->interface->x,
                                  .y = seen->interface->y,
                                  .slip_rate = contact->slip_rate,
                                  .slip = contact->slip,
                                  .pressure = contact->pressure,
                                  .shear = contact->shear,
                                  .status = contact->status,
                                  .state = contact->state,
                                  .states = contact->states}};
}

// Allocations of the loop are counted from when it began; a run that failed before has none.
RunCounters summary_count(const Simulation *simulation)
{
    const StepControl *control = &simulation->control;
    const StepCounters *steps = &control->counters;
    const ContactSolver *solver = &control->scheme.solver;
    int64_t rejected = steps->rejected_error + steps->rejected_energy + steps->rejected_uncertified;
    return (RunCounters){.accepted = steps->accepted,
                         .rejected = rejected,
                         .rejected_uncertified = steps->rejected_uncertified,
                         .stepped_over_oscillations = steps->stepped_over_oscillations,
                         .unsolved_retries = steps->unsolved,
                         .factorisations = simulation->model.system.factorisations,
                         .solves = simulation->model.system.solves,
                         .contact_solves = solver->solves,
                         .contact_iterations = solver->iterations,
                         .contact_fallbacks = solver->fallbacks,
                         .contact_rescued = solver->rescued,
                         .certificates = control->certificate.checks,
                         .loop_allocations = simulation->allocations_before > 0
                                                 ? simulation_allocations(simulation) -
                                                       simulation->allocations_before
                                                 : 0};
}

void amontons_estimate(double value, double bar, double known_to, char text[ESTIMATE_SIZE])
{
    NUMBERS_HAVE_A_POINT;
    text_estimate(value, bar, known_to, text);
}

void amontons_known_to(double value, double known_to, char text[ESTIMATE_SIZE])
{
    NUMBERS_HAVE_A_POINT;
    text_known_to(value, known_to, text);
}

void summary_fill(const Simulation *simulation, RunSummary *summary)
{
    const Answers *answers = &simulation->answers;
    const int32_t *kinds = simulation->events.kinds;
    const Model *model = &simulation->model;
    double length = model->length;
    *summary =
        (RunSummary){.mu_M = answers->mu_M.value,
                     .mu_M_error = answers->mu_M.error,
                     .mu_M_known_to = answers->mu_M_known_to,
                     .mu_M_spread = answers->mu_M_spread,
                     .mu_hold = answers->mu_hold.value,
                     .mu_hold_error = answers->mu_hold.error,
                     .mu_hold_known_to = answers->mu_hold_known_to,
                     .mu_max = answers->mu_max,
                     .mu_max_known_to = answers->mu_max_known_to,
                     .mu_steady = steady_mu(&simulation->steady).value,
                     .mu_M_is = steady_words(&simulation->steady, answers),
                     .peaks = answers->peaks,
                     .peaks_counted = answers->peaks_counted,
                     .period = answers->period,
                     .drops = answers->regime.count,
                     .drop_period = answers->regime.period,
                     .drops_enough = answers->enough,
                     .run_in_drift = answers->regime.drift,
                     .run_in_drops_left = answers->regime.drops_left,
                     .quasi_static = kinds[EVENT_QUASI_STATIC],
                     .bounded = kinds[EVENT_BOUNDED],
                     .leading = kinds[EVENT_LEADING],
                     .slight = kinds[EVENT_SLIGHT],
                     .normal_force = model->scales.load *
                                     scene_whole_force(&simulation->scene, model->interface.dim),
                     .base_slip = base_slip(model, &simulation->control.now),
                     .critical_length = answers->critical_length / length,
                     .first_mu = answers->first_loading.mu.value,
                     .first_U = answers->first_loading.U,
                     .first_critical_length = answers->first_loading.critical_length / length,
                     .first_longest = answers->first_loading.longest / length,
                     .first_mu_error = answers->first_loading.mu.error,
                     .first_mu_known_to = answers->first_loading.known_to,
                     .first_precursors = answers->first_loading.precursors,
                     .later_precursors = answers->later_cycles.precursors,
                     .later_longest = answers->later_cycles.longest / length,
                     .energy_error = simulation->errors.energy,
                     .moment_error = simulation->errors.moment,
                     .complementarity_error = simulation->errors.complementarity,
                     .seconds_solve = simulation->timing.solve,
                     .seconds_output = simulation->timing.output,
                     .seconds_total = simulation->timing.total,
                     .counters = simulation->counters,
                     .warnings = simulation->warnings,
                     .field_files = simulation->fields.written,
                     .figures = simulation->figures};
    if (answers->regime.run_in != RUN_IN_OVER)
        summary->run_in = run_in_name(answers->regime.run_in);
    mesh_move_text(&simulation->model.mesh, summary->mesh_moved);

    // The load drop, from number `first` on, at which slow slip had the fewest cells to turn fast
    // on.
    const Event *least = simulation->least_resolved;
    const Interface *interface = &simulation->model.interface;
    summary->slip_length = least ? least->slip_length : NAN;
    summary->slip_cells = least ? least->slip_cells : NAN;
    if (least && interface->pad_count > 1)
        snprintf(summary->slip_pad, sizeof summary->slip_pad, "%s",
                 interface->pad_name[least->pad]);

    if (simulation->pads.count > 1) {
        pads_order(&simulation->pads, true, summary->pads_order_first);
        pads_order(&simulation->pads, false, summary->pads_order);
    }

    // The direct effect and healing, where the rod jumps.
    if (simulation->readings.course) {
        ProgramSums sums = program_results_sum(&simulation->readings);
        summary->velocity_steps = sums.steps;
        summary->holds = sums.holds;
        memcpy(summary->direct_effect, &sums.direct, sizeof summary->direct_effect);
        memcpy(summary->level_change, &sums.change, sizeof summary->level_change);
        memcpy(summary->slip_distance, &sums.distance, sizeof summary->slip_distance);
        memcpy(summary->healing, &sums.healing, sizeof summary->healing);
    }

    memcpy(summary->mu_M_parts, &answers->mu_M_parts, sizeof summary->mu_M_parts);
    memcpy(summary->mu_hold_parts, &answers->mu_hold_parts, sizeof summary->mu_hold_parts);

    // Meshes and runs behind an error bar.
    const Levels *levels = simulation->levels;
    if (levels) {
        const Scene *scene = &simulation->scene;
        const Level *last = levels_last(levels);
        for (int32_t l = 0; l < levels->count; l++) summary->bar_runs += levels->list[l].run_count;
        summary->bar_meshes = levels->count;
        summary->bar_nodes = last ? last->contact_nodes : 0;
        summary->bar_wanted = levels->wanted;
        summary->bar_window = simulation->scene.accuracy.window;
        summary->bar_ended = levels->ended;
        summary->bar_goes_on = scene->time.until_periodic || scene->time.until_slidings > 0 ||
                               scene->time.until_mu_below > 0;
    }
    snprintf(summary->folder, sizeof summary->folder, "%s", simulation->folder.path);
}
