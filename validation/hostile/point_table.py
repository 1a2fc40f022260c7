# SPDX-License-Identifier: GPL-2.0-or-later
"""How a point is tried, and the table of what happened: shared by points.py, points_calls.py and points_answers.py."""
import argparse
import os
import subprocess
import tempfile
from pathlib import Path

import cases
from tries import PROGRAM, SCRATCH

PATIENCE = 60   # seconds until something counts as waiting without end


def call(folder, *words, seconds=PATIENCE, shell=None, env=None):
    """(exit status, None where it did not end; what it said). shell: a command that runs "$@"."""
    words = [str(PROGRAM), *map(str, words)]
    if shell:
        words = ["bash", "-c", shell, "bash", *words]
    try:
        done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, timeout=seconds,
                              stderr=subprocess.STDOUT, env=os.environ | {"AMONTONS_CACHE": ""} | (env or {}))
    except subprocess.TimeoutExpired:
        return None, f"no end after {seconds} s"
    return done.returncode, done.stdout.decode(errors="replace").strip()


def last_line(said):
    return (said.splitlines() or ["nothing said"])[-1]


def put_scene(folder):
    """scene.yaml and its mesh: a run of a tenth of a second."""
    cases.put(folder, {"scene.yaml": cases.SCENE, "block.msh": cases.square(), "block.geo": cases.ROOT / "meshes/block.geo"})


def refused(status, said, name):
    """A sentence of ours that names `name`, and nothing computed."""
    return status in (1, 2) and "error: " in said and str(name) in said


# --- the table -----------------------------------------------------------------------------------

def main(points):
    """The exit status; points: those that --only can name, {name: function}."""
    parser = argparse.ArgumentParser(description="Points that a review found, tried on the built program")
    parser.add_argument("--only", nargs="+", metavar="NAME", choices=points, default=list(points))
    wanted = parser.parse_args().only
    print("| point | tried | what happened | good |\n|---|---|---|---|")
    bad = 0
    for name in wanted:
        with tempfile.TemporaryDirectory(dir=SCRATCH) as folder:
            for tried, happened, good in points[name](Path(folder)):
                bad += not good
                row = [name, tried, happened.replace(folder, "."), "yes" if good else "**no**"]
                print("| " + " | ".join(str(cell).replace("|", "\\|").replace("\n", " ") for cell in row) + " |",
                      flush=True)
    print(f"\n{len(wanted)} points, {bad} tries ended as none should")
    return 1 if bad else 0
