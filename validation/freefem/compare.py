# SPDX-License-Identifier: GPL-2.0-or-later
"""FreeFEM on the same gmsh mesh, node by node: the same discrete problem, solved by another program.

T3 and TET4 are FreeFEM's P1, T6 and TET10 its P2 on the straight-sided mesh. Contact is on nodes in both, without a
penalty, so that nothing but rounding is left."""
import numpy as np

from harness import (FREEFEM, ELEMENTS, Run, Static, freefem, have_freefem, make_mesh, match, mesh_set,
                     observed_order, relative)

GROUP = "FreeFEM"
REGULAR = {"shape": "triangle", "nx": 20, "nz": 10}
GRADED = {"shape": "triangle", "nx": 24, "nz": 12, "grade_x": 6, "grade_z": 8, "layout": "alternate"}
FREE = {"shape": "triangle", "nx": 26, "nz": 8, "layout": "free"}
PADS = {"shape": "triangle", "n": 4}
LAYERS = {"shape": "triangle", "nx": 20, "nz": 8, "nz_layer": 3}
SQUARE = {"shape": "triangle", "length": 0.04, "height": 0.04, "nx": 32, "nz": 32}
SPACE = {"shape": "tet", "nx": 5, "ny": 4, "nz": 4}
FREE_SPACE = {"shape": "tet", "layout": "free", "nx": 6, "ny": 5, "nz": 5, "grade_z": 3}
PADS_SPACE = {"shape": "tet", "n": 2, "m": 2, "cells_x": 3, "cells_y": 3, "cells_pad_height": 1, "nz": 4}
MESHES = {"regular": REGULAR, "graded": GRADED, "unstructured": FREE}
BODIES = {"shape": "triangle", "nx": 12, "nz": 6, "base_height": 0.5}
OTHERS = {"on a base": BODIES, "four pads": PADS, "on a layer": LAYERS, "32x32": SQUARE}

# Nothing but rounding tells the two apart: 1e-9 of the largest displacement leaves room for four
# digits of conditioning, sums and stresses have one more. With contact the statuses must be equal too.
CASES = [("bonded", "block"), ("traction", "block"), ("uplift", "block"), ("friction", "block"),
         ("pads", "pads"), ("layers", "layers"), ("bodies", "base"), ("ssnv128", "block")]
TOLERANCE = 1e-9
LOWERED = 10   # by which block.idp writes a base lower than it is


def solve_both(study, case, geo, parameters, order):
    """(ours, FreeFEM's nodes in our order, FreeFEM's stresses at vertices, our rows of them)."""
    folder = study.new_folder(f"freefem-{case}")
    folder.mkdir()
    curves = make_mesh(folder / "linear.msh", geo, parameters)
    make_mesh(folder / "ours.msh", geo, parameters, order)
    theirs = freefem(FREEFEM / f"{case}.edp", order, folder / "linear.msh", curves,
                     folder / "freefem.txt")
    scene = FREEFEM / f"{case}.yaml" if case != "ssnv128" else FREEFEM.parent / "exact/ssnv128.yaml"
    ours = Static(study, scene, f"static-{case}",
                  {"mesh.file": folder / "ours.msh", "mesh.set": "{}"})
    assert len(theirs) == len(ours.position)
    stress = np.loadtxt(folder / "freefem.txt.stress")
    # Where materials meet stress jumps: FreeFEM's mean over both is no stress of either.
    joint = {"layers": 0.1, "base": 0}.get(geo, np.inf)
    inside = np.abs(stress[:, 1] - joint) > 1e-9
    position = ours.position.copy()
    if geo == "base":
        below = position[:, 1] < 1e-9
        below[ours.contact] = False
        position[below, 1] -= LOWERED
    return (ours, theirs[match(position, theirs[:, :2])], stress[inside, 2:],
            match(stress[inside, :2], ours.position))


