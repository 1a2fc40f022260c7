// SPDX-License-Identifier: GPL-2.0-or-later
// The 1D equation times alpha H, on nodes x_i with weights w_i, in the form of a block:
//
//     M u'' + C u' + K u = r,   u = (u_0, n_0, u_1, n_1, ..., U)
//
//     M = alpha H rho w_i                                      at u_i
//     K = alpha H E_1 (stiffness of linear elements)  + E_2/h [  w_i  -w_i ]   between u_i and U
//     C = alpha H eta_t (same)                        + eta_s/h [ -w_i   w_i ]
//
// The rod's unknown U is led by it and its reaction is F_T. The pressure is given, so the normals
// n_i have nothing to say: each stands on a spring of its own, never moves, and is pressed with
// p_i = integral of p times the shape function. Nothing couples pressure to slip, so that
// S_C - W of stepping/certificate is the exact balance of powers here.
#include "study/line/model1d.h"

#include "base/memory.h"

// Adds `value` to the coupling of unknowns a and b: [ value -value; -value value ].
static void add_spring(double *matrix, int64_t size, int32_t a, int32_t b, double value)
{
    matrix[a * size + a] += value;
    matrix[b * size + b] += value;
    matrix[a * size + b] -= value;
    matrix[b * size + a] -= value;
}

// K or C: axial over the elements, shear between each node and the rod.
static void fill_matrix(const Model1d *model, const Interface *interface, double axial,
                        double shear, double *matrix)
{
    int64_t size = interface->count;
    int32_t rod = interface_rod(interface, 0);
    double layer = model->alpha * model->height;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(interface, i), n = interface_normal(interface, i);
        double held = shear / model->drive * interface->weight[i];
        add_spring(matrix, size, t, rod, held);
        matrix[n * size + n] = held;
        if (i == 0) continue;
        double element = interface->x[i] - interface->x[i - 1];
        add_spring(matrix, size, interface_tangent(interface, i - 1), t, axial * layer / element);
    }
}

// The line as a Block: from here on the steppers cannot tell it from a block of elements. The rod
// is bonded: s_xz follows U - u whatever its sign.
bool chain_build(const Model1d *model, int32_t points, Chain *chain, Error *err)
{
    *chain = (Chain){.law = model->law};
    chain->friction = friction_everywhere(friction_node(&chain->law, 1));

    // Evenly spaced nodes, all of them contact; the trapezoid rule's weights (half at the ends).
    // The rod is one more unknown, behind the nodes'.
    Interface *interface = &chain->interface;
    double element = model->length / (points - 1);
    *interface = (Interface){.dim = 2, .contact_count = points, .pad_count = 1, .rod_count = 1};
    interface->count = interface_rod(interface, 1);
    interface->node = NEW_ARRAY(int32_t, points, err);
    interface->x = NEW_ARRAY(double, points, err);
    interface->weight = NEW_ARRAY(double, points, err);
    interface->pad = NEW_ARRAY(int32_t, points, err);
    interface->rod_node = NEW_ARRAY(int32_t, 1, err);
    interface->rod_z = NEW_ARRAY(double, 1, err);
    interface->rod_share = NEW_ARRAY(double, 1, err);
    interface->dofs = NEW_ARRAY(int32_t, interface->count, err);
    if (!error_is_clean(err)) return false;
    for (int32_t i = 0; i < points; i++) {
        bool end = i == 0 || i == points - 1;
        interface->node[i] = i;
        interface->x[i] = i == points - 1 ? model->length : i * element;
        interface->weight[i] = end ? element / 2 : element;
    }
    interface->rod_node[0] = points;
    interface->rod_z[0] = model->drive;
    interface->rod_share[0] = 1;
    for (int32_t k = 0; k < interface->count; k++) interface->dofs[k] = k;

    // M, C, K and the load as a reduced bulk with nothing inside: all unknowns are the interface's.
    // The normals carry the node's mass too, so that A stays definite; they never move.
    ReducedBulk *reduced = &chain->reduced;
    int64_t count = interface->count;
    *reduced = (ReducedBulk){.dim = interface->dim,
                             .interface_count = interface->count,
                             .count = interface->count,
                             .part_count = 1,
                             .scales = {.stiffness = 1, .damping = 1, .mass = 1, .load = 1}};
    ReducedPart *part = &reduced->part[0];
    part->border_count = part->count = interface->count;
    part->border = (Transform){.size = interface->count, .count = interface->count};
    part->mass = NEW_ARRAY(double, count *count, err);
    part->damping = NEW_ARRAY(double, count *count, err);
    part->stiffness = NEW_ARRAY(double, count *count, err);
    reduced->load = NEW_ARRAY(double, count, err);
    if (!error_is_clean(err)) return false;
    fill_matrix(model, interface, model->elastic_x, model->elastic_shear, part->stiffness);
    fill_matrix(model, interface, model->viscous_x, model->viscous_shear, part->damping);
    int32_t last = interface->contact_count - 1;
    for (int32_t i = 0; i <= last; i++) {
        double mass = model->density * model->alpha * model->height * interface->weight[i];
        part->mass[interface_tangent(interface, i) * (count + 1)] = mass;
        part->mass[interface_normal(interface, i) * (count + 1)] = mass;

        // The integral of p over a node's shape function, p = 2 P x/L: w_i p(x_i), at the ends a
        // third of an element further in.
        double third = model->length / last / 3, x = interface->x[i];
        if (i == 0) x += third;
        if (i == last) x -= third;
        reduced->load[interface_normal(interface, i)] =
            -(interface->weight[i] * model1d_pressure(model, x));
    }

    // The block.
    double total_mass = model->density * model->alpha * model->height * model->length;
    if (!bulk_operator_reduce(reduced, model->length, total_mass, &chain->system, err))
        return false;
    if (!rod_build(interface, ROD_IS_BONDED, model->velocity, &chain->rod, err)) return false;
    chain->block = (Block){.system = &chain->system,
                           .interface = interface,
                           .friction = &chain->friction,
                           .rod = &chain->rod};
    return true;
}

void chain_destroy(Chain *chain)
{
    rod_destroy(&chain->rod);
    bulk_operator_destroy(&chain->system);
    reduced_bulk_destroy(&chain->reduced);
    interface_destroy(&chain->interface);
    *chain = (Chain){0};
}

// u_0 solves the line at rest with tau = mu_K p everywhere and U = 0; the reactions follow from
// K u - f, so that the state is in balance on the discrete line, whose friction then differs from
// mu_K p by the error of the elements.
void chain_rest(const Model1d *model, const Chain *chain, State *state)
{
    const Interface *interface = &chain->interface;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        state->displacement[interface_tangent(interface, i)] = model1d_rest(model, interface->x[i]);
        state->status[i] = CONTACT_STICK;
    }
    state->rod_touches[0] = 1;
    bulk_operator_apply(&chain->system, BULK_STIFFNESS, state->displacement, state->elastic_force);
    for (int32_t k = 0; k < interface->count; k++)
        state->reaction[k] = state->elastic_force[k] - chain->system.load[k];
}
