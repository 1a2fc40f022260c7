// SPDX-License-Identifier: GPL-2.0-or-later
// Order of one step: what is free and open -> factors, kept or made -> residuals -> what forces at
// open nodes do to the others (`pull`) -> the step of what is free -> what follows from it.
#include "contact/contact_newton.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "friction/friction.h"

#include <math.h>
#include <string.h>

bool contact_newton_create(const Interface *interface, ContactNewton *newton, Error *err)
{
    int64_t count = interface->count, contacts = interface->contact_count;
    *newton = (ContactNewton){0};
    newton->free = NEW_ARRAY(int32_t, count, err);
    newton->node = NEW_ARRAY(int32_t, count, err);
    newton->open = NEW_ARRAY(int32_t, count, err);
    newton->row = NEW_ARRAY(ContactRow, contacts, err);
    newton->step = NEW_ARRAY(double, count, err);
    newton->residual = NEW_ARRAY(double, count, err);
    newton->more = NEW_ARRAY(double, count, err);
    newton->pull = NEW_ARRAY(double, count, err);
    ContactFactors *factors = &newton->factors;
    factors->lu = memory_bytes((int64_t)sizeof(double) * count * count, err);
    factors->pivots = NEW_ARRAY(int32_t, count, err);
    factors->status = NEW_ARRAY(uint8_t, contacts + interface->rod_count, err);
    factors->row = NEW_ARRAY(ContactRow, contacts, err);
    factors->column = NEW_ARRAY(double, PARALLEL_WORKERS_MAX *count, err);
    return error_is_clean(err);
}

void contact_newton_destroy(ContactNewton *newton)
{
    ContactFactors *factors = &newton->factors;
    memory_free_all(newton->free, newton->node, newton->open, newton->row, newton->step,
                    newton->residual, newton->more, newton->pull, factors->lu, factors->pivots,
                    factors->status, factors->row, factors->column);
    *newton = (ContactNewton){0};
}

// --- velocities and reactions -------------------------------------------------------------------

void contact_newton_react(ContactNewton *newton)
{
    contact_react(&newton->equations);
    newton->exact = true;
}

// Without rows.
static void begin(ContactNewton *newton, const ContactProblem *problem, ContactSolution *solution,
                  double tolerance)
{
    newton->equations = (ContactEquations){.problem = problem,
                                           .at = solution,
                                           .tolerance = tolerance,
                                           .free = newton->free,
                                           .node = newton->node,
                                           .row = newton->row};
    newton->creeps = friction_creeps(problem->friction, problem->interface->contact_count);
    newton->rounding = 1e-3 * tolerance * dense_max_abs(problem->g, problem->interface->count);
    newton->listed = newton->reused = false;
}

void contact_newton_begin(ContactNewton *newton, const ContactProblem *problem,
                          ContactSolution *solution, double tolerance)
{
    begin(newton, problem, solution, tolerance);
    contact_take_statuses(&newton->equations);
    contact_hold(&newton->equations);
    contact_newton_react(newton);
}

void contact_newton_settle(ContactNewton *newton)
{
    const ContactProblem *problem = newton->equations.problem;
    const ContactSolution *at = newton->equations.at;
    int32_t count = problem->interface->count;
    bool moved = false;
    memcpy(newton->more, at->velocity, (size_t)count * sizeof(double));
    newton->listed = false;
    contact_hold(&newton->equations);
    for (int32_t k = 0; k < count; k++) {
        newton->more[k] = at->velocity[k] - newton->more[k];
        moved = moved || newton->more[k] != 0;
    }
    if (!moved) return;
    newton->exact = false;
    dense_add_symmetric(problem->matrix->schur, count, newton->more, 1, at->reaction);
}

bool contact_newton_start_fast(ContactNewton *newton, double least)
{
    const ContactEquations *equations = &newton->equations;
    if (!contact_start_fast(equations, newton->factors.status, least)) return false;
    contact_hold(equations);
    contact_newton_react(newton);
    contact_judge(&newton->equations);
    contact_newton_settle(newton);
    newton->factors_gain = false;
    return true;
}

