// SPDX-License-Identifier: GPL-2.0-or-later
// Order of one solve: guess (the statuses handed in) -> hold what they hold -> Newton step on the
// rest -> r = S v - g -> check every status -> again. Forces are measured by the largest force of
// the problem, velocities by that force over the largest diagonal entry of S. All arrays are the
// solver's own, made once for an interface: nothing is allocated in a solve.
#include "contact/contact_solver.h"

#include "base/clock.h"
#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// An old matrix is given up when the residual of a step is above this part of that before it.
static const double CHORD_GAIN = 0.1;

// The header says what the numbers rest on.
ContactSolverDef contact_solver_def(void)
{
    return (ContactSolverDef){
        .iterations_all = 30, .iterations_one = 200, .iterations_short = 40, .tolerance = 1e-12};
}

// Dense matrices of interface->count squared: for the interface's own size, whatever the mesh.
// *solver is overwritten; on failure contact_solver_destroy frees what was made.
bool contact_solver_create(const Interface *interface, ContactSolverDef def, ContactSolver *solver,
                           Error *err)
{
    int64_t count = interface->count;
    *solver = (ContactSolver){.def = def, .follows_path = true};
    solver->free = NEW_ARRAY(int32_t, count, err);
    solver->open = NEW_ARRAY(int32_t, count, err);
    solver->step = NEW_ARRAY(double, count, err);
    solver->pull = NEW_ARRAY(double, count, err);
    solver->anchor = NEW_ARRAY(uint8_t, interface->contact_count + interface->rod_count, err);
    return error_is_clean(err) && contact_path_create(interface, &solver->path, err);
}

void contact_solver_destroy(ContactSolver *solver)
{
    contact_path_destroy(&solver->path);
    memory_free(solver->free);
    memory_free(solver->open);
    memory_free(solver->step);
    memory_free(solver->pull);
    memory_free(solver->anchor);
    *solver = (ContactSolver){0};
}

// What one pass over the statuses found.
typedef struct Violation {
    int32_t broken;   // statuses that break their conditions
    double worst;   // the largest violation, in units of the scales
    int32_t worst_node;   // contact node, or contact_count + rod node
    double force;   // residual of the free unknowns' equations, relative
} Violation;

// Scales that make forces and velocities comparable, and the rounding level of each.
typedef struct Scales {
    double force, velocity;
} Scales;

// From the reaction as it is now as well as from g, for what presses may come through the bounds
// alone. Never 0.
static Scales problem_scales(const ContactProblem *problem, const ContactSolution *solution)
{
    int32_t count = problem->interface->count;
    double diagonal = 0;
    for (int32_t k = 0; k < count; k++)
        diagonal = fmax(diagonal, problem->matrix->schur[(int64_t)k * count + k]);
    Scales scales;
    scales.force = fmax(dense_max_abs(problem->g, count), dense_max_abs(solution->reaction, count));
    if (scales.force == 0) scales.force = 1;
    scales.velocity = scales.force / diagonal;
    return scales;
}

// The held unknowns take their values; slipping and open ones keep what they had.
static void hold_unknowns(const ContactProblem *problem, ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (solution->status[i] == CONTACT_OPEN) continue;
        int32_t n = interface_normal(i), t = interface_tangent(i);
        solution->velocity[n] = problem->bound[n];
        if (solution->status[i] == CONTACT_STICK) solution->velocity[t] = 0;
        if (status_slips(solution->status[i]) &&
            solution->velocity[t] * status_direction(solution->status[i]) < 0)
            solution->velocity[t] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        if (solution->rod_touches[j] && rod_stiffness(problem, j) == 0)
            solution->velocity[x] = problem->bound[x];
    }
}

