// SPDX-License-Identifier: GPL-2.0-or-later
// Order of one solve: guess (the statuses handed in) -> hold what they hold -> Newton step on the
// rest -> r = S v - g -> check every status -> again. Forces are measured by the largest force of
// the problem, velocities by that force over the largest diagonal entry of S. All arrays are the
// solver's own, made once for an interface: nothing is allocated in a solve.
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

// One solve so far.
typedef struct Solve {
    ContactSolver *solver;   // not owned
    ContactNewton *newton;   // the solver's
    ContactScales scales;
    int32_t iterations, limit;
    bool change_all;   // every violated status is changed, not only the worst
    int32_t changes, anchored;   // status sets met; the one that solver->anchor holds
    double least;   // residual so far with these statuses, over the scale of force
    int32_t stalled;   // Newton steps in a row, not of a chord, that did not halve it
    double before;   // residual of the step before, where its matrix was reused
    int32_t started;   // node set slipping alone, by the last change; -1: none
} Solve;

static const Interface *interface_of(const Solve *solve)
{
    return solve->newton->equations.problem->interface;
}

// --- statuses -----------------------------------------------------------------------------------

// Checks all statuses, and changes all that violate their conditions by more than the tolerance, or
// only the worst, if it does by more than `least`; where that one stuck and now slips it is
// remembered (starts_fast). Velocities stay: `settle` brings them in line. false: none is changed.
static bool update_statuses(Solve *solve, double least)
{
    const ContactSolution *at = solve->newton->equations.at;
    int32_t contacts = interface_of(solve)->contact_count;
    int32_t starts = -1;
    double largest = 0;
    uint8_t *worst = NULL, worst_status = 0;
    for (int32_t k = 0; k < contacts + interface_of(solve)->rod_count; k++) {
        double violation;
        bool rod = k >= contacts;
        uint8_t *status = rod ? &at->rod_touches[k - contacts] : &at->status[k];
        uint8_t better =
            rod ? contact_judge_rod(&solve->newton->equations, solve->scales, k - contacts,
                                    &violation)
                : contact_judge_node(&solve->newton->equations, solve->scales, k, &violation);
        if (!(violation > TOLERANCE)) continue;
        if (violation > largest) {
            largest = violation;
            worst = status;
            worst_status = better;
            starts = !rod && *status == CONTACT_STICK && status_slips(better) ? k : -1;
        }
        if (solve->change_all) *status = better;
    }
    if (!(largest > (solve->change_all ? 0 : least))) return false;
    if (!solve->change_all) *worst = worst_status;
    solve->started = starts;
    return true;
}

// The rod's kind decides what a bonded or absent rod does.
static void fix_rod_kind(const ContactProblem *problem, const ContactSolution *solution)
{
    bool bonded = problem->rod_kind == ROD_IS_BONDED;
    if (!bonded && problem->rod_kind != ROD_AWAY) return;
    for (int32_t j = 0; j < problem->interface->rod_count; j++) solution->rod_touches[j] = bonded;
}

// Makes exact what was solved to the tolerance. A node may slip against its status by the
// tolerance, which beside a rod slow enough is more than rounding: it rests, and friction is what
// holds it. What touches nothing has no force, not even rounding.
static void clean_solution(const Solve *solve)
{
    const Interface *interface = interface_of(solve);
    ContactSolution *at = solve->newton->equations.at;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(interface, i);
        uint8_t status = at->status[i];
        if (status_slips(status) && at->velocity[t] * status_direction(status) < 0)
            at->velocity[t] = 0;
        if (status != CONTACT_OPEN) continue;
        at->reaction[t] = 0;
        at->reaction[interface_normal(interface, i)] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (!at->rod_touches[j]) at->reaction[interface_rod(interface, j)] = 0;
    }
}

// --- one solve ----------------------------------------------------------------------------------

// Only the worst status is changed from here on.
static void change_one(Solve *solve)
{
    if (!solve->change_all) return;
    solve->change_all = false;
    solve->limit = solve->iterations + ITERATIONS_ONE;
    solve->solver->fallbacks++;
}

static bool may_go_on(Solve *solve)
{
    if (solve->iterations == solve->limit) change_one(solve);
    return solve->iterations++ < solve->limit;
}

// After statuses have changed. A set met before tells of a cycle (Brent, BIT 20, 1980: compared
// with one set that is kept, and renewed at powers of two).
static void note_statuses(Solve *solve)
{
    solve->least = INFINITY;
    solve->stalled = 0;
    if (solve->changes > 0 &&
        contact_has_statuses(&solve->newton->equations, solve->solver->anchor))
        change_one(solve);
    if (solve->changes++ < 2 * solve->anchored) return;
    solve->anchored = solve->changes;
    contact_copy_statuses(&solve->newton->equations, solve->solver->anchor);
}

// Newton's own steps no longer reduce the residual of these statuses: where friction weakens they
// may have no solution (two met in a fold and are gone).
static bool has_stalled(Solve *solve, double residual)
{
    enum { STALLED_MAX = 4 };
    solve->stalled = residual > solve->least / 2 ? solve->stalled + 1 : 0;
    solve->least = fmin(solve->least, residual);
    return solve->stalled >= STALLED_MAX;
}

