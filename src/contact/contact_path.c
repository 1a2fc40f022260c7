// SPDX-License-Identifier: GPL-2.0-or-later
// One step: from a point of the path along its tangent to where the first bound would be reached,
// back onto the path by Newton across the tangent,
//
//     [ J  E_tau ] [dx  ]   [-E]
//     [  tangent ] [dtau] = [ 0],       E the equations of the free unknowns x, J = dE/dx,
//
// and on to the bound by secants. The tangent itself solves the same system with (0, 1) on the
// right, the last row being the tangent before or, after an exchange, the gradient of what the new
// status lets grow from 0.
// Tolerances and limits here decide only whether a path is found: contact/contact_solver solves
// again, to its own tolerance, from where it ends.
#include "contact/contact_path.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact/path_bounds.h"

#include <math.h>
#include <string.h>

static const double NEAR = 1e-10;   // of the scales: on the path, on a bound
static const double ASIDE = 0.5;   // of a step: Newton may lead so far from its tangent
static const double HEIGHT_LIMIT = 1e4;   // of the scale of velocity: no step presses so far down
static const double TAU_LIMIT = 1e6;   // of that at the start: beyond, the path does not come back
enum {
    STEPS_LIMIT = 200,   // for each unknown; with friction 5 on 12 pads 170 were needed
    CORRECTIONS = 8,   // Newton steps back onto the path
    TRIALS_LIMIT = 60,   // points tried in a step
    STARTS_LIMIT = 200,   // pressures, and statuses of rod nodes, tried at the start
};

// The matrix has one row and column more than the interface, for tau.
bool contact_path_create(const Interface *interface, ContactPath *path, Error *err)
{
    int64_t count = interface->count;
    *path = (ContactPath){.count = interface->count};
    path->free = NEW_ARRAY(int32_t, count, err);
    path->equation = NEW_ARRAY(ContactRow, count, err);
    path->pivots = NEW_ARRAY(int32_t, count + 1, err);
    path->matrix = NEW_ARRAY(double, (count + 1) * (count + 1), err);
    path->lift = NEW_ARRAY(double, count, err);
    path->row = NEW_ARRAY(double, count + 1, err);
    path->tangent = NEW_ARRAY(double, count + 1, err);
    path->velocity_rate = NEW_ARRAY(double, count, err);
    path->reaction_rate = NEW_ARRAY(double, count, err);
    path->kept = NEW_ARRAY(double, count, err);
    path->piece = NEW_ARRAY(uint8_t, interface->contact_count, err);
    return error_is_clean(err);
}

void contact_path_destroy(ContactPath *path)
{
    memory_free_all(path->free, path->equation, path->pivots, path->matrix, path->lift, path->row,
                    path->tangent, path->velocity_rate, path->reaction_rate, path->kept,
                    path->piece);
    *path = (ContactPath){0};
}

// What is held is in its place, what is free is listed, the row is empty.
static void arrange(PathTrace *trace)
{
    contact_hold(&trace->system);
    contact_list_free(&trace->system, true);
    memset(trace->path->row, 0, ((size_t)trace->path->count + 1) * sizeof(double));
}

// r = S v - g + tau d
static void find_reaction(PathTrace *trace)
{
    contact_react(&trace->system);
    dense_add_scaled(trace->tau, trace->path->lift, trace->path->count, trace->system.at->reaction);
}

// Factors [J E_tau; last], J by the rows as they were found.
// Size free_count + 1, column after column; `last` is its lowest row [free_count + 1]. false:
// singular, as at a point where two paths meet.
static bool factor(PathTrace *trace, const double *last)
{
    ContactPath *path = trace->path;
    int32_t free_count = trace->system.free_count, size = free_count + 1;
    contact_jacobian(&trace->system, trace->system.problem->matrix->schur, size, path->matrix);
    contact_combine(&trace->system, path->lift, path->matrix + (int64_t)free_count * size);
    for (int32_t b = 0; b < size; b++) path->matrix[(int64_t)b * size + free_count] = last[b];
    return dense_lu(path->matrix, size, path->pivots);
}

