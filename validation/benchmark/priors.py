#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What is usual from mesh to mesh? Chooses what src/answers/error_bars.c takes for granted before meshes tell.

    validation/benchmark/priors.py [-o FOLDER]

Values on many meshes are kept in priors.jsonl: of the two hundred problems of strangers for tuning (mu_M and mu_hold; their
references), and of 78 cases before the first of promise.py (mu_M; its references). They are those of runs behind bars asked for
2 % on meshes 2^(1/4) finer from one to the next, for 20 and 15 s, by a program that went on when the bar was met; `--to 0.1%`, which
is below what a bar can be, does nearly that. With values and reference known, bars by any constants follow without a run: how
many hold, how far the worst is off, how long they are. Leaves priors.md in FOLDER (default results/priors)."""
import argparse
import json
import math
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy

from measured_run import ROOT, commit, markdown_table

STEPS, END_WAITS, ONE_MESH = 0.002, 3, 0.5      # as in src/record
WANTED = (0.01, 0.02, 0.03)
STUDENT = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.20, 2.18, 2.16, 2.14, 2.13, 2.12, 2.11, 2.10)
CELLS = (0, 4, 8, 16, 32, 1000)     # bounds of the table's rows


@dataclass(frozen=True)
class Constants:
    usual: float = 0.05    # scatter of a mesh and way to the limit, of mu, over the cells that slip where slip turns fast
    least: float = 0.2     # or, where that is more, over the nodes in contact
    slope: float = 1       # the latter over the former
    worth: int = 1         # so many meshes
    span: float = 2         # the finest mesh of a bar that is met is so many times as fine as the coarsest
    meshes: int = 2         # before a bar is met


TRIED = {"now": Constants(), "four meshes, no span": Constants(meshes=4, span=1), "no span": Constants(span=1), "span 1.4": Constants(span=2**0.5),
         "span 1.7": Constants(span=2**0.75), "span 2.4": Constants(span=2**1.25),
         "0.02": Constants(usual=0.02), "0.03": Constants(usual=0.03), "0.04": Constants(usual=0.04), "0.07": Constants(usual=0.07),
         "0 over nodes": Constants(least=0), "0.1 over nodes": Constants(least=0.1), "0.15 over nodes": Constants(least=0.15), "0.3 over nodes": Constants(least=0.3),
         "half the slope": Constants(slope=0.5), "twice the slope": Constants(slope=2),
         "worth 2": Constants(worth=2), "worth 4": Constants(worth=4), "0.1 over nodes alone": Constants(usual=0, least=0.1),
         "0.2 over nodes alone": Constants(usual=0)}


def value_on(problem, mesh):
    return min(mesh["values"]) if problem["answer"] == "mu_hold" else statistics.mean(mesh["values"])


def bar_of(problem, meshes, constants):
    """(value, bar) by generalised least squares, as error_bars.c finds them another way: there the slope is an unknown, here part of
    the covariance."""
    nodes = numpy.array([mesh["nodes"] for mesh in meshes], float)
    values = numpy.array([value_on(problem, mesh) for mesh in meshes])
    usual = max(constants.usual / part_slipping(meshes), constants.least) * values[-1] / nodes
    counts = numpy.array([len(mesh["values"]) for mesh in meshes])
    squares = sum(statistics.pvariance(mesh["values"]) * len(mesh["values"]) for mesh in meshes)
    runs = squares / (counts - 1).sum() / counts if (counts > 1).any() else numpy.zeros(len(meshes))
    waits = numpy.array([mesh["wait"] for mesh in meshes])
    inverse = numpy.linalg.inv(numpy.diag(usual**2 + waits**2 + runs) + constants.slope**2 * numpy.outer(usual, usual))
    variance = 1 / inverse.sum()
    weights = variance * inverse.sum(axis=0)
    value, by_runs = weights @ values, (weights**2 * runs).sum()
    freedoms = len(nodes) - 1 + constants.worth
    wider = ((values - value) @ inverse @ (values - value) + constants.worth) / freedoms
    mesh = STUDENT[min(freedoms, len(STUDENT)) - 1] * math.sqrt(wider * max(variance - by_runs, 0))
    mesh = max(math.hypot(mesh, END_WAITS * waits[-1]), STEPS * value)
    return value, max(math.hypot(mesh, 2 * math.sqrt(by_runs)), abs(value - values[-1]))


def part_slipping(meshes):
    """Of the contact where slow slip turns fast, by all meshes."""
    return sum(max(mesh["cells"], 0.5) for mesh in meshes) / sum(mesh["nodes"] for mesh in meshes)


def asked(problem, wanted, constants):
    """(meshes, value, bar) where a bar is met as the program would; None: the meshes that are known do not. A bar that is short
    enough is put to the test on the first mesh that spans what is asked for."""
    ladder, meshes, far = problem["meshes"], [], 0
    for mesh in ladder:
        if mesh["nodes"] < far:
            continue
        meshes, far = [*meshes, mesh], 0
        if len(meshes) < constants.meshes:
            continue
        value, bar = bar_of(problem, meshes, constants)
        if bar <= wanted * abs(value):
            far = 0.93 * constants.span * meshes[0]["nodes"]       # a node at each end of a contact is no cell
            if mesh["nodes"] >= far:
                return meshes, value, bar
    return None


def judged(problem, meshes, value, bar):
    """|error| / bar; None: the reference is not known well enough, or coarser than the meshes (validation/strangers/judge.py)."""
    error, own = abs(value - problem["mu"]), problem["own"]
    known = own <= bar / 3 or error - 3 * own > bar or error + 3 * own <= bar
    fine = problem["finest"] >= min(meshes[-1]["refine"], 7.5) * (1 - 1e-9)
    return error / bar if known and fine else None


def tried_text(families):
    table = []
    for name, constants in TRIED.items():
        for family, problems in families.items():
            met = [(problem, found) for problem in problems for wanted in WANTED if (found := asked(problem, wanted, constants))]
            bars = [(ratio, found[2] / found[1]) for problem, found in met if (ratio := judged(problem, *found)) is not None]
            ratios = [ratio for ratio, _ in bars]
            table.append([name, family, f"{len(met)} of {len(WANTED) * len(problems)}", str(len(bars)),
                          f"{100 * sum(ratio <= 1 for ratio in ratios) / len(ratios):.1f}", f"{max(ratios):.2f}", f"{statistics.median(ratios):.2f}",
                          f"{100 * statistics.median(bar for _, bar in bars):.2f}", f"{statistics.mean(len(found[0]) for _, found in met):.1f}"])
    return markdown_table(["constants", "problems", "met", "judged", "bars that hold, %", "worst error, bars", "median error, bars", "median bar, %",
                           "meshes"], table)


def few_cells_text(families):
    """Bars of all that is known from two meshes on, met or not, by the cells that slip on the last mesh."""
    table = []
    for low, high in zip((0, 2, *CELLS[1:]), (2, *CELLS[1:])):
        for family, problems in families.items():
            found = []
            for problem in problems:
                for count in range(2, len(problem["meshes"]) + 1):
                    meshes = problem["meshes"][:count]
                    value, bar = bar_of(problem, meshes, Constants())
                    ratio = judged(problem, meshes, value, bar)
                    if low <= part_slipping(meshes) * meshes[-1]["nodes"] < high and ratio is not None:
                        found.append((ratio, bar / value))
            if found:
                ratios = [ratio for ratio, _ in found]
                table.append([f"{low} to {high}" if high < CELLS[-1] else f"{low} and more", family, str(len(found)),
                              f"{100 * sum(ratio <= 1 for ratio in ratios) / len(ratios):.1f}", f"{max(ratios):.2f}", f"{statistics.median(ratios):.2f}",
                              f"{100 * statistics.median(bar for _, bar in found):.2f}"])
    return markdown_table(["cells", "problems", "bars", "hold, %", "worst error, bars", "median error, bars", "median bar, %"], table)


def scatter_text(families):
    """Of |value / reference - 1| times nodes and times cells, by the cells that decide."""
    table = []
    for low, high in zip(CELLS, CELLS[1:]):
        for family, problems in families.items():
            meshes = [(value_on(problem, mesh) / problem["mu"] - 1, mesh) for problem in problems for mesh in problem["meshes"]
                      if low <= mesh["cells"] < high]
            row = [f"{low} to {high}" if high < CELLS[-1] else f"{low} and more", family, str(len(meshes))]
            for size in ("nodes", "cells"):
                off = [abs(each) * mesh[size] for each, mesh in meshes]
                row += [f"{value:.3f}" for value in numpy.quantile(off, (0.5, 0.8, 0.95))]
            table.append(row)
    return markdown_table(["cells", "problems", "meshes", "off, times nodes: median", "8 of 10 below", "19 of 20 below", "off, times cells: median",
                           "8 of 10 below", "19 of 20 below"], table)


def digits_text(families):
    """Of values in the digits that a run without a bar shows."""
    table = []
    for family, problems in families.items():
        found = []
        for problem in problems:
            for mesh in problem["meshes"]:
                value = value_on(problem, mesh)
                known = max(ONE_MESH / mesh["nodes"], STEPS) * value
                if problem["own"] <= known / 3:
                    place = 10.0**min(math.ceil(math.log10(known)), math.floor(math.log10(value)))
                    apart = abs(round(value / place) - round(problem["mu"] / place))
                    found.append((abs(value - problem["mu"]) <= known, apart == 0, apart <= 1))
        table.append([family, str(len(found)), *(f"{statistics.mean(column):.3f}" for column in zip(*found))])
    return markdown_table(["problems", "meshes", "within what is usual", "last digit the reference's", "within 1 of it"], table)


def own_scatter_text(families):
    """Of values beside a + b/n, times nodes, problem by problem: six meshes and more."""
    table = []
    for family, problems in families.items():
        for kind in ("one contact", "several"):
            found = []
            for problem in problems:
                several = problem["shape"] in ("pads", "soft pads", "feet", "grooves")
                if len(problem["meshes"]) < 6 or several != (kind == "several"):
                    continue
                nodes = numpy.array([mesh["nodes"] for mesh in problem["meshes"]], float)
                values = numpy.array([value_on(problem, mesh) for mesh in problem["meshes"]])
                slope, start = numpy.polyfit(1 / nodes, values, 1, w=nodes)
                rest = ((values - start - slope / nodes) * nodes)**2
                found.append((math.sqrt(rest.sum() / (len(nodes) - 2)) / start, abs(slope) / start))
            if found:
                table.append([family, kind, str(len(found)), *(f"{value:.3f}" for value in numpy.quantile([one for one, _ in found], (0.1, 0.5, 0.9))),
                              *(f"{value:.3f}" for value in numpy.quantile([one for _, one in found], (0.1, 0.5, 0.9)))])
    return markdown_table(["problems", "contact", "series", "scatter: 1 in 10 below", "median", "9 in 10 below", "slope: 1 in 10 below", "median",
                           "9 in 10 below"], table)


def text_of(families):
    counts = ", ".join(f"{len({problem['number'] for problem in problems})} {family}" for family, problems in families.items())
    return f"""## What is usual from mesh to mesh?

