# SPDX-License-Identifier: GPL-2.0-or-later
"""Three dimensions against exact solutions: patches, damped waves, Hertz, a flat punch, Cattaneo and Mindlin, a plate that
slides and turns, and a block held across its drive beside plane strain."""
from pathlib import Path

import numpy as np

from exact.bulk import NU, PRESSURE, column_exact
from harness import SOURCE, Run, Static, observed_order, relative

HERE = Path(__file__).resolve().parent
GROUP = "space"
# name: shape, order and cells of a patch
ELEMENTS = {"TET4": ("tet", 1), "TET10": ("tet", 2), "WEDGE6": ("wedge", 1), "HEX8": ("hex", 1), "HEX27": ("hex", 2)}


def patch(study):
    """Uniform strain on unstructured meshes, to rounding: eps_xx = eps_yy = nu P/E, eps_zz = -P/E."""
    for element, (shape, order) in ELEMENTS.items():
        ours = Static(study, HERE / "space_patch.yaml", f"patch-{element}", {
            "mesh.set": f"{{length: 1, breadth: 0.7, height: 0.5, nx: 4, ny: 4, nz: 2, layout: free, shape: {shape}, order: {order}}}"})
        exact = ours.position * [NU * PRESSURE, NU * PRESSURE, -PRESSURE]
        study.add(GROUP, f"patch test, unstructured {element}", "displacement of every node", PRESSURE / 2,
                  np.abs(ours.displacement[:, 2]).max(), relative(ours.displacement, exact), 1e-11)
        stress = ours.stress - [0, 0, -PRESSURE, 0, 0, 0]
        study.add(GROUP, f"patch test, unstructured {element}", "stress at every node", -PRESSURE, ours.stress[:, 2].min(),
                  np.abs(stress).max() / PRESSURE, 1e-10)


def orders(study):
    """A made-up displacement of waves along all axes, on unstructured meshes: the order of the element in u, one less in energy."""
    for element, (shape, order) in ELEMENTS.items():
        table = np.array([[float(word) for word in study.call("amontons_manufactured", [
            SOURCE / "meshes/block3d.geo", f"shape={shape}", f"order={order}", "layout=free", f"nx={n}", f"ny={n}", f"nz={n}"]).stdout.split()]
            for n in (4, 8)])
        for k, (name, expected) in enumerate((("displacement, L2 norm", order + 1), ("strain energy's norm", order))):
            study.add(GROUP, f"manufactured solution, {element}", name, "chosen", f"{table[-1, k + 1]:.2e}", table[-1, k + 1],
                      (0.1, 1e-2)[order - 1] if k else (1e-2, 3e-4)[order - 1], order=f"{expected} expected",
                      seen=observed_order(table[:, 0], table[:, k + 1]), least=expected - 0.25)


WAVES = {"longitudinal": ("space_wave.yaml", (1 - NU) / ((1 + NU) * (1 - 2 * NU)), 0.2, 2, -1),
         "shear": ("space_shear.yaml", 1 / (2 * (1 + NU)), 0.05, 1, 1)}


def waves(study):
    """As in the plane: a load put on at once sends waves through a column that cannot move aside, to and fro, damped. With cells
    halved the error falls to a quarter."""
    for kind, (scene, modulus, eta, component, sign) in WAVES.items():
        errors, cells = [], [8, 16]
        for n in cells:
            run = Run(study, HERE / scene, f"wave-{kind}-{n}", {
                "mesh.set": f"{{length: 0.25, breadth: 0.25, height: 1, nx: 1, ny: 1, nz: {n}}}"}, ledger=2.5e-2)
            t, points, u, _ = list(run.frames())[-1]
            exact = sign * column_exact(points[:, 2], t, modulus, eta)
            errors.append(float(np.sqrt(np.mean((u[:, component] - exact)**2) / np.mean(exact**2))))
        study.add(GROUP, f"damped {kind} wave, HEX8", f"displacement at every node, {cells[-1]} cells", "exact series",
                  f"{errors[-1]:.2e}", errors[-1], 1e-3, order="2 or more expected",
                  seen=observed_order([1 / c for c in cells], errors), least=1.85)


