#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run costs outside its time loop: the first of a shape, which reduces the block, and those
that find the reduction in the cache, of the same length and of another.

    validation/benchmark/startup.py [--program build/bin/amontons] [--cells 40 80] [--repeats 20]

Runs the paper's Figure 1 up to its first step, with an empty cache of its own. Processor time, user
and system, from the start of the process on: all but relaxation, time loop and the system's tidying
up behind the process. Medians. Exit status 1: a run from the cache takes over 15 ms.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from measured_run import PROGRAM, ROOT, markdown_table

SCENE = ROOT / "validation/paper/fig1.yaml"
LIMIT = 15          # ms, from the cache
SETTINGS = ["output.figures=[]", "output.fields=none", "output.history=false",
            "time.until={t: 1e-6}"]
HEAD = ["cells", "unknowns", "first run, s", "another length, ms", "from the cache, ms", "smallest", "largest"]


def outside(program, cells, length, folder):
    """Processor time outside the time loop, ms, and run.json."""
    mesh = f"{{length: {length}, height: {length / 2}, nx: {cells}, nz: {cells}}}"
    rod = [f"rod.height={length / 4}", f"rod.width={length / 20}"]
    settings = [f"--set={setting}" for setting in [*SETTINGS, f"mesh.set={mesh}", *rod]]
    subprocess.run([program, "run", SCENE, "-o", f"{folder}/result", "--quiet", "--overwrite",
                    *settings], check=True, env=dict(os.environ, AMONTONS_CACHE=f"{folder}/cache",
                                                     OPENBLAS_NUM_THREADS="1"))
    report = json.loads(Path(folder, "result", "run.json").read_text())
    return 1e3 * report["timing_s"]["outside_loop_cpu"], report


def measure(program, cells, repeats):
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        first, report = outside(program, cells, 1, folder)
        other, rescaled = outside(program, cells, 2, folder)
        if report["model"]["from_cache"] or not rescaled["model"]["from_cache"]:
            sys.exit("the cache was not used as it should be")
        again = [outside(program, cells, 1, folder)[0] for _ in range(repeats)]
    row = [f"{cells}x{cells}", report["model"]["reduced_dofs"], f"{first / 1e3:.2f}", f"{other:.0f}",
           f"{statistics.median(again):.1f}", f"{min(again):.1f}", f"{max(again):.1f}"]
    return row, statistics.median(again)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--cells", type=int, nargs="+", default=[40, 80])
    parser.add_argument("--repeats", type=int, default=20)
    options = parser.parse_args()
    rows, medians = zip(*[measure(options.program, cells, options.repeats)
                          for cells in options.cells])
    print(markdown_table(HEAD, rows))
    return int(max(medians) > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
