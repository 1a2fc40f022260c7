#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons optimise` over pads (search.yaml) against a full grid and against random designs of equal cost, three seeds each; the
best of each once more on cells half as long and with an error bar, and the search once more on cells half as long.

    validation/pads/search_study.py [-o results/pads-search] [-j N]

A call that is stopped goes on where it was. `--part search|grid|random|values|fine|bars` does one part of it (values and bars: of
the parts that are asked for with them)."""
import argparse
import csv
import itertools
import os
import random
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin")) / "amontons"
SEEDS = (1, 2, 3)
PARTS = ("search", "grid", "random", "fine", "values", "bars")
KEYS = ("mesh.set.n", "mesh.set.fill", "mesh.set.pad_height", "mesh.set.first_gap", "rod.height")
# At least as many designs as a search computes: 52, and some 20 along the keys, more where these find a better best.
GRID = ((2, 4, 6), (0.45, 0.6, 0.75), (0.03, 0.09), (0.63, 1.6), (0.15, 0.25, 0.35))
COUNT = 108
FINER = (1, 2, 3)   # mesh.set.refine: cells so many times as short
PLAIN = {"mesh.set.n": 1, "mesh.set.fill": 1, "mesh.set.pad_height": 0.05, "mesh.set.first_gap": 1, "rod.height": 0.25}


def parts():
    """search.yaml before `search:`, and from there on."""
    text = (HERE / "search.yaml").read_text().replace("scene: pads.yaml", f"scene: {HERE}/pads.yaml")
    return text[:text.index("search:")], text[text.index("search:"):]


def allowed(design):
    return (1 - design["mesh.set.fill"]) / design["mesh.set.n"] >= 0.04


def random_designs(seed):
    """Drawn as the ranges of the search say, limits kept."""
    chance, found = random.Random(seed), []
    while len(found) < COUNT:
        design = {"mesh.set.n": chance.randint(1, 8), "mesh.set.fill": chance.uniform(0.4, 0.9),
                  "mesh.set.pad_height": 0.02 * 6**chance.random(), "mesh.set.first_gap": 0.4 * 6.25**chance.random(),
                  "rod.height": chance.uniform(0.1, 0.4)}
        if allowed(design):
            found.append({key: float(f"{value:.3g}") for key, value in design.items()})
    return found


def listed(designs):
    return "[" + ",\n  ".join("{" + ", ".join(f"{key}: {value:g}" for key, value in one.items()) + "}" for one in designs) + "]"


class Study:
    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs
        folder.mkdir(parents=True, exist_ok=True)

    def call(self, command, name, text):
        path = self.folder / f"{name}.yaml"
        path.write_text(text)
        done = subprocess.run([PROGRAM, command, path, "-q", "-j", str(self.jobs), "-o", self.folder / name])
        if done.returncode not in (0, 1):
            raise SystemExit(f"{command} {path}: status {done.returncode}")
        with open(self.folder / name / "sweep.csv", newline="") as file:
            return list(csv.DictReader(file))

    def cases(self, name, designs, extra=""):
        return self.call("sweep", name, parts()[0] + extra + f"cases: {listed(designs)}\nrank: {{by: mu_hold}}\n")

    def search(self, seed, extra=""):
        return self.call("optimise", f"search-{seed}" + ("-fine" if extra else ""),
                         parts()[0] + extra + parts()[1].replace("designs: 52", f"designs: 52, seed: {seed}"))


def best_of(rows):
    """The row with the highest mu_hold, and after how many points it was within 1 % of it."""
    values = [float(row["mu_hold"] or "nan") for row in rows]
    top = max(value for value in values if value == value)
    return rows[values.index(top)], next(k + 1 for k, value in enumerate(values) if value >= 0.99 * top)


def design_of(row):
    return {key: float(row[key]) for key in KEYS}


def show_values(study, names, designs):
    """mu_hold on meshes of cells so many times as short, and how far it is usually off there."""
    print("| by | " + " | ".join(f"mu_hold, cells 1/{refine}" for refine in FINER) + " |\n|" + "---|" * (len(FINER) + 1))
    found = [study.cases(f"values-{refine}", designs, f"  mesh.set.refine: {refine}\n") for refine in FINER]
    for name, *rows in zip(names, *found):
        print(f"| {name} | " + " | ".join(f"{float(row['mu_hold']):.4f} ± {float(row['mu_hold_known_to']):.4f}" for row in rows) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=SOURCE / "results/pads-search")
    parser.add_argument("-j", "--jobs", type=int, default=2)
    parser.add_argument("--part", action="append", choices=PARTS)
    given = parser.parse_args()
    study, wanted = Study(given.output, given.jobs), given.part or PARTS
    found = {}
    if "search" in wanted:
        for seed in SEEDS:
            found[f"search, seed {seed}"] = study.search(seed)
    if "grid" in wanted:
        found["grid"] = study.cases("grid", [dict(zip(KEYS, values)) for values in itertools.product(*GRID)])
    if "random" in wanted:
        for seed in SEEDS:
            found[f"random, seed {seed}"] = study.cases(f"random-{seed}", random_designs(seed))
    if "fine" in wanted:
        found["search, seed 1, cells half as long"] = study.search(1, "  mesh.set.refine: 2\n")
    best = {name: best_of(rows) for name, rows in found.items()}
    bars, designs = {}, [design_of(row) for row, _ in best.values()] + [PLAIN]
    if "values" in wanted:
        show_values(study, list(best) + ["plain block"], designs)
    if "bars" in wanted:
        rows = study.cases("bars", designs, "  accuracy: {mu: 2%, of: mu_hold, within: 240}\n  mesh.set.refine: 2\n")
        bars = {tuple(design.values()): row for design, row in zip(designs, rows)}
    print("| by | designs | best mu_hold | within 1 % of it after | n, fill, height, first gap, rod | with a bar | over the plain block |")
    print("|---|---|---|---|---|---|---|")
    for name, (row, after) in best.items():
        design = design_of(row)
        cells = [name, str(len(found[name])), f"{float(row['mu_hold']):.4f}", str(after),
                 ", ".join(f"{value:g}" for value in design.values())]
        bar, base = (bars.get(tuple(one.values())) for one in (design, PLAIN))
        if bar and base and bar["mu_hold_error"] and base["mu_hold_error"]:
            mu, error, plain, plain_error = (float(one[key]) for one in (bar, base) for key in ("mu_hold", "mu_hold_error"))
            gain = mu / plain - 1
            cells += [f"{mu:.4f} ± {error:.4f}", f"{100 * gain:+.1f} ± {100 * (1 + gain) * ((error / mu)**2 + (plain_error / plain)**2)**0.5:.1f} %"]
        else:
            cells += [bar["mu_hold"] + ", no bar" if bar else "", ""]
        print("| " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
