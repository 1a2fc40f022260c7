#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Whole runs as they are by default, on the reduced bulk, beside the same on the whole mesh, as distributions over
pressures.

    validation/benchmark/default_path.py [--shapes NAME ...] [--tolerances T ...] [-o FOLDER]

Beside `never` (reduced) stand: `halves`, as a block that is its own mirror image is reduced by default; `whole`, reduced in one
piece, as one node inside the block is 1e-7 of the length aside; `steps`, never reduced, with 0.9 of the step's tolerance:
what any other choice of steps comes to, as the reduced bulk measures its error in its own unknowns; and, where asked for, `moved`: never reduced, the node aside.
Peaks are compared one by one. Slip goes one cell farther or not by next to nothing, so a run departs from the other at some peak (the
first that differs by more than 0.5 %), and what comes later is of another history: what is counted is how many
of the peaks up to there depart. --tolerances: reduced with these `reduction.tolerance`, too.

Every run is kept in FOLDER/default_path.jsonl (default results/default_path) as it ends: the same command goes on where it
was stopped. Leaves default_path.md in FOLDER."""
import argparse
import json
import math
import statistics
import subprocess
from pathlib import Path

from measured_run import ROOT, commit, markdown_table, run

BLOCK, PADS = ROOT / "validation/paper/fig1.yaml", ROOT / "validation/pads/pads.yaml"
QUIET = ["output.history=false", "output.fields=none", "output.figures=[]"]
APART = 0.005       # of a peak, relative: far above what steps leave, below what branches are apart
MOVED = 1e-7        # of a node, over the length
STEP = 0.003        # from one pressure to the next, relative


def block(cells, count, pressure=0.003):
    return {"scene": BLOCK, "mesh": {"nx": cells, "nz": cells}, "pressure": pressure, "slidings": 4, "count": count}


def pads(size, count, pressure=0.006):
    return {"scene": PADS, "mesh": {"n": 2, "pad_ratio": 2, "total_height": 0.5, "pad_height": 0.05, "fill": 0.6, "ends": "open",
                                    "size_contact": size, "size_bulk": 4 * size},
            "pressure": pressure, "slidings": 5, "count": count}


SHAPES = {"20 x 20": block(20, 40), "40 x 40": block(40, 40), "80 x 80": block(80, 12), "120 x 120": block(120, 8),
          "40 x 40, P = 0.006": block(40, 40, 0.006), "two unequal pads": pads(0.0125, 20)}
NEVER, ALWAYS = "reduction.use=never", "reduction.use=always"
WAYS = {"never": (False, [NEVER]), "halves": (False, [ALWAYS]), "whole": (True, [ALWAYS]),    # a node aside?, settings
        "steps": (False, [NEVER, "time.tolerance=4.5e-3"]), "moved": (True, [NEVER])}


def pressures(shape):
    """Around that of the shape, a step apart."""
    middle = (shape["count"] - 1) / 2
    return [float(f"{shape['pressure'] * (1 + STEP * (k - middle)):.6g}") for k in range(shape["count"])]


def moved_mesh(name, shape, folder):
    """The mesh with the node nearest to (0.3, 0.35) aside."""
    path = folder / f"{name.replace(' ', '')}.msh"
    if path.exists():
        return path
    words = ["gmsh", "-2", str(ROOT / "meshes/block.geo"), "-format", "msh2", "-v", "0", "-o", str(path)]
    for key, value in shape["mesh"].items():
        words += ["-setnumber", key, str(value)]
    subprocess.run(words, check=True)
    lines = path.read_text().splitlines()
    first = lines.index("$Nodes") + 2
    places = {k: [float(word) for word in lines[k].split()[1:]] for k in range(first, lines.index("$EndNodes"))}
    line = min(places, key=lambda k: math.dist(places[k][:2], (0.3, 0.35)))
    x, y, z = places[line]
    lines[line] = f"{lines[line].split()[0]} {x + MOVED!r} {y!r} {z!r}"
    path.write_text("\n".join(lines) + "\n")
    return path


def compute(name, shape, pressure, way, tolerance, folder):
    moved, settings = WAYS[way]
    if moved and shape["scene"] == BLOCK:     # unequal pads are reduced in one piece as they are
        mesh = [f"mesh.file={moved_mesh(name, shape, folder)}", "mesh.set={}"]
    else:
        mesh = ["mesh.set={" + ", ".join(f"{key}: {value}" for key, value in shape["mesh"].items()) + "}"]
    more = [f"reduction.tolerance={tolerance}"] if tolerance else []
    ended = run(shape["scene"], [*QUIET, *mesh, *more, *settings, f"load.pressure={pressure}",
                                 f"time.until={{U: {shape['slidings'] * shape['pressure']:.6g}}}"], 600, cache=folder / "cache")
    if ended.status != 0:
        raise SystemExit(f"{name}, P = {pressure}, {way}: {ended.said}")
    results, model = ended.report["results"], ended.report["model"]
    return {"peaks": [(peak["U"], peak["mu"]) for peak in results["peaks"]], "mu_M": results["mu_M"],
            "by_halves": model["by_halves"], "steps": ended.report["steps"]["accepted"], "seconds": ended.seconds,
            "error": ended.report["errors"]["reduction"]}


class Kept:
    """What was computed, a line of JSON each."""

    def __init__(self, folder):
        self.folder, self.path, self.rows = folder, folder / "default_path.jsonl", {}
        for line in self.path.read_text().splitlines() if self.path.exists() else []:
            row = json.loads(line)
            self.rows[tuple(row["key"])] = row

    def obtain(self, name, shape, pressure, way, tolerance):
        key = (name, pressure, way, tolerance)
        if key not in self.rows:
            row = {"key": key} | compute(name, shape, pressure, way, tolerance, self.folder)
            with open(self.path, "a") as file:
                file.write(json.dumps(row) + "\n")
            self.rows[key] = row
        return self.rows[key]


def differences(one, other):
    """(peaks compared, relative differences of mu of those before they depart, whether they do)"""
    found = []
    for (_, mine), (_, its) in zip(one["peaks"], other["peaks"]):
        if abs(mine / its - 1) > APART:
            return len(found) + 1, found, True
        found.append(abs(mine / its - 1))
    return len(found), found, False


def row_of(pairs):
    """Cells: of runs side by side."""
    every = [differences(*pair) for pair in pairs]
    looked, departed = sum(count for count, _, _ in every), sum(parts for _, _, parts in every)
    first = [small[0] for _, small, _ in every if small]
    later = [each for _, small, _ in every for each in small[1:]]
    apart = [one["mu_M"] / other["mu_M"] - 1 for one, other in pairs if one["mu_M"] and other["mu_M"]]
    spread = statistics.stdev(apart) if len(apart) > 1 else math.nan
    return [len(pairs), f"{departed} of {looked}", f"{max(first, default=math.nan):.0e}",
            f"{statistics.median(later):.1e}" if later else "", f"{100 * statistics.mean(apart):+.2f}",
            f"{100 * spread / math.sqrt(len(apart)):.2f}", f"{100 * spread:.2f}", f"{100 * max(map(abs, apart)):.2f}"]


def report(kept, names):
    head = ["", "runs", "peaks that depart", "first peak, largest", "others, median", "mu_M, mean %", "+-", "spread %", "largest %"]
    rows = []
    for name in names:
        ways = {(way, tolerance) for shape, _, way, tolerance in kept.rows if shape == name}
        for way, tolerance in sorted(ways, key=lambda each: (list(WAYS).index(each[0]), -(each[1] or 1))):
            pairs = [(row, kept.rows[name, key[1], "never", None]) for key, row in kept.rows.items()
                     if key[0] == name and key[2:] == (way, tolerance) and (name, key[1], "never", None) in kept.rows]
            if pairs and way != "never":
                rows.append([f"{name}, {way}" + (f", tolerance {tolerance:g}" if tolerance else ""), *row_of(pairs)])
    return markdown_table(head, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/default_path")
    parser.add_argument("--shapes", nargs="+", choices=SHAPES, default=list(SHAPES), metavar="NAME", help=", ".join(SHAPES))
    parser.add_argument("--ways", nargs="+", choices=WAYS, default=list(WAYS)[:4], metavar="WAY", help=", ".join(WAYS))
    parser.add_argument("--tolerances", nargs="+", type=float, default=[], metavar="T")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    kept = Kept(given.output)
    for name in given.shapes:
        shape = SHAPES[name]
        for way in given.ways:
            if way in ("halves", "moved") and shape["scene"] == PADS:
                continue
            for tolerance in [None, *given.tolerances] if ALWAYS in WAYS[way][1] else [None]:
                for pressure in pressures(shape):
                    kept.obtain(name, shape, pressure, way, tolerance)
                print(f"{name}, {way}, {tolerance or 'default'}", flush=True)
    text = report(kept, [name for name in SHAPES if any(key[0] == name for key in kept.rows)])
    (given.output / "default_path.md").write_text(f"Version {commit()}.\n\n{text}\n")
    print(text)


if __name__ == "__main__":
    main()
