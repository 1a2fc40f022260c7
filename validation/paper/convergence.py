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
    return [f"mesh.set.{name}={value}" for name, value in dict(nx=cells, nz=cells, **more).items()]


CASES = [(f"Q4 {n}x{n}, tolerance {tolerance}", mesh(n) + [f"time.tolerance={tolerance}"])
         for n in (20, 40, 80) for tolerance in ("1e-2", "1e-3", "1e-4")]
CASES += [("T6 20x20 (41 contact nodes)", mesh(20, shape="triangle", order=2)),
          ("T6 40x40 (81 contact nodes)", mesh(40, shape="triangle", order=2)),
          ("Q4 40x40, full path", mesh(40) + ["reduction.use=never"]),
          ("Q4 80x80, full path", mesh(80) + ["reduction.use=never"])]


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
    parser.add_argument("--until", default="0.0125", help="rod displacement U to run to")
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
