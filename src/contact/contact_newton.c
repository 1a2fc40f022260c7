// SPDX-License-Identifier: GPL-2.0-or-later
// Order of one step: factors, kept or made -> what forces at open nodes do to the others (`pull`)
// -> the step of what is free -> what follows from it (`contact_newton_take`).
#include "contact/contact_newton.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "friction/friction.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

// --- factors of the derivative ------------------------------------------------------------------

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err)
{
    int64_t count = interface->count;
    *factors = (ContactFactors){.lu = memory_bytes(8 * count * count, err)};
    factors->pivots = NEW_ARRAY(int32_t, count, err);
    factors->status = NEW_ARRAY(uint8_t, count, err);
    return error_is_clean(err);
}

void contact_factors_destroy(ContactFactors *factors)
{
    memory_free_all(factors->lu, factors->pivots, factors->status);
    *factors = (ContactFactors){0};
}

bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix)
{
    int32_t rows = equations->free_count;
    contact_jacobian(equations, matrix, rows, factors->lu);
    contact_copy_statuses(equations, factors->status);
    factors->rows = dense_lu(factors->lu, rows, factors->pivots) ? rows : 0;
    return factors->rows == rows;
}

void contact_factors_solve(const ContactFactors *factors, double *x)
{
    dense_lu_solve(factors->lu, factors->rows, factors->pivots, x);
}

// count: interface unknowns.
void contact_factors_archive(ContactFactors *factors, int32_t count, Archive *archive)
{
    archive_section(archive, "contact factors");
    archive_octets(archive, factors->status, count);
    archive_index(archive, &factors->rows, 0, count + 1);
    if (archive->failed) return;
    archive_numbers(archive, factors->lu, (int64_t)factors->rows * factors->rows);
    archive_indices(archive, factors->pivots, factors->rows, 1, factors->rows + 1);
}

// --- one step -----------------------------------------------------------------------------------

bool contact_newton_create(const Interface *interface, ContactNewton *newton, Error *err)
{
    int64_t count = interface->count;
    *newton = (ContactNewton){0};
    newton->free = NEW_ARRAY(int32_t, count, err);
    newton->open = NEW_ARRAY(int32_t, count, err);
    newton->row = NEW_ARRAY(ContactRow, count, err);
    newton->step = NEW_ARRAY(double, count, err);
    newton->more = NEW_ARRAY(double, count, err);
    newton->pull = NEW_ARRAY(double, count, err);
    return error_is_clean(err) && contact_factors_create(interface, &newton->factors, err);
}

void contact_newton_destroy(ContactNewton *newton)
{
    contact_factors_destroy(&newton->factors);
    memory_free_all(newton->free, newton->open, newton->row, newton->step, newton->more,
                    newton->pull);
    *newton = (ContactNewton){0};
}

void contact_newton_react(ContactNewton *newton)
{
    contact_react(&newton->equations);
    newton->exact = true;
}

// Held unknowns take their values. A node that would slip against its status starts from rest; in
// space there is no such thing, it turns.
static void hold(ContactNewton *newton)
{
    const Interface *interface = newton->equations.problem->interface;
    const ContactSolution *at = newton->equations.at;
    newton->listed = false;
    contact_hold(&newton->equations);
    for (int32_t i = 0; interface->dim == 2 && i < interface->contact_count; i++) {
        double *slip_rate = &at->velocity[interface_tangent(interface, i)];
        if (status_slips(at->status[i]) && *slip_rate * status_direction(at->status[i]) < 0)
            *slip_rate = 0;
    }
}

void contact_newton_begin(ContactNewton *newton, const ContactProblem *problem,
                          ContactSolution *solution, double rounding)
{
    newton->equations = (ContactEquations){
        .problem = problem, .at = solution, .free = newton->free, .row = newton->row};
    newton->creeps = problem->friction->whole.law->creeps;
    newton->rounding = rounding * dense_max_abs(problem->g, problem->interface->count);
    hold(newton);
    contact_newton_react(newton);
}

