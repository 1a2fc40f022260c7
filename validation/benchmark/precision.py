#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Error against work: which mesh, element and tolerance buys what.

    validation/benchmark/precision.py [--quick] [-o FOLDER]

Runs the paper's Figure 1 (set A, L = 1, P = 0.003, U to 0.012) over meshes, step tolerances,
reduction tolerances and wave steps, and compares each with a converged reference, whose own error
is its difference from the next best run. Leaves precision.md and precision.csv in FOLDER (default
results/precision). Work is processor time of the whole run on a shape that is not cached, and
steps. --quick: fewer cases, about two minutes.
"""
import argparse
import csv
import math
import os
import tempfile
from pathlib import Path

import h5py
import numpy

from measured_run import ROOT, commit, markdown_table, run

SCENE = ROOT / "validation/paper/fig1.yaml"
QUIET = ["output.figures=[]", "output.fields=none", "time.until.U=0.012"]
SMOOTH = (2e-4, 1.5e-3)      # U between which nothing slips fast
ELEMENTS = {"Q4": {"shape": "quad", "order": 1}, "Q9": {"shape": "quad", "order": 2},
            "T3": {"shape": "triangle", "order": 1}, "T6": {"shape": "triangle", "order": 2}}
REFERENCE = ("Q9", 64, {"grade_z": 4}, {"time.tolerance": 1e-4, "reduction.tolerance": 1e-3,
                                        "time.wave_step": 0.1})
SECOND = ("Q9", 48, {"grade_z": 4}, REFERENCE[3])   # tells the reference's own error
HEAD = ["case", "nodes", "mu_M", "error of mu_M", "first peak", "slip, L1", "smooth", "steps",
        "cpu s", "front"]


def settings_of(element, cells, grading, keys):
    mesh = {"nx": cells, "nz": cells, "length": 1, "height": 0.5} | ELEMENTS[element] | grading
    words = ", ".join(f"{name}: {value}" for name, value in mesh.items())
    return QUIET + [f"mesh.set={{{words}}}"] + [f"{key}={value}" for key, value in keys.items()]


def compute(case):
    """What a run found: peaks, mu over U, slip over (U, x); and its cost."""
    with tempfile.TemporaryDirectory() as folder:
        ended = run(SCENE, settings_of(*case), 600, into=folder + "/result")
        if ended.status != 0:
            return None
        with h5py.File(f"{folder}/result/history.h5") as history:
            found = {"U": history["series/rod_displacement"][:], "mu": history["series/mu"][:],
                     "x": history["nodes/x"][:], "slip": history["interface/slip"][:]}
    results = ended.report["results"]
    found["peaks"] = [peak["mu"] for peak in results["peaks"]]
    rapid = [event["U_start"] for event in results["events"] if event["kind"] != "quasi-static"]
    found |= {"first_event": rapid[0] if rapid else math.nan,
              "steps": ended.report["steps"]["accepted"], "seconds": ended.seconds,
              "nodes": len(found["x"])}
    found["mu_M"] = numpy.mean(found["peaks"][1:]) if len(found["peaks"]) > 1 else math.nan
    return found


def on_grid(found, U, x):
    """Slip at the times U and places x, linear between."""
    in_space = numpy.array([numpy.interp(x, found["x"], row) for row in found["slip"]])
    return numpy.array([numpy.interp(U, found["U"], column) for column in in_space.T])


def errors_of(found, reference):
    """mu_M and first peak, relative; slip, L1 in space-time up to the first event, relative; mu
    while nothing slips fast, largest, relative."""
    U = numpy.linspace(0, 0.98 * reference["first_event"], 400)
    x = numpy.linspace(0, 1, 161)
    wanted = on_grid(reference, U, x)
    slip = numpy.abs(on_grid(found, U, x) - wanted).sum() / numpy.abs(wanted).sum()
    U = numpy.linspace(*SMOOTH, 100)
    wanted = numpy.interp(U, reference["U"], reference["mu"])
    smooth = numpy.abs(numpy.interp(U, found["U"], found["mu"]) - wanted).max() / wanted.max()
    first = abs(found["peaks"][0] / reference["peaks"][0] - 1) if found["peaks"] else math.nan
    return [abs(found["mu_M"] / reference["mu_M"] - 1), first, slip, smooth]


def cases(quick):
    sizes = {"Q4": (10, 20, 40) if quick else (10, 20, 40, 60, 80), "Q9": (10, 20) if quick else
             (5, 10, 20, 40), "T3": (20, 40), "T6": (10, 20) if quick else (10, 20, 40)}
    listed = [(element, cells, {}, {}) for element, all_cells in sizes.items()
              for cells in all_cells]
    listed += [("Q4", cells, {"grade_z": 4, "nz": cells // 2}, {})
               for cells in ((20, 40) if quick else (20, 40, 80))]
    listed += [("Q9", cells, {"grade_z": 4, "nz": cells // 2}, {})
               for cells in ((20,) if quick else (10, 20, 40))]
    sweeps = {"time.tolerance": (1e-1, 1e-2, 1e-4), "reduction.tolerance": (1e-1, 3e-2, 1e-3),
              "time.wave_step": (1, 0.5, 0.05)}
    listed += [("Q9", 20, {}, {key: value}) for key, values in sweeps.items() for value in values]
    return listed


def name_of(element, cells, grading, keys):
    nz = grading.get("nz", cells)
    graded = f" graded {grading['grade_z']}" if "grade_z" in grading else ""
    changed = "".join(f", {key} {value}" for key, value in keys.items())
    return f"{element} {cells}x{nz}{graded}{changed}"


def orders(rows, all_cases):
    """Observed orders in the cell size, between neighbours of each uniform series."""
    lines = []
    for element in ELEMENTS:
        series = [(case[1], row["errors"]) for case, row in zip(all_cases, rows)
                  if case[0] == element and not case[2] and not case[3] and row]
        for (coarse, before), (fine, after) in zip(series, series[1:]):
            ratio = math.log(fine / coarse)
            lines.append([f"{element} {coarse} to {fine}"] +
                         [f"{math.log(max(a, 1e-12) / max(b, 1e-12)) / ratio:.1f}"
                          for a, b in zip(before, after)])
    return markdown_table(["cells", "mu_M", "first peak", "slip", "smooth"], lines)


def is_on_front(row, rows):
    """No other run is both cheaper and better in mu_M and slip."""
    return not any(other and other["seconds"] < row["seconds"] and
                   max(other["errors"][0], 1e-3) <= max(row["errors"][0], 1e-3) and
                   other["errors"][2] < row["errors"][2] for other in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/precision")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    os.environ["AMONTONS_CACHE"] = ""
    best, second = (REFERENCE, SECOND) if not options.quick else (
        ("Q9", 32, *REFERENCE[2:]), ("Q9", 24, *REFERENCE[2:]))
    reference, other = compute(best), compute(second)
    own = errors_of(other, reference)
    print(f"reference {name_of(*best)}: mu_M {reference['mu_M']:.5f}; the second best differs by "
          + ", ".join(f"{error:.1e}" for error in own), flush=True)
    all_cases, rows = cases(options.quick), []
    for case in all_cases:
        found = compute(case)
        if found:
            found["errors"] = errors_of(found, reference)
            print(f"{name_of(*case)}: mu_M {found['mu_M']:.4f} "
                  + " ".join(f"{error:.1e}" for error in found["errors"])
                  + f" {found['steps']} steps {found['seconds']:.2f} s", flush=True)
        rows.append(found)
    lines = [[name_of(*case), row["nodes"], f"{row['mu_M']:.4f}",
              *(f"{error:.1e}" for error in row["errors"]), row["steps"], f"{row['seconds']:.2f}",
              "yes" if is_on_front(row, rows) else ""] if row else
             [name_of(*case), "failed"] + [""] * 8 for case, row in zip(all_cases, rows)]
    options.output.mkdir(parents=True, exist_ok=True)
    text = (f"# Error against work\n\nversion {commit()}; reference {name_of(*best)}, mu_M "
            f"{reference['mu_M']:.5f}; {name_of(*second)} differs from it by "
            f"{', '.join(f'{error:.1e}' for error in own)} (mu_M, first peak, slip, smooth), all "
            f"errors relative.\n\n" + markdown_table(HEAD, lines)
            + "\n\nObserved orders in the cell size:\n\n" + orders(rows, all_cases) + "\n")
    (options.output / "precision.md").write_text(text)
    with open(options.output / "precision.csv", "w", newline="") as file:
        csv.writer(file).writerows([HEAD, *lines])
    print(f"{options.output}/precision.md")


if __name__ == "__main__":
    main()
