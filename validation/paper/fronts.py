# SPDX-License-Identifier: GPL-2.0-or-later
"""The precursor catalogue: kinds, reach, slip rates, and how fast the front of each rapid one runs along the contact.

run.json has the times at which the front came to 21 stations (`front_times`). It sets out in both directions from where
slip first speeds up, within what slipped slowly before; here its way towards the leading edge is followed.
"""
import json

import numpy as np

SHOWN = 4     # bounded ones a curve is drawn for, the last before the sliding


class Front:
    """One rapid event's way towards the leading edge: x/L of the stations it passed, times, speeds between them."""

    def __init__(self, event, run):
        times = np.array([np.nan if t is None else t for t in event["front_times"]])
        self.length, self.speeds_known = run["model"]["length"], run["model"]["wave_speeds"]
        self.event, self.kind = event, event["kind"]
        x = np.linspace(0, 1, len(times))
        start = int(np.nanargmin(times)) if np.isfinite(times).any() else len(times) - 1
        stop = start
        while stop + 1 < len(times) and times[stop + 1] > times[stop]:
            stop += 1
        self.x, self.times = x[start:stop + 1], times[start:stop + 1]
        self.speeds = np.diff(self.x) * self.length / np.diff(self.times)
        self.middles = (self.x[1:] + self.x[:-1]) / 2

    def mean_speed(self, low, high):
        """Between two of its stations, x/L; nan where it did not pass both."""
        inside = (self.x >= low - 1e-9) & (self.x <= high + 1e-9)
        if inside.sum() < 2:
            return np.nan
        x, t = self.x[inside], self.times[inside]
        return (x[-1] - x[0]) * self.length / (t[-1] - t[0])


def load(folder):
    return json.loads((folder / "run.json").read_text())


def rapid_of_last_cycle(run):
    """The rapid events between the last sliding but one and the last, which is the last of them."""
    events = [e for e in run["results"]["events"] if e["kind"] != "quasi-static"]
    slidings = [k for k, e in enumerate(events) if e["kind"] == "leading rapid"]
    if len(slidings) < 2:
        return []
    return [Front(e, run) for e in events[slidings[-2] + 1:slidings[-1] + 1]]


def catalogue_row(front, V, v_c):
    event, L = front.event, front.length
    c = front.speeds_known
    fastest = np.max(front.speeds) if len(front.speeds) else np.nan
    slow = event["front_start"] / L
    return (event["kind"], event["U_start"], event["U_stop"], slow, event["reach"] / L, event["peak_slip_rate"] / V,
            event["peak_slip_rate"] / v_c, front.x[0], fastest / c["longitudinal"],
            front.mean_speed(0.5 * (front.x[0] + front.x[-1]), front.x[-1]) / c["rayleigh"],
            front.speeds[-1] / c["rayleigh"] if len(front.speeds) else np.nan)


HEADS = ["kind", "U, start", "U, stop", "slow front/L", "reach/L", "slip rate/V", "slip rate/v_c", "sets out at x/L",
         "fastest/c_L", "second half/c_R", "last twentieth/c_R"]


def path_series(fronts, label, color, L, c_R):
    out = []
    for k, front in enumerate(fronts):
        if len(front.x) < 2:
            continue
        out.append({"label": label if not out else "", "x": list((front.times - front.times[0]) * c_R / L), "y": list(front.x),
                    "color": color, "marker": "circle" if front.kind == "leading rapid" else "square",
                    "filled": front.kind == "leading rapid"})
    return out


def groups(cases):
    """[(label, colour, fronts)] of cases [(label, run)]: bounded and leading ones of the last cycle, apart."""
    out = []
    for k, (label, run) in enumerate(cases):
        fronts = rapid_of_last_cycle(run)
        bounded = [f for f in fronts if f.kind == "bounded rapid"][-SHOWN:]
        out += [(f"{label}, bounded", 2 * k + 2, bounded), (f"{label}, leading", 2 * k + 1, fronts[-1:])]
    return [group for group in out if any(len(f.x) > 2 for f in group[2])]


def figure_paths(cases):
    c = cases[0][1]["model"]["wave_speeds"]
    series = []
    for label, color, fronts in groups(cases):
        series += path_series(fronts, label, color, fronts[0].length, c["rayleigh"])
    for name, key, line in (("c_{L}", "longitudinal", "dashed"), ("c_{R}", "rayleigh", "thin")):
        series.append({"label": f"~{{{name[0]}}}_{name[2:]}", "x": [0, 0.8 * c["rayleigh"] / c[key]], "y": [0.2, 1], "line": line,
                       "color": 0})
    return {"title": "where the fronts of rapid precursors are", "x": {"label": "~{c}_{R} ~{t} / ~{L}, since it set out"},
            "y": {"label": "~{x} / ~{L}", "range": [0, 1.02]}, "series": series}


def figure_speeds(cases):
    c = cases[0][1]["model"]["wave_speeds"]
    series = []
    for label, color, fronts in groups(cases):
        shown = False
        for front in fronts:
            if len(front.speeds) < 2:
                continue
            leading = front.kind == "leading rapid"
            series.append({"label": "" if shown else label, "x": list(front.middles), "y": list(front.speeds), "color": color,
                           "marker": "circle" if leading else "square", "filled": leading})
            shown = True
    for name, key, line in (("L", "longitudinal", "dashed"), ("S", "shear", "solid"), ("R", "rayleigh", "thin")):
        series.append({"label": f"~{{c}}_{{{name}}}", "x": [0, 1], "y": [c[key], c[key]], "line": line, "color": 0})
    return {"title": "how fast the fronts of rapid precursors run", "height": 0.85, "x": {"label": "~{x} / ~{L}", "range": [0, 1]},
            "y": {"label": "front speed  (√(E/ρ))", "scale": "log", "range": [0.1, 100]}, "series": series}


def events_of(row):
    """Rapid events of the periodic part of a run: after the first sliding, and not the one under way at the end."""
    results = json.loads((row["folder"] / "run.json").read_text())["results"]
    events = results["events"]
    slidings = [k for k, event in enumerate(events) if event["kind"] == "leading rapid"]
    return events[slidings[0] + 1:slidings[-1]] if slidings else []


def rates(row, kind):
    values = [e["peak_slip_rate"] for e in events_of(row) if e["kind"] == kind]
    return np.array(values) if values else np.array([np.nan])