// Into free: tangents of nodes that slip, rod nodes that are soft or have let go. How many they
// are; ascending. Open nodes are free as well, and condensed out (contact/contact_matrix): their
// unknowns go into solver->open.
static int32_t list_free(ContactSolver *solver, const ContactProblem *problem,
                         const ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    int32_t count = 0;
    solver->open_count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (status_slips(solution->status[i])) solver->free[count++] = interface_tangent(i);
        if (solution->status[i] != CONTACT_OPEN) continue;
        solver->open[solver->open_count++] = interface_tangent(i);
        solver->open[solver->open_count++] = interface_normal(i);
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (!solution->rod_touches[j] || rod_stiffness(problem, j) > 0)
            solver->free[count++] = interface_rod(interface, j);
    }
    return count;
}

// r = S v - g
static void compute_reaction(const ContactProblem *problem, ContactSolution *solution)
{
    int32_t count = problem->interface->count;
    dense_symmetric_apply(problem->matrix->schur, count, solution->velocity, solution->reaction);
    for (int32_t k = 0; k < count; k++) solution->reaction[k] -= problem->g[k];
}

// The slipping node an unknown is the tangent of, or -1.
static int32_t slipping_node(const ContactProblem *problem, const ContactSolution *solution,
                             int32_t unknown)
{
    if (unknown >= 2 * problem->interface->contact_count || unknown % 2 != 0) return -1;
    return status_slips(solution->status[unknown / 2]) ? unknown / 2 : -1;
}

// The stiffness of the spring that holds a free unknown: that of a soft rod node which touches.
static double spring_of(const ContactProblem *problem, const ContactSolution *solution,
                        int32_t unknown)
{
    int32_t j = unknown - 2 * problem->interface->contact_count;
    return j >= 0 && solution->rod_touches[j] ? rod_stiffness(problem, j) : 0;
}

// The equation of a free unknown: r = 0, r_t + s mu(|v_t|) r_n = 0 where it slips, or
// r_x = stiffness (bound_x - v_x) at a soft rod node.
static double equation(const ContactProblem *problem, const ContactSolution *solution,
                       int32_t unknown)
{
    int32_t i = slipping_node(problem, solution, unknown);
    double spring = spring_of(problem, solution, unknown);
    if (i < 0)
        return solution->reaction[unknown] +
               (spring > 0 ? spring * (solution->velocity[unknown] - problem->bound[unknown]) : 0);
    double mu = friction_coefficient(problem->law, fabs(solution->velocity[unknown]));
    return solution->reaction[unknown] +
           status_direction(solution->status[i]) * mu * solution->reaction[interface_normal(i)];
}

// The factors of an earlier step still fit: same matrix, same unknowns, same directions. Of the
// last factorisation only: what was left behind at another step size has aged too far to gain a
// digit a step (on Figure 1 it cost 2 % of Newton's steps more).
static bool kept_fits(const ContactSolver *solver, const ContactProblem *problem,
                      const ContactSolution *solution, int32_t free_count)
{
    size_t contacts = (size_t)problem->interface->contact_count;
    size_t rods = (size_t)problem->interface->rod_count;
    const ContactMatrix *kept = problem->matrix;
    return kept->factored == solver->factorisations && kept->factored > 0 &&
           kept->free_count == free_count &&
           memcmp(kept->status, solution->status, contacts) == 0 &&
           memcmp(kept->status + contacts, solution->rod_touches, rods) == 0 &&
           memcmp(kept->free, solver->free, (size_t)free_count * sizeof(int32_t)) == 0;
}

