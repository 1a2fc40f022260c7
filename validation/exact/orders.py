# SPDX-License-Identifier: GPL-2.0-or-later
"""Observed orders: of each element on a manufactured solution (no time), and of the integrator on
stick-slip, where events leave less than the order 2 that smooth problems have."""
from pathlib import Path

import numpy as np

from harness import (PROGRAM, SOURCE, Chart, Control, Row, Run, call, observed_order)

HERE = Path(__file__).resolve().parent
GROUP = "orders"
ELEMENTS = {"T3": ("triangle", 1, 0), "T6": ("triangle", 2, 0), "Q4": ("quad", 1, 0),
            "Q8": ("quad", 2, 1), "Q9": ("quad", 2, 0)}


def manufactured(element, n, layout):
    shape, order, incomplete = ELEMENTS[element]
    done = call([PROGRAM.parent / "amontons_manufactured", SOURCE / "meshes/block.geo",
                 f"shape={shape}", f"order={order}", f"incomplete={incomplete}", f"nx={n}",
                 f"nz={n // 2}", f"layout={layout}"])
    return [float(word) for word in done.stdout.split()]


def in_space(study):
    for layout in ("regular",) if study.quick else ("regular", "free"):
        curves = {}
        for element, (_, order, _) in ELEMENTS.items():
            cells = [8, 16, 32] if study.quick else [8, 16, 32, 64]
            table = np.array([manufactured(element, n, layout) for n in cells])
            sizes = table[:, 0]
            # Serendipity elements lose one order where cells are no parallelograms (Arnold, Boffi
            # and Falk, Math. Comp. 71, 2002).
            order -= element == "Q8" and layout == "free"
            for column, name, expected in ((1, "displacement, L2", order + 1),
                                           (2, "strain energy norm", order)):
                seen = observed_order(sizes, table[:, column])
                study.add(GROUP, f"manufactured solution, {element}, {layout}", name,
                          f"order {expected}", f"error {table[-1, column]:.2e}",
                          max(0, expected - seen), 0.25,
                          order=f"{expected} expected", seen=seen, least=expected - 0.25)
            curves[element] = (sizes, table[:, 1])
        study.charts.append(Chart(f"manufactured-{layout}",
                                  f"Manufactured solution on {layout} meshes: L2 error of u", "h",
                                  "relative error", curves, logarithmic=True))
    first, second = manufactured("T3", 8, "regular"), manufactured("T3", 16, "regular")
    order = np.log(first[1] / second[1]) / np.log(first[0] / second[0])
    study.controls.append(Control(GROUP, "T3 passed off as T6", Row(
        GROUP, "manufactured solution", "order", 3, order, max(0, 3 - order), 0.25)))


def with_events(study):
    """The first peak of F_T/F_N in a stick-slip run, with all step sizes halved again and again. The
    peak is where slip runs away: what remains is not a power of the step but the moment at which a
    step happens to end, so no order is claimed: the steps must matter less than a tenth of the 0.5 %
    to which mu_M is promised."""
    steps, peaks = [], []
    for k in range(5):
        run = Run(study, SOURCE / "validation/paper/fig1.yaml", "fig1", {
            "mesh.set": "{length: 1.0, height: 0.5, nx: 16, nz: 16, shape: quad, order: 1}",
            "time.tolerance": 1, "time.energy_tolerance": 1, "time.step_max": 8 / 2**k,
            "time.wave_step": 0.2 / 2**k, "time.until": "{U: 0.0036}", "output.fields": "none",
            "output.figures": "[]"})
        steps.append(run.report["steps"]["accepted"])
        peaks.append(run.report["results"]["peaks"][0]["mu"])
    spread = max(peaks) / min(peaks) - 1
    study.add(GROUP, "stick-slip, Figure 1 on 16 x 16", "first peak of F_T/F_N, steps halved four times",
              "no change", ", ".join(f"{p:.6f}" for p in peaks), spread, 3e-4,
              note="no order: events; allowed: under a tenth of the 0.5 % promised for mu_M; steps "
              + ", ".join(map(str, steps)))
    study.charts.append(Chart("order-events", "Stick-slip: first peak against steps", "steps",
                              "F_T/F_N", {"SDIRK2": (steps, peaks)}))


def run(study):
    in_space(study)
    if not study.quick:
        with_events(study)
