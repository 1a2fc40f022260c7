# SPDX-License-Identifier: GPL-2.0-or-later
"""FreeFEM on the same gmsh mesh, node by node: the same discrete problem, solved by another program.

T3 is FreeFEM's P1 and T6 its P2 on the straight-sided mesh. Contact is on nodes in both, without a
penalty, so that nothing but rounding is left."""
import numpy as np

from harness import (FREEFEM, Control, Row, Run, Static, freefem, have_freefem, make_mesh, match,
                     observed_order, relative)

GROUP = "FreeFEM"
REGULAR = {"shape": "triangle", "nx": 20, "nz": 10}
GRADED = {"shape": "triangle", "nx": 24, "nz": 12, "grade_x": 6, "grade_z": 8, "layout": "alternate"}
FREE = {"shape": "triangle", "nx": 26, "nz": 8, "layout": "free"}
PADS = {"shape": "triangle", "n": 4}
MESHES = {"regular": REGULAR, "graded": GRADED, "unstructured": FREE}

# scene, geometry, tolerance of displacements: bonded states 1e-9, contact 1e-7
CASES = [("bonded", "block", 1e-9), ("traction", "block", 1e-9), ("uplift", "block", 1e-7),
         ("friction", "block", 1e-7), ("pads", "pads", 1e-7)]


def solve_both(study, case, geo, parameters, order, script=None):
    """(ours, FreeFEM's nodes in our order, FreeFEM's stresses at vertices, our rows of them)."""
    folder = study.new_folder(f"freefem-{case}")
    folder.mkdir()
    curves = make_mesh(folder / "linear.msh", geo, parameters)
    make_mesh(folder / "ours.msh", geo, parameters, order)
    theirs = freefem(script or FREEFEM / f"{case}.edp", order, folder / "linear.msh", curves,
                     folder / "freefem.txt")
    ours = Static(study, FREEFEM / f"{case}.yaml", f"static-{case}",
                  {"mesh.file": folder / "ours.msh", "mesh.set": "{}"})
    assert len(theirs) == len(ours.position)
    stress = np.loadtxt(folder / "freefem.txt.stress")
    return (ours, theirs[match(ours.position, theirs[:, :2])], stress[:, 2:],
            match(stress[:, :2], ours.position))


def compare(study, case, geo, tolerance, mesh_name, order):
    parameters = PADS if geo == "pads" else MESHES[mesh_name]
    ours, theirs, stress, vertices = solve_both(study, case, geo, parameters, order)
    element = "T3" if order == 1 else "T6"
    label = f"{case}, {mesh_name}, {element}"
    contact = theirs[ours.contact]
    largest = np.abs(theirs[:, 4:6]).max()
    study.add(GROUP, label, "displacement of every node, largest", np.abs(theirs[:, 2:4]).max(),
              np.abs(ours.displacement).max(), relative(ours.displacement, theirs[:, 2:4]), tolerance)
    study.add(GROUP, label, "reaction of every node, largest", largest,
              np.abs(ours.reaction).max(), relative(ours.reaction, theirs[:, 4:6]), 10 * tolerance)
    study.add(GROUP, label, "nodal stresses, largest", np.abs(stress).max(),
              np.abs(ours.stress[vertices]).max(), relative(ours.stress[vertices], stress),
              10 * tolerance)
    x = ours.position[ours.contact, 0]
    sums = {"pressure resultant": (contact[:, 5].sum(), ours.results["normal_force"]),
            "moment of the pressure": ((x * contact[:, 5]).sum(), ours.results["pressure_moment"])}
    if geo == "block" and case in ("bonded", "traction", "friction"):
        rod = (theirs[:, 0] == 0) & (theirs[:, 1] > 0)
        sums["rod force"] = (theirs[rod, 4].sum(), ours.results["rod_force"])
    for name, (reference, value) in sums.items():
        study.add(GROUP, label, name, reference, value, relative(value, reference), 10 * tolerance)
    if case in ("friction", "pads", "uplift"):
        states = "{open} open, {sticking} stick, {slipping} slip".format(**ours.results)
        theirs_open = int((np.abs(contact[:, 4:6]).max(axis=1) <= 1e-10 * largest).sum())
        study.add(GROUP, label, "open contact nodes", theirs_open, ours.results["open"],
                  abs(theirs_open - ours.results["open"]), 0, note=states)


def steps(study, order):
    """Four viscoelastic steps with M, C and K: displacement and velocity."""
    folder = study.new_folder("freefem-step")
    folder.mkdir()
    curves = make_mesh(folder / "linear.msh", "block", REGULAR)
    make_mesh(folder / "ours.msh", "block", REGULAR, order)
    theirs = freefem(FREEFEM / "step.edp", order, folder / "linear.msh", curves, folder / "nodes.txt")
    run = Run(study, FREEFEM / "step.yaml", "step",
              {"mesh.file": folder / "ours.msh", "mesh.set": "{}"}, energy=0.05)
    time, points, u, v = list(run.frames())[-1]
    theirs = theirs[match(points, theirs[:, :2])]
    label = f"4 viscoelastic steps, {'T3' if order == 1 else 'T6'}"
    for name, mine, yours in (("displacement", u, theirs[:, 2:4]), ("velocity", v, theirs[:, 4:6])):
        study.add(GROUP, label, f"{name} of every node, largest", np.abs(yours).max(),
                  np.abs(mine).max(), relative(mine, yours), 1e-9)


