# SPDX-License-Identifier: GPL-2.0-or-later
"""The figures: each function writes one plot file and has it drawn (place.draw)."""
import numpy as np

import critical
import fronts
import theory
from interface import same

BLUE, ORANGE, GREEN, PURPLE, OCHRE, SKY, GREY = range(1, 8)
MARKERS = {0: "square", 1: "circle", 2: "triangle"}
P_LABEL, MU_LABEL = "~{P}_{ext} / ~{E}", "~{μ}_{M}"


def plain(values):
    return [None if v is None or not np.isfinite(v) else float(v) for v in values]


# --- figures 2a, 2b, 3a ---------------------------------------------------------------------------

def curves_of_pressure(rows, material, filled):
    """Marks: answers with error bars (bars.read_table), crosses where the bar is not known; thin: 1D theory."""
    series, unknown = [], []
    for k, length in enumerate(sorted({row["mesh.set.length"] for row in rows})):
        at = [row for row in rows if row["mesh.set.length"] == length and row["mu_M"] != "none"]
        known = [(row["load.pressure"], *row["mu_M"]) for row in at if row["mu_M"][1] is not None]
        series.append({"label": f"~{{L}} / ~{{L}}_{{0}} = {length:g}", "x": [P for P, _, _ in known], "y": [mu for _, mu, _ in known],
                       "low": [mu - bar for _, mu, bar in known], "high": [mu + bar for _, mu, bar in known], "line": "none",
                       "color": k + 1, "marker": MARKERS[k], "filled": filled})
        unknown += [(row["load.pressure"], row["mu_M"][0]) for row in at if row["mu_M"][1] is None]
        range_of_P = np.geomspace(min(row["load.pressure"] for row in at) / 1.3, max(row["load.pressure"] for row in at) * 1.3, 120)
        series.append({"x": plain(range_of_P), "y": plain(material.mu(length, P) for P in range_of_P), "color": k + 1,
                       "line": "thin"})
    series[-1]["label"] = "1D theory"
    if unknown:
        series.append({"label": "bar not known", "x": [P for P, _ in unknown], "y": [mu for _, mu in unknown], "color": GREY,
                       "marker": "cross", "filled": False, "line": "none"})
    return series


def figure_2(place, name, rows, material, filled):
    place.draw(name, {
        "title": f"mu_M against pressure, set {material.name}; bars: 95 %",
        "x": {"label": P_LABEL, "scale": "log"}, "y": {"label": MU_LABEL, "range": [0, material.mu_static * 1.07]},
        "series": curves_of_pressure(rows, material, filled)})


def figure_3a(place, found):
    """found: windows of sets A and B."""
    series, inset = [], []
    for material, filled in ((theory.A, False), (theory.B, True)):
        color = BLUE if material is theory.A else ORANGE
        for k, length in enumerate(sorted({w.length for w in found[material.name]})):
            at = [w for w in found[material.name] if w.length == length and np.isfinite(w.l_c)]
            series.append({"label": f"{material.name}, ~{{L}} = {length:g}", "x": [w.l_c for w in at], "y": [w.mu for w in at],
                           "color": color, "marker": MARKERS[k], "filled": filled, "line": "none"})
            if material is theory.A:
                inset.append({"x": [w.P for w in at], "y": [w.l_c or None for w in at], "color": k + 1, "marker": MARKERS[k],
                              "filled": False})
        series.append({"x": [0, 1], "y": [material.mu_kinetic, material.mu_static], "color": color, "line": "thin"})
    place.draw("fig3a", {
        "title": "mu_M against the critical length", "height": 0.85,
        "x": {"label": "~{l}_{c} / ~{L}", "range": [0, 1.02]}, "y": {"label": MU_LABEL, "range": [0, 1.5]},
        "series": series,
        "inset": {"place": [0.29, 0.015, 0.68, 0.38],
                  "x": {"label": P_LABEL, "scale": "log", "range": [8e-4, 0.13]},
                  "y": {"label": "~{l}_{c} / ~{L}", "scale": "log", "range": [0.008, 1.5]}, "series": inset}})


