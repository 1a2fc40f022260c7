# SPDX-License-Identifier: GPL-2.0-or-later
"""Every number of solver, stepper, elements, reduction and recorders: those that were chosen, which constants.py
takes to half and to twice their value, and those that follow from something else, with the reason.
tests/reports/test_constants.py keeps both lists complete. A plain limit stands in neither: its
name ends in _LIMIT. It ends what would not end by itself, or keeps out what is rounding, so far
beyond what was seen that half and twice its value changed no step and no answer of the scenes."""
import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("contact", "reduction", "stepping", "fem", "record", "answers", "model", "study/stability")   # of src
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
KEYS = "scene/keys.c"      # a key's default: varied as a user would, with --set


@dataclass(frozen=True)
class Constant:
    name: str        # as it stands in the source; of a key: the key
    file: str        # below src
    decides: str     # what it decides
    chosen: str      # where the value comes from

    @property
    def label(self):
        return f"{Path(self.file).stem}.{self.name}"

    @property
    def is_key(self):
        return self.file == KEYS

    @property
    def changes_basis(self):
        return self.file.startswith(("fem/", "reduction/", "model/"))

    def reaches(self, command):
        """Whether a scene of this kind can notice it: "run", "explicit", "stability", "problems"."""
        if self.file.endswith(("growth.c", "stability.c")):
            return command == "stability"
        if self.file.endswith(("explicit_reference.c", "stable_step.c")):
            return command == "explicit"
        if command == "problems":
            return self.file.startswith("contact/")
        return command == "run" or not self.is_key and command == "stability" or \
            self.file.startswith("record/")


def of(file, *rows):
    return [Constant(name, file, decides, chosen) for name, decides, chosen in rows]


