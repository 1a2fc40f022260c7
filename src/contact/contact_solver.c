// SPDX-License-Identifier: GPL-2.0-or-later
// Order of one solve: guess (the statuses handed in) -> hold what they hold -> Newton step on the
// rest -> r = S v - g -> check every status -> again. Forces are measured by the largest force of
// the problem, velocities by that force over the largest diagonal entry of S. All arrays are the
// solver's own, made once for an interface: nothing is allocated in a solve.
#include "contact/contact_solver.h"

#include "base/clock.h"
#include "base/dense.h"
#include "base/memory.h"
#include "contact/contact_equations.h"

#include <math.h>
#include <string.h>

// An old matrix is given up when the residual of a step is above this part of that before it.
static const double CHORD_GAIN = 0.1;

// Where one status is changed at a time: the worst violates its condition by this many times what
// the equations are off, at least. Then it does so at their solution, too.
static const double CLEARLY = 100;

// The header says what the numbers rest on.
ContactSolverDef contact_solver_def(void)
{
    return (ContactSolverDef){
        .iterations_all = 30, .iterations_one = 200, .iterations_short = 40, .tolerance = 1e-12};
}

// *solver is overwritten; on failure contact_solver_destroy frees what was made.
bool contact_solver_create(const Interface *interface, ContactSolverDef def, ContactSolver *solver,
                           Error *err)
{
    int64_t count = interface->count;
    *solver = (ContactSolver){.def = def, .follows_path = true};
    solver->free = NEW_ARRAY(int32_t, count, err);
    solver->open = NEW_ARRAY(int32_t, count, err);
    solver->row = NEW_ARRAY(ContactRow, count, err);
    solver->step = NEW_ARRAY(double, count, err);
    solver->more = NEW_ARRAY(double, count, err);
    solver->pull = NEW_ARRAY(double, count, err);
    solver->anchor = NEW_ARRAY(uint8_t, interface->contact_count + interface->rod_count, err);
    return error_is_clean(err) && contact_factors_create(interface, &solver->factors, err) &&
           contact_path_create(interface, &solver->path, err);
}

void contact_solver_destroy(ContactSolver *solver)
{
    contact_path_destroy(&solver->path);
    contact_factors_destroy(&solver->factors);
    memory_free(solver->free);
    memory_free(solver->open);
    memory_free(solver->row);
    memory_free(solver->step);
    memory_free(solver->more);
    memory_free(solver->pull);
    memory_free(solver->anchor);
    *solver = (ContactSolver){0};
}

// One solve so far.
typedef struct Solve {
    ContactSolver *solver;   // not owned
    ContactEquations equations;   // free: tangents of nodes that slip, rod nodes that are soft or
        // do not touch; ascending. Open nodes are free as well, and condensed out
    int32_t open_count;   // unknowns of open nodes, in solver->open
    ContactScales scales;
    int32_t iterations, limit;
    bool change_all;   // every violated status is changed, not only the worst
    const double *closed;   // S': S with open nodes condensed out
    bool listed;   // what is free, open and closed is that of the statuses, and solver->step has
        // the residuals of what is free
    bool exact;   // reactions are S v - g, not what steps added up to
    bool reused;   // the last step was one with the factors of an earlier matrix
    int32_t changes, anchored;   // status sets met; the one that solver->anchor holds
    double least;   // residual so far with these statuses, over the scale of force
    int32_t stalled;   // Newton steps in a row, not of a chord, that did not halve it
    double before;   // residual of the step before, where its matrix was reused
    int32_t started;   // node set slipping alone, by the last change; -1: none
} Solve;

static const Interface *interface_of(const Solve *solve)
{
    return solve->equations.problem->interface;
}

static void react(Solve *solve)
{
    contact_react(&solve->equations);
    solve->exact = true;
}

// --- Newton -------------------------------------------------------------------------------------

// Held unknowns take their values, and r is that of the velocities as they are then. A node that
// would slip against its status starts from rest. known: r is that of the velocities as they are
// now; it stays where none of them changes, as when nodes that stuck begin to slip.
static void settle(Solve *solve, bool known)
{
    const ContactSolution *at = solve->equations.at;
    solve->listed = false;
    bool moved = contact_hold(&solve->equations);
    for (int32_t i = 0; i < interface_of(solve)->contact_count; i++) {
        double *slip_rate = &at->velocity[interface_tangent(i)];
        if (status_slips(at->status[i]) && *slip_rate * status_direction(at->status[i]) < 0) {
            *slip_rate = 0;
            moved = true;
        }
    }
    if (moved || !known) react(solve);
}