// The derivative of `equation` by the free unknowns, column after column [free_count^2], and its
// LU:
//     row of a slipping tangent t:  S'_t + s mu S'_n + mu'(|v_t|) r_n e_t
//     any other:                    S'_row + spring e_row
// S' (`closed`): S with what is open condensed out. s^2 = 1 makes the last term of a slipping row
// free of the direction: d|v_t|/dv_t = s. false: it is singular. The matrix keeps it.
static bool factor_matrix(ContactSolver *solver, const ContactProblem *problem,
                          const ContactSolution *solution, const double *closed, int32_t free_count)
{
    int32_t count = problem->interface->count;
    ContactMatrix *kept = problem->matrix;
    for (int32_t a = 0; a < free_count; a++) {
        int32_t row = solver->free[a];
        const double *own = closed + (int64_t)row * count;   // symmetric
        int32_t i = slipping_node(problem, solution, row);
        double *out = kept->factors + a;
        for (int32_t b = 0; b < free_count; b++)
            out[(int64_t)b * free_count] = own[solver->free[b]];
        out[(int64_t)a * free_count] += spring_of(problem, solution, row);
        if (i < 0) continue;
        double speed = fabs(solution->velocity[row]);
        double mu = status_direction(solution->status[i]) *
                    friction_coefficient(problem->law, speed);
        const double *normal = closed + (int64_t)interface_normal(i) * count;
        for (int32_t b = 0; b < free_count; b++)
            out[(int64_t)b * free_count] += mu * normal[solver->free[b]];
        out[(int64_t)a * free_count] += friction_slope(problem->law, speed) *
                                        solution->reaction[interface_normal(i)];
    }
    solver->factorisations++;
    bool regular = dense_lu(kept->factors, free_count, kept->pivots);
    kept->factored = regular ? solver->factorisations : 0;
    kept->free_count = free_count;
    size_t contacts = (size_t)problem->interface->contact_count;
    memcpy(kept->status, solution->status, contacts);
    memcpy(kept->status + contacts, solution->rod_touches, (size_t)problem->interface->rod_count);
    memcpy(kept->free, solver->free, (size_t)free_count * sizeof(int32_t));
    return regular;
}

// pull = closed e_O: what the residual of open nodes, which shall bear nothing, asks of all others
// and, on O, -S_OO^-1 e_O: how these would move if nothing else did. Rounding is left as it is.
static void find_pull(ContactSolver *solver, const ContactProblem *problem,
                      const ContactSolution *solution, const double *closed)
{
    int32_t count = problem->interface->count;
    double rounding = 1e-3 * solver->def.tolerance * dense_max_abs(problem->g, count);
    memset(solver->pull, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < solver->open_count; a++) {
        int32_t k = solver->open[a];
        if (fabs(solution->reaction[k]) > rounding)
            dense_add_scaled(solution->reaction[k], closed + (int64_t)k * count, count,
                             solver->pull);
    }
}

// One Newton step on the free unknowns and what is open; *reused: with a matrix of an earlier one.
// false: the matrix is singular. With a kept matrix the step is one of a chord method: right in
// direction, linear in convergence, and far cheaper than factoring.
static bool newton_step(ContactSolver *solver, const ContactProblem *problem,
                        ContactSolution *solution, const double *closed, int32_t free_count,
                        bool *reused)
{
    int32_t count = problem->interface->count;
    *reused = kept_fits(solver, problem, solution, free_count);
    if (!*reused && !factor_matrix(solver, problem, solution, closed, free_count)) return false;
    bool opens = solver->open_count > 0;
    if (opens) find_pull(solver, problem, solution, closed);
    for (int32_t a = 0; a < free_count; a++) {
        int32_t row = solver->free[a], i = slipping_node(problem, solution, row);
        solver->step[a] = -equation(problem, solution, row);
        if (opens) solver->step[a] += solver->pull[row];
        if (i < 0 || !opens) continue;
        double mu = friction_coefficient(problem->law, fabs(solution->velocity[row]));
        solver->step[a] += status_direction(solution->status[i]) * mu *
                           solver->pull[interface_normal(i)];
    }
    dense_lu_solve(problem->matrix->factors, free_count, problem->matrix->pivots, solver->step);
    for (int32_t a = 0; a < free_count; a++) {
        int32_t unknown = solver->free[a];
        solution->velocity[unknown] += solver->step[a];
        if (!opens) continue;
        dense_add_scaled(-solver->step[a], closed + (int64_t)unknown * count, count, solver->pull);
    }
    for (int32_t a = 0; a < solver->open_count; a++)
        solution->velocity[solver->open[a]] += solver->pull[solver->open[a]];
    return true;
}