def quadrilaterals(study):
    """FreeFEM has no quadrilaterals: both converge to one state. Work of the loads, bonded block."""
    reference = {}
    sizes, values = [40, 80, 160], []
    for n in (40, 120):
        parameters = {"shape": "triangle", "nx": n, "nz": n // 2}
        folder = study.new_folder("freefem-energy")
        folder.mkdir()
        curves = make_mesh(folder / "linear.msh", "block", parameters)
        nodes = freefem(FREEFEM / "traction.edp", 2, folder / "linear.msh", curves, folder / "n.txt")
        reference[n] = mean_shift(nodes)
    limit = reference[120]
    for n in sizes:
        ours = Static(study, FREEFEM / "traction.yaml", "traction-quad",
                      {"mesh.set": f"{{shape: quad, nx: {n}, nz: {n // 2}}}", "rod.width": 0.05})
        nodes = np.hstack([ours.position, ours.displacement, ours.reaction])
        values.append(mean_shift(nodes))
    errors = [abs(v / limit - 1) for v in values]
    order = observed_order([1 / n for n in sizes], errors)
    study.add(GROUP, "traction, Q4 against P2 120x60", "mean u_x of the top", limit, values[-1],
              errors[-1], 2e-2, seen=order,
              note="by convergence, 40 to 160 cells; singular at the ends of the rod's strip")


def mean_shift(nodes):
    """Mean u_x of the top."""
    top = nodes[np.abs(nodes[:, 1] - nodes[:, 1].max()) < 1e-9]
    order = np.argsort(top[:, 0])
    return float(np.trapz(top[order, 2], top[order, 0]))


def broken_script(study, name, old, new):
    """A copy of a script with one thing wrong."""
    folder = study.new_folder("broken")
    folder.mkdir()
    for file in FREEFEM.glob("*.edp"):
        (folder / file.name).write_text(file.read_text())
    for file in FREEFEM.glob("*.idp"):
        (folder / file.name).write_text(file.read_text())
    path = folder / name
    text = path.read_text()
    assert old in text, (name, old)
    path.write_text(text.replace(old, new))
    return folder


def controls(study):
    """Each is a mistake that a solver could make, put into the reference: the rows must fail."""
    mistakes = [
        ("consistent pressure on a wrong label (traction on the leading face)", "traction", "traction.edp",
         "addTraction(top, 1", "addTraction(leading, 1"),
        ("friction towards the slip, not against it", "friction", "contact.idp",
         "V[N + c] = s * mu", "V[N + c] = -s * mu"),
        ("smoothed stick: a spring of stiffness 10 in place of u_x = 0", "friction", "contact.idp",
         "held[i] = status[c] == stick;",
         "held[i] = 0; if (status[c] == stick) given[i] = 0; "
         "if (status[c] == stick) K(i, i) += 10;"),
        ("consistent, unlumped contact: a penalty integrated over edges", "uplift", "uplift.edp",
         "solveContact(0);", """
Vh active = 1;
matrix K0 = K;
for (int k = 0; k < 30; k++) {
    varf wall(u, v) = int1d(Th, contactCurve)(1e6 * (active > 0.5) * u * v);
    matrix W = wall(Vh, Vh);
    matrix O = 0 * W;
    matrix Z = [[O, O], [O, W]];
    K = K0 + Z;
    real[int] ones(N);
    ones = 1;
    matrix unit = [ones];
    solveHeld(unit);
    for (int i = 0; i < n; i++) active[][i] = u[n + i] < 0;
}"""),
        ("contact that pulls", "uplift", "contact.idp",
         "if (was != open && r[n + i] < -force) status[c] = open;", "if (false) status[c] = open;"),
    ]
    for text, case, name, old, new in mistakes:
        folder = broken_script(study, name, old, new)
        ours, theirs, _, _ = solve_both(study, case, "block", REGULAR, 1, folder / f"{case}.edp")
        row = Row(GROUP, case, "displacement", "", "", relative(ours.displacement, theirs[:, 2:4]), 1e-7)
        study.controls.append(Control(GROUP, text, row))
    step_controls(study)


def step_controls(study):
    for text, old, new in (
            ("wrong sign of eta2 in the viscous coupling", "assemble(C, eta1, eta2)",
             "assemble(C, eta1, -0.5 * eta2)"),
            ("consistent mass in place of lumped", "matrix A = M + g * C;",
             "matrix O = 0 * consistent; matrix MM = [[consistent, O], [O, consistent]]; "
             "matrix A = MM + g * C;")):
        broken_step(study, text, old, new)


def broken_step(study, text, old, new):
    folder = broken_script(study, "step.edp", old, new)
    curves = make_mesh(folder / "linear.msh", "block", REGULAR)
    theirs = freefem(folder / "step.edp", 1, folder / "linear.msh", curves, folder / "nodes.txt")
    run = Run(study, FREEFEM / "step.yaml", "step", {"mesh.file": folder / "linear.msh",
                                                     "mesh.set": "{}"}, energy=0.05)
    _, points, u, _ = list(run.frames())[-1]
    theirs = theirs[match(points, theirs[:, :2])]
    study.controls.append(Control(GROUP, text, Row(
        GROUP, "4 viscoelastic steps", "displacement", "", "", relative(u, theirs[:, 2:4]), 1e-9)))


def run(study):
    if not have_freefem():
        raise RuntimeError("FreeFem++ is not installed: ./amontons validate installs it")
    for case, geo, tolerance in CASES:
        names = ["four pads"] if geo == "pads" else list(MESHES)
        if study.quick:
            names = names[-1:]
        for name in names:
            for order in (1, 2):
                compare(study, case, geo, tolerance, name, order)
    for order in (1, 2):
        steps(study, order)
    if not study.quick:
        quadrilaterals(study)
    controls(study)