// For the statuses as they are. false: nothing holds the open nodes.
static bool list_free(Solve *solve)
{
    const ContactProblem *problem = solve->equations.problem;
    const ContactSolution *at = solve->equations.at;
    int32_t *free = solve->equations.free, count = 0;
    solve->closed =
        contact_matrix_close(problem->matrix, at->status, problem->interface->contact_count);
    if (!solve->closed) return false;
    solve->open_count = 0;
    for (int32_t i = 0; i < problem->interface->contact_count; i++) {
        if (status_slips(at->status[i])) free[count++] = interface_tangent(i);
        if (at->status[i] != CONTACT_OPEN) continue;
        solve->solver->open[solve->open_count++] = interface_tangent(i);
        solve->solver->open[solve->open_count++] = interface_normal(i);
    }
    for (int32_t j = 0; j < problem->interface->rod_count; j++) {
        if (!at->rod_touches[j] || rod_stiffness(problem, j) > 0)
            free[count++] = interface_rod(problem->interface, j);
    }
    solve->equations.free_count = count;
    contact_find_rows(&solve->equations);
    contact_residuals(&solve->equations, solve->solver->step);
    solve->listed = true;
    return true;
}

// What is kept is of this matrix. Of the last factorisation only: what was left at another step
// size is too old to gain a digit a step (on Figure 1 it cost 2 % of Newton's steps more).
static bool factors_are_of(const Solve *solve)
{
    int64_t factored = solve->equations.problem->matrix->factored;
    return factored > 0 && factored == solve->solver->factorisations;
}

// Anew. false: the derivative is singular.
static bool factor(Solve *solve)
{
    ContactSolver *solver = solve->solver;
    solver->factorisations++;
    bool regular = contact_factors_make(&solver->factors, &solve->equations, solve->closed);
    solve->equations.problem->matrix->factored = regular ? solver->factorisations : 0;
    return regular;
}

// The factors are those of the derivative, or of one with these statuses with which steps still
// gain. false: the derivative is singular.
static bool find_factors(Solve *solve)
{
    ContactSolver *solver = solve->solver;
    bool kept = factors_are_of(solve);
    solve->reused = kept && solver->factors_gain &&
                    contact_has_statuses(&solve->equations, solver->factors.status);
    if (solve->reused) return true;
    if (kept && contact_factors_update(&solver->factors, &solve->equations, solve->closed))
        solver->updates++;
    else if (!factor(solve))
        return false;
    solver->factors_gain = true;
    return true;
}

// pull = S' r_O: what the forces at open nodes, which shall have none, do to all others when they
// are taken away and, on O, -S_OO^-1 r_O: how these nodes would move if nothing else did. Rounding
// is left as it is.
static void find_pull(Solve *solve)
{
    ContactSolver *solver = solve->solver;
    const ContactProblem *problem = solve->equations.problem;
    int32_t count = problem->interface->count;
    double rounding = 1e-3 * solver->def.tolerance * dense_max_abs(problem->g, count);
    bool pulls = false;
    memset(solver->pull, 0, (size_t)count * sizeof(double));
    memset(solver->more, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < solve->open_count; a++) {
        int32_t k = solver->open[a];
        double force = solve->equations.at->reaction[k];
        if (fabs(force) <= rounding) continue;
        solver->more[k] = force;
        pulls = true;
    }
    if (pulls)
        dense_add_nonzero((DenseView){solve->closed, count, count}, solver->more, 1, solver->pull);
}

// Velocities and reactions after a step of what is free. Where nodes are open one product with S'
// gives what the step adds to the reactions of the others and how open nodes follow; S v, which
// has their columns too, is left to the end.
static void take_step(Solve *solve)
{
    ContactSolver *solver = solve->solver;
    ContactSolution *at = solve->equations.at;
    int32_t count = interface_of(solve)->count, free_count = solve->equations.free_count;
    for (int32_t a = 0; a < free_count; a++) at->velocity[solver->free[a]] += solver->step[a];
    if (solve->open_count == 0) {
        react(solve);
        return;
    }
    memset(solver->more, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < free_count; a++) solver->more[solver->free[a]] = solver->step[a];
    dense_add_nonzero((DenseView){solve->closed, count, count}, solver->more, -1, solver->pull);
    for (int32_t k = 0; k < count; k++) at->reaction[k] -= solver->pull[k];
    for (int32_t b = 0; b < solve->open_count; b++) {
        int32_t unknown = solver->open[b];
        at->velocity[unknown] += solver->pull[unknown];
        at->reaction[unknown] = 0;
    }
    solve->exact = false;
}