// The tangent along which path->row grows, of length 1, and the rates of v and r along it.
static bool find_tangent(PathTrace *trace)
{
    ContactPath *path = trace->path;
    int32_t free_count = trace->system.free_count, count = path->count;
    double *tangent = path->tangent;
    contact_find_rows(&trace->system);
    if (!factor(trace, path->row)) return false;
    memset(tangent, 0, (size_t)free_count * sizeof(double));
    tangent[free_count] = 1;
    dense_lu_solve(path->matrix, free_count + 1, path->pivots, tangent);
    double length = sqrt(dense_dot(tangent, tangent, free_count + 1));
    if (!(length > 0 && isfinite(length))) return false;
    for (int32_t a = 0; a <= free_count; a++) tangent[a] /= length;
    memset(path->velocity_rate, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < free_count; a++) path->velocity_rate[path->free[a]] = tangent[a];
    trace->tau_rate = tangent[free_count];
    dense_symmetric_apply(trace->system.problem->matrix->schur, count, path->velocity_rate,
                          path->reaction_rate);
    for (int32_t k = 0; k < count; k++) path->reaction_rate[k] += trace->tau_rate * path->lift[k];
    return true;
}

// --- exchange -----------------------------------------------------------------------------------

// row += factor * gradient of r_k
static void add_reaction_row(PathTrace *trace, int32_t k, double factor)
{
    ContactPath *path = trace->path;
    const double *own = trace->system.problem->matrix->schur + (int64_t)k * path->count;
    for (int32_t b = 0; b < trace->system.free_count; b++)
        path->row[b] += factor * own[path->free[b]];
    path->row[trace->system.free_count] += factor * path->lift[k];
}

// Beyond its bound a node takes its next status; `row` becomes what grows from 0 there.
static void exchange(PathTrace *trace, PathBound bound)
{
    ContactPath *path = trace->path;
    const Interface *interface = trace->system.problem->interface;
    ContactSolution *at = trace->system.at;
    int32_t i = bound.node, contacts = interface->contact_count;
    bool rod = i >= contacts;
    int32_t t = rod ? interface_rod(interface, i - contacts) : interface_tangent(interface, i);
    const FrictionLaw *law = rod ? NULL : friction_at(trace->system.problem->law, i);
    uint8_t before = rod ? 0 : at->status[i];
    double direction = status_direction(before), velocity_sign = 0, normal = 0, tangent = 0;
    int32_t grown = t;   // the velocity that grows where velocity_sign is not 0
    if (rod) {
        uint8_t *touches = &at->rod_touches[i - contacts];
        velocity_sign = *touches ? 1 : 0;
        tangent = *touches ? 0 : 1;
        *touches = !*touches;
    } else if (before == CONTACT_OPEN) {
        at->status[i] = at->velocity[t] < 0 ? CONTACT_SLIP_BACKWARD : CONTACT_SLIP_FORWARD;
        path->piece[i] = (uint8_t)friction_piece(law, fabs(at->velocity[t]));
        normal = 1;
    } else if (before == CONTACT_STICK) {
        at->status[i] = bound.kind == 0 ? CONTACT_SLIP_FORWARD : CONTACT_SLIP_BACKWARD;
        path->piece[i] = 0;
        velocity_sign = status_direction(at->status[i]);
    } else if (bound.kind == 0) {
        at->status[i] = CONTACT_STICK;
        normal = law->mu_static;
        tangent = direction;
    } else if (bound.kind == 1) {
        at->status[i] = CONTACT_OPEN;
        velocity_sign = 1;
        grown = interface_normal(interface, i);
    } else {
        int32_t up = bound.kind == 2 && path->piece[i] > 0 ? -1 : 1;
        path->piece[i] = (uint8_t)(path->piece[i] + up);
        velocity_sign = up * direction;
    }
    arrange(trace);
    for (int32_t a = 0; a < trace->system.free_count; a++)
        if (path->free[a] == grown) path->row[a] = velocity_sign;
    if (tangent != 0) add_reaction_row(trace, t, tangent);
    if (normal != 0) add_reaction_row(trace, interface_normal(interface, i), normal);
}

// --- steps --------------------------------------------------------------------------------------

// No node's friction changes so much that the step might have met another part of the path.
static bool stays_near(const PathTrace *trace)
{
    const ContactPath *path = trace->path;
    for (int32_t a = 0; a < trace->system.free_count; a++) {
        int32_t k = path->free[a], i = contact_slipping_node(&trace->system, k);
        if (i < 0) continue;
        const FrictionLaw *law = friction_at(trace->system.problem->law, i);
        double before = fabs(path->kept[a]), after = fabs(trace->system.at->velocity[k]);
        if (!friction_is_straight(law, path->piece[i], before, after)) return false;
    }
    return true;
}

