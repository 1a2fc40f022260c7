# SPDX-License-Identifier: GPL-2.0-or-later
"""Published and exact equilibria with friction: SSNV128, SSNV503, Hertz, Cattaneo and Mindlin."""
import subprocess
from pathlib import Path

import numpy as np

from harness import PROGRAM, Chart, Control, Row, Run, Static, observed_order, relative

HERE = Path(__file__).resolve().parent
GROUP = "published statics"

# code_aster V6.04.128; Feijoo, Barbosa and Zouain: u_x on y = 0 at these x, and the mean of codes.
SSNV128_X = [0, 0.00125, 0.005, 0.0075, 0.01125]
SSNV128_MEAN = [2.86e-5, 2.72e-5, 2.28e-5, 1.98e-5, 1.50e-5]
SSNV128_ASTER = [2.8649e-5, 2.7269e-5, 2.2924e-5, 1.9929e-5, 1.5609e-5]
SSNV128_FREEFEM = {32: [2.8521e-5, 2.7147e-5, 2.2808e-5, 1.9771e-5, 1.5389e-5],
                   64: [2.8578e-5, 2.7203e-5, 2.2848e-5, 1.9795e-5, 1.5405e-5]}


def ssnv128_state(study, shape, cells, **sets):
    ours = Static(study, HERE / "ssnv128.yaml", "ssnv128", {"mesh.set": (
        f"{{length: 0.04, height: 0.04, nx: {cells}, nz: {cells}, shape: {shape}}}"), **sets})
    x = ours.position[ours.contact, 0]
    return ours, np.interp(SSNV128_X, x, ours.displacement[ours.contact, 0])


def ssnv128(study):
    for shape, cells in (("quad", 32), ("triangle", 32), ("triangle", 64)):
        if study.quick and cells > 32:
            continue
        ours, u = ssnv128_state(study, shape, cells)
        name = f"SSNV128, {'Q4' if shape == 'quad' else 'T3'} {cells}x{cells}"
        reference = SSNV128_ASTER if shape == "quad" else SSNV128_FREEFEM[cells]
        source = "code_aster Q4" if shape == "quad" else f"FreeFEM P1 {cells}x{cells}"
        for x, r, mean, mine in zip(SSNV128_X, reference, SSNV128_MEAN, u):
            study.add(GROUP, name, f"u_x at x = {x:g}, against {source}", f"{r:.4e}", f"{mine:.4e}",
                      abs(mine / r - 1), 0.015, note=f"mean of codes {mean:.2e}: "
                      f"{abs(mine / mean - 1):.1%} off")
        study.add(GROUP, name, "normal resultant", 2.0e6, ours.results["normal_force"],
                  abs(ours.results["normal_force"] / 2e6 - 1), 1e-9)
        lifted = ours.displacement[ours.contact[:2], 1]
        study.add(GROUP, name, "u_y of the two leftmost nodes: lift off", "6.8e-7, 3.6e-7",
                  "{:.1e}, {:.1e}".format(*lifted), 0 if min(lifted) > 0 else 1, 0,
                  note="how many more nodes open depends on the mesh")
    _, wrong = ssnv128_state(study, "quad", 32, **{"material.plane": "stress"})
    study.controls.append(Control(GROUP, "SSNV128 in plane stress", Row(
        GROUP, "SSNV128", "u_x", "", "", float(np.abs(wrong / SSNV128_ASTER - 1).max()), 0.015)))
    _, wrong = ssnv128_state(study, "quad", 32, **{"friction.mu_static": 0.9})
    study.controls.append(Control(GROUP, "SSNV128 with friction 0.9 in place of 1", Row(
        GROUP, "SSNV128", "u_x", "", "", float(np.abs(wrong / SSNV128_ASTER - 1).max()), 0.015)))


def ssnv128_in_time(study):
    """SDIRK2 until all is at rest. exp(-20) = 2e-9 is left; error control allows somewhat more."""
    rest, _ = ssnv128_state(study, "quad", 32)
    run = Run(study, HERE / "ssnv128_run.yaml", "ssnv128-run")
    u, r = rest.displacement[rest.contact], rest.reaction[rest.contact]
    slip, force = run["slip"][-1], run["pressure"][-1] * run["weight"]
    study.add(GROUP, "SSNV128, SDIRK2 in time", "u_x of the contact, against the static result",
              float(u[0, 0]), float(slip[0]), relative(slip, u[:, 0]), 1e-5,
              note="code_aster {:.4e}; {} steps".format(SSNV128_ASTER[0], run.report["steps"]["accepted"]))
    study.add(GROUP, "SSNV128, SDIRK2 in time", "normal reactions, against the static result",
              float(r[:, 1].sum()), float(force.sum()), relative(force, r[:, 1]), 1e-5)
    study.add(GROUP, "SSNV128, SDIRK2 in time", "nodes lifted off", int((u[:, 1] > 0).sum()),
              int((run["status"][-1] == 0).sum()),
              abs(int((u[:, 1] > 0).sum()) - int((run["status"][-1] == 0).sum())), 0)
    k = int(np.argmin(np.abs(run["time"] - 1)))
    grown = 1 - np.exp(-run["time"][k])
    study.add(GROUP, "SSNV128, SDIRK2 in time", f"u_x at t = {run['time'][k]:.3f}: static (1 - exp(-t))",
              float(u[0, 0] * grown), float(run["slip"][k, 0]), relative(run["slip"][k], u[:, 0] * grown),
              1e-3)
    wrong = Run(study, HERE / "ssnv128_run.yaml", "ssnv128-short", {"time.until.t": 5})["slip"][-1]
    study.controls.append(Control(GROUP, "SSNV128 in time, stopped before it rests", Row(
        GROUP, "SSNV128", "u_x", "", "", relative(wrong, u[:, 0]), 1e-5)))


