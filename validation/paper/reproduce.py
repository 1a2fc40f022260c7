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
import time
from pathlib import Path

import numpy as np

import theory
from interface import History, peak_made_of

HERE = Path(__file__).resolve().parent
BLUE, ORANGE, GREEN, PURPLE, OCHRE, SKY, GREY = range(1, 8)
MARKERS = {0: "square", 1: "circle", 2: "triangle"}
P_LABEL, MU_LABEL = "~{P}_{ext}", "~{μ}_{M}"
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
        self.seconds, self.pictures = {}, []

    def call(self, *words):
        done = subprocess.run([str(self.program), *map(str, words)], check=False)
        return done.returncode

    def sweep(self, name, label=None, settings=()):
        """Rows of the table of study `name`, as dicts; numbers where they are numbers."""
        label, started = label or name, time.monotonic()
        if self.quick and label == name:
            settings = [*settings, *COARSE]
        folder = self.folder / label
        words = ["sweep", HERE / f"{name}.yaml", "-o", folder, "-j", self.jobs, *self.fresh]
        for setting in settings:
            words += ["--set", setting]
        print(f"--- {label}", flush=True)
        if self.call(*words) == 2:
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
        known = json.loads(path.read_text()) if path.exists() else {}
        known[label] = self.seconds[label] = max(seconds, known.get(label, 0))
        path.write_text(json.dumps(known))

    def draw(self, name, plot):
        path = self.figures / f"{name}.yaml"
        path.write_text(json.dumps(plot, indent=1, ensure_ascii=False))
        if self.call("render", path) == 0:
            self.pictures.append(name)


def number(text):
    try:
        return float(text)
    except ValueError:
        return text if text else float("nan")


def plain(values):
    return [None if v is None or not np.isfinite(v) else float(v) for v in values]


def same(a, b):
    return abs(a - b) <= 1e-9 * abs(b)


# --- figures 2a, 2b, 3a ---------------------------------------------------------------------------

def lengths(rows):
    return sorted({row["mesh.set.length"] for row in rows})


def of_length(rows, length):
    return [row for row in rows if same(row["mesh.set.length"], length)]


def mu_of(row):
    """mu_M; where no sliding was fast, the steady mu of slow sliding."""
    mu = row["mu_M"]
    return mu if np.isfinite(mu) else row["mu_max"]


def curves_of_pressure(rows, material, filled):
    series = []
    for k, length in enumerate(lengths(rows)):
        at = of_length(rows, length)
        P = [row["load.pressure"] for row in at]
        low = [row["low"] if row["period"] != 1 else row["mu_M"] - row["spread"] / 2 for row in at]
        high = [row["high"] if row["period"] != 1 else row["mu_M"] + row["spread"] / 2 for row in at]
        series.append({"label": f"~{{L}} = {length:g}", "x": plain(P), "y": plain(mu_of(row) for row in at),
                       "low": plain(low), "high": plain(high), "color": k + 1, "marker": MARKERS[k],
                       "filled": filled})
        fine = np.geomspace(min(P) / 1.3, max(P) * 1.3, 120)
        series.append({"x": plain(fine), "y": plain(material.mu(length, p) for p in fine), "color": k + 1,
                       "line": "thin"})
    series[-1]["label"] = "1D theory"
    return series


def figure_2(place, name, rows, material, filled):
    top = material.mu_static * 1.07
    place.draw(name, {
        "title": f"mu_M against pressure, set {material.name}",
        "x": {"label": P_LABEL, "scale": "log"}, "y": {"label": MU_LABEL, "range": [0, top]},
        "legend": "lower-left", "series": curves_of_pressure(rows, material, filled)})