// From the step's start by `distance` along the tangent and back onto the path; false: not found,
// or so far aside that it may be another path. Rod nodes do not count: a rod on a spring that they
// do not touch holds them by little more than rounding (reduction/machine), and they bend no path.
// On success velocity, reaction and tau are those of the point; on failure they are of no use, and
// the next trial starts from `kept` again.
static bool place_point(PathTrace *trace, double tau_kept, double distance)
{
    ContactPath *path = trace->path;
    double *velocity = trace->system.at->velocity, *step = path->row, aside = 0;
    int32_t free_count = trace->system.free_count, contact_free = free_count;
    int32_t rod = interface_rod(trace->system.problem->interface, 0);
    while (contact_free > 0 && path->free[contact_free - 1] >= rod) contact_free--;
    for (int32_t a = 0; a < free_count; a++)
        velocity[path->free[a]] = path->kept[a] + distance * path->tangent[a];
    trace->tau = tau_kept + distance * path->tangent[free_count];
    for (int32_t k = 0; k < CORRECTIONS; k++) {
        double largest = 0;
        find_reaction(trace);
        contact_find_rows(&trace->system);
        contact_residuals(&trace->system, step);
        for (int32_t a = 0; a < free_count; a++) {
            step[a] = -step[a];
            largest = fmax(largest, fabs(step[a]));
        }
        step[free_count] = 0;
        if (largest <= NEAR * trace->scales.force) return stays_near(trace);
        if (!isfinite(largest) || !factor(trace, path->tangent)) return false;
        dense_lu_solve(path->matrix, free_count + 1, path->pivots, step);
        for (int32_t a = 0; a < free_count; a++) velocity[path->free[a]] += step[a];
        trace->tau += step[free_count];
        aside += hypot(sqrt(dense_dot(step, step, contact_free)), step[free_count]);
        if (aside > ASIDE * distance + NEAR * trace->scales.velocity) return false;
    }
    return false;
}

// A step to the first bound, or to a point before it (reached->node PATH_AT_NO_BOUND).
// false: no point was found within TRIALS_LIMIT. The length of a first trial is bounded by the
// scale of velocity beyond tau, as a tangent that meets no bound would lead to infinity.
static bool advance(PathTrace *trace, PathBound *reached)
{
    ContactPath *path = trace->path;
    double tau_kept = trace->tau, low = 0, high = INFINITY, low_value = 0, high_value = -INFINITY;
    double distance =
        fmin(path_nearest_bound(trace).distance, trace->scales.velocity + fabs(trace->tau));
    for (int32_t a = 0; a < trace->system.free_count; a++)
        path->kept[a] = trace->system.at->velocity[path->free[a]];
    for (int32_t trial = 0; trial < TRIALS_LIMIT; trial++) {
        bool placed = place_point(trace, tau_kept, distance);
        double least = placed ? path_worst_condition(trace, reached) : -INFINITY;
        if (fabs(least) <= NEAR) return true;
        if (least > 0 && !isfinite(high_value)) {   // the path bends away: on from here
            reached->node = PATH_AT_NO_BOUND;
            return true;
        }
        if (least > 0) {
            low = distance;
            low_value = least;
        } else {
            high = distance;
            high_value = least;
        }
        // False position, every other time the middle.
        double part = low_value / (low_value - high_value);
        if (!(low > 0 && isfinite(high_value)) || trial % 2 == 1) part = 0.5;
        distance = low + part * (high - low);
    }
    return false;
}

// The first rod node that violates its condition; -1: none.
static int32_t broken_rod(const PathTrace *trace)
{
    const Interface *interface = trace->system.problem->interface;
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t node = interface->contact_count + j;
        if (path_condition(trace, node, 0, trace->system.at->velocity, trace->system.at->reaction,
                           1) < 0)
            return j;
    }
    return -1;
}

