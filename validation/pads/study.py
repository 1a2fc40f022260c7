#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The split-pad study: all sweeps, the stability analysis, tables and figures, from one command.

    validation/pads/study.py [-o DIR] [-j N] [--program PROGRAM] [--publish]
    validation/pads/study.py --draw [--publish]

DIR (default results/pads) gets a folder a sweep, tables.md and figures/*.png; what is there already
is not computed again. Answers with error bars are those of bars.py, which it calls (17 minutes of processor time).
--publish copies tables and figures beside this file, for README.md. --draw: the figures alone, from the tables beside this file (one run of a second is computed).
Needs h5py (python3-h5py) for the figure of the loads in time.
"""
import argparse
import csv
import json
import math
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE.parent), str(ROOT / "docs/examples")]
sys.dont_write_bytecode = True
import bars   # noqa: E402
from shown import keep_picture   # noqa: E402

SWEEPS = ("count-b", "height-b", "gap-b", "fine-b", "check-b", "check",   # long ones first
          "height", "plain-b", "grooves", "count", "fill", "gap", "plain")
FIGURES = ("count", "count-b", "load", "drag", "transfer", "shape", "shape-b")
SET_A, SET_B = (0.001, 0.003, 0.006, 0.012), (1.5e-5, 5.75e-5, 2.3e-4)   # pressures
COUNTS = range(1, 13)
MU = "~{\u03bc}"
MARKERS = ("circle", "square", "triangle", "down", "circle", "square", "triangle")   # from the fifth on open


def number(text):
    return float(text) if text not in ("", None) else None


class Point:
    """One run: what was varied and recorded, and run.json."""

    def __init__(self, folder, row):
        run = json.loads((folder / row["run"] / "run.json").read_text()) if row["run"] else {}
        scene = run["scene"]
        self.scene, self.results = scene, run["results"]
        self.pads = self.results["pads"]
        self.P, self.mesh = scene["load"]["pressure"], scene["mesh"]["set"]
        self.sweep, self.place = folder.name, row["run"]
        self.steps = run["steps"]["accepted"]
        self.n = int(self.mesh.get("n", 0))
        self.mu, self.hold = number(row["mu_M"]), number(row["mu_hold"])
        self.l_c, self.first_pad = number(row["l_c"]), number(row["mu_first_pad"])
        self.hold_error, drops = self.results["mu_hold_error"], self.results["drops"]
        self.high = max((b["high"] for b in drops["branches"]), default=None)
        self.mean, self.mean_error = drops["mean"], drops["mean_error"]
        self.drops, self.period, self.enough = drops["counted"], drops["period"], drops["enough"]

    def average(self):
        """Mean of the load drops, with its error bar (95 %) where they do not repeat."""
        if self.mean_error is None or self.period:
            return self.mean
        return f"{self.mean:.3f} ± {self.mean_error:.3f}" + ("" if self.enough else ", too few")

    def low_end(self):
        """mu_hold, with its error bar (95 %) where drops do not repeat."""
        if self.hold_error is None or self.period:
            return self.hold
        return f"{self.hold:.3f} ± {self.hold_error:.3f}"

    def branches(self):
        """mu and the number of pads that slide, of each branch of drops."""
        return ", ".join(f"{b['mu']:.3f} ({b['pads_slid']})" for b in self.results["drops"]["branches"])


def read_points(folder):
    """Those of a sweep's folder that are done, by pressure and number of pads."""
    with open(folder / "sweep.csv", encoding="utf-8") as file:
        points = [Point(folder, row) for row in csv.DictReader(file) if row["status"] == "done"]
    return sorted(points, key=lambda p: (p.P, p.n))


class Study:
    def __init__(self, program, folder, jobs):
        self.program, self.folder, self.jobs = program, folder, jobs
        self.lines = []   # of tables.md

    def sweeps(self, names):
        """{name: points}; two sweeps at a time, so that no processor waits for the last points of one."""
        each = max(self.jobs // 2, 1)
        with ThreadPoolExecutor(min(self.jobs, 2)) as pool:
            return dict(zip(names, pool.map(lambda name: self.sweep(name, each), names)))

    def sweep(self, name, jobs):
        out = self.folder / name
        subprocess.run([self.program, "sweep", HERE / f"{name}.yaml", "-o", out, "-j", str(jobs),
                        "--quiet"], check=False)   # 1: some points failed, and the table says which
        return read_points(out)

    def stability(self, scene, sets):
        """results and pads of `amontons stability`; None where it failed."""
        name = "-".join(str(value) for value in sets.values())
        out = self.folder / "stability" / f"{scene}-{name}"
        if not (out / "stability.json").exists():
            words = [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]
            subprocess.run([self.program, "stability", HERE / f"{scene}.yaml", "-o", out, "--overwrite",
                            "--quiet", *words], check=False, stdout=subprocess.DEVNULL)
        if not (out / "stability.json").exists():
            return None
        found = json.loads((out / "stability.json").read_text())
        return {**found["results"], "pads": found["pads"]}

    def stabilities(self, every):
        """Of pairs of a scene and what is set in it."""
        with ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(lambda one: self.stability(*one), every))

    def plot(self, name, **content):
        path = self.folder / "figures" / f"{name}.yaml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")
        subprocess.run([self.program, "render", path, "--title", "none", "--overwrite"], check=True, stdout=subprocess.DEVNULL)

    def table(self, title, head, rows):
        self.lines += [f"### {title}", "", "| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
        self.lines += ["| " + " | ".join(show(cell) for cell in row) + " |" for row in rows] + [""]


def show(cell):
    if cell is None:
        return "–"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def stress(P):
    """A pressure in words: 0.003, 2.3e-4."""
    mantissa, power = f"{P:.3e}".split("e")
    return f"{P:g}" if P >= 1e-3 else f"{float(mantissa):g}e{int(power)}"


def of_pressure(points, P):
    return [p for p in points if near(p.P, P)]


# --- figures of mu: drawn from the tables that are published --------------------------------------

def tables_of(page):
    """{title: rows} of tables.md; a number with its error is a pair."""
    texts = page.read_text(encoding="utf-8").split("### ")[1:]
    return {text.split("\n")[0].split(";")[0]: bars.read_table(text) for text in texts}


def value(cell):
    return cell[0] if isinstance(cell, tuple) else cell if isinstance(cell, float) else None


def near(a, b):
    return abs(a / b - 1) < 1e-9


def marked(color):
    """Of a curve of that colour: it is told without it, too."""
    return {"color": color, "marker": MARKERS[color - 1], "filled": color < 5}


def with_bars(label, rows, x, over, color):
    """mu_hold over `over`, (value, bar); crosses where nothing is known of its error."""
    series = []
    for known in (True, False):
        at = [row for row in rows if (row["mu_hold"][1] is not None) == known]
        if not at:
            continue
        y = [row["mu_hold"][0] / over[0] for row in at]
        error = [y[k] * math.hypot(row["mu_hold"][1] / row["mu_hold"][0], over[1] / over[0]) if known else 0
                 for k, row in enumerate(at)]
        series.append({"label": label if not series else "", "x": [row[x] for row in at], "y": y, **marked(color),
                       "low": [v - e for v, e in zip(y, error)], "high": [v + e for v, e in zip(y, error)],
                       "line": "none", **({} if known else {"marker": "cross"})})
    return series


def one_mesh(rows, x, over, color):
    return {"x": [row[x] for row in rows], "y": [value(row["mu_hold"]) / over for row in rows if value(row["mu_hold"])],
            "color": color, "marker": "none", "line": "thin"}


def level(value, x, color):
    return {"x": x, "y": [value, value], "color": color, "marker": "none", "line": "dashed"}


def at_pressure(rows, P):
    return [row for row in rows if near(row.get("P", row.get("load.pressure")), P)]


def draw_count(study, name, tables, answers, pressures):
    """Marks: answers with bars; thin: one mesh; dashed: the block without gaps, with its bar at its end."""
    table = tables[f"Number of pads, equal contact length 0.6 L (set {'A' if name == 'count' else 'B'})"]
    of_pads, plain = answers
    content = []
    for color, P in enumerate(pressures, start=1):
        whole = at_pressure(plain, P)[0]["mu_hold"]
        content += with_bars(f"~{{P}} = {stress(P)}", at_pressure(of_pads, P), "mesh.set.n", (1, 0), color)
        content += [one_mesh([row for row in at_pressure(table, P) if row["n"] != "none"], "n", 1, color),
                    level(whole[0], [0.2, 12.4], color),
                    {"x": [0.2], "y": [whole[0]], "low": [whole[0] - whole[1]], "high": [whole[0] + whole[1]], **marked(color),
                     "line": "none"}]
    content[-3]["label"], content[-2]["label"] = "one mesh", "without gaps"
    study.plot(name, title=f"mu_hold against the number of pads, set {'A' if name == 'count' else 'B'}", height=0.8, legend="below",
               x={"label": "pads ~{n}", "range": [0, 12.6]},
               y={"label": f"{MU}_{{hold}}", "range": [0.2, 0.4] if name == "count" else [0.4, 1.1]}, series=content)


def draw_shape(study, tables, found):
    """mu_hold over that of the block without gaps: heights of pads, depths of grooves."""
    content, color = [], 0
    heights = found["Height of the pads, with error bars"] + [
        {**row, "mesh.set.pad_height": 0.05} for row in found["Pads of set A with error bars"]]
    for P in (0.003, 0.006):
        whole = at_pressure(found["The block without gaps, with error bars"], P)[0]["mu_hold"]
        single = value(next(row for row in at_pressure(tables["Number of pads, equal contact length 0.6 L (set A)"], P)
                            if row["n"] == "none")["mu_hold"])
        for what, rows, x, table, y, keep in (
                *((f"{n} pads", heights, "mesh.set.pad_height", tables["Varied: pad_height (set A)"], "pad_height",
                   lambda row, n=n: n in (row.get("n"), row.get("mesh.set.n"))) for n in (4, 8)),
                ("7 grooves", found["Shallow grooves with error bars"], "mesh.set.depth", tables["Shallow grooves"], "depth",
                 lambda row: row.get("mesh.set.grooves", row.get("grooves")) == 7
                 and row.get("mesh.set.width", row.get("width")) == 0.05)):
            color += 1
            content += with_bars(f"~{{P}} = {stress(P)}, {what}", [row for row in at_pressure(rows, P) if keep(row)], x, whole, color)
            content.append(one_mesh([row for row in at_pressure(table, P) if keep(row)], y, single, color))
    content[-1]["label"] = "one mesh"
    study.plot("shape", title="mu_hold over that of the block without gaps", height=0.75, legend="below",
               x={"label": "height of pads, depth of grooves / ~{L}_{0}", "range": [0, 0.16]},
               y={"label": f"{MU}_{{hold}} over that without gaps", "range": [0.75, 1.1]}, series=content + [level(1, [0, 0.155], 0)])


def draw_shape_b(study, tables):
    """One mesh each, and no bars: L of set B is 0.04."""
    content = []
    for P in (SET_B[0], SET_B[2]):
        whole = value(next(row for row in at_pressure(tables["Number of pads, equal contact length 0.6 L (set B)"], P)
                           if row["n"] == "none")["mu_hold"])
        for n in (2, 4):
            rows = [{**row, "x": row["pad_height"] / 0.04}
                    for row in at_pressure(tables["Varied: pad_height (set B)"], P) if row["n"] == n]
            color = len(content) + 1
            content.append({**one_mesh(rows, "x", whole, color), "label": f"~{{P}} = {stress(P)}, {n} pads", **marked(color)})
    study.plot("shape-b", title="mu_hold over that of the block without gaps, set B: one mesh each, no bars", height=0.7,
               x={"label": "height of pads / ~{L}", "range": [0, 0.16]},
               y={"label": f"{MU}_{{hold}} over that without gaps", "range": [0.7, 1.05]}, series=content + [level(1, [0, 0.155], 0)])


def draw_load(study, tables):
    content = []
    for name, pressures in (("A", SET_A[1:]), ("B", SET_B[1:2])):
        table = next(rows for title, rows in tables.items() if title.startswith("Loss of stability") and
                     f"({'pads' if name == 'A' else 'pads-b'}.yaml)" in title)
        for P in pressures:
            rows = at_pressure(table, P)
            content.append({"label": f"{name}, ~{{P}} = {stress(P)}", "x": [row["n"] for row in rows], **marked(len(content) + 1),
                            "y": [row["weakening / resistance"] for row in rows], "line": "thin"})
    study.plot("load", title="Weakening over what the trailing pad resists alone", height=0.7,
               x={"label": "pads ~{n}", "range": [0.4, 12.6]},
               y={"label": "weakening / resistance", "scale": "log"}, series=content + [level(1, [0.6, 12.4], 0)])


def draw_drag(study, tables):
    """Of pads by their height, of grooves (dashed) by their depth."""
    table = next(rows for title, rows in tables.items() if title.startswith("Drag"))
    content = []
    for contact in dict.fromkeys(row["contact"] for row in table):
        rows = [row for row in table if row["contact"] == contact]
        content.append({"label": contact.replace("1 pads", "1 pad"), "x": [row["height"] for row in rows],
                        "y": [row["drag, trailing pad"] for row in rows], **marked(len(content) + 1),
                        "line": "dashed" if "grooves" in contact else "thin"})
    study.plot("drag", title="Drag of the trailing pad against height of pads, depth of grooves", height=0.7,
               x={"label": "height of pads, depth of grooves / ~{L}_{0}", "range": [0, 0.16]},
               y={"label": "drag of the trailing pad"}, series=content)


def draw(study, page):
    """What tables.md (`page`) and bars.md say; bars of 95 %."""
    tables, texts = tables_of(page), bars.sections(HERE / "bars.md")
    found = {title: bars.read_table(text) for title, text in texts.items()}
    draw_count(study, "count", tables, (found["Pads of set A with error bars"], found["The block without gaps, with error bars"]),
               SET_A)
    draw_count(study, "count-b", tables, (found["Pads of set B with error bars"],
                                          found["The block without gaps of set B, with error bars"]), SET_B)
    draw_shape(study, tables, found)
    draw_shape_b(study, tables)
    draw_load(study, tables)
    draw_drag(study, tables)
    study_transfer(study)


# --- how many pads --------------------------------------------------------------------------------

def study_count(study, points, plain, pressures, title):
    rows = []
    for P in pressures:
        here, whole = of_pressure(points, P), of_pressure(plain, P)[0]
        rows += [[stress(P), "none" if p is whole else p.n, p.low_end(), p.average(), p.drops, p.period, p.mu,
                  p.first_pad, p.branches(), p.l_c] for p in [whole] + here]
    study.table(f"Number of pads, equal contact length 0.6 L ({title}); none: the block without gaps",
                ["P", "n", "mu_hold", "mean of drops", "drops", "period", "mu_M", "first whole pad",
                 "drops (pads that slide)", "l_c/L"], rows)


# --- which pad goes, and why ----------------------------------------------------------------------

def runaways(study, scene, pressures, reach):
    """{(P, n): results of `amontons stability`}, where it ends."""
    asked = [(P, n) for P in pressures for n in COUNTS]
    every = [(scene, {"load.pressure": P, "mesh.set.n": n, "time.until.U": reach * P}) for P, n in asked]
    return {at: one for at, one in zip(asked, study.stabilities(every)) if one}


def runaway_table(study, scene, found, points):
    """Which pad the growing mode lies on, and what the trailing pad can resist; by pressure and n."""
    rows = []
    for (P, n), one in found.items():
        run = [p for p in of_pressure(points, P) if p.n == n]
        pad, most = one["pads"][0], max(range(n), key=lambda k: one["pads"][k]["mode"])
        others = sorted((p["mode"] for p in one["pads"]), reverse=True)[1:2]
        l_c = [p["l_c_over_length"] for p in one["pads"]]
        run = run[0] if run else None
        rows.append([stress(P), n, one["mu_l_sc"], one["mu_snap"], one["mu_M"], run and run.low_end(),
                     run and run.first_pad, most + 1, others[0] if others else None,
                     " ".join("–" if v is None else f"{v:.2f}" for v in l_c),
                     pad["pressure"] / P * 0.6, pad["load"], pad["drag"], pad["drag"] * pad["length"]])
    study.table(f"Loss of stability at V on the quasi-static path ({scene}.yaml): the pad that the growing "
                "mode lies on; of the trailing pad its share of load, its weakening over resistance, and its drag",
                ["P", "n", "mu where oscillations grow", "mu where a node slips fast at once", "mu, stability", "mu_hold, stepping",
                 "first whole pad, stepping", "pad that goes",
                 "next in mode", "l_c of each pad alone, over its length", "load share",
                 "weakening / resistance", "drag", "drag x length"], rows)


def study_drag(study, grooves):
    """Drag of a pad in the middle: by its height, its number, and the depth of grooves."""
    heights, rows = (0.0125, 0.025, 0.05, 0.075, 0.1, 0.15), []
    for n in (1, 2, 4, 8):
        found = study.stabilities([("pads", {"load.pressure": 0.006, "mesh.set.n": n, "mesh.set.pad_height": h})
                                   for h in heights])
        for h, one in zip(heights, found):
            if one is None:
                continue
            first, middle = one["pads"][0], one["pads"][n // 2]
            rows.append([f"{n} pads", h, first["drag"], middle["drag"], first["drag"] * first["length"],
                         first["load"], one["mu_M"]])
    for count in (3, 7):
        depths = sorted({p.mesh["depth"] for p in grooves if near(p.mesh["width"], 0.05)})
        found = study.stabilities([("grooved", {"load.pressure": 0.006, "mesh.set.grooves": count,
                                                "mesh.set.depth": d}) for d in depths])
        for d, one in zip(depths, found):
            if one is None:
                continue
            first, middle = one["pads"][0], one["pads"][count // 2]
            rows.append([f"{count} grooves", d, first["drag"], middle["drag"],
                         first["drag"] * first["length"], first["load"], one["mu_M"]])
    study.table("Drag (viscous shear of the softest slip over its rate, eta1/L0) by height, P = 0.006",
                ["contact", "height", "drag, trailing pad", "drag, middle pad", "drag x length",
                 "weakening / resistance", "mu, stability"], rows)


def study_loads(study, points):
    """What each pad carries at the peak, and in what order they let go."""
    rows = []
    for P, n in ((0.003, 5), (0.006, 2), (0.006, 4), (0.006, 8), (0.006, 12)):
        run = [p for p in of_pressure(points, P) if p.n == n][0]
        total = sum(pad["normal_force_start"] for pad in run.pads)
        cells = [[f"{pad['normal_force_peak'] * n / total:.2f}" for pad in run.pads],
                 [f"{pad['shear_peak'] / pad['normal_force_peak']:.2f}" for pad in run.pads],
                 [f"{pad['l_c_over_length']:.2f}" if pad["l_c_over_length"] is not None else "–"
                  for pad in run.pads],
                 [str(pad["detachment_order"] or "–") for pad in run.pads]]
        rows.append([stress(P), n, run.mu] + [" ".join(cell) for cell in cells])
    study.table("Each pad at mu_M: load over its share, shear over load, part that slips before its slip "
                "turns fast, order of letting go", ["P", "n", "mu_M", "load", "shear/load", "slow part",
                                                    "order"], rows)


def study_transfer(study):
    """Shear over load of each pad in time, between two slidings."""
    import h5py
    P, n = 0.006, 4
    out = study.folder / "transfer"
    if not (out / "run.json").exists():
        subprocess.run([study.program, "run", HERE / "pads.yaml", "-o", out, "--quiet", "--overwrite",
                        "--set", f"load.pressure={P}", "--set", f"mesh.set.n={n}", "--set",
                        f"time.until.U={2.5 * P}", "--set", "output.figures=[]"], check=True)
    with h5py.File(out / "history.h5") as file:
        U, mu = file["series/rod_displacement"][:] / P, file["series/mu"][:]
        ratio = file["pads/shear"][:] / file["pads/normal_force"][:]
        peaks = file["peaks/U"][:] / P
    kept = [k for k in range(len(U)) if peaks[1] < U[k] < peaks[2] + 0.03]
    kept = [k for j, k in enumerate(kept) if j == 0 or U[k] - U[kept[j - 1]] > 1e-9]
    kept = kept[::max(1, len(kept) // 600)]
    content = [{"label": f"pad {pad + 1}", "x": [float(U[k]) for k in kept], "color": pad + 1,
                "y": [float(ratio[k, pad]) for k in kept], "marker": "none", "line": "solid"}
               for pad in range(n)]
    content.append({"label": "block", "x": [float(U[k]) for k in kept], "color": 0,
                    "y": [float(mu[k]) for k in kept], "marker": "none", "line": "dashed"})
    study.plot("transfer", title="Shear over load of each pad from sliding to sliding", height=0.7, legend="below",
               x={"label": "~{U} / (~{P} ~{L} / ~{E})"}, y={"label": "shear / load", "range": [0, 0.65]},
               series=content)


# --- height, gap, share, grooves ------------------------------------------------------------------

def shape_table(study, points, key, title):
    rows = [[stress(p.P), p.n, p.mesh[key], p.low_end(), p.average(), p.drops, p.period, p.mu, p.first_pad,
             p.branches(), p.l_c] for p in sorted(points, key=lambda p: (p.P, p.n, p.mesh[key]))]
    study.table(f"Varied: {key} ({title})", ["P", "n", key, "mu_hold", "mean of drops", "drops", "period",
                                             "mu_M", "first whole pad", "drops (pads that slide)", "l_c/L"], rows)


def study_shapes(study, points, plain):
    for name, key in (("height", "pad_height"), ("gap", "gap"), ("fill", "fill")):
        shape_table(study, points[name], key, "set A")
    for name, key in (("height-b", "pad_height"), ("gap-b", "gap")):
        shape_table(study, points[name], key, "set B")
    rows = []
    for p in sorted(points["grooves"], key=lambda p: (p.P, p.mesh["grooves"], p.mesh["width"],
                                                      p.mesh["depth"])):
        whole = of_pressure(plain, p.P)[0]
        rows.append([stress(p.P), int(p.mesh["grooves"]), p.mesh["width"], p.mesh["depth"], p.hold,
                     f"{100 * (p.hold / whole.hold - 1):+.1f} %", p.mu, p.first_pad, p.period,
                     p.branches(), p.l_c])
    study.table("Shallow grooves; change against the block without", [
        "P", "grooves", "width", "depth", "mu_hold", "change", "mu_M", "first whole pad", "period",
        "drops (pads that slide)", "l_c/L"], rows)


# --- how sure -------------------------------------------------------------------------------------

CASES = ("as computed", "mesh twice as coarse", "mesh twice as fine", "fine steps", "T6", "V/2", "V/10", "bonded rod", "rod at H/4",
         "start without friction")


def case_of(point):
    scene, is_a = point.scene, point.P > 5e-4
    size = point.mesh["size_contact"]
    base = 0.0125 if is_a else 0.00025
    if not near(size, base):
        return "mesh twice as fine" if size < base else "mesh twice as coarse"
    if scene["time"]["accuracy"] == "fine":
        return "fine steps"
    if point.mesh.get("shape") == "triangle":
        return "T6"
    if scene["rod"]["kind"] == "bonded":
        return "bonded rod"
    if scene["start"]["friction"] == "off":
        return "start without friction"
    if near(scene["rod"]["height"], 0.125):
        return "rod at H/4"
    part = (1e-5 if is_a else 1.2e-8) / scene["rod"]["velocity"]
    return "as computed" if near(part, 1) else f"V/{part:.0f}"


def change(value, error, base):
    if value is None or base is None:
        return "–"
    return f"{value:.4f}{error} ({100 * (value / base - 1):+.1f} %)"


def study_check(study, points, name):
    """Tables of what one change does; points: those as computed among them."""
    def bound(p, error):
        return "" if p.period or error is None else f" ± {error:.4f}"

    looks = (("mu_hold", lambda p: (p.hold, bound(p, p.hold_error))),
             ("mean of drops", lambda p: (p.mean, bound(p, p.mean_error))),
             ("mu_M", lambda p: (p.mu, "")))
    cases = [c for c in CASES if any(case_of(p) == c for p in points)]
    changed = {(p.P, p.n) for p in points if case_of(p) != "as computed"}
    for what, look in looks:
        rows = []
        for P, n in sorted(changed):
            found = {case_of(p): p for p in of_pressure(points, P) if p.n == n}
            if "as computed" not in found:
                continue
            base, error = look(found["as computed"])
            rows.append([stress(P), n, f"{base:.4f}{error}" if base else None] + [
                change(*look(found[c]), base) if c in found else None for c in cases[1:]])
        study.table(f"{name}: {what} with one thing changed", ["P", "n"] + cases, rows)


def publish(folder):
    if (folder / "tables.md").exists():
        shutil.copy(folder / "tables.md", HERE / "tables.md")
    for name in FIGURES:
        if (folder / "figures" / f"{name}.png").exists():
            keep_picture(folder / "figures" / f"{name}.png", HERE / f"{name}.png")


def main():
    reader = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    reader.add_argument("-o", "--output", type=Path, default=ROOT / "results/pads")
    reader.add_argument("-j", "--jobs", type=int, default=2)
    reader.add_argument("--program", type=Path, default=ROOT / "amontons")
    reader.add_argument("--publish", action="store_true")
    reader.add_argument("--draw", action="store_true")
    words = reader.parse_args()
    words.output.mkdir(parents=True, exist_ok=True)
    study = Study(words.program.resolve(), words.output, words.jobs)
    if words.draw:
        draw(study, HERE / "tables.md")
    else:
        compute(study)
    if words.publish:
        publish(words.output)


def compute(study):
    points = study.sweeps(SWEEPS)
    study_count(study, points["count"], points["plain"], SET_A, "set A")
    study_count(study, points["count-b"], points["plain-b"], SET_B, "set B")
    a, b = runaways(study, "pads", SET_A, 10), runaways(study, "pads-b", SET_B, 1)
    runaway_table(study, "pads", a, points["count"])
    runaway_table(study, "pads-b", b, points["count-b"])
    study_drag(study, points["grooves"])
    study_loads(study, points["count"])
    study_shapes(study, points, points["plain"])
    study_check(study, points["check"], "Set A")
    study_check(study, points["count-b"] + points["check-b"] + points["fine-b"], "Set B")
    (study.folder / "tables.md").write_text("\n".join(study.lines), encoding="utf-8")
    subprocess.run([HERE.parent / "bars.py", HERE, "-j", str(study.jobs)], check=True)
    draw(study, study.folder / "tables.md")


if __name__ == "__main__":
    main()
