# SPDX-License-Identifier: GPL-2.0-or-later
"""A floor that deforms: glued bodies, a stiff base, two elastic bodies in line contact, explicit steps."""
from pathlib import Path

import numpy as np

from harness import Run, Static, mesh_set, observed_order, relative

HERE = Path(__file__).resolve().parent
GROUP = "two bodies"
PRESSURE, SHEAR = 3e-3, 2e-4


def glued(study, element, ratio):
    """All sticks: what one mesh in one piece gives. Matching nodes to rounding; others at the order of the elements
    (below, where the pieces of both meshes halve). The corners of the block, where stresses of an edge are not
    bounded, are the same in both."""
    sets = {"load.tractions": f"[{{group: top, x: {SHEAR}, z: 0}}]"}
    whole = Static(study, HERE / "bodies.yaml", "glued", {
        **sets, "mesh.set": mesh_set(element, nx=20, nz=10, glued=1), "groups.contact": "bottom"})
    ours = Static(study, HERE / "bodies.yaml", "stuck", {**sets, "mesh.set": mesh_set(element, nx=20, nz=10, ratio=ratio)})
    lift = whole.position[:, 1].min() - ours.position[:, 1].min()   # the glued body stands on its own bottom
    where = {tuple(p): u for p, u in zip(np.round(whole.position - [0, lift], 7) + 0.0, whole.displacement)}
    pairs = [(where[p], u) for p, u in zip(map(tuple, np.round(ours.position, 7) + 0.0), ours.displacement) if p in where]
    theirs, mine = map(np.array, zip(*pairs))
    return relative(mine, theirs), len(pairs), ours


def glued_bodies(study):
    for element in ("Q4", "T6") if study.quick else ("Q4", "T3", "Q9", "T6", "Q8"):
        error, nodes, ours = glued(study, element, 1)
        study.add(GROUP, f"all sticks, matching nodes, {element}", "displacement of every node against one mesh",
                  "0", f"{error:.1e}", error, 1e-11, note=f"{nodes} nodes; {ours.results['sticking']} stick")


def glued_in_time(study):
    """The same in steps of both bodies' inertia and viscosity, the load put on at once: the last of twenty."""
    found = {}
    for name, more in (("glued", {"mesh.set": mesh_set("Q4", nx=20, nz=10, glued=1), "groups.contact": "bottom"}),
                       ("stuck", {"mesh.set": mesh_set("Q4", nx=20, nz=10)})):
        run = Run(study, HERE / "bodies.yaml", f"{name}-in-time", {
            **more, "material.eta1": 0.05, "material.eta2": 0.05, "start.state": "undeformed", "output.fields": "{every_t: 0.9}",
            "time": "{until: {t: 1.0001}, step_max: 0.05, step_min: 0.05, tolerance: 1, energy_tolerance: 1}"}, ledger=1)
        _, points, u, v = list(run.frames())[-1]
        lift = points[:, 1].min() + 0.5
        found[name] = {tuple(p): [*a, *b] for p, a, b in zip(np.round(points - [0, lift], 6) + 0.0, u, v)}
    where = sorted(found["glued"].keys() & found["stuck"].keys())
    theirs, mine = (np.array([found[name][p] for p in where]) for name in ("glued", "stuck"))
    for k, name in ((0, "displacement"), (2, "velocity")):
        study.add(GROUP, "all sticks, in time, matching nodes, Q4", f"{name} of every node against one mesh, largest",
                  np.abs(theirs[:, k:k + 2]).max(), np.abs(mine[:, k:k + 2]).max(),
                  relative(mine[:, k:k + 2], theirs[:, k:k + 2]), 1e-11)


