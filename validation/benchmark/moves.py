#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Designs of pads one after another, as a designer asks for them, each on a new mesh: what their reductions take.

    validation/benchmark/moves.py [--turns 3] [--size 0.003125] [--equal] PROGRAM ...

Programs take turns; each turn begins with an empty cache. Of each design the least of all turns (cold.md): seconds of the
reduction by the clock, and processor seconds of the whole run, of which gmsh takes 0.4.
"""
import argparse
import json
import os
import resource
import subprocess
import tempfile
from pathlib import Path

SCENE = Path(__file__).resolve().parents[1] / "pads" / "pads.yaml"
# Pads of two lengths: a design that is its own mirror image is reduced by halves. The first one, its
# pads longer, a gap half as wide, another quotient of the lengths.
UNEQUAL = ["mesh.set.n=2", "mesh.set.pad_ratio=2"]
DESIGNS = {"2 pads, fill 0.6": UNEQUAL, "fill 0.75": [*UNEQUAL, "mesh.set.fill=0.75"],
           "gap 0.1": [*UNEQUAL, "mesh.set.gap=0.1"], "1 to 3": [*UNEQUAL, "mesh.set.pad_ratio=3"]}
EQUAL = {"4 pads, fill 0.6": [], "fill 0.7": ["mesh.set.fill=0.7"], "gap 0.075": ["mesh.set.gap=0.075"],
         "8 pads": ["mesh.set.n=8"]}
SHORT = ["time.until.U=1e-7", "output.figures=[]", "output.fields=none", "output.history=false"]


def reduce(program, design, size, folder):
    """run.json of a design, processor seconds of the run."""
    settings = [f"mesh.set.size_contact={size}", f"mesh.set.size_bulk={size}", "reduction.use=always", *SHORT, *design]
    environment = dict(os.environ, AMONTONS_CACHE=str(folder / "cache"))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "run", SCENE, "-o", folder / "run", "--overwrite", "--quiet", "--set", *settings],
                   env=environment, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.loads((folder / "run" / "run.json").read_text()), spent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--size", type=float, default=0.003125, help="of cells")
    parser.add_argument("--equal", action="store_true", help="designs of equal pads, each its own mirror image")
    arguments = parser.parse_args()
    designs = EQUAL if arguments.equal else DESIGNS
    least = {}
    for _ in range(arguments.turns):
        for number, program in enumerate(arguments.programs):
            with tempfile.TemporaryDirectory(prefix="amontons-moves-") as name:
                for title, design in designs.items():
                    report, spent = reduce(program, design, arguments.size, Path(name))
                    clock, model = report["timing_s"]["reduce"], report["model"]
                    before = least.get((title, number), (clock, spent))
                    least[title, number] = min(before[0], clock), min(before[1], spent)
                    print(f"{title:18s} {program}: {clock:.2f} s, {spent:.2f} s;", model["contact_nodes"], "nodes,",
                          model["full_dofs"], "unknowns",
                          flush=True)
    for title in designs:
        print(f"{title:18s}", *("{:6.2f} {:6.2f}".format(*least[title, k]) for k in range(len(arguments.programs))))


if __name__ == "__main__":
    main()
