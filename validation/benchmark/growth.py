#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How cost grows, beside theory, and where the time goes.

    validation/benchmark/growth.py [--quick] [--only NAME ...] [-o FOLDER]
    validation/benchmark/growth.py --draw validation/benchmark/growth.md      # its figures anew

Set A of the paper. Series: `cells` (n x n cells, n to 400: the reduction of a cold run, and the full
sparse path), `contact` (contact nodes, to 2000, on meshes graded to the contact line), `L`, `P`, `V`
(each over three decades), `sweep` (points a second in 1 and 2 processes), `phases` (where the time
goes at 40, 80 and 160 cells). Times are processor seconds; steps and unknowns are counts. Exponents
are fitted over the upper half of a series, where what grows slower no longer shows. Leaves
growth.md, a .yaml and a .png a series in FOLDER (default results/growth). --quick: short series,
about two minutes."""
import argparse
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

from figure import draw_page, fitted_exponent
from measured_run import PROGRAM, ROOT, commit, markdown_table, run

SCENE = ROOT / "validation/paper/fig1.yaml"
PLAIN = ["output.figures=[]", "output.fields=none", "output.history=false",
         "reduction.cache=false"]
SHORT = 2.0                                    # cpu s
LOOP = ("contact", "certificate", "bulk")      # phases of a stage; `levels of dt` are counted apart
SWEEP = """title: Points a second
scene: {base}
set: {{mesh.set.nx: 20, mesh.set.nz: 20, time.until.U: 0.006, output.history: false,
  output.fields: none, output.figures: []}}
vary:
  load.pressure: [{pressures}]
