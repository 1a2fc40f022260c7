// SPDX-License-Identifier: GPL-2.0-or-later
// Each condition of contact/contact_problem is turned into a number that is 0 where it holds, and
// the largest over all nodes is kept. Statuses are not looked at: a solver that assigns them
// wrongly but meets the conditions is right, one that does not is found out.
#include "contact/contact_check.h"

#include "contact/slip.h"

#include <math.h>

// Below this fraction of the velocity scale a tangential velocity counts as zero.
static const double STILL = 1e-9;

// approach: how far v is above its bound; force: the reaction, both scaled. Of two numbers that
// must be >= 0 with a product of 0, the smaller one is what is left when both are positive.
static void check_unilateral(double approach, double force, ContactResidual *worst)
{
    worst->penetration = fmax(worst->penetration, -approach);
    worst->pull = fmax(worst->pull, -force);
    worst->gap_force = fmax(worst->gap_force, fmin(approach, force));
}

// velocity, reaction: [interface->count] in the order of contact/interface. The limit of friction
// is taken with the pressure that pushes only, so that a node which pulls may carry no shear at
// all. A soft rod node yields by r_x softness / (rod_reach + lag) before it counts as penetrating.
ContactResidual contact_residual(const ContactProblem *problem, const double *velocity,
                                 const double *reaction, double force_scale, double velocity_scale)
{
    const Interface *interface = problem->interface;
    ContactResidual worst = {0};
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t t = interface_tangent(interface, i), n = interface_normal(interface, i);
        double pressing = reaction[n] / force_scale;
        check_unilateral((velocity[n] - problem->bound[n]) / velocity_scale, pressing, &worst);
        const FrictionNode *node = friction_at(problem->friction, i);
        double speed = slip_size(interface, i, velocity);
        double limit = friction_coefficient(node, speed) * fmax(pressing, 0);
        worst.cone = fmax(worst.cone, slip_size(interface, i, reaction) / force_scale - limit);
        // Where it slips, friction is mu p against the slip; at rest any shear inside the cone will
        // do. What creeps slips at any speed.
        double off = 0;
        for (int32_t c = 0; c < slip_tangents(interface); c++)
            off = hypot(off, reaction[t + c] / force_scale + limit * (velocity[t + c] / speed));
        double still = node->law->creeps ? 0 : STILL * velocity_scale;
        if (speed > still) worst.direction = fmax(worst.direction, off);
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        double force = reaction[x] / force_scale, stiffness = rod_stiffness(problem, j);
        double yields = stiffness > 0 ? reaction[x] / stiffness : 0;
        double approach = (velocity[x] + yields - problem->bound[x]) / velocity_scale;
        if (problem->rod_kind == ROD_PUSHES) check_unilateral(approach, force, &worst);
        if (problem->rod_kind == ROD_IS_BONDED)
            worst.penetration = fmax(worst.penetration, fabs(approach));
        // It touches nothing: whatever force it seems to have is an error.
        if (problem->rod_kind == ROD_AWAY) worst.gap_force = fmax(worst.gap_force, fabs(force));
    }
    return worst;
}

double contact_residual_max(const ContactResidual *residual)
{
    return fmax(fmax(fmax(residual->penetration, residual->pull), residual->gap_force),
                fmax(residual->cone, residual->direction));
}
