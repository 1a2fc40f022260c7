#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What `--dry-run` says of the problems for tuning, against what their runs take, each on its own mesh.

    validation/strangers/forecasts.py [--limit 120] [--only 5,44] [-o FOLDER]
    validation/strangers/forecasts.py --meshes      # what the next mesh of a search takes, from now.jsonl

A run leaves a line in FOLDER/forecasts.jsonl (default results/strangers); a call that was ended goes on there. Constants of
src/model/stages.c were fitted to problems of odd number, those of even number judge. Seconds are processor time of the
whole process, without any cache; stages are contact problems that were solved, two a step and those of steps taken back."""
import argparse
import json
import math
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
import problems                                                 # noqa: E402
from measured_run import PROGRAM, commit, markdown_table, run   # noqa: E402

PLAIN = ["output.figures=[]", "output.fields=none", "output.history=false", "reduction.cache=false"]


def said_of(scene):
    """(stages, seconds) of --dry-run."""
    words = [PROGRAM, "run", scene, "--dry-run", "--set", "reduction.cache=false"]
    text = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    return float(re.search(r"some (\d+) stages", text)[1]), sum(map(float, re.findall(r"^  \w+ +([\d.]+) s", text, re.M)))


def measure(one, folder, limit):
    scene = one.write(folder / "scenes")
    stages, seconds = said_of(scene)
    ended = run(scene, PLAIN, limit)
    return {"number": one.number, "version": commit(), "said": [stages, seconds], "status": ended.status,
            "took": [ended.report["steps"]["contact_solves"], ended.seconds] if ended.status == 0 else None}


def row(name, ratios):
    off = sorted(abs(math.log2(ratio)) for ratio in ratios)
    return [name, len(off), f"{2 ** off[len(off) // 2]:.2f}", f"{2 ** off[int(0.9 * len(off))]:.1f}", f"{2 ** off[-1]:.0f}",
            f"{100 * sum(value <= 2 for value in off) / len(off):.0f} %"]


def table(rows):
    head = ["", "problems", "off in the median by", "of nine in ten by less than", "at most", "within 4"]
    halves = {"fitted (odd)": 1, "judged (even)": 0}
    return markdown_table(head, [
        row(f"{name}, {what}", [one["took"][at] / one["said"][at] for one in rows if one["took"] and one["number"] % 2 == odd])
        for name, odd in halves.items() for at, what in enumerate(("stages", "seconds"))])


def quantile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def meshes_table(path, least):
    """Time of a run over that of one on the mesh before, times a power of their nodes: wall time on busy machines, of runs
    that took `least` s and more."""
    steps = []      # (nodes over those before, time over that before, problem)
    for one in map(json.loads, path.read_text().splitlines()):
        levels = (one["asked"] or {}).get("levels") or []
        times = [level["seconds"] / max(len(level["runs"]), 1) for level in levels]
        steps += [(here["contact_nodes"] / before["contact_nodes"], after / time, one["number"])
                  for before, here, time, after in zip(levels, levels[1:], times, times[1:]) if after >= least]
    rows = []
    for name, low, high in (("next mesh", 1.05, 1.35), ("far jump", 1.35, 3)):
        for power in (1.5, 2, 2.6):
            of = [time / nodes**power for nodes, time, _ in steps if low <= nodes < high]
            rows.append([name, len(of), power, *(f"{quantile(of, part):.2f}" for part in (0.05, 0.1, 0.5, 0.9, 0.95))])
    return markdown_table(["", "meshes", "power", "5 % take less than", "10 %", "median", "90 %", "95 %"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--limit", type=int, default=120, help="processor s of a run")
    parser.add_argument("--only", type=lambda text: [int(word) for word in text.split(",")])
    parser.add_argument("--meshes", action="store_true")
    parser.add_argument("-o", dest="folder", type=Path, default=Path("results/strangers"))
    asked = parser.parse_args()
    if asked.meshes:
        return print(meshes_table(Path(__file__).with_name("now.jsonl"), 4))
    asked.folder.mkdir(parents=True, exist_ok=True)
    path = asked.folder / "forecasts.jsonl"
    rows = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    done = {one["number"] for one in rows}
    for one in problems.problems():
        if one.tuning and one.number not in done and (not asked.only or one.number in asked.only):
            rows.append(measure(one, asked.folder, asked.limit))
            with path.open("a") as kept:
                print(json.dumps(rows[-1]), file=kept)
    print(table(rows))
    for one in rows:
        if one["took"]:
            off = [math.log2(took / said) for took, said in zip(one["took"], one["said"])]
            print(f"{one['number']:3} log2(took/said): stages {off[0]:+.1f}, seconds {off[1]:+.1f}")


if __name__ == "__main__":
    main()