def compare(study, case, geo, mesh_name, order):
    parameters = {**MESHES, **OTHERS}[mesh_name]
    ours, theirs, stress, vertices = solve_both(study, case, geo, parameters, order)
    element = "T3" if order == 1 else "T6"
    label = f"{case}, {mesh_name}, {element}"
    contact = theirs[ours.contact]
    largest = np.abs(theirs[:, 4:6]).max()
    study.add(GROUP, label, "displacement of every node, largest", np.abs(theirs[:, 2:4]).max(),
              np.abs(ours.displacement).max(), relative(ours.displacement, theirs[:, 2:4]), TOLERANCE)
    study.add(GROUP, label, "reaction of every node, largest", largest,
              np.abs(ours.reaction).max(), relative(ours.reaction, theirs[:, 4:6]), 10 * TOLERANCE)
    study.add(GROUP, label, "nodal stresses, largest", np.abs(stress).max(),
              np.abs(ours.stress[vertices]).max(), relative(ours.stress[vertices], stress),
              10 * TOLERANCE)
    x = ours.position[ours.contact, 0]
    sums = {"pressure resultant": (contact[:, 5].sum(), ours.results["normal_force"]),
            "moment of the pressure": ((x * contact[:, 5]).sum(), ours.results["pressure_moment"])}
    if geo == "block" and case in ("bonded", "traction", "friction"):
        rod = (theirs[:, 0] == 0) & (theirs[:, 1] > 0)
        sums["rod force"] = (theirs[rod, 4].sum(), ours.results["rod_force"])
    for name, (reference, value) in sums.items():
        study.add(GROUP, label, name, reference, value, relative(value, reference), 10 * TOLERANCE)
    if case in ("friction", "pads", "uplift", "layers", "bodies", "ssnv128"):
        states = "{open} open, {sticking} stick, {slipping} slip".format(**ours.results)
        theirs_open = int((np.abs(contact[:, 4:6]).max(axis=1) <= 1e-10 * largest).sum())
        study.add(GROUP, label, "open contact nodes", theirs_open, ours.results["open"],
                  abs(theirs_open - ours.results["open"]), 0, note=states)


def compare_in_space(study, case, mesh_name, parameters, order):
    """Displacements and reactions of every node; where contact can open, how much of it is open. Of TET10 the mid-sides
    are what touches."""
    folder = study.new_folder(f"freefem-{case}")
    folder.mkdir()
    geo = "pads3d" if case == "space_pads" else "block3d"
    surfaces = make_mesh(folder / "linear.msh", geo, parameters)
    make_mesh(folder / "ours.msh", geo, parameters, order)
    theirs = freefem(FREEFEM / f"{case}.edp", order, folder / "linear.msh", surfaces, folder / "freefem.txt")
    ours = Static(study, FREEFEM / f"{case}.yaml", f"static-{case}", {"mesh.file": folder / "ours.msh", "mesh.set": "{}"})
    assert len(theirs) == len(ours.position)
    theirs = theirs[match(ours.position, theirs[:, :3])]
    label = f"{case.replace('_', ' ')}, {mesh_name}, {'TET4' if order == 1 else 'TET10'}"
    for name, mine, yours, allowed in (("displacement", ours.displacement, theirs[:, 3:6], TOLERANCE),
                                       ("reaction", ours.reaction, theirs[:, 6:9], 10 * TOLERANCE)):
        study.add(GROUP, label, f"{name} of every node, largest", np.abs(yours).max(), np.abs(mine).max(),
                  relative(mine, yours), allowed)
    if case in ("space_uplift", "space_pads"):
        open_there = int((np.abs(theirs[ours.contact, 8]) <= 1e-10 * np.abs(theirs[:, 8]).max()).sum())
        study.add(GROUP, label, "open contact nodes", open_there, ours.results["open"],
                  abs(open_there - ours.results["open"]), 0, note=f"of {len(ours.contact)}")


def steps(study, order, case="step"):
    """Four viscoelastic steps with M, C and K: displacement and velocity; `layers_step` with two
    materials, `space_step` in space, `rubber_step` and `rubber_layer_step` with a branch that relaxes. Loads come at once and the steps are long on purpose: the ledger shows their
    truncation, 1.7 %."""
    geo, parameters, where = {"step": ("block", REGULAR, ""), "layers_step": ("layers", LAYERS, " on a layer"),
                              "space_step": ("block3d", SPACE, " in space"),
                              "rubber_step": ("block", REGULAR, " with a branch"),
                              "rubber_layer_step": ("layers", LAYERS, " on a layer with a branch")}[case]
    folder = study.new_folder(f"freefem-{case}")
    folder.mkdir()
    curves = make_mesh(folder / "linear.msh", geo, parameters)
    make_mesh(folder / "ours.msh", geo, parameters, order)
    theirs = freefem(FREEFEM / f"{case}.edp", order, folder / "linear.msh", curves,
                     folder / "nodes.txt")
    run = Run(study, FREEFEM / f"{case}.yaml", case,
              {"mesh.file": folder / "ours.msh", "mesh.set": "{}"},
              ledger=0.2 if geo == "layers" else 2e-2)
    time, points, u, v = list(run.frames())[-1]
    dim = points.shape[1]
    theirs = theirs[match(points, theirs[:, :dim])]
    element = ("T3", "T6") if dim == 2 else ("TET4", "TET10")
    label = f"4 viscoelastic steps{where}, {element[order - 1]}"
    for name, mine, yours in (("displacement", u, theirs[:, dim:2 * dim]), ("velocity", v, theirs[:, 2 * dim:])):
        study.add(GROUP, label, f"{name} of every node, largest", np.abs(yours).max(),
                  np.abs(mine).max(), relative(mine, yours), 1e-9)