# --- contact --------------------------------------------------------------------------------------

SPHERE = {"load": 4 * 7e-4, "mu": 0.3, "share": 0.5, "nu": 0.45}   # R = 1, E = 1


def sphere_mesh(n, nz):
    return f"{{length: 2, breadth: 2, height: 1, nx: {n}, ny: {n}, nz: {nz}, grade_x: 0.03, grade_y: 0.03, grade_z: 10}}"


def from_middle(ours):
    x = ours.position[ours.contact] - [1, 1, 0]
    return np.hypot(x[:, 0], x[:, 1]), ours.reaction[ours.contact]


def hertz(study):
    """a^3 = 3 F R (1 - nu^2)/(4 E), p0 = 3 F/(2 pi a^2); the mean of r^2 over the pressure is 2 a^2/5. Eight radii of the contact
    fit into the block; a has 4 cells."""
    F, nu = SPHERE["load"], SPHERE["nu"]
    a = (3 * F * (1 - nu**2) / 4)**(1 / 3)
    p0 = 1.5 * F / (np.pi * a**2)
    ours = Static(study, HERE / "sphere.yaml", "hertz", {"mesh.set": sphere_mesh(24, 10)})
    r, force = from_middle(ours)
    mine = np.sqrt(2.5 * (r**2 * force[:, 2]).sum() / F)
    pressure = force[:, 2] / ours.weight
    study.add(GROUP, "Hertz, sphere", "radius a (second moment of p)", a, mine, abs(mine / a - 1), 2e-2)
    study.add(GROUP, "Hertz, sphere", "largest pressure p0", p0, pressure.max(), abs(pressure.max() / p0 - 1), 2e-2)
    inside = r < 0.9 * a
    study.add(GROUP, "Hertz, sphere", "p(r) for r < 0.9 a, root mean square, of p0", "p0 sqrt(1 - r^2/a^2)", f"{inside.sum()} nodes",
              float(np.sqrt(np.mean((pressure[inside] / p0 - np.sqrt(1 - (r[inside] / a)**2))**2))), 4e-2)


def hertz_curved(study):
    """The same with a ball of radius 1 that is curved itself, drawn by OpenCASCADE, of TET10, whose faces touch by their mid-sides.
    It is no half-space: (a/R)^2 = 0.7 % is to be expected."""
    nu = 0.3
    ours = Static(study, HERE / "ball.yaml", "ball", {"mesh.set": "{size: 0.03, order: 2}"})
    at, force = ours.position[ours.contact], ours.reaction[ours.contact][:, 2]
    r, F = np.hypot(at[:, 0], at[:, 1]), force.sum()
    a = (3 * F * (1 - nu**2) / 4)**(1 / 3)
    p0 = 1.5 * F / (np.pi * a**2)
    mine = np.sqrt(2.5 * (r**2 * force).sum() / F)
    pressure, inside = force / ours.weight, r < 0.9 * a
    case = "Hertz, a ball of curved TET10"
    study.add(GROUP, case, "radius a (second moment of p)", a, mine, abs(mine / a - 1), 1e-2)
    study.add(GROUP, case, "largest pressure p0", p0, pressure.max(), abs(pressure.max() / p0 - 1), 2e-2)
    study.add(GROUP, case, "p(r) for r < 0.9 a, root mean square, of p0", "p0 sqrt(1 - r^2/a^2)", f"{inside.sum()} nodes",
              float(np.sqrt(np.mean((pressure[inside] / p0 - np.sqrt(1 - (r[inside] / a)**2))**2))), 2.5e-2)