Version {commit()}. What `src/answers/error_bars.c` takes for granted before meshes tell: by how much the value of a mesh is off, in parts of mu over the nodes in contact.
Problems with a reference: {counts}. `cells`: those that slip where slow slip turns fast.

### One mesh

{scatter_text(families)}

From 0 to 32 cells that slip a mesh is off by as much, times these cells, within a factor of three, on blocks as on pads. So one number serves all, and a bar by cells
that slip needs no least number of them: it is long where they are few. Where nearly all cells slip first more is off for each of them: 0.2 over the nodes is taken at
least. Bars by two meshes and more, met or not:

{few_cells_text(families)}

### Digits of a run without a bar

A run that asks for no bar prints mu to the digit that is worth 0.5/n of it, or more (`ONE_MESH`).

{digits_text(families)}

### From problem to problem

Scatter of values beside a + b/n, and |b|, both over nodes and in parts of mu, of problems with six meshes and more.

{own_scatter_text(families)}

It differs by a factor of ten to a hundred, which no kind of contact and no number that a run knows tells beforehand; the meshes of the problem itself do. So what is usual is worth no
more than one mesh, and runs are shared out to as many meshes as there are runs.

### Bars by other constants

Asked for 1, 2 and 3 %: meshes until the bar is short enough, then one twice as fine as the first (`span`), on which it must still be so, as the program ends. `now` is what it takes: the shortest bars of which 19 of 20 hold in either family.

{tried_text(families)}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/priors")
    parser.add_argument("--values", type=Path, default=Path(__file__).with_suffix(".jsonl"))
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    families = {}
    for row in map(json.loads, options.values.read_text().splitlines()):
        families.setdefault(row["family"], []).append(row)
    (options.output / "priors.md").write_text(text_of(families))
    return 0


if __name__ == "__main__":
    sys.exit(main())