// One Newton step on the free unknowns and the open nodes. false: the derivative is singular. With
// factors of an earlier one it is a step of a chord method: linear in convergence, and far cheaper
// than factoring.
static bool newton_step(Solve *solve)
{
    ContactSolver *solver = solve->solver;
    const ContactEquations *equations = &solve->equations;
    int32_t free_count = equations->free_count;
    solver->iterations++;
    if (!find_factors(solve)) return false;
    for (int32_t a = 0; a < free_count; a++) solver->step[a] = -solver->step[a];
    if (solve->open_count > 0) {
        find_pull(solve);
        contact_combine(equations, solver->pull, solver->more);
        dense_add_scaled(1, solver->more, free_count, solver->step);
    }
    if (!contact_factors_solve(&solver->factors, equations, solver->step) &&
        !(factor(solve) && contact_factors_solve(&solver->factors, equations, solver->step)))
        return false;
    take_step(solve);
    return true;
}

// --- statuses -----------------------------------------------------------------------------------

// Checks all statuses, and changes all that violate their conditions by more than the tolerance, or
// only the worst, if it does by more than `least`; where that one stuck and now slips it is
// remembered (starts_fast). Velocities stay: `settle` brings them in line. false: none is changed.
static bool update_statuses(Solve *solve, double least)
{
    const ContactSolution *at = solve->equations.at;
    int32_t contacts = interface_of(solve)->contact_count;
    int32_t starts = -1;
    double largest = 0;
    uint8_t *worst = NULL, worst_status = 0;
    for (int32_t k = 0; k < contacts + interface_of(solve)->rod_count; k++) {
        double violation;
        bool rod = k >= contacts;
        uint8_t *status = rod ? &at->rod_touches[k - contacts] : &at->status[k];
        uint8_t better =
            rod ? contact_judge_rod(&solve->equations, solve->scales, k - contacts, &violation)
                : contact_judge_node(&solve->equations, solve->scales, k, &violation);
        if (!(violation > solve->solver->def.tolerance)) continue;
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

// Of the free unknowns' equations, which it leaves in solver->step, and the forces at open nodes,
// force/width; infinite where a number is not finite.
static double largest_residual(const Solve *solve)
{
    const ContactEquations *equations = &solve->equations;
    double largest = 0, *left = solve->solver->step;
    contact_find_rows(equations);
    contact_residuals(equations, left);
    for (int32_t a = 0; a < equations->free_count; a++) {
        if (!isfinite(left[a])) return INFINITY;
        if (fabs(left[a]) > largest) largest = fabs(left[a]);
    }
    for (int32_t a = 0; a < solve->open_count; a++) {
        double force = equations->at->reaction[solve->solver->open[a]];
        if (!isfinite(force)) return INFINITY;
        largest = fmax(largest, fabs(force));
    }
    return largest;
}

// The rod's kind decides what a bonded or absent rod does.
static void fix_rod_kind(const Solve *solve)
{
    const ContactProblem *problem = solve->equations.problem;
    uint8_t *touches = solve->equations.at->rod_touches;
    size_t rods = (size_t)problem->interface->rod_count;
    if (problem->rod_kind == ROD_AWAY) memset(touches, 0, rods);
    if (problem->rod_kind == ROD_IS_BONDED) memset(touches, 1, rods);
}

// What is left to the tolerance becomes exact. A node may slip against its status by the tolerance,
// which beside a rod slow enough is more than rounding: it rests, and friction is what holds it.
// What touches nothing has no force, not even rounding.
static void clean_solution(const Solve *solve)
{
    const Interface *interface = interface_of(solve);
    ContactSolution *at = solve->equations.at;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(i);
        uint8_t status = at->status[i];
        if (status_slips(status) && at->velocity[t] * status_direction(status) < 0)
            at->velocity[t] = 0;
        if (status != CONTACT_OPEN) continue;
        at->reaction[t] = 0;
        at->reaction[interface_normal(i)] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (!at->rod_touches[j]) at->reaction[interface_rod(interface, j)] = 0;
    }
}

// --- one solve ----------------------------------------------------------------------------------

// Only the worst status is changed from here on.
static void change_one(Solve *solve)
{
    const ContactSolver *solver = solve->solver;
    if (!solve->change_all) return;
    solve->change_all = false;
    solve->limit = solve->iterations + (solver->follows_path ? solver->def.iterations_one
                                                             : solver->def.iterations_short);
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
    if (solve->changes > 0 && contact_has_statuses(&solve->equations, solve->solver->anchor))
        change_one(solve);
    if (solve->changes++ < 2 * solve->anchored) return;
    solve->anchored = solve->changes;
    contact_copy_statuses(&solve->equations, solve->solver->anchor);
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
    const ContactProblem *problem = solve->equations.problem;
    int32_t node = solve->started;
    solve->started = -1;
    if (node < 0) return false;
    double *slip_rate = &solve->equations.at->velocity[interface_tangent(node)];
    double direction = status_direction(solve->equations.at->status[node]);
    if (*slip_rate * direction >= 0) return false;
    *slip_rate = direction * friction_spent_speed(friction_at(problem->law, node));
    solve->solver->factors_gain = false;
    solve->least = INFINITY;
    solve->stalled = 0;
    solve->listed = false;
    react(solve);
    return true;
}

// What a Newton step comes to.
typedef enum Progress { GOES_ON, SOLVED, GIVEN_UP } Progress;

// Statuses are changed after the first solve for them, not where steps are those of a chord: there
// the equations are solved first; nor, where only one may change, before it is clear which.
static Progress judge_step(Solve *solve)
{
    const ContactProblem *problem = solve->equations.problem;
    solve->scales = contact_scales(problem, solve->equations.at->reaction);
    double residual = largest_residual(solve);
    if (!isfinite(residual)) return GIVEN_UP;
    bool equal = residual <= solve->solver->def.tolerance * solve->scales.force;
    if (equal && !solve->exact) {
        react(solve);
        residual = largest_residual(solve);
        equal = residual <= solve->solver->def.tolerance * solve->scales.force;
    }
    if (!equal && solve->reused && residual > CHORD_GAIN * solve->before)
        solve->solver->factors_gain = false;
    solve->before = solve->reused ? residual : INFINITY;
    if (!equal && !solve->reused && has_stalled(solve, residual / solve->scales.force))
        return GIVEN_UP;
    if (!equal && solve->reused && solve->change_all) return GOES_ON;
    double off = equal ? 0 : residual / solve->scales.force;
    if (!update_statuses(solve, CLEARLY * off)) return equal ? SOLVED : GOES_ON;
    note_statuses(solve);
    if (solve->change_all) solve->started = -1;
    settle(solve, true);
    return GOES_ON;
}

// true: equations and all statuses hold, reactions of open nodes are 0 to the bit. false: the limit
// of steps was reached, Newton stalled, nothing holds what is open, a derivative was singular or a
// number not finite; the solution then has no meaning.
static bool solve_statuses(ContactSolver *solver, const ContactProblem *problem,
                           ContactSolution *solution)
{
    Solve solve = {
        .solver = solver,
        .equations = {.problem = problem, .at = solution, .free = solver->free, .row = solver->row},
        .limit = solver->def.iterations_all,
        .change_all = true,
        .before = INFINITY,
        .started = -1};
    fix_rod_kind(&solve);
    note_statuses(&solve);
    settle(&solve, false);
    while (may_go_on(&solve)) {
        if (!solve.listed && !list_free(&solve)) return false;
        if (!newton_step(&solve)) return false;
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

// After a path was followed its end is handed to Newton once more, which brings the last digits and
// has the last word on whether it is solved.
bool contact_solve(ContactSolver *solver, const ContactProblem *problem, ContactSolution *solution)
{
    double started = clock_seconds();
    bool solved = solve_statuses(solver, problem, solution);
    if (!solved && solver->follows_path && contact_path_follow(&solver->path, problem, solution)) {
        solved = solve_statuses(solver, problem, solution);
        solver->rescued += solved;
    }
    solver->solves++;
    solver->unsolved += !solved;
    solver->seconds += clock_seconds() - started;
    return solved;
}
