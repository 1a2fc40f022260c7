#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Four questions of a designer, answered with error bars: sweeps, tables, figures and the page, from one command.

    validation/questions/questions.py [-o DIR] [-j N] [--program PROGRAM]

Sweeps the studies of this folder (a call that is stopped goes on where it was) and writes README.md from page.in, with what was
measured in the place of [[names]], and the figures beside it. Needs h5py and numpy (python3-h5py)."""
import argparse
import csv
import json
import math
import re
import resource
import subprocess
import sys
import textwrap
from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "validation/drive"))
sys.dont_write_bytecode = True
import rigid_block   # noqa: E402

MU = "~{\u03bc}_{hold}"
MU_STATIC = 0.38   # set A
BLOCK_STIFFNESS = 0.4   # of the studies' formulas; what it is, is measured too


# --- numbers with error bars ----------------------------------------------------------------------

class Number:
    """A value and its bar of 95 %; None: it is not known."""

    def __init__(self, value, error):
        self.value, self.error = value, error

    def __str__(self):
        if math.isnan(self.value):
            return "no drop of the force"
        return f"{self.value:.3f} ± {self.error:.3f}" if self.error is not None else f"{self.value:.3f} (bar not known)"

    def over(self, other):
        """The change against `other`, as part of it; both errors taken as independent."""
        ratio = self.value / other.value
        if self.error is None or other.error is None:
            return Change(ratio - 1, None)
        return Change(ratio - 1, ratio * math.hypot(self.error / self.value, other.error / other.value))


class Change(Number):
    def __str__(self):
        if math.isnan(self.value):
            return "no drop of the force"
        if self.error is None:
            return f"{100 * self.value:+.0f} % (bar not known)"
        open_end = "" if abs(self.value) > self.error else ", not decided"
        return f"{100 * self.value:+.1f} ± {100 * self.error:.1f} %{open_end}"


class Point:
    """One run of a sweep: its row of the table and its run.json."""

    def __init__(self, folder, row):
        self.folder, self.row = folder / row["run"], row
        self.run = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))
        asked = "mesh's part of it is not known" not in row["warnings"]
        error = float(row["mu_hold_error"]) if row["mu_hold_error"] and asked else None
        self.hold = Number(float(row["mu_hold"] or "nan"), error)

    def __getitem__(self, key):
        """What the scene has under `key`, a number where it is one."""
        value = self.run["scene"]
        for part in key.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        return value

    def history(self):
        return h5py.File(self.folder / "history.h5")


def pick(points, **wanted):
    """The one point with these values; load__pressure=0.003."""
    found = [p for p in points if all(same(p[key.replace("__", ".")], value) for key, value in wanted.items())]
    assert len(found) == 1, (wanted, len(found))
    return found[0]


def same(found, wanted):
    if isinstance(wanted, float) and isinstance(found, (int, float)):
        return math.isclose(found, wanted, rel_tol=1e-6)
    return found == wanted


# --- running and drawing --------------------------------------------------------------------------

class Study:
    def __init__(self, words):
        self.program, self.folder, self.jobs = words.program.resolve(), words.output, words.jobs
        self.measured = {}
        self.clock = words.output / "seconds.txt"   # of processor time, of all calls

    @property
    def seconds(self):
        return float(self.clock.read_text(encoding="utf-8")) if self.clock.exists() else 0.0

    def call(self, *words):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([self.program, *words], check=False, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime"))
        self.clock.write_text(f"{self.seconds + spent:.1f}", encoding="utf-8")
        return done.returncode

    def sweep(self, name):
        out = self.folder / name
        self.call("sweep", HERE / f"{name}.yaml", "-o", out, "-j", str(self.jobs), "--quiet")
        with open(out / "sweep.csv", encoding="utf-8") as file:
            return [Point(out, row) for row in csv.DictReader(file)]

    def once(self, command, scene, name, result, **keys):
        """results of `amontons static` or `stability`; computed if it is not there."""
        out = self.folder / name
        if not (out / result).exists():
            words = [word for key, value in keys.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]
            self.call(command, HERE / scene, "-o", out, "--overwrite", "--quiet", *words)
        return json.loads((out / result).read_text(encoding="utf-8"))

    def plot(self, name, **content):
        path = self.folder / "figures" / f"{name}.yaml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")
        assert self.call("render", path, "--dpi", "254", "--overwrite") == 0
        (HERE / f"{name}.png").write_bytes(path.with_suffix(".png").read_bytes())


def curve(label, x, numbers, color, **more):
    """Numbers with their bars; one without a bar is drawn open, without one."""
    bars = [n.error if n.error is not None else 0 for n in numbers]
    return {"label": label, "x": x, "y": [n.value for n in numbers], "low": [n.value - e for n, e in zip(numbers, bars)],
            "high": [n.value + e for n, e in zip(numbers, bars)], "color": color, "marker": "circle", "line": "thin", **more}


def rows(label, numbers, color, shift, **more):
    """A mark a row, first row on top, bars along x."""
    y = [len(numbers) - k + shift for k in range(len(numbers))]
    across = curve(label, y, numbers, color, **{"line": "none", **more})
    return {**across, "x": across["y"], "y": y}


def level(value, x, label="", color=0):
    return {"label": label, "x": x, "y": [value, value], "color": color, "marker": "none", "line": "dashed"}


def table(head, lines):
    text = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(text + ["| " + " | ".join(str(cell) for cell in line) + " |" for line in lines])


def at_sliding(point):
    """x, pressure, shear and weight of the contact nodes when mu was largest before the last sliding."""
    with point.history() as file:
        step = int(np.argmin(np.abs(file["series/rod_displacement"][:] - file["peaks/U"][-1])))
        return (file["nodes/x"][:], file["interface/pressure"][step].astype(float),
                file["interface/shear"][step].astype(float), file["nodes/weight"][:])


# --- what happens before the block slides ---------------------------------------------------------

class Cycle:
    """From one sliding to the next: bursts of slip before it, and the largest drop of the force before it."""

    def __init__(self, mu, rate, threshold):
        rest = int(np.argmin(mu))   # from here on: the sliding before has ended
        rest += int(np.argmax(rate[rest:] < threshold / 2))
        self.mu, rate = mu[-1], rate[rest:]
        fast = rate > threshold
        begins = np.flatnonzero(fast[1:] & ~fast[:-1])
        self.bursts = 0
        for here, after in zip(begins, [*begins[1:], len(rate)]):
            self.bursts += bool(np.any(rate[here + 1:after] < threshold / 2))   # it stopped; the last one does not
        self.drop = float(np.max(np.maximum.accumulate(mu[rest:]) - mu[rest:])) / self.mu


def cycles(point):
    """The cycles of a run, the start left out. Fast: twice the velocity at which the face of a block that sticks would move."""
    threshold = 2 * point["rod.velocity"] / (1 + BLOCK_STIFFNESS / point["rod.stiffness"])
    with point.history() as file:
        mu, rate = file["series/mu"][:], file["series/max_slip_rate"][:]
        U = file["series/rod_displacement"][:]
        ends = [int(np.argmin(np.abs(U - peak))) for peak in file["peaks/U"][:]]
    return [Cycle(mu[a + 1:b + 1], rate[a + 1:b + 1], threshold) for a, b in zip(ends[1:-1], ends[2:])]


# --- 1: soft pads ---------------------------------------------------------------------------------

def question_pads(study):
    points = study.sweep("soft-pads")
    stiffness, viscosity = (1.0, 0.3, 0.1), (1.0, 0.6, 0.3)

    def at(E, eta):
        return pick(points, materials__pads__young=E, materials__pads__eta1=eta).hold

    hard = at(1.0, 1.0)
    study.measured.update({"pads hard": hard, "pads soft": at(0.1, 1.0).over(hard), "pads soft thin": at(0.1, 0.3).over(hard),
                           "pads hard thin": at(1.0, 0.3).over(hard),
                           "pads thin soft": at(0.1, 0.3).over(at(1.0, 0.3))})
    study.measured["pads table"] = table(
        ["E of the pads"] + [f"η of the pads {eta:g}" for eta in viscosity],
        [[f"{E:g}", *(f"{at(E, eta)}" + (f" ({at(E, eta).over(hard)})" if (E, eta) != (1.0, 1.0) else "") for eta in viscosity)]
         for E in stiffness])
    study.plot("soft-pads", title="Four pads: their stiffness and viscosity", height=0.65,
               x={"label": "~{E} of the pads / ~{E} of the block", "scale": "log", "range": [0.08, 1.25]}, y={"label": MU},
               series=[curve(f"η of the pads {eta:g}", [E * (1 + 0.04 * (k - 1)) for E in stiffness], [at(E, eta) for E in stiffness],
                             k + 1, marker=("circle", "square", "triangle")[k]) for k, eta in enumerate(viscosity)])
    pads_mechanism(study, points)
    pads_depends(study, at)


def ramp(point):
    """Shear over load of each pad when the force is largest, trailing pad first."""
    return [pad["shear_peak"] / pad["normal_force_peak"] for pad in point.run["results"]["pads"]]


def pads_mechanism(study, points):
    """What the trailing pad resists, by growth rates, and what the pads carry when it lets go."""
    lines = []
    for E, eta in ((1.0, 1.0), (0.1, 1.0), (1.0, 0.3), (0.1, 0.3)):
        found = study.once("stability", "../pads/pads.yaml", f"stability-{E:g}-{eta:g}", "stability.json", materials__pads__young=E,
                           materials__pads__eta1=eta, materials__pads__eta2=eta, time__until__U=0.072 * max(1, 0.2 / E))
        pad, shares = found["pads"][0], ramp(pick(points, materials__pads__young=E, materials__pads__eta1=eta))
        lines.append([f"{E:g}", f"{eta:g}", f"{pad['stiffness']:.2f}", f"{pad['drag']:.2f}", f"{pad['l_c_over_length']:.2f}",
                      f"{found['results']['mu_M']:.3f}", ", ".join(f"{share:.2f}" for share in shares)])
        study.measured.update({f"pad {E:g} {eta:g} stiffness": lines[-1][2], f"pad {E:g} {eta:g} drag": lines[-1][3],
                               f"pad {E:g} {eta:g} l_c": lines[-1][4], f"pad {E:g} {eta:g} first": f"{shares[0]:.2f}",
                               f"pad {E:g} {eta:g} last": f"{shares[-1]:.2f}"})
    low = [p for p in study.sweep("soft-pads-depends") if same(p["rod.height"], 0.125)]
    for E in (1.0, 0.1):
        study.measured[f"pad low {E:g} last"] = f"{ramp(pick(low, materials__pads__young=E, materials__pads__eta1=1.0))[-1]:.2f}"
    study.measured["pads stability"] = table(
        ["E of the pads", "η", "stiffness", "drag", "part of the pad that slips before it runs away", "mu then, growth rates",
         "run: shear over load, trailing to leading pad"], lines)


def pads_depends(study, at):
    """The change from hard to soft pads, one thing changed at a time."""
    def design(point):
        return point["materials.pads.young"], point["materials.pads.eta1"]

    designs = ((1.0, 1.0), (0.1, 1.0), (0.1, 0.3))
    hard = at(*designs[0])
    lines = [["as computed", hard, *(at(*other).over(hard) for other in designs[1:])]]
    lines += depends(study.sweep("soft-pads-depends"), design, designs)
    set_b = {design(p): p.hold for p in study.sweep("soft-pads-b")}
    lines.append(["set B", set_b[designs[0]], *(set_b[other].over(set_b[designs[0]]) for other in designs[1:])])
    study.measured["pads depends"] = table(["", "hard pads", "0.1 E", "0.1 E and 0.3 η"], lines)
    study.measured.update({f"pads {line[0]} {name}": c for line in lines for name, c in (("soft", line[2]), ("thin", line[3]))})
    study.plot("soft-pads-depends", title="Pads of a tenth of E: what the change depends on", height=0.8,
               x={"label": f"change of {MU}, %"}, y={"label": "what is changed", "names": [line[0] for line in reversed(lines)]},
               series=[rows("η kept", percent([line[2] for line in lines]), 1, 0.12),
                       rows("0.3 η too", percent([line[3] for line in lines]), 2, -0.12, marker="square"),
                       {"label": "", "x": [0, 0], "y": [0.5, len(lines) + 0.5], "color": 0, "marker": "none", "line": "dashed"}])


# What a study named ...-depends may change, one at a time.
KINDS = (("one pad", {"mesh.set.n": 1}), ("start without friction", {"start.friction": "off"}), ("bonded rod", {"rod.kind": "bonded"}),
         ("rod at H/4", {"rod.height": 0.125}), ("V three times as slow", {"rod.velocity": 3e-6}),
         ("machine of 0.3 E", {"rod.stiffness": 0.3}), ("P = 0.003", {"load.pressure": 0.003}), ("P = 0.006", {"load.pressure": 0.006}))


def depends(points, design, designs):
    """A line a kind: its first design, and the changes of the others against it. A kind that all share is no change."""
    lines = []
    for kind, keys in KINDS:
        held = [(design(p), p.hold) for p in points if all(same(p[key], value) for key, value in keys.items())]
        if len(held) == len(designs):
            base, *others = [dict(held)[one] for one in designs]
            lines.append([kind, base, *(hold.over(base) for hold in others)])
    return lines


def percent(changes):
    return [Number(100 * c.value, 100 * c.error if c.error is not None else None) for c in changes]


def edges_of_set_b(study, name, points, kind_of, plain, heads):
    """What either edge changes in set B, against `plain`, at two pressures; kind_of: point -> which edge, and more."""
    lines = []
    for P in (2.5e-5, 5.75e-5):
        here = {kind_of(p)[0]: p.hold for p in points if same(p["load.pressure"], P)}
        lines.append([f"{P:g}", here[plain], here["trailing"].over(here[plain]), here["leading"].over(here[plain])])
        study.measured.update({f"{name} B {P:g} trailing": lines[-1][2], f"{name} B {P:g} leading": lines[-1][3]})
    study.measured[f"{name} b table"] = table(["P, set B", *heads], lines)


# --- 2: a lubricated edge -------------------------------------------------------------------------

def film(point):
    """(where, length, factor) of the film, from the formula itself."""
    text = (point["friction.along"] or "1").strip('"')
    x = (np.arange(2000) + 0.5) / 2000 * (point["mesh.set.length"] or 1)
    factor = eval(text, {"points": lambda x, *p: np.interp(x, p[::2], p[1::2]), "x": x}) + 0 * x   # pylint: disable=eval-used
    least = factor.min()
    if least == 1:
        return "none", 0.0, factor
    where = "trailing" if factor[0] < 1 else "leading" if factor[-1] < 1 else "middle"
    return where, round(float(np.mean(1 - factor) / (1 - least)), 3), factor


def question_film(study):
    points = study.sweep("lubricated")
    series, lines = [], []
    for k, P in enumerate((0.001, 0.003, 0.006)):
        here = {film(p)[:2]: p.hold for p in points if same(p["load.pressure"], P)}
        plain = here["none", 0.0]
        study.measured[f"film {P:g} none"] = plain
        for where, marker, filled in (("trailing", "circle", True), ("leading", "square", False)):
            of = sorted((length, hold.over(plain)) for (place, length), hold in here.items() if place == where and hold.value > 0)
            series.append(curve(f"~{{P}} = {P:g}, {where}", [0.0] + [length + 0.004 * (k - 1) for length, _ in of],
                                [Number(1, 0)] + [Number(1 + c.value, c.error) for _, c in of], k + 1, marker=marker, filled=filled))
        for key, hold in sorted(here.items()):
            study.measured[f"film {P:g} {key[0]} {key[1]:g}"] = hold.over(plain)
        lines.append([f"{P:g}", plain] + [here[key].over(plain) for key in
                                          (("trailing", 0.1), ("trailing", 0.2), ("trailing", 0.4), ("middle", 0.2),
                                           ("leading", 0.1), ("leading", 0.2), ("leading", 0.4))])
        if same(P, 0.003):
            changed = depends(study.sweep("lubricated-depends"), lambda p: film(p)[0], ("none", "trailing"))
            study.measured["film depends"] = table(["", "no film", "film"], [["as computed", plain, here["trailing", 0.2].over(plain)], *changed])
    steady = [p for p in points if same(p["load.pressure"], 0.001) and film(p)[:2] == ("leading", 0.4)]
    study.measured["film steady"] = f"{steady[0].run['results']['mu_max']:.3f}"
    study.measured["film table"] = table(["P", "no film", "trailing 0.1", "0.2", "0.4", "middle 0.2", "leading 0.1", "0.2", "0.4"], lines)
    study.plot("lubricated", title="A film that leaves 0.3 of the friction",
               x={"label": "length of the film / ~{L}", "range": [0, 0.44]}, y={"label": f"{MU} over that without a film"},
               series=series + [{"label": "as the area goes", "x": [0, 0.42], "y": [1, 1 - 0.7 * 0.42], "color": 0, "marker": "none",
                                 "line": "dashed"}])
    film_mechanism(study)
    edges_of_set_b(study, "film", study.sweep("lubricated-b"), film, "none", ["no film", "trailing 0.2", "leading 0.2"])


def film_mechanism(study):
    """What the contact could carry at most with the pressure that it has, and how much of it it carries."""
    lines, series = [], []
    for point in sorted(study.sweep("profiles"), key=lambda p: (p["load.pressure"], film(p)[0] == "leading", film(p)[0] == "trailing")):
        where, _, factor = film(point)
        x, pressure, shear, weight = at_sliding(point)
        P = point["load.pressure"]
        along = np.interp(x, (np.arange(2000) + 0.5) / 2000, factor)
        load = float(np.sum(pressure * weight))
        most = MU_STATIC * float(np.sum(along * pressure * weight)) / load
        share = float(np.sum(pressure * weight * (along < 0.65))) / load
        carried = float(np.sum(shear * weight)) / load
        lines.append([f"{P:g}", where, f"{share:.2f}" if where != "none" else "–", f"{most:.3f}", f"{carried:.3f}", f"{100 * carried / most:.0f} %"])
        study.measured[f"share {P:g} {where}"] = lines[-1][2]
        study.measured[f"part {P:g} {where}"] = lines[-1][5]
        study.measured[f"most {P:g} {where}"] = lines[-1][3]
        if same(P, 0.003):
            color = {"none": 0, "trailing": 1, "leading": 2}[where]
            name = {"none": "no film", "trailing": "film at the trailing edge", "leading": "film at the leading edge"}[where]
            series.append({"label": name, "x": x.tolist(), "y": (shear / P).tolist(), "color": color, "marker": "none", "line": "solid"})
            series.append({"label": "", "x": x.tolist(), "y": (MU_STATIC * along * pressure / P).tolist(), "color": color,
                           "marker": "none", "line": "dashed"})
    study.measured["film bound"] = table(["P", "film", "its share of the load", "mu if every point were at its threshold", "mu carried",
                                          "part of it"], lines)
    study.plot("lubricated-stress", title="Shear when the block lets go, and the threshold (dashed)", height=0.7,
               x={"label": "~{x} / ~{L}"}, y={"label": "shear / ~{P}", "range": [0, 0.9]}, series=series)


# --- 3: rounded pads ------------------------------------------------------------------------------

def edges(point):
    """(which edges of the first pad are rounded, how high they are), from the formula itself."""
    text = (point["contact.gap"] or "0").strip('"').replace("^", "**")
    n = int(point["mesh.set.n"])
    length = point["mesh.set.length"] or 1
    pitch, pad = length / n, point["mesh.set.fill"] * length / n
    gap = [eval(text, {"x": x, "min": min, "max": max, "abs": abs})   # pylint: disable=eval-used
           for x in ((pitch - pad) / 2, (pitch + pad) / 2)]
    which = {(False, False): "sharp", (True, True): "both", (True, False): "trailing", (False, True): "leading"}[gap[0] > 0, gap[1] > 0]
    return which, float(f"{max(gap):.3g}")


def question_round(study):
    points = study.sweep("rounded")
    kinds = (("sharp", 0.0), ("both", 1e-3), ("trailing", 1e-3), ("leading", 1e-3), ("both", 5e-3), ("trailing", 5e-3), ("leading", 5e-3))
    for n in (1, 4):
        changes, lines = {}, []
        mine = [kind for kind in kinds if n == 1 or kind in (*kinds[:4], kinds[4])]
        for P in (0.003, 0.006):
            here = {edges(p): p.hold for p in points if p["mesh.set.n"] == n and same(p["load.pressure"], P)}
            sharp = here["sharp", 0.0]
            changes[P] = [here[kind].over(sharp) for kind in mine[1:]]
            study.measured[f"round {n} {P:g} sharp"] = sharp
            for kind, change in zip(mine[1:], changes[P]):
                study.measured[f"round {n} {P:g} {kind[0]} {kind[1]:g}"] = change
            lines.append([f"{P:g}", sharp, *changes[P]])
        names = [f"{which}, {high:g}" for which, high in mine[1:]]
        study.measured[f"round {n} table"] = table(["P", "sharp", *names], lines)
        study.plot(f"rounded-{n}", title=f"{'One pad' if n == 1 else 'Four pads'}: rounded edges against sharp ones", height=0.7,
                   x={"label": f"change of {MU}, %"}, y={"label": "rounded, and how high", "names": list(reversed(names))},
                   series=[rows("~{P} = 0.003", percent(changes[0.003]), 1, 0.12),
                           rows("~{P} = 0.006", percent(changes[0.006]), 2, -0.12, marker="square"),
                           {"label": "", "x": [0, 0], "y": [0.5, len(names) + 0.5], "color": 0, "marker": "none", "line": "dashed"}])
    first = [study.measured[f"round 1 0.006 {which}"] for which in ("sharp", "trailing 0.005", "leading 0.005")]
    designs = ("sharp", "trailing", "leading")
    study.measured["round depends"] = table(["", *designs], [["as computed", *first], *depends(
        study.sweep("rounded-depends"), lambda p: edges(p)[0], designs)])
    study.measured.update(zip(("round sharp", "round mesh", "round gap"), (p.row["mu_hold"][:6] for p in study.sweep("rounded-mesh"))))
    round_mechanism(study)
    edges_of_set_b(study, "round", study.sweep("rounded-b"), edges, "sharp", ["sharp", "trailing", "leading"])


def round_mechanism(study):
    lines, series = [], []
    for point in sorted(study.sweep("profiles-pads"), key=lambda p: (p["load.pressure"], ("sharp", "trailing", "leading").index(edges(p)[0]))):
        which, _ = edges(point)
        x, pressure, shear, weight = at_sliding(point)
        P = point["load.pressure"]
        mean = float(np.sum(pressure * weight) / np.sum(weight))
        touching = float(np.sum(weight[pressure > 0]))
        front = point.run["results"]["l_c_over_L"]
        lines.append([f"{P:g}", which, f"{touching:.2f}", f"{pressure.max() / mean:.1f}", f"{x[np.argmax(pressure)]:.2f}", f"{front:.2f}", point.row["mu_hold"][:6]])
        study.measured[f"peak {P:g} {which}"] = lines[-1][3]
        study.measured[f"front {P:g} {which}"] = lines[-1][5]
        if same(P, 0.006):
            color = {"sharp": 0, "trailing": 1, "leading": 2}[which]
            name = {"sharp": "sharp", "trailing": "trailing edge rounded", "leading": "leading edge rounded"}[which]
            series.append({"label": name, "x": x.tolist(), "y": (shear / P).tolist(), "color": color, "marker": "none", "line": "solid"})
            series.append({"label": "", "x": x.tolist(), "y": (MU_STATIC * pressure / P).tolist(), "color": color,
                           "marker": "none", "line": "dashed"})
    study.measured["round profiles"] = table(["P", "edge", "length that touches", "largest pressure over mean", "where, x", "l_c / L", "mu_hold on this mesh"], lines)
    study.plot("rounded-stress", title="Shear when the block lets go, and the threshold (dashed)", height=0.7,
               x={"label": "~{x} / ~{L}"}, y={"label": "shear / ~{P}", "range": [0, 2.4]}, series=series)


# --- 4: the machine -------------------------------------------------------------------------------

def question_machine(study):
    block = block_stiffness(study)
    points = sorted(study.sweep("machine"), key=lambda p: p["rod.stiffness"])
    rigid = study.measured["film 0.003 none"]   # the same block and pressure, question 2
    k = [p["rod.stiffness"] for p in points]
    study.plot("machine", title="A soft machine against a stiff one", height=0.65,
               x={"label": "stiffness of the machine / ~{E}", "scale": "log", "range": [0.02, 45]}, y={"label": MU},
               series=[curve("", k, [p.hold for p in points], 1), level(rigid.value, [0.02, 45], "rod without a spring")])
    study.measured.update({"machine soft": points[0].hold.over(rigid), "machine stiff": points[-1].hold.over(rigid),
                           "machine table": table(["k / E", "k over the block's", "mu_hold", "against a rod without a spring"],
                                                  [[f"{s:.2g}", f"{s / block:.2g}", p.hold, p.hold.over(rigid)] for s, p in zip(k, points)])})
    here = [pick(points, rod__stiffness=30.0).hold, pick(points, rod__stiffness=k[1]).hold]
    changed = depends(study.sweep("machine-depends"), lambda p: p["rod.stiffness"], (30.0, 0.1))
    study.measured["machine depends"] = table(["", "k = 30 E", "k = 0.1 E"], [["as computed", here[0], here[1].over(here[0])], *changed])
    machine_mechanism(study)
    count_precursors(study)
    towards_rigid(study)
    lines = []
    for point in sorted(study.sweep("machine-b"), key=lambda p: p["rod.stiffness"]):
        of = cycles(point)
        lines.append([f"{point['rod.stiffness']:g}", point.row["mu_hold"][:6], span([c.bursts for c in of], "{:.0f}"),
                      span([100 * c.drop for c in of], "{:.2f}")])
    study.measured["machine b table"] = table(["k / E, set B", "mu_hold", "bursts before each sliding", "largest drop of the force before it, %"], lines)


def machine_mechanism(study):
    """Where slip runs away, by growth rates."""
    lines = []
    for k in (0.03, 0.3, 3, 30):
        found = study.once("stability", "../paper/fig1.yaml", f"stability-machine-{k:g}", "stability.json", mesh__set__nx=40, mesh__set__nz=40,
                           output__fields="none", rod__stiffness=k, time__until__U=0.03 * (1 + BLOCK_STIFFNESS / k))["results"]
        lines.append([f"{k:g}", f"{found['l_sc_over_L']:.2f}", f"{found['l_c_at_V_over_L']:.2f}", f"{found['mu_M']:.3f}"])
        study.measured[f"machine l_c {k:g}"] = lines[-1][2]
        study.measured[f"machine l_sc {k:g}"] = lines[-1][1]
    study.measured["machine growth"] = table(["k / E", "oscillations grow from l / L", "slip runs away from l / L", "mu then"], lines)


def block_stiffness(study):
    """Force over displacement of the rod while the whole contact sticks."""
    force = [study.once("static", "../paper/fig1.yaml", f"static-{way:g}", "static.json", mesh__set__nx=40, mesh__set__nz=40,
                        rod__displacement=way)["results"]["rod_force"] for way in (5e-4, 1e-3)]
    study.measured["block stiffness"] = f"{(force[1] - force[0]) / 5e-4:.2f}"
    return (force[1] - force[0]) / 5e-4


def span(values, form):
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def spread(label, x, lists, color, **more):
    """Means of lists of numbers, bars from the least to the largest of each."""
    return {"label": label, "x": x, "y": [float(np.mean(of)) for of in lists], "low": [min(of) for of in lists],
            "high": [max(of) for of in lists], "color": color, "line": "thin", "marker": "circle", **more}


def count_precursors(study):
    points = study.sweep("machine-count")
    stiffness = sorted({p["rod.stiffness"] for p in points})
    rules = (("loaded as fast as by V = 1e-5", lambda k: 1e-5 * (1 + BLOCK_STIFFNESS / k)),
             ("as fast as by V = 3e-6", lambda k: 3e-6 * (1 + BLOCK_STIFFNESS / k)), ("driven with V = 1e-5", lambda k: 1e-5))
    drops, bursts, lines = [], [], [[f"{k:.2g}"] for k in stiffness]
    for color, (name, velocity) in enumerate(rules, 1):
        of = [[c for p in points if same(p["rod.stiffness"], k) and math.isclose(p["rod.velocity"], velocity(k), rel_tol=1e-4)
               for c in cycles(p)] for k in stiffness]
        x = [k * (1 + 0.08 * (color - 2)) for k in stiffness]
        marker = ("circle", "square", "triangle")[color - 1]
        drops.append(spread(name, x, [[100 * c.drop for c in row] for row in of], color, marker=marker))
        bursts.append(spread(name, x, [[c.bursts for c in row] for row in of], color, marker=marker))
        for line, row in zip(lines, of):
            line += [span([100 * c.drop for c in row], "{:.2f}"), span([c.bursts for c in row], "{:.0f}")]
    study.measured["precursor table"] = table(["k / E"] + [f"{what}, {name}" for name, _ in rules for what in ("largest drop, %", "bursts")], lines)
    axis = {"label": "stiffness of the machine / ~{E}", "scale": "log", "range": [0.02, 45]}
    ways = np.geomspace(0.02, 45, 21).tolist()
    stiff = float(np.mean([of["y"][-1] for of in drops]))
    expected = {"label": "the stiffest's ~{k} / (~{k} + ~{k}_{block})", "x": ways, "color": 0, "marker": "none", "line": "dashed",
                         "y": [stiff * k / (k + BLOCK_STIFFNESS) for k in ways]}
    study.plot("machine-drops", title="Largest drop of the force before the block slides", height=0.65, x=axis,
               y={"label": "drop / force, %"}, series=[*drops, expected])
    study.plot("machine-bursts", title="Bursts of slip before the block slides", height=0.65, x=axis, y={"label": "bursts a sliding"}, series=bursts)


def towards_rigid(study):
    """A stiffer and stiffer block against a rigid one on the same spring (validation/drive/rigid_block.py)."""
    lines = []
    for point in sorted(study.sweep("machine-rigid"), key=lambda p: p["material.young"]):
        P, k, V = point["load.pressure"], point["rod.stiffness"], point["rod.velocity"]
        mass = 0.5   # of a block of 1 by 0.5
        last = rigid_block.cycles(mass, P, k, V, (0.38, 0.1, 3.4e-4), 2, step=0.002)[-1]
        study.measured["rigid mu"] = f"{last['F_max'] / P:.4f}"
        lines.append([f"{point['material.young']:g}", f"{k / point['material.young']:.2g}", point.row["mu_hold"][:6],
                      f"{float(point.row['l_c']):.2f}", span([c.bursts for c in cycles(point)], "{:.0f}"), f"{last['F_max'] / P:.4f}"])
        study.measured[f"rigid {point['material.young']:g}"] = point.row["mu_hold"][:6]
    study.measured["rigid table"] = table(["E of the block", "k / E", "mu_hold", "l_c / L", "bursts", "rigid block on the same spring"], lines)


# --- the page -------------------------------------------------------------------------------------

def write_page(study):
    text = (HERE / "page.in").read_text(encoding="utf-8")
    missing = sorted({name for name in re.findall(r"\[\[([^]]+)\]\]", text) if name not in study.measured})
    if missing:
        raise SystemExit("page.in names what was not measured: " + ", ".join(missing))
    page = re.sub(r"\[\[([^]]+)\]\]", lambda found: str(study.measured[found.group(1)]), text)
    (HERE / "README.md").write_text("\n\n".join(wrapped(part) for part in page.strip().split("\n\n")) + "\n", encoding="utf-8")


def wrapped(paragraph):
    """Lines of words as long as in the other pages; tables, pictures, headings and commands stay as they are."""
    kept = paragraph[0] in "|!#" or paragraph.startswith("    ")
    return paragraph if kept else textwrap.fill(paragraph, 125, break_long_words=False, break_on_hyphens=False)


def main():
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("-o", "--output", type=Path, default=ROOT / "results/questions")
    reader.add_argument("-j", "--jobs", type=int, default=2)
    reader.add_argument("--program", type=Path, default=ROOT / "amontons")
    words = reader.parse_args()
    words.output.mkdir(parents=True, exist_ok=True)
    study = Study(words)
    for ask in (question_pads, question_film, question_round, question_machine):
        ask(study)
    study.measured["minutes"] = f"{study.seconds / 60:.0f}"
    write_page(study)
    print(f"validation/questions/README.md; {study.seconds:.0f} s of processor time in all", file=sys.stderr)


if __name__ == "__main__":
    main()
