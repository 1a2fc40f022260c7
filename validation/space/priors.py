#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How far do answers scatter from mesh to mesh in space? Values of mu_M and mu_hold on meshes 2^(1/4) apart.

    validation/space/priors.py [--problems N] [-o FOLDER]

Draws blocks and blocks on pads in space (a seed, so always the same), runs each on a row of meshes until its load drops repeat, and
keeps values in FOLDER/priors.jsonl (default validation/space): a call that was stopped goes on where it was. Then says by how much
a mesh is off the two finest, times nodes along the contact and times cells that slip where slip turns
fast, and which bars of coarser meshes would hold by the constants of src/answers/error_bars.c (validation/space/priors.md)."""
import argparse
import json
import math
import os
import random
import resource
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import PROGRAM, markdown_table   # noqa: E402
from priors import Constants, bar_of   # noqa: E402

SEED, STEPS = 20261125, range(-2, 4)     # of refine, in powers of 2^(1/4); the last two are the reference
FINEST = 2                                # meshes


def draw(number):
    """The settings of problem `number`: a block, or every third time one on pads."""
    dice = random.Random(f"{SEED} {number}")
    length = dice.uniform(0.5, 2)
    breadth, height = length * math.exp(dice.uniform(math.log(0.3), math.log(2))), length * dice.uniform(0.3, 1.2)
    pressure = math.exp(dice.uniform(math.log(1.5e-3), math.log(1.5e-2)))
    rod, velocity, eta = dice.uniform(0.1, 0.6) * height, math.exp(dice.uniform(math.log(1e-5), math.log(4e-5))), dice.uniform(0.7, 1.4)
    if number % 3 == 2:
        n, m = dice.randint(1, 3), dice.randint(1, 2)
        fill_x = dice.uniform(0.4, 0.8)
        fill_y = dice.uniform(0.4, 0.8) if m > 1 else 1
        cells_x, cells_y = max(round(8 / (2 * n - 1)), 2), max(round(8 / (2 * m - 1) * math.sqrt(breadth / length)), 2)
        file, shape = "pads3d.geo", dict(n=n, m=m, fill_x=fill_x, fill_y=fill_y, pad_height=0.08 * height, height=0.92 * height,
                                         cells_x=cells_x, cells_y=cells_y, cells_pad_height=1, nz=round(8 * height / length) + 1)
    else:
        cell = math.sqrt(length * breadth) / 8
        file, shape = "block3d.geo", dict(height=height, nx=max(round(length / cell), 2), ny=max(round(breadth / cell), 2),
                                          nz=max(round(height / cell), 2))
    shape |= dict(length=length, breadth=breadth)
    slides = 0.38 * pressure * length * (length / 2 / height + 2 * rod / length + 4 * (rod / length)**3)
    mesh = ", ".join(f"{key}: {value:.6g}" for key, value in shape.items())
    return file, mesh, [f"load.pressure={pressure:.5g}", f"rod.height={rod:.5g}", f"rod.width={0.1 * height:.5g}",
                        f"rod.velocity={velocity:.4g}", f"material.eta1={eta:.4g}", f"material.eta2={eta:.4g}",
                        f"time.until.U={25 * slides:.4g}"]


def value_on_mesh(number, refine, folder):
    """{refine, nodes, cells, mu_M, mu_hold, seconds} of one run; None where it fails."""
    file, mesh, settings = draw(number)
    words = [word for setting in (f"mesh={{file: {ROOT}/meshes/{file}}}", f"mesh.set={{{mesh}, refine: {refine:.6g}}}", *settings)
             for word in ("--set", setting)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([PROGRAM, "run", Path(__file__).with_name("problem.yaml"), *words, "-o", folder, "--overwrite", "-q"],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"problem {number}, refine {refine:.3g}: {done.stderr.strip()[:300]}", file=sys.stderr)
        return None
    said = json.loads(Path(folder, "run.json").read_text())
    results, model = said["results"], said["model"]
    along = dict(part.split(": ") for part in mesh.split(", "))
    aspect = float(along["length"]) / float(along["breadth"])
    return {"refine": round(refine, 6), "nodes": round(math.sqrt(model["contact_nodes"] * aspect), 3),
            "cells": results["slip_cells"], "mu_M": results["mu_M"], "mu_hold": results["mu_hold"],
            "drops": sum(peak["counts"] for peak in results["peaks"]), "period": results["period"],
            "steps": said["steps"]["accepted"], "seconds": round(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, 2)}


def compute(count, path):
    """The rows of `path`, one a problem, computed where they are not there."""
    rows = {row["number"]: row for row in map(json.loads, path.read_text().splitlines())} if path.exists() else {}
    for number in range(count):
        if number in rows:
            continue
        meshes = [value_on_mesh(number, 2**(step / 4), path.parent / "work") for step in STEPS]
        rows[number] = {"number": number, "file": draw(number)[0], "meshes": [mesh for mesh in meshes if mesh]}
        with path.open("a") as out:
            out.write(json.dumps(rows[number]) + "\n")
    return [rows[number] for number in sorted(rows) if number < count]


def of_answer(rows, name):
    """Problems as validation/benchmark/priors.py has them: values on all meshes but the finest, the mean of these as reference."""
    problems = []
    for row in rows:
        meshes = [mesh for mesh in row["meshes"] if mesh[name] is not None]
        if len(meshes) < FINEST + 3:
            continue
        last = [mesh[name] for mesh in meshes[-FINEST:]]
        problems.append({"number": row["number"], "answer": name, "mu": statistics.mean(last), "own": (max(last) - min(last)) / 2,
                         "meshes": [mesh | {"cells": mesh["nodes"] - 1 if mesh["cells"] is None else mesh["cells"], "wait": 0,
                                            "values": [mesh[name]]} for mesh in meshes[:-FINEST]]})
    return problems


def scatter_text(problems):
    table = []
    for name, chosen in problems.items():
        for size in ("nodes", "cells"):
            off = sorted(abs(mesh[name] / problem["mu"] - 1) * mesh[size] for problem in chosen for mesh in problem["meshes"])
            table.append([name, size, str(len(off)), *(f"{off[int(part * (len(off) - 1))]:.3f}" for part in (0.5, 0.8, 0.9, 0.95)), f"{off[-1]:.3f}"])
    return markdown_table(["answer", "off, times", "meshes", "median", "8 of 10 below", "9 of 10", "19 of 20", "worst"], table)


def bars_text(problems):
    """Bars of two and more of the meshes that have no part in the reference; what its own error may be is taken off."""
    table = []
    for usual, least in ((0.05, 0.1), (0.05, 0.2), (0.05, 0.3), (0.1, 0.2), (0.1, 0.3), (0.2, 0.2)):
        for name, chosen in problems.items():
            ratios, lengths = [], []
            for problem in chosen:
                for count in range(2, len(problem["meshes"]) + 1):
                    value, bar = bar_of(problem, problem["meshes"][:count], Constants(usual=usual, least=least))
                    ratios.append(max(abs(value - problem["mu"]) - problem["own"], 0) / bar)
                    lengths.append(bar / value)
            ratios.sort()
            table.append([f"{usual:g} over cells that slip, {least:g} over nodes", name, str(len(ratios)), f"{100 * sum(ratio <= 1 for ratio in ratios) / len(ratios):.0f}",
                          f"{ratios[-1]:.2f}", f"{statistics.median(ratios):.2f}", f"{100 * statistics.median(lengths):.1f}"])
    return markdown_table(["constants", "answer", "bars", "hold, %", "worst error, bars", "median error, bars", "median bar, %"], table)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=int, default=16)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    words = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    rows = compute(words.problems, words.output / "priors.jsonl")
    problems = {name: of_answer(rows, name) for name in ("mu_M", "mu_hold")}
    own = [problem["own"] / problem["mu"] for chosen in problems.values() for problem in chosen]
    text = f"""# How far meshes in space are off

`validation/space/priors.py --problems {words.problems}`: blocks and blocks on pads, seed {SEED}, {len(STEPS)} meshes each, 2^(1/4) apart, one run a
mesh. The mean of the {FINEST} finest is the reference; they differ by {200 * statistics.median(own):.2f} % in the median. Nodes: along the contact, of cells as long as broad.

{scatter_text(problems)}

Bars of two and more of the coarser meshes, by the rule of src/answers/error_bars.c with the constants that it has (0.05 and 0.2) and
others; half of the distance between the two finest is taken off each error:

{bars_text(problems)}
"""
    (words.output / "priors.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
