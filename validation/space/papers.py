#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks of Iwashita, Matsukawa & Otsuki (2023, corrected 2024; grooves 2024) in space: mu_M against pressure, length, breadth, the
area that slips before and grooves, with error bars.

    validation/space/papers.py [--seconds S] [--cells N] [--only STUDY [--points KEY ...]] [--page] [-o FOLDER]

Each point is run on meshes of 8 to 40 cells to the height, as long as one may be expected to take S seconds of processor time (default
40; it goes up with the sixth power). From 20 on rows get higher towards the top; `even rows` has some of these blocks with rows of one
height, to see what that changes. A line of FOLDER/papers.jsonl (default validation/space) is one run, and a call that was stopped goes on
behind the last one. Bars are those of the program's rule (src/answers/error_bars.c) on these meshes: of blocks
in space 98 of 100 held (priors.md). Writes papers.md and its two figures beside it."""
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
MESHES, GRADED_FROM, GRADE = (8, 10, 12, 14, 16, 20, 28, 40), 20, 4
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
            have = rows.setdefault((study, key), [])
            for cells in (MESHES if study in STUDIES else EVEN)[len(have):]:
                if cells > words.cells:
                    break
                if have and have[-1]["cpu_s"] * (cells / have[-1]["cells"])**6 > words.seconds:
                    break
                have.append(run(study, key, cells, words.output))
                with path.open("a") as out:
                    out.write(json.dumps(have[-1]) + "\n")
    return rows


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
    mean = statistics.fmean(differences)
    known = STUDENT[min(len(differences) - 1, len(STUDENT)) - 1] * statistics.stdev(differences) / math.sqrt(len(differences))
    return f"{what}, mesh by mesh: {mean:+.4f} ± {known:.4f} in the mean of {len(differences)}, {sum(d < 0 for d in differences)} of them below 0."


def table_of(study, rows):
    lines = []
    for key in STUDIES[study][1]:
        have = [row for row in rows.get((study, key), []) if "error" not in row]
        if have:
            finest = have[-1]
            lines.append([key, told(with_bar(have, "mu_M")), told(with_bar(have, "mu_hold")), ", ".join(number(row, "mu_M", 4) for row in have),
                          number(finest, "A_c_over_A", 2), number(finest, "l_c_over_L", 2), number(finest, "slip_cells", 1),
                          str(finest["cells"]), f"{sum(row['cpu_s'] for row in have):.0f}"])
    return markdown_table([study, "mu_M", "mu_hold", "mu_M mesh by mesh", "A_c/A", "l_c/L", "cells that slip", "finest: cells to H", "s"], lines)


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
        if study not in STUDIES:
            continue
        found, good = with_bar(have, "mu_M"), [row for row in have if row.get("A_c_over_A") is not None]
        if found and good:
            yield good[-1]["A_c_over_A"], *found, study, key


def draw(rows, folder):
    """The two figures: mu_M against breadth at each pressure, and against the critical area."""
    def series(number, label, places, found):
        return {"label": label, "x": places, "y": [f[0] for f in found], "low": [f[0] - f[1] for f in found], "high": [f[0] + f[1] for f in found],
                "color": number + 1, "marker": ("circle", "square", "triangle", "down", "cross")[number]}
    mu = {"label": "~{μ}_{M}"}
    across = []
    for study, name, keys in [("breadth", f"~{{P}}/~{{E}} = {p:g}", [f"{w:g}, P {p:g}" for w in BREADTHS]) for p in PRESSURES] + [
            ("small rod", "~{P}/~{E} = 0.006, rod ~{H}/10 broad", [f"{w:g}" for w in BREADTHS])]:
        found = [(w, with_bar(rows.get((study, key), []), "mu_M")) for w, key in zip(BREADTHS, keys)]
        found = [(w, f) for w, f in found if f]
        if found:
            across.append(series(len(across), name, [w for w, _ in found], [f for _, f in found]))
    plots = {"papers-breadth": {"x": {"label": "~{W}/~{H}", "scale": "log", "range": [0.4, 2.5]}, "y": mu, "series": across}}
    kinds = {}
    for area, value, bar, study, _ in points(rows):
        kinds.setdefault(study, []).append((area, value, bar))
    plots["papers-area"] = {"x": {"label": "~{A}_{c}/~{A}"}, "y": mu, "series": [
        series(k, study, [p[0] for p in at], [p[1:] for p in at]) | {"line": "none"} for k, (study, at) in enumerate(kinds.items())]}
    for name, plot in plots.items():
        path = folder / f"{name}.yaml"
        path.write_text(json.dumps(plot, ensure_ascii=False))
        subprocess.run([PROGRAM, "render", path, "--dpi", "200", "--overwrite"], check=True, stdout=subprocess.DEVNULL)
        path.unlink()


def page(rows, words):
    parts = [f"""# The papers of 2023 and 2024, in space

`validation/space/papers.py` ([script](papers.py), [scene](papers.yaml), [every run](papers.jsonl)). Parameters as corrected in 2024; lengths over H. Of the meshes of
{MESHES[0]} to {MESHES[-1]} cells to the height a point is run on as many as its time allowed (`--seconds`, `--cells`; the column `finest`); its bar is that of the program's rule on these
meshes. Their cells are H/40, their steps 1e-6. From {GRADED_FROM} cells on only those at the contact are so small: rows get higher towards the top, the last {GRADE} times
the first ([what that changes](#even-rows-wh-with-rows-of-one-height-at-lh--1-and-pe--0006)). What we have of the papers are abstracts and captions: statements are judged, no number of a figure could be read.
Where and how broad their rod is is not known to us: a strip H/10 wide at half of the height over the whole breadth, but where a table says otherwise.
s: processor time of all meshes of a point. What it means: [README.md](README.md#the-papers-of-2023-and-2024)."""]
    for study, (title, _) in STUDIES.items():
        parts.append(f"## {study.capitalize()}: {title}\n\n{table_of(study, rows)}\n\n{verdicts(study, rows)}")
        if study == "breadth":
            parts.append("![mu_M against breadth at four pressures](papers-breadth.png)")
    parts.append(f"## Even rows: {RUNS['even rows'][0]}\n\n{graded_or_not(rows)}")
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
