#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What blocks in space cost: a cube of 0.5 to five slidings on finer and finer meshes, nothing in the cache, one core, beside explicit
steps of the same mesh.

    validation/space/cost.py [--only MESH ...] [-o FOLDER]

Each run leaves a line in FOLDER/cost.jsonl (default validation/space), and a call that was stopped goes on where it was. Times are
processor seconds of the whole process. Writes cost.md beside it."""
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
        "20 x 20 x 10": (20, 10, "reduced"), "20 x 20 x 20": (20, 20, "reduced")}


def measure(n, nz, way):
    how = {"reduced": ["reduction.use=always"], "unreduced": ["reduction.use=never"], "explicit": ["time.scheme=explicit"]}[way]
    settings = [f"mesh.set={{length: 0.5, breadth: 0.5, height: {0.5 * nz / n:g}, nx: {n}, ny: {n}, nz: {nz}}}", "load.pressure=0.003", "time.until={U: 0.02, slidings: 5}",
                "friction.critical_velocity=3.4e-4", f"rod.height={0.25 * nz / n:g}", f"rod.width={0.05 * nz / n:g}", "reduction.cache=false", *how]
    with tempfile.TemporaryDirectory() as folder:
        words = [PROGRAM, "run", Path(__file__).with_name("problem.yaml"), "-q", "-o", Path(folder, "run"), "--set", *settings]
        with subprocess.Popen(words, env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "AMONTONS_CACHE": ""}) as run:
            _, status, used = os.wait4(run.pid, 0)
            run.returncode = status
        said = json.loads(Path(folder, "run/run.json").read_text())
    return {"cpu_s": round(used.ru_utime + used.ru_stime, 2), "MB": round(used.ru_maxrss / 1024), "nodes": said["model"]["contact_nodes"],
            "unknowns": said["model"]["full_dofs"], "reduced": said["model"]["reduced_dofs"], "steps": said["steps"]["accepted"],
            "forecast_s": said["model"]["expected_s"], "peaks": [round(peak["mu"], 5) for peak in said["results"]["peaks"]]}


def page(rows):
    table = [[name, str(row["unknowns"]), str(row["reduced"]) if "unreduced" not in name and "explicit" not in name else "", str(row["nodes"]), str(row["steps"]),
              f"{row['cpu_s']:.1f}", str(row["MB"]), ", ".join(f"{mu:.4f}" for mu in row["peaks"][:5])] for name in RUNS if (row := rows.get(name))]
    return f"""# What blocks in space cost

`validation/space/cost.py`: a cube of 0.5 (20 x 20 x 10: half as high), P = 0.003, set A with V = 2e-5, to five slidings; nothing in the cache. Processor seconds of the
whole process (meshing, reduction, steps), on a machine that did other things as well, which lengthens those that pass through much memory.

{markdown_table(["cells", "unknowns", "reduced", "contact nodes", "steps", "s", "MB", "peaks"], table)}
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
            rows[name] = {"name": name} | measure(*RUNS[name])
            with path.open("a") as out:
                out.write(json.dumps(rows[name]) + "\n")
            (words.output / "cost.md").write_text(page(rows))
    (words.output / "cost.md").write_text(page(rows))


if __name__ == "__main__":
    main()
