// SPDX-License-Identifier: GPL-2.0-or-later
// Equations and source stand in the header; what a row has beside S and r is found in one place,
// contact_find_rows, from the status of its node.
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

void contact_list_free(ContactEquations *equations)
{
    const Interface *interface = equations->problem->interface;
    const ContactSolution *at = equations->at;
    int32_t *free = equations->free, count = 0;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        if (!status_slips(at->status[i])) continue;
        for (int32_t c = 0; c < interface->dim - 1; c++)
            free[count++] = interface_unknown(interface, i, c);
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        if (!at->rod_touches[j] || rod_stiffness(equations->problem, j) > 0)
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
    DenseView schur = {problem->matrix->schur, count, count};
    for (int32_t k = 0; k < count; k++) reaction[k] = -problem->g[k];
    dense_add_nonzero(schur, equations->at->velocity, 1, reaction);   // what sticks adds nothing
}

// mu(|v_t|) of a slipping node, and mu' where it is asked for, one over a velocity.
static double friction_of(const ContactEquations *equations, int32_t i, double *slope)
{
    const FrictionNode *node = friction_at(equations->problem->friction, i);
    int32_t t = interface_tangent(equations->problem->interface, i);
    double speed = fabs(equations->at->velocity[t]);
    if (slope) *slope = friction_slope(node, speed);
    return friction_coefficient(node, speed);
}

void contact_find_rows(const ContactEquations *equations)
{
    const ContactProblem *problem = equations->problem;
    const ContactSolution *at = equations->at;
    for (int32_t a = 0; a < equations->free_count; a++) {
        int32_t unknown = equations->free[a], i = contact_slipping_node(equations, unknown);
        int32_t j = unknown - interface_rod(problem->interface, 0);
        ContactRow row = {.normal = unknown};
        if (j >= 0 && at->rod_touches[j]) row.stiffness = rod_stiffness(problem, j);
        if (i >= 0) {
            row.mu = status_direction(at->status[i]) * friction_of(equations, i, NULL);
            row.normal = interface_normal(problem->interface, i);
        }
        equations->row[a] = row;
    }
}

void contact_residuals(const ContactEquations *equations, double *residual)
{
    const double *velocity = equations->at->velocity, *bound = equations->problem->bound;
    contact_combine(equations, equations->at->reaction, residual);
    for (int32_t a = 0; a < equations->free_count; a++) {
        double stiffness = equations->row[a].stiffness;
        int32_t k = equations->free[a];
        if (stiffness != 0) residual[a] += stiffness * (velocity[k] - bound[k]);
    }
}

void contact_combine(const ContactEquations *equations, const double *x, double *out)
{
    for (int32_t a = 0; a < equations->free_count; a++)
        out[a] = x[equations->free[a]] + equations->row[a].mu * x[equations->row[a].normal];
}

void contact_jacobian(const ContactEquations *equations, const double *matrix, int32_t stride,
                      double *jacobian)
{
    int32_t count = equations->problem->interface->count, free_count = equations->free_count;
    for (int32_t a = 0; a < free_count; a++) {
        ContactRow row = equations->row[a];
        const double *own = matrix + (int64_t)equations->free[a] * count;   // symmetric
        const double *normal = matrix + (int64_t)row.normal * count;
        double *out = jacobian + a;
        for (int32_t b = 0; b < free_count; b++)
            out[(int64_t)b * stride] = own[equations->free[b]] +
                                       row.mu * normal[equations->free[b]];

        // mu'(|v_t|) r_n of a slipping tangent, the spring of a soft rod node.
        int32_t i = contact_slipping_node(equations, equations->free[a]);
        double slope = 0;
        if (i >= 0) friction_of(equations, i, &slope);
        out[(int64_t)a * stride] += slope * equations->at->reaction[row.normal] + row.stiffness;
    }
}

uint8_t contact_judge_node(const ContactEquations *equations, ContactScales scales, int32_t i,
                           double *violation)
{
    const ContactProblem *problem = equations->problem;
    const ContactSolution *at = equations->at;
    const Interface *interface = equations->problem->interface;
    int32_t n = interface_normal(interface, i), t = interface_tangent(interface, i);
    uint8_t status = at->status[i];
    double pressing = at->reaction[n], shear = at->reaction[t];
    if (status == CONTACT_OPEN) {
        // It closes with the tangential velocity it has: held at once it may want to open again.
        *violation = (problem->bound[n] - at->velocity[n]) / scales.velocity;
        if (at->velocity[t] == 0) return CONTACT_STICK;
        return at->velocity[t] > 0 ? CONTACT_SLIP_FORWARD : CONTACT_SLIP_BACKWARD;
    }
    *violation = -pressing / scales.force;
    if (*violation > 0) return CONTACT_OPEN;
    if (status == CONTACT_STICK) {
        *violation =
            (fabs(shear) - friction_threshold(friction_at(problem->friction, i)) * pressing) /
            scales.force;
        return shear < 0 ? CONTACT_SLIP_FORWARD : CONTACT_SLIP_BACKWARD;
    }
    *violation = -at->velocity[t] * status_direction(status) / scales.velocity;
    return CONTACT_STICK;
}

// Only a pushing rod can lose contact.
uint8_t contact_judge_rod(const ContactEquations *equations, ContactScales scales, int32_t j,
                          double *violation)
{
    const ContactProblem *problem = equations->problem;
    const ContactSolution *at = equations->at;
    int32_t x = interface_rod(problem->interface, j);
    *violation = 0;
    if (problem->rod_kind != ROD_PUSHES) return at->rod_touches[j];
    if (at->rod_touches[j])
        *violation = -at->reaction[x] / scales.force;
    else
        *violation = (problem->bound[x] - at->velocity[x]) / scales.velocity;
    return !at->rod_touches[j];
}
