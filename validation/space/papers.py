#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks of Iwashita, Matsukawa & Otsuki (2023, corrected 2024; grooves 2024) in space: mu_M against pressure, length, breadth and
the area that slips before, with error bars.

    validation/space/papers.py [--bar 5] [--within 120] [--only STUDY ...] [-o FOLDER]

Each point is a run on one mesh, eight cells to the height, and one with an error bar (`--to BAR % --within S`); answers stay in
FOLDER/papers.jsonl (default validation/space), and a call that was stopped goes on where it was. Writes papers.md beside it: a table
a study, and what of the papers' statements stands."""
import argparse
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "validation/benchmark"))
sys.dont_write_bytecode = True
from measured_run import PROGRAM, markdown_table   # noqa: E402

CELLS = 8     # along H; the first mesh of a bar is half as fine


def block(length=1.0, breadth=1.0, pressure=0.006):
    return {"mesh.set": f"{{length: {length:g}, breadth: {breadth:g}, height: 1, nx: {round(CELLS * length)}, ny: {round(CELLS * breadth)}, nz: {CELLS}}}",
            "load.pressure": pressure, "time.until.U": 20 * pressure * max(length, 1)}


def grooved(direction, width, depth=0.2, pressure=0.006):
    """Two grooves in a block 1 x 1 x 1, straight, all of their section hexahedra."""
    shape = f"grooves: 2, direction: {direction}, length: 1, breadth: 1, height: 1, width: {width:g}, floor: {width:g}, depth: {depth:g}"
    return {"mesh.file": ROOT / "meshes/grooves3d.geo", "mesh.set": f"{{{shape}, size_contact: 0.09, size_bulk: 0.2, cells: 8}}",
            "load.pressure": pressure, "time.until.U": 20 * pressure}


STUDIES = {
    "pressure": ("P/E, at L/H = 1 and W/H = 2", {pressure: block(1, 2, pressure) for pressure in (0.001, 0.002, 0.003, 0.006, 0.012)}),
    "length": ("L/H, at W/H = 1 and P/E = 0.006", {length: block(length, 1) for length in (0.5, 1, 2, 3)}),
    "breadth": ("W/H, at L/H = 1 and P/E = 0.006", {breadth: block(1, breadth) for breadth in (0.5, 1, 2, 3)}),
    "rod": ("W/H where the rod is elsewhere, at L/H = 1 and P/E = 0.006: all of the trailing face, or a strip at a tenth of the height",
            {f"{name}, W/H {breadth}": block(1, breadth) | {key: value} for name, key, value in (("whole face", "rod.whole", "true"), ("low", "rod.height", 0.1))
             for breadth in (0.5, 2)}),
    "grooves": ("two grooves 0.2 H deep, along or across and how wide over H, at L/H = W/H = 1 and P/E = 0.006",
                {f"{direction} {width}": grooved(direction, width) for width in (0.1, 0.2) for direction in ("along", "across")}),
}


