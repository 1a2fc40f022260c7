// SPDX-License-Identifier: GPL-2.0-or-later
// The table. A key's place in Scene is an offset, so that one function sets every number and one
// shows it; choices stand in the order of their enums. A new key needs its line here, a field in
// scene/scene.h, and code that reads it; parsing, --set, run.json and the reference follow.
#include "scene/keys.h"

#include "amontons_pictures.h"
#include "base/text.h"

#include <string.h>

// Choices stand in the order of their enums in scene/scene.h and friction/laws/law.h.
static const char *const law_choices[] = {
#define X(symbol, name, operations) name,
    FRICTION_LAWS(X)
#undef X
        NULL};
static const char *const interpolation_choices[] = {"cubic", "linear", "log", NULL};
static const char *const unit_choices[] = {
#define X(symbol, name, metres) name,
    SCENE_LENGTHS(X)
#undef X
        NULL};
static const char *const evolution_choices[] = {"ageing", "slip", NULL};
static const char *const figure_choices[] = {
#define X(symbol, name, title) name,
    PICTURE_FIGURES(X)
#undef X
        NULL};

#define KEY(name, type, field, unit, range, standard, ...)                                         \
    {                                                                                              \
        name, type, offsetof(Scene, field), unit, range, standard, .sentence = __VA_ARGS__         \
    }
// The macros below are for keys whose names are also the paths in Scene.
#define NUMBER(name, ...) KEY(#name, KEY_NUMBER, name, __VA_ARGS__)
#define WORDS(type, name, ...) KEY(#name, type, name, "1", RANGE_ANY, __VA_ARGS__)
#define CHOICE(name, standard, sentence, ...)                                                      \
    WORDS(KEY_CHOICE, name, standard, sentence, .choices = (const char *const[]){__VA_ARGS__, NULL})

