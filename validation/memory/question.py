#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Does the breakdown of Amontons' law survive friction that remembers? Points with error bars, their tables, figures and page.

    validation/memory/question.py [--quick] [--only STUDY ...] [--page] [-o FOLDER]

The block is that of parameter set A (validation/paper/fig1.yaml, H = L/2). Each point is a run with an error bar (`--to 3%`) and stays
in FOLDER/question.jsonl (default validation/memory): a call that is stopped goes on where it was. Writes laws.md from page.in, with
what was measured in the place of [[names]], and the figures beside it. --quick: three pressures on coarse meshes, into
results/memory. --page: only the page, from what is there. The ten cases of the promise are cases.py's."""
import argparse
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "validation/benchmark"), str(HERE)]
sys.dont_write_bytecode = True
import page   # noqa: E402
from laws import CELLS_ASKED, CELLS_MOST, COST_CELLS, COST_LAWS, LAWS, MAIN, P, REST_CELLS, RESTS, SCENE, TO, V, length_of   # noqa: E402
from measured_run import markdown_table, run   # noqa: E402
from promise import Kept   # noqa: E402

# --- points ---------------------------------------------------------------------------------------

class Point:
    """One run: a name (Kept's `case`), a study and what is varied."""

    def __init__(self, study, law, pressure=P, length=1.0, velocity=V, within=60):
        self.study, self.law, self.pressure, self.length, self.velocity, self.within = study, law, pressure, length, velocity, within
        self.name = f"{law}: P {pressure:g}, L {length:g}, V {velocity:g}"

    def cells(self):
        """Of the scene's mesh: 40, more where 8 of them would be longer than the length over which slip starts."""
        length = length_of(LAWS[self.law], self.pressure)
        return 40 if length is None else max(40, 4 * math.ceil(CELLS_ASKED * self.length / length / 4))

    def settings(self, cells=None, slidings=8):
        cells, height = cells or self.cells(), self.length / 2
        found = [f"mesh.set={{length: {self.length:g}, height: {height:g}, nx: {cells}, nz: {cells // 2}, shape: quad}}",
                 f"rod.height={height / 2:g}", f"rod.width={height / 10:g}", f"rod.velocity={self.velocity:g}",
                 f"load.pressure={self.pressure:g}", f"time.until={{U: {slidings * self.pressure * self.length:g}}}",
                 "output.fields=none", "output.figures=[]", "output.history=false"]
        return found + [f"friction={{{', '.join(f'{key}: {value}' for key, value in LAWS[self.law].items())}}}"] * bool(LAWS[self.law])

    def compute(self):
        ended = run(SCENE, self.settings(), 600, words=["--to", f"{TO}", "--within", f"{self.within}s"])
        results, found = ended.report.get("results", {}), ended.report.get("accuracy", {})
        row = {"study": self.study, "law": self.law, "P": self.pressure, "L": self.length, "V": self.velocity, "to": TO, "within": self.within,
               "seconds": round(ended.seconds, 2), "steps": ended.report.get("steps", {}).get("accepted"), "met": found.get("met"),
               "nodes": [level["contact_nodes"] for level in found.get("levels", [])], "version": ended.report.get("version"),
               "said": ended.said[-300:]}
        keys = ("mu_M", "mu_M_error", "mu_M_is", "mu_hold", "mu_hold_error", "mu_max", "l_c_over_L", "slip_cells", "mu_steady")
        return row | {key: results.get(key) for key in keys} | precursors(results, self.length)


