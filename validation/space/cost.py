#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What blocks in space cost: a cube of 0.5 to five slidings on finer and finer meshes, nothing in the cache, beside explicit steps of the
same mesh and beside an earlier version of the program.

    validation/space/cost.py [--only MESH ...] [--before PROGRAM] [-o FOLDER]

Each run leaves a line in FOLDER/cost.jsonl (default validation/space), and a call that was stopped goes on where it was: remove the lines
that are to be measured anew. --before measures with the program of an earlier version, on the meshes of BEFORE. Explicit steps are taken
for a short way and for three times as long; what lies between is extrapolated to where the implicit run ended. Writes cost.md beside it."""
import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import PROGRAM, markdown_table   # noqa: E402

RUNS = {"6 x 6 x 6": (6, 6, "reduced"), "6 x 6 x 6, unreduced": (6, 6, "unreduced"), "6 x 6 x 6, explicit": (6, 6, "explicit"),
        "8 x 8 x 8": (8, 8, "reduced"), "10 x 10 x 10": (10, 10, "reduced"), "10 x 10 x 10, unreduced": (10, 10, "unreduced"),
        "10 x 10 x 10, explicit": (10, 10, "explicit"), "14 x 14 x 14": (14, 14, "reduced"), "14 x 14 x 14, unreduced": (14, 14, "unreduced"),
        "20 x 20 x 10": (20, 10, "reduced"), "20 x 20 x 20": (20, 20, "reduced"), "28 x 28 x 28": (28, 28, "reduced"),
        "40 x 40 x 20": (40, 20, "reduced")}
CUBES = ("10 x 10 x 10", "14 x 14 x 14", "20 x 20 x 20", "28 x 28 x 28")   # whose cost is fitted
BEFORE = (*CUBES[:3], "40 x 40 x 20")
PHASES = {"mesh": "mesh", "reduce": "assemble, reduce", "relax": "relax", "levels": "levels of dt", "contact": "contact", "certificate": "certificate",
          "bulk": "bulk"}   # of timing_s in run.json
SHORT = 1e-4   # U of the shorter explicit run


def words_of(n, nz, way, until):
    """The scene of a mesh, with settings, as words of a command."""
    how = {"reduced": ["reduction.use=always"], "unreduced": ["reduction.use=never"], "explicit": ["time.scheme=explicit"]}[way]
    settings = [f"mesh.set={{length: 0.5, breadth: 0.5, height: {0.5 * nz / n:g}, nx: {n}, ny: {n}, nz: {nz}}}", "load.pressure=0.003", f"time.until={until}",
                "friction.critical_velocity=3.4e-4", f"rod.height={0.25 * nz / n:g}", f"rod.width={0.05 * nz / n:g}", "reduction.cache=false", *how]
    return [Path(__file__).with_name("problem.yaml"), "--set", *settings]


ALONE = {"OPENBLAS_NUM_THREADS": "1", "AMONTONS_CACHE": ""}


def run(n, nz, way, until, program=PROGRAM):
    """(resources used, wall time in s, run.json)"""
    with tempfile.TemporaryDirectory() as folder:
        words = [program, "run", *words_of(n, nz, way, until), "-q", "-o", Path(folder, "run")]
        started = time.monotonic()
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, env=os.environ | ALONE) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = status
        elapsed = time.monotonic() - started
        return used, elapsed, json.loads(Path(folder, "run/run.json").read_text())


def told_memory(n, nz, way):
    """What --dry-run tells of a mesh, GB."""
    told = subprocess.run([PROGRAM, "run", *words_of(n, nz, way, "{U: 0.02, slidings: 5}"), "--dry-run"], capture_output=True, text=True, check=True,
                          env=os.environ | ALONE).stdout
    found = re.search(r"about ([0-9.]+) (.)B of memory", told)
    return float(found[1]) / {"G": 1, "M": 1000}[found[2]]


def measure(n, nz, way, program=PROGRAM):
    used, elapsed, said = run(n, nz, way, "{U: 0.02, slidings: 5}", program)
    row = {"version": said["version"], "cpu_s": round(used.ru_utime + used.ru_stime, 2), "elapsed_s": round(elapsed, 2),
           "MB": round(used.ru_maxrss / 1024), "peaks": [round(peak["mu"], 5) for peak in said["results"]["peaks"]]}
    if program != PROGRAM:   # whose other keys had other names
        return row
    steps, model = said["steps"], said["model"]
    return row | {"told_GB": told_memory(n, nz, way), "nodes": model["contact_nodes"], "unknowns": model["full_dofs"], "reduced": model["reduced_dofs"],
                  "steps": steps["accepted"], "iterations": steps["contact_iterations"], "levels": steps["factorisations"],
                  "certificates": steps["certificates"], "clock_s": {phase: said["timing_s"][key] for key, phase in PHASES.items()},
                  "U": said["results"]["peaks"][-1]["U"]}


def extrapolate(n, nz, U):
    taken = []
    for way in (SHORT, 3 * SHORT):
        used, _, said = run(n, nz, "explicit", f"{{U: {way}}}")
        taken.append((used.ru_utime + used.ru_stime, said["steps"]["accepted"], said["model"]["contact_nodes"], said["model"]["full_dofs"]))
    steps = taken[0][1] * U / SHORT
    a_step = (taken[1][0] - taken[0][0]) / (taken[1][1] - taken[0][1])
    return {"cpu_s": round(a_step * steps), "steps": round(steps), "nodes": taken[0][2], "unknowns": taken[0][3], "ms_a_step": round(1e3 * a_step, 3)}


def shares(row):
    clock = row.get("clock_s")
    if not clock:
        return ""
    whole = sum(clock.values())
    most = sorted(clock.items(), key=lambda item: -item[1])[:3]
    return ", ".join(f"{phase} {100 * seconds / whole:.0f} %" for phase, seconds in most)


def powers(rows):
    """How processor time grows with the cells along a side, from one cube to the next."""
    have = [(int(name.split()[0]), rows[name]["cpu_s"]) for name in CUBES if name in rows]
    return ", ".join(f"{math.log(last / first) / math.log(n / m):.1f} from {m} to {n}" for (m, first), (n, last) in zip(have, have[1:]))


def beside(rows):
    """Before and after."""
    table = []
    for name in BEFORE:
        before, after = rows.get(f"{name}, before"), rows.get(name)
        if before and after:
            table.append([name, *(f"{row[key]:.{digits}f}" for key, digits in (("elapsed_s", 1), ("cpu_s", 1), ("MB", 0)) for row in (before, after)),
                          ", ".join(f"{mu:.4f}" for mu in before["peaks"][:5])])
    return markdown_table(["cells", "elapsed, s: before", "after", "processor, s: before", "after", "MB: before", "after", "peaks before"], table)


def page(rows):
    table = [[name, str(row["unknowns"]), str(row["reduced"]) if RUNS[name][2] == "reduced" else "", str(row["nodes"]), str(row["steps"]),
              str(row.get("iterations", "")), str(row.get("certificates", "")),
              f"{row['elapsed_s']:.1f}" if "elapsed_s" in row else "",
              f"{row['cpu_s']:.1f}" if RUNS[name][2] != "explicit" else f"{row['cpu_s']:.0f}, extrapolated", str(row.get("MB", "")),
              f"{1000 * row['told_GB']:.0f}" if "told_GB" in row else "", shares(row),
              ", ".join(f"{mu:.4f}" for mu in row.get("peaks", [])[:5])] for name in RUNS if (row := rows.get(name))]
    versions = sorted({row["version"] for name, row in rows.items() if "before" in name})
    return f"""# What blocks in space cost