// Nodes that are open at the start and go further than they may are pressed, too. false: there are
// none.
static bool press_fallen(PathTrace *trace)
{
    const ContactProblem *problem = trace->system.problem;
    const ContactSolution *at = trace->system.at;
    bool any = false;
    for (int32_t i = 0; i < problem->interface->contact_count; i++) {
        int32_t n = interface_normal(problem->interface, i);
        if (at->status[i] != CONTACT_OPEN || at->velocity[n] >= problem->bound[n]) continue;
        at->status[i] = CONTACT_STICK;
        trace->path->lift[n] = problem->matrix->diagonal;
        any = true;
    }
    return any;
}

// Everything that would touch is pressed so hard that it sticks; tau falls. What is far above
// the substrate is left alone: in a short step it would have to come down at a speed beside which
// all else is rounding. What the rod does then is a small linear complementarity problem, solved by
// changing the first status that is wrong (Murty's rule).
static bool start_pressed(PathTrace *trace)
{
    const ContactProblem *problem = trace->system.problem;
    const Interface *interface = problem->interface;
    ContactPath *path = trace->path;
    ContactSolution *at = trace->system.at;
    PathBound worst;
    memset(path->lift, 0, (size_t)path->count * sizeof(double));
    for (int32_t i = 0; i < interface->contact_count; i++) {
        bool above = problem->bound[interface_normal(interface, i)] <
                     -HEIGHT_LIMIT * trace->scales.velocity;
        at->status[i] = above ? CONTACT_OPEN : CONTACT_STICK;
        if (!above) path->lift[interface_normal(interface, i)] = problem->matrix->diagonal;
    }
    memset(at->rod_touches, problem->rod_kind != ROD_AWAY, (size_t)interface->rod_count);
    memset(path->piece, 0, (size_t)interface->contact_count);
    memset(at->velocity, 0, (size_t)path->count * sizeof(double));
    trace->tau = 4 * trace->scales.velocity;
    for (int32_t trial = 0; trial < STARTS_LIMIT; trial++) {
        arrange(trace);
        path->row[trace->system.free_count] = -1;
        if (!find_tangent(trace)) return false;
        find_reaction(trace);
        contact_residuals(&trace->system, path->row);
        for (int32_t a = 0; a < trace->system.free_count; a++) path->row[a] = -path->row[a];
        path->row[trace->system.free_count] = 0;
        dense_lu_solve(path->matrix, trace->system.free_count + 1, path->pivots, path->row);
        for (int32_t a = 0; a < trace->system.free_count; a++)
            at->velocity[path->free[a]] += path->row[a];
        find_reaction(trace);
        if (press_fallen(trace)) continue;
        int32_t j = broken_rod(trace);
        if (j < 0 && path_worst_condition(trace, &worst) >= 0) return true;
        if (j >= 0)
            at->rod_touches[j] = !at->rod_touches[j];
        else
            trace->tau *= 4;
    }
    return false;
}

// From a start to tau = 0.
// false: given up after STEPS_LIMIT steps for each unknown, where a step was not found, or on a ray
// that leaves for tau to infinity.
static bool trace_path(PathTrace *trace)
{
    ContactPath *path = trace->path;
    PathBound reached = {.node = PATH_AT_NO_BOUND};
    double highest = TAU_LIMIT * trace->tau;
    for (int32_t step = 0; step < STEPS_LIMIT * path->count && trace->tau < highest; step++) {
        if (step > 0 && !find_tangent(trace)) return false;
        path->steps++;
        if (!advance(trace, &reached)) return false;
        if (reached.node == PATH_AT_END) return true;
        if (reached.node == PATH_AT_NO_BOUND)
            memcpy(path->row, path->tangent,
                   ((size_t)trace->system.free_count + 1) * sizeof(double));
        else
            exchange(trace, reached);
    }
    return false;
}

bool contact_path_follow(ContactPath *path, const ContactProblem *problem,
                         ContactSolution *solution)
{
    PathTrace trace = {.path = path,
                       .velocity_rate = path->velocity_rate,
                       .reaction_rate = path->reaction_rate,
                       .system = {.problem = problem,
                                  .at = solution,
                                  .piece = path->piece,
                                  .free = path->free,
                                  .row = path->equation}};
    if (!friction_everywhere(problem->law, problem->interface->contact_count)) return false;
    trace.scales = contact_scales(problem, NULL);
    return start_pressed(&trace) && trace_path(&trace);
}
