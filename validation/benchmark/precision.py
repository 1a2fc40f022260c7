#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Error against work: which mesh, element, scheme and tolerance buys what.

    validation/benchmark/precision.py [--quick] [-o FOLDER]

Set A, L = 1, at P = 0.006 (at the paper's 0.003 two periodic branches lie 3 % apart and errors
between them say nothing), U to 0.06: some twenty slidings, whose peaks scatter by a per cent.
Errors, all relative: mu_M (mean of the peaks that count), the first peak, l_c of `amontons stability`, the slip map (L1 in space and
time up to the first sliding, over the slip it ends with) and mu while nothing slips fast
(`smooth`).

  space     meshes and elements against the finest two runs, whose difference is the reference's
            error
  time      tolerances against SDIRK2 at 1e-7 on the same mesh
  explicit  central differences at their stable step, on the two meshes that bear waiting for
  rest      reduction tolerance against the full path; the step allowed while waves are resolved

Work is processor time of the whole run on a shape that is not cached, and steps. Leaves
precision.md, precision.csv and figures in FOLDER (default results/precision). --quick: fewer cases,
about a minute."""
import argparse
import csv
import json
import math
import os
import re
import subprocess
import tempfile
from pathlib import Path

import h5py
import numpy

from figure import MU, draw_page, fitted_exponent
from measured_run import PROGRAM, ROOT, commit, markdown_table, run

SCENE = ROOT / "validation/paper/fig1.yaml"
QUIET = ["output.figures=[]", "output.fields=none", "load.pressure=0.006", "time.until.U=0.06"]
SPEED = 1e-5                 # V
SMOOTH = (2e-4, 3e-3)        # U between which nothing slips fast
SLIPS = 800                  # instants at which slip is compared
ELEMENTS = {"Q4": "shape: quad, order: 1", "Q8": "shape: quad, order: 2, incomplete: 1",
            "Q9": "shape: quad, order: 2", "T3": "shape: triangle, order: 1",
            "T6": "shape: triangle, order: 2"}
ERRORS = ("mu_M", "first peak", "l_c", "slip", "smooth")
FINE = {"time.tolerance": 5e-4}
TIGHT = {"time.tolerance": 1e-7, "time.wave_step": 0.05}


def mesh(element, nx, nz=None, grade=1):
    return (f"mesh.set={{length: 1, height: 0.5, nx: {nx}, nz: {nz or nx}, grade_z: {grade}, "
            f"{ELEMENTS[element]}}}")


def critical_length(mesh_words, folder):
    """l_c on the way from rest, as `amontons stability` has it; NaN: none."""
    words = [str(PROGRAM), "stability", str(SCENE), "--quiet", "--from", "start", "-o",
             f"{folder}/stability", "--set", "load.pressure=0.006", mesh_words]
    ended = subprocess.run(words, capture_output=True, text=True)
    if ended.returncode != 0:
        return math.nan
    found = json.loads(Path(folder, "stability", "stability.json").read_text())["results"]
    return found["l_c_over_L"] if found["l_c_over_L"] is not None else math.nan


def compute(mesh_words, keys=(), with_length=False):
    """What a run found (peaks, mu over U, slip over U and x) and its cost; None: it failed."""
    settings = QUIET + [mesh_words] + [f"{key}={value}" for key, value in dict(keys).items()]
    with tempfile.TemporaryDirectory() as folder:
        os.environ["AMONTONS_CACHE"] = f"{folder}/cache"   # empty now: the run is the shape's first
        ended = run(SCENE, settings, 900, into=folder + "/result")
        if ended.status != 0:
            print(f"  {settings[-2:]}: {ended.said[-160:]}", flush=True)
            return None
        with h5py.File(f"{folder}/result/history.h5") as history:
            found = {"U": history["series/rod_displacement"][:], "mu": history["series/mu"][:],
                     "x": history["nodes/x"][:], "slip": history["interface/slip"][:],
                     "rate": history["interface/slip_rate"][:]}
        found["l_c"] = critical_length(mesh_words, folder) if with_length else math.nan
    results, steps = ended.report["results"], ended.report["steps"]
    peaks = [peak["mu"] for peak in results["peaks"]]
    counted = [peak["mu"] for peak in results["peaks"] if peak["counts"]]
    rapid = [event["U_start"] for event in results["events"] if event["kind"] == "leading rapid"]
    scatter = numpy.std(counted, ddof=1) if len(counted) > 1 else math.nan
    return found | {"mu_M": results["mu_M"] or math.nan, "mu_M error": scatter / len(counted) ** 0.5,
                    "peak": peaks[0] if peaks else math.nan,
                    "slides": rapid[0] if rapid else math.nan, "steps": steps["accepted"],
                    "solves": max(steps["contact_solves"], steps["accepted"]),
                    "seconds": ended.seconds, "nodes": len(found["x"])}


def on_grid(found, U, x):
    """Slip at the times U and places x: cubic (by slip and slip rate) in time, linear in space."""
    after = numpy.clip(numpy.searchsorted(found["U"], U), 1, len(found["U"]) - 1)
    length = found["U"][after] - found["U"][after - 1]
    s = ((U - found["U"][after - 1]) / length)[:, None]
    h = length[:, None]
    old, new = found["slip"][after - 1], found["slip"][after]
    rate_old, rate_new = (found["rate"][k] / SPEED * h for k in (after - 1, after))
    at_nodes = (old * (1 + 2 * s) * (1 - s) ** 2 + rate_old * s * (1 - s) ** 2
                + new * s ** 2 * (3 - 2 * s) + rate_new * s ** 2 * (s - 1))
    return numpy.array([numpy.interp(x, found["x"], row) for row in at_nodes])


def errors_of(found, reference):
    """In the order of ERRORS."""
    U, x = numpy.linspace(0, 0.99 * reference["slides"], SLIPS), numpy.linspace(0, 1, 161)
    wanted = on_grid(reference, U, x)
    late = numpy.abs(wanted[-1]).sum() * SLIPS   # as if it had slipped so far all the time
    slip = numpy.abs(on_grid(found, U, x) - wanted).sum() / late
    U = numpy.linspace(*SMOOTH, 100)
    wanted = numpy.interp(U, reference["U"], reference["mu"])
    smooth = numpy.abs(numpy.interp(U, found["U"], found["mu"]) - wanted).max() / wanted.max()
    single = [abs(found[name] / reference[name] - 1) for name in ("mu_M", "peak", "l_c")]
    return dict(zip(ERRORS, [*single, slip, smooth]))


class Part:
    """One table of the report: rows of cases against a reference."""

    def __init__(self, title, reference, said):
        self.title, self.reference, self.said, self.rows = title, reference, said, []

    def add(self, name, series, size, found):
        errors = errors_of(found, self.reference) if found else None
        self.rows.append((name, series, size, found, errors))
        if found:
            print(f"{name}: " + " ".join(f"{e:.1e}" for e in errors.values())
                  + f" {found['steps']} steps {found['seconds']:.2f} s", flush=True)

    def done(self):
        return [row for row in self.rows if row[3]]

    def on_front(self, row):
        """No other run is cheaper and at least as good in mu_M (to 0.1 %) and better in slip."""
        return not any(other[3]["seconds"] < row[3]["seconds"] and
                       max(other[4]["mu_M"], 1e-3) <= max(row[4]["mu_M"], 1e-3) and
                       other[4]["slip"] < row[4]["slip"] for other in self.done())

    def lines(self):
        for row in self.rows:
            name, _, _, found, errors = row
            if not found:
                yield [name, "failed"] + [""] * (len(ERRORS) + 4)
                continue
            yield [name, found["nodes"], *(f"{e:.1e}" if math.isfinite(e) else "" for e in
                                           errors.values()), found["steps"], found["solves"],
                   f"{found['seconds']:.2f}", "yes" if self.on_front(row) else ""]

    def table(self):
        head = ["case", "nodes", *ERRORS, "steps", "stages", "cpu s", "front"]
        return f"### {self.title}\n\n{self.said}\n\n" + markdown_table(head, self.lines())

    def orders(self, over):
        """Fitted exponents of each series, error ~ size^-order."""
        lines = []
        for series in dict.fromkeys(row[1] for row in self.done() if row[1]):
            members = [row for row in self.done() if row[1] == series]
            line = [series]
            for error in ERRORS:
                pairs = [(row[2], row[4][error]) for row in members if row[4][error] > 0]
                line.append(f"{-fitted_exponent(*zip(*pairs)):.1f}" if len(pairs) > 2 else "")
            lines.append(line)
        return f"Fitted orders in {over}:\n\n" + markdown_table(["series", *ERRORS], lines)


def differs(one, other):
    return ", ".join(f"{name} {error:.1e}" for name, error in errors_of(one, other).items()
                     if math.isfinite(error))


def space_part(quick):
    best, second = (("Q9", 32), ("Q4", 64)) if quick else (("Q9", 80), ("Q4", 128))
    reference = compute(mesh(*best), FINE, True)
    other = compute(mesh(*second), FINE, True)
    said = (f"Reference {best[0]} {best[1]}x{best[1]} at tolerance 5e-4, mu_M = "
            f"{reference['mu_M']:.5f} +- {reference['mu_M error']:.5f}, l_c/L = {reference['l_c']:.4f}; {second[0]} "
            f"{second[1]}x{second[1]} differs from it by {differs(other, reference)}. "
            f"All else as by default. `nodes`: rod.ends = nodes. A slip error above 1: it slides "
            "before the reference does.")
    part = Part("Meshes and elements", reference, said)
    sizes = {"Q4": (10, 20, 40) if quick else (10, 20, 40, 80, 160), "Q9": (10, 20) if quick else
             (5, 10, 20, 40, 80), "Q8": (10, 20, 40), "T3": (20, 40, 80), "T6": (10, 20, 40)}
    if quick:
        sizes = {name: sizes[name][:2] if name in ("Q8", "T3", "T6") else sizes[name]
                 for name in sizes}
    for element, all_cells in sizes.items():
        for n in all_cells:
            part.add(f"{element} {n}x{n}", element, n, compute(mesh(element, n), (), True))
    for element, all_cells in {"Q4": (20, 40, 80), "Q9": (10, 20, 40)}.items():
        for n in all_cells[:1] if quick else all_cells:
            part.add(f"{element} {n}x{n // 2} graded", f"{element} graded", n,
                     compute(mesh(element, n, n // 2, 4), (), True))
    for n in (20, 40) if quick else (10, 20, 40, 80):
        part.add(f"Q4 {n}x{n} nodes", "Q4 nodes", n,
                 compute(mesh("Q4", n), {"rod.ends": "nodes"}, True))
    return part


def time_part(quick):
    where = mesh("Q4", 20 if quick else 40)
    reference = compute(where, TIGHT)
    other = compute(where, TIGHT | {"time.tolerance": 1e-5})
    said = (f"Q4 {20 if quick else 40} cells; reference SDIRK2 at tolerance 1e-7 with waves "
            "resolved in steps of 0.05 L/c; SDIRK2 at 1e-5 differs from it by "
            f"{differs(other, reference)}.")
    part = Part("Step tolerances", reference, said)
    tolerances = (1e-1, 1e-2, 1e-3) if quick else (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5)
    for tolerance in tolerances:
        found = compute(where, {"time.tolerance": tolerance})
        part.add(f"sdirk2, {tolerance:g}", "sdirk2", found["steps"] if found else 0, found)
    return part


def explicit_part(quick):
    """Explicit steps beside the default's on the same meshes."""
    part = Part("Explicit steps", None, "Each against SDIRK2 at 1e-7 on its own mesh. Explicit runs "
                "keep a history of intervals, which the slip map is read from.")
    for cells in (10,) if quick else (10, 20):
        where = mesh("Q4", cells)
        part.reference = compute(where, TIGHT)
        for scheme in ("explicit", "sdirk2"):
            part.add(f"{scheme}, {cells}x{cells}", "", cells,
                     compute(where, {"time.scheme": scheme}))
    return part


