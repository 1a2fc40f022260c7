#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Implicit against explicit stepping: the same answer, and what each costs.

    python3 validation/benchmark/explicit.py [--program build/bin/amontons] [--cells 20 40 80]

First the mean of the periodic peaks of explicit.yaml (20x20) by both schemes. Then the time loop of
the paper's Figure 1 (U to 0.006) on meshes of `--cells`. The explicit run is done whole up to
`--whole` cells; on finer meshes a short stretch is measured and scaled by the number of steps.
Implicit and explicit runs take turns, and of the implicit ones the median counts. On a busy machine
believe the processor times: wall times the part of it that the program had a processor. Exit status
1: mu_M differ by over 1 %.
"""
import argparse
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCENE = HERE / "explicit.yaml"
REPEATS = 3            # of each implicit run
T_END = 600.0          # U = 0.006 at V = 1e-5
STRETCH = 2.0          # of time, where the whole run would take too long
MU_TOLERANCE = 0.01


def run(program, *settings):
    """run.json of a run of the scene, and what part of its wall time it had a processor."""
    words = [f"--set={setting}" for setting in settings]
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "run", SCENE, *words, "-o", f"{folder}/result", "--quiet"],
                       check=True)
        elapsed = time.monotonic() - started
        result = json.loads(Path(folder, "result", "run.json").read_text())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return result, used / elapsed


def compare_mu(program):
    """mu_M by both schemes; their relative difference."""
    mu = {}
    print("Periodic regime, 20x20\n")
    print("| scheme | mu_M | spread | all peaks | steps |\n|---|---|---|---|---|")
    for scheme in ("sdirk2", "explicit"):
        result, _ = run(program, f"time.scheme={scheme}")
        found = result["results"]
        mu[scheme] = found["mu_M"]
        peaks = " ".join(format(peak["mu"], ".4f") for peak in found["peaks"])
        print(f"| {scheme} | {found['mu_M']:.5f} | {found['mu_M_spread']:.5f} | {peaks} | "
              f"{result['steps']['accepted']} |", flush=True)
    return abs(mu["explicit"] / mu["sdirk2"] - 1)


def loop_times(result, share, scale=1):
    """Of the time loop: wall time and processor time, s."""
    wall = scale * result["timing_s"]["solve"]
    return wall, wall * share


def time_pair(program, cells, whole):
    """A row: what the run to T_END costs on cells x cells."""
    mesh = (f"mesh.set.nx={cells}", f"mesh.set.nz={cells}", "output.history=false")
    duration = T_END if whole else STRETCH
    scale = T_END / duration
    implicit = []
    for turn in range(REPEATS):
        implicit.append(run(program, *mesh, f"time.until={{t: {T_END}}}", "time.scheme=sdirk2"))
        if turn == 0:
            explicit = run(program, *mesh, f"time.until={{t: {duration}}}")
    times = [loop_times(*one) for one in implicit]
    wall, used = (statistics.median(column) for column in zip(*times))
    explicit_wall, explicit_used = loop_times(*explicit, scale)
    steps, dt = explicit[0]["steps"]["accepted"] * scale, explicit[0]["rungs"][0]["dt"]
    implicit_steps = implicit[0][0]["steps"]["accepted"]
    return (f"| {cells}x{cells} | {implicit_steps} | {wall:.3f} | {used:.3f} | {steps:.3g} | "
            f"{dt:.3g} | {1e6 * explicit_used / steps:.1f} | {explicit_wall:.4g} | "
            f"{explicit_used:.4g} | {'whole' if whole else 'scaled'} | "
            f"{explicit_wall / wall:.0f} | {explicit_used / used:.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=HERE.parent.parent / "build" / "bin" / "amontons")
    parser.add_argument("--cells", type=int, nargs="*", default=[20, 40, 80])
    parser.add_argument("--whole", type=int, default=40)
    parser.add_argument("--skip-mu", action="store_true", help="the cost only")
    options = parser.parse_args()
    difference = 0 if options.skip_mu else compare_mu(options.program)
    if not options.skip_mu:
        print(f"\nThe two mu_M differ by {100 * difference:.3f} %.\n", flush=True)
    print("Cost of the time loop to U = 0.006, s: wall, and of it on a processor\n")
    print("| mesh | implicit steps | wall | cpu | explicit steps | dt | us/step | wall | cpu | "
          "measured | ratio, wall | cpu |\n|" + 12 * "---|")
    for cells in options.cells:
        print(time_pair(options.program, cells, cells <= options.whole), flush=True)
    return 1 if difference > MU_TOLERANCE else 0


if __name__ == "__main__":
    sys.exit(main())
