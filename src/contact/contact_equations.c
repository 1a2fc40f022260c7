// SPDX-License-Identifier: GPL-2.0-or-later
// Statuses first, then the equations that follow from them and their derivative; what each means
// stands in the header.
#include "contact/contact_equations.h"

#include "algebra/dense.h"

#include <math.h>
#include <string.h>

ContactScales contact_scales(const ContactProblem *problem, const double *reaction)
{
    int32_t count = problem->interface->count;
    double force = dense_max_abs(problem->g, count);
    if (reaction) force = fmax(force, dense_max_abs(reaction, count));
    if (force == 0) force = 1;
    return (ContactScales){.force = force, .velocity = force / problem->matrix->diagonal};
}

void contact_copy_statuses(const ContactEquations *equations, uint8_t *copy)
{
    const Interface *interface = equations->problem->interface;
    size_t contacts = (size_t)interface->contact_count;
    memcpy(copy, equations->at->status, contacts);
    memcpy(copy + contacts, equations->at->rod_touches, (size_t)interface->rod_count);
}

bool contact_has_statuses(const ContactEquations *equations, const uint8_t *copy)
{
    const Interface *interface = equations->problem->interface;
    size_t contacts = (size_t)interface->contact_count;
    return memcmp(copy, equations->at->status, contacts) == 0 &&
           memcmp(copy + contacts, equations->at->rod_touches, (size_t)interface->rod_count) == 0;
}

// --- statuses and rows --------------------------------------------------------------------------

// d.x of one tangent or two.
static double along(const ContactRow *row, int32_t tangents, const double *x)
{
    return tangents == 1 ? row->d[0] * x[0] : row->d[0] * x[0] + row->d[1] * x[1];
}

// rho of the tangents, from the node's own entries of S.
static double own_stiffness(const ContactProblem *problem, int32_t i)
{
    const double *own = problem->matrix->own + interface_tangent(problem->interface, i);
    return slip_tangents(problem->interface) == 1 ? own[0] : 0.5 * (own[0] + own[1]);
}

// z of node i, and p.
static double pull_of(const ContactEquations *equations, int32_t i, double z[TANGENTS_MAX])
{
    const ContactProblem *problem = equations->problem;
    int32_t tangents = slip_tangents(problem->interface);
    int32_t t = interface_tangent(problem->interface, i), n = t + tangents;
    const double *v = equations->at->velocity, *r = equations->at->reaction;
    double rho = own_stiffness(problem, i);
    z[1] = 0;
    for (int32_t c = 0; c < tangents; c++) z[c] = r[t + c] - rho * v[t + c];
    return r[n] - problem->matrix->own[n] * (v[n] - problem->bound[n]);
}

// The row of node i, which slips with this speed and mu; limit: mu p. What creeps has the direction
// of its velocity; friction that is 0 at rest resists there alike in all directions.
static void find_row(const ContactEquations *equations, int32_t i, const double z[TANGENTS_MAX],
                     double speed, double mu, double limit)
{
    const ContactProblem *problem = equations->problem;
    const FrictionNode *node = friction_at(problem->friction, i);
    int32_t tangents = slip_tangents(problem->interface);
    int32_t t = interface_tangent(problem->interface, i);
    const double *v = equations->at->velocity + t;
    double size = hypot(z[0], z[1]), rho = own_stiffness(problem, i);
    double slope = friction_slope(node, speed) * fmax(equations->at->reaction[t + tangents], 0);
    double at_rest = limit > 0 ? INFINITY : fmax(slope, 0);
    double across = speed > 0 ? limit / speed : at_rest;
    ContactRow *row = &equations->row[i];
    *row = (ContactRow){
        .d = {-z[0] / size, -z[1] / size}, .mu = mu, .theta = rho / (rho + across), .rho = rho};
    for (int32_t c = 0; node->law->creeps && speed > 0 && c < tangents; c++)
        row->d[c] = v[c] / speed;
    for (int32_t c = 0; c < tangents; c++)
        row->slope[c] = slope * (speed > 0 ? v[c] / speed : row->d[c]);
}

// Status of node i, and its row where it slips. false: its status stays.
static bool judge_node(const ContactEquations *equations, int32_t i)
{
    const Interface *interface = equations->problem->interface;
    const FrictionNode *node = friction_at(equations->problem->friction, i);
    uint8_t *status = &equations->at->status[i], was = *status;
    double slack = equations->tolerance * equations->scales.force;
    double z[TANGENTS_MAX], pressing = pull_of(equations, i, z);
    if (pressing <= (was == CONTACT_OPEN ? slack : -slack)) {
        *status = CONTACT_OPEN;
        return was != CONTACT_OPEN;
    }
    double size = hypot(z[0], z[1]), speed = slip_size(interface, i, equations->at->velocity);
    double mu = friction_coefficient(node, speed), limit = mu * fmax(pressing, 0);
    bool sticks = size <= limit + (was == CONTACT_STICK ? slack : 0);
    // A slipping node rests before it would turn round.
    bool turns = status_slips(was) && along(&equations->row[i], slip_tangents(interface), z) > 0;
    bool creeps = node->law->creeps && size > 0;
    *status = !creeps && (sticks || turns) ? CONTACT_STICK : CONTACT_SLIP_FORWARD;
    if (status_slips(*status)) find_row(equations, i, z, speed, mu, limit);
    return *status != was;
}

