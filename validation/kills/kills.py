#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs, sweeps and renders killed (SIGKILL) at random moments and gone on with, again and again, until they end: is every
byte of what they found the same as without a kill?

    validation/kills/kills.py [--kills N] [--seed N] [-o DIR] [--program PROGRAM] [CASE ...]

Each case is run once as it is, which also says how long it takes. Then it is begun anew, killed after a random part of
that time, gone on with by --resume, killed again, until it comes to its end; and all of that until there were N kills
(200) over all cases. Compared are history.h5 (arrays and attributes), run.json (all but times and `resumed`), fields
and pictures. Checkpoints of runs are written every 30 ms, so that kills meet them too. A sweep is killed with its
points' processes and taken up by the same command; a render is killed over an earlier picture, which must stay whole. Prints a table, in Markdown; the exit
status is 1 if anything differs. 200 kills take some five minutes.
"""
import argparse
import collections
import csv
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[2]
FIG1, PADS = ROOT / "validation" / "paper" / "fig1.yaml", ROOT / "validation" / "pads" / "pads.yaml"
BASE = ROOT / "validation" / "bodies" / "cases.yaml"
SMALL = ["mesh.set.nx=16", "mesh.set.nz=16", "output.figures=[force]"]
# What a state is made of differs: fields, the full mesh, nodes that open, the explicit scheme, a mesh that gmsh makes, a floor that deforms.
CASES = {
    "block, reduced": (FIG1, [*SMALL, "output.fields=none", "time.until.U=0.02"]),
    "block, fields": (FIG1, [*SMALL, "output.fields={every_U: 0.0005, at_events: true}"]),
    "block, full mesh": (FIG1, [*SMALL, "output.fields=none", "reduction.use=never"]),
    "block, explicit": (FIG1, [*SMALL, "output.fields=none", "mesh.set.nx=8", "mesh.set.nz=8",
                                "time.scheme=explicit", "time.until.U=0.002"]),
    "block, window": (FIG1, [*SMALL, "output.fields={every_step: true}", "output.window={from_U: 0.01694}",
                             "time.until.U=0.02"]),
    "four pads": (PADS, ["mesh.set.size_contact=0.025", "output.figures=[force]", "time.until.U=0.04"]),
    "block, until periodic": (FIG1, [*SMALL, "output.fields=none",
                                     "time.until={U: 0.06, periodic: true}"]),
    "block on a base, nodes apart, fields": (BASE, ["mesh.set={nx: 16, nz: 8, ratio: 1.25}", "output.figures=[force]",
                                                    "output.fields={every_U: 0.002}"]),
    "block on a base, explicit": (BASE, ["mesh.set={nx: 8, nz: 4}", "time.scheme=explicit", "time.until.U=0.004"]),
}
SWEEP, RENDER = "sweep of three points", "render"
STUDY = """scene: {scene}
set: {{mesh.set.nx: 16, mesh.set.nz: 16, time.until.U: 0.01, output.history: true, output.fields: none, output.figures: []}}
vary: {{load.pressure: [0.003, 0.0033, 0.0036]}}
record: [results.mu_max, results.mu_M]
"""


def arrays(path):
    """Everything in an HDF5 file: {name: type, shape, bytes, attributes}."""
    found = {}
    with h5py.File(path) as file:
        found["/"] = {name: numpy.asarray(value).tobytes() for name, value in file.attrs.items()}
        file.visititems(lambda name, entry: found.update({name: (
            entry.dtype.str, entry.shape, entry[()].tobytes(), {k: str(v) for k, v in entry.attrs.items()})})
            if isinstance(entry, h5py.Dataset) else None)
    return found


def report(path):
    """run.json without what may differ: what writes fields makes room when it is first used, also after a kill."""
    found = json.loads(path.read_text())
    found["steps"].pop("loop_allocations")
    return {key: value for key, value in found.items() if key not in ("timing_s", "resumed")}


def differences(whole, cut):
    """What of two results differs, in words; none: []."""
    first, second = arrays(whole / "history.h5"), arrays(cut / "history.h5")
    found = [f"history.h5: {name}" for name in first.keys() | second.keys() if first.get(name) != second.get(name)]
    first, second = report(whole / "run.json"), report(cut / "run.json")
    found += [f"run.json: {name}" for name in first.keys() | second.keys() if first.get(name) != second.get(name)]
    first, second = ({path.relative_to(folder): path.read_bytes() for path in folder.rglob("*")
                      if path.suffix in (".vtu", ".vtp", ".pvd", ".png")} for folder in (whole, cut))
    return found + [str(name) for name in first.keys() | second.keys() if first.get(name) != second.get(name)]


class Case:
    def __init__(self, name, folder, program):
        self.name, self.program = name, program
        scene, settings = CASES[name]
        place = "".join(c if c.isalnum() else "-" for c in name)
        self.words = [scene, *(word for setting in settings for word in ("--set", setting))]
        self.whole, self.cut = folder / f"{place}-whole", folder / f"{place}-cut"
        self.kills, self.moments, self.ends, self.wrong = 0, collections.Counter(), 0, []

    go_on, anew = ["--checkpoint", "0.03s", "--resume"], ["--checkpoint", "0.03s", "--overwrite"]

    def command(self, folder, *more):
        return [self.program, "run", *map(str, self.words), "-o", str(folder), "--quiet", *more]

    def run_whole(self):
        shutil.rmtree(self.whole, ignore_errors=True)
        subprocess.run(self.command(self.whole), check=True)   # fills the cache
        shutil.rmtree(self.whole)
        started = time.monotonic()
        subprocess.run(self.command(self.whole), check=True)
        self.seconds = time.monotonic() - started

    def moment(self):
        """What there was when the kill came."""
        if not (self.cut / "checkpoint.bin").exists():
            return "before the first checkpoint"
        if (self.cut / "checkpoint.bin.part").exists():
            return "while one was written"
        return "at the end" if (self.cut / "history.h5").exists() else "between two"

    def run_cut(self, chance, kills_left):
        """From nothing to the end, through some kills."""
        self.prepare()
        while True:
            go_on = (self.cut / "checkpoint.bin").exists()
            process = subprocess.Popen(self.command(self.cut, *(self.go_on if go_on else self.anew)),
                                       start_new_session=True, stdout=subprocess.DEVNULL)
            try:
                process.wait(chance.uniform(0, 1.1 * self.seconds) if self.kills < kills_left else None)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                self.wrong += self.torn()
                self.kills += 1
                self.moments[self.moment()] += 1
                continue
            if process.returncode != 0:
                self.wrong.append(f"exit status {process.returncode}")
            break
        self.ends += 1
        self.wrong += self.compare() if process.returncode == 0 else []

    def prepare(self):
        shutil.rmtree(self.cut, ignore_errors=True)

    def torn(self):
        """What is wrong right after a kill."""
        return []

    def compare(self):
        return differences(self.whole, self.cut)


class Sweep(Case):
    go_on, anew = [], []

    def __init__(self, name, folder, program):
        self.name, self.program, self.study = name, program, folder / "study.yaml"
        self.whole, self.cut = folder / "sweep-whole", folder / "sweep-cut"
        self.kills, self.moments, self.ends, self.wrong = 0, collections.Counter(), 0, []
        self.study.write_text(STUDY.format(scene=FIG1))

    def command(self, folder, *more):
        return [self.program, "sweep", str(self.study), "-j", "2", "-q", "-o", str(folder), *more]

    def moment(self):
        return "at the end" if (self.cut / "sweep.csv").exists() else "between two"

    def compare(self):
        """Tables without times, and each point."""
        tables = [[{key: cell for key, cell in row.items() if "time" not in key and "second" not in key}
                   for row in csv.DictReader(open(folder / "sweep.csv", newline=""))] for folder in (self.whole, self.cut)]
        found = ["sweep.csv"] if tables[0] != tables[1] else []
        for point in sorted((self.whole / "points").iterdir()):
            if point.is_dir():
                found += differences(point, self.cut / "points" / point.name)
        return found


class Render(Case):
    go_on, anew = [], []

    def __init__(self, name, folder, program):
        super().__init__("block, fields", folder, program)
        self.name, self.whole, self.cut = name, folder / "render-whole", folder / "render-cut"

    def command(self, folder, *more):
        if not (folder / "history.h5").exists():
            return super().command(folder)
        return [self.program, "render", str(folder), "--figure", "force"]

    def run_whole(self):
        super().run_whole()
        started = time.monotonic()
        subprocess.run(self.command(self.whole), check=True, stdout=subprocess.DEVNULL)
        self.seconds = time.monotonic() - started
        self.picture = (self.whole / "figures" / "force.png").read_bytes()

    def prepare(self):
        super().prepare()
        shutil.copytree(self.whole, self.cut)

    def moment(self):
        return "between two"

    def torn(self):
        whole = (self.cut / "figures" / "force.png").read_bytes() == self.picture
        return [] if whole else ["figures/force.png was torn"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", dest="folder", type=Path, default=ROOT / "results" / "kills")
    parser.add_argument("--program", default=str(ROOT / "build" / "bin" / "amontons"))
    parser.add_argument("cases", nargs="*", default=[*CASES, SWEEP, RENDER], metavar="CASE")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    os.environ["AMONTONS_CACHE"] = str(asked.folder / "cache")
    chance = random.Random(asked.seed)
    kinds = {SWEEP: Sweep, RENDER: Render}
    cases = [kinds.get(name, Case)(name, asked.folder, asked.program) for name in asked.cases]
    for number, case in enumerate(cases):
        case.run_whole()
        share = asked.kills * (number + 1) // len(cases) - asked.kills * number // len(cases)
        while case.kills < share:
            case.run_cut(chance, share)
    print("| run | seconds | kills | before the first checkpoint | while one was written | at the end | runs that ended "
          "| different |\n|---|---|---|---|---|---|---|---|")
    for case in cases:
        print(f"| {case.name} | {case.seconds:.1f} | {case.kills} | {case.moments['before the first checkpoint']} "
              f"| {case.moments['while one was written']} | {case.moments['at the end']} | {case.ends} "
              f"| {len(case.wrong)} |")
        for line in case.wrong:
            print(f"    {line}", file=sys.stderr)
    return any(case.wrong for case in cases)


if __name__ == "__main__":
    sys.exit(main())