`validation/space/cost.py` ([script](cost.py), [every run](cost.jsonl)): a cube of 0.5 (20 x 20 x 10 and 40 x 40 x 20: half as high), P = 0.003, set A with V = 2e-5, to
five slidings; nothing in the cache. The whole process (meshing, reduction, steps) on two cores, BLAS on one thread; seconds by the clock, and processor seconds of all
threads. "told" is what `--dry-run` says of memory beforehand. What takes the time are the largest shares of the clock. Explicit steps: so many to where the implicit run
of that mesh ended, at what a step takes between two short runs; they settle first by implicit steps, which are left out. Explicit counts and times are of
version 1eb0caa6, whose longest step came from Lanczos's method and whose loop was a vector sweep; now a run takes more steps and a step more time (in the plane,
on 20 x 20 cells of Figure 1, 1.3 times the steps and 2.1 times the time a step).

{markdown_table(["cells", "unknowns", "reduced", "contact nodes", "steps", "Newton", "certificates", "elapsed, s", "processor, s", "MB", "told", "what takes the time", "peaks"], table)}

- **Growth**: processor time of the cubes goes with the cells along a side to the power {powers(rows)}.

## Before and after

The same runs by the version of 26 November 2026 ({", ".join(versions)}, before the papers' mesh was aimed at), on the same machine within the hour.

{beside(rows)}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=RUNS)
    parser.add_argument("--before", type=Path, help="an earlier version of the program")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    words = parser.parse_args()
    path = words.output / "cost.jsonl"
    rows = {row["name"]: row for row in map(json.loads, path.read_text().splitlines())} if path.exists() else {}

    def keep(name, row):
        rows[name] = {"name": name} | row
        with path.open("a") as out:
            out.write(json.dumps(rows[name]) + "\n")
        (words.output / "cost.md").write_text(page(rows))
    for name in words.only or (BEFORE if words.before else RUNS):
        n, nz, way = RUNS[name]
        implicit = rows.get(name.split(",")[0])
        if words.before and f"{name}, before" not in rows:
            keep(f"{name}, before", measure(n, nz, way, words.before))
        elif not words.before and name not in rows and (way != "explicit" or implicit):
            keep(name, extrapolate(n, nz, implicit["U"]) if way == "explicit" else measure(n, nz, way))
    (words.output / "cost.md").write_text(page(rows))


if __name__ == "__main__":
    main()
