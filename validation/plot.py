# SPDX-License-Identifier: GPL-2.0-or-later
"""Charts, drawn by amontons' own renderer (validation/chart.c)."""
import subprocess

import numpy as np

from harness import PROGRAMS


def draw(chart, path):
    lines = [chart.title, chart.x_label, chart.y_label, "1" if chart.logarithmic else "0"]
    for name, (x, y) in chart.curves.items():
        x, y = np.asarray(x, float), np.asarray(y, float)
        good = np.isfinite(x) & np.isfinite(y) & ((x > 0) & (y > 0) if chart.logarithmic else True)
        lines.append(f"{good.sum()} {name}")
        lines += [f"{a:.17g} {b:.17g}" for a, b in zip(x[good], y[good])]
    done = subprocess.run([PROGRAMS / "amontons_chart", path], input="\n".join(lines) + "\n",
                          capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