// Only a pushing rod can lose contact. false: the status of rod node j stays.
static bool judge_rod(const ContactEquations *equations, int32_t j)
{
    const ContactProblem *problem = equations->problem;
    const ContactSolution *at = equations->at;
    int32_t x = interface_rod(problem->interface, j);
    if (problem->rod_kind != ROD_PUSHES) return false;
    double violation = at->rod_touches[j]
                           ? -at->reaction[x] / equations->scales.force
                           : (problem->bound[x] - at->velocity[x]) / equations->scales.velocity;
    if (!(violation > equations->tolerance)) return false;
    at->rod_touches[j] = !at->rod_touches[j];
    return true;
}

bool contact_judge(ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    bool changed = false;
    equations->scales = contact_scales(equations->problem, equations->at->reaction);
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (judge_node(equations, i)) changed = true;
    for (int32_t j = 0; j < interface->rod_count; j++)
        if (judge_rod(equations, j)) changed = true;
    return changed;
}

void contact_take_statuses(ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    const ContactSolution *at = equations->at;
    equations->scales = contact_scales(equations->problem, at->reaction);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (!status_slips(at->status[i])) continue;
        // Its direction so far.
        const double *v = at->velocity + interface_tangent(interface, i);
        double speed = slip_size(interface, i, at->velocity);
        equations->row[i] = (ContactRow){.d = {status_direction(at->status[i])}};
        for (int32_t c = 0; speed > 0 && c < slip_tangents(interface); c++)
            equations->row[i].d[c] = v[c] / speed;
        at->status[i] = CONTACT_SLIP_FORWARD;
        if (judge_node(equations, i)) at->status[i] = CONTACT_STICK;
    }
}

bool contact_start_fast(const ContactEquations *equations, const uint8_t *stepped, double least)
{
    const ContactProblem *problem = equations->problem;
    const Interface *interface = problem->interface;
    ContactSolution *at = equations->at;
    int32_t tangents = slip_tangents(interface);
    bool started = false;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(interface, i);
        const FrictionNode *node = friction_at(problem->friction, i);
        const ContactRow *row = &equations->row[i];
        if (!status_slips(stepped[i]) || at->status[i] == CONTACT_OPEN) continue;
        double falls = -friction_slope(node, 0) * at->reaction[t + tangents];
        bool back = along(row, tangents, at->velocity + t) < 0;
        if (!back || node->law->creeps || !(falls > least * row->rho)) continue;
        for (int32_t c = 0; c < tangents; c++)
            at->velocity[t + c] = row->d[c] * friction_spent_speed(node);
        at->status[i] = CONTACT_SLIP_FORWARD;
        started = true;
    }
    return started;
}

// --- what is free, what is held -----------------------------------------------------------------

void contact_list_free(ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    const ContactSolution *at = equations->at;
    int32_t *free = equations->free, count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (!status_slips(at->status[i])) continue;
        for (int32_t c = 0; c < slip_tangents(interface); c++) {
            equations->node[count] = i;
            free[count++] = interface_unknown(interface, i, c);
        }
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (at->rod_touches[j] && rod_stiffness(equations->problem, j) == 0) continue;
        equations->node[count] = -1;
        free[count++] = interface_rod(interface, j);
    }
    equations->free_count = count;
}

void contact_hold(const ContactEquations *equations)
{
    const ContactProblem *problem = equations->problem;
    const Interface *interface = problem->interface;
    const ContactSolution *at = equations->at;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t n = interface_normal(interface, i);
        if (at->status[i] == CONTACT_OPEN) continue;
        at->velocity[n] = problem->bound[n];
        if (at->status[i] != CONTACT_STICK) continue;
        for (int32_t t = interface_tangent(interface, i); t < n; t++) at->velocity[t] = 0;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        if (at->rod_touches[j] && rod_stiffness(problem, j) == 0)
            at->velocity[x] = problem->bound[x];
    }
}

void contact_react(const ContactEquations *equations)
{
    const ContactProblem *problem = equations->problem;
    int32_t count = problem->interface->count;
    double *reaction = equations->at->reaction;
    for (int32_t k = 0; k < count; k++) reaction[k] = -problem->g[k];
    dense_add_symmetric(problem->matrix->schur, count, equations->at->velocity, 1, reaction);
}

