#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks of Iwashita, Matsukawa & Otsuki (2023, corrected 2024; grooves 2024) in space: mu_M against pressure, length, breadth, the
area that slips before and grooves, with error bars.

    validation/space/papers.py [--seconds S] [--cells N] [--only STUDY [--points KEY ...]] [--page] [-o FOLDER]

Each point is run on meshes of 8 to 40 cells to the height, as long as one may be expected to take S seconds of processor time (default
40; it goes up with the sixth power), but for those that are there. From 20 on rows get higher towards the top; `even rows` has some of these blocks with rows of one
height, to see what that changes. A line of FOLDER/papers.jsonl (default validation/space) is one run, and a call that was stopped goes on
with those that lack: `-o` an empty folder computes all anew. Bars are those of the program's rule (src/answers/error_bars.c) on these
meshes: how many hold stands in priors.md and in papers.md. Writes papers.md and its three figures beside it."""
import argparse
import json
import math
import os
import resource
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import PROGRAM, markdown_table   # noqa: E402
from priors import STUDENT, Constants, bar_of   # noqa: E402

# Cells to the height. From GRADED_FROM on cells of that length stand at the contact, and rows get higher towards the top, GRADE times the
# lowest: 1/2.16 of the rows.
MESHES, GRADED_FROM, GRADE = (8, 10, 12, 14, 16, 20, 24, 28, 32, 36, 40), 20, 4
EVEN = (20, 28, 40)               # of these, with rows of one height, to see what grading does
PRESSURES, BREADTHS = (0.002, 0.003, 0.006, 0.012), (0.5, 1, 2)


def block(length=1.0, breadth=1.0, pressure=0.006, graded=True, **more):
    def settings(cells):
        along, across = max(round(cells * length), 2), max(round(cells * breadth), 2)
        rows = f"nz: {math.ceil(cells * math.log(GRADE) / (GRADE - 1))}, grade_z: {GRADE}" if graded and cells >= GRADED_FROM else f"nz: {cells}"
        return {"mesh.set": f"{{length: {length:g}, breadth: {breadth:g}, height: 1, nx: {along}, ny: {across}, {rows}}}",
                "load.pressure": pressure, "time.until.U": 20 * pressure * max(length, 1), **more}
    return length / breadth, settings


def grooved(direction, width, depth=0.2, pressure=0.006):
    """Two grooves in a block 1 x 1 x 1, straight, all of their section hexahedra."""
    shape = f"grooves: 2, direction: {direction}, length: 1, breadth: 1, height: 1, width: {width:g}, floor: {width:g}, depth: {depth:g}"

    def settings(cells):
        return {"mesh.file": ROOT / "meshes/grooves3d.geo", "load.pressure": pressure, "time.until.U": 20 * pressure,
                "mesh.set": f"{{{shape}, size_contact: {0.72 / cells:.5g}, size_bulk: {1.6 / cells:.5g}, cells: {cells}}}"}
    return 1.0, settings


# study: what it is, then key: (length over breadth, settings of a mesh)
STUDIES = {
    "breadth": ("W/H and P/E, at L/H = 1",
                {f"{breadth:g}, P {pressure:g}": block(1, breadth, pressure) for pressure in PRESSURES for breadth in BREADTHS}),
    "length": ("L/H, at W/H = 1 and P/E = 0.006", {f"{length:g}": block(length, 1) for length in (0.5, 1, 2, 3)}),
    "small rod": ("W/H, pushed by a rod H/10 wide and H/10 broad in the middle of the face, at L/H = 1 and P/E = 0.006",
                  {f"{breadth:g}": block(1, breadth, **{"rod.breadth": 0.1}) for breadth in BREADTHS}),
    "rod": ("W/H where the rod is elsewhere: all of the trailing face, or a strip at a tenth of the height, at L/H = 1 and P/E = 0.006",
            {f"{name}, {breadth:g}": block(1, breadth, **{key: value}) for name, key, value in (("whole face", "rod.whole", "true"), ("low", "rod.height", 0.1))
             for breadth in (0.5, 2)}),
    "grooves": ("two grooves 0.2 H deep (but where another depth is named), along or across and how wide over H, at L/H = W/H = 1 and P/E = 0.006",
                {f"{direction} {width}": grooved(direction, width) for width in (0.1, 0.2) for direction in ("along", "across")}
                | {f"along 0.2, {depth} deep": grooved("along", 0.2, depth) for depth in (0.1, 0.4)}),
}
# All that is run: these, on MESHES, and what only shows what grading changes, on meshes of EVEN cells.
RUNS = STUDIES | {"even rows": ("W/H with rows of one height, at L/H = 1 and P/E = 0.006",
                                {f"{breadth:g}": block(1, breadth, graded=False) for breadth in BREADTHS})}
# The same block in two studies: it is run in the second one named.
SAME = {("length", "1"): ("breadth", "1, P 0.006")}
CHECKED = 16                      # bars of meshes to so many cells are held against those from 3/2 as many on
RESOLVED = 8                      # cells that slip where slip turns fast, below which the program calls it not resolved
ANSWERS = ("mu_M", "mu_hold", "A_c_over_A", "l_c_over_L", "slip_cells")


def run(study, key, cells, folder):
    """A line of the answers."""
    aspect, settings = RUNS[study][1][key]
    flat = [word for name, value in settings(cells).items() for word in ("--set", f"{name}={value}")]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([PROGRAM, "run", Path(__file__).with_name("papers.yaml"), *flat, "-q", "-o", folder / "work", "--overwrite"],
                          capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    row = {"study": study, "key": key, "cells": cells, "cpu_s": round(after.ru_utime - before.ru_utime, 1)}
    if done.returncode:
        return row | {"error": done.stderr.strip()[-300:]}
    said = json.loads((folder / "work/run.json").read_text())
    results, nodes = said["results"], said["model"]["contact_nodes"]
    return row | {"version": said["version"], "nodes": round(math.sqrt(nodes * aspect), 3), "contact_nodes": nodes, "slidings": results["mu_M_peaks"],
                  **{name: results[name] for name in ANSWERS}}


def compute(words):
    """{(study, key): its lines, the coarsest mesh first}"""
    path = words.output / "papers.jsonl"
    rows = {}
    for row in map(json.loads, path.read_text().splitlines()) if path.exists() else ():
        rows.setdefault((row["study"], row["key"]), []).append(row)
    for study in () if words.page else words.only or RUNS:
        for key in words.points or RUNS[study][1]:
            if (study, key) in SAME:
                continue
            have = rows.setdefault((study, key), [])
            for cells in (MESHES if study in STUDIES else EVEN):
                coarser = [row for row in have if row["cells"] < cells]
                if cells > words.cells or coarser and coarser[-1]["cpu_s"] * (cells / coarser[-1]["cells"])**6 > words.seconds:
                    break
                if any(row["cells"] == cells for row in have):
                    continue
                have.append(run(study, key, cells, words.output))
                with path.open("a") as out:
                    out.write(json.dumps(have[-1]) + "\n")
                have.sort(key=lambda row: row["cells"])
    rows |= {at: rows[same] for at, same in SAME.items() if same in rows}
    return {at: sorted(have, key=lambda row: row["cells"]) for at, have in rows.items()}


def with_bar(rows, name):
    """(value, bar) of a point; None: fewer than two of its meshes have the answer."""
    meshes = [row | {"values": [row[name]], "wait": 0, "cells": row["slip_cells"] or 0} for row in rows if row.get(name) is not None]
    return bar_of({"answer": name}, meshes, Constants()) if len(meshes) > 1 else None


def told(found):
    return f"{found[0]:.3f} ± {found[1]:.3f}" if found else "none"


def number(row, name, digits):
    return f"{row[name]:.{digits}f}" if row.get(name) is not None else ""


def change(rows, first, last, what):
    """Whether mu_M of the last is below that of the first by more than both bars."""
    one, other = (with_bar(rows.get(at, []), "mu_M") for at in (first, last))
    if not one or not other:
        return f"{what}: not known."
    fall, bars = one[0] - other[0], math.hypot(one[1], other[1])
    verdict = "falls" if fall > bars else "rises" if -fall > bars else "within the bars"
    return f"{what}: {one[0]:.3f} to {other[0]:.3f}, {-fall:+.3f} ± {bars:.3f}: {verdict}."


def paired(rows, first, last, what):
    """The same difference mesh by mesh, of cells of the same length: its mean and, by Student's t, within what that is known 19 times in 20."""
    by_cells = [{row["cells"]: row["mu_M"] for row in rows.get(at, []) if row.get("mu_M") is not None} for at in (first, last)]
    differences = [by_cells[1][cells] - by_cells[0][cells] for cells in sorted(by_cells[0].keys() & by_cells[1].keys())]
    if len(differences) < 3:
        return f"{what}: fewer than three meshes in common."
    def mean_of(part):
        known = STUDENT[min(len(part) - 1, len(STUDENT)) - 1] * statistics.stdev(part) / math.sqrt(len(part))
        return f"{statistics.fmean(part):+.4f} ± {known:.4f} in the mean of {len(part)}"
    fine = differences[len(differences) // 2:]
    finer = f", {mean_of(fine)} of the finer half" if len(fine) > 2 else ""
    return f"{what}, mesh by mesh: {mean_of(differences)}, {sum(d < 0 for d in differences)} of them below 0{finer}; {differences[-1]:+.4f} on the finest."


def table_of(study, rows):
    lines = []
    for key in STUDIES[study][1]:
        have = [row for row in rows.get((study, key), []) if "error" not in row]
        if have:
            finest = have[-1]
            slip = number(finest, "slip_cells", 1) + (", not resolved" if (finest["slip_cells"] or RESOLVED) < RESOLVED else "")
            lines.append([key, told(with_bar(have, "mu_M")), told(with_bar(have, "mu_hold")),
                          ", ".join(f"{row['cells']}: {number(row, 'mu_M', 4) or 'none'}" for row in have),
                          number(finest, "A_c_over_A", 2), number(finest, "l_c_over_L", 2), slip,
                          " to ".join(sorted({str(f(row["slidings"] or 0 for row in have)) for f in (min, max)}, key=int)),
                          f"{sum(row['cpu_s'] for row in have):.0f}"])
    return markdown_table([study, "mu_M", "mu_hold", "mu_M on each mesh, by its cells to H", "A_c/A", "l_c/L", "cells that slip", "peaks of a run", "s"], lines)


def bars_checked(rows):
    """Bars of the meshes to CHECKED cells, of points that have three and more from 3/2 of it on: against the mean of these."""
    lines = []
    for (study, key), have in rows.items():
        fine = [row["mu_M"] for row in have if row.get("mu_M") is not None and row["cells"] >= 1.5 * CHECKED]
        found = with_bar([row for row in have if row["cells"] <= CHECKED], "mu_M")
        if study in STUDIES and (study, key) not in SAME and found and len(fine) > 2:
            off = found[0] - statistics.fmean(fine)
            lines.append([f"{study} {key}", told(found), f"{statistics.fmean(fine):.4f}, {len(fine)} meshes scattered by {statistics.stdev(fine):.4f}",
                          f"{off:+.4f}", f"{abs(off) / found[1]:.2f}"])
    return markdown_table(["point", f"mu_M by meshes to {CHECKED} cells", f"mean of those from {1.5 * CHECKED:.0f} on", "difference", "in bars"], lines)


def graded_or_not(rows):
    """What grading changes, mesh by mesh."""
    lines, ratios = [], []
    for (study, key), have in sorted(rows.items()):
        for even in () if study in STUDIES else have:
            graded = [row for row in rows.get(("breadth", f"{key}, P 0.006"), []) if row["cells"] == even["cells"]]
            if graded and "error" not in even | graded[0]:
                ratios.append(graded[0]["mu_M"] / even["mu_M"] - 1)
                lines.append([key, str(even["cells"]), number(even, "mu_M", 4), number(graded[0], "mu_M", 4), f"{100 * ratios[-1]:+.1f} %",
                              f"{even['cpu_s']:.0f}", f"{graded[0]['cpu_s']:.0f}"])
    if not lines:
        return "Not computed."
    mean, spread = statistics.fmean(ratios), statistics.stdev(ratios) if len(ratios) > 1 else 0
    return (markdown_table(["W/H", "cells to H at the contact", "even", "graded", "change", "s, even", "s, graded"], lines)
            + f"\n\n- graded over even: {100 * mean:+.2f} % in the mean of {len(ratios)}, scattered by {100 * spread:.2f} %.")


def verdicts(study, rows):
    def between(first, last, what):
        return change(rows, (study, first), (study, last), what)
    if study == "breadth":
        lines = [between(f"{BREADTHS[0]:g}, P {p:g}", f"{BREADTHS[-1]:g}, P {p:g}", f"W/H from {BREADTHS[0]} to {BREADTHS[-1]} at P/E = {p:g}") for p in PRESSURES]
        lines += [paired(rows, (study, f"{BREADTHS[0]:g}, P {p:g}"), (study, f"{BREADTHS[-1]:g}, P {p:g}"), f"W/H from {BREADTHS[0]} to {BREADTHS[-1]} at P/E = {p:g}")
                  for p in PRESSURES]
        lines += [between(f"{w:g}, P {PRESSURES[0]:g}", f"{w:g}, P {PRESSURES[-1]:g}", f"P/E from {PRESSURES[0]} to {PRESSURES[-1]} at W/H = {w:g}") for w in BREADTHS]
    elif study == "grooves":
        lines = [change(rows, ("length", "1"), (study, key), f"{key}, beside none") for key in STUDIES[study][1]]
    elif study == "rod":
        lines = [between(f"{name}, 0.5", f"{name}, 2", f"{name}, W/H from 0.5 to 2") for name in ("whole face", "low")]
    else:
        keys = list(STUDIES[study][1])
        lines = [between(keys[0], keys[-1], f"from {keys[0]} to {keys[-1]}")]
    return "\n".join(f"- {line}" for line in lines)


def points(rows):
    """(A_c/A of the finest mesh, mu_M, bar, study, key)"""
    for (study, key), have in rows.items():
        if study not in STUDIES or (study, key) in SAME:
            continue
        found, good = with_bar(have, "mu_M"), [row for row in have if row.get("A_c_over_A") is not None]
        if found and good:
            yield good[-1]["A_c_over_A"], *found, study, key


def draw(rows, folder):
    """The figures: mu_M against breadth at each pressure, what breadth changes against cells, and mu_M against the critical area."""
    def series(number, label, points):
        """points: (x, value) or (x, value, bar)"""
        found = {"label": label, "x": [p[0] for p in points], "y": [p[1] for p in points], "color": number + 1,
                 "marker": ("circle", "square", "triangle", "down", "cross")[number % 5]}
        if points and len(points[0]) > 2:
            found |= {"low": [p[1] - p[2] for p in points], "high": [p[1] + p[2] for p in points]}
        return found

    def mu_on(study, key):
        return {row["cells"]: row["mu_M"] for row in rows.get((study, key), []) if row.get("mu_M") is not None}
    mu = {"label": "~{μ}_{M}"}
    across, differences = [], []
    for study, name, keys in [("breadth", f"~{{P}}/~{{E}} = {p:g}", [f"{w:g}, P {p:g}" for w in BREADTHS]) for p in PRESSURES] + [
            ("small rod", "~{P}/~{E} = 0.006, rod ~{H}/10 broad", [f"{w:g}" for w in BREADTHS])]:
        beside = 1 + 0.03 * (len(across) - 2)   # so that bars do not hide each other
        found = [(w * beside, *bar) for w, key in zip(BREADTHS, keys) if (bar := with_bar(rows.get((study, key), []), "mu_M"))]
        across.append(series(len(across), name, found))
        narrow, broad = mu_on(study, keys[0]), mu_on(study, keys[-1])
        differences.append(series(len(differences), name, [(cells, broad[cells] - narrow[cells]) for cells in sorted(narrow.keys() & broad.keys())]))
    kinds = {}
    for area, *value, study, key in points(rows):
        kinds.setdefault("rod over the face, or low" if study == "rod" else " ".join([study, key.split()[0]]) if study == "grooves" else study, []).append((area, *value))
    cells = {"label": "cells to ~{H} at the contact", "scale": "log", "range": [7, 45]}
    plots = {"papers-breadth": {"x": {"label": "~{W}/~{H}", "scale": "log", "range": [0.4, 2.5]}, "y": mu, "series": across},
             "papers-cells": {"x": cells, "y": {"label": "~{μ}_{M}: ~{W}/~{H} = 2 less 0.5"},
                              "series": differences[:-1] + [{"x": [7, 45], "y": [0, 0], "line": "dashed", "color": 0}]},
             "papers-area": {"x": {"label": "~{A}_{c}/~{A}"}, "y": mu,
                             "series": [series(k, kind, at) | {"line": "none"} for k, (kind, at) in enumerate(kinds.items())]}}
    for name, plot in plots.items():
        path = folder / f"{name}.yaml"
        path.write_text(json.dumps(plot, ensure_ascii=False))
        subprocess.run([PROGRAM, "render", path, "--dpi", "200", "--overwrite"], check=True, stdout=subprocess.DEVNULL)
        path.unlink()


def page(rows, words):
    parts = [f"""# The papers of 2023 and 2024, in space

`validation/space/papers.py` ([script](papers.py), [scene](papers.yaml) with all parameters, [every run](papers.jsonl)). What the numbers mean for the papers' statements:
[README.md](README.md#the-papers-of-2023-and-2024).

- **Parameters** as corrected in 2024; lengths over H, P and stress over E. The rod is a strip H/10 wide at half of the height, over the whole breadth, but where a table says otherwise:
  where and how broad theirs is is not known to us. Of the papers we have abstracts and captions: statements are judged, no number of a figure could be read.
- **mu_M** is the mean of the peaks of F_T/F_N before bulk slidings, the first loading left out (how many peaks: last column but one); ± is the bar of the program's rule
  ([accuracy](../../docs/accuracy.md)), 95 %, on these meshes, one run each: the value for infinitely small cells lies within.
- **Meshes** of {", ".join(map(str, MESHES))} cells to the height, up to what time allowed (`--seconds`, `--points`; papers.jsonl says how long each took). Theirs have 40, and explicit steps
  of 1e-6. From {GRADED_FROM} cells on only those at the contact are so small: rows get higher towards the top, the last {GRADE} times the first
  ([what that changes](#even-rows-wh-with-rows-of-one-height-at-lh--1-and-pe--0006)). A mesh's own value is off by some 1 %.
- **A_c/A** and **l_c/L**: the part of the contact that has slipped, and how far the front has come, when slow slip turns fast; **cells that slip** is the length of the slipping part in
  cells. All three on the finest mesh; below {RESOLVED} cells slip is not resolved.
- s: processor time of all meshes of a point.
- All computed by version {", ".join(sorted({row["version"] for have in rows.values() for row in have if "version" in row}))}. A call computes only what papers.jsonl lacks: `-o` an empty folder computes all anew."""]
    for study, (title, _) in STUDIES.items():
        parts.append(f"## {study.capitalize()}: {title}\n\n{table_of(study, rows)}\n\n{verdicts(study, rows)}")
        if study == "breadth":
            parts += ["![mu_M against breadth at four pressures, and pushed by a small rod](papers-breadth.png)",
                      "What breadth changes on meshes of the same cells, a rod over the whole breadth:\n\n"
                      "![mu_M of W/H = 2 less that of 0.5 against cells, at four pressures](papers-cells.png)"]
    parts.append(f"## Even rows: {RUNS['even rows'][0]}\n\n{graded_or_not(rows)}")
    parts.append(f"## Did bars hold?\n\nOf points with three and more meshes from {1.5 * CHECKED:.0f} cells on: a bar by the meshes to {CHECKED} cells, against the mean of those.\n\n{bars_checked(rows)}")
    lines = [[f"{area:.2f}", f"{value:.3f} ± {bar:.3f}", f"{study} {key}"] for area, value, bar, study, key in sorted(points(rows))]
    parts.append("## mu_M against A_c/A\n\nIn order of the area that slips before bulk sliding, on the finest mesh.\n\n![mu_M against the critical area](papers-area.png)\n\n"
                 + markdown_table(["A_c/A", "mu_M", "point"], lines))
    return "\n\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=40, help="of processor time for one mesh")
    parser.add_argument("--only", nargs="+", choices=RUNS)
    parser.add_argument("--points", nargs="+", help="some of the one study after --only, by the first column of its table")
    parser.add_argument("--cells", type=int, default=MESHES[-1], help="to the height, at most")
    parser.add_argument("--page", action="store_true", help="write the page from what was computed, and compute nothing")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    words = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    words.output.mkdir(parents=True, exist_ok=True)
    rows = compute(words)
    draw(rows, words.output)
    (words.output / "papers.md").write_text(page(rows, words))


if __name__ == "__main__":
    main()
