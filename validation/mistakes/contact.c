// SPDX-License-Identifier: GPL-2.0-or-later
// Mistakes in contact and friction.
//
// The program's contact is nodal ("lumped"): gap, slip rate and reaction of a node belong together.
// Had one integrated over edges with the shape functions instead, node i would see the mean
// (A v)_i, A = W^-1 B, with B_ij = int N_i N_j dx and W its row sums, and its reaction l_i would
// act as r = A' l. With v = T w, T = A^-1, the problem S v = g + r becomes
//
//     (T' S T) w = T' g + l,     w_n >= (A bound)_n,     friction between l and w,
//
// again a contact problem, which the program's own solver solves; v and r are put back at the end.
#include "mistake.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact/contact_solver.h"

#include <math.h>
#include <string.h>

REPLACED(friction_coefficient);
REPLACED(friction_slope);
REPLACED(friction_rates);
REPLACED(contact_solve);

// Width of the smoothed law, velocity; in `amontons static` length. A hundredth of the rod's speed
// in set A, a thousandth of the displacements of the static cases.
static const double SMOOTH = 1e-7;
// Added to the pressing force of a glued node, of the largest force: it never gets below zero.
static const double GLUE = 1e3;

// --- friction -----------------------------------------------------------------------------------

// The nodes that a smoothing solver sees; the threshold of each is 0: nothing sticks.
static struct {
    Friction all;
    FrictionLaw law;   // a law that holds nothing at rest
    FrictionNode *node;
    int32_t count;
    const Friction *real;
} smooth;

// The node behind one that a smoothing solver sees; NULL: it is none.
static const FrictionNode *behind(const FrictionNode *node)
{
    bool seen = smooth.node && node >= smooth.node && node < smooth.node + smooth.count;
    return seen ? friction_at(smooth.real, (int32_t)(node - smooth.node)) : NULL;
}

// The states are those of the start of the stage.
static FrictionNode lagged(const FrictionNode *node)
{
    FrictionNode other = *node;
    Mistake made = friction_is_own(node->law) ? MISTAKE_STATES_LAGGED : MISTAKE_MEMORY_LAGGED;
    if (mistake_made() == made) other.reach = 0;
    return other;
}

double __wrap_friction_coefficient(const FrictionNode *node, double speed)
{
    const FrictionNode *real = behind(node);
    FrictionNode other = lagged(node);
    if (real) return __real_friction_coefficient(real, speed) * tanh(speed / SMOOTH);
    bool half = mistake_made() == MISTAKE_HALF_SLIP_RATE;
    return __real_friction_coefficient(&other, half ? speed / 2 : speed);
}

double __wrap_friction_slope(const FrictionNode *node, double speed)
{
    const FrictionNode *real = behind(node);
    FrictionNode other = lagged(node);
    if (real) {
        double rise = tanh(speed / SMOOTH);
        return __real_friction_slope(real, speed) * rise +
               __real_friction_coefficient(real, speed) * (1 - rise * rise) / SMOOTH;
    }
    bool half = mistake_made() == MISTAKE_HALF_SLIP_RATE;
    return half ? __real_friction_slope(&other, speed / 2) / 2
                : __real_friction_slope(&other, speed);
}

// The same in the derivatives that growth rates are made of.
void __wrap_friction_rates(const FrictionNode *node, double speed, const double *state,
                           FrictionRates *rates)
{
    bool half = mistake_made() == MISTAKE_HALF_SLIP_RATE && !node->law->remembers;
    __real_friction_rates(node, half ? speed / 2 : speed, state, rates);
    if (half) rates->mu_speed /= 2;
}

static bool solve_smoothed(ContactSolver *solver, const ContactProblem *problem,
                           ContactSolution *solution)
{
    ContactProblem smoothed = *problem;
    Error err = {0};
    int32_t count = problem->interface->contact_count;
    FrictionNode *node = NEW_ARRAY(FrictionNode, count, &err);
    if (!node) return false;
    smooth.law = *problem->friction->whole.law;
    smooth.law.mu_static = 0;
    for (int32_t i = 0; i < count; i++) {
        node[i] = *friction_at(problem->friction, i);
        node[i].law = &smooth.law;
    }
    smooth.all = *problem->friction;
    smooth.all.node = node;
    smooth.node = node;
    smooth.count = count;
    smooth.real = problem->friction;
    smoothed.friction = &smooth.all;
    bool solved = __real_contact_solve(solver, &smoothed, solution);
    smooth.node = NULL;
    memory_free(node);
    return solved;
}