def figure_3a(place, a_rows, b_rows):
    series, inset = [], []
    for rows, material, filled in ((a_rows, theory.A, False), (b_rows, theory.B, True)):
        color = BLUE if material is theory.A else ORANGE
        for k, length in enumerate(lengths(rows)):
            at = [row for row in of_length(rows, length) if np.isfinite(row["l_c"])]
            series.append({"label": f"{material.name}, ~{{L}} = {length:g}", "x": plain(row["l_c"] for row in at),
                           "y": plain(row["mu_M"] for row in at), "color": color, "marker": MARKERS[k],
                           "filled": filled, "line": "none"})
            if material is theory.A:
                inset.append({"x": plain(row["load.pressure"] for row in at),
                              "y": plain(row["l_c"] for row in at), "color": k + 1, "marker": MARKERS[k],
                              "filled": False})
        series.append({"x": [0, 1], "y": [material.mu_kinetic, material.mu_static], "color": color, "line": "thin"})
    place.draw("fig3a", {
        "title": "mu_M against the critical length", "height": 0.85,
        "x": {"label": "~{l}_{c} / ~{L}", "range": [0, 1.02]}, "y": {"label": MU_LABEL, "range": [0, 1.5]},
        "legend": "upper-left", "series": series,
        "inset": {"place": [0.29, 0.015, 0.68, 0.38], "legend": "none",
                  "x": {"label": P_LABEL, "scale": "log", "range": [8e-4, 0.13]},
                  "y": {"label": "~{l}_{c} / ~{L}", "scale": "log"}, "series": inset}})


# --- figures 3b, 3c -------------------------------------------------------------------------------

def chosen_rows(history):
    """After a sliding has stopped; fronts at a third and two thirds of l_c; at the peak."""
    first, peak = history.cycles()[-1]
    rows = [first]
    for part in (1 / 3, 2 / 3):
        reached = np.flatnonzero(history.front[first:peak] >= part * history.front[peak])
        rows.append(first + (reached[0] if len(reached) else 0))
    return rows + [peak]


def figures_3bc(place, history):
    b, c = [], []
    rows = chosen_rows(history)
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
                         "y": {"label": "~{p} / ~{P}_{ext}", "range": [0, 3]}, "legend": "upper-left", "series": b})
    place.draw("fig3c", {"title": "shear stress over pressure at the interface", "x": across,
                         "y": {"label": "~{τ} / ~{p}", "range": [0, 0.65]}, "legend": "upper-right", "series": c})
    return rows


# --- what the rod's velocity changes --------------------------------------------------------------

def events_of(row):
    """Rapid events of the periodic part of a run: after the first sliding, and not the one under way at the end."""
    results = json.loads((row["folder"] / "run.json").read_text())["results"]
    events = results["events"]
    slidings = [k for k, event in enumerate(events) if event["kind"] == "leading rapid"]
    return events[slidings[0] + 1:slidings[-1]] if slidings else []


def rates(row, kind):
    values = [e["peak_slip_rate"] for e in events_of(row) if e["kind"] == kind]
    return np.array(values) if values else np.array([np.nan])


def figure_velocity(place, rows):
    V = [row["rod.velocity"] for row in rows]
    series = []
    for kind, color, marker in (("leading rapid", ORANGE, "circle"), ("bounded rapid", BLUE, "square")):
        found = [rates(row, kind) for row in rows]
        series.append({"label": kind, "x": plain(V), "y": plain(np.median(r) for r in found),
                       "low": plain(r.min() for r in found), "high": plain(r.max() for r in found),
                       "color": color, "marker": marker})
    series.append({"label": "~{V}", "x": plain(V), "y": plain(V), "line": "dashed"})
    place.draw("velocity-a", {
        "title": "largest slip rate of precursors against the rod's velocity",
        "x": {"label": "~{V}", "scale": "log"}, "y": {"label": "largest slip rate", "scale": "log"},
        "legend": "lower-right", "series": series})


def figure_adiabatic(place, rows):
    V = [row["rod.velocity"] / theory.B.critical_velocity for row in rows]
    place.draw("velocity-b", {
        "title": "mu_M of set B against V / v_c",
        "x": {"label": "~{V} / ~{v}_{c}", "scale": "log"}, "y": {"label": MU_LABEL}, "legend": "none",
        "series": [{"x": plain(V), "y": plain(row["mu_M"] for row in rows), "marker": "circle", "color": ORANGE}]})


