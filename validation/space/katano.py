#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How far slow slip has come, l/L, against F_x/(mu_S W), by equilibria of sliders of several shapes: what a model whose
friction is one coefficient says before any rate matters. Neither load nor stiffness, v_c or viscosity is in it.

    validation/space/katano.py     # a minute; writes katano-table.md"""
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.dont_write_bytecode = True

from harness import Static, Study, scratch   # noqa: E402

SHAPES = {"100 x 20 x 20 mm": (0.1, 0.02, 0.02), "100 x 20 x 40 mm": (0.1, 0.02, 0.04), "100 x 40 x 20 mm": (0.1, 0.04, 0.02)}
PARTS = (0.3, 0.5, 0.7, 0.9)


def curve(study, length, breadth, height, load):
    """[(F/(mu_S W), l/L)]: l is the area that slips over the breadth."""
    points = [(0.0, 0.0)]
    for k in range(1, 11):
        ours = Static(study, HERE / "katano.yaml", "katano", {
            "mesh.set": f"{{length: {length}, breadth: {breadth}, height: {height}, nx: 30, ny: 6, nz: 6}}", "load.pressure": load,
            "rod.displacement": k * 4e-11 * load * length / 0.1}, slack=10)
        slipping = ours.weight[ours.status != 1].sum() / ours.weight.sum()
        points.append((ours.results["rod_force"] / (0.5 * ours.results["normal_force"]), slipping))
        if slipping >= 1:
            break
    return np.array(points).T


def main():
    study, rows = Study(folder=scratch()), []
    for name, sizes in SHAPES.items():
        for load in (2e5, 5e4):
            force, reach = curve(study, *sizes, load)
            rows.append((name, f"{load / 1e6:g} MPa", *(f"{np.interp(part, force, reach):.2f}" for part in PARTS), f"{force.max():.2f}"))
            print(rows[-1], flush=True)
    lines = ["# A slider of PMMA: how far slow slip has come", "", "Made by `katano.py`; what it means: [katano.md](katano.md).", "", "| slider | pressure | " + " | ".join(f"l/L at {part}" for part in PARTS) + " | largest F_x/(mu_S W) |", "|" + "---|" * 7]
    (HERE / "katano-table.md").write_text("\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n")


if __name__ == "__main__":
    main()
