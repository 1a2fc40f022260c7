# SPDX-License-Identifier: GPL-2.0-or-later
"""laws.md of this folder: page.in with what question.jsonl and cases.jsonl say in the place of [[names]], and the figures."""
import json
import math
import re
import statistics
import subprocess

import cases
from ten_cases import section
from laws import (CELLS_ASKED, COST_CELLS, COST_LAWS, FAST, HERE, LAWS, MAIN, P, REST, REST_CELLS, RESTS, V, length_of, rested,
                  steady)
from measured_run import PROGRAM, markdown_table
from promise import Kept

MU = "~{\u03bc}_{M}"
COLORS = {law: k + 1 for k, law in enumerate(MAIN)}
MARKERS = dict(zip(MAIN, ("circle", "square", "triangle", "down")))


def with_bar(row, name):
    """0.319 ± 0.005; why there is none, if there is none."""
    value, error = row.get(name), row.get(f"{name}_error")
    if value is None:
        return "none"
    said = f"{value:.3f} ± {error:.3f}" if error is not None else f"{value:.3f}, bar not known"
    return said + ", steady" * (name == "mu_M" and ends_steadily(row))


def ends_steadily(row):
    """Slidings, if there were some, died out: the end of the run is steady sliding."""
    return row.get("mu_steady") is not None


def cells_on(row):
    """Cells of the last mesh on G D_c/(b P); None: the law has no slip distance that sets it."""
    length = length_of(LAWS[row["law"]], row["P"])
    return length * (row["nodes"][-1] - 1) / row["L"] if length and row["nodes"] else None


def resolution(row, kept):
    cells = cells_on(row)
    if cells is None:
        return f"{row['slip_cells']:g} slip" if row["slip_cells"] else ""
    if cells >= CELLS_ASKED:
        return f"{cells:.1f}"
    finer = kept.rows.get((row["case"], "resolved"))
    if not finer:
        return f"**{cells:.1f}**, not resolved"
    mu = f"{finer['mu_M']:.3f}" if finer["mu_M"] is not None else "no sliding"
    return f"**{cells:.1f}**; one run on {finer['cells']} cells: {mu}"


def table_of(rows, key, kept):
    head = [key, "law", "mu_M", "mu_hold", "bounded rapid a sliding", "slow slip before, of L", "l_c/L", "cells", "contact nodes", "s", "3 %"]
    lines = []
    for row in rows:
        lines.append([f"{row[key]:g}", row["law"], with_bar(row, "mu_M"), with_bar(row, "mu_hold"),
                      *("" if row[name] is None else f"{row[name]:.2g}" for name in ("bounded", "slow_reach")),
                      "" if row["l_c_over_L"] is None else f"{row['l_c_over_L']:.2f}", resolution(row, kept),
                      f"{row['nodes'][0]} to {row['nodes'][-1]}" if row["nodes"] else "", f"{row['seconds']:.1f}",
                      "met" if row["met"] else "not met"])
    return markdown_table(head, lines)


def curve(law, rows, key, shift=1.0):
    rows = [row for row in rows if row["law"] == law and row["mu_M"] is not None]
    bars = [row["mu_M_error"] or 0 for row in rows]
    return {"label": law, "x": [row[key] * shift for row in rows], "y": [row["mu_M"] for row in rows],
            "low": [row["mu_M"] - bar for row, bar in zip(rows, bars)], "high": [row["mu_M"] + bar for row, bar in zip(rows, bars)],
            "color": COLORS[law], "marker": MARKERS[law], "line": "thin"}


def draw(name, folder, **content):
    path = folder / f"{name}.yaml"
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")
    subprocess.run([PROGRAM, "render", path, "--dpi", "200", "--overwrite"], check=True, stdout=subprocess.DEVNULL)
    path.unlink()


def rest_table(kept):
    """{(law, rest): (mean over the meshes of the first peak, half of what they differ by)}, and the table."""
    found = {}
    for row in (row for row in kept.rows.values() if row["what"] == "rest" and row["peaks"]):
        found.setdefault((row["law"], row["rest"]), []).append(row["peaks"])
    first = {at: (statistics.mean(peak[0] for peak in peaks), (max(peak[0] for peak in peaks) - min(peak[0] for peak in peaks)) / 2)
             for at, peaks in found.items() if len(peaks) == len(REST_CELLS)}
    third = {at: statistics.mean(peak[-1] for peak in peaks) for at, peaks in found.items()}
    lines = [[law, f"{rest:g}" if LAWS[law] else "any", f"{mean:.3f} ± {half:.3f}", f"{third[law, rest]:.3f}"]
             for (law, rest), (mean, half) in sorted(first.items(), key=lambda item: (MAIN.index(item[0][0]), item[0][1]))]
    return first, markdown_table(["law", "rest before pushing", "first peak", "third peak"], lines)


def slope(first, law):
    """Of the first peak, a factor of ten of rest, over the last three decades."""
    known = [(math.log10(rest), mean) for (name, rest), (mean, _) in first.items() if name == law and rest >= RESTS[-4]]
    if len(known) < 2:
        return "not known"
    x, y = zip(*known)
    return f"{statistics.linear_regression(x, y).slope:.4f}"


