#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What of the paper's result survives friction that remembers: the studies of this folder, and their tables as README.md
has them. Points that are there already are not computed again.

    validation/memory/memory.py [--build build] [--output results/memory] [STUDY ...]
"""
import argparse
import csv
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
STUDIES = {"pressures": "load.pressure", "lengths": "mesh.set.length", "velocities": "rod.velocity", "rests": "friction.rest",
           "fine": None}
LAWS = {"linear-weakening": "paper", "ageing": "ageing", "rate-and-state": "rate and state"}


def cell(point):
    """mu_M with its bar, and how far slip had come when it turned fast."""
    if not point["mu_M"]:
        return "-"
    bar = f" +- {float(point['mu_M_error']):.4f}" if point["mu_M_error"] else " (no bar)"
    length = f", l_c/L {float(point['l_c']):.2f}" if point["l_c"] else ""
    return f"{float(point['mu_M']):.4f}{bar}{length}"


def rest_cell(points):
    """The first peak on the finer mesh, and what the mesh changes."""
    coarse, fine = (float(point["results.mu_max"]) for point in sorted(points, key=lambda point: float(point["mesh.set.refine"])))
    return f"{fine:.4f} ({fine - coarse:+.4f})"


def number(point, key, standard):
    return float(point.get(key) or standard)


def where(point):
    return (point["friction.law"], number(point, "load.pressure", 0.003), number(point, "mesh.set.length", 1),
            number(point, "rod.velocity", 1e-5))


def bars(folder, points):
    """Whether bars of the other studies hold mu_M of the fine meshes."""
    given = {}
    for name in ("pressures", "lengths", "velocities"):
        with open(folder / name / "sweep.csv", encoding="utf-8") as file:
            given |= {where(point): point for point in csv.DictReader(file)}
    print("\nfine\n\n| law | P | L | V | mu_M | three times as fine | off by, in bars |\n|---|---|---|---|---|---|---|")
    for point in points:
        law, P, L, V = where(point)
        mu, bar, fine = (float(item) for item in (given[law, P, L, V]["mu_M"], given[law, P, L, V]["mu_M_error"], point["mu_M"]))
        print(f"| {LAWS[law]} | {P:g} | {L:g} | {V:g} | {mu:.4f} +- {bar:.4f} | {fine:.4f} | {abs(fine - mu) / bar:.2f} |")


def table(name, points):
    key = STUDIES[name]
    values = sorted({float(point[key]) for point in points})
    print(f"\n{name}\n")
    if name == "rests":
        pressures = sorted({float(point["load.pressure"]) for point in points})
        columns = [(law, P) for law in LAWS for P in pressures if any(point["friction.law"] == law for point in points)]
        print(f"| {key} | " + " | ".join(f"{LAWS[law]}, P = {P:g}" for law, P in columns) + " |")
        print("|---" * (len(columns) + 1) + "|")
        for value in values:
            row = [rest_cell([point for point in points if (point["friction.law"], float(point["load.pressure"]), float(point[key]))
                              == (law, P, value)]) for law, P in columns]
            print(f"| {value:g} | " + " | ".join(row) + " |")
        return
    print(f"| {key} | " + " | ".join(LAWS.values()) + " |")
    print("|---" * (len(LAWS) + 1) + "|")
    for value in values:
        row = {point["friction.law"]: cell(point) for point in points if float(point[key]) == value}
        print(f"| {value:g} | " + " | ".join(row.get(law, "-") for law in LAWS) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parents[1] / "build")
    parser.add_argument("--output", type=Path, default=Path("results/memory"))
    parser.add_argument("studies", nargs="*", metavar="STUDY", help=", ".join(STUDIES))
    given = parser.parse_args()
    for name in given.studies or STUDIES:
        folder = given.output / name
        subprocess.run([given.build / "bin/amontons", "sweep", "-q", HERE / f"{name}.yaml", "-o", folder], check=True)
        with open(folder / "sweep.csv", encoding="utf-8") as file:
            points = list(csv.DictReader(file))
        if name == "fine":
            bars(given.output, points)
        else:
            table(name, points)


if __name__ == "__main__":
    main()
