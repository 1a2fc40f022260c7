#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a fit finds the numbers that data were made with: mu_M of nine blocks on cells half as long as the fit's, with noise,
ten times over; how often each number is in its region.

    validation/fit/recover.py [--seeds 10] [--noise 0.01] [-o results/fit]

The first table is kept as measured.csv, for fit.yaml. A call that is stopped goes on where it was."""
import argparse
import csv
import os
import random
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path.insert(0, str(Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin")).parent / "python"))
import amontons   # noqa: E402

TRUE = {"material.eta1": 0.8, "friction.critical_velocity": 4e-4}
CONDITIONS = {"mesh.set.length": [0.5, 1, 2], "load.pressure": [0.003, 0.006, 0.012]}


def study(text, path, changes):
    """The study `text` with other parts, beside fit.yaml's scene."""
    head = text[text.index("scene:"):text.index("search:")].replace("../paper", str(SOURCE / "validation/paper"))
    path.write_text(head + changes)
    return path


def make_data(folder):
    """mu_M of the conditions, on cells half as long: [(length, pressure, mu_M)]."""
    text = (HERE / "fit.yaml").read_text().replace("nx: 24, nz: 12", "nx: 48, nz: 24")
    for key, value in TRUE.items():
        text = text.replace(next(line for line in text.split("\n") if line.startswith(f"  {key}: ") and "log" not in line),
                            f"  {key}: {value:g}")
    vary = "vary: {" + ", ".join(f"{key}: {values}" for key, values in CONDITIONS.items()) + "}\nrecord: [mu_M]\n"
    rows = amontons.read_table(folder / "truth/sweep.csv") if (folder / "truth/sweep.csv").exists() else \
        amontons.sweep(study(text, folder / "truth.yaml", vary), folder=folder / "truth")
    return list(zip(*(list(rows[name]) for name in (*CONDITIONS, "mu_M"))))


def measure(data, noise, seed, path):
    """Data with noise, as a table of measurements."""
    chance = random.Random(seed)
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow([*CONDITIONS, "mu_M", "mu_M_error"])
        for length, pressure, mu in data:
            out.writerow([f"{length:g}", f"{pressure:g}", f"{mu * (1 + chance.gauss(0, noise)):.5f}", f"{noise * mu:.5f}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--noise", type=float, default=0.01)
    parser.add_argument("-o", "--output", type=Path, default=SOURCE / "results/fit")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    data = make_data(given.output.resolve())
    text = (HERE / "fit.yaml").read_text()
    inside = dict.fromkeys(TRUE, 0)
    print("| seed | " + " | ".join(f"{key}, {value:g}" for key, value in TRUE.items()) + " | misfit, 7 +- 3.7 | own share | points |")
    print("|---|" + "---|" * (len(TRUE) + 3))
    for seed in range(1, given.seeds + 1):
        table = given.output.resolve() / f"measured-{seed}.csv"
        measure(data, given.noise, seed, table)
        path = study(text, given.output / f"fit-{seed}.yaml", text[text.index("search:"):].replace("measured.csv", str(table)))
        found = amontons.fit(path, folder=given.output / f"seed-{seed}")
        cells = []
        for key, true in TRUE.items():
            value, low, high = (found["keys"][key][name] for name in ("value", "low", "high"))
            inside[key] += low <= true <= high
            cells.append(f"{value:.3g} ({low:.3g} to {high:.3g})" + ("" if low <= true <= high else " **outside**"))
        print(f"| {seed} | " + " | ".join(cells) + f" | {found['misfit']:.1f} | {found['own_share']:.2f} | {found['computed']} |", flush=True)
    print(", ".join(f"{key}: {count} of {given.seeds} inside" for key, count in inside.items()))


if __name__ == "__main__":
    main()
