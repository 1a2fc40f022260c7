#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold? Forty cases that no rule of theirs was chosen by.

    validation/benchmark/promise.py [--quick] [--list] [--within TIME] [-o FOLDER]

Cases are laid down by a rule before anything is computed: points of Halton sequences in log P and log L, number of pads,
part of the length in contact, and number of grooves, on blocks of both parameter sets, on pads and on grooves of set A,
in turn; a case without bulk sliding is passed over for the next of the sequence. Each is asked for at 3 % and at 1 % with
`--to`, its mesh that of the scene file, within a minute.

The reference of a case is the mean over meshes of the mean over three pressures, 0.5 % below, at and above, as the
program's window has them. A block has two meshes: quads of 96 cells along it, and quads of order 2 of 48. Pads and grooves,
where values of single meshes scatter (slip waits at the edges of pads, whose last cells differ), have four: 112 and 88
cells a length, and of order 2 56 and 44, graded by 8, 16, 8 and 16 towards the edges. Its own error is the standard error
of the meshes' means, or that of the single runs where it is more; where it is above a third of a bar that was given, three finer meshes are added. A bar holds the reference where they differ by no more
than the bar.

Every run is kept in FOLDER/promise.jsonl as it ends (default results/promise): the same command goes on where it was
stopped. Leaves promise.md in FOLDER. --references: those alone. --quick: four cases at 3 %. Exit status 1: fewer than 19
of 20 bars hold, or one is off by more than three bars."""
import argparse
import itertools
import json
import math
import statistics
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import promise_work
from measured_run import ROOT, commit, markdown_table, run

BLOCK, PADS = ROOT / "validation/paper/fig1.yaml", ROOT / "validation/pads/pads.yaml"
BLOCK_B = ROOT / "validation/paper/set-b.yaml"
DESIGNS = ("A", "pads", "A", "B", "grooves", "A", "pads", "A", "grooves", "A")   # in turn
FIRST, CASES, CASES_QUICK = 160, 40, 4     # the 160 before FIRST: what the rule's constants were chosen by
WANTED = (0.03, 0.01)
WITHIN = "60s"                  # --within: as many times as long as the machine is busy
WINDOW = (0.995, 1, 1.005)      # of pressure: ends and middle of the program's own window
REFERENCES = {True: ((96, 1, 1), (48, 2, 1)),      # of a block: (cells, order, grade)
              False: ((112, 1, 8), (56, 2, 8), (88, 1, 16), (44, 2, 16))}
FINER = {True: ((112, 1, 1), (128, 1, 1), (64, 2, 1)), False: ((128, 1, 16), (144, 1, 8), (72, 2, 8))}     # where that is not enough
OWN_MAX = 1 / 3                 # over the shortest bar
QUIET = ["output.history=false", "output.fields=none", "output.figures=[]"]
HELD = 0.95


@dataclass(frozen=True)
class Case:
    name: str
    scene: Path
    settings: tuple
    pressure: float
    way: float             # U of some 12 slidings
    mesh: dict             # mesh.set without sizes
    is_block: bool


def halton(index, base):
    """The van der Corput sequence, from index 1: digits mirrored at the point."""
    value, part = 0.0, 1.0
    while index > 0:
        part /= base
        value += part * (index % base)
        index //= base
    return value


def between(low, high, part):
    return low * (high / low) ** part


def rounded(value):
    return float(f"{value:.3g}")


def block(name, scene, products, lengths, index, slides):
    """P L and L from their ranges, evenly in their logarithms."""
    length = rounded(between(*lengths, halton(index, 3)))
    pressure = rounded(between(*products, halton(index, 2)) / length)
    return Case(f"{name}, P = {pressure:g}, L = {length:g}", scene,
                (f"rod.height={length / 4}", f"rod.width={length / 20}"), pressure, slides * pressure * length,
                {"length": length, "height": length / 2, "shape": "quad"}, True)


def pads(index):
    number, fill = 2 + int(5 * halton(index, 3)), round(0.3 + 0.4 * halton(1 + index // 5, 7), 2)
    pressure = rounded(between(0.003, 0.012, halton(index, 2)))
    return Case(f"A, P = {pressure:g}, {number} pads, fill {fill:g}", PADS, (), pressure, 12 * pressure,
                {"n": number, "total_height": 0.5, "pad_height": 0.05, "fill": fill, "ends": "open"}, False)


def grooves(index):
    number, pressure = 1 + int(4 * halton(index, 3)), rounded(between(0.003, 0.012, halton(index, 2)))
    return Case(f"A, P = {pressure:g}, {number} grooves", PADS, ("mesh.file=../../meshes/grooves.geo",), pressure,
                12 * pressure, {"grooves": number}, False)


def case(number):
    """The case of this number, from 0 on."""
    design, index = DESIGNS[number % len(DESIGNS)], number + 1
    if design == "pads":
        return pads(index)
    if design == "grooves":
        return grooves(index)
    if design == "B":
        return block("B", BLOCK_B, (1.5e-6, 6e-6), (0.02, 0.08), index, 18)
    return block("A", BLOCK, (0.002, 0.02), (0.4, 2.5), index, 12)


def flow(mesh):
    return "mesh.set={" + ", ".join(f"{key}: {value}" for key, value in mesh.items()) + "}"


def reference_mesh(case, cells, order, grade):
    if case.is_block:
        return case.mesh | {"nx": cells, "nz": cells, "order": order}
    return case.mesh | {"size_contact": 1 / cells, "size_bulk": 4 / cells, "order": order, "grade_contact": grade}


def scene_mesh(case):
    """As the scene files have it: 80 cells along a block of set A, 40 of set B, pads of 0.0125, grooves of 0.02."""
    if case.is_block:
        cells = 40 if case.scene == BLOCK_B else 80
        return case.mesh | {"nx": cells, "nz": cells}
    return case.mesh if "grooves" in case.mesh else case.mesh | {"size_contact": 0.0125, "size_bulk": 0.05}


class Kept:
    """What was computed, a line of JSON each."""

    def __init__(self, path):
        self.path, self.rows = path, {}
        for line in path.read_text().splitlines() if path.exists() else []:
            row = json.loads(line)
            self.rows[row["case"], row["what"]] = row

    def obtain(self, case, what, compute):
        if (case.name, what) not in self.rows:
            row = {"case": case.name, "what": what} | compute()
            with open(self.path, "a") as file:
                file.write(json.dumps(row) + "\n")
            self.rows[case.name, what] = row
        return self.rows[case.name, what]


def reference_run(case, cells, order, grade, factor):
    ended = run(case.scene, [*QUIET, *case.settings, flow(reference_mesh(case, cells, order, grade)),
                             f"load.pressure={case.pressure * factor:.9g}", f"time.until={{U: {case.way:.6g}}}"], 3000)
    results = ended.report.get("results", {})
    return {"mu": results.get("mu_M"), "hold": results.get("mu_hold"), "seconds": ended.seconds, "said": ended.said[-200:]}


def standard_error(values):
    return statistics.stdev(values) / math.sqrt(len(values))


def reference(case, kept, meshes=None):
    """(mean, its own error); None: no bulk sliding, or a run failed."""
    means, every, meshes = [], [], meshes or REFERENCES[case.is_block]
    for cells, order, grade in meshes:
        rows = [kept.obtain(case, f"reference {cells} order {order} grade {grade} at {factor}",
                            lambda f=factor: reference_run(case, cells, order, grade, f)) for factor in WINDOW]
        values = [row["mu"] for row in rows]
        if None in values:
            return None
        means.append(statistics.mean(values))
        every += values
    mean, own = statistics.mean(means), max(standard_error(means), standard_error(every))
    return mean, own


def sure_reference(case, kept, truth, bars):
    """The reference, by finer meshes too where its own error is above a third of a bar."""
    if not bars or truth[1] <= OWN_MAX * min(bars):
        return truth
    return reference(case, kept, REFERENCES[case.is_block] + FINER[case.is_block]) or truth


def reference_hold(case, kept):
    """The same of mu_hold, whose answer is the lowest of the window; None: not kept, as by versions before, or none."""
    lowest = []
    for cells, order, grade in REFERENCES[case.is_block] + FINER[case.is_block]:
        rows = [kept.rows.get((case.name, f"reference {cells} order {order} grade {grade} at {factor}"), {}) for factor in WINDOW]
        values = [row.get("hold") for row in rows]
        if None not in values:
            lowest.append(min(values))
    return (statistics.mean(lowest), standard_error(lowest)) if len(lowest) > 1 else None


def known_references(path):
    """case name: (mean, its own error) of mu_M, and of mu_hold, from the tables of an earlier promise.md: a reference does
    not depend on bars."""
    known = {"mu_M": {}, "mu_hold": {}}
    answer = "mu_M"
    for line in path.read_text().splitlines() if path else []:
        cells = [cell.strip() for cell in line.split("|")[1:4]]
        if cells[:2] == ["case", "mu_hold"]:
            answer = "mu_hold"
        if len(cells) == 3 and cells[0].startswith(("A, ", "B, ")):
            known[answer][cells[0]] = (float(cells[1]), float(cells[1]) * float(cells[2]) / 100)
    return tuple(known.values())


def ask(case, wanted, within):
    with tempfile.TemporaryDirectory() as cache:      # what a user pays who tries this shape for the first time
        ended = run(case.scene, [*QUIET, *case.settings, flow(scene_mesh(case)), f"load.pressure={case.pressure}",
                                 f"time.until={{U: {case.way:.6g}}}"], 600, cache=cache,
                    words=["--within", within, "--to", str(wanted)])
    results, found = ended.report.get("results", {}), ended.report.get("accuracy", {})
    return {"mu": results.get("mu_M"), "bar": results.get("mu_M_error"), "parts": results.get("mu_M_error_parts"),
            "hold": results.get("mu_hold"), "hold_bar": results.get("mu_hold_error"),
            "met": found.get("met"), "nodes": [level["contact_nodes"] for level in found.get("levels", [])],
            "values": [level["mu_M"]["value"] for level in found.get("levels", [])],
            "seconds": ended.seconds, "said": ended.said[-200:]}


def fixed_run(case, cells):
    mesh = case.mesh | {"nx": cells, "nz": cells}
    with tempfile.TemporaryDirectory() as cache:
        ended = run(case.scene, [*QUIET, *case.settings, flow(mesh), f"load.pressure={case.pressure}",
                                 f"time.until={{U: {case.way:.6g}}}"], 600, cache=cache)
    return {"mu": ended.report.get("results", {}).get("mu_M"), "seconds": ended.seconds}


def work(judged, kept, folder, within):
    """What error bars cost beside fixed meshes, on blocks of set A. judged: (case, its reference's mean)."""
    blocks = [(one, mean) for one, mean in judged if one.scene == BLOCK]

    def runs(what, compute):
        rows = [(kept.obtain(one, what, lambda c=one: compute(c)), mean) for one, mean in blocks]
        return [(abs(row["mu"] / mean - 1), row["seconds"]) for row, mean in rows if row["mu"]]
    fixed = {cells: runs(f"fixed {cells}", lambda c, n=cells: fixed_run(c, n)) for cells in promise_work.CELLS}
    asked = {wanted: runs(f"to {wanted}", lambda c, w=wanted: ask(c, w, within)) for wanted in WANTED}
    return promise_work.text_of(fixed, asked, folder)


def percent(part):
    return f"{100 * part:.2f}"


def answer_cells(answer, mean):
    """Cells of the table, and |error| / bar."""
    if answer["mu"] is None or not answer["bar"]:
        return ["none", "", "", "", ""], math.inf
    ratio = abs(answer["mu"] - mean) / answer["bar"]
    return [percent(answer["mu"] / mean - 1) + " **no**" * (ratio > 1), percent(answer["bar"] / mean),
            "yes" if answer["met"] else "no", ", ".join(map(str, answer["nodes"])), f"{answer['seconds']:.1f}"], ratio


def summary_of(wanted, within, ratios, undecided, met, seconds):
    """A sentence, and whether the promise is kept. undecided: bars that miss a reference whose own error is larger."""
    held = sum(ratio <= 1 for ratio in ratios)
    sentence = (f"- **{100 * wanted:g} %**: {held} of {len(ratios)} bars hold the reference"
                + f" ({undecided} of the others are shorter than its own error)" * (undecided > 0)
                + f"; the worst error is {max(ratios):.2f} bars, the median {statistics.median(ratios):.2f}; {met} met the "
                f"request within {within}; {statistics.median(seconds):.1f} s of processor time in the median, "
                f"{max(seconds):.0f} at most.")
    return sentence, held >= HELD * len(ratios) and max(ratios) <= 3


def hold_text(judged, known, kept, wanted_all):
    """The section of mu_hold, whose bars come along: cases with a reference of it."""
    rows, ratios = [], {wanted: [] for wanted in wanted_all}
    for one, _ in judged:
        truth = known.get(one.name) or reference_hold(one, kept)
        answers = {wanted: kept.rows[one.name, f"to {wanted}"] for wanted in wanted_all}
        if truth is None or any(answer.get("hold") is None for answer in answers.values()):
            continue
        row = [one.name, f"{truth[0]:.4f}", percent(truth[1] / truth[0])]
        for wanted, answer in answers.items():
            error, bar = answer["hold"] - truth[0], answer["hold_bar"] or 0
            ratios[wanted].append(abs(error) / bar if bar else math.inf)
            row += [percent(error / truth[0]) + (" **no**" if abs(error) > bar else ""), percent(bar / truth[0])]
        rows.append(row)
    if not rows:
        return ""
    head = ["case", "mu_hold", "own error, %"]
    for wanted in wanted_all:
        head += [f"to {100 * wanted:g} %: error, %", "bar, %"]
    said = [f"- asked for mu_M at {100 * wanted:g} %: {sum(ratio <= 1 for ratio in found)} of {len(found)} bars of mu_hold hold; "
            f"the worst error is {max(found):.2f} bars, the median {statistics.median(found):.2f}."
            for wanted, found in ratios.items()]
    return ("\n### mu_hold, whose bar comes along\n\nIts reference is the lowest of three pressures, mean of the reference's "
            "meshes; `own error`: from the difference of meshes.\n\n" + "\n".join(said) + "\n\n"
            + markdown_table(head, rows) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/promise")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--list", action="store_true", help="only say which cases, were none passed over")
    parser.add_argument("--references", action="store_true", help="compute these alone")
    parser.add_argument("--within", default=WITHIN, metavar="TIME", help="time of each request (%(default)s)")
    parser.add_argument("--known", type=Path, metavar="PROMISE.MD",
                        help="take references from this page of an earlier version, to four digits")
    options = parser.parse_args()
    count = CASES_QUICK if options.quick else CASES
    if options.list:
        print("\n".join(case(FIRST + k).name for k in range(count)))
        return 0
    options.output.mkdir(parents=True, exist_ok=True)
    kept, wanted_all = Kept(options.output / "promise.jsonl"), WANTED[:1] if options.quick else WANTED
    known, known_hold = known_references(options.known)
    rows, passed, judged, found = [], [], [], {wanted: [] for wanted in wanted_all}
    for number in itertools.count(FIRST):
        if len(rows) == count:
            break
        one = case(number)
        truth = known.get(one.name) or reference(one, kept)
        if truth is None:
            passed.append(one.name)
            print(f"passed over: {one.name}", flush=True)
            continue
        answers = {wanted: kept.obtain(one, f"to {wanted}", lambda w=wanted: ask(one, w, options.within)) for wanted in wanted_all if not options.references}
        mean, own = sure_reference(one, kept, truth, [answer["bar"] for answer in answers.values() if answer["bar"]])
        row = [one.name, f"{mean:.4f}", percent(own / mean)]
        for wanted, answer in answers.items():
            cells, ratio = answer_cells(answer, mean)
            row += cells
            found[wanted].append((ratio, answer, ratio > 1 and bool(answer["bar"]) and own > answer["bar"]))
        print(" | ".join(row), flush=True)
        rows.append(row)
        judged.append((one, mean))
    if options.references:
        return 0
    sentences, good = [], True
    for wanted, answers in found.items():
        ratios, runs, undecided = zip(*answers)
        sentence, kept_promise = summary_of(wanted, options.within, ratios, sum(undecided), sum(bool(run["met"]) for run in runs),
                                            [run["seconds"] for run in runs])
        sentences.append(sentence)
        good = good and kept_promise
    head = ["case", "mu_M", "own error, %"]
    for wanted in wanted_all:
        head += [f"to {100 * wanted:g} %: error, %", "bar, %", "met", "contact nodes", "cpu s"]
    over = f" Passed over, as the block does not slide as a whole: {'; '.join(passed)}." if passed else ""
    source = " References are those of the version before." if known else ""
    text = (f"## Do error bars hold?\n\nVersion {commit()}. {len(rows)} cases by Halton's sequences, fixed before anything was "
            f"computed.{over} `own error`: of the reference (promise.py says how it is made). `bar`: half its width. "
            f"`contact nodes`: of each mesh that was used. No cache.{source}\n\n" + "\n".join(sentences) + "\n\n"
            + markdown_table(head, rows) + "\n" + hold_text(judged, known_hold, kept, wanted_all) + ("" if options.quick else "\n" + work(judged, kept, options.output, options.within)))
    (options.output / "promise.md").write_text(text)
    print("\n".join(sentences))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
