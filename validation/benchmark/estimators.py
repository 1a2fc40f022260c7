#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Which estimator's error bars hold, and what do they cost? On the 20 blocks of set A among promise.py's cases.

    validation/benchmark/estimators.py [--quick] [-o FOLDER] [--promise FOLDER]

Compared are: a bar of 1 % for all cases; the difference of N and 2N cells; Richardson's extrapolation from N, 2N and 4N as
Roache's grid convergence index; the program's own fit, on the same runs, and as promise.md has it (`--to 3%`, `--to 1%`);
and the error of the elastic state shortly before the first rapid event as recovery of stress shows it (Zienkiewicz and
Zhu), relative and squared. Then meshes whose cells are short where slip sets out, against even ones with as many contact
nodes. References and the program's bars are read from promise.md beside this file.

Runs are kept in FOLDER/estimators.jsonl as they end (default results/estimators): the same command goes on where it was
stopped. What promise.py left in its own folder (--promise, default results/promise) on meshes of 80 cells is not computed
again. Leaves estimators.md and a figure in FOLDER. --quick: one case on small meshes."""
import argparse
import math
import statistics
from dataclasses import dataclass, replace
from pathlib import Path

import estimates
import figure
from estimates import Answer
from estimator_runs import FULL, QUICK, SHORTENED, compute
from measured_run import ROOT, commit, markdown_table
from promise import BLOCK, CASES, FIRST, Kept, case
from promise_work import sure_error

HERE = Path(__file__).resolve().parent
SAME_BAR = 0.01      # of mu_M: what one would say of 40 cells without any estimator
GUIDE = "error = bar"
DRAWN = {"difference, 1 run a mesh": "difference of N, 2N", "Roache, else 3 differences, 1 run": "Roache, N, 2N, 4N",
         "the program's fit, 1 run": "the program's fit", "indicator squared": "indicator squared"}


@dataclass(frozen=True)
class Promised:
    """A row of promise.md; answers: of `--to 3%` and `--to 1%`, over mu."""
    mu: float
    own_error: float
    answers: tuple


def promised(path):
    """Name of the case -> Promised."""
    rows = {}
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) != 13 or not cells[0].startswith(("A,", "B,")):
            continue
        answers = tuple(Answer(float(cells[k].split()[0]) / 100, float(cells[k + 1]) / 100, float(cells[k + 4])) for k in (3, 8))
        rows[cells[0]] = Promised(float(cells[1]), float(cells[2]) / 100, answers)
    return rows


@dataclass(frozen=True)
class Found:
    """Of one case: (kind, cells) -> runs, cells -> state, and what promise.md has."""
    meshes: dict
    states: dict
    promised: Promised

    def error(self, mu):
        return mu / self.promised.mu - 1

    def single(self, cells):
        """mu of the run at the case's own pressure, and what a first run on this mesh costs."""
        row = self.meshes["even", cells]
        return row["mu"][len(row["mu"]) // 2], row["seconds"][0]

    def by_values(self, cells, rule):
        """The rule on one run a mesh."""
        values, seconds = zip(*(self.single(n) for n in cells))
        bar = rule(values)
        return Answer(self.error(values[-1]), None if bar is None else bar / self.promised.mu, sum(seconds))

    def by_means(self, cells, rule):
        """The rule on the mean of all runs on each mesh."""
        rows = [self.meshes["even", n] for n in cells]
        values = [statistics.mean(row["mu"]) for row in rows]
        bar = rule(values)
        return Answer(self.error(values[-1]), None if bar is None else bar / self.promised.mu,
                      sum(sum(row["seconds"]) for row in rows))

    def by_fit(self, cells, single):
        rows = [self.meshes["even", n] for n in cells]
        runs = [[self.single(n)[0]] if single else row["mu"] for n, row in zip(cells, rows)]
        seconds = sum(row["seconds"][0] if single else sum(row["seconds"]) for row in rows)
        bar = estimates.fitted_line([row["nodes"] for row in rows], runs)
        return Answer(self.error(statistics.mean(runs[-1])), bar / self.promised.mu, seconds)

    def by_state(self, cells, power):
        mu, seconds = self.single(cells)
        return Answer(self.error(mu), self.states[cells]["relative"] ** power, seconds + self.states[cells]["seconds"])


def shown(cells):
    return ", ".join(map(str, cells))


def rules(plan):
    """(name, cells, Found -> Answer)."""
    coarse, every = plan.coarse, (*plan.coarse, *plan.fine)
    triples = [every[k:k + 3] for k in range(len(every) - 2)]

    def same(cells):
        return lambda found: replace(found.by_values((cells,), lambda values: 0), bar=SAME_BAR)

    def named(name, cells, method, *more):
        return name, shown(cells), lambda found: getattr(found, method)(cells, *more)
    rows = [(f"{100 * SAME_BAR:g} % for every case, no estimator", str(n), same(n)) for n in every[1:]]
    rows += [named("difference, 1 run a mesh", pair, "by_values", estimates.difference) for pair in zip(every, every[1:])]
    rows += [named("difference, 3 runs", coarse[-2:], "by_means", estimates.difference)]
    rows += [named("Roache, only where an order is observed, 1 run", triple, "by_values", estimates.convergence_index)
             for triple in triples]
    rows += [named("Roache, else 3 differences, 1 run", triple, "by_values", estimates.convergence_index_or_blind)
             for triple in triples]
    rows += [named("Roache, else 3 differences, 3 runs", coarse, "by_means", estimates.convergence_index_or_blind)]
    rows += [named("the program's fit, 1 run", triple, "by_fit", True) for triple in triples]
    rows += [named("the program's fit, 3 runs", coarse, "by_fit", False)]
    rows += [("the program, `--to 3%`", "its own", lambda found: found.promised.answers[0]),
             ("the program, `--to 1%`", "its own", lambda found: found.promised.answers[1])]
    for cells in coarse[1:]:
        rows += [("indicator of the state", str(cells), lambda found, n=cells: found.by_state(n, 1)),
                 ("indicator squared", str(cells), lambda found, n=cells: found.by_state(n, 2))]
    return rows


def percent(part, digits=2):
    return f"{100 * part:.{digits}f}"


def correlation_text(value):
    return "" if math.isnan(value) else f"{value:.2f}"


def rule_table(judged):
    """judged: (name, cells, verdict)."""
    head = ["rule", "cells", "bars that hold", "worst error, bars", "median error, bars", "median bar, %", "cpu s",
            "times wider: 19 of 20 hold", "median bar then, %", "rank correlation, bar and error"]
    return markdown_table(head, [[name, cells, f"{v.held} of {v.count}", f"{v.worst:.2f}", f"{v.median:.2f}", percent(v.bar),
                                  f"{v.seconds:.1f}", f"{v.factor:.2f}", percent(v.bar * v.factor),
                                  correlation_text(v.correlation)] for name, cells, v in judged])


def mesh_table(everything, plan):
    """Short cells where slip sets out against even ones: error of the mean over pressures."""
    rows = []
    for cells in plan.coarse[1:]:
        for kind, words in {"even": "even", **{kind: SHORTENED[kind] for kind in plan.shortened}}.items():
            runs = [(found.error(statistics.mean(found.meshes[kind, cells]["mu"])), sum(found.meshes[kind, cells]["seconds"]))
                    for found in everything]
            errors, seconds = zip(*runs)
            size = [abs(error) for error in errors]
            better = sum(abs(error) < abs(found.error(statistics.mean(found.meshes["even", cells]["mu"])))
                         for error, found in zip(errors, everything))
            rows.append([f"{cells} x {cells}", words, percent(sure_error(size)), percent(statistics.median(size)),
                         percent(statistics.mean(errors)), "" if kind == "even" else f"{better} of {len(errors)}",
                         f"{statistics.median(seconds):.1f}"])
    return markdown_table(["cells", "columns of cells", "19 of 20 err by less than, %", "median error, %", "mean, signed, %",
                           "closer than even cells", "cpu s, median"], rows)


def state_table(everything, coarse):
    rows = []
    for cells in coarse:
        states = [found.states[cells] for found in everything]
        relative = [state["relative"] for state in states]
        rows.append([f"{cells} x {cells}", percent(statistics.median(relative), 1),
                     f"{percent(min(relative), 1)} to {percent(max(relative), 1)}",
                     *(percent(statistics.median(state[key] for state in states), 0) for key in ("at_rod_face", "at_contact"))])
    return markdown_table(["cells", "relative error, median, %", "all cases, %", "of it next to the rod's face, %",
                           "next to the contact, %"], rows)


def draw(path, answers):
    """Errors against bars of the finest meshes that each rule has; answers: name -> list."""
    curves = {}
    for name, every in answers.items():
        own = [one for one in every if one.bar is not None]
        curves[name] = [one.bar for one in own], [abs(one.error) for one in own]
    bars = [bar for x, _ in curves.values() for bar in x]
    curves[GUIDE] = [min(bars), max(bars)], [min(bars), max(bars)]
    figure.draw(path, "Blocks of set A: do bars know of the error?", "bar of mu_M, relative", "error of mu_M, relative", curves,
                guide=GUIDE)


def text_of(everything, plan, folder):
    answered = [(name, cells, [rule(found) for found in everything]) for name, cells, rule in rules(plan)]
    judged = [(name, cells, estimates.verdict_of(answers)) for name, cells, answers in answered
              if any(one.bar is not None for one in answers)]
    draw(folder / "estimators", {DRAWN[name]: answers for name, cells, answers in answered
                                 if name in DRAWN and cells.endswith(str(plan.coarse[-1]))})
    own = [found.promised.own_error for found in everything]
    return (f"## Which estimator's bars hold?\n\nVersion {commit()}. {len(everything)} blocks of set A, references from "
            f"promise.md (their own error: {percent(statistics.median(own))} % in the median, {percent(max(own))} % at most). "
            "Errors and bars are relative, bars half their width. `1 run`: at the case's pressure; `3 runs`: mean of "
            "pressures 0.5 % below, at and above, the mesh made and reduced once. `times wider`: what all bars of the rule "
            "would have to be multiplied with; `median bar then` compares rules that hold equally often. `cells`: along and "
            "up the block.\n\n" + rule_table(judged) + "\n\n![estimators](estimators.png)\n\n"
            "### Error of the elastic state before the first rapid event\n\nBy recovery of stress, relative to the energy "
            "norm. Next to: within a tenth of length or height, parts of the error's energy.\n\n"
            + state_table(everything, plan.coarse[1:]) + "\n\n### Short cells where slip sets out\n\n`trailing.geo` and "
            "`grade_x` of block.geo; rows are even. 3 runs.\n\n" + mesh_table(everything, plan) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/estimators")
    parser.add_argument("--promise", type=Path, default=ROOT / "results/promise", help="folder of what promise.py computed")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    plan = QUICK if options.quick else FULL
    kept, before = Kept(options.output / "estimators.jsonl"), Kept(options.promise / "promise.jsonl")
    table, everything = promised(HERE / "promise.md"), []
    blocks = [one for one in map(case, range(FIRST, FIRST + CASES)) if one.scene == BLOCK]
    for one in blocks[plan.cases]:
        meshes, states = compute(one, kept, before, plan)
        everything.append(Found(meshes, states, table[one.name]))
        print(one.name, flush=True)
    (options.output / "estimators.md").write_text(text_of(everything, plan, options.output))
    print((options.output / "estimators.md").read_text())


if __name__ == "__main__":
    main()