void contact_newton_settle(ContactNewton *newton)
{
    const ContactProblem *problem = newton->equations.problem;
    const ContactSolution *at = newton->equations.at;
    int32_t count = problem->interface->count;
    memcpy(newton->more, at->velocity, (size_t)count * sizeof(double));
    hold(newton);
    bool moved = false;
    for (int32_t k = 0; k < count; k++) {
        newton->more[k] = at->velocity[k] - newton->more[k];
        moved = moved || newton->more[k] != 0;
    }
    if (!moved) return;
    newton->exact = false;
    dense_add_nonzero((DenseView){problem->matrix->schur, count, count}, newton->more, 1,
                      at->reaction);
}

bool contact_newton_close(ContactNewton *newton)
{
    const ContactProblem *problem = newton->equations.problem;
    const ContactSolution *at = newton->equations.at;
    newton->closed = contact_matrix_close(
        problem->matrix, at->status, problem->interface->contact_count, problem->interface->dim);
    if (!newton->closed) return false;
    newton->open_count = 0;
    for (int32_t i = 0; i < problem->interface->contact_count; i++) {
        if (at->status[i] != CONTACT_OPEN) continue;
        for (int32_t c = 0; c < problem->interface->dim; c++)
            newton->open[newton->open_count++] = interface_unknown(problem->interface, i, c);
    }
    contact_list_free(&newton->equations);
    newton->listed = true;
    return true;
}

bool contact_newton_list(ContactNewton *newton)
{
    if (!contact_newton_close(newton)) return false;
    contact_find_rows(&newton->equations);
    contact_residuals(&newton->equations, newton->step);
    return true;
}

// pull: velocity change of all nodes when the forces at open nodes, which shall have none, are
// removed, S' r_O, and on O itself -S_OO^-1 r_O, the motion of these nodes while the others stay.
// Forces of the size of rounding are left as they are.
void contact_newton_find_pull(ContactNewton *newton)
{
    int32_t count = newton->equations.problem->interface->count;
    bool pulls = false;
    memset(newton->pull, 0, (size_t)count * sizeof(double));
    memset(newton->more, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < newton->open_count; a++) {
        int32_t k = newton->open[a];
        double force = newton->equations.at->reaction[k];
        if (fabs(force) <= newton->rounding) continue;
        newton->more[k] = force;
        pulls = true;
    }
    if (pulls)
        dense_add_nonzero((DenseView){newton->closed, count, count}, newton->more, 1, newton->pull);
}

// Velocities and reactions after a step of what is free. Where nodes are open one product with S'
// gives what the step adds to the reactions of the others and how open nodes follow; S v, which
// has their columns too, is left to the end.
void contact_newton_take(ContactNewton *newton)
{
    ContactSolution *at = newton->equations.at;
    int32_t count = newton->equations.problem->interface->count,
            free_count = newton->equations.free_count;
    for (int32_t a = 0; a < free_count; a++) at->velocity[newton->free[a]] += newton->step[a];
    if (newton->open_count == 0) {
        contact_newton_react(newton);
        return;
    }
    memset(newton->more, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < free_count; a++) newton->more[newton->free[a]] = newton->step[a];
    dense_add_nonzero((DenseView){newton->closed, count, count}, newton->more, -1, newton->pull);
    for (int32_t k = 0; k < count; k++) at->reaction[k] -= newton->pull[k];
    for (int32_t b = 0; b < newton->open_count; b++) {
        int32_t unknown = newton->open[b];
        at->velocity[unknown] += newton->pull[unknown];
        at->reaction[unknown] = 0;
    }
    newton->exact = false;
}

