# SPDX-License-Identifier: GPL-2.0-or-later
"""Recomputes the paper's figures 1 to 3 from nothing, and says how the numbers compare: `./amontons reproduce`.

Sweeps are taken up where an earlier call stopped. Figures and REPORT.md go into the folder given by -o.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import critical
import fronts
import paper_figures as figures
import paper_report as report
import refinement
import theory
from interface import History, same
from windows import windows

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import bars   # noqa: E402

COARSE = ["mesh.set.nx=20", "mesh.set.nz=20"]


class Place:
    """The program, the folder of results, and what was done."""

    def __init__(self, options):
        root = HERE.parents[1]
        self.program = Path(os.environ.get("AMONTONS_BIN", root / "build" / "bin")) / "amontons"
        self.folder, self.quick, self.jobs = Path(options.output), options.quick, options.jobs
        self.fresh = ["--fresh"] if options.fresh else []
        self.figures = self.folder / "figures"
        self.figures.mkdir(parents=True, exist_ok=True)
        self.seconds, self.pictures, self.noting = {}, [], threading.Lock()

    def call(self, *words, label=None):
        """Status; what it says goes on, with a label each line behind it: several may run at once."""
        command = [str(self.program), *map(str, words)]
        if label is None:
            return subprocess.run(command, check=False).returncode
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
            for line in running.stdout:
                print(f"{label}: {line}", end="", flush=True)
        return running.returncode

    def sweep(self, name, label=None, settings=(), study=None):
        """Rows of the table of study `name` (in the file `study`), as dicts; numbers where they are numbers."""
        label, started = label or name, time.monotonic()
        if self.quick and label == name:
            settings = [*settings, *COARSE]
        folder = self.folder / label
        words = ["sweep", study or HERE / f"{name}.yaml", "-o", folder, "-j", self.jobs, *self.fresh]
        for setting in settings:
            words += ["--set", setting]
        print(f"--- {label}", flush=True)
        if self.call(*words, label=label) == 2:
            sys.exit(f"the study {name} could not be run")
        self.note_time(label, time.monotonic() - started)
        with open(folder / "sweep.csv", newline="") as file:
            rows = [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]
        for row in rows:
            row["folder"] = folder / row["run"]
        return rows

    def note_time(self, label, seconds):
        """The longest is kept over calls: a sweep taken up again has less to do."""
        path = self.folder / "times.json"
        with self.noting:
            known = json.loads(path.read_text()) if path.exists() else {}
            known[label] = self.seconds[label] = max(seconds, known.get(label, 0))
            path.write_text(json.dumps(known))

    def timed(self, label, work):
        """What work() returns; its wall time is noted."""
        print(f"--- {label}", flush=True)
        started = time.monotonic()
        answer = work()
        self.note_time(label, time.monotonic() - started)
        return answer

    def draw(self, name, plot):
        path = self.figures / f"{name}.yaml"
        path.write_text(json.dumps(without_nan(plot), indent=1, ensure_ascii=False))
        if self.call("render", path, "--title", "none", "--overwrite") == 0:
            self.pictures.append(name)


def number(text):
    try:
        return float(text)
    except ValueError:
        return text if text else float("nan")


def without_nan(value):
    """As JSON has it: null where there is no number."""
    if isinstance(value, dict):
        return {key: without_nan(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(v) for v in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if np.isfinite(value) else None
    return value


def finer(place, name):
    """compute(cells, grade_x, points) for refinement.refine: a study of those points is written, and swept."""
    def compute(cells, grade_x, points):
        label = f"{name}-{cells}-{refinement.NAMES[grade_x] or 'even'}"
        study = place.folder / f"{label}.yaml"
        study.write_text(refinement.study_text((HERE / f"{name}.yaml").read_text(), HERE, points))
        return windows(place.sweep(name, label, refinement.settings(cells, grade_x), study))
    return compute


def pressure_pairs(place, study, material, cells):
    """Of figure 2a or 2b: pairs of even meshes, and those with finer ones where these do not settle it."""
    coarse = windows(place.sweep(study))
    fine = coarse if place.quick else windows(place.sweep(study, f"{study}-80", ["mesh.set.nx=80", "mesh.set.nz=80"]))
    even = [refinement.Pair(*pair, cells) for pair in zip(coarse, fine)]
    return even, even if place.quick else refinement.refine(even, material, finer(place, study))


def pressure_parts(place, parts):
    """Figures 2a, 2b and 3a; what they show as pairs of meshes, by set. Both sets are computed side by side: towards the end of
    a sweep, and of one with a point or two, a processor would have nothing to do."""
    cells, found = 20 if place.quick else refinement.EVEN, {}
    sets = (("A", theory.A, False), ("B", theory.B, True))
    with ThreadPoolExecutor(len(sets)) as pool:
        pairs = list(pool.map(lambda one: pressure_pairs(place, f"fig2{one[0].lower()}", one[1], cells), sets))
    for (name, material, filled), (even, found[name]) in zip(sets, pairs):
        study, key = f"fig2{name.lower()}", name.lower()
        if place.quick:   # one mesh, no bars
            rows = [{"mesh.set.length": pair.length, "load.pressure": pair.P,
                     "mu_M": (pair.fine.mu, None) if np.isfinite(pair.fine.mu) else "none"} for pair in found[name]]
        else:
            rows = bars.read_rows(place.sweep(f"{study}-bars"))
            parts[f"block_{key}"] = report.line_against(rows, material) + report.windows_against(rows, found[name])
        figures.figure_2(place, study, rows, material, filled)
        parts[f"even_{key}"] = report.even_table(even, finer=not place.quick)
        if not place.quick:
            parts[key] = report.pair_table(found[name])
            parts[f"agreement_{key}"] = report.agreement_words(found[name], even)
    figures.figure_3a(place, {name: [pair.fine for pair in pairs] for name, pairs in found.items()})
    parts.update(cells=cells)
    return {name: [pair.fine for pair in pairs] for name, pairs in found.items()}


def draw_figure_2(place):
    """From bars.md, as it lies beside this file."""
    texts = bars.sections(HERE / "bars.md")
    for name, material, filled in (("a", theory.A, False), ("b", theory.B, True)):
        rows = bars.read_table(texts[f"Figure 2{name} of the paper with error bars, set {material.name}"])
        figures.figure_2(place, f"fig2{name}", rows, material, filled)
        print(report.line_against(rows, material))


def line_and_profiles(place, parts):
    rows = place.sweep("line")
    shown = [row for row in rows if same(row["load.pressure"], 0.003) and row["status"] == "done"]
    history = History(shown[0]["folder"])
    parts["profile"] = report.profile_words(history, figures.figures_3bc(place, history))
    split = report.line_parts(rows)
    parts["line"], parts["words"] = report.line_table(split), report.line_words(split)


def velocity_parts(place, parts):
    of_a, of_b = place.sweep("velocity-a"), place.sweep("velocity-b")
    figures.figure_velocity(place, of_a)
    figures.figure_adiabatic(place, of_b)
    parts["velocity"] = report.velocity_table(of_a)
    parts["adiabatic"] = report.table(["V / v_c", "mu_M", "low", "high", "steps"],
                                      [(row["rod.velocity"] / theory.B.critical_velocity, row["mu_M"], row["low"], row["high"],
                                        row["steps"]) for row in of_b])


def critical_parts(place, parts, dynamic):
    found = {name: place.timed(f"critical-{name}", lambda name=name: critical.measure(place, HERE, name)) for name in "AB"}
    figures.figures_critical(place, dynamic, found)
    parts["critical_a"], parts["critical_b"] = (report.critical_table(found[name]) for name in "AB")


def front_parts(place, parts):
    rows = [row for row in place.sweep("precursors") if row["status"] == "done"]
    cases = [(f"~{{L}} = {row['mesh.set.length']:g}, ~{{P}} = {row['load.pressure']:g}", fronts.load(row["folder"])) for row in rows]
    drawn = [case for row, case in zip(rows, cases) if not same(row["load.pressure"], 0.01)]   # that one is fast all the way
    figures.figures_fronts(place, [case for case in drawn if len(fronts.rapid_of_last_cycle(case[1]))])
    parts["catalogue"] = report.catalogue(cases, (1e-5, theory.A.critical_velocity))


def main():
    parser = argparse.ArgumentParser(prog="./amontons reproduce", description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", default="results/paper", help="the folder (default: results/paper)")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count() or 1, help="points computed at a time")
    parser.add_argument("--quick", action="store_true", help="20 cells, and nothing finer: a look, in a minute")
    parser.add_argument("--fresh", action="store_true", help="compute again what an earlier call (of another build) left")
    parser.add_argument("--draw", action="store_true", help="figure 2 alone, from bars.md, and its comparison with the 1D theory")
    options = parser.parse_args()
    place, parts, started = Place(options), {}, time.monotonic()
    if options.draw:
        return draw_figure_2(place)
    dynamic = pressure_parts(place, parts)
    line_and_profiles(place, parts)
    velocity_parts(place, parts)
    critical_parts(place, parts, dynamic)
    front_parts(place, parts)
    parts["readings"] = report.readings_table(place.sweep("readings"))
    parts["depends"] = "(left out: quick)\n" if place.quick else report.depends_table(place.sweep("depends"))
    place.note_time(report.WHOLE, time.monotonic() - started)
    report.write(place, parts)


if __name__ == "__main__":
    main()
