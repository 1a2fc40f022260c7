# SPDX-License-Identifier: GPL-2.0-or-later
"""An elastic bar on a rigid wall (the data of Doyen, Ern and Piperno, SIAM J. Sci. Comput. 33, 223,
2011, from the moment of contact): E = 900, rho = 1, length 10, speed 10. Contact lasts 2 L/c with the
stress |v0| sqrt(E rho), then the bar leaves at |v0| without deformation."""
from pathlib import Path

import numpy as np
from scipy.integrate import trapezoid

from harness import Chart, Run

HERE = Path(__file__).resolve().parent
GROUP = "unilateral dynamics"
SPEED, LENGTH, WAVE, STRESS = 10.0, 10.0, 30.0, 300.0


def bounce(study, cells, **sets):
    """The node that hits loses its energy, half a cell's: 1/(4 cells) of what the ledger counts (the
    bar's energy before and after); SDIRK2 damps as much again of the jump's shortest waves."""
    step = 0.1 / cells
    run = Run(study, HERE / "impact.yaml", "impact", {
        "mesh.set": f"{{length: 0.5, height: 10, nx: 1, nz: {cells}}}",
        "time.step_max": step, "time.step_min": step, **sets}, ledger=0.7 / cells)
    t = run["time"]
    pressure = run["pressure"].astype(float) @ run["weight"] / run["weight"].sum()
    pressed = np.nonzero(pressure > 0.1 * STRESS)[0]
    duration = float(t[pressed[-1]]) if len(pressed) else np.inf
    middle = (t > 0.1 * duration) & (t < 0.8 * duration)
    _, points, _, v = list(run.frames())[-1]
    side = points[:, 0] == 0
    order = np.argsort(points[side, 1])
    mean = trapezoid(v[side, 1][order], points[side, 1][order]) / LENGTH
    return {"duration": duration, "stress": float(pressure[middle].mean()) if middle.any() else 0.0,
            "speed": float(mean), "t": t, "pressure": pressure,
            "impulse": float(trapezoid(pressure, t))}


def run(study):
    cells = [25, 50, 100] if study.quick else [50, 100, 200, 400]
    results = [bounce(study, n) for n in cells]
    exact = {"duration": 2 * LENGTH / WAVE, "stress": STRESS, "speed": SPEED,
             "impulse": 2 * SPEED * LENGTH}
    texts = {"duration": "duration of contact 2 L/c", "stress": "contact stress v0 sqrt(E rho)",
             "speed": "mean speed after the rebound", "impulse": "impulse 2 rho L v0"}
    limits = {"stress": 1e-3, "speed": 2e-2, "impulse": 5e-3}
    # A scheme of order 2 carries a jump with an error over a width of about h^(2/3) (Hedstrom, Math.
    # Comp. 29, 1975), and so do means over it: the least that speed and impulse may converge with.
    # The stress of the plateau is a mean away from the jumps and better than that. The end of contact
    # falls between two steps, early or late: its error is no power of h, and it is asked to be within
    # the width of the jump, (h/L)^(2/3) of a crossing.
    curves = {}
    for name, value in exact.items():
        errors = [abs(r[name] / value - 1) for r in results]
        order = np.log(errors[0] / errors[-1]) / np.log(cells[-1] / cells[0])
        curves[name] = ([1 / n for n in cells], [max(e, 1e-16) for e in errors])
        case = f"bar on a wall, {cells[-1]} cells"
        if name == "duration":
            study.add(GROUP, case, texts[name], value, results[-1][name], errors[-1],
                      0.5 * cells[-1] ** (-2 / 3), note="within half of the jump's width (h/L)^(2/3)")
        else:
            study.add(GROUP, case, texts[name], value, results[-1][name], errors[-1], limits[name],
                      order="2/3 or more expected", seen=order, least=0.6)
    fine = results[-1]
    study.charts.append(Chart("Bar on a wall: contact stress, first steps left out", "t", "stress",
                              {f"{cells[-1]} cells": (fine["t"][10:], fine["pressure"][10:]),
                               "exact": ([0, 0, 2 / 3, 2 / 3, 1], [0, 300, 300, 0, 0])}))
    study.control(GROUP, "glued-contact", "nodes in contact pull", rebound)
    study.control(GROUP, "stage-matrix", "K counted twice in the matrix of a stage", rebound)


def rebound(study):
    """Duration and speed on a coarse bar."""
    result = bounce(study, 50)
    for name, value, allowed in (("duration", 2 * LENGTH / WAVE, 0.02), ("speed", SPEED, 0.03)):
        study.add(GROUP, "bar on a wall, 50 cells", name, value, result[name],
                  abs(result[name] / value - 1), allowed)
