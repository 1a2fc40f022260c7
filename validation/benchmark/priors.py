#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What is usual from mesh to mesh? Chooses what src/record/error_bars.c takes for granted before it knows better.

    validation/benchmark/priors.py [--cases NUMBER] [--known PRIORS.MD] [-o FOLDER]

Cases are those before the first of promise.py, so that its test is made on others. On each mesh a case is run at pressures
0.5 % below and above; the mean is the mesh's value. References are promise.py's. With values and reference known, bars by
any constants follow without a run: how many hold the reference, how far the worst is off, how wide they are.

--cases: the first so many (default: those of the page alone). --known: a page of an earlier version, whose rows are taken
as they are (default priors.md beside this file). Every run is kept in FOLDER/priors.jsonl (default results/priors): the same
command goes on where it was stopped. Leaves priors.md in FOLDER. A case takes a minute or two."""
import argparse
import math
import re
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy

from measured_run import ROOT, commit, markdown_table, run
from promise import FIRST, QUIET, WINDOW, Kept, case, flow, reference, scene_mesh

CELLS_BLOCK, REFINE_PADS = (20, 28, 40, 57, 80), (0.25, 0.35, 0.5, 0.7, 1, 1.42)
# scatter, slope: in parts of mu, over the nodes in contact; levels: so many it would be worth to know the scatter
TRIED = {"blocks": ((0.12, 0.08, 8), (0.10, 0.08, 8), (0.14, 0.08, 8), (0.12, 0.05, 8), (0.12, 0.12, 8), (0.12, 0.08, 4),
                    (0.12, 0.08, 16), (0.12, math.inf, 8)),
         "pads and grooves": ((0.7, 0.5, 8), (0.7, 0.4, 8), (0.5, 0.5, 8), (0.6, 0.5, 8), (0.6, 0.6, 8), (0.7, 0.3, 8),
                              (0.7, 0.5, 4))}
LEVELS = (3, 4, 5)        # the coarsest so many of each case
STEPS = 0.002             # as in error_bars.c
CELLS_ENOUGH = 8          # as in src/record/drops.h
CELLS = (0, 4, 6, 8, 10, 14, 20, 30, 80)     # that slip; bounds of the table's rows
STUDENT = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.20, 2.18, 2.16, 2.14, 2.13, 2.12, 2.11, 2.10)


@dataclass(frozen=True)
class Known:
    number: int
    name: str
    mu: float              # reference
    own: float             # its own error, of mu
    slip: float            # cells that slip before it turns fast, over contact nodes, on one of the meshes; NaN: not known
    values: dict           # contact nodes -> mu_M, mean of two pressures


def known_rows(path):
    """Rows of a page, by number."""
    found = re.findall(r"^\| (\d+) \| ([AB],.*?) \| ([\d.]+) \| ([\d.]+) \| ([\d.]*) \| (.*?) \|$",
                       path.read_text(), re.M) if path.exists() else []
    return {int(number): Known(int(number), name, float(mu), float(own) / 100, float(slip or "nan"),
                               {int(nodes): float(value) for nodes, value in re.findall(r"(\d+): ([\d.]+)", values)})
            for number, name, mu, own, slip, values in found}


def meshes(one):
    if one.is_block:
        return [one.mesh | {"nx": cells, "nz": cells} for cells in CELLS_BLOCK]
    return [scene_mesh(one) | {"refine": refine} for refine in REFINE_PADS]


def mesh_value(one, mesh):
    """{"mu": mean or None, "nodes"}"""
    values, nodes = [], 0
    for factor in (WINDOW[0], WINDOW[-1]):
        ended = run(one.scene, [*QUIET, *one.settings, flow(mesh), f"load.pressure={one.pressure * factor:.9g}",
                                f"time.until={{U: {one.way:.6g}}}"], 600)
        values.append(ended.report.get("results", {}).get("mu_M"))
        nodes = ended.report.get("model", {}).get("contact_nodes", 0)
        cells = ended.report.get("results", {}).get("slip_cells")
    return {"mu": None if None in values else statistics.mean(values), "nodes": nodes, "slip": cells and cells / nodes}


def computed(number, kept):
    """None: no bulk sliding, or a run failed."""
    one = case(number)
    truth = reference(one, kept)
    if truth is None:
        return None
    rows = [kept.obtain(one, flow(mesh), lambda m=mesh: mesh_value(one, m)) for mesh in meshes(one)]
    slips = [row["slip"] for row in rows if row["slip"]]
    return Known(number, one.name, truth[0], truth[1] / truth[0], statistics.median(slips) if slips else math.nan,
                 {row["nodes"]: row["mu"] for row in rows if row["mu"]})


def limit(row, nodes, scatter, slope, levels):
    """(value, bar) of generalised least squares, as error_bars.c finds them another way: here b is no unknown but part of
    the covariance (slope infinite: 1e3)."""
    over, values = 1 / numpy.array(nodes, float), [row.values[n] for n in nodes]
    off = numpy.array(values) / values[-1] - 1
    few = numpy.ones(len(nodes))
    if case(row.number).is_block and row.slip > 0:
        few = numpy.maximum(CELLS_ENOUGH * over / row.slip, 1)
    inverse = numpy.linalg.inv(numpy.diag((scatter * few * over) ** 2) + min(slope, 1e3) ** 2 * numpy.outer(over, over))
    variance = 1 / inverse.sum()
    a = variance * (inverse @ off).sum()
    freedoms = len(nodes) - 1 + levels
    wider = ((off - a) @ inverse @ (off - a) + levels) / freedoms
    value = values[-1] * (1 + a)
    return value, max(values[-1] * STUDENT[min(freedoms, len(STUDENT)) - 1] * math.sqrt(variance * wider), STEPS * value)


def is_resolved(row, nodes):
    """Whether a bar may count as met on so many contact nodes."""
    return not case(row.number).is_block or not row.slip * nodes < CELLS_ENOUGH


def score(rows, count, constants):
    """Of the `count` coarsest levels: cells of the table."""
    ratios, bars, misses = [], [], []
    for row in rows:
        value, bar = limit(row, sorted(row.values)[:count], *constants)
        ratios.append(abs(value - row.mu) / bar)
        bars.append(100 * bar / row.mu)
        misses.append(100 * abs(value / row.mu - 1))
    return [f"{sum(ratio <= 1 for ratio in ratios)} of {len(rows)}", f"{max(ratios):.2f}", f"{statistics.median(ratios):.2f}",
            f"{statistics.median(misses):.2f}", f"{statistics.median(bars):.2f}", f"{numpy.quantile(bars, 0.9):.2f}"]


def scatter_text(rows):
    """Root mean square of (value / reference - 1) nodes, by the cells that slip before it turns fast."""
    table = []
    for low, high in zip(CELLS, CELLS[1:]):
        cells = [f"{low} to {high}"]
        for block in (True, False):
            off = [nodes * (value / row.mu - 1) for row in rows if case(row.number).is_block == block
                   for nodes, value in row.values.items() if low <= row.slip * nodes < high]
            cells += [str(len(off)), f"{math.sqrt(statistics.mean(x * x for x in off)):.2f}" if off else ""]
        table.append(cells)
    return markdown_table(["cells that slip", "meshes of blocks", "scatter", "meshes of pads and grooves", "scatter"], table)


def text_of(rows):
    parts = ["### By resolution\n\n" + scatter_text(rows)]
    for kind, tried in TRIED.items():
        mine = [row for row in rows if case(row.number).is_block == (kind == "blocks")]
        table = []
        for count in LEVELS:
            enough = [row for row in mine if len(row.values) >= count and is_resolved(row, sorted(row.values)[count - 1])]
            table += [[str(count), *(f"{part:g}" for part in constants), *score(enough, count, constants)] for constants in tried]
        parts.append(f"### {kind.capitalize()}\n\n" + markdown_table(
            ["meshes", "scatter", "slope", "worth levels", "bars that hold", "worst error, bars", "median error, bars",
             "median error, %", "median bar, %", "9 of 10 bars below, %"], table))
    every = markdown_table(["number", "case", "mu_M", "own error, %", "slip, of the nodes", "contact nodes: mu_M"],
                           [[str(row.number), row.name, f"{row.mu:.4f}", f"{100 * row.own:.2f}", f"{row.slip:.3f}" if row.slip > 0 else "",
                             ", ".join(f"{nodes}: {value:.5f}" for nodes, value in sorted(row.values.items()))] for row in rows])
    return (f"## What is usual from mesh to mesh?\n\nVersion {commit()}. `scatter`, `slope`: in parts of mu, over the nodes in "
            "contact. `worth levels`: how many levels it is worth to know the scatter. Errors and bars are those of meshes alone, "
            "without branches and drops, on a last mesh that resolves slip. error_bars.c takes 0.12 and 0.08 for one contact, 0.7 and "
            "0.5 for several, worth 8 levels: about the shortest bars of which 19 of 20 hold, all numbers of meshes together.\n\n" + "\n\n".join(parts)
            + "\n\n### Cases\n\n" + every)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/priors")
    parser.add_argument("--cases", type=int, default=0)
    parser.add_argument("--known", type=Path, default=Path(__file__).with_name("priors.md"))
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    kept, known = Kept(options.output / "priors.jsonl"), known_rows(options.known)
    for number in range(min(options.cases, FIRST)):
        row = known.get(number) or computed(number, kept)
        if row:
            known[number] = row
            print(number, row.name, flush=True)
    rows = [known[number] for number in sorted(known)]
    (options.output / "priors.md").write_text(text_of(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