def limit_of_meshes(study):
    """Not matching: the work of the loads goes to that of one mesh in one piece."""
    sets = {"load.tractions": f"[{{group: top, x: {SHEAR}, z: 0}}]"}
    # Corners of right angles between equal materials: r^0.545, so that the work is of order 1.09 in the cell.
    errors, cells = [], (10, 20, 40)
    for n in cells:
        parts = {}
        for name, more, ratio in (("glued", {"glued": 1}, 1), ("apart", {}, 1.5)):
            more_sets = {"groups.contact": "bottom"} if name == "glued" else {}
            found = Static(study, HERE / "bodies.yaml", name, {**sets, **more_sets, "mesh.set": mesh_set("Q4", nx=n, nz=n // 2, ratio=ratio, **more)})
            parts[name] = found.results["load_work"]
        errors.append(abs(parts["apart"] / parts["glued"] - 1))
    study.add(GROUP, "all sticks, three cells over two, Q4", "work of the loads against one mesh", 0, errors[-1], errors[-1], 4e-3,
              order="1 expected, of the corners", seen=observed_order([1 / n for n in cells], errors), least=0.8,
              note="errors " + ", ".join(f"{e:.1e}" for e in errors))


def stiff_base(study):
    """A base 10^6 times as stiff is the rigid floor."""
    sets = {"friction.mu_static": 0.38, "rod": "{kind: bonded, displacement: 3.2e-3, height: 0.4, width: 0.05}"}
    rigid = Static(study, HERE / "bodies.yaml", "rigid", {
        **sets, "mesh.file": HERE.parents[1] / "meshes/block.geo", "mesh.set": "{nx: 20, nz: 10}", "load.supports": "[]"})
    base = Static(study, HERE / "bodies.yaml", "stiff", {**sets, "materials": "{base: {young: 1e6}}"}, slack=1e4)
    study.add(GROUP, "base 10^6 times as stiff", "reactions of the contact against the rigid floor's",
              np.abs(rigid.reaction[rigid.contact]).max(), np.abs(base.reaction[base.contact]).max(),
              relative(base.reaction[base.contact], rigid.reaction[rigid.contact]), 1e-5)
    study.add(GROUP, "base 10^6 times as stiff", "slip of the contact against the rigid floor's", np.abs(rigid.jump).max(),
              np.abs(base.jump).max(), relative(base.jump, rigid.jump), 1e-5)


FORCE, RADIUS, MU, SHARE = 2e-3, 1.0, 0.5, 0.5


def line_contact(study, nu, stiffness):
    """Hertz with 1/E* the sum of both; for like bodies Cattaneo and Mindlin are exact for every Poisson's ratio. Moments
    of pressure and shear, as in exact/statics.py; the block's and the base's size, 23 a, stays."""
    modulus = 1 / ((1 - nu**2) * (1 + 1 / stiffness))
    a = np.sqrt(4 * FORCE * RADIUS / (np.pi * modulus))
    mesh = ("{length: 2, height: 1, base_height: 1, behind: 1, before: 1, nx: 64, nz: 32, order: 2, grade_x: 0.03, "
            "grade_z: 40}")
    sets = {"mesh.set": mesh, "material.plane": "strain", "material.poisson": nu, "contact": f"{{gap: (x - 1)^2 / {2 * RADIUS}}}",
            "materials": f"{{base: {{young: {stiffness}}}}}", "load.pressure": FORCE / 2}
    held = "{group: bottom, direction: both}"
    normal = Static(study, HERE / "bodies.yaml", "hertz-two", {
        **sets, "friction.mu_static": 0, "load.supports": f"[{held}, {{group: top, direction: x}}]"}, slack=100)
    x, r = normal.position[normal.contact, 0] - 1, normal.reaction[normal.contact]
    ours = 2 * np.sqrt((x**2 * r[:, 1]).sum() / r[:, 1].sum())
    study.add(GROUP, f"Hertz, two elastic bodies, nu {nu}, base {stiffness:g} times as stiff", "half-width a (second moment of p)",
              a, ours, abs(ours / a - 1), 5e-3, note=f"limited by the size of the bodies, {1 / a:.0f} a")
    if stiffness != 1:
        return
    q, c = SHARE * MU * FORCE, a * np.sqrt(1 - SHARE)
    sheared = Static(study, HERE / "bodies.yaml", "mindlin-two", {
        **sets, "friction.mu_static": MU, "load.supports": f"[{held}]",
        "load.tractions": f"[{{group: top, x: {q / 2}, z: 0}}, {{group: leading, x: 0, z: {q / 2}}}, {{group: rod, x: 0, z: {-q / 2}}}]"},
        slack=100)
    x, r = sheared.position[sheared.contact, 0] - 1, sheared.reaction[sheared.contact]
    second = -(x**2 * r[:, 0]).sum() / (MU * FORCE)
    ours = (a**2 * (a**2 - 4 * second)) ** 0.25
    study.add(GROUP, f"Cattaneo-Mindlin, like bodies, nu {nu}", "stick half-width c (second moment of tau)", c, ours,
              abs(ours / c - 1), 1e-2)


SPHERE = {"load": 4 * 7e-4, "mu": 0.3, "share": 0.5, "nu": 0.3}   # R = 1, E = 1 of the block


def spheres(study, stiffness):
    """Hertz: a^3 = 3 F R/(4 E*), 1/E* the sum of both bodies'. Cattaneo and Mindlin, for like bodies: the stick radius is
    a (1 - Q/(mu F))^(1/3). Pressure and shear are uncoupled then; that slip is not quite along the force
    where nu is not 0, the theory leaves out. Moments of pressure and shear, as in exact/space.py; a is 1/7 of the block's half-width."""
    F, mu, q, nu = (SPHERE[k] for k in ("load", "mu", "share", "nu"))
    a = (0.75 * F * (1 - nu**2) * (1 + 1 / stiffness)) ** (1 / 3)
    sets = {"materials": f"{{base: {{young: {stiffness}}}}}", "material.poisson": nu}
    normal = Static(study, HERE / "spheres.yaml", "hertz-spheres", sets)
    x, force = normal.position[normal.contact] - [1, 1, 0], normal.reaction[normal.contact]
    ours = np.sqrt(2.5 * ((x[:, 0]**2 + x[:, 1]**2) * force[:, 2]).sum() / F)
    study.add(GROUP, f"Hertz, sphere on a plate {stiffness:g} times as stiff", "radius a (second moment of p)", a, ours, abs(ours / a - 1), 2e-2,
              note="limited by the mesh: 0.0206, a cell of the middle")
    if stiffness != 1:
        return
    Q, c = q * mu * F, a * (1 - q)**(1 / 3)
    sheared = Static(study, HERE / "spheres.yaml", "mindlin-spheres", {
        **sets, "friction.mu_static": mu, "load.supports": "[{group: bottom, direction: all}]", "load.tractions":
        f"[{{group: top, x: {Q / 4}}}, {{group: leading, z: {Q / 4}}}, {{group: rod, z: {-Q / 4}}}]"})
    x, force = sheared.position[sheared.contact] - [1, 1, 0], sheared.reaction[sheared.contact]
    ours = ((a**2 + 2.5 * ((x[:, 0]**2 + x[:, 1]**2) * force[:, 0]).sum() / (mu * F)) * a**3)**0.2
    study.add(GROUP, "Cattaneo-Mindlin, like spheres", "stick radius c (second moment of shear)", c, ours, abs(ours / c - 1), 3e-2)


def unlike_solution(study, stiffness, nu, nu_base, cells):
    """Two unlike half-spaces, sheared, with a stretch of the length 2 a without friction (Comninou, J. Appl. Mech. 44, 1977): slip
    is an ellipse, and pressure changes by beta tau t/sqrt(a^2 - t^2), t from the middle of the stretch. Slip into the direction
    in which the softer body moves unloads the front end (Weertman, J. Geophys. Res. 85, 1980). All is linear as long as nothing
    opens and the rest sticks: the state without shear is taken off. Yields (what, exact, computed) for |t| < 0.8 a; a ends half
    a cell behind the last node that slips, which leaves an error of first order."""
    tau, found = 2e-5, {}
    mesh = f"{{length: 2, height: 1, base_height: 1, behind: 0, before: 0, nx: {cells}, nz: {cells // 4}, grade_x: 0.03, grade_z: 30}}"
    for shear in (0, tau):
        sides = "".join(f", {{group: {name}, x: 0, z: {sign * shear}}}" for name, sign in
                        (("leading", 1), ("rod", -1), ("base_front", 1), ("base_rear", -1)))
        found[shear] = Static(study, HERE / "bodies.yaml", "unlike", {
            "mesh.set": mesh, "material": f"{{poisson: {nu}, plane: strain}}", "load.pressure": 1e-3,
            "materials": f"{{base: {{young: {stiffness}, poisson: {nu_base}}}}}", "load.tractions": f"[{{group: top, x: {shear}, z: 0}}{sides}]",
            "friction.along": "points(x, 0.919999, 1, 0.92, 0, 1.08, 0, 1.080001, 1)"}, slack=1e4)
    sheared, rest = found[tau], found[0]
    t = sheared.position[sheared.contact, 0] - 1
    pressure = (sheared.reaction - rest.reaction)[sheared.contact, 1] / sheared.weight
    slip = (sheared.jump - rest.jump)[:, 0]
    a = t[abs(slip) > 1e-3 * abs(slip).max()].max() + np.diff(t).min() / 2
    block, base = 1 / (2 * (1 + nu)), stiffness / (2 * (1 + nu_base))   # shear moduli
    kappa, kappa_base = 3 - 4 * nu, 3 - 4 * nu_base
    total = block * (kappa_base + 1) + base * (kappa + 1)
    alpha = (base * (kappa + 1) - block * (kappa_base + 1)) / total
    beta = (block * (kappa_base - 1) - base * (kappa - 1)) / total
    compliance = (kappa + 1) * (1 - beta**2) / (2 * block * (1 + alpha))
    inside = abs(t) < 0.8 * a
    root = np.sqrt(a**2 - t[inside]**2)
    yield "slip", compliance * tau * root, slip[inside]
    yield f"change of pressure, Dundurs' beta {beta:.3f},", beta * tau * t[inside] / root, pressure[inside]


def unlike(study, stiffness, nu, nu_base):
    fine = 160
    coarse = [] if study.quick else [relative(ours, exact) for _, exact, ours in unlike_solution(study, stiffness, nu, nu_base, fine // 2)]
    for k, (what, exact, ours) in enumerate(unlike_solution(study, stiffness, nu, nu_base, fine)):
        error = relative(ours, exact)
        order = {"order": "1 expected", "seen": observed_order([2, 1], [coarse[k], error]), "least": 0.7} if coarse else {}
        study.add(GROUP, f"unlike half-spaces, base {stiffness:g} times as stiff", f"{what} of a stretch without friction, largest",
                  exact.max(), ours.max(), error, 3.5e-2, note="a cell is 4 % of a", **order)


def explicit_steps(study):
    """The same scene by central differences on the same two meshes."""
    implicit = Run(study, HERE / "bodies_run.yaml", "implicit-two", {"time.tolerance": 1e-5})
    explicit = Run(study, HERE / "bodies_run.yaml", "explicit-two", {"time.scheme": "explicit"}, ledger=3e-3)
    compare_steps(study, "explicit steps on the same meshes", implicit, explicit)


def compare_steps(study, case, implicit, explicit):
    for name in ("mu_M", "mu_max"):
        one, other = implicit.report["results"][name], explicit.report["results"][name]
        study.add(GROUP, case, name, other, one, abs(one / other - 1), 2e-3)


def explicit_in_space(study):
    space = {"mesh.file": HERE / "../../meshes/base3d.geo", "mesh.set": "{nx: 4, ny: 4, nz: 2, breadth: 0.5}",
             "load.supports": "[{group: bottom, direction: all}]"}
    implicit = Run(study, HERE / "bodies_run.yaml", "implicit-space", {**space, "time.tolerance": 1e-5})
    explicit = Run(study, HERE / "bodies_run.yaml", "explicit-space", {**space, "time.scheme": "explicit"}, ledger=3e-3)
    compare_steps(study, "explicit steps on the same meshes, in space", implicit, explicit)


def controls(study):
    for mistake, broken, compute in (
            ("none", "no mistake: nothing may break", glued_in_time),
            ("floor-beside", "each contact node over the floor of its neighbour", glued_bodies),
            ("floor-weight", "what floor nodes give adds up to 1, not what contact nodes take", limit_of_meshes),
            ("one-sided", "displacements of the block without the floor's", glued_bodies),
            ("light-base", "a base without mass", glued_in_time),
            ("mass-apart", "inertia that does not couple jumps to the floor", explicit_steps)):
        study.control(GROUP, mistake, broken, compute)


def run(study):
    glued_bodies(study)
    glued_in_time(study)
    if not study.quick:
        limit_of_meshes(study)
    stiff_base(study)
    for nu, stiffness in ((0.3, 1),) if study.quick else ((0.3, 1), (0.0, 1), (0.45, 1), (0.3, 5)):
        line_contact(study, nu, stiffness)
    for stiffness in () if study.quick else (1, 4):
        spheres(study, stiffness)
    for stiffness, nu, nu_base in ((10, 0.3, 0.3),) if study.quick else ((10, 0.3, 0.3), (0.1, 0.3, 0.3), (4, 0.2, 0.4)):
        unlike(study, stiffness, nu, nu_base)
    explicit_steps(study)
    if not study.quick:
        explicit_in_space(study)
    controls(study)
