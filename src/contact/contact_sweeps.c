// SPDX-License-Identifier: GPL-2.0-or-later
// A node alone: r = S v - b, S its 3 x 3 block (in the plane with a tangent more, of the same
// stiffness, along which nothing moves). Pressed, v_n = bound, it has with A the block of
// its tangents, c their coupling to the normal, q = b_t - c bound and r_n = r_0 + c.v
//
//     (A + l) v = q,    l = mu(s) r_n/s,    s = |v|,
//
// so that v(l), and with it everything, follows from one number: s falls from |A^-1 q| to 0 as l
// rises from 0. Of several roots the slowest is taken.
#include "contact/contact_sweeps.h"

#include "algebra/dense.h"
#include "contact/contact_equations.h"
#include "contact/slip.h"

#include <math.h>

// Parts of the range of l in which a root is looked for; halvings of the part that has it.
enum { PARTS = 64, HALVINGS = 60 };

enum {
    SWEEPS = 15,   // of the first round
    MORE_SWEEPS = 4   // times as many in each round as in that before
};

typedef struct NodeAlone {
    const FrictionNode *friction;
    double s[3][3];
    double b[3], bound;
    double q[2], r_0;
    double soft;   // an eigenvalue of A is no less
} NodeAlone;

// v(l) with l = soft (1/x - 1), 0 < x <= 1, and r_n. Returns l s - mu r_n: above 0 it is too slow.
static double slip_at(const NodeAlone *node, double x, double v[2], double *pressing)
{
    double l = node->soft * (1 / x - 1);
    double a = node->s[0][0] + l, b = node->s[0][1], d = node->s[1][1] + l;
    double determinant = a * d - b * b;
    v[0] = (d * node->q[0] - b * node->q[1]) / determinant;
    v[1] = (a * node->q[1] - b * node->q[0]) / determinant;
    double speed = hypot(v[0], v[1]);
    *pressing = fmax(node->r_0 + node->s[0][2] * v[0] + node->s[1][2] * v[1], 0);
    return l * speed - friction_coefficient(node->friction, speed) * *pressing;
}

// Status of a node whose neighbours stay as they are, and its velocity v.
static uint8_t solve_alone(NodeAlone *node, double v[3])
{
    // Open, if v_n is above the bound where nothing touches: S v = b.
    const double(*s)[3] = node->s, *b = node->b;
    double cross[3] = {s[1][1] * s[2][2] - s[1][2] * s[1][2], s[0][2] * s[1][2] - s[0][1] * s[2][2],
                       s[0][1] * s[1][2] - s[0][2] * s[1][1]};
    double whole = s[0][0] * cross[0] + s[0][1] * cross[1] + s[0][2] * cross[2];
    double second = s[0][0] * s[2][2] - s[0][2] * s[0][2];
    double third = s[0][0] * s[1][1] - s[0][1] * s[0][1];
    double mixed = s[0][1] * s[0][2] - s[0][0] * s[1][2];
    v[0] = (cross[0] * b[0] + cross[1] * b[1] + cross[2] * b[2]) / whole;
    v[1] = (cross[1] * b[0] + second * b[1] + mixed * b[2]) / whole;
    v[2] = (cross[2] * b[0] + mixed * b[1] + third * b[2]) / whole;
    if (v[2] >= node->bound) return CONTACT_OPEN;

    // Pressed: it sticks, if friction at rest holds it. A start only: the solvers judge afterwards.
    v[0] = v[1] = 0;
    v[2] = node->bound;
    for (int32_t c = 0; c < 2; c++) node->q[c] = b[c] - s[c][2] * node->bound;
    node->r_0 = s[2][2] * node->bound - b[2];
    node->soft = third / (s[0][0] + s[1][1]);
    double limit = friction_coefficient(node->friction, 0) * fmax(node->r_0, 0), pressing;
    if (hypot(node->q[0], node->q[1]) <= limit) return CONTACT_STICK;

    // Slips: the first part of the range of l with a root, then halvings of it.
    double low = 0, high = 1;
    for (int32_t k = 1; k <= PARTS; k++) {
        high = (double)k / PARTS;
        if (slip_at(node, high, v, &pressing) <= 0) break;
        low = high;
    }
    for (int32_t k = 0; k < HALVINGS; k++) {
        double middle = 0.5 * (low + high);
        *(slip_at(node, middle, v, &pressing) > 0 ? &low : &high) = middle;
    }
    slip_at(node, high, v, &pressing);
    return status_of_slip(v[0]);
}

// Velocity of `unknown` becomes v; reactions follow.
static void move_to(const ContactProblem *problem, ContactSolution *at, int32_t unknown, double v)
{
    int32_t count = problem->interface->count;
    double change = v - at->velocity[unknown];
    if (change == 0) return;
    dense_add_scaled(change, problem->matrix->schur + (int64_t)count * unknown, count,
                     at->reaction);
    at->velocity[unknown] = v;
}

// Goes `part` of the way to what the node would do alone.
static void sweep_node(const ContactProblem *problem, ContactSolution *at, int32_t i, double part)
{
    const Interface *interface = problem->interface;
    int64_t count = interface->count, t = interface_tangent(interface, i);
    int32_t dim = interface->dim, slot[] = {0, dim == 2 ? 2 : 1, 2};   // of a component, above
    NodeAlone node = {.friction = friction_at(problem->friction, i),
                      .bound = problem->bound[t + dim - 1]};
    double v[3];
    for (int64_t a = 0; a < dim; a++) {
        double *b_a = &node.b[slot[a]];
        *b_a = -at->reaction[t + a];
        for (int64_t b = 0; b < dim; b++) {
            double entry = problem->matrix->schur[count * (t + b) + t + a];
            node.s[slot[a]][slot[b]] = entry;
            *b_a += entry * at->velocity[t + b];
        }
    }
    if (dim == 2) node.s[1][1] = node.s[0][0];
    at->status[i] = solve_alone(&node, v);
    for (int32_t a = 0; a < dim; a++) {
        double now = at->velocity[t + a], alone = v[slot[a]];
        move_to(problem, at, (int32_t)t + a, part < 1 ? now + part * (alone - now) : alone);
    }
}

// In space later rounds are only longer; 435 collected problems are solved so.
int32_t contact_sweep(const ContactProblem *problem, ContactSolution *solution, int32_t round)
{
    const Interface *interface = problem->interface;
    ContactEquations equations = {.problem = problem, .at = solution};
    int32_t sweeps = SWEEPS, last = interface->contact_count - 1;
    bool turns = interface->dim == 2 && round > 0, back = false;
    double part = turns ? ldexp(1, -round) : 1;
    for (int32_t k = 0; k < round; k++) sweeps *= MORE_SWEEPS;
    contact_react(&equations);
    for (int32_t k = 0; k < sweeps; k++, back = turns && !back) {
        for (int32_t i = 0; i <= last; i++)
            sweep_node(problem, solution, back ? last - i : i, part);

        // A rod node alone: what it is pushed by over its own entry of S.
        for (int32_t j = 0; j < interface->rod_count; j++) {
            int32_t x = interface_rod(interface, j);
            double own = problem->matrix->own[x];
            double stiffness = rod_stiffness(problem, j), bound = problem->bound[x];
            double b = own * solution->velocity[x] - solution->reaction[x], v = b / own;
            if (problem->rod_kind == ROD_PUSHES) solution->rod_touches[j] = v < bound;
            if (solution->rod_touches[j])
                v = stiffness > 0 ? (b + stiffness * bound) / (own + stiffness) : bound;
            move_to(problem, solution, x, v);
        }
    }
    return sweeps;
}
