#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What is usual from mesh to mesh? Chooses what src/record/error_bars.c takes for granted before it knows better.

    validation/benchmark/priors.py [--cases NUMBER] [--known PRIORS.MD] [--asked NOW.JSONL] [-o FOLDER]

Cases are those before the first of promise.py, so that its test is made on others. On each mesh a case is run at pressures
0.5 % below and above; the mean is the mesh's value. References are promise.py's. With values and reference known, bars by
any constants follow without a run: how many hold the reference, how far the worst is off, how wide they are.

--cases: the first so many (default: those of the page alone). --known: a page of an earlier version, whose rows are taken
as they are (default priors.md beside this file). Every run is kept in FOLDER/priors.jsonl (default results/priors): the same
command goes on where it was stopped. Leaves priors.md in FOLDER. A case takes a minute or two.

--asked: what strangers answered, packed by strangers.py. Constants that are tried stand in TRIED."""
import argparse
import json
import math
import re
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy

from measured_run import ROOT, commit, markdown_table, run
from promise import FIRST, QUIET, WINDOW, Kept, case, flow, reference, scene_mesh

sys.path.insert(0, str(ROOT / "validation/strangers"))
import judge            # noqa: E402
import strangers        # noqa: E402

CELLS_BLOCK, REFINE_PADS = (20, 28, 40, 57, 80), (0.25, 0.35, 0.5, 0.7, 1, 1.42)
STEPS, MOST = 0.002, 0.5  # as in error_bars.c
CELLS_ENOUGH = 8          # as in src/record/drops.h
PARTS = (0, 0.18, 0.25, 0.35, 0.5, 1.01)     # of the contact; bounds of the table's rows
STUDENT = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.20, 2.18, 2.16, 2.14, 2.13, 2.12, 2.11, 2.10)


@dataclass(frozen=True)
class Constants:           # (scatter, slope) of each
    nodes: tuple = (0.12, 0.05)
    slip: tuple = (0.03, 0.01)
    whole: tuple = (0.2, 0.12)
    pads: tuple = (0.14, 0.1)
    levels: int = 4


TRIED = {"now": Constants(),
         "twice the slope": Constants(nodes=(0.12, 0.1), slip=(0.03, 0.02), whole=(0.2, 0.25), pads=(0.14, 0.2)),
         "0.7 of the scatter": Constants(nodes=(0.085, 0.05), slip=(0.02, 0.01), whole=(0.14, 0.12), pads=(0.1, 0.1)),
         "1.4 of the scatter": Constants(nodes=(0.17, 0.05), slip=(0.04, 0.01), whole=(0.28, 0.12), pads=(0.2, 0.1)),
         "worth 1": Constants(levels=1), "worth 8": Constants(levels=8)}


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


# --- bars by any constants ----------------------------------------------------------------------

@dataclass(frozen=True)
class Level:
    nodes: int
    cells: float           # that decide: of a pad, or those that slip where it turns fast
    values: tuple          # of its runs
    wait: float = 0        # what mu rises by while the last nodes hold


@dataclass(frozen=True)
class Problem:
    name: str
    pads: int
    mu: float              # reference
    own: float             # its own error
    levels: tuple
    lowest: bool = False   # of runs, in place of their mean


def own_problems(rows):
    for row in rows:
        one, over = case(row.number), row.slip if row.slip > 0 else 1
        pads = one.mesh.get("n") or one.mesh.get("grooves", 0) + 1
        yield Problem(row.name, pads, row.mu, row.own * row.mu, tuple(
            Level(nodes, nodes / pads - 1 if pads > 1 else over * nodes, (value,)) for nodes, value in sorted(row.values.items())))


def strangers_problems(path):
    """Of the tuning part of validation/strangers, as packed by strangers.py --pack."""
    tuning = {one.number: one for one in strangers.problems.problems() if one.tuning}
    for data in map(json.loads, path.read_text().splitlines()):
        asked, rows = data["asked"], [row for row in data["runs"] if "late" in row]
        if data["number"] not in tuning or asked["status"]:
            continue
        for answer in judge.ANSWERS:
            truth = judge.reference(rows, answer)
            levels = [Level(level["contact_nodes"], level["cells"], tuple(run[answer] for run in level["runs"]), level["end_wait"] or 0)
                      for level in asked["levels"] if not level["undamped"] and all(run[answer] for run in level["runs"])]
            if truth and truth.value and levels:
                last = asked["levels"][-1]
                pads = 1 if last["cells"] in (last["slip_cells"], last["contact_nodes"] - 1) else round(last["contact_nodes"] / (last["cells"] + 1))
                yield Problem(f"{data['number']} {answer}", pads, truth.value, truth.own, tuple(levels), answer == "mu_hold")


def level_value(problem, level):
    return min(level.values) if problem.lowest else statistics.mean(level.values)


def kind_of(problem, part):
    return "pads" if problem.pads > 1 else "more" if part > MOST else "one piece"


def limit(problem, levels, constants):
    """(value, bar, kind) of generalised least squares, as error_bars.c finds them another way: here b is no unknown but part of the
    covariance."""
    nodes, values = (numpy.array(x, float) for x in zip(*((level.nodes, level_value(problem, level)) for level in levels)))
    part = sum(max(level.cells, 0.5) for level in levels) / nodes.sum()
    kind = kind_of(problem, part)
    scatter, slope = {"pads": [c / part for c in constants.pads], "more": constants.whole,
                      "one piece": [max(n, s / part) for n, s in zip(constants.nodes, constants.slip)]}[kind]
    squares = sum(statistics.pvariance(level.values) * len(level.values) for level in levels)
    freedoms = sum(len(level.values) - 1 for level in levels)
    runs = squares / freedoms / numpy.array([len(level.values) for level in levels]) if freedoms else numpy.zeros(len(levels))
    waits = numpy.array([level.wait for level in levels])
    few = numpy.maximum(CELLS_ENOUGH / (part * nodes), 1)
    own = (values[-1] * scatter * few / nodes) ** 2 + waits ** 2 + runs
    inverse = numpy.linalg.inv(numpy.diag(own) + (values[-1] * slope) ** 2 * numpy.outer(1 / nodes, 1 / nodes))
    variance = 1 / inverse.sum()
    weights = variance * inverse.sum(axis=0)
    value, by_runs = weights @ values, (weights ** 2 * runs).sum()
    freedoms = len(nodes) - 1 + constants.levels
    wider = ((values - value) @ inverse @ (values - value) + constants.levels) / freedoms
    mesh = max(math.hypot(STUDENT[min(freedoms, len(STUDENT)) - 1] * math.sqrt(wider * (variance - by_runs)), 3 * waits[-1]), STEPS * value)
    return value, max(math.hypot(mesh, 2 * math.sqrt(by_runs)), abs(value - values[-1])), kind


def bars_of(problems, constants):
    """{kind: [(|error| / bar, bar / mu)]} of all first meshes, three at least, of all problems, the last with enough cells."""
    found = {}
    for problem in problems:
        for count in range(3, len(problem.levels) + 1):
            levels = problem.levels[:count]
            if levels[-1].cells < CELLS_ENOUGH or levels[-1].nodes == levels[0].nodes:
                continue
            value, bar, kind = limit(problem, levels, constants)
            error = abs(value - problem.mu)
            if problem.own <= bar / 3 or error - 3 * problem.own > bar or error + 3 * problem.own <= bar:
                found.setdefault(kind, []).append((error / bar, bar / value))
    return found


def tried_text(families):
    table = []
    for name, constants in TRIED.items():
        for family, problems in families.items():
            for kind, bars in sorted(bars_of(problems, constants).items()):
                ratios = [ratio for ratio, _ in bars]
                table.append([name, family, kind, f"{sum(ratio <= 1 for ratio in ratios)} of {len(ratios)}", f"{max(ratios):.2f}",
                              f"{statistics.median(ratios):.2f}", f"{100 * statistics.median(bar for _, bar in bars):.2f}"])
    return markdown_table(["constants", "problems", "contact", "bars that hold", "worst error, bars", "median error, bars",
                           "median bar, %"], table)


def scatter_text(families):
    """Median of |value / reference - 1| times nodes and times cells, by the part of the contact that decides."""
    table = []
    for kind, low, high in (*(("one piece", *bounds) for bounds in zip(PARTS, PARTS[1:])), ("pads", 0, math.inf)):
        for family, problems in families.items():
            meshes = [(level_value(problem, level) / problem.mu - 1, level) for problem in problems for level in problem.levels
                      if (problem.pads > 1) == (kind == "pads") and low <= level.cells / level.nodes < high and level.cells >= CELLS_ENOUGH]
            if meshes:
                table.append([kind if high == math.inf else f"{kind}, {low:g} to {high:g}", family, str(len(meshes)),
                              *(f"{statistics.median(abs(off) * size(level) for off, level in meshes):.3f}"
                                for size in (lambda level: level.nodes, lambda level: level.cells))])
    return markdown_table(["contact, and the part of it that decides", "problems", "meshes", "off, times nodes", "off, times cells"], table)


# --- digits without a bar -----------------------------------------------------------------------

def single_meshes(rows):
    """(family, problem, level) of one mesh each: of strangers the plain runs behind their references, pads by the cells that slip there."""
    for problem in own_problems(rows):
        yield from (("78 cases", problem, level) for level in problem.levels)
    shapes = {one.number: one.shape for one in strangers.problems.problems() if one.tuning}
    for data in map(json.loads, (ROOT / "validation/strangers/before.jsonl").read_text().splitlines()):
        runs = [run for run in data["runs"] if "late" in run and data["number"] in shapes]
        for answer in judge.ANSWERS:
            truth = judge.reference(runs, answer)
            pads = 2 if any(word in str(shapes.get(data["number"])) for word in ("pads", "grooves", "feet", "arch")) else 1
            for run in runs if truth and truth.value else ():
                if run["pressure"] == 1 and run["program"].get(answer):
                    level = Level(run["nodes"], run["slip_cells"] or run["nodes"] - 1, (run["program"][answer],))
                    yield "strangers", Problem(str(data["number"]), pads, truth.value, truth.own, (level,)), level


def digits_text(rows, constants=TRIED["now"]):
    """As error_bars.c, level_answer_for, and base/text, text_estimate: the last digit printed is worth what one mesh usually leaves, or more."""
    found = {}
    for family, problem, level in single_meshes(rows):
        part = max(level.cells, 0.5) / level.nodes
        kind = kind_of(problem, part)
        scatter, slope = {"pads": [c / part for c in constants.pads], "more": constants.whole,
                          "one piece": [max(n, s / part) for n, s in zip(constants.nodes, constants.slip)]}[kind]
        few = max(CELLS_ENOUGH / (part * level.nodes), 1)
        value = level.values[0]
        known_to = max(2 * math.hypot(scatter * few, slope) / level.nodes, STEPS) * value
        digits = math.floor(-math.log10(known_to))
        off = abs(round(value, digits) - round(problem.mu, digits)) * 10 ** digits
        found.setdefault((family, "pads" if problem.pads > 1 else "one piece"), []).append((off, abs(value - problem.mu) <= known_to, digits))
    table = [[family, kind, str(len(each)), f"{statistics.mean(held for _, held, _ in each):.3f}", f"{statistics.mean(off < 0.5 for off, *_ in each):.3f}",
              f"{statistics.mean(off < 1.5 for off, *_ in each):.3f}", ", ".join(f"{d}: {sum(x[2] == d for x in each)}" for d in sorted({x[2] for x in each}))]
             for (family, kind), each in found.items()]
    return markdown_table(["problems", "contact", "runs", "within what is usual", "last digit the reference's", "within 1 of it", "digits behind the point"], table)


def text_of(rows, asked):
    families = {"78 cases": list(own_problems(rows)), "strangers": list(strangers_problems(asked)) if asked.exists() else []}
    every = markdown_table(["number", "case", "mu_M", "own error, %", "slip, of the nodes", "contact nodes: mu_M"],
                           [[str(row.number), row.name, f"{row.mu:.4f}", f"{100 * row.own:.2f}", f"{row.slip:.3f}" if row.slip > 0 else "",
                             ", ".join(f"{nodes}: {value:.5f}" for nodes, value in sorted(row.values.items()))] for row in rows])
    return (f"""## What is usual from mesh to mesh?

