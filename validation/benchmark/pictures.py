#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture costs: processor time of `amontons render` from its start to its end, user and system, as the operating system
counts it; least and median of --repeats runs. What is drawn: a slip map of 20 000 steps of 81 contact nodes, the three figures
of that run, a field of 80 x 80 elements, maps of sweeps of 1e5 points (a grid, and scattered ones), the latter from a sweep.h5
that is written here.

    validation/benchmark/pictures.py [--program build/bin/amontons] [--repeats 9] [--before OTHER/build/bin/amontons]

--before: each picture is drawn by both in turn; the last column is the median of the ratios of their times.

Exit status 1: a least time is over its limit.
"""
import argparse
import json
import os
import statistics
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from measured_run import PROGRAM, ROOT, markdown_table

STEPS, POINTS = 20_000, 100_000
SCENE = ROOT / "docs/examples/block.yaml"
SCATTERED = "{x: load.pressure, y: mesh.set.length, color: mu_M}"
MAP = SCATTERED[:-1] + ", contours: l_c}"
HEAD = ["picture", "least, s", "median, s", "limit, s", "over before"]


def processor_time(arguments):
    """Of one process and those it starts, s."""
    child = os.fork()
    if child == 0:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.execv(arguments[0], [str(word) for word in arguments])
    _, status, used = os.wait4(child, 0)
    if status:
        sys.exit(f"{arguments} ended with status {status}")
    return used.ru_utime + used.ru_stime


def make_run(program, folder, *settings):
    processor_time([program, "run", SCENE, "-o", folder, "--quiet", "--set=output.figures=[]", *(f"--set={word}" for word in settings)])


def make_history(program, folder):
    """A run of as many steps: every step is kept."""
    make_run(program, folder, "mesh.set={nx: 80, nz: 20}", "time.until={U: 0.15}")
    steps = json.loads((folder / "run.json").read_text())["steps"]["accepted"]
    if steps < STEPS:
        sys.exit(f"the run has {steps} steps")
    return steps


def make_sweep(folder, scattered):
    """As study/sweep/showing/table writes it."""
    random, side = np.random.default_rng(3), (400, POINTS // 400)
    if scattered:
        pressure, length = 10 ** (3 * random.random(POINTS) - 4), 10 ** (2 * random.random(POINTS) - 1)
    else:
        pressure, length = (a.ravel() for a in np.meshgrid(np.logspace(-4, -1, side[0]), np.logspace(-1, 1, side[1])))
    mu = 0.1 + 0.28 / (1 + (pressure * length / 0.004) ** 0.6) + 0.002 * random.standard_normal(POINTS)
    mu[random.random(POINTS) < 0.01] = np.nan
    columns = {"scene/load.pressure": pressure, "scene/mesh.set.length": length, "result/mu_M": mu,
               "result/mu_M_error": 0 * mu + 0.001, "result/l_c": np.minimum(1, 0.03 / np.sqrt(pressure * length)),
               "result/warned": (pressure * length > 0.05).astype(float)}
    words = {"title": "1e5 points", "units": "normalised", "columns": "load.pressure|mesh.set.length|mu_M|l_c"}
    folder.mkdir()
    with h5py.File(folder / "sweep.h5", "w") as file:
        for name, text in words.items():
            file.attrs.create(name, text, dtype=h5py.string_dtype())
        for name, values in columns.items():
            file.create_dataset(name, data=values, chunks=(4096,), shuffle=True, compression=2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--before")
    options = parser.parse_args()
    rows, missed = [], False
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        steps = make_history(options.program, folder / "long")
        make_run(options.program, folder / "field", "mesh.set={nx: 80, nz: 80}", "time.until={U: 0.006}", "output.fields={every_U: 2e-3}")
        make_sweep(folder / "grid", False)
        make_sweep(folder / "scattered", True)
        for name, limit, words in [
                (f"slip map of {steps} steps", 0.5, ("long", "--figure", "slip-map")),
                ("three figures of that run", None, ("long",)),
                ("field of 80 x 80 elements", 0.15, ("field", "--figure", "field")),
                ("the same, PDF", None, ("field", "--figure", "field", "--format", "pdf")),
                ("map of 1e5 points, a grid", 2, ("grid", "--plot", MAP)),
                ("map of 1e5 points, scattered", 2, ("scattered", "--plot", SCATTERED))]:
            times, ratios = [], []
            for _ in range(options.repeats):
                times.append(processor_time([options.program, "render", folder / words[0], *words[1:], "--overwrite"]))
                if options.before:
                    ratios.append(times[-1] / processor_time([options.before, "render", folder / words[0], *words[1:], "--overwrite"]))
            ratio = f"{statistics.median(ratios):.2f}" if ratios else ""
            rows.append([name, f"{min(times):.3f}", f"{statistics.median(times):.3f}", limit or "", ratio])
            missed = missed or (limit is not None and min(times) > limit)
    print(markdown_table(HEAD, rows))
    print(f"\nLoad of the machine: {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores.")
    return missed


if __name__ == "__main__":
    sys.exit(main())