def answer(study, key, settings, words, bar):
    """A line of the answers. bar: %, 0: one mesh."""
    flat = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    folder = words.output / "work"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    wanted = ["--to", f"{bar:g}%", "--within", f"{words.within:g}s"] if bar else []
    done = subprocess.run([PROGRAM, "run", Path(__file__).with_name("papers.yaml"), *flat, *wanted, "-q", "-o", folder, "--overwrite"],
                          capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    row = {"study": study, "key": key, "bar": bar, "within": words.within if bar else None, "cpu_s": round(after.ru_utime - before.ru_utime, 1)}
    if done.returncode:
        return row | {"error": done.stderr.strip()[-300:]}
    said = json.loads((folder / "run.json").read_text())
    results, accuracy = said["results"], said.get("accuracy", {"met": None, "levels": [said["model"]]})
    return row | {"version": said["version"], "met": accuracy["met"], "nodes": [level["contact_nodes"] for level in accuracy["levels"]],
                  **{name: results[name] for name in ("mu_M", "mu_M_error", "mu_hold", "mu_hold_error", "A_c_over_A", "l_c_over_L", "slip_cells")}}


def compute(words):
    path = words.output / "papers.jsonl"
    lines = map(json.loads, path.read_text().splitlines()) if path.exists() else ()
    rows = {(row["study"], str(row["key"]), row["bar"] > 0): row for row in lines}
    for bar in (0, words.bar):
        for study in () if words.page or (bar and words.one_mesh) else words.only or STUDIES:
            for key, settings in STUDIES[study][1].items():
                at = study, str(key), bar > 0
                if at not in rows:
                    rows[at] = answer(study, key, settings, words, bar)
                    with path.open("a") as out:
                        out.write(json.dumps(rows[at]) + "\n")
    return rows


def with_bar(row, name):
    if row.get(name) is None:
        return "none"
    return f"{row[name]:.3f} ± {row[name + '_error']:.3f}" if row.get(f"{name}_error") is not None else f"{row[name]:.3f}, not known"


def falls(rows, one):
    """Whether mu_M of the last is below that of the first: on one kind of mesh, and by more than both bars."""
    first, last = one[0]["mu_M"], one[-1]["mu_M"]
    text = f"On meshes of {CELLS} cells to the height mu_M goes from {first:.3f} to {last:.3f}."
    known = [row for row in rows if row.get("mu_M_error") is not None]
    if len(known) < 2:
        return text
    fall, bars = known[0]["mu_M"] - known[-1]["mu_M"], (known[0]["mu_M_error"]**2 + known[-1]["mu_M_error"]**2)**0.5
    verdict = "stands" if fall > bars else "is turned round" if -fall > bars else "is within the bars"
    return text + f" With bars, {known[0]['key']} to {known[-1]['key']}: that it falls {verdict} ({fall:.3f}, bars {bars:.3f})."


def page(rows, words):
    parts = [f"""# The papers of 2023 and 2024, in space

`validation/space/papers.py --bar {words.bar:g} --within {words.within:g}` ([script](papers.py), [scene](papers.yaml), [answers](papers.jsonl)). Parameters as corrected in 2024;
lengths over H. Their cells are H/40, their steps 1e-6; here meshes go up to what the time for a point reaches (contact nodes are told), and each
answer has its bar. Their figures were not at hand: statements of their abstracts are judged, no numbers. Where their rod stands is not known
(here: a strip H/10 wide at half of the height). s: processor time of a point, meshes and reductions included."""]
    areas = []
    for study, (title, points) in STUDIES.items():
        table, have, ones = [], [], []
        for key in points:
            row, one = (rows.get((study, str(key), barred), {}) for barred in (True, False))
            have += [row] if row else []
            ones += [one] if one.get("mu_M") else []
            if one.get("A_c_over_A") is not None:
                areas.append((one["A_c_over_A"], one["mu_M"], f"{study} {key}"))
            table.append([str(key), *(f"{one[name]:.{digits}f}" if one.get(name) is not None else "" for name, digits in
                                      (("mu_M", 4), ("A_c_over_A", 2), ("l_c_over_L", 2), ("slip_cells", 1))), *map(str, one.get("nodes", [""])), f"{one.get('cpu_s', 0):.0f}",
                          with_bar(row, "mu_M"), with_bar(row, "mu_hold"), ", ".join(map(str, row.get("nodes", []))), f"{row.get('cpu_s', 0):.0f}"])
        parts.append(f"## {study.capitalize()}: {title}\n\n" + markdown_table(
            [study, "mu_M", "A_c/A", "l_c/L", "cells that slip", "contact nodes", "s", "mu_M with bar", "mu_hold with bar", "contact nodes", "s"], table)
            + ("" if study in ("grooves", "rod") or len(ones) < 2 else f"\n\n{falls(have, ones)}"))
    if areas:
        parts.append("## mu_M against A_c/A\n\nOn one mesh each, in order of the area that slips before bulk sliding.\n\n"
                     + markdown_table(["A_c/A", "mu_M", "point"], [[f"{area:.2f}", f"{mu:.3f}", point] for area, mu, point in sorted(areas)]))
    return "\n\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bar", type=float, default=5, help="%% of mu_M")
    parser.add_argument("--within", type=float, default=120, help="s for a point")
    parser.add_argument("--one-mesh", action="store_true", help="no error bars yet")
    parser.add_argument("--only", nargs="+", choices=STUDIES)
    parser.add_argument("--page", action="store_true", help="write the page from what was computed, and compute nothing")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    words = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    words.output.mkdir(parents=True, exist_ok=True)
    rows = compute(words)
    (words.output / "papers.md").write_text(page(rows, words))


if __name__ == "__main__":
    main()