// --- contact ------------------------------------------------------------------------------------

// Nodes that touch are pressed by a force that is not there, which is taken off again afterwards.
static bool solve_glued(ContactSolver *solver, const ContactProblem *problem,
                        ContactSolution *solution)
{
    Error err = {0};
    int32_t count = problem->interface->count;
    bool solved = false;
    double glue = GLUE * dense_max_abs(problem->g, count);
    double *g = NEW_ARRAY(double, count, &err);
    ContactProblem glued = *problem;
    if (!g) goto cleanup;
    memcpy(g, problem->g, (size_t)count * sizeof *g);
    for (int32_t i = 0; i < problem->interface->contact_count; i++)
        if (solution->status[i] != CONTACT_OPEN) g[interface_normal(problem->interface, i)] -= glue;
    glued.g = g;
    solved = __real_contact_solve(solver, &glued, solution);
    for (int32_t i = 0; i < problem->interface->contact_count; i++) {
        int32_t n = interface_normal(problem->interface, i);
        if (g[n] != problem->g[n]) solution->reaction[n] -= glue;
    }
cleanup:
    memory_free(g);
    return solved;
}

// A on tangents, and on normals unless slip_only; the unit matrix elsewhere. Edges between
// neighbours of a pad; [count^2] column-major.
static void fill_means(const Interface *interface, bool slip_only, double *means)
{
    int32_t size = interface->count;
    memset(means, 0, (size_t)size * (size_t)size * sizeof *means);
    for (int32_t k = 0; k < size; k++) means[(int64_t)k * size + k] = 1;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        for (int32_t side = -1; side <= 1; side += 2) {
            int32_t j = i + side;
            if (j < 0 || j >= interface->contact_count || interface->pad[j] != interface->pad[i])
                continue;
            double share = fabs(interface->x[j] - interface->x[i]) / 6 / interface->weight[i];
            for (int32_t d = 0; d < (slip_only ? 1 : 2); d++) {
                int32_t row = 2 * i + d, column = 2 * j + d;
                means[(int64_t)column * size + row] += share;
                means[(int64_t)row * size + row] -= share;
            }
        }
    }
}

// inverse := A^-1, column by column; `means` is destroyed.
static bool invert(double *means, int32_t size, int32_t *pivots, double *inverse)
{
    if (!dense_lu(means, size, pivots)) return false;
    for (int32_t k = 0; k < size; k++) {
        double *column = inverse + (int64_t)k * size;
        memset(column, 0, (size_t)size * sizeof *column);
        column[k] = 1;
        dense_lu_solve(means, size, pivots, column);
    }
    return true;
}

// The matrices of one solve, [size^2] each but the vectors, [size].
typedef struct Means {
    double *means, *inverse, *half, *schur;
    ContactMatrix seen;   // of schur
    double *g, *bound, *copy;
    int32_t *pivots;
} Means;

static bool means_create(const ContactProblem *problem, bool slip_only, Means *of)
{
    Error err = {0};
    int32_t size = problem->interface->count;
    int64_t square = (int64_t)size * size;
    *of = (Means){.means = NEW_ARRAY(double, square, &err),
                  .inverse = NEW_ARRAY(double, square, &err),
                  .half = NEW_ARRAY(double, square, &err),
                  .schur = NEW_ARRAY(double, square, &err),
                  .g = NEW_ARRAY(double, size, &err),
                  .bound = NEW_ARRAY(double, size, &err),
                  .copy = NEW_ARRAY(double, size, &err),
                  .pivots = NEW_ARRAY(int32_t, size, &err)};
    if (!error_is_clean(&err)) return false;
    fill_means(problem->interface, slip_only, of->half);
    if (!invert(of->half, size, of->pivots, of->inverse)) return false;
    fill_means(problem->interface, slip_only, of->means);
    DenseView inverse = {of->inverse, size, size};
    for (int32_t k = 0; k < size; k++)
        dense_symmetric_apply(problem->matrix->schur, size, of->inverse + (int64_t)k * size,
                              of->half + (int64_t)k * size);
    dense_multiply_transposed(inverse, (DenseView){of->half, size, size}, 1, 0, of->schur);
    dense_apply_transposed(inverse, problem->g, 1, 0, of->g);
    return contact_matrix_create(of->schur, size, &of->seen, &err);
}