def mindlin(study):
    """Stick radius c = a (1 - Q/(mu F))^(1/3), from the area that sticks and from the second moment of the shear,
    mu F (2/5)(a^2 - c^5/a^3). Shift: how much more the top moves than where all sticks, which has the block's own yield, too:
    3 mu F (2 - nu)/(16 G a) (1 - (1 - Q/(mu F))^(2/3)) - Q (2 - nu)/(8 G a). The theory is exact for no Poisson's ratio (pressure and
    shear are uncoupled at 0.5, slip is along the force at 0); at 0.45 a few per cent are to be expected."""
    F, mu, q, nu = (SPHERE[k] for k in ("load", "mu", "share", "nu"))
    Q, G = q * mu * F, 1 / (2 * (1 + nu))
    a = (3 * F * (1 - nu**2) / 4)**(1 / 3)
    c = a * (1 - q)**(1 / 3)
    shift = {}
    for name, friction in (("partial slip", mu), ("no slip", 100)):
        ours = Static(study, HERE / "sphere.yaml", "mindlin", {
            "mesh.set": sphere_mesh(24, 10), "friction.mu_static": friction,
            "load.supports": "[]", "load.tractions":
            f"[{{group: top, x: {Q / 4}}}, {{group: leading, z: {Q / 4}}}, {{group: rod, z: {-Q / 4}}}]"})
        shift[name] = ours.displacement[np.isclose(ours.position[:, 2], 1), 0].mean()
        if name == "partial slip":
            r, force = from_middle(ours)
            area = np.sqrt(ours.weight[ours.status == 1].sum() / np.pi)
            moment = ((a**2 + 2.5 * (r**2 * force[:, 0]).sum() / (mu * F)) * a**3)**0.2
            across = abs(force[:, 1]).sum() / abs(force[:, 0]).sum()
    study.add(GROUP, "Cattaneo-Mindlin, sphere", "stick radius c (area)", c, area, abs(area / c - 1), 6e-2, note="a ring of nodes is 6 %")
    study.add(GROUP, "Cattaneo-Mindlin, sphere", "stick radius c (second moment of shear)", c, moment, abs(moment / c - 1), 3e-2,
              note=f"forces across are {across:.0%} of those along the drive, which the theory leaves out")
    exact = 3 * mu * F * (2 - nu) / (16 * G * a) * (1 - (1 - q)**(2 / 3)) - Q * (2 - nu) / (8 * G * a)
    mine = shift["partial slip"] - shift["no slip"]
    study.add(GROUP, "Cattaneo-Mindlin, sphere", "shift by slip", exact, mine, abs(mine / exact - 1), 6e-2)


def punch(study):
    """p = F/(2 pi a sqrt(a^2 - r^2)), the mean of r^2 is 2 a^2/3. It is singular at the rim: what a mesh takes for a is too large by a
    part of a cell there, so errors fall with the cell."""
    a, moments, middles, sizes = 0.25, [], [], [0.045, 0.03] if study.quick else [0.045, 0.03, 0.015]
    for rim in sizes:
        ours = Static(study, HERE / "punch.yaml", "punch", {"mesh.set": f"{{rim: {rim}, middle: {2 * rim}, layers: 14, grade: 50}}"})
        x = ours.position[ours.contact] - [2, 2, 0]
        r, force = np.hypot(x[:, 0], x[:, 1]), ours.reaction[ours.contact][:, 2]
        moments.append((r**2 * force).sum() / force.sum() / a**2 * 1.5 - 1)
        inside = r < 0.7 * a
        exact = force.sum() / (2 * np.pi * a * np.sqrt(a**2 - r[inside]**2))
        middles.append(float(np.sqrt(np.mean((force[inside] / ours.weight[inside] / exact - 1)**2))))
    study.add(GROUP, "flat round punch", "mean of r^2 over the pressure", 2 / 3, 2 / 3 * (1 + moments[-1]), moments[-1],
              0.1 if study.quick else 0.04, order="1 expected", seen=observed_order(sizes, moments), least=0.6)
    study.add(GROUP, "flat round punch", "p(r) for r < 0.7 a, root mean square", "exact", f"{middles[-1]:.3f}", middles[-1], 0.1 if study.quick else 0.05,
              note="on coarser meshes " + ", ".join(f"{m:.3f}" for m in middles[:-1]))


# --- a plate that slides and turns ------------------------------------------------------------------

