#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Which estimator's error bars hold, and what do they cost? On the 20 blocks of set A among promise.py's cases.

    validation/benchmark/estimators.py [--quick] [--report] [-o FOLDER] [--promise FOLDER]

Compared are: a bar of 1 % for all cases; the difference of N and 2N cells; Richardson's extrapolation from N, 2N and 4N as
Roache's grid convergence index; the program's own fit, on the same runs, and as promise.md has it (`--to 3%`, `--to 1%`);
and the error of the elastic state shortly before the first rapid event as recovery of stress shows it (Zienkiewicz and
Zhu), relative and squared. Then meshes whose cells are short where slip sets out, against even ones with as many contact
nodes. References and the program's bars are read from promise.md beside this file.

Runs are kept in FOLDER/estimators.jsonl as they end (default results/estimators): the same command goes on where it was
stopped. Runs on fixed meshes that promise.py has left in its own folder (--promise, default results/promise) are not
computed again. Leaves estimators.md and a figure in FOLDER. --report: computes nothing, shows what is
there. --quick: one case on small meshes."""
import argparse
import math
import statistics
from dataclasses import dataclass
from pathlib import Path

import estimates
import figure
from estimates import Answer
from estimator_runs import FULL, GRADE, QUICK, compute
from measured_run import ROOT, markdown_table
from promise import BLOCK, CASES, FIRST, Kept, case
from promise_work import sure_error

HERE = Path(__file__).resolve().parent
SAME_BAR = 0.01      # of mu_M: what one would say of 40 cells without any estimator
GUIDE = "error = bar"
DRAWN = {"difference": "difference of N, 2N", "Roache, else 3 differences": "Roache, N, 2N, 4N", "fit": "fit, N, 2N, 4N",
         "indicator squared": "indicator squared"}


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
        answers = tuple(Answer(float(cells[k].split()[0]) / 100, float(cells[k + 1]) / 100, float(cells[k + 4]))
                        for k in (3, 8))
        rows[cells[0]] = Promised(float(cells[1]), float(cells[2]) / 100, answers)
    return rows


@dataclass(frozen=True)
class Found:
    """Of one case: (name of the mesh, cells) -> run, cells -> state, and what promise.md has."""
    runs: dict
    states: dict
    promised: Promised

    def error(self, mesh, cells):
        return self.runs[mesh, cells]["mu"] / self.promised.mu - 1

    def answer(self, cells, rule):
        """rule: values on meshes of these numbers of cells -> bar."""
        runs = [self.runs["even", n] for n in cells]
        bar = rule([run["mu"] for run in runs])
        return Answer(self.error("even", cells[-1]), None if bar is None else bar / self.promised.mu,
                      sum(run["seconds"] for run in runs))

    def same_bar(self, cells):
        return Answer(self.error("even", cells), SAME_BAR, self.runs["even", cells]["seconds"])

    def by_state(self, cells, power):
        state, seconds = self.states[cells], self.runs["even", cells]["seconds"]
        if state is None:
            return Answer(self.error("even", cells), None, seconds)
        return Answer(self.error("even", cells), state["relative"] ** power, seconds + state["seconds"])


def shown(cells):
    return ", ".join(map(str, cells))


def rules(plan):
    """(name, cells, Found -> Answer)."""
    pairs = [plan.cells[k:k + 2] for k in range(len(plan.cells) - 1)]
    triples = [plan.cells[k:k + 3] for k in range(len(plan.cells) - 2)]
    by_values = (("difference", pairs, estimates.difference),
                 ("Roache, only where an order is observed", triples, estimates.convergence_index),
                 ("Roache, else 3 differences", triples, estimates.convergence_index_or_blind))
    rows = [(f"{100 * SAME_BAR:g} % for all, no estimator", str(n), lambda found, n=n: found.same_bar(n))
            for n in plan.cells[1:]]
    rows += [(name, shown(cells), lambda found, n=cells, rule=rule: found.answer(n, rule))
             for name, groups, rule in by_values for cells in groups]
    rows += [("fit", shown(cells), lambda found, n=cells: found.answer(
        n, lambda values: estimates.fitted_line(values, [one + 1 for one in n]))) for cells in triples]
    rows += [(f"`--to {wanted}%`", "its own", lambda found, k=k: found.promised.answers[k]) for k, wanted in enumerate((3, 1))]
    return rows + [(name, str(n), lambda found, n=n, power=power: found.by_state(n, power))
                   for n in plan.looked_at for power, name in ((1, "indicator"), (2, "indicator squared"))]


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
    """Short cells where slip sets out against even ones."""
    rows = []
    for cells in plan.looked_at:
        both = [found for found in everything if found.runs["trailing", cells]]
        for mesh, words in (("even", "even"), ("trailing", f"short at the trailing end, 1 to {GRADE}")) if both else ():
            errors = [found.error(mesh, cells) for found in both]
            size = [abs(error) for error in errors]
            better = sum(error < abs(found.error("even", cells)) for error, found in zip(size, both))
            rows.append([f"{cells} x {cells}", words, len(both), percent(sure_error(size)), percent(statistics.median(size)),
                         percent(statistics.mean(errors)), "" if mesh == "even" else f"{better} of {len(both)}",
                         f"{statistics.median(found.runs[mesh, cells]['seconds'] for found in both):.1f}"])
    return markdown_table(["cells", "columns of cells", "cases", "19 of 20 err by less than, %", "median error, %",
                           "mean, signed, %", "closer than even cells", "cpu s, median"], rows)


def state_table(everything, plan):
    rows = []
    for cells in plan.looked_at:
        states = [found.states[cells] for found in everything if found.states[cells]]
        if not states:
            continue
        relative = [state["relative"] for state in states]
        places = [statistics.median(state[key] for state in states) for key in ("at_rod_face", "at_contact")]
        rows.append([f"{cells} x {cells}", len(states), percent(statistics.median(relative), 1),
                     f"{percent(min(relative), 1)} to {percent(max(relative), 1)}", *(percent(part, 0) for part in places)])
    return markdown_table(["cells", "cases", "relative error, median, %", "all cases, %", "of it next to the rod's face, %",
                           "next to the contact, %"], rows)


def draw(path, answers):
    """Errors against bars of the finest meshes that each rule has; answers: name -> list."""
    curves = {}
    for name, every in answers.items():
        own = [one for one in every if one.bar is not None]
        if own:
            curves[name] = [one.bar for one in own], [abs(one.error) for one in own]
    bars = [bar for x, _ in curves.values() for bar in x]
    curves[GUIDE] = [min(bars), max(bars)], [min(bars), max(bars)]
    figure.draw(path, "Blocks of set A: do bars know of the error?", "bar of mu_M, relative", "error of mu_M, relative", curves,
                guide=GUIDE)


def missing_text(everything, plan):
    """--report says what it could not show."""
    there = [bool(row) for found in everything for n in plan.looked_at
             for row in (found.states[n], found.runs["trailing", n])]
    return "" if all(there) else (f" Of the runs for states and short cells {sum(there)} of {len(there)} were done when this "
                                  "page was written; the command goes on with the others.")


def text_of(everything, plan, folder):
    answered = [(name, cells, [rule(found) for found in everything]) for name, cells, rule in rules(plan)]
    judged = [(name, cells, estimates.verdict_of(answers)) for name, cells, answers in answered
              if any(one.bar is not None for one in answers)]
    draw(folder / "estimators", {DRAWN[name]: answers for name, cells, answers in answered
                                 if name in DRAWN and cells.endswith(str(plan.looked_at[-1]))})
    own = [found.promised.own_error for found in everything]
    return (f"## Which estimator's bars hold?\n\n{len(everything)} blocks of set A, references from promise.md (their own "
            f"error: {percent(statistics.median(own))} % in the median, {percent(max(own))} % at most). One run a mesh, at "
            "the case's pressure; quads of order 1, `cells` along and up the block. Errors and bars are relative, bars half "
            "their width. `fit`: line and scatter, of the mesh part of the program's bar. `times wider`: what all bars of the "
            "rule would have to be multiplied with; `median bar then` compares rules that hold equally often. Rank "
            "correlations of 20 cases below 0.45 may be chance. Bars as short as the reference's own error miss by that alone."
            + missing_text(everything, plan) + "\n\n"
            + rule_table(judged) + "\n\n![estimators](estimators.png)\n\n"
            "### Error of the elastic state before the first rapid event\n\nBy recovery of stress, relative to the energy "
            "norm. Next to: within a tenth of length or height, parts of the error's energy.\n\n"
            + state_table(everything, plan) + "\n\n### Short cells where slip sets out\n\n"
            "`trailing.geo` against `block.geo`, as many contact nodes.\n\n" + mesh_table(everything, plan) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/estimators")
    parser.add_argument("--promise", type=Path, default=ROOT / "results/promise", help="folder of what promise.py computed")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--report", action="store_true", help="compute nothing, show what is there")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    plan = QUICK if options.quick else FULL
    kept, before = Kept(options.output / "estimators.jsonl"), Kept(options.promise / "promise.jsonl")
    table, everything = promised(HERE / "promise.md"), []
    blocks = [one for one in map(case, range(FIRST, FIRST + CASES)) if one.scene == BLOCK]
    for one in blocks[plan.cases]:
        runs, states = compute(one, kept, before, plan, not options.report)
        if all(runs["even", cells] for cells in plan.cells):
            everything.append(Found(runs, states, table[one.name]))
        print(one.name, flush=True)
    (options.output / "estimators.md").write_text(text_of(everything, plan, options.output))
    print((options.output / "estimators.md").read_text())


if __name__ == "__main__":
    main()
