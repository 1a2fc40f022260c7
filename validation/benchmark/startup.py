#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run costs outside its time loop: the first of a shape, which reduces the block, and those
that find the reduction in the cache, of the same length and of another.

    validation/benchmark/startup.py [--program build/bin/amontons] [--cells 40 80] [--repeats 20]
    validation/benchmark/startup.py --design validation/pads/pads.yaml [--repeats 5]

Runs the paper's Figure 1 up to its first step, with an empty cache of its own; its even block is made
without gmsh, and for comparison by gmsh, from a copy of block.geo with one more byte. Processor time, user
and system, from the start of the process on: all but relaxation, time loop and the system's tidying
up behind the process. Medians. Exit status 1: a run from the cache takes over 15 ms.

--design runs a whole scene with an empty cache, its mesh made without gmsh and by it in turns: the least
wall time of each stage, and the processor time of the process, in ms.
"""
import argparse
import json
import os
import resource
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
HEAD = ["cells", "unknowns", "first run, s", "by gmsh, s", "another length, ms", "by gmsh, ms",
        "from the cache, ms", "smallest", "largest"]
STAGES = ["mesh", "reduce", "relax", "solve", "total"]


def outside(program, cells, length, folder, cache="cache", geo=ROOT / "meshes/block.geo"):
    """Processor time outside the time loop, ms, and run.json."""
    mesh = f"{{length: {length}, height: {length / 2}, nx: {cells}, nz: {cells}}}"
    rod = [f"rod.height={length / 4}", f"rod.width={length / 20}"]
    settings = [f"--set={setting}" for setting in [*SETTINGS, f"mesh.file={geo}", f"mesh.set={mesh}", *rod]]
    subprocess.run([program, "run", SCENE, "-o", f"{folder}/result", "--quiet", "--overwrite",
                    *settings], check=True, env=dict(os.environ, AMONTONS_CACHE=f"{folder}/{cache}",
                                                     OPENBLAS_NUM_THREADS="1"))
    report = json.loads(Path(folder, "result", "run.json").read_text())
    return 1e3 * report["timing_s"]["outside_loop_cpu"], report


def measure(program, cells, repeats):
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        copy = Path(folder, "block.geo")
        copy.write_text((ROOT / "meshes/block.geo").read_text() + "\n")
        first, report = outside(program, cells, 1, folder)
        first_gmsh, _ = outside(program, cells, 1, folder, "cache-gmsh", copy)
        other, rescaled = outside(program, cells, 2, folder)
        other_gmsh, _ = outside(program, cells, 2, folder, "cache-gmsh", copy)
        if report["model"]["from_cache"] or not rescaled["model"]["from_cache"]:
            sys.exit("the cache was not used as it should be")
        again = [outside(program, cells, 1, folder)[0] for _ in range(repeats)]
    row = [f"{cells}x{cells}", report["model"]["reduced_dofs"], f"{first / 1e3:.2f}",
               f"{first_gmsh / 1e3:.2f}", f"{other:.0f}", f"{other_gmsh:.0f}",
           f"{statistics.median(again):.1f}", f"{min(again):.1f}", f"{max(again):.1f}"]
    return row, statistics.median(again)


def processor_ms():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1e3 * (used.ru_utime + used.ru_stime)


def run_cold(program, scene, geo):
    """Wall ms of the stages, processor ms of all, and who made the mesh."""
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        before = processor_ms()
        subprocess.run([program, "run", scene, "-o", f"{folder}/result", "--quiet", "--set", f"mesh.file={geo}",
                        "output.figures=[]"], check=True,
                       env=dict(os.environ, AMONTONS_CACHE=f"{folder}/cache", OPENBLAS_NUM_THREADS="1"))
        used = processor_ms() - before
        report = json.loads(Path(folder, "result", "run.json").read_text())
    stages = report["timing_s"]
    return report["model"]["mesh_by"], [*(1e3 * stages[name] for name in STAGES), used]


def compare_design(program, scene, repeats):
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "pads.geo")
        copy.write_text((ROOT / "meshes/pads.geo").read_text() + "\n")
        turns = [run_cold(program, scene, geo) for _ in range(repeats) for geo in (ROOT / "meshes/pads.geo", copy)]
    return [[maker, *(f"{min(times):.1f}" for times in zip(*(times for by, times in turns if by == maker)))]
            for maker in ("amontons", "gmsh")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--cells", type=int, nargs="+", default=[40, 80])
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--design", type=Path, help="a scene with a mesh of meshes/pads.geo")
    options = parser.parse_args()
    if options.design:
        print(markdown_table(["mesh by", *STAGES, "processor"],
                             compare_design(options.program, options.design, options.repeats)))
        return 0
    rows, medians = zip(*[measure(options.program, cells, options.repeats)
                          for cells in options.cells])
    print(markdown_table(HEAD, rows))
    return int(max(medians) > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