void contact_release(const ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    const ContactSolution *at = equations->at;
    for (int32_t i = 0; i < interface->contact_count; i++)
        for (int32_t c = 0; at->status[i] == CONTACT_OPEN && c < interface->dim; c++)
            at->reaction[interface_unknown(interface, i, c)] = 0;
    for (int32_t j = 0; j < interface->rod_count; j++)
        if (!at->rod_touches[j]) at->reaction[interface_rod(interface, j)] = 0;
}

void contact_clean(const ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    ContactSolution *at = equations->at;
    int32_t tangents = slip_tangents(interface);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double *v = at->velocity + interface_tangent(interface, i);
        const ContactRow *row = &equations->row[i];
        if (!status_slips(at->status[i])) continue;
        at->status[i] = status_of_slip(row->d[0]);
        bool back = along(row, tangents, v) < 0;
        for (int32_t c = 0; back && c < tangents; c++) v[c] = 0;
    }
    contact_release(equations);
}

double contact_slip_square(const ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    const ContactSolution *at = equations->at;
    double sum = 0;
    for (int32_t i = 0; i < interface->contact_count; i++)
        if (at->status[i] != CONTACT_OPEN)
            sum += slip_dot(interface, i, at->velocity, at->velocity);
    return sum;
}

bool contact_is_finite(const ContactEquations *equations)
{
    const ContactSolution *at = equations->at;
    for (int32_t k = 0; k < equations->problem->interface->count; k++)
        if (!isfinite(at->velocity[k]) || !isfinite(at->reaction[k])) return false;
    return true;
}

// --- equations and their derivative -------------------------------------------------------------

// The spring of rod node j, force/width per velocity; 0 where it does not touch.
static double spring(const ContactEquations *equations, int32_t j)
{
    return equations->at->rod_touches[j] ? rod_stiffness(equations->problem, j) : 0;
}

static double larger(double a, double b)
{
    return isfinite(b) ? fmax(a, fabs(b)) : INFINITY;
}

double contact_residuals(const ContactEquations *equations, const ContactRow *kept,
                         double *residual)
{
    const ContactProblem *problem = equations->problem;
    const Interface *interface = problem->interface;
    const ContactSolution *at = equations->at;
    int32_t tangents = slip_tangents(interface), rods = interface_rod(interface, 0);
    double largest = 0;
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t k = equations->free[a], i = equations->node[a];
        if (i < 0) {
            residual[a] = at->reaction[k] +
                          spring(equations, k - rods) * (at->velocity[k] - problem->bound[k]);
            largest = larger(largest, residual[a]);
            continue;
        }
        const ContactRow *row = &equations->row[i], *old = kept ? &kept[i] : row;
        const double *r = at->reaction + k, *v = at->velocity + k, *d = row->d;
        double force = along(row, tangents, r) + row->mu * r[tangents];
        double cosine = along(old, tangents, d);
        if (tangents == 1) {
            residual[a] = cosine * force;
            largest = larger(largest, force);
            continue;
        }
        // Both equations of a node in space, whose tangents follow one another.
        double turning = row->theta * (d[0] * r[1] - d[1] * r[0]) +
                         (1 - row->theta) * row->rho * (d[0] * v[1] - d[1] * v[0]);
        double across = row->theta > 0 ? turning / row->theta : 0;
        largest = larger(largest, hypot(force, across));
        if (kept) {
            double sine = old->d[0] * d[1] - old->d[1] * d[0];
            turning = old->theta * (sine * force + cosine * across);
            force = cosine * force - sine * across;
        }
        residual[a++] = force;
        residual[a] = turning;
    }
    return largest;
}

void contact_combine(const ContactEquations *equations, const ContactRow *rows, const double *x,
                     double *out)
{
    const Interface *interface = equations->problem->interface;
    int32_t tangents = slip_tangents(interface);
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t k = equations->free[a], i = equations->node[a];
        if (i < 0) {
            out[a] += x[k];
            continue;
        }
        const ContactRow *row = &rows[i];
        out[a] += along(row, tangents, x + k) + row->mu * x[k + tangents];
        if (tangents == 1) continue;
        out[++a] += row->theta * (row->d[0] * x[k + 1] - row->d[1] * x[k]);
    }
}

void contact_derivative_column(const ContactEquations *equations, const double *matrix, int32_t b,
                               double *out)
{
    const Interface *interface = equations->problem->interface;
    int32_t own = equations->free[b], i = equations->node[b], dim = interface->dim;
    for (int32_t a = 0; a < equations->free_count; a++) out[a] = 0;
    contact_combine(equations, equations->row, matrix + (int64_t)interface->count * own, out);
    if (i < 0) {
        out[b] += spring(equations, own - interface_rod(interface, 0));
        return;
    }
    const ContactRow *row = &equations->row[i];
    int32_t axis = dof_axis(dim, own), first = b - axis;
    out[first] += row->slope[axis];
    if (dim == 2) return;
    out[first + 1] += (1 - row->theta) * row->rho * (axis == 0 ? -row->d[1] : row->d[0]);
}