# --- the report -----------------------------------------------------------------------------------

def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(cell(value) for value in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def cell(value):
    if isinstance(value, str):
        return value
    if value is None or not np.isfinite(value):
        return "-"
    return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.3e}"


def regime(row):
    return {1: "1", 2: "2 (high and low alternate)", 0: "none found"}.get(row["period"], row["status"])


def mu_table(rows, fine):
    out = []
    for row, other in zip(rows, fine):
        mu, mu_fine = mu_of(row), mu_of(other)
        out.append((row["mesh.set.length"], row["load.pressure"], mu, row["low"], row["high"], regime(row), row["l_c"],
                    mu_fine, 100 * (mu_fine / mu - 1)))
    return table(["L", "P", "mu_M", "low", "high", "period", "l_c/L", "mu_M, twice as many cells", "difference, %"], out)


def agreement(pairs):
    """How far the meshes agree, and where they do not: there the critical length is a few cells, or peaks do not repeat."""
    differences = [abs(mu_of(fine) / mu_of(row) - 1) for row, fine in pairs]
    resolved = [d for d, (row, _) in zip(differences, pairs) if row["l_c"] >= 0.1 and row["period"] == 1
                and row["high"] < 1.05 * row["low"]]
    return (f"The two meshes agree within 1 % at {sum(d <= 0.01 for d in differences)} of {len(pairs)} points, within 2 % at "
            f"{sum(d <= 0.02 for d in differences)}. Where l_c is at least four cells of the coarser mesh and the peaks lie "
            f"within 5 % of each other, they differ by {100 * np.median(resolved):.2g} % (median; largest "
            f"{100 * max(resolved):.2g} %). Where they differ by more, l_c is not resolved, or the last peaks are one of several "
            "branches (`low` and `high` say how far apart these lie), or l_c is about to reach L.\n")


def line_words(parts):
    """The answer to why mu_M is not on the line, from the numbers of this run."""
    text = []
    for name in ("A", "B"):
        at = [p for p in parts if p["set"] == name]
        if not at:
            continue
        mean = {key: np.mean([p[key] for p in at]) for key in ("distance", "by_behind", "by_left", "by_carried", "by_load")}
        text.append(f"Set {name}, mean over its rows: mu lies {mean['distance']:+.3f} from the line; friction behind the front "
                    f"gives {mean['by_behind']:+.3f}, what sliding left ahead of it {mean['by_left']:+.3f}, what was carried "
                    f"ahead of it {mean['by_carried']:+.3f}, and pressure growing with x {mean['by_load']:+.3f}.")
    return "\n" + "\n".join(text) + """
Two of the three things that the line takes for granted do not hold in these runs: tau/p ahead of the front is above mu_K
from the start, for sliding ends at slip rates of a few v_c, where friction is no longer mu_K; and it grows further ahead
of the front while the front is on its way, since the stuck part is elastic. The pressure's growth with x acts against both.
`model1d.py` splits the same distance against the 1D model's pressure.
"""


def depends_table(rows):
    keys = list(rows[0])
    keys = keys[keys.index("point") + 1:keys.index("mu_M")]
    out = []
    for P in sorted({row["load.pressure"] for row in rows}):
        at = [row for row in rows if same(row["load.pressure"], P)]
        base = at[0]
        for row in at:
            changed = [f"{key} = {cell(row[key])}" for key in keys
                       if key not in ("load.pressure", "time.until.U") and str(row[key]) != str(base[key])]
            out.append((P, ", ".join(changed) or "(standard)", row["mu_M"], 100 * (row["mu_M"] / base["mu_M"] - 1),
                        row["low"], row["high"], regime(row), row["l_c"], row["steps"]))
    return table(["P", "changed", "mu_M", "by, %", "low", "high", "period", "l_c/L", "steps"], out)