HERE = "this table"   # where a value comes from
FAR_FIELD = "validation/benchmark/far_field.py"
NO_BRANCHES = "not measured yet: no scene of this table has branches"
NO_FIT = "not measured yet: no scene of this table fits moduli to data"
CONSTANTS = [
    *of("contact/contact_solver.c",
        ("TOLERANCE", "residual of a solved problem, of its largest force",
         "1e2 above the rounding of S v - g"),
        ("CHORD_GAIN", "a kept factor is given up when a step leaves more of the residual", HERE)),
    *of("friction/laws/weakening.c",
        ("SPENT", "rate at which a node that starts fast is tried, of v_c, exponential law", HERE)),
    *of("contact/rod.c",
        ("END_SOFTNESS", "softness of the strip's end nodes", "validation/benchmark/precision.py")),
    *of("stepping/step_control.c",
        ("SAFETY", "part of the tolerance that the error of a longer step must keep", HERE),
        ("LEDGER_SHARE", "part of the ledger's tolerance that long steps may use up", HERE),
        ("UNCERTIFIED_DROP", "levels down from a step into a state that is not certified", HERE),
        ("SMALL_OSCILLATION", "part of v_c that an oscillation may reach unseen", HERE)),
    *of("stepping/oscillation_record.c",
        ("SMALL_RATE", "slip rate up to which an oscillation is small, of v_c", HERE),
        ("SAME_WEAKENING", "how far weakening may exceed what was seen", HERE)),
    *of("stepping/certificate.c",
        ("RISEN", "rates at which a node's resistance is computed: down to where every node resists so many times "
                  "its least", NO_BRANCHES)),
    *of("stepping/sdirk.c",
        ("AUDIT_EVERY", "steps to one whose full equation is computed anew", HERE)),
    *of("stepping/stable_step.c",
        ("SAFETY", "explicit step over the stable one", "distance from the limit")),
    *of("reduction/training_points.c",
        ("LEVEL_LOWEST", "lowest level, of the slowest mode of the interior", HERE),
        ("VISCOSITY_RATIO", "between two viscosities that the basis is built at", HERE),
        ("MESH_SHARE", "error allowed where inertia acts within an element", HERE),
        ("SLOWEST_ITERATIONS", "inverse iterations for the slowest mode", HERE),
        ("PATH_STEPS", "steps in which the change of moduli over the viscosities is summed up, with branches",
         NO_BRANCHES),
        ("PATH_BEYOND", "how far these viscosities reach beyond the rates of the materials, either way",
         NO_BRANCHES)),
    *of("reduction/far_patches.h",
        ("FAR_INTERFACE", "unknowns of an interface from which on what is far is replaced", FAR_FIELD)),
    *of("reduction/far_patches.c",
        ("FAR_NEAR", "elements between interface and first layer times the interface's unknowns", FAR_FIELD),
        ("FAR_DISTANCE_LEAST", "of these elements", FAR_FIELD),
        ("FAR_DISTANCE_MOST", "of these elements", FAR_FIELD),
        ("FAR_WIDTH", "unknowns of the interface below a patch of the first layer", FAR_FIELD),
        ("FAR_SHARE", "of the unknowns that are far, from which on they are replaced", FAR_FIELD)),
    *of("reduction/far_field.c",
        ("ERROR_MAX", "error of the far field over the allowed, from which on it is not", FAR_FIELD)),
    *of("reduction/far_samples.c",
        ("CHUNK", "motions that are asked at once", FAR_FIELD),
        ("NEW_SHARE", "of these that are new, from which on more are asked", FAR_FIELD),
        ("LEAST", "energy that a motion may lack, of tolerance^2", FAR_FIELD),
        ("LEAST_AT_REST", "energy that a motion may lack at rest", FAR_FIELD),
        ("INERTIA_STEP", "between two inertias that motions are asked at", FAR_FIELD),
        ("FALLEN", "powers of e that an answer has fallen by, up to which they are", FAR_FIELD),
        ("LIFT", "of S at rest, where rigid motions cost nothing", FAR_FIELD)),
    *of("reduction/patch_modes.c",
        ("DIGITS", "energies of motions that are told apart at once", "rounding"),
        ("LITTLE", "left of a motion, from which on others are taken out again", "rounding")),
    *of("record/drops.c",
        ("LEAST_DROP", "drop of mu that counts, of mu", "validation/pads, drops seen")),
    *of("answers/statistics.c",
        ("START_PART", "part of the run left to the start without a period", HERE),
        ("LOWEST", "quantile that stands for the least mu without a period", HERE)),
    *of("model/step_rule.c",
        ("STEP_MAX_SLIP", "longest step: what the rod moves in it, of friction's slip", HERE)),
    *of("model/assemble.c",
        ("FOLDED", "relaxation time over that of waves in an element, below which a branch is a viscosity; its "
                   "modulus is off by this part", NO_BRANCHES)),
    *of("fem/relaxation_fit.c",
        ("BEYOND", "how far relaxation times of a fit reach beyond those of the data, either way", NO_FIT),
        ("MISFIT_ALLOWED", "misfit above the least that a fit of fewer branches may have", NO_FIT)),
    *of("run/start.c",
        ("[ACCURACY_STANDARD]", "local error of a step, of friction's slip",
         "validation/benchmark/precision.py, promise.py")),
    *of("model/obtain.c",
        ("[ACCURACY_STANDARD]", "error of the reduction",
         "validation/benchmark/precision.py")),
    *of("study/stability/stability.c",
        ("PATH_SLIP", "what the rod moves in it, of friction's slip", HERE),
        ("PATH_ELEMENTS", "front advance in it, in elements", HERE)),
    *of(KEYS,
        ("time.wave_step", "step while waves are resolved, of a crossing of the block",
         "validation/benchmark/precision.py"),
        ("time.watch", "time that an oscillation is followed, in crossings", HERE),
        ("time.energy_tolerance", "imbalance of the energy ledger", HERE),
        ("time.periodic_tolerance", "peaks that agree", HERE)),
]