def precursors(results, length):
    """Per bulk sliding: how many bounded rapid ones, and how far slow slip had come before (over L; the median)."""
    slow, reaches, bounded, slidings = 0.0, [], 0, 0
    for event in results.get("events", []):
        if event["kind"] == "quasi-static":
            slow = max(slow, event["reach"] or 0)
        elif event["kind"] == "bounded rapid":
            bounded += 1
        else:
            slidings += 1
            reaches.append(slow / length)
            slow = 0.0
    reaches = sorted(reaches[1:])
    return {"bounded": bounded / slidings if slidings else None, "slow_reach": reaches[len(reaches) // 2] if reaches else None}


def points():
    pressures = (0.003, 0.01, 0.001, 0.03, 0.006, 0.002, 0.02)
    for pressure in pressures[:3]:
        yield from (Point("pressure", law, pressure) for law in MAIN)
    others = [law for law in LAWS if law not in MAIN]
    yield from (Point("variants", law, pressure) for pressure in (0.003, 0.01) for law in others if (law, pressure) != ("rate-and-state, D_c / 12", 0.01))
    yield from (Point("length", law, length=length) for length in (0.5, 2, 4, 0.25) for law in MAIN)
    yield from (Point("velocity", law, velocity=velocity) for velocity in (1e-6, 1e-4, 1e-3, 1e-7, 1e-8) for law in MAIN)
    for pressure in pressures[3:]:
        yield from (Point("pressure", law, pressure, within=60 if "rate" not in law or pressure < 0.02 else 150) for law in MAIN)
    yield from (Point("variants", law, 0.03) for law in LAWS if law.startswith("slip-weakening"))


def first_peak(law, rest, cells):
    """mu where the block first slides, from contacts that rested for `rest` before the rod began to push."""
    words = Point("rest", law).settings(cells, 3)
    words += [f"friction.rest={rest:g}"] if LAWS[law] else []
    ended = run(SCENE, words, 200)
    results = ended.report.get("results", {})
    return {"study": "rest", "law": law, "rest": rest, "cells": cells, "peaks": [peak["mu"] for peak in results.get("peaks", [])][:3],
            "mu_max": results.get("mu_max"), "seconds": round(ended.seconds, 2)}


def cost(law, cells, turn):
    ended = run(SCENE, Point("cost", law).settings(cells, 8), 200)
    steps = ended.report.get("steps", {})
    return {"study": "cost", "law": law, "cells": cells, "turn": turn, "seconds": round(ended.seconds, 3),
            "slidings": len(ended.report.get("results", {}).get("peaks", [])),
            "solve_s": ended.report.get("timing_s", {}).get("solve"),
            **{key: steps.get(key) for key in ("accepted", "rejected", "contact_solves", "contact_iterations", "certificates")}}


def resolved(point):
    """One run on a mesh with 8 cells on the length over which slip weakens, where the bar's meshes had fewer."""
    ended = run(SCENE, point.settings(slidings=5), 400)
    return {"study": "resolved", "cells": point.cells(), "mu_M": ended.report.get("results", {}).get("mu_M"), "seconds": round(ended.seconds, 2)}


class Named:
    def __init__(self, name):
        self.name = name


def compute(kept, words):
    """All that is not there yet."""
    for point in points():
        if words.only and point.study not in words.only:
            continue
        row, length = kept.obtain(point, point.study, point.compute), length_of(LAWS[point.law], point.pressure)
        if length and row["nodes"] and (row["nodes"][-1] - 1) * length < CELLS_ASKED * point.length and point.cells() <= CELLS_MOST:
            kept.obtain(point, "resolved", lambda one=point: resolved(one))
    for law in MAIN if not words.only or "rest" in words.only else ():
        for rest in RESTS if LAWS[law] else (1,):
            for cells in REST_CELLS:
                kept.obtain(Named(f"{law}: rest {rest:g}, {cells} cells"), "rest", lambda at=(law, rest, cells): first_peak(*at))
    for turn in range(3) if not words.only or "cost" in words.only else ():
        for cells in COST_CELLS:
            for law in COST_LAWS:
                kept.obtain(Named(f"{law}: {cells} cells, turn {turn}"), "cost", lambda at=(law, cells, turn): cost(*at))


def quick(folder):
    """Three pressures, one coarse mesh each: what the page says in short."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for law in MAIN:
        for pressure in (0.001, 0.003, 0.01):
            ended = run(SCENE, Point("quick", law, pressure).settings(28), 100)
            mu = ended.report.get("results", {}).get("mu_M")
            rows.append([law, f"{pressure:g}", "none" if mu is None else f"{mu:.3f}", f"{ended.seconds:.1f}"])
    (folder / "quick.md").write_text(markdown_table(["law", "P", "mu_M", "s"], rows) + "\n", encoding="utf-8")
    print((folder / "quick.md").read_text(encoding="utf-8"))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", metavar="STUDY", choices=("pressure", "variants", "length", "velocity", "rest", "cost"))
    parser.add_argument("--page", action="store_true", help="write the page from what was computed, and compute nothing")
    parser.add_argument("-o", "--output", type=Path, default=HERE)
    words = parser.parse_args()
    if words.quick:
        sys.exit(quick(ROOT / "results/memory" if words.output == HERE else words.output))
    if not words.page:
        compute(Kept(words.output / "question.jsonl"), words)
    page.write(words.output)