// Lists what is free and open by the statuses as they are. false: nothing holds the open nodes.
static bool list_unknowns(ContactNewton *newton)
{
    const ContactProblem *problem = newton->equations.problem;
    const ContactSolution *at = newton->equations.at;
    const Interface *interface = problem->interface;
    newton->condensed =
        contact_matrix_close(problem->matrix, at->status, interface->contact_count, interface->dim);
    if (!newton->condensed) return false;
    newton->open_count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (at->status[i] != CONTACT_OPEN) continue;
        for (int32_t c = 0; c < interface->dim; c++)
            newton->open[newton->open_count++] = interface_unknown(interface, i, c);
    }
    contact_list_free(&newton->equations);
    newton->listed = true;
    return true;
}

// pull: by what the forces at open nodes, which shall have none, act on the others when they are
// removed, S' r_O, forces; and on O itself -S_OO^-1 r_O, velocities, the motion of these nodes
// while the others stay. Forces of the size of rounding are left as they are.
static void find_pull(ContactNewton *newton)
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
    if (pulls) dense_add_symmetric(newton->condensed, count, newton->more, 1, newton->pull);
}

// Velocities and reactions after a step of what is free. Where nodes are open one product with S'
// gives what the step adds to the reactions of the others and how open nodes follow; S v, which
// has their columns too, is left to the end.
static void take_step(ContactNewton *newton, const double *step)
{
    ContactSolution *at = newton->equations.at;
    int32_t count = newton->equations.problem->interface->count,
            free_count = newton->equations.free_count;
    for (int32_t a = 0; a < free_count; a++) at->velocity[newton->free[a]] += step[a];
    if (newton->open_count == 0) {
        contact_newton_react(newton);
        return;
    }
    memset(newton->more, 0, (size_t)count * sizeof(double));
    for (int32_t a = 0; a < free_count; a++) newton->more[newton->free[a]] = step[a];
    dense_add_symmetric(newton->condensed, count, newton->more, -1, newton->pull);
    for (int32_t k = 0; k < count; k++) at->reaction[k] -= newton->pull[k];
    for (int32_t b = 0; b < newton->open_count; b++) {
        int32_t unknown = newton->open[b];
        at->velocity[unknown] += newton->pull[unknown];
        at->reaction[unknown] = 0;
    }
    newton->exact = false;
}

// --- factors ------------------------------------------------------------------------------------

// True if the stored factors may be used again: they are the latest, of this S, of these statuses
// and of slip the same way, and steps with them gain. Factors of another step size would converge
// too slowly, and where friction creeps each row changes from step to step.
static bool keeps_factors(const ContactNewton *newton)
{
    const ContactFactors *factors = &newton->factors;
    int64_t factored = newton->equations.problem->matrix->factored;
    if (!newton->factors_gain || newton->creeps || factored == 0 ||
        factored != newton->factorisations || factors->is_single == newton->in_double ||
        factors->rows != newton->equations.free_count ||
        !contact_has_statuses(&newton->equations, factors->status))
        return false;
    for (int32_t a = 0; a < newton->equations.free_count; a++) {
        int32_t i = newton->node[a];
        if (i < 0) continue;
        const double *d = newton->row[i].d, *kept = factors->row[i].d;
        if (d[0] * kept[0] + d[1] * kept[1] < 0) return false;
    }
    return true;
}

enum { COLUMNS = 64 };   // of a piece

// Columns of the derivative over the largest entry of S, in single precision.
static void fill_columns(void *context, int32_t piece, int32_t worker)
{
    const ContactNewton *newton = context;
    const ContactFactors *factors = &newton->factors;
    int64_t size = newton->equations.free_count, end = (piece + 1) * (int64_t)COLUMNS;
    double scale = 1 / newton->equations.problem->matrix->diagonal;
    double *column = factors->column +
                     worker * (int64_t)newton->equations.problem->interface->count;
    for (int64_t b = piece * (int64_t)COLUMNS; b < size && b < end; b++) {
        float *out = (float *)factors->lu + b * size;
        contact_derivative_column(&newton->equations, newton->condensed, (int32_t)b, column);
        for (int64_t a = 0; a < size; a++) out[a] = (float)(scale * column[a]);
    }
}

