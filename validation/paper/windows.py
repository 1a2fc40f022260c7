# SPDX-License-Identifier: GPL-2.0-or-later
"""mu_M at a pressure as the mean over runs at pressures close by, and how well two meshes agree on it.

Sliding starts with one of a row of bursts, and the slip front stands at a node when it does: mu_M of a single run is a
staircase in P, whose steps (1 to 10 %) lie elsewhere on each mesh. The mean over a window as wide as a step does not
depend on where they lie; what a run departs from the window's trend is the spread to expect of a single one.
"""
import json

import numpy as np

GAP = 0.3               # in ln P: further apart, another window
CELLS_RESOLVED = 8      # l_c shorter than this many cells of the coarser mesh is not resolved
END_CELLS = 2           # fewer left when it slides: when the last nodes let go decides
AGREE = 0.01


def mu_of(row):
    """mu_M, of steady sliding where no sliding was fast; the largest mu where it is not steady yet."""
    mu = row["mu_M"]
    return mu if np.isfinite(mu) else row["mu_max"]


class Window:
    """The runs of one length whose pressures are close to each other."""

    def __init__(self, rows):
        self.rows = rows
        self.length = rows[0]["mesh.set.length"]
        self.centre = rows[len(rows) // 2]
        logs = np.log([row["load.pressure"] for row in rows])
        self.P = float(np.exp(logs.mean()))
        values = np.array([mu_of(row) for row in rows])
        self.mu = values.mean()
        slope = np.polyfit(logs - logs.mean(), values, 1)[0] if len(rows) > 2 else 0
        trend = self.mu + slope * (logs - logs.mean())
        lows = [row["low"] if row["period"] != 1 and np.isfinite(row["low"]) else mu for row, mu in zip(rows, values)]
        highs = [row["high"] if row["period"] != 1 and np.isfinite(row["high"]) else mu for row, mu in zip(rows, values)]
        self.low = self.mu + min(0, np.min(lows - trend))
        self.high = self.mu + max(0, np.max(highs - trend))
        self.scatter = (values - trend).std()
        fronts = [row["l_c"] for row in rows if np.isfinite(row["l_c"])]
        self.l_c = np.mean(fronts) if fronts else np.nan

    def branches(self):
        """Every branch of the central run's peaks, with how many lay on it."""
        path = self.centre["folder"] / "run.json"
        if not path.exists():
            return []
        return [(b["mu"], b["count"]) for b in json.loads(path.read_text())["results"]["branches"]]


def windows(rows):
    """Windows of a study's rows, by length and pressure."""
    out = []
    for length in sorted({row["mesh.set.length"] for row in rows}):
        at = sorted((row for row in rows if row["mesh.set.length"] == length), key=lambda row: row["load.pressure"])
        at = [row for row in at if np.isfinite(mu_of(row))]
        group = at[:1]
        for row in at[1:]:
            if np.log(row["load.pressure"] / group[-1]["load.pressure"]) > GAP:
                out.append(Window(group))
                group = []
            group.append(row)
        if group:
            out.append(Window(group))
    return out


def difference(window, fine):
    return fine.mu / window.mu - 1


def reason(window, fine, cells):
    """Why two meshes differ by more than AGREE, from what both measured."""
    if abs(difference(window, fine)) <= AGREE:
        return ""
    if window.l_c * cells < CELLS_RESOLVED:
        return f"l_c is {window.l_c * cells:.1f} cells"
    if window.l_c > 1 - END_CELLS / cells:
        return f"slides when the last {(1 - window.l_c) * cells:.1f} cells let go"
    scatter = np.hypot(window.scatter, fine.scatter) / window.mu
    return f"steps and branches: single runs scatter by {100 * scatter:.1f} %"


def branch_words(window):
    found = window.branches()
    return " ".join(f"{mu:.4f} ({count})" for mu, count in found) or "-"