def line_parts(rows):
    parts = []
    for row in rows:
        if row["status"] != "done":
            continue
        history = History(row["folder"])
        if history.cycles():
            m = peak_made_of(history)
            parts.append({**m, "set": "A" if history.mu_static < 1 else "B", "P": row["load.pressure"],
                          "distance": m["mu"] - m["line"]})
    return parts


def line_table(parts):
    keys = ["set", "P", "mu", "l", "line", "distance", "by_behind", "by_left", "by_carried", "by_load", "f", "left", "ahead"]
    return table(["set", "P", "mu, peak", "l/L", "line", "mu - line", "behind", "left by sliding", "carried ahead",
                  "load not uniform", "f", "tau/p ahead, after sliding", "tau/p ahead, at the peak"],
                 [[p[key] for key in keys] for p in parts])


def velocity_table(rows):
    out = []
    for row in rows:
        leading, bounded = rates(row, "leading rapid"), rates(row, "bounded rapid")
        speeds = [e["front_speed"] for e in events_of(row) if e["kind"] == "leading rapid" and e["front_speed"]]
        out.append((row["rod.velocity"], row["mu_M"], regime(row), np.median(bounded), np.max(bounded),
                    np.median(leading), len(bounded) if np.isfinite(bounded[0]) else 0,
                    np.median(speeds) if speeds else np.nan))
    return table(["V", "mu_M", "period", "bounded: median slip rate", "largest", "leading: median slip rate",
                  "bounded seen", "leading: mean front speed"], out)


def readings_table(rows):
    out = [(row["material.density"], row["friction.critical_velocity"], row["rod.kind"], row["mesh.set.length"],
            row["load.pressure"], row["mu_M"], row["l_c"], theory.B.line(row["l_c"])) for row in rows]
    return table(["density", "v_c", "rod", "L", "P", "mu_M", "l_c/L", "line at this l_c"], out)


def picture(place, name, words):
    return f"![{words}](figures/{name}.png)\n" if name in place.pictures else ""


def write_report(place, parts):
    mesh = "20 (quick)" if place.quick else "40"
    text = [f"""# The paper's figures, recomputed

Otsuki and Matsukawa, Sci. Rep. 3, 1586 (2013). Everything here was computed by `./amontons reproduce`; meshes have {mesh} by
{mesh} cells unless another number is named. mu_M is the mean of the peaks of the periodic regime; where none was found
within the run, of the last peaks, and `low` and `high` give the range of all peaks but the first. Where no sliding was
fast (no peak), mu_M stands for the steady F_T/F_N of slow sliding.

## Figures 2a and 2b: mu_M against pressure
"""]
    text += [picture(place, "fig2a", "mu_M against P, set A"), picture(place, "fig2b", "mu_M against P, set B"),
             "Set A:\n\n", parts["a"], "\nSet B:\n\n", parts["b"],
             "\n", agreement(parts["pairs"]),
             "\nThe paper: mu_M falls as P or L grows, and becomes nearly constant at both ends.\n\n## Figure 3a\n\n",
             picture(place, "fig3a", "mu_M against l_c"),
             """
The paper has all points on mu_K + (mu_S - mu_K) l_c/L. Where ours lie off it, the last peak of each run says why. With f
the part of the load that lies behind the front l, and tau/p averaged by load behind and ahead of it,
mu - line = (r_behind - mu_S) f + (r_left - mu_K)(1 - f) + (r_ahead - r_left)(1 - f) + (mu_S - mu_K)(f - l/L), exactly:
what friction lacks behind the front, what sliding left ahead of it, what was carried ahead of it since, and pressure that
is not uniform (80 cells).

""", parts["line"], parts["words"], "\n## Figures 3b and 3c\n\n",
             picture(place, "fig3b", "p over P"), picture(place, "fig3c", "tau over p"), parts["profile"],
             "\n## Set B at P L = 2.3e-6: the paper's mu_M = 0.6\n\n", parts["readings"], """
The density in the equation of motion, the rod's kind, and L at constant P L change nothing here: inertia is negligible at
this size. What counts is (mu_S - mu_K) P L / (v_c eta): the last rows have v_c smaller by sqrt 2, the factor by which the
authors later corrected v_c, V and eta1 in the 3D follow-up.
""",
             "\nAnd V towards 0 (the sweeps above have V / v_c = 0.03):\n\n",
             picture(place, "velocity-b", "mu_M against V/v_c"), parts["adiabatic"],
             "\n## Precursors and the rod's velocity, set A, L = 1, P = 0.003\n\n",
             picture(place, "velocity-a", "slip rates against V"), parts["velocity"],
             "\nThe paper: the slip rate of bounded precursors falls with V, that of leading ones does not. (A mean front "
             "speed above c_L = 1.06 is no rupture: at such V the block begins to slip at many places at once.)\n",
             "\n## What mu_M depends on, set A, L = 1\n\n", parts["depends"],
             "\n## Time\n\n",
             table(["sweep", "wall time, s"], [(k, round(v, 1)) for k, v in place.seconds.items()])]
    path = place.folder / "REPORT.md"
    path.write_text("".join(text))
    print(f"report: {path}\nfigures: {place.figures}")


