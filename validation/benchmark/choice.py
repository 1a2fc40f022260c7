#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether `reduction.use: auto` chooses well: thirty shapes, each stepped reduced and on the full mesh.

    validation/benchmark/choice.py [--only N ...] [--page FILE] [-o FOLDER]

Blocks of several sizes and proportions, graded and unstructured meshes, 2 to 16 pads, ways of the rod
from before the first sliding to dozens of them. A pair is a cold run with `always` and one with
`never`, without any cache or output, one right after the other; three pairs a shape, the least
of each counts. Times are processor seconds of the whole process, user and system, which
other work on the machine changes little: the second core that a reduction uses counts as much as the
first. What `auto` expects and takes is asked of the program (`--dry-run`).

A pair leaves a line in FOLDER/choice.jsonl (default results/choice); a call that was ended goes on
there. choice.md in FOLDER, or --page FILE, gets the table, and what the constants of
src/model/choice.c are by these pairs (least squares of the relative error)."""
import argparse
import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy

from measured_run import PROGRAM, ROOT, commit, markdown_table, run

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
            "n": model["full_dofs"],
            "m": 2 * (model["contact_nodes"] + model["rod_nodes"]),
            "halves": 2 if model["by_halves"] else 1, "unknowns": model["reduced_dofs"], "steps": ended.report["steps"]["accepted"],
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


# --- the table ----------------------------------------------------------------------------------

def forecast(shape):
    """What the program, as it is now, expects and takes: stages, and seconds of either way without
    what they share."""
    words = [PROGRAM, "run", shape.scene, "--dry-run", "--set", *shape.settings]
    said = subprocess.run(words, capture_output=True, text=True, check=True,
                          env=os.environ | {"AMONTONS_CACHE": ""}).stdout
    number = {name: float(re.search(rf"{name} +([-+.\de]+)", said)[1])
              for name in ("mesh", "reduction", "steps", "some", "would be about")}
    taken = "full" if "stepped on the full mesh" in said else "reduced"
    other = "full" if taken == "reduced" else "reduced"
    return {"takes": taken, "stages": round(number["some"]),
            taken: number["reduction"] + number["steps"],
            other: number["would be about"] - number["mesh"]}


def least(pairs, use):
    """One way's run, with the least of its processor times."""
    return min((pair[use] for pair in pairs), key=lambda one: one["cpu"])


def table_of(shapes, done):
    rows, losses, lost = [], [], []
    for number, shape in enumerate(shapes, 1):
        pairs = done[key_of(shape)]
        ran = {use: least(pairs, use) for use in USES}
        wanted = forecast(shape)
        taken = wanted["takes"]
        cpu = {use: ran[use]["cpu"] for use in USES}
        better = min(cpu, key=cpu.get)
        losses.append(cpu[taken] / cpu[better] - 1)
        lost.append(cpu[taken] - cpu[better])
        stages = f"{wanted['stages']} ({ran['full']['stages']})"
        seconds = [f"{wanted[use]:.2f} ({cpu[use]:.2f})" for use in USES]
        rows.append([number, shape.what, f"{shape.way:g}", ran["full"]["n"], stages, *seconds, taken,
                     f"{100 * losses[-1]:.0f} %, {lost[-1]:.2f} s" if lost[-1] > 0 else ""])
    head = ["", "shape", "U", "unknowns", "stages", "reduced, s", "full, s", "`auto` takes",
            "slower than the better by"]
    good = sum(loss <= LOSS for loss in losses)
    return (markdown_table(head, rows)
            + f"\n\n{good} of {len(losses)} within {100 * LOSS:.0f} % of the better choice; the "
            f"largest loss is {100 * max(losses):.0f} %, the longest {max(lost):.2f} s.")


# --- the constants ------------------------------------------------------------------------------

NAMES = ("FULL_FACTOR", "FULL_STAGE", "FULL_BORDER", "REDUCTION_FACTORS", "REDUCTION_PRODUCTS",
         "REDUCED_STAGE", "ANY_STAGE")
SOURCE = (ROOT / "src/model/choice.c").read_text()


def in_source(name):
    return float(re.search(rf"\b{name} = ([-+.\de]+)", SOURCE)[1])


def left(n, m):
    """As far_patches_left of src/reduction/far_patches.c."""
    return min(n, 1.5 * int(min(max(8000 / m, 8), 20)) * m) if m >= 100 else n


def terms(use, ran):
    """What each constant is multiplied by, and 1 for what both ways share."""
    n, m, stages = ran["n"], ran["m"], ran["stages"]
    full = [in_source("RUNGS") * n**1.5, stages * n**1.5, stages * m**2, 0, 0, 0, stages]
    parts = ran["halves"]
    reduced = [0, 0, 0, n, left(n / parts, m / parts) * m**2 / parts, stages * m**2, stages]
    return (full if use == "full" else reduced) + [1]


def fit(done):
    """Least squares of the relative errors, none of the constants below 0."""
    ran = [(use, least(pairs, use)) for pairs in done.values() for use in USES]
    matrix = numpy.array([terms(use, one) for use, one in ran])
    matrix /= numpy.array([[one["cpu"]] for _, one in ran])
    kept = list(range(matrix.shape[1]))
    while True:
        found = numpy.linalg.lstsq(matrix[:, kept], numpy.ones(len(ran)), rcond=None)[0]
        if (found >= 0).all():
            break
        kept.pop(int(numpy.argmin(found * matrix[:, kept].max(axis=0))))
    values = numpy.zeros(matrix.shape[1])
    values[kept] = found
    return values, float(numpy.sqrt(numpy.mean((matrix @ values - 1) ** 2)))


def table_of_constants(done):
    values, error = fit(done)
    rows = [[f"`{name}`", f"{in_source(name):.3g}", f"{value:.2g}" if value > 0 else "not seen"]
            for name, value in zip(NAMES, values)]
    return (markdown_table(["s", "in the source", "by these pairs"], rows)
            + f"\n\nWhat both ways share, gmsh above all: {values[-1]:.2f} s. The fit is off by "
            f"{100 * error:.0f} % (rms).")


PAGE = """# How `reduction.use: auto` chooses

Thirty shapes, each stepped both ways from nothing, in pairs: processor seconds (user and system) of the whole
run, gmsh and all, the least of {pairs}. What is expected stands before what was measured in brackets; the seconds expected
leave out what both ways share, gmsh above all (even blocks are meshed without it). Stages are those to the end
of the run. A basis that takes less than {floor:g} s is built in any case: it is kept, and the next run of the shape is the faster for it.

{table}

## Constants of `src/model/choice.c`

{constants}

`validation/benchmark/choice.py`, version {version}; two cores that were shared with other work.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", type=int, nargs="*", help="shapes by number, from 1")
    parser.add_argument("--page", type=Path, help="write the table into this file as well")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/choice")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    chosen = [SHAPES[k - 1] for k in options.only] if options.only else SHAPES
    done = measure_pairs(chosen, options.output / "choice.jsonl")
    done = {key_of(shape): done[key_of(shape)] for shape in chosen}
    page = PAGE.format(pairs=PAIRS, floor=in_source("NOT_WORTH_ASKING"), table=table_of(chosen, done),
                       constants=table_of_constants(done), version=commit())
    for path in filter(None, (options.output / "choice.md", options.page)):
        path.write_text(page)
    print(f"{options.output}/choice.md")


if __name__ == "__main__":
    main()
