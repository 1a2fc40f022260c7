#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the instructions of a cold run go: callgrind's counts, which a busy machine does not change.

    validation/benchmark/cold.py [--program build/bin/amontons ...] [--cells 20 40] [--no-pads]

Figure 1 of the paper on n x n cells, and its block on four pads, each to U = 0.006 without a cache.
A count contains what is called from there; a row of a program that has no such function is empty.
Several programs: a column each. Valgrind takes half a minute at 40 x 40, ten at 80 x 80."""
import argparse
import os
import re
import subprocess
import tempfile
from pathlib import Path

from measured_run import PROGRAM, ROOT, commit, markdown_table

FIG1, PADS = ROOT / "validation/paper/fig1.yaml", ROOT / "validation/pads/pads.yaml"
COMMON = ["output.figures=[]", "output.fields=none", "output.history=false",
          "reduction.cache=false", "time.until.U=0.006"]
ROWS = {"all": ["main"],
        "mesh, but for loading gmsh": ["model_read_mesh"],
        "assembly": ["bulk_assemble"],
        "reduction": ["reduction_build"],
        "- factors of the mesh": ["sparse_factorise"],
        "- responses of the mesh": ["sparse_expand_many", "sparse_expand"],
        "- new modes": ["basis_extend"],
        "- static modes": ["basis_start"],
        "- the basis's own S": ["basis_condense"],
        "- eigenvalues of the error": ["dense_eigen"],
        "- K x, C x": ["sparse_apply"],
        "time loop": ["simulation_loop"]}
COUNT = re.compile(r"^\s*([\d,]+) \(.*?\)\s+\S*?:(\w+)(?:\.\w+)*(?: \[|$)")


def count(program, scene, settings, folder):
    """{function: instructions, of all it calls too}"""
    found = {}
    out = Path(folder, "callgrind.out")
    subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, "run", scene,
                    "--quiet", "--overwrite", "-o", f"{folder}/result",
                    *[f"--set={setting}" for setting in COMMON + settings]],
                   check=True, capture_output=True,
                   env=dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_THREAD_LIMIT="1"))
    said = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--auto=no", "--threshold=100",
                           out], check=True, capture_output=True, text=True).stdout
    for line in said.splitlines():
        row = COUNT.match(line)
        if row:
            number = int(row[1].replace(",", ""))
            found[row[2]] = max(found.get(row[2], 0), number)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", nargs="+", default=[PROGRAM])
    parser.add_argument("--cells", type=int, nargs="+", default=[20, 40])
    parser.add_argument("--no-pads", dest="pads", action="store_false")
    options = parser.parse_args()
    cases = [(f"{n}x{n}", FIG1, [f"mesh.set.nx={n}", f"mesh.set.nz={n}"]) for n in options.cells]
    cases += [("4 pads", PADS, [])] if options.pads else []
    columns = []
    with tempfile.TemporaryDirectory() as folder:
        for _, scene, settings in cases:
            columns += [count(program, scene, settings, folder) for program in options.program]
    head = ["10^6 instructions"] + [name for name, *_ in cases for _ in options.program]
    rows = []
    for name, functions in ROWS.items():
        sums = [sum(column.get(function, 0) for function in functions) for column in columns]
        rows.append([name] + [f"{number / 1e6:.0f}" if number else "" for number in sums])
    print(f"version {commit()}\n\n{markdown_table(head, rows)}")


if __name__ == "__main__":
    main()
