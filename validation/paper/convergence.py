#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How the peaks of F_T/F_N in Figure 1 depend on mesh, element and step tolerance, and what the full
path costs: a Markdown table on standard output.

    validation/paper/convergence.py [PROGRAM] [--until U]

PROGRAM: the built amontons (default: build/bin/amontons of this checkout). Takes some minutes.
"""
import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "validation/paper/fig1.yaml"
QUIET = ["output.figures=[]", "output.fields=none", "output.history=false"]


def mesh(cells, **more):
    settings = {"nx": cells, "nz": cells} | more
    return [f"mesh.set.{name}={value}" for name, value in settings.items()]


CASES = [(f"Q4 {n}x{n}, tolerance {tolerance}", mesh(n) + [f"time.tolerance={tolerance}"])
         for n in (20, 40, 80) for tolerance in ("2e-2", "5e-3", "5e-4")]
CASES += [(f"Q4 80x40, graded to the contact, tolerance {tolerance}",
           mesh(80, nz=40, grade_z=4) + [f"time.tolerance={tolerance}"])
          for tolerance in ("5e-3", "5e-4")]
CASES += [(f"{name} {n}x{n} ({2 * n + 1} contact nodes), tolerance {tolerance}",
           mesh(n, shape=shape, order=2) + [f"time.tolerance={tolerance}"])
          for name, shape in (("T6", "triangle"), ("Q9", "quad")) for n in (20, 40)
          for tolerance in ("5e-3", "5e-4")]
CASES += [(f"Q4 {n}x{n}, full path", mesh(n) + ["reduction.use=never"]) for n in (40, 80)]


def run(program, settings, until):
    """The run.json of one case, with the largest resident memory of the process in MB."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", SCENE, "-o", folder + "/result", "--quiet", "--set",
                   f"time.until.U={until}", *QUIET, *settings]
        process = subprocess.Popen([str(word) for word in command])
        _, status, usage = os.wait4(process.pid, 0)
        if status:
            raise SystemExit(f"{' '.join(map(str, command))}: ended with {status}")
        report = json.loads(Path(folder, "result/run.json").read_text())
    report["memory_MB"] = usage.ru_maxrss / 1024
    return report


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="?", default=ROOT / "build/bin/amontons")
    parser.add_argument("--until", default="0.015", help="rod displacement U to run to")
    given = parser.parse_args()
    print("| case | mu_M | of peaks | spread | all peaks | steps | solve, s | total, s | MB | energy |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, settings in CASES:
        report = run(given.program, settings, given.until)
        results, times = report["results"], report["timing_s"]
        spread = results["mu_M_spread"]
        peaks = " ".join(f"{peak['mu']:.4f}" for peak in results["peaks"])
        print(f"| {name} | {results['mu_M']:.4f} | {results['mu_M_peaks']} | "
              f"{'-' if spread is None else format(spread, '.4f')} | {peaks} | "
              f"{report['steps']['accepted']} | {times['solve']:.2f} | {times['total']:.2f} | "
              f"{report['memory_MB']:.0f} | {report['errors']['energy']:.1e} |", flush=True)


if __name__ == "__main__":
    main()