// Keys of one map stand together: the writers open and close maps as they go along.
static const SceneKey keys[] = {
    WORDS(KEY_TEXT, title, "\"\"",
          "What the scene is, in a line; shown in the closing lines and above figures, kept in "
          "results."),
    CHOICE(units, "normalised",
           "`normalised`: plain numbers; density, Young's modulus and eta1 usually 1. `si`: "
           "numbers in SI base units, or with a unit (10 um/s, 3 kPa).",
           "normalised", "si"),
    NUMBER(thickness, "length", RANGE_POSITIVE, NULL,
           "In the plane: how thick the block is, across the plane. Forces are then those of the "
           "whole block: load.force, rod.stiffness in N/m, and results in newtons."),
    WORDS(KEY_TEXT, mesh.file, NULL,
          "The mesh: a .msh file, or a .geo for gmsh; relative to the scene's folder.",
          .must_be_given = true),
    KEY("mesh.set", KEY_PARAMETERS, mesh, "length", RANGE_ANY, "{}",
        "Parameters of a .geo file, each a number or a word; which there are, the file says. Every "
        "mesh has `refine`: cells so many times as small (2, 4, ...)."),
    KEY("mesh.unit", KEY_CHOICE, mesh.unit, "1", RANGE_ANY, NULL,
        "SI scenes: the unit in which the mesh is drawn; if not given, m.",
        .choices = unit_choices),
    NUMBER(mesh.scale, "1", RANGE_POSITIVE, "1",
           "Coordinates of the mesh times this, beside its unit."),
    KEY("mesh.shift", KEY_NUMBERS, mesh.shift, "length", RANGE_ANY, NULL,
        "The mesh is then moved by this, [x, z], in space [x, y, z]; if not given, along z alone, "
        "so "
        "that its lowest contact node stands on the substrate."),
    WORDS(KEY_NAMES, groups.body, "[]",
          "The physical surfaces (volumes) that are computed; none named: all that the mesh has. "
          "What else is in the mesh is left out: with the block's alone the floor is rigid, "
          "whatever base the mesh has."),
    WORDS(KEY_NAME, groups.floor, "floor",
          "The physical group that is the upper side of a base, a second body under the block: the "
          "floor then deforms with it (load.supports must hold the base)."),
    WORDS(KEY_NAME, groups.top, "top", "The physical group that carries load.pressure."),
    WORDS(KEY_NAME, groups.rod, "rod",
          "The physical group of the trailing face, which the rod touches."),
    WORDS(KEY_NAMES, groups.contact, "[]",
          "The physical groups that lie on the substrate; none named: every one called `contact` "
          "or `contact_...`."),
    NUMBER(material.young, "stress", RANGE_POSITIVE, "1",
           "Young's modulus E; with `relaxation` that of the long-time response.",
           .given_in_si = true),
    NUMBER(material.poisson, "1", RANGE_POISSON, NULL,
           "Poisson's ratio; below 0.5 in plane strain.", .must_be_given = true),
    NUMBER(material.density, "density", RANGE_POSITIVE, "1", "Mass density rho.",
           .given_in_si = true),
    NUMBER(material.eta1, "viscosity", RANGE_NOT_NEGATIVE, "1",
           "Viscosity of the strain rate: stress eta1 eps'.", .given_in_si = true),
    NUMBER(material.eta2, "viscosity", RANGE_NOT_NEGATIVE, "1",
           "Viscosity of the volume rate: stress eta2 tr(eps') I.", .given_in_si = true),
    KEY("material.relaxation", KEY_BRANCHES, material.relaxation, "1", RANGE_ANY, NULL,
        "Branches of a generalised Maxwell solid (a Prony series) beside all else, each a spring "
        "of shear modulus `shear` and bulk modulus `bulk` (0 if not given) that relaxes in "
        "`time`."),
    WORDS(KEY_TEXT, material.from, NULL,
          "In the place of young, eta1, eta2 and relaxation: a table of storage and loss modulus "
          "over frequency (f, E', E''), or of a relaxation curve (t, E), to which they are fitted; "
          "relative to the scene's folder. eta1 and eta2 may be given beside it."),
    KEY("material.wlf", KEY_NUMBERS, material.wlf, "1", RANGE_ANY, NULL,
        "Shifts such tables: [c1, c2, T_ref, T] of Williams, Landel and Ferry, T that of the "
        "block, in degrees Celsius; data are at T_ref, or at that of their column T."),
    NUMBER(material.shift, "1", RANGE_POSITIVE, "1",
           "Relaxation in the block takes so many times as long as in such tables."),
    CHOICE(
        material.bulk, "elastic",
        "What such tables mean for volume: it is `elastic` and shape alone relaxes (rubber), or it "
        "`relaxes` alike.",
        "elastic", "relaxes"),
    CHOICE(material.plane, "stress",
           "Plane stress (a thin plate) or plane strain (a wide block); in space neither.",
           "stress", "strain"),
    KEY("materials", KEY_ITEMS, materials.count, "1", RANGE_ANY, NULL,
        "Materials of regions, by the names of physical surfaces (volumes): those of young, "
        "poisson, density, eta1, eta2, relaxation, from that differ there from "
        "`material`.",
        .items = &scene_material_items),
    KEY("friction.law", KEY_CHOICE, friction.kind, "1", RANGE_ANY, "linear-weakening",
        "How the local coefficient changes with slip rate; `table`, `formula` and `plugin` are "
        "one's own; `ageing`, `slip-weakening` and `rate-and-state` remember.",
        .choices = law_choices),
    NUMBER(friction.mu_static, "1", RANGE_NOT_NEGATIVE, NULL,
           "Local coefficient mu_S at rest; one's own law has it.", .must_be_given = true),
    NUMBER(friction.mu_kinetic, "1", RANGE_NOT_NEGATIVE, NULL,
           "Local coefficient mu_K of fast slip, at most mu_static; not needed with `coulomb` and "
           "one's own law.",
           .must_be_given = true),
    NUMBER(friction.critical_velocity, "velocity", RANGE_NOT_NEGATIVE, "0",
           "Slip rate v_c over which friction weakens; needed by the weakening laws."),
    KEY("friction.velocity", KEY_NUMBERS, friction_keys.velocity, "velocity", RANGE_NOT_NEGATIVE,
        NULL, "Law `table`: slip rates, ascending; beyond the last mu stays."),
    KEY("friction.mu", KEY_NUMBERS, friction_keys.mu, "1", RANGE_NOT_NEGATIVE, NULL,
        "Law `table`: the coefficient at each. At rest it is mu_static where the table begins "
        "above "
        "0 and that is given, else the first."),
    KEY("friction.interpolation", KEY_CHOICE, friction_keys.interpolation, "1", RANGE_ANY, NULL,
        "Law `table`: between points `cubic` (each piece monotone; if not given), `linear`, or "
        "`log`: the same cubics over the logarithm of the slip rate.",
        .choices = interpolation_choices),
    KEY("friction.formula", KEY_TEXT, friction_keys.formula, "1", RANGE_ANY, NULL,
        "Law `formula`: mu of the slip rate v >= 0, the pressure p and the states, with + - * / ^, "
        "brackets, sqrt, exp, log, tanh, asinh, abs, round, min, max, points, and numbers of this "
        "map where they are given: mu_static, slip_distance or D_c, ..."),
    KEY("friction.state", KEY_ITEMS, friction_keys.states.count, "1", RANGE_ANY, NULL,
        "Law `formula`: what a contact remembers, each state by the formula of its rate and what "
        "it is at first (if not given, as in steady slip at rod.velocity).",
        .items = &scene_state_items),
    KEY("friction.file", KEY_TEXT, friction_keys.file, "1", RANGE_ANY, NULL,
        "Law `table`: a file with the columns v and mu, in the place of `velocity` and `mu`. Law "
        "`plugin`: a shared object with the functions of amontons_friction.h, which needs --trust. "
        "Relative to the scene's folder."),
    KEY("friction.parameters", KEY_NUMBERS, friction_keys.parameters, "1", RANGE_ANY, NULL,
        "Law `plugin`: at most 16 numbers for it."),
    KEY("friction.velocity_max", KEY_NUMBER, friction_keys.velocity_max, "velocity", RANGE_POSITIVE,
        NULL,
        "Laws `formula` and `plugin`: slip rate beyond which mu stays, and up to which it is "
        "looked at beforehand; if not given, that of sound, sqrt(E/rho)."),
    KEY("friction.slip_distance", KEY_NUMBER, friction_keys.slip_distance, "length", RANGE_POSITIVE,
        NULL, "Laws with memory: slip D_c over which contacts lose what they had."),
    KEY("friction.healing_time", KEY_NUMBER, friction_keys.healing_time, "time", RANGE_POSITIVE,
        NULL,
        "Law `ageing`: theta_0 of 1 + beta ln(1 + theta/theta_0); `slip-weakening`: time t_h in "
        "which strength comes back at rest, but for 1/e."),
    KEY("friction.healing", KEY_NUMBER, friction_keys.healing, "1", RANGE_NOT_NEGATIVE, NULL,
        "Law `ageing`: beta, by which part of mu friction grows each time that the age is e times "
        "as much."),
    KEY("friction.direct_effect", KEY_NUMBER, friction_keys.direct_effect, "1", RANGE_POSITIVE,
        NULL, "Law `rate-and-state`: a, by which mu rises at once when slip is e times as fast."),
    KEY("friction.evolution_effect", KEY_NUMBER, friction_keys.evolution_effect, "1",
        RANGE_NOT_NEGATIVE, NULL,
        "Law `rate-and-state`: b, by which mu falls again over slip_distance; above a friction "
        "weakens."),
    KEY("friction.mu_reference", KEY_NUMBER, friction_keys.mu_reference, "1", RANGE_POSITIVE, NULL,
        "Law `rate-and-state`: f_0, mu of steady slip at reference_velocity."),
    KEY("friction.reference_velocity", KEY_NUMBER, friction_keys.reference_velocity, "velocity",
        RANGE_POSITIVE, NULL, "Law `rate-and-state`: V_0, for mu_reference."),
    KEY("friction.evolution", KEY_CHOICE, friction_keys.evolution, "1", RANGE_ANY, NULL,
        "Law `rate-and-state`: contacts strengthen at rest (`ageing`; if not given) or by slip "
        "alone (`slip`).",
        .choices = evolution_choices),
    KEY("friction.rest", KEY_NUMBER, friction_keys.rest, "time", RANGE_POSITIVE, NULL,
        "Laws with memory: how long the contacts have rested when the rod begins to move; if not "
        "given, they are as in steady slip at rod.velocity."),
    KEY("friction.along", KEY_TEXT, friction_keys.along, "1", RANGE_ANY, NULL,
        "Factor on mu along the contact: a formula of x (and y), as in `points(x, 0.4, 1, 0.45, "
        "0.3, 0.55, 0.3, 0.6, 1)`, a middle that is lubricated."),
    KEY("friction.contacts", KEY_ITEMS, contact_laws.count, "1", RANGE_ANY, NULL,
        "Friction of single contact groups, a list of {group: NAME, ...} with those of law, "
        "mu_static, mu_kinetic, critical_velocity, formula and along that differ there.",
        .items = &scene_contact_items),
    WORDS(
        KEY_TEXT, contact.gap, NULL,
        "How far the substrate lies below z = 0: a formula of x (and y), as in `max(0, 0.1 - x)^2 "
        "/ 0.4`, a trailing edge rounded by a radius of 0.2, or `points(x, 0, 1e-3, 0.5, 0, ...)`, "
        "a measured profile. It adds to what the mesh's own contact curves leave."),
    WORDS(KEY_TEXT, contact.profile, NULL,
          "The same as a file, relative to the scene's folder: a line for each point, x and gap, "
          "in space also x, y and gap (a height map), over all of the contact. A first line may "
          "give units, `x [mm], gap [um]`."),
    NUMBER(load.pressure, "stress", RANGE_NOT_NEGATIVE, NULL,
           "Uniform pressure P_ext on groups.top; needed where load.force is not given.",
           .must_be_given = true,
           .hint = "that of groups.top; or give `load.force`, in the plane with `thickness`"),
    NUMBER(load.force, "force", RANGE_POSITIVE, NULL,
           "The force that presses groups.top down, spread evenly, in the place of load.pressure; "
           "in the plane it needs `thickness`.",
           .hint = "a force per width times `thickness`, a pressure as `load.pressure`"),
    KEY("load.tractions", KEY_ITEMS, load.traction_count, "stress", RANGE_ANY, "[]",
        "Further tractions, a list of {group, x, z} (and y): a stress on a group, or with its unit "
        "a force (5 N), spread evenly over it, in the plane with `thickness`.",
        .items = &scene_traction_items),
    KEY("load.supports", KEY_ITEMS, load.support_count, "1", RANGE_ANY, "[]",
        "Where the block is held, a list of {group, direction}: nodes of a group that do not "
        "move along `x`, `z` or `both`, in space also `y` or `all`.",
        .items = &scene_support_items),
    KEY("load.program.t", KEY_NUMBERS, load.program.t, "time", RANGE_NOT_NEGATIVE, NULL,
        "Times of the program, ascending from 0; the same twice: a jump."),
    KEY("load.program.U", KEY_NUMBERS, load.program.U, "length", RANGE_NOT_NEGATIVE, NULL,
        "The same by displacements of the rod's drive, in the place of times."),
    KEY("load.program.factor", KEY_NUMBERS, load.program.factor, "1", RANGE_POSITIVE, NULL,
        "The load at each, over that at t = 0, under which the block relaxes: the first is 1. "
        "Straight lines between."),
    WORDS(KEY_FLAG, load.program.repeat, NULL,
          "true: begin again after the last point; else what it has there stays."),
    NUMBER(rod.velocity, "velocity", RANGE_POSITIVE, NULL,
           "Speed V of the rod along x; not needed with kind `none`, nor by `amontons static`.",
           .must_be_given = true),
    NUMBER(rod.stiffness, "stress", RANGE_POSITIVE, NULL,
           "Stiffness of the machine: a spring between the drive, which moves with `rod.velocity`, "
           "and the rod; force per width (breadth) of the block over length, or that of the whole "
           "machine with its unit (4e6 N/m), in the plane with `thickness`. If not given, the rod "
           "itself moves with `rod.velocity`.",
           .total_unit = "force/length", .is_total = offsetof(Scene, rod.stiffness_is_total)),
    NUMBER(rod.displacement, "length", RANGE_ANY, "0",
           "How far the rod stands inside the undeformed block; read by `amontons static` only."),
    NUMBER(rod.height, "length", RANGE_NOT_NEGATIVE, "0",
           "Height of the strip's centre over the substrate; 0: half the block's height."),
    NUMBER(rod.width, "length", RANGE_NOT_NEGATIVE, "0",
           "Extent of the driven strip; 0: a tenth of the block's height."),
    NUMBER(rod.breadth, "length", RANGE_POSITIVE, NULL,
           "In space: extent of the strip along y, in the middle of its face; else all."),
    WORDS(KEY_FLAG, rod.whole, NULL, "true: all of groups.rod is driven, in the place of a strip."),
    CHOICE(rod.kind, "push",
           "`push`: can lose contact, never pulls. `bonded`: glued on. `none`: no rod.", "push",
           "bonded", "none"),
    CHOICE(rod.ends, "exact",
           "`exact`: the strip ends where height and width say, also within a cell. `nodes`: it is "
           "the nodes inside, and its width changes with the mesh.",
           "exact", "nodes"),
    KEY("rod.program.t", KEY_NUMBERS, rod.program.t, "time", RANGE_NOT_NEGATIVE, NULL,
        "Times of the program, ascending from 0; the same twice: a jump."),
    KEY("rod.program.U", KEY_NUMBERS, rod.program.U, "length", RANGE_NOT_NEGATIVE, NULL,
        "The same by displacements of the rod's drive, in the place of times."),
    KEY("rod.program.factor", KEY_NUMBERS, rod.program.factor, "1", RANGE_ANY, NULL,
        "The rod's velocity at each, over rod.velocity: 0 holds it, below 0 it goes back. Straight "
        "lines between."),
    WORDS(KEY_FLAG, rod.program.repeat, NULL,
          "true: begin again after the last point; else what it has there stays."),
    CHOICE(start.friction, "on", "Whether friction acts while the block relaxes under its load.",
           "off", "on"),
    CHOICE(start.rod, "away",
           "`away`: the rod touches the relaxed face at t = 0. `held`: it stands there while the "
           "block relaxes.",
           "away", "held"),
    CHOICE(
        start.state, "relaxed",
        "The block at t = 0: `relaxed` under its load, or `undeformed`, the load put on at once.",
        "relaxed", "undeformed"),
    NUMBER(start.velocity_x, "velocity", RANGE_ANY, "0",
           "Velocity of the whole block at t = 0, along x."),
    NUMBER(start.velocity_z, "velocity", RANGE_ANY, "0",
           "The same along z; towards the substrate where negative."),
    NUMBER(start.tolerance, "1", RANGE_PART, "1e-6",
           "The block is relaxed when every speed is below this times the rod's."),
    NUMBER(start.duration_max, "1", RANGE_POSITIVE, "1e4",
           "Longest relaxation allowed, in viscous times eta1/E."),
    KEY("time.until.U", KEY_NUMBER, time.until_U, "length", RANGE_NOT_NEGATIVE, "0",
        "Stop when the rod has moved this far; 0: not by U."),
    KEY("time.until.t", KEY_NUMBER, time.until_t, "time", RANGE_NOT_NEGATIVE, "0",
        "Stop at this time after the rod's start; 0: not by time."),
    KEY("time.until.periodic", KEY_FLAG, time.until_periodic, "1", RANGE_ANY, "false",
        "Stop earlier when the periodic regime is established, or when load drops that do not "
        "repeat are enough (results.drops.enough)."),
    KEY("time.until.slidings", KEY_NUMBER, time.until_slidings, "1", RANGE_NOT_NEGATIVE, NULL,
        "Stop earlier when the whole block has slid so many times, each to its end; 1: the first "
        "sliding."),
    KEY("time.until.mu_below", KEY_NUMBER, time.until_mu_below, "1", RANGE_NOT_NEGATIVE, NULL,
        "Stop earlier when F_T / F_N falls below this, having been above."),
    CHOICE(time.scheme, "sdirk2",
           "`sdirk2`: implicit, of order 2, steps as long as the answer allows. `explicit`: "
           "central differences at the stable step, an independent check that takes far longer.",
           "sdirk2", "explicit"),
    CHOICE(
        time.accuracy, "standard",
        "Error allowed to steps (2e-2, 5e-3, 5e-4) and to the reduction where their own keys do "
        "not say; `fine` is for references. The error of the mesh is another matter: accuracy.mu.",
        "draft", "standard", "fine"),
    NUMBER(time.tolerance, "1", RANGE_PART_OR_ZERO, "0",
           "Local error allowed to the displacements in one step, over the slip that the drop of "
           "friction drives, (mu_S - mu_K) P H / E; 0: by time.accuracy."),
    NUMBER(time.step_max, "time", RANGE_NOT_NEGATIVE, "0",
           "Longest step; 0: the rod moves 0.2 of the slip that the drop of friction drives (see "
           "time.tolerance), or of friction.slip_distance if that is more, in it, up to twice "
           "that; without a rod a 50th of the run."),
    NUMBER(time.step_min, "time", RANGE_NOT_NEGATIVE, "0",
           "Shortest step; 0: 1e-10 of the smaller of longest step and wave step."),
    NUMBER(time.wave_step, "1", RANGE_PART, "0.2",
           "Longest step while slip is not certified to be stable, in wave crossings of the block, "
           "L / c_L (L / 2 c_S where that is longer)."),
    NUMBER(time.watch, "1", RANGE_NOT_NEGATIVE, "20",
           "How long oscillations of slow slip beyond l_sc are followed at each position of the "
           "front, in wave crossings of the block; after that those that stay small are stepped "
           "over, so that a slow rod costs no more than a fast one. 0: all of them are followed."),
    WORDS(KEY_FLAG, time.certificate, "true",
          "Resolve waves wherever slip is not certified to be stable; off gives wrong answers and "
          "is for studying just that."),
    NUMBER(time.energy_tolerance, "1", RANGE_PART, "1e-3",
           "The run fails when the energy ledger is off by more, relative to the work done."),
    NUMBER(time.periodic_tolerance, "1", RANGE_PART, "1e-2",
           "Load drops that agree within this, relative, make a periodic regime."),
    NUMBER(accuracy.mu, "1", RANGE_PART_OR_ZERO, "0",
           "Error bar wanted of mu_M (of mu_hold where the block does not slide as a whole), "
           "relative, such as 1%: the mesh is refined and runs are repeated until it is met. 0: "
           "one run on the mesh as it is, whose error is not known."),
    CHOICE(accuracy.of, "mu_M",
           "`mu_hold`: the bar is asked of mu_hold in any case. On pads, where some slide before "
           "the others, it takes finer meshes than that of mu_M.",
           "mu_M", "mu_hold"),
    NUMBER(accuracy.within, "1", RANGE_NOT_NEGATIVE, "0",
           "Seconds of this computer's time that may go into it; a mesh that takes no more than a "
           "sixtieth of it confirms the bar. 0: as many as it takes, without such a mesh."),
    NUMBER(accuracy.window, "1", RANGE_PART, "0.01",
           "Width of the window of pressures, relative, over which branches that coexist are "
           "averaged."),
    CHOICE(reduction.use, "auto",
           "Reduce the bulk to its interface and a small interior basis before stepping; `auto`: "
           "wherever the scene allows it; `always`: likewise, or it is an error; `never`: step on "
           "the whole mesh.",
           "auto", "always", "never"),
    NUMBER(reduction.tolerance, "1", RANGE_PART_OR_ZERO, "0",
           "Error allowed to the answers of the reduced interior, relative, in the energy norm; 0: "
           "by time.accuracy."),
    WORDS(KEY_FLAG, reduction.cache, "true",
          "Keep the basis on disk for the next run of the same shape, of whatever length."),
    WORDS(KEY_FLAG, output.history, "true",
          "Write history.h5: time series and the interface at every step."),
    WORDS(KEY_FIELDS, output.fields, "none",
          "Fields of the block for ParaView (fields.pvd): `none`, or when to write them."),
    KEY("output.fields.every_U", KEY_NUMBER, output.fields_every_U, "length", RANGE_NOT_NEGATIVE,
        "0", "A file each time the rod has moved this far; 0: none."),
    KEY("output.fields.every_t", KEY_NUMBER, output.fields_every_t, "time", RANGE_NOT_NEGATIVE, "0",
        "A file each time this much time has passed; 0: not by time."),
    KEY("output.fields.every_step", KEY_FLAG, output.fields_every_step, "1", RANGE_ANY, NULL,
        "true: a file at each step that the solver takes; best in an output.window."),
    KEY("output.fields.at_events", KEY_FLAG, output.fields_at_events, "1", RANGE_ANY, "false",
        "A file at the start and stop of each precursor and sliding."),
    KEY("output.fields.film", KEY_FLAG, output.fields_film, "1", RANGE_ANY, "false",
        "What a film needs: see above. `fields: film` says the same."),
    NUMBER(output.window.from_U, "length", RANGE_NOT_NEGATIVE, NULL,
           "Fields are written in a part of the run only: from this U on."),
    NUMBER(output.window.to_U, "length", RANGE_POSITIVE, NULL, "Up to this displacement."),
    NUMBER(output.window.from_t, "time", RANGE_NOT_NEGATIVE, NULL, "From this time on."),
    NUMBER(output.window.to_t, "time", RANGE_POSITIVE, NULL, "Up to this time."),
    WORDS(KEY_FLAG, output.window.history, NULL,
          "true: history.h5 has the steps of the window only; else all."),
    KEY("output.probes", KEY_ITEMS, output.probes.count, "length", RANGE_ANY, NULL,
        "Points inside the block (or its base) at which displacement, velocity, strain and stress "
        "are read at every step, as by a strain gauge: a map of names, each with `at`: [x, z], in "
        "space [x, y, z].",
        .items = &scene_probe_items),
    WORDS(KEY_NAMES, output.figures, "[]", "The pictures to draw at the end.",
          .choices = figure_choices),
    WORDS(KEY_TEXT, output.compare, NULL,
          "Measurements (.csv) to be drawn beside it, with the misfit."),
    WORDS(KEY_TEXT, output.cycle, NULL,
          "Which cycle pictures show: `first` (the first loading), `last` or `all`."),
};

