#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What of the paper's result survives friction that remembers: the studies of this folder, and their tables as README.md
has them. Points that are there already are not computed again.

    validation/memory/memory.py [--build build] [--output results/memory] [STUDY ...]
"""
import argparse
import csv
import json
import os
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


VELOCITIES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
TURNS = 2


def friction_of(law):
    """As pressures.yaml gives it to that law, on one line; none: the scene's own."""
    lines = (HERE / "pressures.yaml").read_text(encoding="utf-8").splitlines()
    return [line.split("friction: ", 1)[1].rsplit("}", 1)[0] for line in lines if f"law: {law}," in line]


def run_once(program, folder, law, V):
    words = [program, "run", HERE / "paper.yaml", "-q", "--overwrite", "-o", folder, "--set", f"rod.velocity={V}", "output.figures=[]"]
    process = subprocess.Popen(words + [f"friction={text}" for text in friction_of(law)], stderr=subprocess.DEVNULL)
    used = os.wait4(process.pid, 0)[2]
    report = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    return used.ru_utime + used.ru_stime, report


def cost(program, folder):
    """Steps and processor time (least of TURNS) a sliding, of all laws at all velocities on one mesh."""
    print("\ncost\n\n| V | law | slidings | steps | steps a sliding | over paper | iterations a stage | us a stage | s | s a sliding | over paper |")
    print("|---" * 11 + "|")
    for V in VELOCITIES:
        base = None
        for law, name in LAWS.items():
            runs = [run_once(program, folder / "cost", law, V) for _ in range(TURNS)]
            seconds, (_, report) = min(run[0] for run in runs), runs[0]
            steps, slidings = report["steps"], max(len(report["results"]["peaks"]), 1)
            each = steps["accepted"] / slidings, seconds / slidings
            base = base or each
            print(f"| {V:g} | {name} | {len(report['results']['peaks'])} | {steps['accepted']} | {each[0]:.0f} | {each[0] / base[0]:.2f} "
                  f"| {steps['contact_iterations'] / steps['contact_solves']:.2f} | {1e6 * seconds / steps['contact_solves']:.0f} "
                  f"| {seconds:.2f} | {each[1]:.3f} | {each[1] / base[1]:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parents[1] / "build")
    parser.add_argument("--output", type=Path, default=Path("results/memory"))
    parser.add_argument("studies", nargs="*", metavar="STUDY", help=", ".join([*STUDIES, "cost"]))
    given = parser.parse_args()
    for name in given.studies or [*STUDIES, "cost"]:
        if name == "cost":
            cost(given.build / "bin/amontons", given.output)
            continue
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