Version {commit()}. What `src/record/error_bars.c` takes for granted before meshes tell: how far values scatter from mesh to mesh, and
how far it is from a mesh to ever smaller cells (slope), in parts of mu over the contact's nodes (`nodes`), over the cells that slip where slip turns fast
(`slip`; the larger of the two counts), over the nodes where more than half of the contact slips (`whole`), over the cells of a pad
(`pads`); worth so many meshes (`levels`). Two families: the {len(rows)} cases before the first of promise.py, and mu_M and mu_hold of the tuning part of
[strangers](../strangers/README.md). A case whose reference is not known to a third of the bar counts where that does not matter.

### How far meshes are off

Median of |value / reference - 1| on meshes where 8 cells and more decide.

{scatter_text(families)}

### Bars by other constants

Of all first three, four, ... meshes of each problem. `now` is what the program takes: of those by which 19 of 20 bars hold in both
families together, those with the shortest. Pads of the 78 cases scatter three times as far as those of strangers, and nothing that a run knows tells them apart: so the
bars of the latter are long (their median error is a tenth of them).

{tried_text(families)}

### Digits of a run without a bar

A run that asks for no bar prints mu to the digit that is worth twice what is usual of its mesh, or more. Of single meshes, against their reference:

{digits_text(rows)}

### Cases

{every}
""")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/priors")
    parser.add_argument("--cases", type=int, default=0)
    parser.add_argument("--asked", type=Path, default=ROOT / "validation/strangers/now.jsonl", help="of strangers.py --pack")
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
    (options.output / "priors.md").write_text(text_of(rows, options.asked))
    return 0


if __name__ == "__main__":
    sys.exit(main())