// The status a contact node should have by its own conditions, and by how much it breaks them now.
static uint8_t judge_contact(const ContactProblem *problem, const ContactSolution *solution,
                             Scales scales, int32_t i, double *violation)
{
    int32_t n = interface_normal(i), t = interface_tangent(i);
    uint8_t status = solution->status[i];
    double pressing = solution->reaction[n], shear = solution->reaction[t];
    if (status == CONTACT_OPEN) {
        // It lands with the tangential velocity it has: held at once it may want to open again.
        *violation = (problem->bound[n] - solution->velocity[n]) / scales.velocity;
        if (solution->velocity[t] == 0) return CONTACT_STICK;
        return solution->velocity[t] > 0 ? CONTACT_SLIP_FORWARD : CONTACT_SLIP_BACKWARD;
    }
    *violation = -pressing / scales.force;
    if (*violation > 0) return CONTACT_OPEN;
    if (status == CONTACT_STICK) {
        *violation = (fabs(shear) - problem->law->mu_static * pressing) / scales.force;
        return shear < 0 ? CONTACT_SLIP_FORWARD : CONTACT_SLIP_BACKWARD;
    }
    *violation = -solution->velocity[t] * status_direction(status) / scales.velocity;
    return CONTACT_STICK;
}

// 1 where it should touch. Only a pushing rod can change its mind: 0 violation for the others.
static uint8_t judge_rod(const ContactProblem *problem, const ContactSolution *solution,
                         Scales scales, int32_t j, double *violation)
{
    int32_t x = interface_rod(problem->interface, j);
    *violation = 0;
    if (problem->rod_kind != ROD_PUSHES) return solution->rod_touches[j];
    if (solution->rod_touches[j])
        *violation = -solution->reaction[x] / scales.force;
    else
        *violation = (problem->bound[x] - solution->velocity[x]) / scales.velocity;
    return !solution->rod_touches[j];
}

// Checks all statuses; changes all broken ones, or only the worst.
// *solution's statuses change, its velocities do not: hold_unknowns brings them in line. A
// violation is in units of the scales, and counts above the solver's tolerance.
static Violation update_statuses(const ContactSolver *solver, const ContactProblem *problem,
                                 ContactSolution *solution, Scales scales, bool change_all)
{
    const Interface *interface = problem->interface;
    int32_t contacts = interface->contact_count;
    double threshold = solver->def.tolerance;
    Violation found = {.worst_node = -1};
    uint8_t worst_status = 0;
    for (int32_t k = 0; k < contacts + interface->rod_count; k++) {
        double violation;
        uint8_t better = k < contacts
                             ? judge_contact(problem, solution, scales, k, &violation)
                             : judge_rod(problem, solution, scales, k - contacts, &violation);
        if (!(violation > threshold)) continue;
        found.broken++;
        if (violation > found.worst) {
            found.worst = violation;
            found.worst_node = k;
            worst_status = better;
        }
        if (change_all && k < contacts) solution->status[k] = better;
        if (change_all && k >= contacts) solution->rod_touches[k - contacts] = better;
    }
    if (!change_all && found.broken > 0) {
        if (found.worst_node < contacts)
            solution->status[found.worst_node] = worst_status;
        else
            solution->rod_touches[found.worst_node - contacts] = worst_status;
    }
    return found;
}

// Force per width; infinite where a number is not finite.
static double equations_residual(const ContactSolver *solver, const ContactProblem *problem,
                                 const ContactSolution *solution, int32_t free_count)
{
    double largest = 0;
    for (int32_t a = 0; a < free_count + solver->open_count; a++) {
        double left = a < free_count ? equation(problem, solution, solver->free[a])
                                     : solution->reaction[solver->open[a - free_count]];
        if (!isfinite(left)) return INFINITY;
        largest = fmax(largest, fabs(left));
    }
    return largest;
}

