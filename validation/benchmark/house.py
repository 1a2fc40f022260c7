#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What the source looks like and what runs cost, of one version beside another.

    validation/benchmark/house.py BEFORE AFTER [--turns 3] [--cases CASE ...]

BEFORE and AFTER are checkouts, each with its build/bin. Lines and files by folder are those of the checkouts. Runs take
turns, each a process by itself on one processor; of several turns the least processor time stands in the table, so that
a busy machine changes little. Cold: without a cache, to t = 1, which leaves mesh and reduction; warm: from the cache, to
U = 0.006. `reproduce --quick` is the launcher's, by each checkout."""
import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

FIG1, PADS = "validation/paper/fig1.yaml", "validation/pads/pads.yaml"
# Name: scene, settings, at most so many turns.
CASES = {"4 pads": (PADS, [], 9)}
CASES |= {f"{n} x {n}": (FIG1, [f"mesh.set.nx={n}", f"mesh.set.nz={n}"], turns)
          for n, turns in ((20, 9), (40, 9), (80, 5), (160, 3), (320, 1))}
CASES["800 nodes"] = (FIG1, ["mesh.set.nx=799", "mesh.set.nz=100"], 1)
PLAIN = ["output.history=false", "output.figures=[]", "output.fields=none", "reduction.use=always"]
COLD, WARM = ["time.until.t=1"], ["time.until.U=0.006"]


def lines(root, ending):
    """{folder of src or render: (files, lines)}"""
    found = {}
    for path in sorted(path for top in ("src", "render") for path in (root / top).rglob(f"*{ending}")):
        folder = "/".join(path.relative_to(root).parts[:-1][:3])
        files, count = found.get(folder, (0, 0))
        found[folder] = files + 1, count + len(path.read_bytes().splitlines())
    return found


def spent(root, scene, settings, cache):
    """Processor seconds of a run."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([root / "build/bin/amontons", "run", root / scene, "-q", "-o", f"{folder}/run",
                        *(word for setting in [*settings, *PLAIN] for word in ("--set", setting))],
                       env=os.environ | {"AMONTONS_CACHE": cache}, check=True, cwd=folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def times(roots, scene, settings, turns):
    """([cold], [warm]) of the checkouts: the least of the turns."""
    least = [[float("inf")] * 2 for _ in roots]
    with tempfile.TemporaryDirectory() as caches:
        for _ in range(turns):
            for k, root in enumerate(roots):
                least[k][0] = min(least[k][0], spent(root, scene, [*settings, *COLD], ""))
        for k, root in enumerate(roots):
            spent(root, scene, [*settings, *COLD], f"{caches}/{k}")
        for _ in range(turns):
            for k, root in enumerate(roots):
                least[k][1] = min(least[k][1], spent(root, scene, [*settings, *WARM], f"{caches}/{k}"))
    return [one[0] for one in least], [one[1] for one in least]


def quick(root):
    """Processor seconds of `reproduce --quick`."""
    with tempfile.TemporaryDirectory() as cache:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([root / "amontons", "reproduce", "--quick"], env=os.environ | {"AMONTONS_CACHE": cache},
                       check=True, cwd=root, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def table(head, rows):
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows]) + "\n"


def line_rows(roots):
    sources, headers = [[lines(root, ending) for root in roots] for ending in (".c", ".h")]
    folders = sorted(set().union(*sources, *headers))
    rows = [[folder, *(cell for k in range(2) for cell in
                       (*sources[k].get(folder, ("", "")), *headers[k].get(folder, ("", ""))))] for folder in folders]
    for top in ("src", "render"):
        rows.append([f"**{top}**"] + [sum(row[k] or 0 for row in rows if row[0].split("/")[0] == top) for k in range(1, 9)])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("roots", nargs=2, type=lambda word: Path(word).resolve(), metavar="CHECKOUT")
    parser.add_argument("--turns", type=int, default=3, help="at most so many of each case")
    parser.add_argument("--cases", nargs="*", default=list(CASES))
    parser.add_argument("--reproduce", action="store_true", help="and `reproduce --quick`")
    given = parser.parse_args()
    rows = []
    for name in given.cases:
        scene, settings, most = CASES[name]
        cold, warm = times(given.roots, scene, settings, min(most, given.turns))
        rows.append([name, *(f"{one:.3g}" for one in cold), f"{cold[1] / cold[0]:.2f}",
                     *(f"{one:.3g}" for one in warm), f"{warm[1] / warm[0]:.2f}"])
        print(rows[-1], file=sys.stderr, flush=True)
    if given.reproduce:
        both = [quick(root) for root in given.roots]
        rows.append(["reproduce --quick", *(f"{one:.3g}" for one in both), f"{both[1] / both[0]:.2f}", "", "", ""])
    tables = (table(["folder", ".c files, before", "lines", ".h files", "lines", ".c files, after", "lines", ".h files", "lines"],
                    line_rows(given.roots)),
              table(["processor time, s", "cold, before", "after", "ratio", "warm, before", "after", "ratio"], rows))
    print("\n".join(tables))


if __name__ == "__main__":
    main()
