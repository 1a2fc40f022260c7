#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons optimise` over pads (search.yaml), three seeds, against a full grid and three times random designs of at least equal
cost: all with error bars of up to 20 %, those that may be the best with 2 %. The best of each once more on cells a half and a third as long.

    validation/pads/search_study.py [-o results/pads-search] [-j N] [--within SECONDS]

A call that is stopped goes on where it was. `--part search-1|...|grid|random-1|...` computes some of them only; the table has those
that were computed."""
import argparse
import csv
import itertools
import math
import os
import random
import resource
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin")) / "amontons"
SEEDS = (1, 2, 3)
PARTS = [f"{by}-{seed}" for by in ("search", "random") for seed in SEEDS] + ["grid", "plain"]
KEYS = ("mesh.set.n", "mesh.set.fill", "mesh.set.pad_height", "mesh.set.first_gap", "rod.height")
# As many designs as a search computes: 52, and some 60 along the keys.
GRID = ((4, 6, 8), (0.45, 0.6, 0.75), (0.03, 0.09), (0.63, 1.6), (0.15, 0.25, 0.35))
COUNT = 108
FINER = (2, 3)   # mesh.set.refine: cells so many times as short
PLAIN = (1, 1, 0.05, 1, 0.25)


def random_designs(seed):
    """Drawn as the ranges of the search say, limits kept."""
    chance, found = random.Random(seed), []
    while len(found) < COUNT:
        design = (chance.randint(1, 8), chance.uniform(0.4, 0.9), 0.02 * 6**chance.random(), 0.4 * 6.25**chance.random(), chance.uniform(0.1, 0.4))
        if (1 - design[1]) / design[0] >= 0.04:
            found.append(tuple(float(f"{value:.3g}") for value in design))
    return found


class Study:
    def __init__(self, folder, words):
        self.folder, self.words = folder, words
        self.text = (HERE / "search.yaml").read_text().replace("scene: pads.yaml", f"scene: {HERE}/pads.yaml")
        folder.mkdir(parents=True, exist_ok=True)

    def call(self, command, name, text, *words):
        """Rows of the table; processor time is added to that of earlier calls."""
        path, cost = self.folder / f"{name}.yaml", self.folder / f"{name}.seconds"
        path.write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([PROGRAM, command, path, "-q", *self.words, *words, "-o", self.folder / name])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime"))
        cost.write_text(f"{spent + self.seconds(name):.1f}\n")
        if done.returncode not in (0, 1):
            raise SystemExit(f"{command} {path}: status {done.returncode}")

    def seconds(self, name):
        cost = self.folder / f"{name}.seconds"
        return float(cost.read_text()) if cost.exists() else 0

    def rows(self, name):
        table = self.folder / name / "sweep.csv"
        if not table.exists():
            return []
        with open(table, newline="") as file:
            return list(csv.DictReader(file))

    def cases(self, name, designs, text, *words):
        """A sweep over designs, without refining."""
        listed = ",\n  ".join("{" + ", ".join(f"{key}: {value:g}" for key, value in zip(KEYS, design)) + "}" for design in designs)
        self.call("sweep", name, f"{text[:text.index('search:')]}cases: [{listed}]\nrank: {{by: mu_hold}}\n", *words)

    def told_apart(self, name, designs, words):
        """As the search does: those whose value is not below what the best holds for sure get a bar of 2 %, until all have."""
        self.cases(name, designs, self.text, *words)
        asked = []
        while True:
            last, best = best_of(self.rows(name) + (self.rows(f"{name}-finer") if asked else []))
            more = [design for design, row in last.items() if design not in asked and number(row, "mu_hold") >= sure(last[best])
                    and number(row, "mu_hold_error") > 0.02 * number(row, "mu_hold")]
            if not more:
                return
            asked += more
            self.cases(f"{name}-finer", asked, self.text.replace("mu: 20%", "mu: 2%"), *words)

    def part(self, name, within):
        by, _, seed = name.partition("-")
        words = ["--set", f"accuracy.within={within}"] if within else []
        if by == "search":
            self.call("optimise", name, self.text.replace("designs: 52", f"designs: 52, seed: {seed}"), *words)
        elif by == "plain":
            self.cases(name, [PLAIN], self.text.replace("mu: 20%", "mu: 1%"), *words)
        else:
            self.told_apart(name, random_designs(int(seed)) if seed else list(itertools.product(*GRID)), words)


def number(row, name):
    return float(row[name] or "nan")


def sure(row):
    return number(row, "mu_hold") - number(row, "mu_hold_error")


def best_of(rows):
    """{design: its last row}, and the design that holds most for sure."""
    last = {tuple(number(row, key) for key in KEYS): row for row in rows if row["mu_hold_error"]}
    return last, max(last, key=lambda design: sure(last[design]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=SOURCE / "results/pads-search")
    parser.add_argument("-j", "--jobs", default="2")
    parser.add_argument("--within", help="wall time of a run, s: more than in search.yaml where others use the machine")
    parser.add_argument("--part", action="append", choices=PARTS)
    given = parser.parse_args()
    study = Study(given.output, ["-j", given.jobs])
    for name in given.part or PARTS:
        study.part(name, given.within)
    found = {name: best_of(study.rows(name) + study.rows(f"{name}-finer")) for name in PARTS if study.rows(name)}
    for refine in FINER:   # one mesh each
        text = study.text.replace("accuracy: {mu: 20%, of: mu_hold, within: 40}", f"mesh.set.refine: {refine}")
        study.cases(f"values-{refine}", [best for _, best in found.values()], text)
    finer = [study.rows(f"values-{refine}") for refine in FINER]
    plain = found["plain"][0][PLAIN] if "plain" in found else None
    print("| by | designs | processor time, s | n, fill, height, first gap, rod | mu_hold | over the plain block | "
          + " | ".join(f"one mesh, cells 1/{refine}" for refine in FINER) + " |\n|" + "---|" * (6 + len(FINER)))
    for name, (last, best), *values in zip(found, found.values(), *finer):
        mu, bar = (number(last[best], key) for key in ("mu_hold", "mu_hold_error"))
        gain = ""
        if plain and name != "plain":
            base, base_bar = (number(plain, key) for key in ("mu_hold", "mu_hold_error"))
            gain = f"{100 * (mu / base - 1):+.1f} ± {100 * mu / base * math.hypot(bar / mu, base_bar / base):.1f} %"
        cells = [name.replace("-", ", seed "), len(last), f"{study.seconds(name) + study.seconds(f'{name}-finer'):.0f}", ", ".join(f"{value:g}" for value in best),
                 f"{mu:.4f} ± {bar:.4f}", gain, *(f"{number(row, 'mu_hold'):.4f} ± {number(row, 'mu_hold_known_to'):.4f}" for row in values)]
        print("| " + " | ".join(map(str, cells)) + " |")


if __name__ == "__main__":
    main()