def cost_table(kept):
    rows = [row for row in kept.rows.values() if row["what"] == "cost" and row["slidings"]]
    lines = []
    for cells in COST_CELLS:
        base = None
        for law in COST_LAWS:
            turns = [row for row in rows if (row["law"], row["cells"]) == (law, cells)]
            if not turns:
                continue
            one, seconds = turns[0], min(row["seconds"] for row in turns)
            each = seconds / one["slidings"]
            base = base or (each, one["accepted"] / one["slidings"])
            lines.append([cells, law, one["slidings"], one["accepted"], f"{one['accepted'] / one['slidings']:.0f}",
                          f"{one['contact_iterations'] / one['contact_solves']:.2f}", f"{seconds:.2f}", f"{1000 * each:.0f}",
                          f"{each / base[0]:.2f}", len(turns)])
    return markdown_table(["cells", "law", "slidings", "steps", "steps a sliding", "iterations a stage", "s", "ms a sliding",
                           "over the paper's law", "runs"], lines)


def match_table():
    lines = []
    for name, law in LAWS.items():
        length = length_of(law)
        lines.append([name, "; ".join(f"{key} {value}" for key, value in law.items() if key not in ("law",)) or "mu_static 0.38; mu_kinetic 0.1; critical_velocity 3.4e-4",
                      f"{rested(law):.3f}", f"{steady(law, V):.3f}", f"{steady(law, FAST):.3f}", f"{length:.2f}" if length else "viscosity's"])
    return markdown_table(["law", "numbers", f"held after {REST}", "steady slip at V", "steady slip at 10 v_c", f"slip-weakening length at P = {P}"], lines)


def fall(rows, law, at, key):
    """Change of mu_M between two values of `key`, with its bar."""
    first, last = ([row for row in rows if row["law"] == law and row[key] == value and row["mu_M_error"]] for value in at)
    if not first or not last:
        return "not known"
    ratio = last[0]["mu_M"] / first[0]["mu_M"]
    error = ratio * math.hypot(*(row[0]["mu_M_error"] / row[0]["mu_M"] for row in (first, last)))
    return f"{100 * (ratio - 1):+.0f} ± {100 * error:.0f} %"


def measured(kept, asked):
    """{name: text} for page.in."""
    studies = {}
    for row in kept.rows.values():
        studies.setdefault(row["what"], []).append(row)
    by = {study: sorted(studies.get(study, []), key=lambda row: (row[key], list(LAWS).index(row["law"])))
          for study, key in (("pressure", "P"), ("length", "L"), ("velocity", "V"), ("variants", "P"))}
    by["variants"] = [row for row in by["variants"] if row["law"] not in MAIN]
    standard = [row for row in by["pressure"] if row["P"] == P]
    by["length"] = sorted(by["length"] + standard, key=lambda row: (row["L"], list(LAWS).index(row["law"])))
    by["velocity"] = sorted(by["velocity"] + standard, key=lambda row: (row["V"], list(LAWS).index(row["law"])))
    first, rests = rest_table(kept)
    found = {"rest cells": ", ".join(map(str, REST_CELLS)), "match table": match_table(), "rest table": rests, "cost table": cost_table(kept), "promise": section(asked)}
    for study, key in (("pressure", "P"), ("length", "L"), ("velocity", "V"), ("variants", "P")):
        found[f"{study} table"] = table_of(by[study], key, kept)
    for law in MAIN:
        found |= {f"fall P {law}": fall(by["pressure"], law, (0.003, 0.02), "P"), f"fall L {law}": fall(by["length"], law, (1, 4), "L"),
                  f"rest {law}": slope(first, law)}
        for row in by["pressure"] + by["length"] + by["velocity"]:
            if row["law"] == law:
                at = f"{law} P {row['P']:g} L {row['L']:g} V {row['V']:g}"
                found |= {f"mu {at}": with_bar(row, "mu_M"), f"hold {at}": with_bar(row, "mu_hold"),
                          f"slow {at}": "none" if row["slow_reach"] is None else f"{row['slow_reach']:.2f}",
                          f"bounded {at}": "none" if row["bounded"] is None else f"{row['bounded']:.1f}"}
    for row in by["variants"]:
        found[f"variant {row['law']} P {row['P']:g}"] = with_bar(row, "mu_M")
    return found, by, first


def figures(by, first, folder):
    for study, key, label in (("pressure", "P", "pressure ~{P}"), ("length", "L", "length ~{L}"), ("velocity", "V", "velocity of the rod ~{V}")):
        values = [row[key] for row in by[study]]
        draw(study, folder, height=0.65, x={"label": label, "scale": "log", "range": [min(values) / 1.3, max(values) * 1.3]}, y={"label": MU},
             series=[curve(law, by[study], key, 1 + 0.03 * (k - 1)) for k, law in enumerate(MAIN)])
    series = []
    for law in MAIN[1:]:
        at = [(rest, *value) for (name, rest), value in first.items() if name == law]
        series.append({"label": law, "x": [x for x, _, _ in at], "y": [y for _, y, _ in at], "low": [y - e for _, y, e in at],
                       "high": [y + e for _, y, e in at], "color": COLORS[law], "marker": MARKERS[law], "line": "thin"})
    draw("rest", folder, height=0.65, x={"label": "rest before pushing", "scale": "log", "range": [RESTS[0] / 1.5, RESTS[-1] * 1.5]},
         y={"label": "first peak of ~{F}_{T}/~{F}_{N}"}, series=series)


def text(kept, asked):
    found, by, first = measured(kept, asked)
    page = (HERE / "page.in").read_text(encoding="utf-8")
    return re.sub(r"\[\[([^]]+)\]\]", lambda name: found.get(name[1], "not computed"), page), by, first


def write(folder):
    kept = Kept(folder / "question.jsonl")
    page, by, first = text(kept, cases.CASES.known(Kept(folder / "cases.jsonl")))
    (folder / "laws.md").write_text(page, encoding="utf-8")
    figures(by, first, folder)
