# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons stability` against the exact growth rates of a sheared column, and against time stepping.

(A rigid block has no row here: the path of `stability` is led by a rod, which holds a rigid block;
its growth rate is measured by time stepping, see instability.py.)"""
import json
from pathlib import Path

import numpy as np

from exact.instability import critical_exact, exact_root, exact_root_near
from harness import PROGRAM, SOURCE, Chart, Control, Row, Run, call, observed_order, settings

HERE = Path(__file__).resolve().parent
GROUP = "growth rates"

# The friction coefficient at which the column slips. Its shear is p times this; on the two ends of
# the base it leaves a couple, which no endless layer has and which shifts the pressure by as much.
MU, V_C = 4e-4, 1e-6


class Stability:
    """`amontons stability`: its numbers in .results and .points."""

    def __init__(self, study, scene, name, sets, *words):
        folder = study.new_folder(name)
        call([PROGRAM, "stability", scene, "-q", "-o", folder, *words, *settings(sets)])
        report = json.loads((folder / "stability.json").read_text())
        self.results, self.points = report["results"], report["points"]


# --- a sheared column, slipping everywhere, V -> 0 ------------------------------------------------

def column_root(study, w, cells):
    """The fastest s once the whole base slips; w = (mu_S - mu_K) p/v_c."""
    ours = Stability(study, HERE / "column.yaml", "column", {
        "load.tractions": f"[{{group: contact, x: 0, z: {-w * V_C / MU}}}]",
        "friction.mu_static": MU, "friction.critical_velocity": V_C, "start.velocity_x": 0,
        "rod.velocity": 1e-3 * V_C, "mesh.set": f"{{width: {1 / cells}, nx: 1, nz: {cells}}}",
    }, "--from", "start", "--whole")
    last = ours.points[-1]
    return complex(last["rate_re"], last["rate_im"]) if last["slipping"] == 2 else complex("nan")


def column(study):
    cells = 32
    for w, text in ((0.03, "decaying oscillation"), (0.2, "growing oscillation"),
                    (0.5, "growing fast"), (0.65, "near the critical threshold")):
        exact, ours = exact_root(w, 0.05), column_root(study, w, cells)
        study.add(GROUP, f"shear column, {cells} cells, w = {w:g}, {text}", "s = Re + i Im",
                  f"{exact:.5f}", f"{ours:.5f}", abs(ours - exact) / abs(exact), 1e-2)
    wrong = exact_root(0.2, 0.1)
    ours = column_root(study, 0.2, cells)
    study.controls.append(Control(GROUP, "`stability`: shear viscosity eta1 in place of eta1/2", Row(
        GROUP, "shear column", "s", "", "", abs(ours - wrong) / abs(wrong), 1e-2)))
    if not study.quick:
        column_order(study)
        thresholds(study)


def column_order(study):
    exact, cells = exact_root(0.5, 0.05), [8, 16, 32]
    errors = [abs(column_root(study, 0.5, n) - exact) / abs(exact) for n in cells]
    order = observed_order([1 / n for n in cells], errors)
    study.add(GROUP, "shear column, w = 0.5", "order of s in the mesh, 8, 16, 32 cells", 2,
              ", ".join(f"{e:.1e}" for e in errors), max(0, 2 - order), 0.2,
              order="2 expected", seen=order, least=1.8)
    study.charts.append(Chart("growth-rate-stability", "Shear column, `stability`: error of s", "h / H",
                              "relative error", {"Q4": ([1 / n for n in cells], errors)}, True))


def thresholds(study):
    """Re s goes through 0 at the subcritical one, (Im s)^2 at the critical one; linear between two."""
    low, high = 0.0, 0.3
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if exact_root_near(middle) < 0 else (low, middle)
    ws = [0.04, 0.06]
    rates = [column_root(study, w, 32).real for w in ws]
    ours = ws[0] - rates[0] * (ws[1] - ws[0]) / (rates[1] - rates[0])
    study.add(GROUP, "shear column", "subcritical threshold of w", low, ours, abs(ours / low - 1), 1e-2)
    ws = [0.66, 0.67]
    squares = [column_root(study, w, 32).imag ** 2 for w in ws]
    ours = ws[0] - squares[0] * (ws[1] - ws[0]) / (squares[1] - squares[0])
    exact = critical_exact()
    study.add(GROUP, "shear column", "critical threshold of w", exact, ours, abs(ours / exact - 1), 1e-2)


# --- Figure 1 -------------------------------------------------------------------------------------

SLIDINGS = 2   # both commands start from the rest after the second sliding


def figure_settings(cells, **more):
    """The rod at a tenth of the paper's V: l_c is a question about V -> 0."""
    return {"mesh.set.nx": cells, "mesh.set.nz": cells, "rod.velocity": 1e-6,
            "time.until": "{U: 0.0072}", "output.figures": "[]", "output.fields": "none", **more}


def figure_1(study):
    """l_sc, l_c and mu_M of one sliding, by growth rates and by time stepping."""
    scene = SOURCE / "validation/paper/fig1.yaml"
    apart = []
    for cells in (20,) if study.quick else (20, 40):
        found = Stability(study, scene, "fig1-growth", figure_settings(cells)).results
        run = Run(study, scene, "fig1", figure_settings(cells), energy=2e-2)
        peak, name = run.report["results"]["peaks"][SLIDINGS], f"Figure 1, {cells} x {cells}"
        # Both know the front to one node only, and so no better than by one element.
        for quantity, key, other in (
                ("l_c/L at V: front before the leading rapid precursor", "l_c_at_V_over_L", "l_c_over_L"),
                ("l_c/L, V -> 0: first real growth in the run's scan", "l_c_over_L", "l_c_growth_over_L"),
                ("l_sc/L: certificate lost", "l_sc_certificate_over_L", "l_sc_over_L")):
            study.add(GROUP, name, quantity, peak[other], found[key], abs(found[key] - peak[other]),
                      1.01 / cells, note="consistency: reference is our time stepping; "
                      "error absolute, one element allowed")
        apart.append(abs(found["l_c_at_V_over_L"] - peak["l_c_over_L"]))
        early = found["l_sc_certificate_over_L"] - found["l_sc_over_L"]
        study.add(GROUP, name, "l_sc/L: the certificate is lost before anything grows",
                  f"at most {found['l_sc_over_L']:.4f}", found["l_sc_certificate_over_L"],
                  max(0, early), 0)
        # One element is 1/cells of l; mu rises with l by about (mu_S - mu_K) dl/L.
        study.add(GROUP, name, "mu_M at V", peak["mu"], found["mu_M"], abs(found["mu_M"] - peak["mu"]),
                  0.28 / cells, note="consistency: reference is our time stepping; error absolute, "
                  "one element's (mu_S - mu_K)/cells allowed")
    wrong = Stability(study, scene, "fig1-wrong", figure_settings(20, **{
        "load.pressure": 0.009, "time.until": "{U: 0.025}"})).results
    off = abs(wrong["l_c_at_V_over_L"] - peak["l_c_over_L"])
    study.controls.append(Control(GROUP, "growth rates at three times the pressure", Row(
        GROUP, "Figure 1", "l_c/L", "", "", off, 1.01 / 20)))
    if not study.quick:
        study.add(GROUP, "Figure 1", "l_c/L at V from `stability` and from time stepping, 20 and 40 cells",
                  "closer", ", ".join(f"{a:.4f}" for a in apart), apart[1] / apart[0], 1)


def run(study):
    column(study)
    figure_1(study)