SIZE = "room of an array; more than is used"
ROUNDING = "rounding of coordinates"
MIDDLE = "It is the middle of a face in its reference coordinates."
NOT_A_CHOICE = {
    "contact/contact_check.c": {"STILL": "rounding; the judge only reports"},
    "friction/friction.c": {
        "EXPONENT_MAX": "exp of it is finite", "STEPS": "Newton's: all digits",
        "HALVINGS": "of a step: all digits", "NEAR": "Newton's next step is its square, which is rounding",
        "ROUNDING": ROUNDING, "MANY": "a first guess beyond the weakening, as SPENT"},
    "friction/laws/law.h": {"STATES_MAX": SIZE, "FRICTION_POINTS_MAX": SIZE, "STATE_NAME_SIZE": SIZE,
                            "STATE_TEXT_SIZE": SIZE},
    "friction/laws/plugin.c": {"SPEED_ALONE": "of functions", "SYMBOLS": "of functions"},
    "friction/laws/rate_state.c": {"EXPONENT_MAX": "exp of it is finite", "LEAST_SPEED": "ln of it is finite"},
    "friction/laws/table.c": {"BETWEEN": "looks between two points"},
    "friction/friction_response.c": {"DECADES": "looks", "DECADE": "looks", "HALVINGS": "all digits"},
    "friction/friction_start.c": {
        "SLIGHT": "rounding of a formula that touches 0", "LEFT": "1/e",
        "DECADES": "looks", "DECADE": "looks", "STAYS": "a state that is steady: rounding of stages of 1e29",
        "FIRST": "of a rest: nothing", "GROWTH": "the midpoint rule errs by 1e-5 of an exponential"},
    "friction/friction_start.h": {"NO_FRICTION": "rounding of a law that is 0 at rest"},
    "friction/friction_make.c": {
        "DECADE": "looks", "DECADES": "looks", "LAST": "looks",
        "SAME": "rounding of a formula", "JUMP": "halved as long as it is larger",
        "STEP": "of differences: half the digits", "SLOPE_ERROR": "that differences leave",
        "CHANGED": "1 - 1/e: v_c of the exponential law", "SPENT_PART": "as of the exponential law"},
    "contact/interface.c": {"ROUNDING": "rounding of an integral that is 0", "LINE_ROUNDING": ROUNDING,
                            "STRIP_TOLERANCE": ROUNDING},
    "contact/rod.c": {"PI": "pi", "WHOLE": ROUNDING},
    "record/contact_arrays.c": {"SLIGHT": "as in friction/friction_start.c"},
    "stepping/friction_states.c": {"PRESSED": "of mu: the contact problem's own rounding"},
    "stepping/certificate.c": {"BETWEEN_LEVELS": "(sqrt 2 + 1/sqrt 2)/2: dt doubles from level to level",
                               "BETWEEN_MEMORIES": "proven: 1.1242, dt doubles from level to level",
                               "SETTLED": "digits that tell a ratio from 1, with room",
                               "SINGLE_ROWS": "time alone", "OPEN_PARTS": "memory and time alone: pads have most of their nodes open, blocks a few",
                               "SINGLE_MARGIN": "4000 matrices of two blocks are as definite in single precision as in double even with 0; that one is not is never taken from it alone"},
    "contact/contact_solver.c": {
        "STEPS": "with 40 a fifth fewer of 30 000 hard problems is left to sweeps, at one and a half times the steps",
        "HALVINGS": "to and fro over a kink: 1/16 of a step is left; with 8 as many problems are solved",
        "STALE": "to and fro over kinks of mu: eight pads of set B take 0.89 "
                 "times the Newton steps; with 4 six pads take 9879 steps of time for 9004, as more shorter ones are tried",
        "SAME": "tells a cycle from steps that still gain"},
    "contact/contact_half.c": {"APART": ROUNDING, "ALIKE": "rounding of S; what is left out is a billionth",
                               "HELD": "far above any weakening that S withstands"},
    "contact/contact_sweeps.c": {"PARTS": "of an interval in which a node may have several roots",
                                 "HALVINGS": "all digits",
                                 "SWEEPS": "15 or 10 make no difference to 435 collected problems in space",
                                 "MORE_SWEEPS": "with 1, 420 of 435 collected problems in space are solved, with 4 all"},
    "contact/contact_sweeps.h": {"SWEEP_ROUNDS": "with 3, 433 of 435 collected problems in space are solved, with 4 all"},
    "contact/slip.h": {"TANGENTS_MAX": SIZE},
    "stepping/explicit_reference.c": {
        "EXCESS_PARTS": "of an interval in which one's own law may have several roots"},
    "stepping/growth.h": {"GROWTH_KEPT": "rates shown", "GROWTH_SHIFTS_MAX": SIZE},
    "stepping/step_control.h": {"STEPS_LOOKED": "steps between looks whether a run gets on"},
    "stepping/half_step.c": {"ALIKE": "rounding of a state that was stepped as a whole",
                             "PARALLEL_UNKNOWNS": "time alone"},
    "stepping/step_control.c": {"STEPS_LEFT_MAX": "steps to go at which a run is given up",
                                "SCANNED_PARTS": "of a contact in space: what its critical area is known to"},
    "stepping/dt_levels.h": {"DT_LEVELS_MAX": SIZE},
    "stepping/tableau.h": {"SDIRK_STAGES": "of SDIRK2", "LOCAL_ORDER": "of SDIRK2: its order and one"},
    "reduction/far_patches.h": {"NO_PATCH": "near"},
    "reduction/far_patches.c": {"LAYERS_MAX": SIZE, "LEFT": "counted"},
    "reduction/far_samples.c": {"LEVELS_MAX": SIZE, "POINTS_MAX": SIZE, "ROOM": SIZE},
    "reduction/basis.c": {"WIDE": SIZE, "STRETCH": SIZE,
                          "INVERSE_STEPS": "to an eigenvalue that is compared with powers of 10"},
    "fem/element.h": {"ELEMENT_DOFS_MAX": "of each node as many as the dimension"},
    "fem/mesh_build.c": {"AREA_TOLERANCE": ROUNDING,
                         "PROBES_MAX": "It counts nodes and quadrature points of the largest element."},
    "fem/element_group.h": {"GROUP_ELEMENTS_MAX": "a pair of T3 and one at each of its edges"},
    "fem/material.c": {"AREA_RESISTS": "docs/meshes.md, where elements lock"},
    "fem/material.h": {"BRANCHES_MAX": "It is room of an array: as many as a scene may give a material.",
                       "MATERIALS_MAX": SIZE, "SHEAR_AXES": "all pairs", "STRAINS_MAX": "of the largest dimension"},
    "fem/mesh.h": {"MESH_PATH_SIZE": SIZE, "MOVE_TEXT_SIZE": SIZE, "PLACE_TEXT_SIZE": SIZE},
    "fem/mesh_contact.c": {"PLACE_TOLERANCE": ROUNDING, "UPRIGHT": "a face that is a side of the block"},
    "fem/mesh_faces.h": {"FACE_INNER_MAX": "of the largest face"},
    "reduction/reduced_bulk.c": {"BETWEEN": "of what is said of the error, not of the basis"},
    "reduction/reduced_bulk.h": {"REDUCTION_LEVELS_MAX": SIZE, "REDUCED_PARTS_MAX": "two for each axis of the floor"},
    "reduction/training_points.h": {"TRAINING_VISCOSITIES_MAX": SIZE, "TRAINING_POINTS_MAX": SIZE},
    "reduction/transform.h": {"NO_BLOCK": "none"},
    "reduction/mirror.c": {"AXES_MAX": "of the floor", "ALIKE": "rounding", "NONE": "none",
                      "MIRRORED_MAX": "far above a rod's nodes, far below a contact on one side",
                      "APART": "rounding of two nodes to the grid", "SLANT": "any that is no ratio of small numbers"},
    "reduction/symmetric_part.c": {"ACROSS": "It is the axis across the mirror, y."},
    "reduction/reduction_block.c": {
        "BASE_APART": "It keeps nodes of the block and of the base apart that stand at one place; as a number of the grid "
                      "it adds no rounding."},
    "reduction/reduced_operator.c": {
        "ENTRIES_LARGE": "threads for a level: time alone; an estimate, as starting them twice took 0.4 ms on a busy machine",
        "COLUMNS_TOGETHER": "columns that stay in the cache"},
    "reduction/reduced_operator.h": {"BULK_TERMS": "K, C, M",
                                    "BULK_TERMS_MAX": "It counts K, C, M and all shape matrices that there is room for."},
    "reduction/responses.h": {"RESPONSE_BLOCKS_MAX": SIZE,
                       "RESPONSES_TOGETHER": "columns whose image stays in the cache"},
    "fem/floor.c": {
        "SHARE_ROUNDING": "It is the rounding of shares, which sum up to 1.",
        "COVER_ROUNDING": "It is the rounding of coordinates, over the size of a face.",
        "GAP_ROUNDING": "It is the rounding of coordinates, over the block's length.",
        "UPRIGHT": "It is the rounding of the shadow of an upright face, which is 0.",
        "SHADOW_DIM": "A shadow has one axis less than space.",
        "POLYGON_MAX": "Two convex faces have no more corners in common than both have together.",
        "GAUSS_POINTS": "The rule is exact for a product of two shape functions, both of degree 4 at most, on a piece of a "
                        "parallelogram.",
        "GAUSS_PLACE": "These are the places of Gauss's rule.", "GAUSS_WEIGHT": "These are the weights of Gauss's rule."},
    "fem/mesh_locate.c": {
        "OUTSIDE": "It is more than the rounding of coordinates; a slit that is so wide open is no fault.",
        "triangle": MIDDLE, "square": MIDDLE,
        "REFERENCE_TOLERANCE": "It is the rounding of reference coordinates, which are of order 1.",
        "BENT_BOX": "A side of three nodes leaves their box by 1/8 of it at most; a larger box costs time alone.",
        "BOX_ROUNDING": "It is the rounding of coordinates, over the size of an element."},
    "fem/mesh_parts.h": {"PART_TEXT_SIZE": SIZE},
    "fem/mesh_place.c": {"GRID": "Its steps are far smaller than an element and far larger than rounding."},
    "fem/relaxation_fit.c": {
        "ROUNDING": "It is the rounding of a gradient that is 0.",
        "DEPENDENT": "It is the rounding of a column that depends on others, with room.",
        "offered": "These are all numbers of times that a fit may keep, and larger ones, of which it keeps few.",
        "TIMES_MAX": "It is the last number that is offered.", "COLUMNS_MAX": "A fit has two columns besides its times.",
        "TRIALS": "It counts the numbers that are offered."},
    "fem/relaxation_fit.h": {
        "RELAXATION_TERMS_MAX": "It is room of an array: as many as a scene may give a material.",
        "RELAXATION_POINTS_MAX": "It is the most that a table of data may have; a longer one is refused."},
    "fem/spectrum.c": {"ALIKE": "It is the rounding of a quotient of moduli.",
                       "NOTHING": "It is the rounding of a modulus that is 0."},
    "fem/spectrum.h": {
        "SPECTRUM_SHAPES_MAX": "It is room for 8 regions with branches; a scene with more is refused.",
        "SPECTRUM_TIMES_MAX": "It is room of an array; a scene with more relaxation times is refused."},
    "fem/assembly.c": {"ROUNDING": "rounding of an integral that is 0"},
    "reduction/responses.c": {"FAR": "condition of two equations"},
    "reduction/reduction.c": {"TOGETHER": "parts in memory at once"},
    "reduction/factored_points.c": {"SLOTS_MAX": "factors in memory at once"},
    "record/observation.c": {"CREEP": "of V: what counts as at rest where nothing ever sticks; no scene of the table has such a law"},
    "record/events.c": {
        "RATE_COUNTS": "from which rate a bounded event counts: a quarter above the 2 V that an oscillation about V comes to; Figure 1 has 16 "
                       "rapid events that stop, 5 of them of 2.02 to 2.09 V",
        "LEAST_RAPID": "over which part of the contact slip is rapid at least; the bounded events of Figure 1 are rapid over half of "
                       "it; the jumps of single nodes are left out",
        "AFTER_SLIP": "of what counts: ringing is a hundred times slower, precursors in a row are alike", "RATE_START": "what is called rapid: twice the rod's velocity; 1 and 4 change no event",
        "RATE_STOP": "the end of it; 0.5 and 2 change no event", "FIRST_ROOM": SIZE, "AT_NODE": "rounding of coordinates"},
    "record/events.h": {"FRONT_STATIONS": "shown"},
    "record/drops.c": {"FIRST_ROOM": SIZE, "SEGMENTS": "of run-in: above"},
    "record/drops.h": {"SLIP_CELLS_ENOUGH": "of slip: 48 cases, in run/warnings; scatter by cells in priors.md"},
    "record/fields.c": {"PATH_SIZE": SIZE, "FIRST_ROOM": SIZE,
                        "LIST_EVERY": "times in a list that is late"},
    "record/fields.h": {"FIELD_SLOTS": SIZE},
    "record/field_files.h": {"FIELD_LINE_ARRAYS": "of the interface's file"},
    "record/field_files.c": {"VTK_LINE_CELL": "VTK's", "VTK_TRIANGLE_CELL": "VTK's", "VTK_QUAD_CELL": "VTK's",
                             "FACE_CELLS_MAX": "of a face", "whole": "of a face", "six": "of a face", "nine": "of a face",
                             "types": "VTK's"},
    "record/rotation.c": {"ROUNDING": ROUNDING},
    "answers/regime.c": {"LAG": "of run-in: above", "TREND_DROPS": "of run-in: above"},
    "answers/regime.h": {"DROPS_ENOUGH": "of run-in: above"},
    "answers/answers.c": {"ELSEWHERE": "where most of what slips is elsewhere", "MEAN_ERROR": "what `time.until.periodic` promises without a period; half and twice changed nothing"},
    "answers/statistics.c": {"ROUNDS": "what a period is (head of the file); half and twice changed no period",
                        "REPEATING_PART": "the same", "NEARER": "of run-in: above", "TREND_VALUES": SIZE, "by_freedoms": "Student's, 95 %",
                        "CORRELATED": "items that tell nothing of a correlation", "CORRELATION_MAX": "the root of what follows is finite"},
    "answers/answers.h": {"ERROR_BAR": "95 % of normal deviates"},
    "answers/error_bars.c": {
        "USUAL": "of error bars: [priors.md](../validation/benchmark/priors.md)", "USUAL_LEAST": "the same", "USUAL_LEVELS": "the same", "ONE_MESH": "the same", "ONE_MESH_IN_SPACE": "of digits without a bar: validation/space/priors.md", "SPAN": "the same",
        "CONFIRM": "of error bars on several pads: two feet of unequal height, strangers 467; on other contacts strangers 55, 138, 328, 730",
        "ROUNDING": "of products of a few steps from mesh to mesh", "END_WAITS": "of error bars: set B at P = 1e-5",
        "ONE_PRECURSOR": "of digits of the first loading: [accuracy](accuracy.md#without-a-bar)",
        "STEPS": "of error bars: what this table's tolerances move",
        "BRANCH_WIDTH": "of branches: the next is twice as far", "CHANCE": "95 %"},
    "answers/error_bars.h": {"PATTERNS_MAX": SIZE, "LEVELS_MAX": SIZE, "LEVEL_RUNS_MAX": SIZE},
    "record/program_readings.c": {"STEADY_RANGE": "as in record/steady", "REACHED": "rounding of points in time",
                                  "LEAST": "bins that make a level", "ARRIVED": "what counts as the rod's new velocity, in the definition of the direct effect"},
    "record/program_readings.h": {"PROGRAM_BINS": SIZE, "PROGRAM_READINGS_MAX": SIZE},
    "record/steady.c": {"STEADY_RANGE": "twice what the steps of a standard run move mu by"},
    "record/history.c": {
        "FLUSH_EVERY": "seconds of a run that a kill may cost",
        "FLUSH_SHARE": "It is the part of the time that a slow disk may take; it changes time, and what a kill may cost, alone."},
    "record/pads.h": {"PADS_ORDER_SIZE": "It is room of a text; names for which there is none are counted."},
    "record/probes.c": {"READINGS_MAX": "It counts displacements and strains of the largest dimension."},
    "record/observation.h": {"RECORDERS_MAX": SIZE},
    "model/assemble.c": {
        "MOTIONS_MAX": "It counts the rigid motions in space.",
        "FREE": "It is the rounding of a singular value that is 0, with room."},
    "model/model.h": {"NOT_REDUCED_SIZE": "It is room of a text; a longer message is cut."},
    "model/scene_mesh.c": {"NODE_BYTES": "memory"},
    "stepping/growth.c": {
        "NO_RATE": "rounding, with room: 0 that is not 0",
        "STRIDE": "at 1 a stiff block gets a rate that it has not (tests/unit/stepping/test_growth.c); 2 and 6 change nothing",
        "SAME_RATE": "rounding, with room: what two shifts saw agrees to 1e-7, others differ by 1e-4"},
    "reduction/machine.c": {"LOOSE": "rounding, with room: a matrix that must not be singular"},
    "algebra/sparse_order.c": {"LEAF": "points: 4, 16, 32, 100 leave 0.98, 1, 1.02, 1.12 times the entries on 16 x 32 x 16 cells"},
    "algebra/sparse_factor.c": {"COLUMNS": "solved for at once: time alone"},
    "contact/contact_newton.c": {"COLUMNS": "filled at once: time alone", "FOLLOW_SINGLE": "time alone",
                                 "FOLLOW_STEPS": "five digits each", "FOLLOWED": "of what is itself a billionth"},
    "contact/contact_matrix.c": {"TOGETHER": "unknowns swept at once: time alone",
                                 "PAIR": "of a node"},
    "model/model.c": {
        "FLOOR_PART": "of the contact: as mean widths are exact for upright layers and pads, any above a half",
        "standard_middle": "the rod's default place", "standard_width": "the rod's default"},
    "model/obtain.c": {
        "REDUCTION_TOLERANCES": "draft and fine: as standard",
        "ONE_BY_ONE_FROM": "of the memory; below, two parts side by side are faster on two cores"},
    "model/memory.c": {
        "BYTES_FACTORS": "counted", "BYTES_PRODUCTS": "counted",
        "SPACE_LEAST": "bytes, by the memory of a run on 6 x 6 x 6 cells",
        "SPACE_MESH": "bytes, by heaptrack of a reduction of 24 x 24 x 24 cells",
        "SPACE_SQUARES": "numbers, by the memory of runs on cubes of 10, 14, 20 and 28 cells and on 40 x 40 x 20: 25 to 36, and 58 where contact "
                         "came to be solved as a whole",
        "SPACE_SQUARES_ONE_SIDE": "11 to 12 by 20 x 20 x 20, 28 x 28 x 14 and 40 x 80 x 40 cells",
        "SPACE_ENTRIES": "entries of factors of cubes of 20 and 40 cells over unknowns^(4/3): 22 and 25; whole meshes of 14^3 and 20^3 cells "
                         "told 0.67 and 2.3 GB, taken 0.63 and 2.5",
        "SPACE_PART_ENTRIES": "the same of the parts of 16 x 32 x 16, 24 x 48 x 24 and 40 x 80 x 40 cells: 22, 25, 28, of each of three",
        "SPACE_COLUMNS": "by the memory of reductions of 16^3, 16 x 32 x 16, 20 x 40 x 20, 24 x 48 x 24, 28 x 56 x 13 and of a part of "
                         "32 x 64 x 32 cells: 0.74 to 1.13 of what was taken is told",
        "SPACE_TOGETHER": "all but the last of them either way",
        "SPACE_FACTORS": "counted",
        "SPACE_MODES": "reduced unknowns of 24 x 24 x 24, 40 x 40 x 20 and 40 x 80 x 19 cells: 1.5 to 1.6",
        "PLANE_MODES": "Figure 1 on 40 x 40 to 320 x 320 cells: 3.1"},
    "model/contact_nodes.c": {
        "ROUNDING": "digits of a file, far below a cell",
        "SAMPLES": "a jump of `friction.along` to a part in 32 of a cell; exact where it is straight"},
    "study/stability/stability.c": {"MEMORY_PART": "of a rate; slower ones matter to no answer", "POINTS_BEYOND": "shown"},
    "study/stability/loss.c": {"NEXT_PART": "of the contact; from one point of a path in space to the next 1 to 3 % begin to slip"},
    "study/stability/why.c": {"TAKES_PART": "words", "EARLIER": "words"},
}


