#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The split-pad study: all sweeps, the stability analysis, tables and figures, from one command.

    validation/pads/study.py [-o DIR] [-j N] [--program PROGRAM] [--publish]

DIR (default results/pads) gets a folder a sweep, tables.md and figures/*.png; what is there already
is not computed again. --publish copies tables and figures beside this file, for README.md.
"""
import argparse
import csv
import json
import shutil
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SWEEPS = ("plain", "count", "height", "gap", "fill", "count-b", "check", "check-b")
FIGURES = ("count", "count-b", "height", "fill", "pads")
STABILITY = {0.003: (1, 2, 4, 5, 8), 0.006: (1, 2, 3, 4, 6, 8, 11)}   # P: numbers of pads
PAD_FIELDS = ("normal_force_peak", "shear_peak", "l_c_over_length")


def number(text):
    return float(text) if text not in ("", None) else None


class Point:
    """One run: the keys varied, the columns recorded, and run.json."""

    def __init__(self, folder, row):
        self.row = row
        run = json.loads((folder / row["run"] / "run.json").read_text()) if row["run"] else {}
        scene = run.get("scene", {})
        self.results = run.get("results", {})
        self.pads = self.results.get("pads", [])
        self.P = scene["load"]["pressure"]
        self.V = scene["rod"]["velocity"]
        self.mesh = scene["mesh"]["set"]
        self.accuracy = scene["time"]["accuracy"]
        self.n = int(self.mesh["n"])
        self.mu, self.period = number(row["mu_M"]), int(row["period"] or 0)
        self.l_c = number(row["l_c"])
        self.fall_low = number(row["results.mu_trusted"])
        self.fall_high = number(row["results.falls.mu_high"])
        self.load = sum(pad["normal_force_start"] for pad in self.pads)


class Study:
    def __init__(self, program, folder, jobs):
        self.program, self.folder, self.jobs = program, folder, jobs
        self.lines = []   # of tables.md

    def sweep(self, name):
        out = self.folder / name
        subprocess.run([self.program, "sweep", HERE / f"{name}.yaml", "-o", out, "-j", str(self.jobs),
                        "--quiet"], check=False)   # 1: some points failed, and the table says which
        with open(out / "sweep.csv", encoding="utf-8") as file:
            return [Point(out, row) for row in csv.DictReader(file) if row["status"] == "done"]

    def stability(self, P, n):
        out = self.folder / "stability" / f"P{P}-n{n}"
        if not (out / "stability.json").exists():
            subprocess.run([self.program, "stability", HERE / "pads.yaml", "-o", out, "--overwrite",
                            "--quiet", "--set", f"load.pressure={P}", "--set", f"mesh.set.n={n}",
                            "--set", f"time.until.U={10 * P}"], check=True)
        return json.loads((out / "stability.json").read_text())["results"], out

    def plot(self, name, **content):
        path = self.folder / "figures" / f"{name}.yaml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")
        subprocess.run([self.program, "render", path], check=True)

    def table(self, title, head, rows):
        self.lines += [f"### {title}", "", "| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
        self.lines += ["| " + " | ".join(show(cell) for cell in row) + " |" for row in rows] + [""]


def show(cell):
    if cell is None:
        return "–"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def series(label, points, x, color, **more):
    """A curve of mu_M with bars from the lowest to the highest mu at which the force falls."""
    return {"label": label, "x": [x(p) for p in points], "y": [p.mu for p in points],
            "low": [low_of(p) for p in points], "high": [high_of(p) for p in points],
            "color": color, "marker": "circle", "line": "thin", **more}


def low_of(point):
    return min(v for v in (point.mu, point.fall_low) if v is not None)


def high_of(point):
    return max(v for v in (point.mu, point.fall_high) if v is not None)


def level(value, x, color):
    return {"x": x, "y": [value, value], "color": color, "marker": "none", "line": "dashed"}


def of_pressure(points, P):
    return [p for p in points if abs(p.P / P - 1) < 1e-9]


MU, FALL = "~{\u03bc}_{M}", "~{\u03bc} at which the force falls"


def study_count(study, points, plain):
    content = []
    rows = []
    for color, P in enumerate((0.001, 0.003, 0.006, 0.012), start=1):
        here = of_pressure(points, P)
        whole = of_pressure(plain, P)[0]
        content += [series(f"~{{P}} = {P:g}", here, lambda p: p.n, color),
                    level(whole.mu, [0.6, 12.4], color)]
        rows.append([f"{P:g}", whole.mu] + [p.mu for p in here])
        rows.append([f"{P:g}, falls", None] + [f"{low_of(p):.3f} – {high_of(p):.3f}" for p in here])
    study.table("Number of pads, equal contact length 0.6 L (set A)",
                ["P", "plain block"] + [f"n = {n}" for n in range(1, 13)], rows)
    study.plot("count", title="mu_M against the number of pads, set A", height=0.85,
               x={"label": "pads ~{n}", "range": [0.4, 12.6]}, y={"label": MU, "range": [0.2, 0.44]},
               legend="upper-right", series=content)


def study_count_b(study, points):
    study.table("Number of pads (set B, P L = 2.3e-6)",
                ["n", "mu_M", "period", "force falls at", "l_c/L"],
                [[p.n, p.mu, p.period, f"{low_of(p):.3f} – {high_of(p):.3f}", p.l_c] for p in points])
    study.plot("count-b", title="mu_M against the number of pads, set B", height=0.7,
               x={"label": "pads ~{n}", "range": [0.4, 10.6]}, y={"label": MU}, legend="none",
               series=[series("", points, lambda p: p.n, 1)])


def study_shape(study, points, key, span, label):
    """Against one parameter of the mesh, a curve a number of pads and pressure: the lowest mu at which
    the force falls, and, where some pads then stay behind, mu_M of the whole block as open squares."""
    name = "height" if key == "pad_height" else key
    content, rows, color = [], [], 0
    for P in (0.003, 0.006):
        for n in sorted({p.n for p in points}):
            color += 1
            here = [p for p in of_pressure(points, P) if p.n == n]
            x = [p.mesh[key] for p in here]
            content.append({"label": f"~{{P}} = {P:g}, ~{{n}} = {n}", "x": x, "color": color,
                            "y": [low_of(p) for p in here], "marker": "circle", "line": "thin"})
            apart = [p for p in here if p.mu and p.mu - low_of(p) > 0.01]
            content.append({"x": [p.mesh[key] for p in apart], "y": [p.mu for p in apart],
                            "color": color, "marker": "square", "filled": False, "line": "none"})
            rows += [[f"{P:g}", n, p.mesh[key], p.mu, p.period, f"{low_of(p):.3f} – {high_of(p):.3f}",
                      p.l_c] for p in here if p.fall_low is not None]
    study.table(f"Varied: {key}",
                ["P", "n", key, "mu_M", "period", "force falls at", "l_c/L"], rows)
    content = [curve for curve in content if curve["x"]]
    study.plot(name, title=f"mu_M against {label}", height=0.95, x={"label": label},
               y={"label": FALL, "range": span}, legend="upper-right", series=content)


def mode_of_pads(folder, n):
    """How much of the unstable mode each pad takes: mean |slip|, the largest 1."""
    try:
        import h5py
    except ImportError:
        return ["needs h5py"]
    with h5py.File(folder / "stability.h5") as file:
        x, slip = file["nodes/x"][:], abs(file["critical/slip"][:])
    pad = [min(int(value * n), n - 1) for value in x]
    means = [sum(s for s, p in zip(slip, pad) if p == k) / pad.count(k) for k in range(n)]
    return [round(float(m / max(max(means), 1e-300)), 2) for m in means]


def study_stability(study, points):
    rows = []
    for P, numbers in STABILITY.items():
        for n in numbers:
            found, folder = study.stability(P, n)
            run = [p for p in of_pressure(points, P) if p.n == n][0]
            mode = mode_of_pads(folder, n)
            rows.append([f"{P:g}", n, found["mu_M"], run.mu, found["l_c_at_V_over_L"], run.l_c,
                         " ".join(map(str, mode))])
    study.table("Loss of stability on the quasi-static path, and which pads move in the unstable mode",
                ["P", "n", "mu_M, stability", "mu_M, time stepping", "l_c/L, stability",
                 "l_c/L, time stepping", "mode, pad by pad"], rows)


def study_pads(study, points):
    """What each pad carries when mu is largest."""
    rows, content = [], []
    for color, (P, n) in enumerate(((0.006, 2), (0.006, 4), (0.006, 9), (0.006, 11)), start=1):
        run = [p for p in of_pressure(points, P) if p.n == n][0]
        if any(pad[field] is None for pad in run.pads for field in PAD_FIELDS):
            continue
        middle = [(pad["x_from"] + pad["x_to"]) / 2 for pad in run.pads]
        ratio = [pad["shear_peak"] / pad["normal_force_peak"] for pad in run.pads]
        load = [pad["normal_force_peak"] / run.load * n for pad in run.pads]
        slow = [pad["l_c_over_length"] for pad in run.pads]
        rows.append([f"{P:g}", n, run.mu, " ".join(f"{v:.2f}" for v in load),
                     " ".join(f"{v:.2f}" for v in ratio), " ".join(f"{v:.2f}" for v in slow)])
        content.append({"label": f"~{{n}} = {n}", "x": middle, "y": ratio, "color": color,
                        "marker": "circle", "line": "thin"})
    study.table("Each pad when mu is largest: load over its share, shear over load, part that slips "
                "before its slip turns fast", ["P", "n", "mu_M", "load", "shear/load", "slow part"], rows)
    study.plot("pads", title="Shear over load of each pad at the peak", height=0.7,
               x={"label": "~{x} / ~{L}", "range": [0, 1]},
               y={"label": "shear / load of a pad", "range": [0.1, 0.42]}, legend="lower-left",
               series=content + [level(0.38, [0, 1], 0)])



def case_of(point):
    if point.mesh["size_contact"] < 0.01:
        return "mesh twice as fine"
    if point.accuracy == "fine":
        return "fine steps"
    if point.mesh.get("shape") == "triangle":
        return "T6"
    return "V/2" if point.V < 9e-6 else "as computed"


def study_check(study, points):
    cases = ["as computed", "mesh twice as fine", "fine steps", "T6", "V/2"]
    rows = []
    for P in (0.003, 0.006):
        for n in sorted({p.n for p in points}):
            found = {case_of(p): p for p in of_pressure(points, P) if p.n == n}
            rows.append([f"{P:g}", n] + [found[c].mu if c in found else None for c in cases])
    study.table("Mesh, steps, element, velocity", ["P", "n"] + cases, rows)


def study_check_b(study, points, standard):
    rows = []
    for n in sorted({p.n for p in points}):
        fine = [p for p in points if p.n == n]
        rows.append([n, [p.mu for p in standard if p.n == n][0],
                     [p.mu for p in fine if p.mesh["size_contact"] < 4e-4][0],
                     [p.mu for p in fine if p.accuracy == "fine"][0]])
    study.table("Set B: mesh and steps", ["n", "as computed", "mesh twice as fine", "fine steps"], rows)


def publish(folder):
    shutil.copy(folder / "tables.md", HERE / "tables.md")
    for name in FIGURES:
        shutil.copy(folder / "figures" / f"{name}.png", HERE / f"{name}.png")


def main():
    reader = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    reader.add_argument("-o", "--output", type=Path, default=ROOT / "results/pads")
    reader.add_argument("-j", "--jobs", type=int, default=2)
    reader.add_argument("--program", type=Path, default=ROOT / "amontons")
    reader.add_argument("--publish", action="store_true")
    words = reader.parse_args()
    words.output.mkdir(parents=True, exist_ok=True)
    study = Study(words.program, words.output, words.jobs)
    points = {name: study.sweep(name) for name in SWEEPS}
    study_count(study, points["count"], points["plain"])
    study_count_b(study, points["count-b"])
    study_shape(study, points["height"], "pad_height", [0.19, 0.43], "pad height / ~{L}_{0}")
    study_shape(study, points["gap"], "gap", [0.24, 0.36], "gap / ~{L}_{0}")
    study_shape(study, points["fill"], "fill", [0.21, 0.41], "share of the face in contact")
    study_pads(study, points["count"])
    study_stability(study, points["count"])
    study_check(study, points["check"])
    study_check_b(study, points["check-b"], points["count-b"])
    (words.output / "tables.md").write_text("\n".join(study.lines), encoding="utf-8")
    if words.publish:
        publish(words.output)


if __name__ == "__main__":
    main()
