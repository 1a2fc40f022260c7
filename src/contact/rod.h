// SPDX-License-Identifier: GPL-2.0-or-later
// The rod that drives the block: node j of the strip is held at, or pushed to,
// u_x = u_x,j(0) + U, U = V t, with no shear. Behind a machine that yields the rod's
// own way R stands in the place of U; it belongs to the state (stepping/state). Used by
// contact/contact_problem and stepping/.
//
// The ends of the strip seldom stand half way between two nodes, and a mesh knows no other place
// for an end: of whole nodes, the strip's width is off by up to a cell, and with it the force at
// a given U. A node whose tributary part of the face lies in the strip with a share w < 1 only is
// therefore led through a spring. A frictionless rigid strip on a half-plane goes in by -2 P
// ln(width)/(pi E*) (Johnson, Contact Mechanics, 1985, ch. 2), so a piece w of a node's part
// yields more by a multiple of ln(1/w)/E*:
//
//     softness = 4 ln(1/w) / (pi E*),    r = [(U - u) + lag (V - v)] / softness
//
// with E* the half-plane's modulus 4 mu (lambda + mu)/(lambda + 2 mu) of the plane's two
// constants (E in plane stress), and lag the same of the viscosities over it, so that the end
// keeps its place in fast motion as well. 0 for a node inside, without bound for one that the
// strip just misses: the force changes without a jump as the strip is moved over the mesh. The
// factor 4/pi in place of a lone strip's 2/pi is fitted: the last node carries the singular end
// of a longer strip. With it the force at a given U is within 0.4 % of its limit on 20 to 160
// cells of Q4 whose nodes stand at the strip's ends (with whole nodes: 8.8, 4.4, 2.2, 1.1 %); it
// goes to the same limit, of first order in the cell, with any factor.
// validation/benchmark/precision.py measures both.
#ifndef AMONTONS_CONTACT_ROD_H
#define AMONTONS_CONTACT_ROD_H

#include "base/archive.h"
#include "contact/interface.h"
#include "contact/rod_course.h"

typedef enum RodKind {
    ROD_AWAY,   // touches nothing (while the block relaxes)
    ROD_PUSHES,   // unilateral: can lose contact, never pulls
    ROD_IS_BONDED   // bilateral
} RodKind;

typedef struct Rod {
    RodKind kind;
    double velocity;   // V, velocity
    const RodCourse *course;   // by which it is driven from time 0 on; NULL: with V; not owned
    double since, way;   // it has this velocity since then, from this displacement on; time, length
    double stiffness;   // of the spring that drives it, force/width over length; 0: rigid
    double *origin;   // [rod_count] u_x,j(0), length; owned
    double *softness;   // [rod_count] length per force/width, 0: rigid; owned
    double *lag;   // [rod_count] of soft nodes, time; owned
    int32_t count;
} Rod;

// Rigid at every node.
bool rod_build(const Interface *interface, RodKind kind, double velocity, Rod *rod, Error *err);
void rod_destroy(Rod *rod);

// The material under an end of the strip: E* of its elastic and of its viscous stiffness, stress, *
// time.
typedef struct RodGround {
    double modulus, viscosity;
} RodGround;

// Springs where the interface has shares below 1: the lowest node, and the highest. ground: of the
// strip's lower and upper end.
void rod_soften(const Interface *interface, const RodGround ground[2], Rod *rod);

// U: V t, where V was the same from t = 0 on; and its velocity.
double rod_displacement(const Rod *rod, double time);
double rod_velocity(const Rod *rod, double time);
// Time when it is first displaced by `way` > 0, from where it is at its last change; INFINITY:
// never.
double rod_arrival(const Rod *rod, double way);
// It moves with V from `time` on, from where it is then.
void rod_set_velocity(Rod *rod, double velocity, double time);

// The velocity bound of node j of contact/contact_problem, from where it is without any velocity
// (`position`), for a stage that ends at `time` and moves by `reach` times its velocity.
double rod_bound(const Rod *rod, int32_t j, double position, double time, double reach);
// The same against a rod on a spring that would be at `way` if it had no velocity.
double rod_bound_on_spring(const Rod *rod, int32_t j, double position, double way, double reach);

// F_T, from the reactions on the interface [interface->count].
double rod_force(const Interface *interface, const double *reaction);

// Lists how it moves and from where; its springs are the model's.
void rod_archive(Rod *rod, Archive *archive);

#endif