def quadrilaterals(study):
    """FreeFEM has no quadrilaterals: both converge to one state. Compared is the mean u_x of the base,
    that is the work of the shear there, whose error is the square of the energy norm's. Shear that
    jumps at the base's corners makes u ~ r log r there, strains' slopes ~ 1/r: the error is as
    h^2 for elements of second order, as h^2 log(1/h) for Q4, between 40 and 80 cells an order of
    2 - 1/log(57) = 1.75. FreeFEM's P2 on 160 x 80 is itself off by its last change, 80 x 40 to 160 x 80, over 3."""
    values = []
    for n in (80, 160):
        folder = study.new_folder("freefem-sheared")
        folder.mkdir()
        curves = make_mesh(folder / "linear.msh", "block", {"shape": "triangle", "nx": n, "nz": n // 2})
        nodes = freefem(FREEFEM / "sheared.edp", 2, folder / "linear.msh", curves, folder / "n.txt")
        values.append(base_shift(nodes))
    limit = values[1] + (values[1] - values[0]) / 3
    for element, sizes, expected in (("Q4", [20, 40, 80], 1.75), ("Q8", [10, 20, 40], 2),
                                     ("Q9", [10, 20, 40], 2)):
        errors = []
        for n in sizes:
            ours = Static(study, FREEFEM / "sheared.yaml", f"sheared-{element}",
                          {"mesh.set": mesh_set(element, nx=n, nz=n // 2)})
            shift = (ours.weight * ours.displacement[ours.contact, 0]).sum() / ours.weight.sum()
            errors.append(abs(shift / limit - 1))
        study.add(GROUP, f"sheared, {element} against P2, {sizes[-1]} x {sizes[-1] // 2} cells",
                  "mean u_x of the base", limit, shift, errors[-1], 1e-3,
                  order=f"{expected} expected", seen=observed_order([1 / n for n in sizes], errors),
                  least=expected - 0.1,
                  note="errors " + ", ".join(f"{e:.1e}" for e in errors))


def base_shift(nodes):
    """Mean u_x of FreeFEM's base, P2 on even edges: Simpson's rule, exact for it."""
    base = nodes[np.abs(nodes[:, 1]) < 1e-9]
    shift = base[np.argsort(base[:, 0]), 2]
    return float((shift[0] + 4 * shift[1::2].sum() + 2 * shift[2:-1:2].sum() + shift[-1])
                 / (3 * (len(shift) - 1)))


def controls(study):
    def contact(case):
        return lambda s: compare(s, case, "block", "regular", 1)
    for mistake, broken, compute in (
            ("none", "no mistake: nothing may break", contact("friction")),
            ("unlumped-contact", "gap, slip and reaction by integrals along the base", contact("uplift")),
            ("consistent-slip", "slip and shear by consistent mass of the base", contact("friction")),
            ("smoothed-stick", "friction smoothed over 1e-7 of slip, nothing sticks", contact("friction")),
            ("glued-contact", "nodes in contact pull", contact("uplift")),
            ("viscous-sign", "wrong sign of the viscous coupling of xx and zz", lambda s: steps(s, 1)),
            ("shear-viscosity", "eta1 in place of eta1/2 in shear", lambda s: steps(s, 1)),
            ("branch-beside", "a branch of the layer is in the block", lambda s: steps(s, 1, "rubber_layer_step")),
            ("branch-late", "stretches of a second stage begin where the step did", lambda s: steps(s, 1, "rubber_step"))):
        study.control(GROUP, mistake, broken, compute)


def run(study):
    if not have_freefem():
        raise RuntimeError("FreeFem++ is not installed: ./amontons validate installs it")
    for case, geo in CASES:
        names = {"pads": ["four pads"], "layers": ["on a layer"], "bodies": ["on a base"], "ssnv128": ["32x32"]}.get(case, list(MESHES))
        if study.quick:
            names = names[-1:]
        for name in names:
            for order in (1, 2):
                compare(study, case, geo, name, order)
    for order in (1, 2):
        for case in ("step", "layers_step", "space_step", "rubber_step", "rubber_layer_step"):
            steps(study, order, case)
        for case in ("space_bonded", "space_uplift"):
            compare_in_space(study, case, "regular", SPACE, order)
            if not study.quick:
                compare_in_space(study, case, "unstructured", FREE_SPACE, order)
        compare_in_space(study, "space_pads", "two materials", PADS_SPACE, order)
    if not study.quick:
        quadrilaterals(study)
    controls(study)