#undef KEY
#undef NUMBER
#undef WORDS
#undef CHOICE

enum { KEY_COUNT = sizeof keys / sizeof keys[0] };
_Static_assert((int)KEY_COUNT <= (int)SCENE_KEYS_MAX, "Scene.given is too short");

const SceneKey *scene_keys(int32_t *count)
{
    *count = KEY_COUNT;
    return keys;
}

static const char WINDOW_INSTEAD[] =
    "runs repeat to the bit: run, read U of the sliding in run.json (U_start and U_stop in "
    "results.events), and run again with from_U and to_U";

// Keys of earlier versions that are gone, and what takes their place.
static const struct {
    const char *name, *instead;
} retired_keys[] = {
    {"contact.radius",
     "a round contact is a formula, `contact.gap: \"(x - X)^2 / (2 * R)\"`, where X is the x of "
     "the block's middle and R the radius; a radius of 0 is left out"},
    {"material.young_short",
     "give `young` of the long-time response: `young: = E0 - 2*(1 + nu)*(g1 + g2)`, with E0 of the "
     "short-time response and the branches' shear g1, g2, says the same where nu is the same"},
    {"output.window.around", WINDOW_INSTEAD},
    {"output.window.last", WINDOW_INSTEAD},
};

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
        bool open = keys[k].type == KEY_PARAMETERS || keys[k].type == KEY_BRANCHES ||
                    (keys[k].items && keys[k].items->named);
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
            if ((k >= GROUP_COUNT && scene_key_may_lack(&keys[k - GROUP_COUNT])) == rare &&
                strcmp(words[k], last_word(name)) == 0)
                return names[k];
    int32_t nearest = text_nearest(name, names, COUNT);
    if (nearest < 0) nearest = text_nearest(last_word(name), words, COUNT);
    return nearest < 0 ? NULL : names[nearest];
}

const char *scene_key_instead(const char *name)
{
    for (size_t k = 0; k < sizeof retired_keys / sizeof retired_keys[0]; k++)
        if (strcmp(retired_keys[k].name, name) == 0) return retired_keys[k].instead;
    return NULL;
}

bool scene_key_refuse(const YamlDocument *document, YamlNode node, const char *name, Error *err)
{
    const char *instead = scene_key_instead(name);
    if (instead)
        return yaml_key_error(document, node, err, "%s: this key of an earlier version is gone: %s",
                              name, instead);
    const char *nearest = scene_key_nearest(name);
    return yaml_key_error(
        document, node, err, "%s: unknown key%s%s%s (`amontons info keys` lists them all)", name,
        nearest ? "; did you mean `" : "", nearest ? nearest : "", nearest ? "`?" : "");
}
