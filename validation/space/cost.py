#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What blocks in space cost: a cube of 0.5 to five slidings on finer and finer meshes, nothing in the cache, one core, beside explicit
steps of the same mesh.

    validation/space/cost.py [--only MESH ...] [-o FOLDER]

Each run leaves a line in FOLDER/cost.jsonl (default validation/space), and a call that was stopped goes on where it was. Times are
processor seconds of the whole process. Explicit steps are taken for a short way and for three times as long; what lies between is
extrapolated to where the implicit run ended. Writes cost.md beside it."""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import PROGRAM, markdown_table   # noqa: E402

RUNS = {"6 x 6 x 6": (6, 6, "reduced"), "6 x 6 x 6, unreduced": (6, 6, "unreduced"), "6 x 6 x 6, explicit": (6, 6, "explicit"),
        "8 x 8 x 8": (8, 8, "reduced"), "10 x 10 x 10": (10, 10, "reduced"), "10 x 10 x 10, unreduced": (10, 10, "unreduced"),
        "10 x 10 x 10, explicit": (10, 10, "explicit"), "14 x 14 x 14": (14, 14, "reduced"), "14 x 14 x 14, unreduced": (14, 14, "unreduced"),
        "20 x 20 x 10": (20, 10, "reduced"), "20 x 20 x 20": (20, 20, "reduced"), "40 x 40 x 20": (40, 20, "reduced")}
PHASES = {"mesh": "mesh", "reduce": "assemble, reduce", "relax": "relax", "levels": "levels of dt", "contact": "contact", "certificate": "certificate",
          "bulk": "bulk"}   # of timing_s in run.json
SHORT = 1e-4   # U of the shorter explicit run


def run(n, nz, way, until):
    how = {"reduced": ["reduction.use=always"], "unreduced": ["reduction.use=never"], "explicit": ["time.scheme=explicit"]}[way]
    settings = [f"mesh.set={{length: 0.5, breadth: 0.5, height: {0.5 * nz / n:g}, nx: {n}, ny: {n}, nz: {nz}}}", "load.pressure=0.003", f"time.until={until}",
                "friction.critical_velocity=3.4e-4", f"rod.height={0.25 * nz / n:g}", f"rod.width={0.05 * nz / n:g}", "reduction.cache=false", *how]
    with tempfile.TemporaryDirectory() as folder:
        words = [PROGRAM, "run", Path(__file__).with_name("problem.yaml"), "-q", "-o", Path(folder, "run"), "--set", *settings]
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "AMONTONS_CACHE": ""}) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = status
        said = json.loads(Path(folder, "run/run.json").read_text())
    return used, said, {phase: said["timing_s"][key] for key, phase in PHASES.items()}


def measure(n, nz, way):
    used, said, clock = run(n, nz, way, "{U: 0.02, slidings: 5}")
    steps = said["steps"]
    return {"cpu_s": round(used.ru_utime + used.ru_stime, 2), "MB": round(used.ru_maxrss / 1024), "nodes": said["model"]["contact_nodes"],
            "unknowns": said["model"]["full_dofs"], "reduced": said["model"]["reduced_dofs"], "steps": steps["accepted"],
            "iterations": steps["contact_iterations"], "levels": steps["factorisations"], "certificates": steps["certificates"],
            "clock_s": clock, "U": said["results"]["peaks"][-1]["U"],
            "peaks": [round(peak["mu"], 5) for peak in said["results"]["peaks"]]}


def extrapolate(n, nz, U):
    taken = []
    for way in (SHORT, 3 * SHORT):
        used, said, _ = run(n, nz, "explicit", f"{{U: {way}}}")
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


def page(rows):
    table = [[name, str(row["unknowns"]), str(row["reduced"]) if RUNS[name][2] == "reduced" else "", str(row["nodes"]), str(row["steps"]),
              str(row.get("levels", "")), str(row.get("iterations", "")), str(row.get("certificates", "")),
              f"{row['cpu_s']:.1f}" if RUNS[name][2] != "explicit" else f"{row['cpu_s']:.0f}, extrapolated", str(row.get("MB", "")), shares(row),
              ", ".join(f"{mu:.4f}" for mu in row.get("peaks", [])[:5])] for name in RUNS if (row := rows.get(name))]
    notes = [f"- {name}: {row['note']}" for name in RUNS if (row := rows.get(name)) and "note" in row]
    return f"""# What blocks in space cost

`validation/space/cost.py`: a cube of 0.5 (20 x 20 x 10 and 40 x 40 x 20: half as high), P = 0.003, set A with V = 2e-5, to five slidings; nothing in the cache.
Processor seconds of the whole process (meshing, reduction, steps), on a machine that did other things as well, which lengthens those that pass through much memory.
What takes the time are the largest shares of the clock. Explicit steps: so many to where the implicit run of that mesh ended, at what a step takes between two
short runs; they settle first by implicit steps, which are left out. Explicit counts and times are of
version 1eb0caa6, whose longest step came from Lanczos's method and whose loop was a vector sweep; now a run takes more steps and a step more time (in the plane,
on 20 x 20 cells of Figure 1, 1.3 times the steps and 2.1 times the time a step).

{markdown_table(["cells", "unknowns", "reduced", "contact nodes", "steps", "levels", "Newton", "certificates", "s", "MB", "what takes the time", "peaks"], table)}

{chr(10).join(notes)}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=RUNS)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    words = parser.parse_args()
    path = words.output / "cost.jsonl"
    rows = {row["name"]: row for row in map(json.loads, path.read_text().splitlines())} if path.exists() else {}
    for name in words.only or RUNS:
        if name not in rows:
            n, nz, way = RUNS[name]
            implicit = rows.get(name.split(",")[0])
            if way == "explicit" and not implicit:
                continue
            rows[name] = {"name": name} | (extrapolate(n, nz, implicit["U"]) if way == "explicit" else measure(n, nz, way))
            with path.open("a") as out:
                out.write(json.dumps(rows[name]) + "\n")
            (words.output / "cost.md").write_text(page(rows))
    (words.output / "cost.md").write_text(page(rows))


if __name__ == "__main__":
    main()
