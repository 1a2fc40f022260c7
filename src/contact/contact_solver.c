// SPDX-License-Identifier: GPL-2.0-or-later
// A solve in the plane is read from top to bottom in solve_statuses: hold what the statuses hold,
// Newton step on the rest, r = S v - g, check every status, again. Forces are measured by the
// largest force of the problem, velocities by that force over the largest diagonal entry of S. All
// arrays are the solver's own, made once for an interface: nothing is allocated in a solve.
#include "contact/contact_solver.h"

#include "base/clock.h"
#include "base/memory.h"
#include "contact/contact_equations.h"
#include "contact/contact_sweeps.h"

#include <math.h>
#include <string.h>

// An old matrix is given up when the residual of a step is above this part of that before it.
static const double CHORD_GAIN = 0.1;

// Where one status is changed at a time: the worst violates its condition by this many times what
// the equations are off, at least. Then it does so at their solution, too.
static const double CLEARLY = 100;

enum {
    ITERATIONS_ALL = 30,   // Newton steps in which every violated status is changed: some ten times
    // what a solvable problem was seen to need
    ITERATIONS_ONE = 40,   // and then those that change only the worst
    STALLED_MAX = 4,   // Newton steps in a row that do not halve the residual: there is no solution
};
// Tolerance of residual forces, relative to the largest force: some 1e2 above the rounding of
// S v - g.
static const double TOLERANCE = 1e-12;

// *solver is overwritten; on failure contact_solver_destroy frees what was made.
bool contact_solver_create(const Interface *interface, ContactSolver *solver, Error *err)
{
    *solver = (ContactSolver){.sweeps_on = true};
    solver->anchor = NEW_ARRAY(uint8_t, interface->contact_count + interface->rod_count, err);
    if (!error_is_clean(err) || !contact_newton_create(interface, &solver->newton, err))
        return false;
    return interface->dim == 2 ||
           contact_discs_create(interface, &solver->newton, &solver->discs, err);
}

void contact_solver_destroy(ContactSolver *solver)
{
    contact_discs_destroy(&solver->discs);
    contact_newton_destroy(&solver->newton);
    memory_free(solver->anchor);
    *solver = (ContactSolver){0};
}

// Checks every status against its own conditions. Where `all`, each that violates them by more than
// the tolerance is changed, else only the worst, if it does so by more than `least`. Velocities
// stay: contact_newton_settle brings them in line. *started: the node with the worst status where
// that stuck and now slips, else -1. false: none is changed.
static bool change_statuses(const ContactEquations *equations, ContactScales scales, bool all,
                            double least, int32_t *started)
{
    const ContactSolution *at = equations->at;
    int32_t contacts = equations->problem->interface->contact_count;
    int32_t unknowns = contacts + equations->problem->interface->rod_count;
    double largest = 0;
    uint8_t *worst = NULL, worst_status = 0;
    int32_t worst_starts = -1;
    for (int32_t k = 0; k < unknowns; k++) {
        double violation;
        bool rod = k >= contacts;
        uint8_t *status = rod ? &at->rod_touches[k - contacts] : &at->status[k];
        uint8_t better = rod ? contact_judge_rod(equations, scales, k - contacts, &violation)
                             : contact_judge_node(equations, scales, k, &violation);
        if (!(violation > TOLERANCE)) continue;
        if (violation > largest) {
            largest = violation;
            worst = status;
            worst_status = better;
            worst_starts = !rod && *status == CONTACT_STICK && status_slips(better) ? k : -1;
        }
        if (all) *status = better;
    }
    if (!(largest > (all ? 0 : least))) return false;
    if (!all) *worst = worst_status;
    *started = worst_starts;
    return true;
}

// A node whose shear exceeds its threshold at rest, yet which slips against that shear after
// Newton's first step: friction falls faster with its slip rate than S resists, so that slow slip
// is no solution while the others' statuses stay. It starts again beyond the weakening. false: it
// is not so.
static bool start_fast(ContactNewton *newton, int32_t node)
{
    const ContactEquations *equations = &newton->equations;
    const ContactProblem *problem = equations->problem;
    double *slip_rate = &equations->at->velocity[interface_tangent(problem->interface, node)];
    double direction = status_direction(equations->at->status[node]);
    if (*slip_rate * direction >= 0) return false;
    *slip_rate = direction * friction_spent_speed(friction_at(problem->friction, node));
    newton->factors_gain = false;
    newton->listed = false;
    contact_newton_react(newton);
    return true;
}

// Makes exact what was solved to the tolerance. A node may slip against its status by the
// tolerance, which beside a rod slow enough is more than rounding: it rests, and friction is what
// holds it. What touches nothing has no force, not even rounding.
static void clean_solution(const Interface *interface, ContactSolution *at)
{
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(interface, i);
        uint8_t status = at->status[i];
        if (status_slips(status) && at->velocity[t] * status_direction(status) < 0)
            at->velocity[t] = 0;
        if (status != CONTACT_OPEN) continue;
        at->reaction[t] = 0;
        at->reaction[interface_normal(interface, i)] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++)
        if (!at->rod_touches[j]) at->reaction[interface_rod(interface, j)] = 0;
}