// LU of the derivative at the rows as they are, which are kept. false: it is singular.
static bool make_factors(ContactNewton *newton)
{
    const ContactEquations *equations = &newton->equations;
    ContactMatrix *matrix = equations->problem->matrix;
    ContactFactors *factors = &newton->factors;
    int32_t size = equations->free_count;
    bool regular;
    factors->is_single = !newton->in_double;
    if (factors->is_single) {
        int32_t pieces = (size + COLUMNS - 1) / COLUMNS;
        parallel_where((int64_t)size * size >= PARALLEL_ENTRIES, pieces, fill_columns, newton);
        regular = dense_lu_single((float *)factors->lu, size, factors->pivots);
    } else {
        double *out = factors->lu;
        for (int32_t b = 0; b < size; b++, out += size)
            contact_derivative_column(equations, newton->condensed, b, out);
        regular = dense_lu(factors->lu, size, factors->pivots);
    }
    newton->factorisations++;
    factors->rows = regular ? size : 0;
    contact_copy_statuses(equations, factors->status);
    memcpy(factors->row, newton->row,
           (size_t)equations->problem->interface->contact_count * sizeof(ContactRow));
    matrix->factored = regular ? newton->factorisations : 0;
    newton->factors_gain = true;
    return regular;
}

// x [rows] := derivative^-1 x.
static void solve_by_factors(const ContactNewton *newton, double *x)
{
    const ContactFactors *factors = &newton->factors;
    if (!factors->is_single) {
        dense_lu_solve(factors->lu, factors->rows, factors->pivots, x);
        return;
    }
    double scale = 1 / newton->equations.problem->matrix->diagonal;
    dense_lu_single_solve((const float *)factors->lu, factors->rows, factors->pivots, x,
                          (float *)factors->column);
    for (int32_t a = 0; a < factors->rows; a++) x[a] *= scale;
}

// --- one step -----------------------------------------------------------------------------------

// Nodes that never stick: friction there is steep at rest and flat above, over many decades of v.
// Where it outweighs S, or the step would turn slip round, the step is taken in friction instead of
// in v; no node comes to more than the forces at hand could drive, `fastest`. Slip may turn round
// at 0, where nothing jumps.
static void bend_where_it_creeps(ContactNewton *newton)
{
    const ContactProblem *problem = newton->equations.problem;
    const Interface *interface = problem->interface;
    ContactSolution *at = newton->equations.at;
    int32_t tangents = slip_tangents(interface);
    if (!newton->creeps) return;
    double fastest = contact_scales(problem, at->reaction).velocity;
    for (int32_t a = 0; a < newton->equations.free_count && newton->node[a] >= 0; a += tangents) {
        int32_t k = newton->free[a], i = newton->node[a];
        const FrictionNode *node = friction_at(problem->friction, i);
        if (!node->law->creeps) continue;
        double *v = at->velocity + k, *step = newton->step + a, turned = 0, next[TANGENTS_MAX];
        double speed = slip_size(interface, i, at->velocity);
        double pressing = at->reaction[interface_normal(interface, i)];
        for (int32_t c = 0; c < tangents; c++) turned += (v[c] + step[c]) * v[c];
        bool steep = friction_direct_slope(node, speed) * pressing > problem->matrix->own[k];
        if (!steep && turned > 0) continue;
        friction_follow(node, tangents, v, step, next);
        double most = fmax(speed, fastest), size = fabs(next[0]);
        if (tangents > 1) size = hypot(next[0], next[1]);
        for (int32_t c = 0; c < tangents; c++)
            step[c] = (size > most ? next[c] * (most / size) : next[c]) - v[c];
    }
}