def profile_words(history, rows):
    after, peak = rows[0], rows[-1]
    f, behind, ahead = history.split(peak, history.front[peak])
    return (f"At the peak (U = {history.U[peak]:.5f}) the front stands at {history.front[peak] / history.length:.3f} L; "
            f"tau/p is {behind:.4f} behind it (mu_S = {history.mu_static}) and {ahead:.4f} ahead of it on average "
            f"(mu_K = {history.mu_kinetic}). Just after sliding, tau/p is {history.split(after, -1)[2]:.4f} over the whole "
            f"interface. p/P is {history.pressure[peak][0] / history.P:.3f} at x = 0 and "
            f"{history.pressure[peak][-1] / history.P:.3f} at x = L.\n")


def main():
    parser = argparse.ArgumentParser(prog="./amontons reproduce", description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", default="results/paper", help="the folder (default: results/paper)")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count() or 1, help="points computed at a time")
    parser.add_argument("--quick", action="store_true", help="20 cells, and nothing finer: a look, in a minute")
    parser.add_argument("--fresh", action="store_true", help="compute again what an earlier call (of another build) left")
    place = Place(parser.parse_args())
    record = {"a": place.sweep("fig2a"), "b": place.sweep("fig2b")}
    fine = record if place.quick else {
        key: place.sweep(f"fig2{key}", f"fig2{key}-80", ["mesh.set.nx=80", "mesh.set.nz=80"]) for key in "ab"}
    figure_2(place, "fig2a", record["a"], theory.A, False)
    figure_2(place, "fig2b", record["b"], theory.B, True)
    figure_3a(place, record["a"], record["b"])
    line = place.sweep("line")
    shown = [row for row in line if same(row["load.pressure"], 0.003) and row["status"] == "done"]
    history = History(shown[0]["folder"])
    rows = figures_3bc(place, history)
    velocity, adiabatic = place.sweep("velocity-a"), place.sweep("velocity-b")
    figure_velocity(place, velocity)
    figure_adiabatic(place, adiabatic)
    split = line_parts(line)
    parts = {"a": mu_table(record["a"], fine["a"]), "b": mu_table(record["b"], fine["b"]), "line": line_table(split), "words": line_words(split),
             "pairs": [*zip(record["a"], fine["a"]), *zip(record["b"], fine["b"])],
             "profile": profile_words(history, rows), "velocity": velocity_table(velocity),
             "adiabatic": table(["V / v_c", "mu_M", "low", "high", "steps"],
                                [(row["rod.velocity"] / theory.B.critical_velocity, row["mu_M"], row["low"], row["high"],
                                  row["steps"]) for row in adiabatic]),
             "readings": readings_table(place.sweep("readings"))}
    parts["depends"] = "(left out: quick)\n" if place.quick else depends_table(place.sweep("depends"))
    write_report(place, parts)


if __name__ == "__main__":
    main()
