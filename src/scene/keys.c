// SPDX-License-Identifier: GPL-2.0-or-later
// The table. A key's place in Scene is an offset, so that one function sets every number and one
// shows it; choices stand in the order of their enums. A new key needs its line here, a field in
// scene/scene.h, and code that reads it; parsing, --set, run.json and the reference follow.
#include "scene/keys.h"

#include "base/text.h"
#include "render/render.h"

#include <string.h>

// Choices stand in the order of their enums in scene/scene.h and contact/friction_law.h.
static const char *const units_choices[] = {"normalised", "si", NULL};
static const char *const plane_choices[] = {"stress", "strain", NULL};
static const char *const law_choices[] = {
#define X(symbol, name, own, drops) name,
    FRICTION_LAWS(X)
#undef X
        NULL};
static const char *const interpolation_choices[] = {"cubic", "linear", NULL};
static const char *const evolution_choices[] = {"ageing", "slip", NULL};
static const char *const rod_ends_choices[] = {"exact", "nodes", NULL};
static const char *const rod_choices[] = {"push", "bonded", "none", NULL};
static const char *const switch_choices[] = {"off", "on", NULL};
static const char *const start_rod_choices[] = {"away", "held", NULL};
static const char *const start_state_choices[] = {"relaxed", "undeformed", NULL};
static const char *const scheme_choices[] = {"sdirk2", "explicit", "euler", "sdirk3", NULL};
static const char *const reduce_choices[] = {"auto", "always", "never", NULL};
static const char *const answer_choices[] = {"mu_M", "mu_hold", NULL};
static const char *const accuracy_choices[] = {"draft", "standard", "fine", NULL};
static const char *const figure_choices[] = {
#define X(symbol, name, title) name,
    RENDER_FIGURES(X)
#undef X
        NULL};

