// SPDX-License-Identifier: GPL-2.0-or-later
// Read from the bottom: contact_solve, and settle for the steps of Newton before and after sweeps.
// Forces are measured by the largest force of the problem, velocities by that force over the
// largest diagonal entry of S. All arrays are the solver's own, made once for an interface: nothing
// is allocated in a solve.
#include "contact/contact_solver.h"

#include "base/clock.h"
#include "base/memory.h"
#include "contact/contact_sweeps.h"

#include <math.h>
#include <string.h>

// A derivative is factored anew when a step leaves more than this part of the residual.
static const double CHORD_GAIN = 0.1;
// With the same statuses velocities are the same where their contact_slip_square differs by no more
// than this part.
static const double SAME = 1e-6;
// Tolerance of residual forces, relative to the largest force: some 1e2 above the rounding of
// S v - g.
static const double TOLERANCE = 1e-12;

enum {
    STEPS = 20,   // of Newton before any sweeps, and after each round of them
    HALVINGS = 4,   // of a step that leaves more than there was: to and fro over a kink of mu
    STALE = 6,   // steps with the same statuses that do not halve the residual, as in a cycle
};

// *solver is overwritten; on failure contact_solver_destroy frees what was made.
bool contact_solver_create(const Interface *interface, ContactSolver *solver, Error *err)
{
    *solver = (ContactSolver){.sweeps_on = true};
    solver->anchor = NEW_ARRAY(uint8_t, interface->contact_count + interface->rod_count, err);
    return error_is_clean(err) && contact_newton_create(interface, &solver->newton, err);
}

void contact_solver_destroy(ContactSolver *solver)
{
    contact_newton_destroy(&solver->newton);
    memory_free(solver->anchor);
    *solver = (ContactSolver){0};
}

// The residual of the equations, over the scale of force.
static double scaled_residual(ContactNewton *newton)
{
    return contact_newton_residual(newton) / newton->equations.scales.force;
}

// Newton's steps from statuses, rows and reactions as they are. true: equations and statuses hold.
// false: they do not within STEPS, statuses go round in a cycle, a derivative is singular, or a
// number is not finite.
static bool settle(ContactSolver *solver)
{
    ContactNewton *newton = &solver->newton;
    ContactEquations *equations = &newton->equations;
    double before = INFINITY;   // residual of the last step with these statuses, over the scale
    double least = INFINITY;   // residual when it was last halved
    int32_t stale = 0;   // steps since then
    int32_t met = 1, anchored = 1;   // sets of statuses so far; that which solver->anchor holds
    bool started = false;   // nodes were started beyond their weakening
    double anchor_size = INFINITY;   // contact_slip_square with that set
    contact_copy_statuses(equations, solver->anchor);
    for (int32_t k = 0; k < STEPS; k++) {
        if (!contact_newton_step(newton)) return false;
        solver->iterations++;

        // Statuses at its end; where they stay, a step after which the residual is larger is
        // halved.
        bool changed;
        double residual;
        for (int32_t halved = 0;; halved++) {
            changed = contact_judge(equations);
            residual = changed ? INFINITY : scaled_residual(newton);
            if (changed || newton->reused || residual <= before || halved == HALVINGS) break;
            contact_newton_halve(newton);
        }

        // The last digits are those of S v - g with all of its columns.
        if (residual <= TOLERANCE && !newton->exact) {
            contact_newton_react(newton);
            changed = contact_judge(equations);
            residual = changed ? INFINITY : scaled_residual(newton);
        }
        if (residual <= TOLERANCE) return contact_is_finite(equations);

        // Statuses met before, with the same velocities, tell of a cycle (Brent, BIT 20, 1980:
        // compared with one set that is kept, and renewed at powers of two). Steps with the same
        // statuses that do not halve the residual lead to and fro over kinks of mu.
        bool cycles = false;
        if (changed) {
            double size = contact_slip_square(equations);
            cycles = contact_has_statuses(equations, solver->anchor) &&
                     fabs(size - anchor_size) <= SAME * size;
            if (met++ >= 2 * anchored) {
                anchored = met;
                anchor_size = size;
                contact_copy_statuses(equations, solver->anchor);
            }
        }
        bool halved = changed || residual <= 0.5 * least;
        least = changed ? INFINITY : halved ? residual : least;
        stale = halved ? 0 : stale + 1;
        cycles = cycles || (stale >= STALE && !newton->reused);

        // Slow slip may be no solution: certainly where friction falls faster than the node's own
        // entry of S resists; in a cycle perhaps where it falls at all.
        if (!started && (cycles || (!changed && !newton->reused))) {
            started = contact_newton_start_fast(newton, cycles ? 0 : 1);
            if (started) {
                before = least = INFINITY;
                stale = 0;
                continue;
            }
        }
        if (cycles) return false;
        if (changed) {
            contact_newton_settle(newton);
            before = INFINITY;
        } else {
            if (newton->reused && residual > CHORD_GAIN * before) newton->factors_gain = false;
            before = residual;
        }
    }
    return false;
}

bool contact_solve(ContactSolver *solver, const ContactProblem *problem, ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    ContactNewton *newton = &solver->newton;
    double started = clock_seconds();

    // A bonded rod touches everywhere, an absent one nowhere.
    if (problem->rod_kind != ROD_PUSHES)
        memset(solution->rod_touches, problem->rod_kind == ROD_IS_BONDED,
               (size_t)interface->rod_count);

    // Steps from what was handed in.
    contact_newton_begin(newton, problem, solution, TOLERANCE);
    // Where friction creeps its slope at rest is beyond what a float holds.
    newton->in_double = interface->dim == 2 || newton->creeps;
    bool solved = settle(solver);
    solver->fallbacks += !solved;

    // Sweeps, in the plane from rest in each round, and steps from where these led to.
    for (int32_t k = 0; solver->sweeps_on && k < SWEEP_ROUNDS && !solved; k++) {
        if (interface->dim == 2)
            memset(solution->velocity, 0, (size_t)interface->count * sizeof(double));
        solver->sweeps += contact_sweep(problem, solution, k);
        contact_newton_begin(newton, problem, solution, TOLERANCE);
        newton->in_double = true;
        newton->factors_gain = false;   // those at hand are of where Newton failed
        solved = settle(solver);
        solver->rescued += solved;
    }
    if (solved) contact_clean(&newton->equations);

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
    take_count(&solver->sweeps, &from->sweeps);
    take_count(&solver->rescued, &from->rescued);
    take_count(&solver->unsolved, &from->unsolved);
    solver->seconds += from->seconds;
    from->seconds = 0;
}

void contact_solver_archive(ContactSolver *solver, const Interface *interface, Archive *archive)
{
    archive_section(archive, "contact solver");
    contact_newton_archive(&solver->newton, interface, archive);
    archive_counts_of(archive, &solver->solves, &solver->iterations, &solver->fallbacks,
                      &solver->rescued, &solver->unsolved, &solver->sweeps);
}
