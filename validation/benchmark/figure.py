# SPDX-License-Identifier: GPL-2.0-or-later
"""Log-log figures of the benchmarks, drawn by `amontons render` from a plot file."""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

from measured_run import PROGRAM, ROOT

sys.path.append(str(ROOT / "docs/examples"))
from shown import keep_picture   # noqa: E402

MARKERS = ("circle", "square", "triangle", "down")
NUMBER = r"[\d.]+(?:e[-+]\d+)?"
MU = "~{\u03bc}_{M}"


def draw(path, title, x_label, y_label, curves, guide=None):
    """PATH.yaml and PATH.png; curves: name -> (x, y), both above 0. guide: the one that is a line, the others being points
    then."""
    series = []
    for number, (name, (x, y)) in enumerate(curves.items()):
        series.append({"label": name, "x": [float(v) for v in x], "y": [float(v) for v in y],
                       "color": 1 + number % 7, "marker": MARKERS[number % len(MARKERS)],
                       "filled": number < 4, "line": "none" if guide else "thin"})
        if name == guide:
            series[-1] |= {"color": 0, "marker": "none", "line": "dashed"}
    plot = {"title": title or "", "x": {"label": x_label, "scale": "log"},
            "y": {"label": y_label, "scale": "log"}, "series": series}
    file = path.with_suffix(".yaml")
    file.write_text(json.dumps(plot, indent=1, ensure_ascii=False) + "\n")
    subprocess.run([str(PROGRAM), "render", str(file), "--overwrite"], check=True, stdout=subprocess.DEVNULL)


def draw_page(page, figures):
    """The figures of a page, from its tables, beside it. figures: name -> (heading that the table stands below, label of x, of y,
    what a row of cells gives: [(curve, x, y)], as they are written)."""
    text = page.read_text()
    for name, (heading, x_label, y_label, of_row) in figures.items():
        if f"({name}.png)" not in text:
            continue
        lines = text[text.index(f"## {heading}"):].split("\n|", 1)[1].split("\n\n")[0].splitlines()
        curves = {}
        for line in lines[2:]:   # below the head
            for curve, *cells in of_row([cell.strip() for cell in line.strip("|").split("|")]):
                if all(re.fullmatch(NUMBER, cell) and float(cell) > 0 for cell in cells):
                    curves.setdefault(curve, []).append([float(cell) for cell in cells])
        with tempfile.TemporaryDirectory() as folder:
            draw(Path(folder, name), None, x_label, y_label, {curve: tuple(zip(*at)) for curve, at in curves.items() if len(at) > 1})
            keep_picture(Path(folder, f"{name}.png"), page.parent / f"{name}.png")


def fitted_exponent(x, y):
    """p of y ~ x^p, by least squares of the logarithms."""
    return float(numpy.polyfit(numpy.log(x), numpy.log(y), 1)[0])
