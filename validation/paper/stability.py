#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Does the block begin to slide where the growth rates say? `amontons stability` against time
stepping, six (P, L) of parameter set A: Markdown tables on standard output.

    validation/paper/stability.py [PROGRAM] [--cells N]

PROGRAM: the built amontons (default: build/bin/amontons of this checkout). Both start from the
same state, at rest after two slidings, at the paper's V and at a tenth of it (the exact l_c is
that of V -> 0). The dynamic l_c is the front just before the leading rapid precursor. Differences
are in elements, stability minus dynamics. Takes about a minute.
"""
import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "validation/paper/fig1.yaml"
CASES = [(0.003, 1), (0.001, 1), (0.006, 1), (0.003, 0.5), (0.003, 2), (0.0015, 2)]
VELOCITIES = [1e-5, 1e-6]
SLIDINGS = 2


def settings(pressure, length, velocity, cells):
    # Displacements scale with P L; at (0.003, 1) the third sliding comes at U = 0.006.
    values = {"mesh.set.nx": cells, "mesh.set.nz": cells, "mesh.set.length": length,
              "mesh.set.height": length / 2, "rod.height": length / 4, "rod.width": length / 20,
              "load.pressure": pressure, "rod.velocity": velocity,
              "time.until": f"{{U: {0.01 * pressure / 0.003 * length:g}}}",
              "output.figures": "[]", "output.fields": "none", "output.history": "false"}
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def answers(program, command, result, words):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, *command, SCENE, "--quiet", "-o", folder, *words], check=True)
        return json.loads(Path(folder, result).read_text())


def number(value, form):
    return "-" if value is None else format(value, form)


def compare(program, pressure, length, velocity, cells):
    """l_sc, l_c and mu_M of the sliding after SLIDINGS, from both commands."""
    words = settings(pressure, length, velocity, cells)
    growth = answers(program, ["stability", "--slidings", str(SLIDINGS)], "stability.json", words)
    run = answers(program, ["run"], "run.json", words)
    found, peak = growth["results"], run["results"]["peaks"][SLIDINGS]
    return {"found": found, "dynamic": peak["l_c_over_L"], "mu": peak["mu"],
            "certificate": peak["l_sc_over_L"],
            "off": cells * (found["l_c_at_V_over_L"] - peak["l_c_over_L"]),
            "off_exact": cells * (found["l_c_over_L"] - peak["l_c_over_L"]),
            "off_mu": found["mu_M"] / peak["mu"] - 1,
            "seconds": (sum(growth["timing_s"].values()), run["timing_s"]["total"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="?", default=ROOT / "build/bin/amontons")
    parser.add_argument("--cells", type=int, default=40)
    given = parser.parse_args()
    every = []
    for velocity in VELOCITIES:
        print(f"\nV = {velocity:g}, {given.cells}x{given.cells} cells; lengths over L\n")
        print("| P | L | l_sc certificate | l_sc | l_c scan | l_c exact | l_c at V | l_c dynamic | "
              "at V off | exact off | mu_M stability | mu_M dynamic | off |")
        print("|---|---|---|---|---|---|---|---|---|---|---|---|---|")
        for pressure, length in CASES:
            row = compare(given.program, pressure, length, velocity, given.cells)
            found = row["found"]
            every.append(row)
            print(f"| {pressure:g} | {length:g} | {number(found['l_sc_certificate_over_L'], '.3f')} | "
                  f"{number(found['l_sc_over_L'], '.3f')} | "
                  f"{number(found['l_c_scan_over_L'], '.3f')} | {found['l_c_over_L']:.3f} | "
                  f"{found['l_c_at_V_over_L']:.3f} | {row['dynamic']:.3f} | {row['off']:+.1f} | "
                  f"{row['off_exact']:+.1f} | {found['mu_M']:.4f} | {row['mu']:.4f} | "
                  f"{100 * row['off_mu']:+.1f} % |", flush=True)
    near = sum(math.fabs(row["off"]) <= 1 for row in every)
    exact = sum(math.fabs(row["off_exact"]) <= 1 for row in every)
    print(f"\nWithin one element of the dynamics: l_c at V in {near}, the exact l_c in {exact} of "
          f"{len(every)}. Largest difference of mu_M: "
          f"{100 * max(math.fabs(row['off_mu']) for row in every):.1f} %.")


if __name__ == "__main__":
    main()