// Keys of one map stand together: the writers open and close maps as they go along.
static const SceneKey keys[] = {
    {"title", KEY_TEXT, offsetof(Scene, title), "1", RANGE_ANY, "\"\"",
     .sentence = "What the scene is, in a line; shown in the closing lines and above figures, kept "
                 "in results."},
    {"units", KEY_CHOICE, offsetof(Scene, units), "1", RANGE_ANY, "normalised",
     .sentence = "`normalised`: plain numbers; density, Young's modulus and eta1 usually 1. `si`: "
                 "numbers in SI base units, or with a unit (10 um/s, 3 kPa).",
     .choices = units_choices},
    {"mesh.file", KEY_TEXT, offsetof(Scene, mesh.file), "1", RANGE_ANY, NULL,
     .sentence = "The mesh: a .msh file, or a .geo for gmsh; relative to the scene's folder."},
    {"mesh.set", KEY_PARAMETERS, offsetof(Scene, mesh), "length", RANGE_ANY, "{}",
     .sentence = "Parameters of a .geo file, each a number or a word; which there are, the file "
                 "says. Every mesh has `refine`: cells so many times as small (2, 4, ...)."},
    {"groups.top", KEY_NAME, offsetof(Scene, groups.top), "1", RANGE_ANY, "top",
     .sentence = "The physical group that carries load.pressure."},
    {"groups.rod", KEY_NAME, offsetof(Scene, groups.rod), "1", RANGE_ANY, "rod",
     .sentence = "The physical group of the trailing face, which the rod touches."},
    {"groups.contact", KEY_NAMES, offsetof(Scene, groups.contact), "1", RANGE_ANY, "[]",
     .sentence = "The physical groups that lie on the substrate; none named: every one called "
                 "`contact` or `contact_...`."},
    {"material.young", KEY_NUMBER, offsetof(Scene, material.young), "stress", RANGE_POSITIVE, "1",
     .sentence = "Young's modulus E.", .given_in_si = true},
    {"material.poisson", KEY_NUMBER, offsetof(Scene, material.poisson), "1", RANGE_POISSON, NULL,
     .sentence = "Poisson's ratio; below 0.5 in plane strain."},
    {"material.density", KEY_NUMBER, offsetof(Scene, material.density), "density", RANGE_POSITIVE,
     "1", .sentence = "Mass density rho.", .given_in_si = true},
    {"material.eta1", KEY_NUMBER, offsetof(Scene, material.eta1), "viscosity", RANGE_NOT_NEGATIVE,
     "1", .sentence = "Viscosity of the strain rate: stress eta1 eps'.", .given_in_si = true},
    {"material.eta2", KEY_NUMBER, offsetof(Scene, material.eta2), "viscosity", RANGE_NOT_NEGATIVE,
     "1", .sentence = "Viscosity of the volume rate: stress eta2 tr(eps') I.", .given_in_si = true},
    {"material.plane", KEY_CHOICE, offsetof(Scene, material.plane), "1", RANGE_ANY, "stress",
     .sentence = "Plane stress (a thin plate) or plane strain (a wide block); in space neither.",
     .choices = plane_choices},
    {"materials", KEY_MATERIALS, offsetof(Scene, materials), "1", RANGE_ANY, NULL, .may_lack = true,
     .sentence = "Materials of regions, by the names of physical surfaces (volumes): those of "
                 "young, poisson, density, eta1, eta2 that differ there from `material`."},
    {"friction.law", KEY_CHOICE, offsetof(Scene, friction.kind), "1", RANGE_ANY, "linear-weakening",
     .sentence =
         "How the local coefficient changes with slip rate; `table`, `formula` and `plugin` are "
         "one's own; `ageing`, `slip-weakening` and `rate-and-state` remember.",
     .choices = law_choices},
    {"friction.mu_static", KEY_NUMBER, offsetof(Scene, friction.mu_static), "1", RANGE_NOT_NEGATIVE,
     NULL, .sentence = "Local coefficient mu_S at rest; one's own law has it."},
    {"friction.mu_kinetic", KEY_NUMBER, offsetof(Scene, friction.mu_kinetic), "1",
     RANGE_NOT_NEGATIVE, NULL,
     .sentence = "Local coefficient mu_K of fast slip, at most mu_static; not needed with "
                 "`coulomb` and one's own law."},
    {"friction.critical_velocity", KEY_NUMBER, offsetof(Scene, friction.critical_velocity),
     "velocity", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Slip rate v_c over which friction weakens; needed by the weakening laws."},
    {"friction.velocity", KEY_NUMBERS, offsetof(Scene, own_friction.velocity), "velocity",
     RANGE_NOT_NEGATIVE, NULL, .may_lack = true,
     .sentence = "Law `table`: slip rates, ascending from 0; beyond the last mu stays."},
    {"friction.mu", KEY_NUMBERS, offsetof(Scene, own_friction.mu), "1", RANGE_NOT_NEGATIVE, NULL,
     .may_lack = true,
     .sentence = "Law `table`: the coefficient at each; the first holds at rest."},
    {"friction.interpolation", KEY_CHOICE, offsetof(Scene, own_friction.interpolation), "1",
     RANGE_ANY, NULL, .may_lack = true,
     .sentence =
         "Law `table`: between points `cubic` (each piece monotone; if not given) or `linear`.",
     .choices = interpolation_choices},
    {"friction.formula", KEY_TEXT, offsetof(Scene, own_friction.formula), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence =
         "Law `formula`: mu of the slip rate v >= 0, the pressure p and the states, with + "
         "- * / ^, brackets, sqrt, exp, log, tanh, asinh, abs, round, min, max, points, and "
         "numbers of this map where they are given: mu_static, slip_distance or D_c, ..."},
    {"friction.state", KEY_STATES, offsetof(Scene, own_friction.states), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "Law `formula`: what a contact remembers, each state by the formula of its rate "
                 "and what it is at first (if not given, as in steady slip at rod.velocity)."},
    {"friction.file", KEY_TEXT, offsetof(Scene, own_friction.file), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "Law `plugin`: a shared object with the functions of amontons_friction.h, "
                 "relative to the scene's folder; needs --trust."},
    {"friction.parameters", KEY_NUMBERS, offsetof(Scene, own_friction.parameters), "1", RANGE_ANY,
     NULL, .may_lack = true, .sentence = "Law `plugin`: at most 16 numbers for it."},
    {"friction.velocity_max", KEY_NUMBER, offsetof(Scene, own_friction.velocity_max), "velocity",
     RANGE_POSITIVE, NULL, .may_lack = true,
     .sentence = "Laws `formula` and `plugin`: slip rate beyond which mu stays, and up to which it "
                 "is looked at beforehand; if not given, that of sound, sqrt(E/rho)."},
    {"friction.slip_distance", KEY_NUMBER, offsetof(Scene, own_friction.slip_distance), "length",
     RANGE_POSITIVE, NULL, .may_lack = true,
     .sentence = "Laws with memory: slip D_c over which contacts lose what they had."},
    {"friction.healing_time", KEY_NUMBER, offsetof(Scene, own_friction.healing_time), "time",
     RANGE_POSITIVE, NULL, .may_lack = true,
     .sentence = "Law `ageing`: theta_0 of 1 + beta ln(1 + theta/theta_0); `slip-weakening`: time "
                 "t_h in which strength comes back at rest, but for 1/e."},
    {"friction.healing", KEY_NUMBER, offsetof(Scene, own_friction.healing), "1", RANGE_NOT_NEGATIVE,
     NULL, .may_lack = true,
     .sentence = "Law `ageing`: beta, by which part of mu friction grows each time that the age is "
                 "e times as much."},
    {"friction.direct_effect", KEY_NUMBER, offsetof(Scene, own_friction.direct_effect), "1",
     RANGE_POSITIVE, NULL, .may_lack = true,
     .sentence =
         "Law `rate-and-state`: a, by which mu rises at once when slip is e times as fast."},
    {"friction.evolution_effect", KEY_NUMBER, offsetof(Scene, own_friction.evolution_effect), "1",
     RANGE_NOT_NEGATIVE, NULL, .may_lack = true,
     .sentence = "Law `rate-and-state`: b, by which mu falls again over slip_distance; above a "
                 "friction weakens."},
    {"friction.mu_reference", KEY_NUMBER, offsetof(Scene, own_friction.mu_reference), "1",
     RANGE_POSITIVE, NULL, .may_lack = true,
     .sentence = "Law `rate-and-state`: f_0, mu of steady slip at reference_velocity."},
    {"friction.reference_velocity", KEY_NUMBER, offsetof(Scene, own_friction.reference_velocity),
     "velocity", RANGE_POSITIVE, NULL, .may_lack = true,
     .sentence = "Law `rate-and-state`: V_0, for mu_reference."},
    {"friction.evolution", KEY_CHOICE, offsetof(Scene, own_friction.evolution), "1", RANGE_ANY,
     NULL, .may_lack = true,
     .sentence = "Law `rate-and-state`: contacts strengthen at rest (`ageing`; if not given) or by "
                 "slip alone (`slip`).",
     .choices = evolution_choices},
    {"friction.rest", KEY_NUMBER, offsetof(Scene, own_friction.rest), "time", RANGE_POSITIVE, NULL,
     .may_lack = true,
     .sentence = "Laws with memory: how long the contacts have rested when the rod begins to move; "
                 "if not given, they are as in steady slip at rod.velocity."},
    {"friction.along", KEY_TEXT, offsetof(Scene, own_friction.along), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "Factor on mu along the contact: a formula of x (and y), as in `points(x, 0.4, 1, "
                 "0.45, 0.3, 0.55, 0.3, 0.6, 1)`, a middle that is lubricated."},
    {"friction.contacts", KEY_CONTACT_LAWS, offsetof(Scene, contact_laws), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence =
         "Friction of single contact groups, a list of {group: NAME, ...} with those of law, "
         "mu_static, mu_kinetic, critical_velocity, formula and along that differ there."},
    {"contact.radius", KEY_NUMBER, offsetof(Scene, contact.radius), "length", RANGE_NOT_NEGATIVE,
     "0",
     .sentence = "The substrate falls away from the middle of the block as x^2 / (2 radius); 0: it "
                 "is flat."},
    {"contact.gap", KEY_TEXT, offsetof(Scene, contact.gap), "1", RANGE_ANY, NULL, .may_lack = true,
     .sentence = "How far the substrate lies below z = 0: a formula of x (and y), as in `max(0, "
                 "0.1 - x)^2 / 0.4`, a trailing edge rounded by a radius of 0.2, or `points(x, 0, "
                 "1e-3, 0.5, 0, ...)`, a measured profile. It adds to radius and to what the "
                 "mesh's own contact curves leave."},
    {"contact.profile", KEY_TEXT, offsetof(Scene, contact.profile), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "The same as a file, relative to the scene's folder: a line for each point, x and "
                 "gap, in space also x, y and gap (a height map), over all of the contact. A first "
                 "line may give units, `x [mm], gap [um]`."},
    {"load.pressure", KEY_NUMBER, offsetof(Scene, load.pressure), "stress", RANGE_NOT_NEGATIVE,
     NULL, .sentence = "Uniform pressure P_ext on groups.top."},
    {"load.tractions", KEY_TRACTIONS, offsetof(Scene, load), "stress", RANGE_ANY, "[]",
     .sentence = "Further tractions, a list of {group, x, z} (and y): a stress on a group."},
    {"load.supports", KEY_SUPPORTS, offsetof(Scene, load.supports), "1", RANGE_ANY, "[]",
     .sentence = "Where the block is held, a list of {group, direction}: nodes of a group that do "
                 "not move along `x`, `z` or `both`, in space also `y` or `all`."},
    {"load.program.t", KEY_NUMBERS, offsetof(Scene, load.program.t), "time", RANGE_NOT_NEGATIVE,
     NULL, .may_lack = true,
     .sentence = "Times of the program, ascending from 0; the same twice: a jump."},
    {"load.program.U", KEY_NUMBERS, offsetof(Scene, load.program.U), "length", RANGE_NOT_NEGATIVE,
     NULL, .may_lack = true,
     .sentence = "The same by displacements of the rod's drive, in the place of times."},
    {"load.program.factor", KEY_NUMBERS, offsetof(Scene, load.program.factor), "1", RANGE_POSITIVE,
     NULL, .may_lack = true,
     .sentence = "The load at each, over that at t = 0, under which the block relaxes: the first "
                 "is 1. Straight lines between."},
    {"load.program.repeat", KEY_FLAG, offsetof(Scene, load.program.repeat), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "true: begin again after the last point; else what it has there stays."},
    {"rod.velocity", KEY_NUMBER, offsetof(Scene, rod.velocity), "velocity", RANGE_POSITIVE, NULL,
     .sentence =
         "Speed V of the rod along x; not needed with kind `none`, nor by `amontons static`."},
    {"rod.stiffness", KEY_NUMBER, offsetof(Scene, rod.stiffness), "stress", RANGE_POSITIVE, NULL,
     .may_lack = true,
     .sentence = "Stiffness of the machine: a spring between the drive, which moves with "
                 "`rod.velocity`, and the rod; force per width (breadth) of the block over length. "
                 "If not given, the rod itself moves with `rod.velocity`."},
    {"rod.displacement", KEY_NUMBER, offsetof(Scene, rod.displacement), "length", RANGE_ANY, "0",
     .sentence =
         "How far the rod stands inside the undeformed block; read by `amontons static` only."},
    {"rod.height", KEY_NUMBER, offsetof(Scene, rod.height), "length", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Height of the strip's centre over the substrate; 0: half the block's height."},
    {"rod.width", KEY_NUMBER, offsetof(Scene, rod.width), "length", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Extent of the driven strip; 0: a tenth of the block's height."},
    {"rod.breadth", KEY_NUMBER, offsetof(Scene, rod.breadth), "length", RANGE_POSITIVE, NULL,
     .may_lack = true,
     .sentence = "In space: extent of the strip along y, in the middle of its face; else all."},
    {"rod.whole", KEY_FLAG, offsetof(Scene, rod.whole), "1", RANGE_ANY, NULL, .may_lack = true,
     .sentence = "true: all of groups.rod is driven, in the place of a strip."},
    {"rod.kind", KEY_CHOICE, offsetof(Scene, rod.kind), "1", RANGE_ANY, "push",
     .sentence = "`push`: can lose contact, never pulls. `bonded`: glued on. `none`: no rod.",
     .choices = rod_choices},
    {"rod.ends", KEY_CHOICE, offsetof(Scene, rod.ends), "1", RANGE_ANY, "exact",
     .sentence = "`exact`: the strip ends where height and width say, also within a cell. `nodes`: "
                 "it is the nodes inside, and its width changes with the mesh.",
     .choices = rod_ends_choices},
    {"rod.program.t", KEY_NUMBERS, offsetof(Scene, rod.program.t), "time", RANGE_NOT_NEGATIVE, NULL,
     .may_lack = true,
     .sentence = "Times of the program, ascending from 0; the same twice: a jump."},
    {"rod.program.U", KEY_NUMBERS, offsetof(Scene, rod.program.U), "length", RANGE_NOT_NEGATIVE,
     NULL, .may_lack = true,
     .sentence = "The same by displacements of the rod's drive, in the place of times."},
    {"rod.program.factor", KEY_NUMBERS, offsetof(Scene, rod.program.factor), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "The rod's velocity at each, over rod.velocity: 0 holds it, below 0 it goes back. "
                 "Straight lines between."},
    {"rod.program.repeat", KEY_FLAG, offsetof(Scene, rod.program.repeat), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "true: begin again after the last point; else what it has there stays."},
    {"start.friction", KEY_CHOICE, offsetof(Scene, start.friction), "1", RANGE_ANY, "on",
     .sentence = "Whether friction acts while the block relaxes under its load.",
     .choices = switch_choices},
    {"start.rod", KEY_CHOICE, offsetof(Scene, start.rod), "1", RANGE_ANY, "away",
     .sentence = "`away`: the rod touches the relaxed face at t = 0. `held`: it stands there while "
                 "the block relaxes.",
     .choices = start_rod_choices},
    {"start.state", KEY_CHOICE, offsetof(Scene, start.state), "1", RANGE_ANY, "relaxed",
     .sentence =
         "The block at t = 0: `relaxed` under its load, or `undeformed`, the load put on at once.",
     .choices = start_state_choices},
    {"start.velocity_x", KEY_NUMBER, offsetof(Scene, start.velocity_x), "velocity", RANGE_ANY, "0",
     .sentence = "Velocity of the whole block at t = 0, along x."},
    {"start.velocity_z", KEY_NUMBER, offsetof(Scene, start.velocity_z), "velocity", RANGE_ANY, "0",
     .sentence = "The same along z; towards the substrate where negative."},
    {"start.tolerance", KEY_NUMBER, offsetof(Scene, start.tolerance), "1", RANGE_PART, "1e-6",
     .sentence = "The block is relaxed when every speed is below this times the rod's."},
    {"start.duration_max", KEY_NUMBER, offsetof(Scene, start.duration_max), "1", RANGE_POSITIVE,
     "1e4", .sentence = "Longest relaxation allowed, in viscous times eta1/E."},
    {"time.until.U", KEY_NUMBER, offsetof(Scene, time.until_U), "length", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Stop when the rod has moved this far; 0: not by U."},
    {"time.until.t", KEY_NUMBER, offsetof(Scene, time.until_t), "time", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Stop at this time after the rod's start; 0: not by time."},
    {"time.until.periodic", KEY_FLAG, offsetof(Scene, time.until_periodic), "1", RANGE_ANY, "false",
     .sentence = "Stop earlier when the periodic regime is established, or when load drops that do "
                 "not repeat are enough (results.drops.enough)."},
    {"time.until.slidings", KEY_NUMBER, offsetof(Scene, time.until_slidings), "1",
     RANGE_NOT_NEGATIVE, NULL, .may_lack = true,
     .sentence = "Stop earlier when the whole block has slid so many times, each to its end; 1: "
                 "the first sliding."},
    {"time.until.mu_below", KEY_NUMBER, offsetof(Scene, time.until_mu_below), "1",
     RANGE_NOT_NEGATIVE, NULL, .may_lack = true,
     .sentence = "Stop earlier when F_T / F_N falls below this, having been above."},
    {"time.scheme", KEY_CHOICE, offsetof(Scene, time.scheme), "1", RANGE_ANY, "sdirk2",
     .sentence =
         "`sdirk2`: implicit, of order 2, steps as long as the answer allows. `euler`, `sdirk3`: "
         "the same with backward Euler (order 1), three stages (order 3). `explicit`: central "
         "differences at the stable step, an independent check that takes far longer.",
     .choices = scheme_choices},
    {"time.accuracy", KEY_CHOICE, offsetof(Scene, time.accuracy), "1", RANGE_ANY, "standard",
     .sentence =
         "Error allowed to steps (2e-2, 5e-3, 5e-4) and to the reduction where their own keys do "
         "not say; `fine` is for references. The error of the mesh is another matter: accuracy.mu.",
     .choices = accuracy_choices},
    {"time.tolerance", KEY_NUMBER, offsetof(Scene, time.tolerance), "1", RANGE_PART_OR_ZERO, "0",
     .sentence = "Local error allowed to the displacements in one step, over the slip that the "
                 "drop of friction drives, (mu_S - mu_K) P H / E; 0: by time.accuracy."},
    {"time.step_max", KEY_NUMBER, offsetof(Scene, time.step_max), "time", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Longest step; 0: the rod moves 0.2 of the slip that the drop of friction drives "
                 "(see time.tolerance), or of friction.slip_distance if that is more, in it, up to "
                 "twice that; without a rod a 50th of the run."},
    {"time.step_min", KEY_NUMBER, offsetof(Scene, time.step_min), "time", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Shortest step; 0: 1e-10 of the smaller of longest step and wave step."},
    {"time.wave_step", KEY_NUMBER, offsetof(Scene, time.wave_step), "1", RANGE_PART, "0.2",
     .sentence = "Longest step while slip is not certified to be stable, in wave crossings of the "
                 "block, L / c_L (L / 2 c_S where that is longer)."},
    {"time.watch", KEY_NUMBER, offsetof(Scene, time.watch), "1", RANGE_NOT_NEGATIVE, "20",
     .sentence =
         "How long oscillations of slow slip beyond l_sc are followed at each position of the "
         "front, in wave crossings of the block; after that those that stay small are stepped "
         "over, so that a slow rod costs no more than a fast one. 0: all of them are followed."},
    {"time.certificate", KEY_FLAG, offsetof(Scene, time.certificate), "1", RANGE_ANY, "true",
     .sentence = "Resolve waves wherever slip is not certified to be stable; off gives wrong "
                 "answers and is for studying just that."},
    {"time.energy_tolerance", KEY_NUMBER, offsetof(Scene, time.energy_tolerance), "1", RANGE_PART,
     "1e-3",
     .sentence = "The run fails when the energy ledger is off by more, relative to the work done."},
    {"time.periodic_tolerance", KEY_NUMBER, offsetof(Scene, time.periodic_tolerance), "1",
     RANGE_PART, "1e-2",
     .sentence = "Load drops that agree within this, relative, make a periodic regime."},
    {"accuracy.mu", KEY_NUMBER, offsetof(Scene, accuracy.mu), "1", RANGE_PART_OR_ZERO, "0",
     .sentence = "Error bar wanted of mu_M (of mu_hold where the block does not slide as a whole), "
                 "relative, such as 1%: the mesh is refined and runs are repeated until it is met. "
                 "0: one run on the mesh as it is, whose error is not known."},
    {"accuracy.of", KEY_CHOICE, offsetof(Scene, accuracy.of), "1", RANGE_ANY, "mu_M",
     .sentence = "`mu_hold`: the bar is asked of mu_hold in any case. On pads, where some slide "
                 "before the others, it takes finer meshes than that of mu_M.",
     .choices = answer_choices},
    {"accuracy.within", KEY_NUMBER, offsetof(Scene, accuracy.within), "1", RANGE_NOT_NEGATIVE, "0",
     .sentence = "Seconds of this computer's time that may go into it; 0: as many as it takes."},
    {"accuracy.window", KEY_NUMBER, offsetof(Scene, accuracy.window), "1", RANGE_PART, "0.01",
     .sentence = "Width of the window of pressures, relative, over which branches that coexist are "
                 "averaged."},
    {"reduction.use", KEY_CHOICE, offsetof(Scene, reduction.use), "1", RANGE_ANY, "auto",
     .sentence = "Reduce the bulk to its interface and a small interior basis before stepping; "
                 "`auto`: where that is expected to be faster.",
     .choices = reduce_choices},
    {"reduction.tolerance", KEY_NUMBER, offsetof(Scene, reduction.tolerance), "1",
     RANGE_PART_OR_ZERO, "0",
     .sentence = "Error allowed to the answers of the reduced interior, relative, in the energy "
                 "norm; 0: by time.accuracy."},
    {"reduction.cache", KEY_FLAG, offsetof(Scene, reduction.cache), "1", RANGE_ANY, "true",
     .sentence = "Keep the basis on disk for the next run of the same shape, of whatever length."},
    {"output.history", KEY_FLAG, offsetof(Scene, output.history), "1", RANGE_ANY, "true",
     .sentence = "Write history.h5: time series and the interface at every step."},
    {"output.fields", KEY_FIELDS, offsetof(Scene, output.fields), "1", RANGE_ANY, "none",
     .sentence = "Fields of the block for ParaView (fields.pvd): `none`, or when to write them."},
    {"output.fields.every_U", KEY_NUMBER, offsetof(Scene, output.fields_every_U), "length",
     RANGE_NOT_NEGATIVE, "0", .sentence = "A file each time the rod has moved this far; 0: none."},
    {"output.fields.every_t", KEY_NUMBER, offsetof(Scene, output.fields_every_t), "time",
     RANGE_NOT_NEGATIVE, "0",
     .sentence = "A file each time this much time has passed; 0: not by time."},
    {"output.fields.every_step", KEY_FLAG, offsetof(Scene, output.fields_every_step), "1",
     RANGE_ANY, NULL, .may_lack = true,
     .sentence = "true: a file at each step that the solver takes; best in an output.window."},
    {"output.fields.at_events", KEY_FLAG, offsetof(Scene, output.fields_at_events), "1", RANGE_ANY,
     "false", .sentence = "A file at the start and stop of each precursor and sliding."},
    {"output.fields.film", KEY_FLAG, offsetof(Scene, output.fields_film), "1", RANGE_ANY, "false",
     .sentence = "What a film needs: see above. `fields: film` says the same."},
    {"output.window.from_U", KEY_NUMBER, offsetof(Scene, output.window.from_U), "length",
     RANGE_NOT_NEGATIVE, NULL, .may_lack = true,
     .sentence = "Fields are written in a part of the run only: from this U on."},
    {"output.window.to_U", KEY_NUMBER, offsetof(Scene, output.window.to_U), "length",
     RANGE_POSITIVE, NULL, .may_lack = true, .sentence = "Up to this displacement."},
    {"output.window.from_t", KEY_NUMBER, offsetof(Scene, output.window.from_t), "time",
     RANGE_NOT_NEGATIVE, NULL, .may_lack = true, .sentence = "From this time on."},
    {"output.window.to_t", KEY_NUMBER, offsetof(Scene, output.window.to_t), "time", RANGE_POSITIVE,
     NULL, .may_lack = true, .sentence = "Up to this time."},
    {"output.window.around", KEY_TEXT, offsetof(Scene, output.window.around), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "`sliding 3`: the third time that the whole block slides, from the step before "
                 "slip gets rapid to the one in which all is slow again."},
    {"output.window.last", KEY_TEXT, offsetof(Scene, output.window.last), "1", RANGE_ANY, NULL,
     .may_lack = true,
     .sentence = "`2 slidings`: from the end of the one before them to the end of the run."},
    {"output.window.history", KEY_FLAG, offsetof(Scene, output.window.history), "1", RANGE_ANY,
     NULL, .may_lack = true,
     .sentence = "true: history.h5 has the steps of the window only; else all."},
    {"output.figures", KEY_NAMES, offsetof(Scene, output.figures), "1", RANGE_ANY, "[]",
     .sentence = "The pictures to draw at the end.", .choices = figure_choices},
    {"output.compare", KEY_TEXT, offsetof(Scene, output.compare), "1", RANGE_ANY, NULL,
     .may_lack = true, .sentence = "Measurements (.csv) to be drawn beside it, with the misfit."},
};

enum { KEY_COUNT = sizeof keys / sizeof keys[0] };
_Static_assert((int)KEY_COUNT <= (int)SCENE_KEYS_MAX, "Scene.given is too short");

const SceneKey *scene_keys(int32_t *count)
{
    *count = KEY_COUNT;
    return keys;
}

int32_t scene_key_index(const char *name)
{
    for (int32_t k = 0; k < KEY_COUNT; k++)
        if (strcmp(keys[k].name, name) == 0) return k;
    return -1;
}

int32_t scene_key_above(const char *name, const char **part)
{
    for (int32_t k = 0; k < KEY_COUNT; k++) {
        size_t length = strlen(keys[k].name);
        bool open = keys[k].type == KEY_PARAMETERS || keys[k].type == KEY_MATERIALS;
        if (!open || strncmp(name, keys[k].name, length) != 0 || name[length] != '.') continue;
        *part = name + length + 1;
        return k;
    }
    return -1;
}

// A group is what stands before a dot in some key.
bool scene_key_is_group(const char *name)
{
    size_t length = strlen(name);
    for (int32_t k = 0; k < KEY_COUNT; k++)
        if (strncmp(keys[k].name, name, length) == 0 && keys[k].name[length] == '.') return true;
    return false;
}

static const char *last_word(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? dot + 1 : name;
}

// First the right word in another map (`poisson` at the top), then a slip of the keyboard in the
// whole name, then in its last word.
const char *scene_key_nearest(const char *name)
{
    static const char *const groups[] = {"mesh",    "groups",      "material",     "friction",
                                         "contact", "load",        "rod",          "start",
                                         "time",    "time.until",  "accuracy",     "reduction",
                                         "output",  "rod.program", "load.program", "output.window"};
    enum { GROUP_COUNT = sizeof groups / sizeof groups[0], COUNT = GROUP_COUNT + KEY_COUNT };
    const char *names[COUNT], *words[COUNT];
    for (int32_t k = 0; k < GROUP_COUNT; k++) names[k] = groups[k];
    for (int32_t k = 0; k < KEY_COUNT; k++) names[GROUP_COUNT + k] = keys[k].name;
    for (int32_t k = 0; k < COUNT; k++) words[k] = last_word(names[k]);
    // Right, but in another map; of two, the one that most scenes have.
    for (int32_t rare = 0; rare < 2; rare++)
        for (int32_t k = 0; k < COUNT; k++)
            if ((k >= GROUP_COUNT && keys[k - GROUP_COUNT].may_lack) == rare &&
                strcmp(words[k], last_word(name)) == 0)
                return names[k];
    int32_t nearest = text_nearest(name, names, COUNT);
    if (nearest < 0) nearest = text_nearest(last_word(name), words, COUNT);
    return nearest < 0 ? NULL : names[nearest];
}