"""


def mesh_of(**changed):
    mesh = {"nx": 40, "nz": 40, "length": 1, "height": 0.5} | changed
    return "mesh.set={" + ", ".join(f"{key}: {value}" for key, value in mesh.items()) + "}"


def measure(*settings, limit=1800):
    """A run, its phases as if it had always had a processor: the shortest of three where it is
    short, else its wall times by its share. None, with a line that says so: it failed."""
    ended = run(SCENE, PLAIN + list(settings), limit)
    if ended.status != 0:
        print(f"  {settings}: status {ended.status}: {ended.said[-200:]}", flush=True)
        return None
    seen = [ended.phases]
    if ended.seconds < SHORT:
        seen += [run(SCENE, PLAIN + list(settings), limit).phases for _ in range(2)]
    share = min(1, ended.seconds / ended.phases["total"][0]) if len(seen) == 1 else 1
    for name, (_, count) in ended.phases.items():
        ended.phases[name] = (share * min(one[name][0] for one in seen), count)
    return ended


def stage_seconds(ended):
    return sum(ended.phases[name][0] for name in LOOP) / ended.phases["bulk"][1]


def level_seconds(ended):
    return ended.phases["levels of dt"][0] / max(1, ended.phases["levels of dt"][1])


def upper(points):
    return points[-max(3, (len(points) + 1) // 2):]


def exponent_lines(x_name, x, columns, theory):
    """A line a column: its fitted exponent and what theory says."""
    rows = []
    for name, values in columns.items():
        pairs = [(a, b) for a, b in zip(x, values) if b and b > 0]
        if len(pairs) > 1:
            a, b = zip(*upper(pairs))
            rows.append([name, x_name, f"{fitted_exponent(a, b):.2f}", theory.get(name, "")])
    return rows


class Series:
    """A table and its exponents; draw_page draws it."""

    def __init__(self, name, title, x_name, head, theory):
        self.name, self.title, self.x_name, self.head, self.theory = name, title, x_name, head, theory
        self.rows, self.x, self.columns = [], [], {}

    def add(self, x, cells, **values):
        self.x.append(x)
        self.rows.append(cells)
        for name, value in values.items():
            name = name.replace("_", " ")
            self.columns.setdefault(name, [None] * (len(self.x) - 1)).append(value)
        for column in self.columns.values():
            column += [None] * (len(self.x) - len(column))
        print(f"{self.name}: " + "  ".join(str(cell) for cell in cells), flush=True)

    def write(self):
        """Its part of the page."""
        lines = exponent_lines(self.x_name, self.x, self.columns, self.theory)
        return (f"### {self.title}\n\n{markdown_table(self.head, self.rows)}\n\n"
                + markdown_table(["what", "in", "exponent", "theory"], lines)
                + f"\n\n![{self.title}](growth-{self.name}.png)\n")


def cells_series(quick):
    series = Series(
        "cells", "Cells along the block (n x n, half as high as long)", "n",
        ["n", "unknowns", "reduced to", "reduction, s", "MB", "stage, ms", "factor, s",
         "full path: MB", "stage, ms", "factor, s", "auto takes"],
        {"reduction s": "4: N m^2 of dense products on N ~ n^2 unknowns, m ~ n of the interface",
         "reduction MB": "3: N m numbers", "reduced stage s": "2: dense, (m + r)^2",
         "reduced factor s": "3: dense, r^3", "full stage s": "2 log n: the factor's entries",
         "full factor s": "3: nested dissection, N^1.5", "full MB": "2 log n a level"})
    for n in (10, 20, 40) if quick else (20, 40, 80, 160, 240, 320, 400):
        mesh, duration = mesh_of(nx=n, nz=n), 200 if n <= 80 else 20
        full = measure(mesh, "reduction.use=never", f"time.until.t={duration}")
        reduced = n <= REDUCED_MAX and measure(mesh, "reduction.use=always",
                                                 f"time.until.t={duration}")
        auto = measure(mesh, "time.until.t=1e-3") if n <= 160 else None
        took = "" if not auto else "reduced" if auto.report["model"]["reduced_dofs"] \
            < auto.report["model"]["full_dofs"] else "full"
        cells, values = [n, full.report["model"]["full_dofs"] if full else ""], {}
        if reduced:
            spent = reduced.phases["assemble, reduce"][0]
            cells += [reduced.report["model"]["reduced_dofs"], f"{spent:.2f}",
                      f"{reduced.memory:.0f}", f"{1e3 * stage_seconds(reduced):.3f}",
                      f"{level_seconds(reduced):.4f}"]
            values = {"reduction_s": spent, "reduction_MB": reduced.memory,
                      "reduced_stage_s": stage_seconds(reduced),
                      "reduced_factor_s": level_seconds(reduced)}
        else:
            cells += ["not tried"] + [""] * 4
        if full:
            cells += [f"{full.memory:.0f}", f"{1e3 * stage_seconds(full):.2f}",
                      f"{level_seconds(full):.3f}"]
            values |= {"full_MB": full.memory, "full_stage_s": stage_seconds(full),
                       "full_factor_s": level_seconds(full)}
        else:
            cells += [""] * 3
        series.add(n, cells + [took], **values)
    return series


REDUCED_MAX = 320      # cells; 400 would take a minute and 5 GB


def contact_series(quick):
    series = Series(
        "contact", "Contact nodes (10 rows of cells, the lowest a quarter of the highest)",
        "contact nodes",
        ["contact nodes", "unknowns", "MB", "stage, ms", "Newton steps a stage", "factor, s",
         "auto takes"],
        {"stage s": "2: S v of the dense interface", "factor s": "3: the dense S of a level",
         "MB": "2: S of each level"})
    for nodes in (50, 100, 200) if quick else (125, 250, 500, 1000, 2000):
        ended = measure(mesh_of(nx=nodes - 1, nz=10, grade_z=4), "time.until.t=60")
        if ended:
            model = ended.report["model"]
            newtons = ended.phases["contact"][1] / ended.phases["bulk"][1]
            series.add(nodes, [nodes, model["full_dofs"], f"{ended.memory:.0f}",
                               f"{1e3 * stage_seconds(ended):.2f}", f"{newtons:.1f}",
                               f"{level_seconds(ended):.4f}",
                               "reduced" if model["reduced_dofs"] < model["full_dofs"] else "full"],
                       stage_s=stage_seconds(ended), factor_s=level_seconds(ended),
                       MB=ended.memory)
    return series


def parameter_series(name, title, values, settings, theory):
    """Steps of a run as a parameter of the scene changes."""
    series = Series(name, title, name, [name, "steps", "repeated", "Newton steps a stage",
                                        "cpu s", "mu_M"], theory)
    for value in values:
        ended = measure(*settings(value))
        if ended:
            steps, mu = ended.report["steps"], ended.report["results"]["mu_M"]
            series.add(value, [f"{value:g}", steps["accepted"], steps["rejected"],
                               f"{ended.phases['contact'][1] / ended.phases['bulk'][1]:.1f}",
                               f"{ended.seconds:.2f}", "" if mu is None else f"{mu:.4f}"],
                       steps=steps["accepted"], cpu_s=ended.seconds)
    return series


def length_series(quick):
    # P L stays, so that mu_M does; U grows with the slip, P H.
    return parameter_series(
        "L", "Length of the block, P L = 0.003", (0.25, 1, 4) if quick else
        (0.1, 0.3, 1, 3, 10, 30, 100),
        lambda L: [mesh_of(length=L, height=L / 2), f"load.pressure={0.003 / L}",
                   "rod.height=0", "rod.width=0", "time.until.U=0.006"],
        {"steps": "0 while viscosity rules (L < 1); waves of a longer block take longer, and more "
                  "of them pass"})


def pressure_series(quick):
    # Slip at which the block goes is mu P H / E.
    return parameter_series(
        "P", "Pressure, the rod's way 2 P", (1e-3, 3e-3, 1e-2) if quick else
        (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1),
        lambda P: [mesh_of(), f"load.pressure={P}", f"time.until.U={2 * P}"],
        {"steps": "0 for the same number of slips; the time to sliding grows as P"})


def velocity_series(quick):
    return parameter_series(
        "V", "Speed of the rod, to U = 0.006", (1e-6, 1e-5, 1e-4) if quick else
        (1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4),
        lambda V: [mesh_of(), f"rod.velocity={V}", "time.until.U=0.006"],
        {"steps": "0: cost must not grow as V falls"})


def sweep_rates(quick):
    """Points a second of a sweep, after the shape is in the cache."""
    count = 8 if quick else 16
    pressures = ", ".join(f"{0.002 + 0.0002 * k:.4f}" for k in range(count))
    rows, rates = [], {}
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder, "study.yaml")
        study.write_text(SWEEP.format(base=SCENE, pressures=pressures))
        environment = {**os.environ, "AMONTONS_CACHE": f"{folder}/cache"}
        for turn, processes in enumerate((1, 1, 2, 1, 2)):
            before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
            subprocess.run([str(PROGRAM), "sweep", study, "-j", str(processes), "--quiet", "-o",
                            f"{folder}/{turn}"], env=environment, check=True,
                           stdout=subprocess.DEVNULL)
            wall = time.monotonic() - started
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            if turn > 0:   # the first filled the cache
                rates.setdefault(processes, []).append((count / wall, used / count))
    for processes, found in rates.items():
        best = max(rate for rate, _ in found)
        rows.append([processes, f"{best:.1f}", f"{1e3 * min(used for _, used in found):.0f}"])
    print("sweep:", rows, flush=True)
    return ("### Sweep points a second\n\n20x20 cells to U = 0.006, the shape cached; the better of "
            "two turns, of wall time.\n\n"
            + markdown_table(["processes", "points a second", "cpu ms a point"], rows) + "\n")


def phase_table(quick):
    """Where a cold run to U = 0.006 spends its time."""
    rows = []
    for n in (20, 40) if quick else (40, 80, 160):
        ended = measure(mesh_of(nx=n, nz=n), "time.until.U=0.006")
        if ended:
            total = ended.phases["total"][0]
            for name, (seconds, count) in ended.phases.items():
                if name != "total":
                    rows.append([f"{n}x{n}", name, f"{seconds:.4f}", f"{100 * seconds / total:.1f}",
                                 count, f"{1e6 * seconds / max(1, count):.1f}"])
            rows.append([f"{n}x{n}", "total", f"{total:.3f}", "100",
                         ended.report["steps"]["accepted"], ""])
            print(f"phases: {n}x{n} {total:.3f} s", flush=True)
    return ("### Where the time goes\n\nCold runs to U = 0.006, processor seconds; relaxing is "
            "inside the others.\n\n"
            + markdown_table(["mesh", "phase", "s", "%", "count", "us each"], rows) + "\n")


SERIES = {"cells": cells_series, "contact": contact_series, "L": length_series,
          "P": pressure_series, "V": velocity_series}
TABLES = {"sweep": sweep_rates, "phases": phase_table}


def over_first(heading, x_label, y_label, columns):
    """Columns (the first is 0) over the first, each under its name; in ms: as seconds."""
    def of_row(row):
        return [(name, row[0], row[k] if not milli or row[k] == "" else f"{float(row[k]) / 1e3:g}") for name, k, milli in columns]
    return heading, x_label, y_label, of_row


FIGURES = {
    "growth-cells": over_first("Cells along the block", "cells along the block ~{n}", "time (s), memory (MB)", (
        ("reduction (s)", 3, False), ("reduction (MB)", 4, False), ("reduced stage (s)", 5, True), ("reduced factor (s)", 6, False),
        ("full path (MB)", 7, False), ("full stage (s)", 8, True), ("full factor (s)", 9, False))),
    "growth-contact": over_first("Contact nodes", "contact nodes", "time (s), memory (MB)", (
        ("stage (s)", 3, True), ("factor (s)", 5, False), ("memory (MB)", 2, False))),
    **{f"growth-{name}": over_first(heading, label, "steps, time (s)", (("steps", 1, False), ("processor time (s)", 4, False)))
       for name, heading, label in (("L", "Length of the block", "length ~{L} / ~{L}_{0}"),
                                    ("P", "Pressure, the rod's way", "pressure ~{P}_{ext} / ~{E}"),
                                    ("V", "Speed of the rod", "rod velocity ~{V} / (~{L}_{0} / ~{t}_{0})"))},
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/growth")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="*", default=[*SERIES, *TABLES],
                        choices=[*SERIES, *TABLES])
    parser.add_argument("--draw", type=Path, help="the figures of this growth.md anew, from its tables; nothing is computed")
    options = parser.parse_args()
    if options.draw:
        draw_page(options.draw, FIGURES)
        return
    options.output.mkdir(parents=True, exist_ok=True)
    parts = [f"## How cost grows\n\nversion {commit()}; set A of the paper, Q4; processor time.\n"]
    for name in options.only:
        if name in SERIES:
            parts.append(SERIES[name](options.quick).write())
        else:
            parts.append(TABLES[name](options.quick))
        (options.output / "growth.md").write_text("\n".join(parts))
    draw_page(options.output / "growth.md", FIGURES)
    print(f"{options.output}/growth.md")


if __name__ == "__main__":
    main()
