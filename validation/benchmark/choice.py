#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether `reduction.use: auto` chooses well: thirty shapes, each stepped reduced and on the full mesh.

    validation/benchmark/choice.py [--only N ...] [--page FILE] [-o FOLDER]

Blocks of several sizes and proportions, graded and unstructured meshes, 2 to 16 pads, ways of the rod
from before the first sliding to dozens of them. A pair is a cold run with `always` and one with
`never`, without any cache or output, one right after the other; three pairs a shape, the least
of each counts. Times are processor seconds of the whole process, user and system, which
other work on the machine changes little: the second core that a reduction uses counts as much as the
first. What `auto` takes is what the program itself expects (`model.expected_s` of run.json).

A pair leaves a line in FOLDER/choice.jsonl (default results/choice); a call that was ended goes on
there. choice.md in FOLDER, or --page FILE, gets the table, and what the constants of
src/model/choice.c are by these pairs (least squares of the relative error)."""
import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy

from measured_run import ROOT, commit, markdown_table, run

PAIRS = 3
LIMIT = 400                      # processor s of a run
LOSS = 0.20                      # that is allowed
PLAIN = ["output.figures=[]", "output.fields=none", "output.history=false", "reduction.cache=false"]
A, PADS, PADS_B = (ROOT / "validation" / name for name in
                   ("paper/fig1.yaml", "pads/pads.yaml", "pads/pads-b.yaml"))
USES = {"reduced": "always", "full": "never"}


@dataclass(frozen=True)
class Shape:
    what: str
    scene: Path
    way: float                   # time.until.U
    mesh: str = ""               # entries of mesh.set
    more: tuple = ()

    @property
    def settings(self):
        words = [f"mesh.set.{word}" for word in self.mesh.split()]
        return [*PLAIN, *words, *self.more, f"time.until={{U: {self.way}}}"]


def block(nx, nz, way, mesh="", *more):
    what = f"{nx} x {nz}" + (f", {mesh}" if mesh else "")
    return Shape(what.replace("=", " "), A, way, f"nx={nx} nz={nz} {mesh}", more)


def pads(n, way, cells=0.0125, more=()):
    return Shape(f"{n} pads, cells {cells:g}", PADS, way,
                 f"n={n} size_contact={cells} size_bulk={4 * cells}", tuple(more))


def pads_b(n, way):
    return Shape(f"{n} pads, set B", PADS_B, way, f"n={n} size_contact=0.0005")


FLAT = ("rod.height=0.05", "rod.width=0.02")
SHAPES = [
    block(10, 10, 0.006), block(20, 20, 0.001), block(20, 20, 0.012),
    block(40, 40, 0.0005), block(40, 40, 0.003), block(40, 40, 0.01),
    block(80, 80, 0.0005), block(80, 80, 0.002), block(80, 80, 0.006),
    block(120, 120, 0.0005), block(120, 120, 0.003),
    block(160, 160, 0.0005), block(160, 160, 0.002),
    block(200, 20, 0.0005, "height=0.1", *FLAT), block(200, 20, 0.003, "height=0.1", *FLAT),
    block(300, 10, 0.0002, "height=0.1", *FLAT), block(20, 160, 0.003),
    block(60, 120, 0.001, "length=0.25"),
    block(100, 40, 0.002, "shape=triangle"), block(40, 40, 0.003, "order=2"),
    block(60, 60, 0.001, "layout=free shape=triangle"),
    block(200, 20, 0.001, "grade_z=4"), block(300, 30, 0.004, "grade_z=8"),
    pads(2, 0.01), pads(4, 0.02), pads(8, 0.01), pads(12, 0.002, 0.00625), pads(16, 0.012, 0.00625),
    pads_b(4, 2e-5), pads_b(16, 2e-6),
]


# --- measuring ----------------------------------------------------------------------------------

def measure(shape, use):
    ended = run(shape.scene, [*shape.settings, f"reduction.use={USES[use]}"], LIMIT)
    if ended.status != 0:
        sys.exit(f"{shape.what}: status {ended.status}: {ended.said[-300:]}")
    model = ended.report["model"]
    return {"cpu": ended.seconds, "memory": ended.memory, "phases": ended.phases,
            "expected": model.get("expected_s"), "n": model["full_dofs"],
            "m": 2 * (model["contact_nodes"] + model["rod_nodes"]),
            "unknowns": model["reduced_dofs"], "steps": ended.report["steps"]["accepted"],
            "stages": ended.phases["bulk"][1]}


def key_of(shape):
    return " ".join([shape.scene.name, *shape.settings])


def read_pairs(path):
    """Pairs by shape, those of this version of the program."""
    found = {}
    if path.exists():
        for line in path.read_text().splitlines():
            pair = json.loads(line)
            if pair["version"] == commit():
                found.setdefault(pair["shape"], []).append(pair)
    return found


def measure_pairs(shapes, path):
    done = read_pairs(path)
    for turn in range(PAIRS):
        for shape in shapes:
            if len(done.get(key_of(shape), [])) > turn:
                continue
            order = list(USES) if turn % 2 == 0 else list(USES)[::-1]
            pair = {"shape": key_of(shape), "version": commit()}
            pair |= {use: measure(shape, use) for use in order}
            with open(path, "a") as lines:
                lines.write(json.dumps(pair) + "\n")
            print(f"{turn + 1}/{PAIRS} {shape.what}, U = {shape.way:g}: "
                  + ", ".join(f"{use} {pair[use]['cpu']:.2f} s" for use in USES), flush=True)
    return read_pairs(path)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", type=int, nargs="*", help="shapes by number, from 1")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/choice")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    chosen = [SHAPES[k - 1] for k in options.only] if options.only else SHAPES
    measure_pairs(chosen, options.output / "choice.jsonl")