def places(constant, text):
    """Where the value of `constant` stands in the text of its file: spans; one is right."""
    if constant.is_key:
        entry = rf'NUMBER\({re.escape(constant.name)},\s*"[^"]*",\s*\w+,\s*"({NUMBER})"'
        return [found.span(1) for found in re.finditer(entry, text)]
    before = r"(?<![\w\])])" if constant.name[0] != "[" else ""
    pattern = rf"{before}{re.escape(constant.name)} =\s*({NUMBER})(?=\s*[,;}}\n])"
    return [found.span(1) for found in re.finditer(pattern, text)]


def defined(text):
    """Names of the constants that a file of C defines: static const numbers and arrays of them,
    const ones at the start of a line, which other files see, and enumerators with a value."""
    text = re.sub(r"//.*", "", text)
    names = []
    for found in re.finditer(r"(?:static |^)const (?:double|float|u?int\d*_t|int|size_t) ([^;(]*?);",
                             text, re.S | re.M):
        flat = re.sub(r"\{.*?\}(?=\s*(?:,|$))", "0", found[1], flags=re.S)
        names += re.findall(r"(\w+)(?:\[[^\]]*\])*\s*=", flat)
    for found in re.finditer(r"\benum \{(.*?)\}", text, re.S):
        names += re.findall(r"(\w+)\s*=", found[1])
    return names


def faults(root=ROOT):
    """What keeps the lists and the source from saying the same; empty: nothing."""
    found, listed = [], {}
    for constant in CONSTANTS:
        listed.setdefault(constant.file, set()).add(constant.name)
        path = root / "src" / constant.file
        count = len(places(constant, path.read_text())) if path.exists() else 0
        if count != 1:
            found.append(f"{constant.name} stands {count} times in src/{constant.file}, not once")
    for folder in FOLDERS:
        for path in sorted((root / "src" / folder).glob("*.[ch]")):
            file = str(path.relative_to(root / "src"))
            names, no_choice = set(defined(path.read_text())), set(NOT_A_CHOICE.get(file, ()))
            chosen = listed.get(file, set())
            limits = {name for name in names if name.endswith("_LIMIT")}
            found += [f"{name} of src/{file} is in no list" for name in names - limits - chosen - no_choice]
            found += [f"{name} of src/{file} is a limit, and in a list" for name in limits & (chosen | no_choice)]
            found += [f"{name} of src/{file} is in both lists" for name in chosen & no_choice]
            found += [f"{name} is no more in src/{file}" for name in no_choice - names]
    found += [f"there is no src/{file}" for file in NOT_A_CHOICE
              if not (root / "src" / file).exists()]
    return found
