#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The same answers with other kernels of OpenBLAS: ten scenes, each once as it is and once with an error bar, under the
kernels of five kinds of processor.

    validation/hostile/kernels.py [-j N] [-o FOLDER] [--page docs/reliability.md]

A run as it is multiplies a difference of rounding at each sliding: where load drops come in another order or number, or
one differs by more than BRANCH, a branch was flipped, and the table says so. An answer with a bar must agree with that of the first kernels
within both bars, as errors that are independent of each other. Prints a table and leaves kernels.md in FOLDER (default
results/hostile), and in the place of the table on a page. Exit status 1: two answers differ by more than their bars.
"""
import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from cases import ROOT
from tries import PROGRAM, SCRATCH

KERNELS = ["Haswell", "Prescott", "Nehalem", "SkylakeX", "Zen"]
BRANCH = 1e-3          # of mu: rounding alone moves a drop by less
WITHIN, WANTED = "60s", "2%"
BLOCK, PADS = "validation/paper/fig1.yaml", "validation/pads/pads.yaml"
COARSE = ["mesh.set.nx=40", "mesh.set.nz=20"]
SCENES = {
    "block, Figure 1": (BLOCK, COARSE),
    "block, four times the pressure": (BLOCK, [*COARSE, "load.pressure=0.012", "time.until={U: 0.06}"]),
    "block, cells of order 2": (BLOCK, ["mesh.set.nx=20", "mesh.set.nz=10", "mesh.set.order=2"]),
    "block, plane strain, exponential law": (BLOCK, [*COARSE, "material.plane=strain", "friction.law=exponential-weakening"]),
    "block, bonded rod": (BLOCK, [*COARSE, "rod.kind=bonded"]),
    "block, soft machine": (BLOCK, [*COARSE, "rod.stiffness=0.1", "time.until={U: 0.06}"]),
    "block, parameter set B": ("validation/paper/set-b.yaml", []),
    "four pads": (PADS, ["mesh.set.n=4", "mesh.set.size_contact=0.015"]),
    "arch": ("docs/examples/arch.yaml", []),
    "PMMA, SI": ("docs/examples/pmma.yaml", []),
}


def run(scene, kernels, bar, scratch):
    """run.json's results and drops. bar: with an error bar."""
    path, settings = SCENES[scene]
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        words = [PROGRAM, "run", ROOT / path, "-o", f"{folder}/out", "--quiet", "--set", *settings, "output.history=false",
                 "output.fields=none", "output.figures=[]"]
        done = subprocess.run([*words, *(["--to", WANTED, "--within", WITHIN] if bar else [])], capture_output=True, text=True,
                              env=os.environ | {"AMONTONS_CACHE": "", "OPENBLAS_CORETYPE": kernels})
        if done.returncode != 0:
            raise RuntimeError(f"{scene}, {kernels}: {done.stderr}")
        report = json.loads((Path(folder) / "out/run.json").read_text())
    if report["kernels"]["openblas"].lower() != kernels.lower():
        raise RuntimeError(f"{kernels} were asked for, {report['kernels']['openblas']} computed")
    return report["results"]


def compare_drops(one, other):
    """"2e-9", the largest difference of a load drop; or which drop is of another branch."""
    tops = [[drop["mu"] for drop in results["drops"]["list"]] for results in (one, other)]
    largest = 0
    for k, pair in enumerate(zip(*tops)):
        if abs(pair[0] - pair[1]) > BRANCH:
            return f"another branch from drop {k + 1} of {len(tops[0])} on"
        largest = max(largest, abs(pair[0] - pair[1]))
    if len(tops[0]) != len(tops[1]):
        return f"{len(tops[1])} drops, {len(tops[0])} with the first"
    return f"{largest:.0e}"


def compare_bars(one, other):
    """(difference over the root of the sum of both bars' squares of mu_hold and mu_M where both have one)."""
    ratios = [abs(one[name] - other[name]) / math.hypot(one[f"{name}_error"], other[f"{name}_error"])
              for name in ("mu_hold", "mu_M")
              if None not in (one[name], other[name], one[f"{name}_error"], other[f"{name}_error"])]
    return max(ratios, default=math.nan)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/hostile")
    parser.add_argument("--page", type=Path, help="its table is written anew")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=SCRATCH) as scratch, ThreadPoolExecutor(options.jobs) as pool:
        found = {(scene, kernels, bar): pool.submit(run, scene, kernels, bar, scratch)
                 for scene in SCENES for bar in (False, True) for kernels in KERNELS}
        rows, wrong = [], 0
        for scene in SCENES:
            plain, barred = ([found[scene, kernels, bar].result() for kernels in KERNELS] for bar in (False, True))
            first = barred[0]
            error = first["mu_hold_error"]
            ratios = [compare_bars(first, other) for other in barred[1:]]
            wrong += sum(ratio > 1 for ratio in ratios)
            rows.append([scene, f"{first['mu_hold']:.4f} +- {error:.2g}" if error else "no bar",
                         *(f"{compare_drops(plain[0], other)}; {ratio:.2g}" for other, ratio in zip(plain[1:], ratios))])
            print(f"{rows[-1]}", file=sys.stderr, flush=True)
    head = ["scene", f"mu_hold, {KERNELS[0]}", *KERNELS[1:]]
    text = "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])
    options.output.mkdir(parents=True, exist_ok=True)
    (options.output / "kernels.md").write_text(text + "\n")
    if options.page:
        options.page.write_text(re.sub(r"^\| scene \| mu_hold,.*?\n(?!\|)", lambda _: text + "\n", options.page.read_text(), flags=re.S | re.M))
    print(f"{text}\n\n{len(rows) * (len(KERNELS) - 1)} answers compared, {wrong} beyond their bars")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