// Nodes that never stick: friction there is steep at rest and flat above, over many decades of v.
// Where it outweighs S, or the step would turn slip round, the step is taken in friction instead of
// in v; no node comes to more than the forces at hand could drive, `fastest`. Slip may turn round
// at 0, where nothing jumps.
void contact_newton_creep(ContactNewton *newton)
{
    const ContactProblem *problem = newton->equations.problem;
    const ContactSolution *at = newton->equations.at;
    int32_t tangents = slip_tangents(problem->interface);
    int64_t count = problem->interface->count;
    if (!newton->creeps) return;
    double fastest = contact_scales(problem, at->reaction).velocity;
    for (int32_t a = 0; a < newton->equations.free_count; a++) {
        int32_t k = newton->free[a], i = contact_slipping_node(&newton->equations, k);
        if (i < 0 || !friction_at(problem->friction, i)->law->creeps) continue;
        if (k != interface_tangent(problem->interface, i)) continue;
        const FrictionNode *node = friction_at(problem->friction, i);
        double *v = at->velocity + k, *step = newton->step + a, turned = 0, next[TANGENTS_MAX];
        double speed = slip_size(problem->interface, i, at->velocity);
        double pressing = at->reaction[interface_normal(problem->interface, i)];
        for (int32_t c = 0; c < tangents; c++) turned += (v[c] + step[c]) * v[c];
        bool steep = friction_direct_slope(node, speed) * pressing >
                     problem->matrix->schur[k * (count + 1)];
        if (!steep && turned > 0) continue;
        friction_follow(node, tangents, v, step, next);
        double most = fmax(speed, fastest), size = fabs(next[0]);
        if (tangents > 1) size = hypot(next[0], next[1]);
        for (int32_t c = 0; c < tangents; c++)
            step[c] = (size > most ? next[c] * (most / size) : next[c]) - v[c];
        if (tangents == 1) at->status[i] = status_of_slip(v[0] + step[0]);
    }
}

bool contact_newton_keeps_factors(const ContactNewton *newton)
{
    int64_t factored = newton->equations.problem->matrix->factored;
    return newton->factors_gain && !newton->creeps && factored > 0 &&
           factored == newton->factorisations &&
           contact_has_statuses(&newton->equations, newton->factors.status);
}

// With factors of an earlier derivative it is a step of a chord method: linear in convergence, and
// far cheaper than factoring.
bool contact_newton_step(ContactNewton *newton)
{
    const ContactEquations *equations = &newton->equations;
    ContactMatrix *matrix = equations->problem->matrix;
    int32_t free_count = equations->free_count;

    newton->reused = newton->factors.rows == free_count && contact_newton_keeps_factors(newton);
    if (!newton->reused) {
        newton->factorisations++;
        bool regular = contact_factors_make(&newton->factors, equations, newton->closed);
        matrix->factored = regular ? newton->factorisations : 0;
        if (!regular) return false;
        newton->factors_gain = true;
    }

    // The right-hand side, with what the forces at open nodes do to the others.
    for (int32_t a = 0; a < free_count; a++) newton->step[a] = -newton->step[a];
    if (newton->open_count > 0) {
        contact_newton_find_pull(newton);
        contact_combine(equations, newton->pull, newton->more);
        dense_add_scaled(1, newton->more, free_count, newton->step);
    }

    contact_factors_solve(&newton->factors, newton->step);
    contact_newton_creep(newton);
    contact_newton_take(newton);
    return true;
}

double contact_newton_residual(ContactNewton *newton)
{
    const ContactEquations *equations = &newton->equations;
    double largest = 0, *left = newton->step;
    contact_find_rows(equations);
    contact_residuals(equations, left);
    for (int32_t a = 0; a < equations->free_count; a++) {
        if (!isfinite(left[a])) return INFINITY;
        if (fabs(left[a]) > largest) largest = fabs(left[a]);
    }
    for (int32_t a = 0; a < newton->open_count; a++) {
        double force = equations->at->reaction[newton->open[a]];
        if (!isfinite(force)) return INFINITY;
        largest = fmax(largest, fabs(force));
    }
    return largest;
}

void contact_newton_archive(ContactNewton *newton, int32_t count, Archive *archive)
{
    contact_factors_archive(&newton->factors, count, archive);
    archive_flag(archive, &newton->factors_gain);
    archive_count(archive, &newton->factorisations);
}