static void means_destroy(Means *of)
{
    contact_matrix_destroy(&of->seen);
    void *arrays[] = {of->means, of->inverse, of->half, of->schur,
                      of->g,     of->bound,   of->copy, of->pivots};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) memory_free(arrays[k]);
}

// x := A x, or A' x, or T x, or T' x
static void apply(const Means *of, const double *matrix, bool transposed, int32_t size, double *x)
{
    DenseView view = {matrix, size, size};
    memcpy(of->copy, x, (size_t)size * sizeof *x);
    if (transposed)
        dense_apply_transposed(view, of->copy, 1, 0, x);
    else
        dense_apply(view, of->copy, 1, 0, x);
}

static bool solve_means(ContactSolver *solver, const ContactProblem *problem,
                        ContactSolution *solution, bool slip_only)
{
    Means of = {0};
    int32_t size = problem->interface->count;
    bool solved = means_create(problem, slip_only, &of);
    if (!solved) goto cleanup;
    memcpy(of.bound, problem->bound, (size_t)size * sizeof *of.bound);
    for (int32_t i = 0; i < problem->interface->contact_count; i++)
        of.bound[interface_tangent(problem->interface, i)] = 0;   // not used, and may hold anything
    apply(&of, of.means, false, size, of.bound);
    ContactProblem meant = *problem;
    meant.matrix = &of.seen;
    meant.g = of.g;
    meant.bound = of.bound;
    apply(&of, of.means, false, size, solution->velocity);
    apply(&of, of.inverse, true, size, solution->reaction);
    solved = __real_contact_solve(solver, &meant, solution);
    apply(&of, of.inverse, false, size, solution->velocity);
    apply(&of, of.means, true, size, solution->reaction);
cleanup:
    means_destroy(&of);
    return solved;
}

// In space: friction of a slipping node as large as it is, but against `before`, the velocities of
// the solve before, or along the drive alone. [interface->count]
static void turn_friction(const ContactProblem *problem, const double *before,
                          ContactSolution *solution)
{
    for (int32_t i = 0; i < problem->interface->contact_count; i++) {
        int32_t t = interface_tangent(problem->interface, i);
        double *force = solution->reaction + t, size = hypot(force[0], force[1]);
        double speed = before ? hypot(before[t], before[t + 1]) : 0;
        if (!status_slips(solution->status[i]) || (before && speed == 0)) continue;
        force[0] = before ? -size * before[t] / speed : force[0];
        force[1] = before ? -size * before[t + 1] / speed : 0;
    }
}

static bool solve_turned(ContactSolver *solver, const ContactProblem *problem,
                         ContactSolution *solution, bool last)
{
    Error err = {0};
    int32_t count = problem->interface->count;
    double *before = NEW_ARRAY(double, count, &err);
    if (!before) return false;
    memcpy(before, solution->velocity, (size_t)count * sizeof *before);
    bool solved = __real_contact_solve(solver, problem, solution);
    if (problem->interface->dim > 2) turn_friction(problem, last ? before : NULL, solution);
    memory_free(before);
    return solved;
}

bool __wrap_contact_solve(ContactSolver *solver, const ContactProblem *problem,
                          ContactSolution *solution)
{
    Mistake mistake = mistake_made();
    bool slip_only = mistake == MISTAKE_CONSISTENT_SLIP;
    if (mistake == MISTAKE_SMOOTHED_STICK) return solve_smoothed(solver, problem, solution);
    if (mistake == MISTAKE_GLUED_CONTACT) return solve_glued(solver, problem, solution);
    if (mistake == MISTAKE_LAST_DIRECTION || mistake == MISTAKE_NO_ACROSS)
        return solve_turned(solver, problem, solution, mistake == MISTAKE_LAST_DIRECTION);
    if (slip_only || mistake == MISTAKE_UNLUMPED_CONTACT)
        return solve_means(solver, problem, solution, slip_only);
    return __real_contact_solve(solver, problem, solution);
}
