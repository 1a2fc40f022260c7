#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Implicit against explicit stepping: the same answer, and what each costs; and what the parts of
an implicit run cost, from nothing, from the cache, and on the full mesh.

    python3 validation/benchmark/explicit.py [--program build/bin/amontons] [--cells 20 40 80] [-o FOLDER]

First the mean of the periodic peaks of explicit.yaml (20x20) by both schemes. Then the time loop of
the paper's Figure 1 (U to 0.006) on meshes of `--cells`. The explicit steps are a plain yardstick,
made to be read (src/stepping/explicit_reference.c): a code made for them would take some half of
their time. The explicit run is done whole up to
`--whole` cells; on finer meshes a short stretch is measured and scaled by the number of steps.
Implicit and explicit runs take turns, and of the implicit ones the median counts. On a busy machine
believe the processor times: wall times the part of it that the program had a processor. FOLDER gets
what is printed as explicit.md. Exit status 1: mu_M differ by over 1 %.
"""
import argparse
import json
import os
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


class Section:
    """What is said: printed at once, and kept for the report."""

    def __init__(self):
        self.lines = ["## Against explicit steps and the full mesh", ""]

    def say(self, text=""):
        print(text, flush=True)
        self.lines.append(text)


def run(program, *settings, cache=None):
    """run.json of a run of the scene, and what part of its wall time it had a processor."""
    place = {**os.environ, "AMONTONS_CACHE": str(cache)} if cache else None
    words = [f"--set={setting}" for setting in settings]
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "run", SCENE, *words, "-o", f"{folder}/result", "--quiet"],
                       check=True, env=place)
        elapsed = time.monotonic() - started
        result = json.loads(Path(folder, "result", "run.json").read_text())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return result, used / elapsed


def compare_mu(program, section):
    """mu_M by both schemes; their relative difference."""
    mu = {}
    section.say("Periodic regime, 20x20\n")
    section.say("| scheme | mu_M | spread | all peaks | steps |\n|---|---|---|---|---|")
    for scheme in ("sdirk2", "explicit"):
        result, _ = run(program, f"time.scheme={scheme}")
        found = result["results"]
        mu[scheme] = found["mu_M"]
        peaks = " ".join(format(peak["mu"], ".4f") for peak in found["peaks"])
        section.say(f"| {scheme} | {found['mu_M']:.5f} | {found['mu_M_spread']:.5f} | {peaks} | "
                    f"{result['steps']['accepted']} |")
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
    steps, dt = explicit[0]["steps"]["accepted"] * scale, explicit[0]["step_sizes"][0]["dt"]
    implicit_steps = implicit[0][0]["steps"]["accepted"]
    return (f"| {cells}x{cells} | {implicit_steps} | {wall:.3f} | {used:.3f} | {steps:.3g} | "
            f"{dt:.3g} | {1e6 * explicit_used / steps:.1f} | {explicit_wall:.4g} | "
            f"{explicit_used:.4g} | {'whole' if whole else 'scaled'} | "
            f"{explicit_wall / wall:.0f} | {explicit_used / used:.0f} |")


def parts_of_run(program, cells):
    """A row: an implicit run to T_END with an empty cache, from the cache, and on the full mesh."""
    words = (f"mesh.set.nx={cells}", f"mesh.set.nz={cells}", "output.history=false",
             f"time.until={{t: {T_END}}}", "time.scheme=sdirk2")
    with tempfile.TemporaryDirectory() as cache:
        cold = run(program, *words, cache=cache)[0]
        cached = [run(program, *words, cache=cache)[0] for _ in range(REPEATS)]
        full = run(program, *words, "reduction.use=never", cache=cache)[0]
    solve = statistics.median(one["timing_s"]["solve"] for one in cached)
    outside = statistics.median(one["timing_s"]["outside_loop_cpu"] for one in cached)
    full_solve = full["timing_s"]["solve"]
    return (f"| {cells}x{cells} | {cached[0]['steps']['accepted']} | {solve:.3f} | "
            f"{1000 * outside:.1f} | {cold['timing_s']['reduce']:.2f} | {full_solve:.2f} | "
            f"{full_solve / solve:.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", default=HERE.parent.parent / "build" / "bin" / "amontons")
    parser.add_argument("--cells", type=int, nargs="*", default=[20, 40, 80])
    parser.add_argument("--whole", type=int, default=40)
    parser.add_argument("--skip-mu", action="store_true", help="the cost only")
    parser.add_argument("--quick", action="store_true", help="20x20, the cost only")
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER")
    options = parser.parse_args()
    if options.quick:
        options.cells, options.skip_mu = [20], True
    section = Section()
    difference = 0 if options.skip_mu else compare_mu(options.program, section)
    if not options.skip_mu:
        section.say(f"\nThe two mu_M differ by {100 * difference:.3f} %.\n")
    section.say("Parts of an implicit run of Figure 1 to U = 0.006, wall s, and CPU ms outside its "
                "loop from the cache\n")
    section.say("| mesh | steps | loop | outside, ms | cold reduction | loop, full mesh | ratio |\n|" +
                7 * "---|")
    for cells in options.cells:
        section.say(parts_of_run(options.program, cells))
    section.say("\nThe time loop by both schemes, s: wall, and of it on a processor\n")
    section.say("| mesh | implicit steps | wall | cpu | explicit steps | dt | us/step | wall | cpu | "
                "measured | ratio, wall | cpu |\n|" + 12 * "---|")
    for cells in options.cells:
        section.say(time_pair(options.program, cells, cells <= options.whole))
    if options.output:
        options.output.mkdir(parents=True, exist_ok=True)
        (options.output / "explicit.md").write_text("\n".join(section.lines) + "\n")
    return 1 if difference > MU_TOLERANCE else 0


if __name__ == "__main__":
    sys.exit(main())