// Newton and statuses in the plane, from what `at` has. true: equations and all statuses hold,
// reactions of open nodes are 0 to the bit. false: the limit of steps was reached, Newton stalled,
// nothing holds what is open, a derivative was singular or a number not finite; `at` then has no
// meaning.
static bool solve_statuses(ContactSolver *solver, const ContactProblem *problem,
                           ContactSolution *at)
{
    ContactNewton *newton = &solver->newton;
    const ContactEquations *equations = &newton->equations;
    int32_t iteration = 0, limit = ITERATIONS_ALL;
    bool change_all = true;   // every violated status is changed, not only the worst
    int32_t started = -1;   // node that was set slipping by the last change, where the worst is
        // looked at alone
    double least = INFINITY;   // residual so far with these statuses, over the scale of force
    int32_t stalled = 0;   // Newton steps in a row, not of a chord, that did not halve it
    double before = INFINITY;   // residual of the step before, where its factors were reused

    // Unknowns that the statuses hold take their values. The first set of statuses is kept.
    contact_newton_begin(newton, problem, at, 1e-3 * TOLERANCE);
    contact_copy_statuses(equations, solver->anchor);
    int32_t met = 1, anchored = 1;   // sets of statuses so far; that which solver->anchor holds

    for (;;) {
        // After the limit, or in a cycle, only the worst status is changed.
        if (iteration == limit && !change_all) return false;
        if (iteration == limit) {
            change_all = false;
            limit = iteration + ITERATIONS_ONE;
            solver->fallbacks++;
        }
        iteration++;

        // A step of Newton on what is free, open nodes condensed out.
        if (!newton->listed && !contact_newton_list(newton)) return false;
        solver->iterations++;
        if (!contact_newton_step(newton)) return false;
        int32_t node = started;
        started = -1;
        if (node >= 0 && start_fast(newton, node)) {
            least = INFINITY;
            stalled = 0;
            continue;
        }

        // Equations: the residual, with reactions found from all velocities where it seems small.
        ContactScales scales = contact_scales(problem, at->reaction);
        double residual = contact_newton_residual(newton);
        if (!isfinite(residual)) return false;
        bool equal = residual <= TOLERANCE * scales.force;
        if (equal && !newton->exact) {
            contact_newton_react(newton);
            residual = contact_newton_residual(newton);
            equal = residual <= TOLERANCE * scales.force;
        }
        if (!equal && newton->reused && residual > CHORD_GAIN * before)
            newton->factors_gain = false;
        before = newton->reused ? residual : INFINITY;

        // Where friction weakens these statuses may have no solution (two met in a fold and are
        // gone): Newton's own steps then no longer reduce the residual.
        double off = equal ? 0 : residual / scales.force;
        if (!equal && !newton->reused) {
            stalled = off > least / 2 ? stalled + 1 : 0;
            least = fmin(least, off);
            if (stalled >= STALLED_MAX) return false;
        }

        // Statuses: changed after the first solve for them, not where steps are those of a chord
        // (there the equations are solved first); nor, where only one may change, before it is
        // clear which.
        if (!equal && newton->reused && change_all) continue;
        if (!change_statuses(equations, scales, change_all, CLEARLY * off, &started)) {
            if (!equal) continue;
            clean_solution(problem->interface, at);
            return true;
        }
        least = INFINITY;
        stalled = 0;

        // A set met before tells of a cycle (Brent, BIT 20, 1980: compared with one set that is
        // kept, and renewed at powers of two).
        bool cycles = change_all && contact_has_statuses(equations, solver->anchor);
        if (cycles) limit = iteration;
        if (met++ >= 2 * anchored) {
            anchored = met;
            contact_copy_statuses(equations, solver->anchor);
        }
        if (change_all && !cycles) started = -1;
        contact_newton_settle(newton);
    }
}

bool contact_solve(ContactSolver *solver, const ContactProblem *problem, ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    double started = clock_seconds();
    bool solved;

    // A bonded rod touches everywhere, an absent one nowhere.
    if (problem->rod_kind != ROD_PUSHES)
        memset(solution->rod_touches, problem->rod_kind == ROD_IS_BONDED,
               (size_t)interface->rod_count);

    if (interface->dim == 2) {
        solved = solve_statuses(solver, problem, solution);
        // The result of sweeps, from rest in each round, is handed to Newton once more, which
        // brings the last digits and has the last word on whether it is solved.
        for (int32_t k = 0; solver->sweeps_on && k < SWEEP_ROUNDS && !solved; k++) {
            memset(solution->velocity, 0, (size_t)interface->count * sizeof(double));
            solver->sweeps += contact_sweep(problem, solution, k);
            solved = solve_statuses(solver, problem, solution);
            solver->rescued += solved;
        }
    } else {
        ContactDiscs *discs = &solver->discs;
        int64_t iterations = discs->iterations, swept = discs->swept;
        solved = contact_discs_solve(discs, TOLERANCE, problem, solution);
        solver->iterations += discs->iterations - iterations;
        solver->fallbacks += discs->swept - swept;
        solver->rescued += solved && discs->swept > swept;
    }

    solver->solves++;
    solver->unsolved += !solved;
    solver->seconds += clock_seconds() - started;
    return solved;
}

static void take_count(int64_t *count, int64_t *from)
{
    *count += *from;
    *from = 0;
}

void contact_solver_take_counts(ContactSolver *solver, ContactSolver *from)
{
    take_count(&solver->solves, &from->solves);
    take_count(&solver->iterations, &from->iterations);
    take_count(&solver->fallbacks, &from->fallbacks);
    take_count(&solver->rescued, &from->rescued);
    take_count(&solver->unsolved, &from->unsolved);
    solver->seconds += from->seconds;
    from->seconds = 0;
}

void contact_solver_archive(ContactSolver *solver, const Interface *interface, Archive *archive)
{
    archive_section(archive, "contact solver");
    contact_newton_archive(&solver->newton, interface->count, archive);
    archive_counts_of(archive, &solver->solves, &solver->iterations, &solver->fallbacks,
                      &solver->rescued, &solver->unsolved, &solver->sweeps);
    if (solver->discs.kept) contact_discs_archive(&solver->discs, interface, archive);
}