def threshold(study):
    """mu N = 3600: 0.99 of it sticks, 1.01 of it finds no equilibrium, a rod is met by exactly mu N."""
    held = Static(study, HERE / "threshold.yaml", "threshold")
    study.add(GROUP, "SSNV503", "0.99 mu N: shear carried", 3564, -held.results["shear_force"],
              abs(held.results["shear_force"] / -3564 - 1), 1e-9,
              note="{sticking} stick, {slipping} slip".format(**held.results))
    over = subprocess.run([PROGRAM, "static", HERE / "threshold.yaml", "-q", "--set",
                           "load.tractions=[{group: top, x: 3636, z: 0}]"], capture_output=True, text=True)
    study.add(GROUP, "SSNV503", "1.01 mu N: refused, nothing holds the block", "exit status 1",
              f"exit status {over.returncode}", 0 if over.returncode == 1 else 1, 0)
    pushed = Static(study, HERE / "threshold.yaml", "threshold-rod",
                    {"rod": "{kind: bonded, displacement: 1e-3}", "load.tractions": "[]"})
    study.add(GROUP, "SSNV503", "force on a rod that slides the block", 3600,
              pushed.results["rod_force"], abs(pushed.results["rod_force"] / 3600 - 1), 1e-9)
    run = Run(study, HERE / "threshold_run.yaml", "threshold-run", energy=1)
    last = float(run["rod_force"][-1])
    study.add(GROUP, "SSNV503, SDIRK2 in time", "force of the rod once all slides", 3600, last,
              abs(last / 3600 - 1), 1e-4)


# --- line contact ---------------------------------------------------------------------------------

NU, RADIUS, FORCE, MU, SHARE = 0.499, 1.0, 2e-3, 0.5, 0.5


def line_contact(study):
    """Hertz: a^2 = 4 P' R/(pi E*); the second moment of the pressure is P' a^2/4. Cattaneo-Mindlin:
    stick for |x| < c = a sqrt(1 - Q/(mu P')); second moment of the shear mu P' (a^2 - c^4/a^2)/4."""
    a = np.sqrt(4 * FORCE * RADIUS / (np.pi / (1 - NU**2)))
    c = a * np.sqrt(1 - SHARE)
    cells, errors = [40, 80] if study.quick else [40, 80, 160], {"a": [], "c": []}
    for n in cells:
        mesh = f"{{length: 2, height: 1, nx: {n}, nz: {n // 2}, order: 2, grade_x: 0.02, grade_z: 40}}"
        normal = Static(study, HERE / "line_contact.yaml", "hertz", {"mesh.set": mesh},
                        slack=10)
        x, r = normal.position[normal.contact, 0] - 1, normal.reaction[normal.contact]
        ours_a = 2 * np.sqrt((x**2 * r[:, 1]).sum() / r[:, 1].sum())
        errors["a"].append(abs(ours_a / a - 1))
        q = SHARE * MU * FORCE
        sheared = Static(study, HERE / "line_contact.yaml", "mindlin", {
            "mesh.set": mesh, "friction.mu_static": MU, "load.supports": "[]",
            "load.tractions": f"[{{group: top, x: {q / 2}, z: 0}}, {{group: leading, x: 0, z: {q / 2}}}, "
                              f"{{group: rod, x: 0, z: {-q / 2}}}]"}, slack=10)
        x, r = sheared.position[sheared.contact, 0] - 1, sheared.reaction[sheared.contact]
        second = -(x**2 * r[:, 0]).sum() / (MU * FORCE)
        ours_c = (a**2 * (a**2 - 4 * second)) ** 0.25
        errors["c"].append(abs(ours_c / c - 1))
    study.add(GROUP, "Hertz, cylinder under a plane, Q9", "half-width a (second moment of p)", a, ours_a,
              errors["a"][-1], 5e-3, note=f"limited by the size of the block, H = 23 a; largest pressure {2 * FORCE / np.pi / ours_a:.5f}, "
              f"exact {2 * FORCE / np.pi / a:.5f}")
    study.add(GROUP, "Cattaneo-Mindlin, Q = mu P'/2", "stick half-width c (second moment of tau)", c,
              ours_c, errors["c"][-1], 1e-2,
              seen=observed_order([1 / n for n in cells], errors["c"]))
    stick = np.abs(x[sheared.status == 1]).max()
    slip = np.abs(x[sheared.status >= 2]).min()
    study.add(GROUP, "Cattaneo-Mindlin, Q = mu P'/2", "outermost sticking, innermost slipping node",
              c, f"{stick:.5f}, {slip:.5f}",
              max(abs(stick - c), abs(slip - c)) / c, 0.1 if study.quick else 0.05)
    study.charts.append(Chart("line-contact", "Line contact: error of half-widths against cells", "cells",
                              "relative error", {"a": (cells, errors["a"]), "c": (cells, errors["c"])}, True))


def run(study):
    ssnv128(study)
    ssnv128_in_time(study)
    threshold(study)
    line_contact(study)
