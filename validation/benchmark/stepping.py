#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the instructions of the time loop go, and what does not come from the processor's second
cache: callgrind's counts, which a busy machine does not change.

    validation/benchmark/stepping.py [--program build/bin/amontons ...] [--cells 80] [--until 0.006]

Figure 1 of the paper on n x n cells; a first run fills the cache with its reduced basis. A count
contains what is called from there. Several programs: two columns each. Ten minutes at 80 x 80."""
import argparse
import os
import re
import subprocess
import tempfile

from measured_run import PROGRAM, ROOT, commit, markdown_table

SCENE = ROOT / "validation/paper/fig1.yaml"
COMMON = ["output.figures=[]", "output.fields=none", "output.history=false"]
SECOND_CACHE = "--LL=1048576,8,64"     # callgrind knows a first and a last one: 1 MB, as of a Zen 4
ROWS = {"time loop": ["simulation_loop"],
        "- stages": ["sdirk_step"],
        "- - right-hand side on the interface": ["interface_operator_condense"],
        "- - velocities inside": ["interface_operator_expand"],
        "- - M v and K v": ["bulk_operator_apply"],
        "- - contact": ["contact_solve"],
        "- - - r = S v - g": ["contact_react"],
        "- certificate": ["certificate_holds", "certificate_step_resolves", "certificate_finds_runaway"],
        "LU, of contact and certificate": ["dense_lu"],
        "levels of dt, before the loop": ["dt_level_operator"]}
COUNT = re.compile(r"^\s*([\d,]+) \([^)]*\)\s+([\d,]+) \([^)]*\)\s+\S*?:(\w+)(?:\.\w+)*(?: \[|$)")


def count(program, settings, folder):
    """{function: (instructions, reads that miss the second cache), of all it calls too}"""
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", AMONTONS_CACHE=f"{folder}/cache")
    words = [program, "run", SCENE, "--quiet", "--overwrite", "-o", f"{folder}/result",
             *[f"--set={setting}" for setting in COMMON + settings]]
    subprocess.run([*words, "--set=time.until.t=1"], check=True, env=environment)
    out = f"{folder}/callgrind.out"
    subprocess.run(["valgrind", "--tool=callgrind", "--cache-sim=yes", SECOND_CACHE,
                    f"--callgrind-out-file={out}", *words], check=True, capture_output=True,
                   env=environment)
    said = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--auto=no", "--threshold=100",
                           "--show=Ir,DLmr", out], check=True, capture_output=True, text=True).stdout
    found = {}
    for line in said.splitlines():
        row = COUNT.match(line)
        if row:
            numbers = [int(text.replace(",", "")) for text in row.groups()[:2]]
            found[row[3]] = max(found.get(row[3], [0, 0]), numbers)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", nargs="+", default=[PROGRAM])
    parser.add_argument("--cells", type=int, default=80)
    parser.add_argument("--until", type=float, default=0.006)
    options = parser.parse_args()
    settings = [f"mesh.set.nx={options.cells}", f"mesh.set.nz={options.cells}",
                f"time.until.U={options.until}"]
    columns = []
    for program in options.program:
        with tempfile.TemporaryDirectory() as folder:
            columns.append(count(program, settings, folder))
    head = ["10^6"] + [name for _ in columns for name in ("instructions", "misses of 1 MB")]
    rows = []
    for name, functions in ROWS.items():
        sums = [sum(column.get(function, [0, 0])[k] for function in functions)
                for column in columns for k in (0, 1)]
        rows.append([name] + [f"{number / 1e6:.{k % 2}f}" for k, number in enumerate(sums)])
    print(f"version {commit()}\n\n{markdown_table(head, rows)}")


if __name__ == "__main__":
    main()
