#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold on a floor that deforms? Ten cases, laid down before anything was computed (ten_cases.py says how).

    validation/bodies/cases.py [--list] [--limit N] [-o FOLDER]

Blocks and pads of set A on a base of Young's modulus 0.2 to 20, as much as three times as high as the block or a quarter of it,
whose nodes match the block's or do not; pressure and the base's numbers are points of Halton sequences. Every run is kept in
FOLDER/cases.jsonl (default validation/bodies) as it ends: the same command goes on where it was stopped. cases.sha256 is the
digest of the list."""
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "validation/benchmark"))
sys.dont_write_bytecode = True
from promise import between, halton, rounded   # noqa: E402
from ten_cases import Case, TenCases   # noqa: E402

SHAPES = ("block", "block", "pads")
RATIOS = (1, 1.3, 1, 0.8, 1)      # cells of the floor to a cell of the contact


def case(number):
    shape, index = SHAPES[number % len(SHAPES)], number + 1
    pressure, young = rounded(between(0.002, 0.012, halton(index, 2))), rounded(between(0.2, 20, halton(index, 3)))
    height, beside = rounded(between(0.125, 1.5, halton(index, 5))), round(halton(index, 7), 2)
    mesh = {"base_height": height, "behind": beside, "before": beside, "ratio": RATIOS[number % len(RATIOS)]}
    name = f"{number}: {shape}, P = {pressure:g}, E_b = {young:g}, H_b = {height:g}"
    settings = (f"materials.base.young={young:g}", f"time.until={{U: {12 * pressure:g}}}")
    if shape == "block":
        return Case(name, HERE / "cases.yaml", settings, pressure, mesh, True)
    feet = {"n": 2 + number % 2, "total_height": 0.5, "pad_height": 0.05, "fill": 0.6, "ends": "open"}
    return Case(name, HERE / "cases.yaml", ("mesh.file=../../meshes/pads.geo", *settings), pressure, feet | mesh, False)


CASES = TenCases(case, graded=True)

if __name__ == "__main__":
    sys.exit(CASES.main(__doc__.splitlines()[0], HERE))
