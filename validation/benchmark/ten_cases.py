# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold on a kind of problem that the forty of promise.py do not have? Ten cases of that kind, laid down before
anything was computed.

A module that draws such cases gives them here, numbered: blocks and pads whose numbers are points of Halton sequences. A case
without bulk sliding is passed over for the next one. Each is asked for at 3 % with `--to`. Its reference is the mean of two
meshes, finer than what such a bar needs as a rule, at two pressures, 0.5 % below and above; its own error is the standard error
of the meshes' means. Where that is above a third of the bar, finer meshes are added; pads may have meshes that are graded towards
their edges, and of second order, as promise.py has them. A run that sees few slidings is made longer. The digest of the list is kept before the first run in a file beside the module, and tests compare it."""
import argparse
import hashlib
import math
import statistics
from dataclasses import dataclass
from pathlib import Path

import promise
from measured_run import ROOT, markdown_table, run
from promise import Kept, flow

COUNT, DRAWN = 10, 20          # asked for; drawn, as some do not slide as a whole
WANTED, WITHIN = 0.03, 90      # s
WINDOW = (0.995, 1.005)
# Meshes of a reference: (cells along the contact, order, grade). A window and a mesh: four runs.
EVEN = ((80, 1, 1), (100, 1, 1))
EVEN_FINER = ((112, 1, 1), (128, 1, 1), (144, 1, 1), (160, 1, 1))
PEAKS_MIN = 6
OWN_MAX = 1 / 3                # of a reference's own error, over the bar


@dataclass(frozen=True)
class Case:
    name: str
    scene: Path
    settings: tuple
    pressure: float
    mesh: dict             # mesh.set without the cells
    is_block: bool         # else pads
    way: tuple = ()        # settings of the references alone: whole meshes, finer steps


def mesh_of(one, cells, order=1, grade=1):
    graded = {"order": order, "grade_contact": grade} if (order, grade) != (1, 1) else {}
    if one.is_block:
        return one.mesh | {"nx": cells, "nz": cells // 2}
    return one.mesh | {"size_contact": 1 / cells, "size_bulk": 4 / cells} | graded


def row_name(mesh, factor):
    cells, order, grade = mesh
    return f"reference {cells}" + f" order {order} grade {grade}" * ((order, grade) != (1, 1)) + f" at {factor}"


class TenCases:
    """The first COUNT of the drawn cases that slide as a whole. case: number -> Case; graded: pads have graded meshes."""

    def __init__(self, case, graded=False):
        self.cases = [case(number) for number in range(DRAWN)]
        self.graded = graded

    def meshes(self, one):
        """Those of the reference, and the finer ones."""
        if one.is_block or not self.graded:
            return EVEN, EVEN_FINER
        return promise.REFERENCES[False], promise.FINER[False]

    def reference(self, one, kept, finer):
        """(mean, its own error); None: no bulk sliding. finer: with those meshes, too."""
        means, (usual, more) = [], self.meshes(one)
        for mesh in usual + more * finer:
            rows = [kept.obtain(one, row_name(mesh, factor), lambda m=mesh, f=factor: reference_run(one, m, f)) for factor in WINDOW]
            if any(row["mu"] is None or row["is"] != "peaks" for row in rows):
                return None
            means.append(statistics.mean(row["mu"] for row in rows))
        return statistics.mean(means), promise.standard_error(means)

    def listed(self):
        def line(one):
            return f"{one.name}; {'; '.join((*one.settings, *one.way))}; {one.mesh}\n".replace(str(ROOT), ".")
        return "".join(line(one) for one in self.cases)

    def digest(self):
        return hashlib.sha256(self.listed().encode()).hexdigest()

    def known(self, kept):
        """(case, reference, its own error, answer) of what was computed before."""
        def has_finer(one):
            return all((one.name, row_name(mesh, factor)) in kept.rows for mesh in self.meshes(one)[1] for factor in WINDOW)
        return [(one, *self.reference(one, kept, has_finer(one)), kept.rows[one.name, f"to {WANTED}"]) for one in self.cases
                if (one.name, f"to {WANTED}") in kept.rows]

    def judged(self, kept, limit):
        """The same of the first cases that slide as a whole; computes what was not computed before."""
        found = []
        for one in self.cases:
            if len(found) == limit:
                break
            truth = self.reference(one, kept, False)
            if not truth:
                continue
            answer = kept.obtain(one, f"to {WANTED}", lambda c=one: ask(c))
            if answer["bar"] and truth[1] > OWN_MAX * answer["bar"]:
                truth = self.reference(one, kept, True) or truth
            found.append((one, *truth, answer))
        return found

    def main(self, title, folder):
        """The command of the module that draws the cases. Exit status 1: a bar does not hold, or is not known."""
        parser = argparse.ArgumentParser(description=title)
        parser.add_argument("--list", action="store_true", help="the cases and their digest alone")
        parser.add_argument("--limit", type=int, default=COUNT)
        parser.add_argument("-o", "--output", type=Path, default=folder)
        words = parser.parse_args()
        if words.list:
            print(self.listed() + self.digest())
            return 0
        words.output.mkdir(parents=True, exist_ok=True)
        found = self.judged(Kept(words.output / "cases.jsonl"), words.limit)
        print(section(found))
        return 0 if all(answer["bar"] and abs(answer["mu"] - mean) <= answer["bar"] or math.isnan(mean)
                        for _, mean, _, answer in found) else 1


def reference_run(one, mesh, factor):
    """A run that saw few slidings of the whole block goes on to four times the U of the last: its first ones are of
    the start."""
    settings = [*promise.QUIET, *one.settings, *one.way, flow(mesh_of(one, *mesh)), f"load.pressure={one.pressure * factor:.9g}"]
    ended = run(one.scene, settings, 600)
    results = ended.report.get("results", {})
    if 0 < len(results.get("peaks", [])) < PEAKS_MIN:
        way = 4 * results["peaks"][-1]["U"]
        ended = run(one.scene, [*settings, f"time.until={{U: {way:g}}}"], 600)
        results = ended.report.get("results", {})
    return {"mu": results.get("mu_M"), "is": results.get("mu_M_is"), "seconds": ended.seconds, "said": ended.said[-200:]}


def ask(one):
    ended = run(one.scene, [*promise.QUIET, *one.settings, flow(mesh_of(one, 40)), f"load.pressure={one.pressure}"], 600,
                words=["--to", f"{WANTED}", "--within", f"{WITHIN}s"])
    results, found = ended.report.get("results", {}), ended.report.get("accuracy", {})
    return {"mu": results.get("mu_M"), "bar": results.get("mu_M_error"), "met": found.get("met"), "seconds": ended.seconds,
            "nodes": [level["contact_nodes"] for level in found.get("levels", [])], "said": ended.said[-200:]}


def section(found):
    """Of the page: a sentence and a table."""
    if not found:
        return "No case was computed yet.\n"
    rows, ratios = [], []
    for one, mean, own, answer in found:
        if answer["mu"] is None or not answer["bar"]:
            rows.append([one.name, f"{mean:.4f}", f"{100 * own / mean:.2f}", "not known", "", "no", answer["nodes"], f"{answer['seconds']:.1f}"])
            continue
        error = answer["mu"] - mean
        ratios.append(abs(error) / answer["bar"])
        rows.append([one.name, f"{mean:.4f}", f"{100 * own / mean:.2f}", f"{100 * error / mean:+.2f}" + " **no**" * (ratios[-1] > 1),
                     f"{100 * answer['bar'] / mean:.2f}", "yes" if answer["met"] else "no", ", ".join(map(str, answer["nodes"])),
                     f"{answer['seconds']:.1f}"])
    held = sum(ratio <= 1 for ratio in ratios)
    worst = f"; the worst error is {max(ratios):.2f} bars, the median {statistics.median(ratios):.2f}" if ratios else ""
    return (f"{held} of {len(ratios)} bars hold the reference ({len(found) - len(ratios)} of {len(found)} answers are not known){worst}.\n\n"
            + markdown_table(["case", "mu_M", "own error, %", "answer: error, %", "bar, %", "met", "contact nodes", "s"], rows) + "\n")
