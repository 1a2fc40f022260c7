# SPDX-License-Identifier: GPL-2.0-or-later
"""Speeds of pulses in a nearly elastic block against c_L, c_S and c_R, plane stress and plane strain.
The viscosity that is left smooths what the mesh cannot carry; it broadens a front, evenly to both
sides, and does not delay it."""
from pathlib import Path

import numpy as np

from harness import Run, observed_order

HERE = Path(__file__).resolve().parent
GROUP = "wave speeds"
NU, TRACTION = 0.34, 0.003


def closed_forms(plane):
    """c_L, c_S, c_R for E = rho = 1."""
    modulus = 1 / (1 - NU**2) if plane == "stress" else (1 - NU) / ((1 + NU) * (1 - 2 * NU))
    c_l, c_s = np.sqrt(modulus), np.sqrt(1 / (2 * (1 + NU)))
    low, high = 0.5 * c_s, 0.9999 * c_s
    for _ in range(60):
        c = (low + high) / 2
        left = (2 - (c / c_s) ** 2) ** 2
        right = 4 * np.sqrt(1 - (c / c_l) ** 2) * np.sqrt(1 - (c / c_s) ** 2)
        low, high = (c, high) if left < right else (low, c)
    return {"c_L": c_l, "c_S": c_s, "c_R": low}


def front_speed(study, plane, name, exact, cells):
    """Behind the front of a traction put on at once stands the velocity sigma/(rho c): its half is
    followed from a quarter of the column to seven eighths. The ledger misses what the integrator
    damps of waves shorter than its steps, 1 %."""
    scene, component = {"c_L": ("wave.yaml", 1), "c_S": ("shear_wave.yaml", 0)}[name]
    step = 0.5 / cells
    run = Run(study, HERE / scene, f"front-{name}", {
        "mesh.set": f"{{length: {2 / cells}, height: 1, nx: 2, nz: {cells}}}",
        "material.plane": plane, "material.eta1": 2e-3, "material.eta2": 0,
        "time.until.t": 0.9 / exact, "time.step_max": step, "time.step_min": step,
        "output.fields": "{every_t: 0.05}", "reduction.use": "never"}, ledger=2e-2)
    times, places, half = [], [], TRACTION / exact / 2
    for t, x, _, v in run.frames():
        side = np.nonzero(x[:, 0] == 0)[0]
        side = side[np.argsort(x[side, 1])]
        speed, z = np.abs(v[side, component]), x[side, 1]
        k = int(np.argmax(speed > half))
        depth = 1 - np.interp(half, speed[k - 1:k + 1], z[k - 1:k + 1]) if k else 0
        if 0.25 < depth < 0.85:
            times.append(t)
            places.append(depth)
    return float(np.polyfit(times, places, 1)[0])


def surface_speed(study, plane, cells):
    """Lamb's problem: after a strip is loaded at once, the velocity along the surface has a pulse of
    the strip's shape that runs with c_R. Its middle, between its two half heights, is followed."""
    run = Run(study, HERE / "surface_wave.yaml", "surface", {
        "mesh.set.cells": cells, "material.plane": plane, "time.step_max": 0.2 / cells,
        "time.step_min": 0.2 / cells}, ledger=1e-2)
    times, places = [], []
    for t, x, _, v in run.frames():
        top = np.nonzero(x[:, 1] == 1)[0]
        top = top[np.argsort(x[top, 0])]
        x, v = x[top, 0], v[top, 0]
        k = int(np.argmax(np.abs(v)))
        v = v / v[k] if v[k] else v
        low, high = k, k
        while low > 0 and v[low] > 0.5:
            low -= 1
        while high < len(v) - 1 and v[high] > 0.5:
            high += 1
        if v[k] == 0 or low == 0:
            continue
        middle = (np.interp(0.5, v[low:low + 2], x[low:low + 2]) +
                  np.interp(0.5, v[[high, high - 1]], x[[high, high - 1]])) / 2
        if 0.4 < middle < 0.9:
            times.append(t)
            places.append(middle)
    return float(np.polyfit(times, places, 1)[0])


def run(study):
    for plane in ("stress", "strain"):
        exact = closed_forms(plane)
        for name in ("c_L", "c_S"):
            ours = front_speed(study, plane, name, exact[name], 200)
            study.add(GROUP, f"front in a column, plane {plane}", name, exact[name], ours,
                      abs(ours / exact[name] - 1), 1e-4)
        if study.quick and plane == "strain":
            continue
        # The pulse has edges: its place is known to first order in the cell. c_R is 8 % below c_S.
        cells = [40] if study.quick else [20, 40, 80]
        speeds = [surface_speed(study, plane, n) for n in cells]
        errors = [abs(s / exact["c_R"] - 1) for s in speeds]
        order = {} if study.quick else {
            "order": "1 expected", "seen": observed_order([1 / n for n in cells], errors), "least": 0.8,
            "note": "error with 20, 40, 80 cells: " + ", ".join(f"{e:.1e}" for e in errors)}
        study.add(GROUP, f"pulse along a free surface, plane {plane}, {cells[-1]} cells", "c_R",
                  exact["c_R"], speeds[-1], errors[-1], 2e-2 if study.quick else 1e-2, **order)
    study.control(GROUP, "wrong-plane", "moduli of plane strain in plane stress and the reverse", planes)


def planes(study):
    """c_L and c_R of both planes on coarse meshes: what a wrong modulus must be seen on."""
    for plane in ("stress", "strain"):
        exact = closed_forms(plane)
        for name, ours, allowed in (("c_L", front_speed(study, plane, "c_L", exact["c_L"], 200), 1e-3),
                                    ("c_R", surface_speed(study, plane, 40), 1e-2)):
            study.add(GROUP, f"plane {plane}", name, exact[name], ours, abs(ours / exact[name] - 1),
                      allowed)
