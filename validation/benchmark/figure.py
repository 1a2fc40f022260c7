# SPDX-License-Identifier: GPL-2.0-or-later
"""Log-log figures of the benchmarks, drawn by `amontons render` from a plot file."""
import json
import subprocess

import numpy

from measured_run import PROGRAM

MARKERS = ("circle", "square", "triangle", "down")


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
    subprocess.run([str(PROGRAM), "render", str(file)], check=True, stdout=subprocess.DEVNULL)


def fitted_exponent(x, y):
    """p of y ~ x^p, by least squares of the logarithms."""
    return float(numpy.polyfit(numpy.log(x), numpy.log(y), 1)[0])
