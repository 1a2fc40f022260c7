// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's effective model in one dimension (Otsuki and Matsukawa, Sci. Rep. 3, 1586, 2013,
// equation 1): u(x, t) of a bar of length L, 0 <= x <= L, du/dx = 0 at both ends,
//
//     rho u'' = d/dx (E_1 du/dx + eta_t du'/dx) + [ s_xz - mu(u') p(x) ] / (alpha H)
//     s_xz    = E_2 (U - u)/h + eta_s (V - u')/h,     p(x) = 2 P x/L,     F_T = integral of s_xz
//
// with E_1 = E/(1 - nu^2), E_2 = E/(2 (1 + nu)), eta_t = eta1 + eta2, eta_s = eta1/2. It is used by
// amontons_model1d in two ways, which this header lists:
//
//   theory   theory.c: adiabatic slip and the paper's growth rates, mode by mode;
//            modes.c: the same linear problem with its modes coupled
//   steps    chain.c: the equation as a Block with one moving unknown a node, so that
//            contact_solver, SDIRK2, certificate, events and peaks step it as they step a block
#ifndef AMONTONS_STUDY_LINE_MODEL1D_H
#define AMONTONS_STUDY_LINE_MODEL1D_H

#include "amontons_model1d.h"
#include "answers/answers.h"
#include "record/history.h"
#include "scene/scene.h"
#include "stepping/growth.h"

typedef struct Model1d {
    double length, height;   // L, H, length
    double drive;   // h, height at which the rod drives, length
    double alpha;   // part of H over which s_xz varies, 1
    double density;
    double elastic_x, elastic_shear;   // E_1, E_2, stress
    double viscous_x, viscous_shear;   // eta_t, eta_s, stress * time
    double pressure;   // P, stress, above 0
    double velocity;   // V, velocity, above 0
    double young, speed;   // E, stress, and sqrt(E_1/rho), velocity: scales
    FrictionLaw law;
} Model1d;

// d mu/d v at rest, one over a velocity.
static inline double model1d_friction_slope(const Model1d *model)
{
    FrictionNode node = friction_node(&model->law, 1);
    return friction_slope(&node, 0);
}

// --- theory (theory.c) ---------------------------------------------------------------------------
double model1d_pressure(const Model1d *model, double x);
double model1d_range(const Model1d *model);   // kappa r: what is held at a point is felt so far
double model1d_rest(const Model1d *model, double x);   // u_0: tau = mu_K p everywhere, U = 0
double model1d_slip(const Model1d *model, double l, double x);   // u_1 - u_0; 0 ahead of l
double model1d_rod(const Model1d *model, double l);   // U that leads the front to l <= L
double model1d_mu(const Model1d *model, double l);   // F_T/F_N then, exactly
double model1d_mu_line(const Model1d *model, double l);   // mu_K + (mu_S - mu_K) l/L
// omega_n of the paper's equation 3 (off-diagonal terms neglected), the root of larger real part.
GrowthRate model1d_omega(const Model1d *model, int32_t n, double l);
// Lengths at which Re omega_n = 0, at which omega_0 becomes real and positive, and the latter's
// small-l law (L P)^(-1/3). They may lie beyond L; NaN: friction does not weaken.
double model1d_l_sc(const Model1d *model, int32_t n);
double model1d_l_c(const Model1d *model);
double model1d_l_c_small(const Model1d *model);

// --- theory with coupled modes (modes.c) ---------------------------------------------------------
enum { MODEL1D_MODES = 16 };   // cosines: l_c moves by less than 1e-5 of itself with twice as many

typedef struct Model1dRates {
    GrowthRate rightmost;   // im >= 0
    double real;   // the largest real rate above 0; 0: none
} Model1dRates;

// Growth rates at the front l; count: modes kept. work: [model1d_rates_work(count)].
int64_t model1d_rates_work(int32_t count);
bool model1d_rates(const Model1d *model, double l, int32_t count, double *work,
                   Model1dRates *rates);

// Fronts at which something is lost first, length; NaN: not up to L.
typedef struct Model1dLosses {
    double l_sc;   // an oscillation grows
    double l_c;   // a disturbance grows without oscillating
    double l_rod;   // an oscillation grows from V to v_c within half a period
} Model1dLosses;
bool model1d_losses(const Model1d *model, Model1dLosses *losses, Error *err);

// --- steps (chain.c) -----------------------------------------------------------------------------
// Linear elements, everything but the axial terms lumped at the nodes: errors go with (L/n)^2.
typedef struct Chain {
    Interface interface;   // contact nodes, one rod; owned, like all that follows
    ReducedBulk reduced;   // all unknowns are the interface's: nothing inside
    BulkOperator system;
    Rod rod;
    FrictionLaw law;
    Friction friction;   // by that law
    Block block;   // of the above
} Chain;

// points: nodes, at least 3. The chain must not be moved afterwards.
bool chain_build(const Model1d *model, int32_t points, Chain *chain, Error *err);
void chain_destroy(Chain *chain);
// Puts the state at rest in u_0, the rod at U = 0.
void chain_rest(const Model1d *model, const Chain *chain, State *state);

// --- simulation (steps.c) ------------------------------------------------------------------------
enum { MODEL1D_POINTS = 40 };   // fronts of the table, up to l = L

typedef struct Model1dSimulation {
    Model1d model;
    const Scene *scene;   // not owned, like the options
    const Model1dOptions *options;
    Chain chain;   // owned, like all that follows
    StepControl control;
    ObservationScales scales;
    Events events;
    Drops drops;
    ContactArrays contact;
    History history;
    double t_end;   // time
    Model1dPoint *points;   // [point_count] theory; the simulation adds what it sees
    int32_t point_count;
    int32_t next_point;   // whose U is not reached yet
    Observation last;   // the step before, its U and mu
    double energy_error, contact_error;   // largest, relative
    double quasi_static_error;   // largest |mu - theory| before the first rapid event, 1
} Model1dSimulation;

bool model1d_simulate(Model1dSimulation *simulation, Error *err);

// --- results (file.c) ----------------------------------------------------------------------------
// model1d.json and model1d.h5 in the options' folder.
bool model1d_write(const Model1dSimulation *simulation, const Model1dSummary *summary, Error *err);

#endif