// With factors of an earlier derivative it is a step of a chord method: linear in convergence, and
// far cheaper than factoring.
bool contact_newton_step(ContactNewton *newton)
{
    const ContactEquations *equations = &newton->equations;
    if (!newton->listed && !list_unknowns(newton)) return false;
    int32_t free_count = equations->free_count;
    newton->reused = keeps_factors(newton);

    // The residual, with what the forces at open nodes do to the others, becomes the step.
    const ContactRow *kept = newton->reused ? newton->factors.row : NULL;
    if (!isfinite(contact_residuals(equations, kept, newton->step))) return false;
    if (!newton->reused && !make_factors(newton)) return false;
    for (int32_t a = 0; a < free_count; a++) newton->step[a] = -newton->step[a];
    if (newton->open_count > 0) {
        find_pull(newton);
        contact_combine(equations, newton->factors.row, newton->pull, newton->step);
    }
    solve_by_factors(newton, newton->step);
    bend_where_it_creeps(newton);
    take_step(newton, newton->step);
    return true;
}

void contact_newton_halve(ContactNewton *newton)
{
    for (int32_t a = 0; a < newton->equations.free_count; a++) {
        newton->step[a] *= 0.5;
        newton->residual[a] = -newton->step[a];
    }
    memset(newton->pull, 0, (size_t)newton->equations.problem->interface->count * sizeof(double));
    take_step(newton, newton->residual);
}

double contact_newton_residual(ContactNewton *newton)
{
    double largest = contact_residuals(&newton->equations, NULL, newton->residual);
    for (int32_t a = 0; a < newton->open_count; a++) {
        double force = newton->equations.at->reaction[newton->open[a]];
        largest = isfinite(force) ? fmax(largest, fabs(force)) : INFINITY;
    }
    return largest;
}

// Interface unknowns from which on linear equations are solved by factors in single precision;
// steps with these, and what they must leave of the forces.
enum { FOLLOW_SINGLE = 1000, FOLLOW_STEPS = 4 };
static const double FOLLOWED = 1e-10;

// From no motion but that of what is held. false: the derivative is singular, or steps in single
// precision do not come close enough.
static bool follow(ContactNewton *newton, bool in_double)
{
    ContactEquations *equations = &newton->equations;
    int32_t count = equations->problem->interface->count;
    double force = dense_max_abs(equations->problem->g, count);
    memset(equations->at->velocity, 0, (size_t)count * sizeof(double));
    contact_hold(equations);
    contact_newton_react(newton);
    newton->factors_gain = false;
    newton->in_double = in_double;
    bool close = false;
    for (int32_t k = 0; k < (in_double ? 1 : FOLLOW_STEPS) && !close; k++) {
        if (!contact_newton_step(newton)) return false;
        contact_newton_react(newton);
        close = in_double || contact_newton_residual(newton) <= FOLLOWED * force;
    }
    contact_release(equations);
    return close;
}

bool contact_newton_follow(ContactNewton *newton, const ContactRow *rows,
                           const ContactProblem *problem, ContactSolution *solution)
{
    const Interface *interface = problem->interface;
    begin(newton, problem, solution, 0);
    newton->creeps = false;   // the equations are linear, whatever the law
    memcpy(newton->row, rows, (size_t)interface->contact_count * sizeof(ContactRow));
    return (interface->count >= FOLLOW_SINGLE && follow(newton, false)) || follow(newton, true);
}

// Factors take as many bytes as their precision has.
void contact_newton_archive(ContactNewton *newton, const Interface *interface, Archive *archive)
{
    ContactFactors *factors = &newton->factors;
    int32_t contacts = interface->contact_count;
    archive_section(archive, "contact factors");
    archive_octets(archive, factors->status, contacts + interface->rod_count);
    archive_index(archive, &factors->rows, 0, interface->count + 1);
    archive_flag(archive, &factors->is_single);
    if (archive->failed) return;
    int64_t size = (int64_t)(factors->is_single ? sizeof(float) : sizeof(double));
    archive_octets(archive, (uint8_t *)factors->lu, size * factors->rows * factors->rows);
    archive_indices(archive, factors->pivots, factors->rows, 1, factors->rows + 1);
    for (int32_t i = 0; i < contacts; i++) {
        ContactRow *row = &factors->row[i];
        archive_numbers(archive, row->d, TANGENTS_MAX);
        archive_numbers_of(archive, &row->mu, &row->theta, &row->rho);
        archive_numbers(archive, row->slope, TANGENTS_MAX);
    }
    archive_flag(archive, &newton->factors_gain);
    archive_count(archive, &newton->factorisations);
}