// Statuses that settle what is not in question: the rod's kind decides a bonded or absent rod.
static void fix_rod_kind(const ContactProblem *problem, ContactSolution *solution)
{
    for (int32_t j = 0; j < problem->interface->rod_count; j++) {
        if (problem->rod_kind == ROD_AWAY) solution->rod_touches[j] = 0;
        if (problem->rod_kind == ROD_IS_BONDED) solution->rod_touches[j] = 1;
    }
}

// A node may slip backwards in its status by the tolerance, which beside a rod slow enough is more
// than rounding: it rests, and friction is what holds it.
static void stop_reversed(const ContactProblem *problem, ContactSolution *solution)
{
    for (int32_t i = 0; i < problem->interface->contact_count; i++) {
        double *slip_rate = &solution->velocity[interface_tangent(i)];
        if (status_slips(solution->status[i]) &&
            *slip_rate * status_direction(solution->status[i]) < 0)
            *slip_rate = 0;
    }
}

// What touches nothing feels nothing, not even rounding.
static void free_reactions(const ContactProblem *problem, ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (solution->status[i] != CONTACT_OPEN) continue;
        solution->reaction[interface_tangent(i)] = 0;
        solution->reaction[interface_normal(i)] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (!solution->rod_touches[j]) solution->reaction[interface_rod(interface, j)] = 0;
    }
}

// What a solve remembers of its own course.
typedef struct Course {
    int32_t iterations, limit;
    bool change_all;
    int32_t changes, anchored;   // status sets met; the one that solver->anchor holds
    double least;   // residual so far with these statuses, over the scale of force
    int32_t stalled;   // steps of Newton's own in a row that did not halve it
    double before;   // residual of the step before, where its matrix was reused
    int32_t started;   // node set slipping alone, by the last change; -1: none
    bool landed;   // what floated was put on the plane, once
} Course;

// Only the worst status is changed from here on.
static void change_one(ContactSolver *solver, Course *course)
{
    if (!course->change_all) return;
    course->change_all = false;
    course->limit = course->iterations + (solver->follows_path ? solver->def.iterations_one
                                                               : solver->def.iterations_short);
    solver->fallbacks++;
}

static bool may_go_on(ContactSolver *solver, Course *course)
{
    if (course->iterations == course->limit) change_one(solver, course);
    return course->iterations++ < course->limit;
}

// After statuses have changed. A set met before means that they go round in a cycle (Brent, BIT 20,
// 1980: compared with one set kept, which is renewed at powers of two).
static void note_statuses(ContactSolver *solver, const ContactProblem *problem,
                          const ContactSolution *solution, Course *course)
{
    size_t contacts = (size_t)problem->interface->contact_count;
    size_t rods = (size_t)problem->interface->rod_count;
    course->least = INFINITY;
    course->stalled = 0;
    bool met = course->changes > 0 && memcmp(solver->anchor, solution->status, contacts) == 0 &&
               memcmp(solver->anchor + contacts, solution->rod_touches, rods) == 0;
    if (met) change_one(solver, course);
    if (course->changes++ < 2 * course->anchored) return;
    course->anchored = course->changes;
    memcpy(solver->anchor, solution->status, contacts);
    memcpy(solver->anchor + contacts, solution->rod_touches, rods);
}

// Newton's own steps no longer bring the equations of these statuses nearer: where friction weakens
// they may have no solution (two that met and are gone).
static bool has_stalled(Course *course, double residual)
{
    enum { STALLED_MAX = 4 };
    course->stalled = residual > course->least / 2 ? course->stalled + 1 : 0;
    course->least = fmin(course->least, residual);
    return course->stalled >= STALLED_MAX;
}