# --- figures 3b, 3c -------------------------------------------------------------------------------

def profile_rows(history):
    """After a sliding has stopped; fronts at a third and two thirds of l_c; at the peak."""
    first, peak = history.cycles()[-1]
    rows = [first]
    for part in (1 / 3, 2 / 3):
        reached = np.flatnonzero(history.front[first:peak] >= part * history.front[peak])
        rows.append(first + (reached[0] if len(reached) else 0))
    return rows + [peak]


def figures_3bc(place, history):
    b, c = [], []
    rows = profile_rows(history)
    x = history.x / history.length
    for k, row in enumerate(rows):
        label = f"~{{U}} = {history.U[row]:.5f}"
        b.append({"label": label, "x": plain(x), "y": plain(history.pressure[row] / history.P), "color": k + 1})
        c.append({"label": label, "x": plain(x), "y": plain(history.ratio(row)), "color": k + 1})
        front = history.front[row] / history.length
        if k > 0:
            c.append({"x": [front], "y": [history.mu_static * 1.05], "marker": "down", "line": "none", "color": k + 1})
    for level in (history.mu_static, history.mu[rows[-1]], history.mu_kinetic):
        c.append({"x": [0, 1], "y": [level, level], "line": "dashed", "color": GREY})
    across = {"label": "~{x} / ~{L}", "range": [0, 1]}
    place.draw("fig3b", {"title": "pressure at the interface", "x": across,
                         "y": {"label": "~{p} / ~{P}_{ext}", "range": [0, 3]}, "series": b})
    place.draw("fig3c", {"title": "shear stress over pressure at the interface", "x": across,
                         "y": {"label": "~{τ} / ~{p}", "range": [0, 0.65]}, "series": c})
    return rows


# --- what the rod's velocity changes --------------------------------------------------------------

def figure_velocity(place, rows):
    V = [row["rod.velocity"] for row in rows]
    series = []
    for kind, color, marker in (("leading rapid", ORANGE, "circle"), ("bounded rapid", BLUE, "square")):
        found = [fronts.rates(row, kind) for row in rows]
        series.append({"label": kind, "x": plain(V), "y": plain(np.median(r) for r in found),
                       "low": plain(r.min() for r in found), "high": plain(r.max() for r in found),
                       "color": color, "marker": marker})
    series.append({"label": "~{V}", "x": plain(V), "y": plain(V), "line": "dashed"})
    place.draw("velocity-a", {
        "title": "largest slip rate of precursors against the rod's velocity",
        "x": {"label": "~{V}", "scale": "log"}, "y": {"label": "largest slip rate", "scale": "log"},
        "series": series})


def figure_adiabatic(place, rows):
    V = [row["rod.velocity"] / theory.B.critical_velocity for row in rows]
    place.draw("velocity-b", {
        "title": "mu_M of set B against V / v_c",
        "x": {"label": "~{V} / ~{v}_{c}", "scale": "log"}, "y": {"label": MU_LABEL}, "legend": "none",
        "series": [{"x": plain(V), "y": plain(row["mu_M"] for row in rows), "marker": "circle", "color": ORANGE}]})


def figures_critical(place, found, rates):
    """found: windows of the sweeps; rates: of critical.measure; by set."""
    for name, at in rates.items():
        length = critical.SCENES[name][1]
        dynamic = [(w.P * length, w.l_c) for w in found[name] if same(w.length, length)]
        place.draw(f"critical-{name.lower()}", critical.figure(at, dynamic, name))
    place.draw("growth", critical.figure_growth(place, "A", len(rates["A"]) // 2))


def figures_fronts(place, cases):
    place.draw("front-path", fronts.figure_paths(cases))
    place.draw("front-speed", fronts.figure_speeds(cases))