def plate_exact(x, y, weight, until, steps=3000):
    """(t, v_x, v_y, omega) of a rigid plate with the masses and loads of these nodes: friction mu(|v|) p w against the velocity of
    each, Runge and Kutta's method of order 4. It shares nothing with amontons."""
    load, height, mass = 1e-3, 0.01, 0.01 * weight.sum()
    inertia = height * (weight * (x**2 + y**2)).sum()
    push, couple = 1.5e-4 * weight.sum(), 6.6667e-3 * 0.6 * height * 1

    def change(v):
        vx, vy = v[0] - v[2] * y, v[1] + v[2] * x
        speed = np.hypot(vx, vy)
        drag = np.maximum(0.1, 0.4 - 0.3 * speed / 0.05) * load * weight / speed
        return np.array([-(drag * vx).sum() / mass, (push - (drag * vy).sum()) / mass, (couple - (drag * (x * vy - y * vx)).sum()) / inertia])

    v, step, out = np.array([0.02, 0, 0]), until / steps, []
    for k in range(steps + 1):
        out.append((k * step, *v))
        k1 = change(v)
        k2 = change(v + step / 2 * k1)
        k3 = change(v + step / 2 * k2)
        v = v + step / 6 * (k1 + 2 * k2 + 2 * k3 + change(v + step * k3))
    return np.array(out).T


def plate(study):
    """Vectors of friction: a plate thrown along x, pushed across and turned. Its friction acts below its middle, which moves
    pressure towards edges (5 %): that is what is left. Angles turned through are 0.008: places stay."""
    run = Run(study, HERE / "oblique.yaml", "plate", ledger=5e-3, conditions=3e-9)
    x, y, weight = run["x"] - 0.5, run["y"] - 0.3, run["weight"]
    rigid = np.zeros((2 * len(x), 3))
    rigid[0::2, 0] = rigid[1::2, 1] = 1
    rigid[0::2, 2], rigid[1::2, 2] = -y, x
    ours = np.array([np.linalg.lstsq(rigid, v.reshape(-1).astype(float), rcond=None)[0] for v in run["slip_rate"]])
    exact = plate_exact(x, y, weight, run["time"][-1])
    for k, name in enumerate(("along the drive", "across it", "of rotation")):
        wanted = np.interp(run["time"], exact[0], exact[k + 1])
        study.add(GROUP, "a plate slides and turns", f"velocity {name} at all times", f"{wanted[-1]:.5g} at the end", f"{ours[-1, k]:.5g}",
                  relative(ours[:, k], wanted), 6e-3)


# --- limits ---------------------------------------------------------------------------------------

def held_across(study):
    """A block that walls hold across its drive is plane strain. Where steps resolve what happens (a third of the usual tolerance) the
    peaks are the same to six digits; at the usual one they differ by what steps leave, as a sliding sets out in another step."""
    peaks = {}
    for tolerance in (0, 3e-4):
        for name, sets in (("plane strain", {"mesh.file": HERE / "../../meshes/block.geo", "material.plane": "strain", "mesh.set":
                                             "{length: 0.5, height: 0.5, nx: 10, nz: 8}", "load.supports": "[]"}), ("held across", {})):
            run = Run(study, HERE / "held.yaml", "held", {"time.tolerance": tolerance, **sets})
            peaks[tolerance, name] = [p["mu"] for p in run.report["results"]["peaks"]]
    for tolerance, allowed in ((0, 1e-3), (3e-4, 1e-5)):
        flat, deep = peaks[tolerance, "plane strain"], peaks[tolerance, "held across"]
        study.add(GROUP, "a block held across its drive, weakening", f"peaks, tolerance {tolerance or 'usual'}",
                  ", ".join(f"{p:.6f}" for p in flat), ", ".join(f"{p:.6f}" for p in deep),
                  relative(deep, flat) if len(deep) == len(flat) else np.inf, allowed)


def controls(study):
    for mistake, broken in (("last-direction", "friction along the slip of the solve before"),
                            ("no-across", "no friction across the drive")):
        study.control(GROUP, mistake, broken, plate)
    study.control(GROUP, "half-weight", "half the weight at one contact node", hertz)
    study.control(GROUP, "bent-corners", "corners of curved T6 faces touch the floor, too", hertz_curved)
    study.control(GROUP, "shear-viscosity", "eta1 in place of eta1/2 in shear", waves)


def run(study):
    for part in (patch, orders, waves, hertz, hertz_curved, mindlin, punch, plate, held_across):
        part(study)
    controls(study)