// After the only change of statuses. A node that slips now where it stuck is watched.
static void note_start(const ContactProblem *problem, const ContactSolution *solution, int32_t node,
                       Course *course)
{
    bool contact = node >= 0 && node < problem->interface->contact_count;
    bool starts = contact && status_slips(solution->status[node]) &&
                  solution->velocity[interface_tangent(node)] == 0;
    course->started = starts ? node : -1;
}

// A node that is overloaded where it sticks, yet slips backwards by Newton's first step from there:
// friction falls faster with its slip than the block resists, the others' statuses as they are.
// Beyond the weakening lies what solves that. false: it is not so.
static bool starts_fast(const ContactProblem *problem, ContactSolution *solution, Course *course)
{
    int32_t node = course->started;
    course->started = -1;
    if (node < 0) return false;
    double *slip_rate = &solution->velocity[interface_tangent(node)];
    double direction = status_direction(solution->status[node]);
    if (*slip_rate * direction >= 0) return false;
    *slip_rate = direction * friction_spent_speed(problem->law);
    problem->matrix->factored = 0;
    course->least = INFINITY;
    course->stalled = 0;
    compute_reaction(problem, solution);
    return true;
}

// S with what is open condensed out. Where that floats, nothing holding it but what lands, all of
// it is put on the plane, once: what then pulls there opens again. NULL: it floats again.
static const double *close_open(ContactSolver *solver, const ContactProblem *problem,
                                ContactSolution *solution, Course *course)
{
    const double *closed =
        contact_matrix_close(problem->matrix, solution->status, problem->interface->contact_count);
    if (closed || course->landed) return closed;
    course->landed = true;
    for (int32_t i = 0; i < problem->interface->contact_count; i++)
        if (solution->status[i] == CONTACT_OPEN) solution->status[i] = CONTACT_STICK;
    note_statuses(solver, problem, solution, course);
    hold_unknowns(problem, solution);
    compute_reaction(problem, solution);
    return problem->matrix->schur;
}

// true: equations and all statuses hold, reactions of open nodes are 0 to the bit. false: `limit`
// steps were not enough, Newton stalled, a matrix was singular or a number not finite; *solution
// then has no meaning.
static bool solve_statuses(ContactSolver *solver, const ContactProblem *problem,
                           ContactSolution *solution)
{
    fix_rod_kind(problem, solution);
    Course course = {
        .limit = solver->def.iterations_all, .change_all = true, .before = INFINITY, .started = -1};
    note_statuses(solver, problem, solution, &course);
    hold_unknowns(problem, solution);
    compute_reaction(problem, solution);
    while (may_go_on(solver, &course)) {
        const double *closed = close_open(solver, problem, solution, &course);
        if (!closed) break;
        int32_t free_count = list_free(solver, problem, solution);
        solver->iterations++;
        bool reused = false;
        if (!newton_step(solver, problem, solution, closed, free_count, &reused)) break;
        compute_reaction(problem, solution);
        if (starts_fast(problem, solution, &course)) continue;
        Scales scales = problem_scales(problem, solution);
        double residual = equations_residual(solver, problem, solution, free_count);
        if (!isfinite(residual)) break;
        bool equations_hold = residual <= solver->def.tolerance * scales.force;
        if (!equations_hold && reused && residual > CHORD_GAIN * course.before)
            problem->matrix->factored = 0;
        course.before = reused ? residual : INFINITY;
        if (!equations_hold && !reused && has_stalled(&course, residual / scales.force)) break;
        // First solve for these statuses, where steps are not Newton's own or only one may change.
        if (!equations_hold && (reused || !course.change_all)) continue;
        Violation found = update_statuses(solver, problem, solution, scales, course.change_all);
        if (found.broken == 0 && equations_hold) {
            stop_reversed(problem, solution);
            free_reactions(problem, solution);
            return true;
        }
        if (found.broken == 0) continue;
        note_statuses(solver, problem, solution, &course);
        if (!course.change_all) note_start(problem, solution, found.worst_node, &course);
        hold_unknowns(problem, solution);
        compute_reaction(problem, solution);
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