// A node whose shear exceeds its threshold at rest, yet which slips against that shear after
// Newton's first step: friction falls faster with its slip rate than S resists, so that slow slip
// is no solution while the others' statuses stay. It starts again beyond the weakening. false: it
// is not so.
static bool starts_fast(Solve *solve)
{
    const ContactProblem *problem = solve->newton->equations.problem;
    int32_t node = solve->started;
    solve->started = -1;
    if (node < 0) return false;
    const ContactEquations *equations = &solve->newton->equations;
    int32_t t = interface_tangent(equations->problem->interface, node);
    double *slip_rate = &equations->at->velocity[t];
    double direction = status_direction(solve->newton->equations.at->status[node]);
    if (*slip_rate * direction >= 0) return false;
    *slip_rate = direction * friction_spent_speed(friction_at(problem->friction, node));
    solve->newton->factors_gain = false;
    solve->least = INFINITY;
    solve->stalled = 0;
    solve->newton->listed = false;
    contact_newton_react(solve->newton);
    return true;
}

// Outcome of a Newton step.
typedef enum Progress { GOES_ON, SOLVED, GIVEN_UP } Progress;

// Statuses are changed after the first solve for them, not where steps are those of a chord: there
// the equations are solved first; nor, where only one may change, before it is clear which.
static Progress judge_step(Solve *solve)
{
    const ContactProblem *problem = solve->newton->equations.problem;
    solve->scales = contact_scales(problem, solve->newton->equations.at->reaction);
    double residual = contact_newton_residual(solve->newton);
    if (!isfinite(residual)) return GIVEN_UP;
    bool equal = residual <= TOLERANCE * solve->scales.force;
    if (equal && !solve->newton->exact) {
        contact_newton_react(solve->newton);
        residual = contact_newton_residual(solve->newton);
        equal = residual <= TOLERANCE * solve->scales.force;
    }
    if (!equal && solve->newton->reused && residual > CHORD_GAIN * solve->before)
        solve->newton->factors_gain = false;
    solve->before = solve->newton->reused ? residual : INFINITY;
    if (!equal && !solve->newton->reused && has_stalled(solve, residual / solve->scales.force))
        return GIVEN_UP;
    if (!equal && solve->newton->reused && solve->change_all) return GOES_ON;
    double off = equal ? 0 : residual / solve->scales.force;
    if (!update_statuses(solve, CLEARLY * off)) return equal ? SOLVED : GOES_ON;
    note_statuses(solve);
    if (solve->change_all) solve->started = -1;
    contact_newton_settle(solve->newton);
    return GOES_ON;
}

// true: equations and all statuses hold, reactions of open nodes are 0 to the bit. false: the limit
// of steps was reached, Newton stalled, nothing holds what is open, a derivative was singular or a
// number not finite; the solution then has no meaning.
static bool solve_statuses(ContactSolver *solver, const ContactProblem *problem,
                           ContactSolution *solution)
{
    ContactNewton *newton = &solver->newton;
    Solve solve = {.solver = solver,
                   .newton = newton,
                   .limit = ITERATIONS_ALL,
                   .change_all = true,
                   .before = INFINITY,
                   .started = -1};
    fix_rod_kind(problem, solution);
    contact_newton_begin(newton, problem, solution, 1e-3 * TOLERANCE);
    note_statuses(&solve);
    while (may_go_on(&solve)) {
        if (!newton->listed && !contact_newton_list(newton)) return false;
        solver->iterations++;
        if (!contact_newton_step(newton)) return false;
        if (starts_fast(&solve)) continue;
        Progress progress = judge_step(&solve);
        if (progress == GIVEN_UP) return false;
        if (progress == SOLVED) {
            clean_solution(&solve);
            return true;
        }
    }
    return false;
}

static bool solve_discs(ContactSolver *solver, const ContactProblem *problem,
                        ContactSolution *solution)
{
    ContactDiscs *discs = &solver->discs;
    fix_rod_kind(problem, solution);
    int64_t before = discs->iterations, swept = discs->swept;
    bool solved = contact_discs_solve(discs, TOLERANCE, problem, solution);
    solver->iterations += discs->iterations - before;
    solver->fallbacks += discs->swept - swept;
    solver->rescued += solved && discs->swept > swept;
    return solved;
}

// The result of sweeps, from rest in each round, is handed to Newton once more, which brings the
// last digits and has the last word on whether it is solved.
static bool solve_plane(ContactSolver *solver, const ContactProblem *problem,
                        ContactSolution *solution)
{
    bool solved = solve_statuses(solver, problem, solution);
    for (int32_t k = 0; solver->sweeps_on && k < SWEEP_ROUNDS && !solved; k++) {
        memset(solution->velocity, 0, (size_t)problem->interface->count * sizeof(double));
        solver->sweeps += contact_sweep(problem, solution, k);
        solved = solve_statuses(solver, problem, solution);
        solver->rescued += solved;
    }
    return solved;
}

bool contact_solve(ContactSolver *solver, const ContactProblem *problem, ContactSolution *solution)
{
    double started = clock_seconds();
    bool plane = problem->interface->dim == 2;
    bool solved = plane ? solve_plane(solver, problem, solution)
                        : solve_discs(solver, problem, solution);
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