def rest_parts(quick):
    where = mesh("Q4", 20 if quick else 40)
    full = compute(where, {"reduction.use": "never"} | FINE)
    reduction = Part("Reduction tolerance", full, "Against the full path, both at tolerance 5e-4.")
    for tolerance in (1e-1, 1e-2) if quick else (3e-1, 1e-1, 3e-2, 1e-2, 1e-3, 1e-4):
        reduction.add(f"{tolerance:g}", "", tolerance,
                      compute(where, {"reduction.tolerance": tolerance} | FINE))
    finest = compute(where, {"time.wave_step": 0.025} | FINE)
    waves = Part("Steps while waves are resolved", finest,
                 "In crossings of the block, against 0.025; tolerance 5e-4.")
    for step in (0.4, 0.2) if quick else (0.8, 0.4, 0.2, 0.1, 0.05):
        waves.add(f"{step:g}", "", step, compute(where, {"time.wave_step": step} | FINE))
    return [reduction, waves]


def drawn(heading, x_label, y_label, x, y):
    """Columns of a table; a curve is of the cases that differ in the mesh's size, or in the tolerance, alone."""
    return heading, x_label, y_label, lambda row: [(re.sub(r" \d+x\d+|, .*", "", row[0]), row[x], row[y])]


FIGURES = {
    "precision-mu": drawn("Meshes and elements", "processor time (s)", f"relative error of {MU}", 9, 2),
    "precision-slip": drawn("Meshes and elements", "processor time (s)", "relative error of slip", 9, 5),
    "precision-smooth": drawn("Meshes and elements", "contact nodes", f"relative error of {MU[:-4]} before fast slip", 1, 6),
    "precision-time": drawn("Step tolerances", "steps", "relative error of the slip map", 7, 5),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/precision")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--draw", type=Path, help="the figures of this precision.md anew, from its tables; nothing is computed")
    options = parser.parse_args()
    if options.draw:
        draw_page(options.draw, FIGURES)
        return
    options.output.mkdir(parents=True, exist_ok=True)
    time = time_part(options.quick)
    rest = [explicit_part(options.quick), *rest_parts(options.quick)]
    space = space_part(options.quick)
    text = (f"## Error against work\n\nVersion {commit()}; set A, P = 0.006, L = 1, U to 0.06. "
            "Errors are relative.\n\n"
            + space.table() + "\n\n" + space.orders("the number of cells") + "\n\n"
            + time.table() + "\n\n" + time.orders("the number of steps") + "\n\n"
            + "\n\n".join(part.table() for part in rest) + "\n\n"
            + "\n".join(f"![{name}](precision-{name}.png)"
                        for name in ("mu", "slip", "smooth", "time")) + "\n")
    (options.output / "precision.md").write_text(text)
    with open(options.output / "precision.csv", "w", newline="") as file:
        writer = csv.writer(file)
        for part in (space, time, *rest):
            writer.writerows([part.title, *line] for line in part.lines())
    draw_page(options.output / "precision.md", FIGURES)
    print(f"{options.output}/precision.md")


if __name__ == "__main__":
    main()
