# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's page of charts, drawn by amontons' own renderer (validation/chart.c)."""
import subprocess

import numpy as np

from harness import PROGRAMS


def described(chart):
    """What chart.c reads of one chart; what a logarithm cannot show is left out."""
    yield from (chart.title, chart.x_label, chart.y_label,
                f"{int(chart.logarithmic)} {len(chart.curves)}")
    for name, (x, y) in chart.curves.items():
        x, y = np.asarray(x, float), np.asarray(y, float)
        good = np.isfinite(x) & np.isfinite(y) & ((x > 0) & (y > 0) if chart.logarithmic else True)
        yield f"{good.sum()} {name}"
        yield from (f"{a:.17g} {b:.17g}" for a, b in zip(x[good], y[good]))


def draw_page(charts, path):
    text = "\n".join(line for chart in charts for line in described(chart)) + "\n"
    done = subprocess.run([PROGRAMS / "amontons_chart", path], input=text, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
