#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a result, or of a sweep, beside the same data drawn by matplotlib (docs/examples/redraw.py; of a sweep here): one sheet to
look at, both in colour, in grey print and as an eye without green cones sees them; and of each what can be measured. Needs python3-matplotlib, python3-h5py, python3-pil and poppler. What a stranger said of the
sheets stands in README.md.

    validation/pictures/beside.py RESULT [SHEET.png]
    validation/pictures/beside.py SWEEP [SHEET.png]

What was asked of them before any was drawn, and who judges it:

    1  letters of 7 to 9 pt at the printed size, sub- and superscripts 5    measured: sizes of fonts in the PDF, whole points
    2  no empty third          measured: largest empty rectangle over the page, of 48 x 48 parts
    3  prints in grey          lightness falls all along the bar (tests/end_to_end/test_render.py); curves differ in mark or lightness: counted
       eyes without green      as they see it, on the sheet
    4  every mark in a legend, or named where it stands   by eye, on the sheet
    5  names of axes have symbol and unit               by eye
    6  no title that was not asked for                  by eye
    7  no larger in bytes than a journal takes (10 MB)  measured
"""
import json
import re
import subprocess
import sys
from pathlib import Path

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

SOURCE = Path(__file__).resolve().parents[2]
PROGRAM = SOURCE / "build/bin/amontons"
NAMES = ("force", "slip-map", "contact-density")
PARTS, DPI = 48, 220
# Linear RGB as an eye without green cones sees it: Machado, Oliveira, Fernandes, IEEE Trans. Vis. Comput. Graph. 15, 1291 (2009).
WITHOUT_GREEN = np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]])
WIDTH = 86 / 25.4   # inches
plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.5, "lines.linewidth": 0.8, "savefig.dpi": 600})


def picture(pdf):
    stem = pdf.with_suffix("")
    subprocess.run(["pdftoppm", "-r", str(DPI), "-png", "-singlefile", pdf, f"{stem}-seen"], check=True)
    return Image.open(f"{stem}-seen.png").convert("RGB")


def letters(pdf):
    """Least and largest size of words, points."""
    boxes = subprocess.run(["pdftohtml", "-xml", "-stdout", "-i", "-zoom", "1", pdf], capture_output=True, text=True, check=True).stdout
    sizes = [float(size) for size in re.findall(r'<fontspec [^>]*size="([\d.]+)"', boxes)]
    return (min(sizes), max(sizes)) if sizes else (np.nan, np.nan)


def empty_share(image):
    """The largest rectangle without a mark, over the page."""
    pixels = np.asarray(image.convert("L"))
    rows, columns = (np.linspace(0, size, PARTS + 1).astype(int) for size in pixels.shape)
    free = [[pixels[rows[i]:rows[i + 1], columns[k]:columns[k + 1]].min() > 240 for k in range(PARTS)] for i in range(PARTS)]
    best, above = 0, np.zeros(PARTS, int)
    for line in free:
        above = np.where(line, above + 1, 0)
        for first in range(PARTS):
            for last in range(first, PARTS):
                best = max(best, (last - first + 1) * above[first:last + 1].min())
    return best / PARTS**2


def views(image):
    """In colour, in grey, and without green cones."""
    part = np.asarray(image, float) / 255
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ WITHOUT_GREEN.T, 0, 1)
    seen = np.where(seen <= 0.0031308, 12.92 * seen, 1.055 * seen ** (1 / 2.4) - 0.055)
    return [image, image.convert("L").convert("RGB"), Image.fromarray(np.uint8(np.round(255 * seen)))]


def lightness():
    """Of the program's colours of curves, CIELAB."""
    table = (SOURCE / "render/plot/marks.c").read_text().partition("COLORS[PLOT_COLORS] = ")[2].partition(";")[0]
    parts = np.array(re.findall(r"\{([\d.]+)f, ([\d.]+)f, ([\d.]+)f, 1\}", table), float)
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return 116 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16


def told_in_grey(description):
    """Of a plot: how many of its curves with a name differ from each other in mark or line, or by 15 of 100 in lightness."""
    if not description.exists():
        return ""
    curves = [one for one in json.loads(description.read_text()).get("series", []) if one["label"]]
    marks, light = [(one["marker"], one.get("filled", True), one["line"]) for one in curves], lightness()
    alike = [any(marks[i] == marks[k] and abs(light[curves[i]["color"]] - light[curves[k]["color"]]) < 15 for k in range(len(curves)) if k != i)
             for i in range(len(curves))]
    return f"{alike.count(False)} of {len(curves)}"


def values(folder, numbers):
    """A list of a plot's description, or the column of a table that it names."""
    if not isinstance(numbers, str):
        return np.array([np.nan if number is None else number for number in numbers], float)
    path, name = numbers.split(":")
    with h5py.File(folder / path) as file:
        return file[name][:]


def math(words):
    """Our marks of symbols as matplotlib's."""
    return re.sub(r"~\{([^}]*)\}(?:_\{([^}]*)\})?", lambda found: f"${found[1]}" + (f"_{{\\rm {found[2]}}}" if found[2] else "") + "$", words or "")


def redraw_plot(description):
    """The same curves or map with matplotlib's defaults and a journal's sizes."""
    plot, folder = json.loads(description.read_text()), description.parent
    figure, axes = plt.subplots(figsize=(WIDTH, 0.75 * WIDTH))
    for name in ("x", "y"):
        axis = plot.get(name, {})
        getattr(axes, f"set_{name}label")(math(axis.get("label")))
        getattr(axes, f"set_{name}scale")(axis.get("scale", "linear"))
    if "map" in plot:
        x, y, value = (values(folder, plot["map"][name]) for name in ("x", "y", "value"))
        grid = [np.unique(places) for places in (x, y)]
        table = np.full((len(grid[1]), len(grid[0])), np.nan)
        table[np.searchsorted(grid[1], y), np.searchsorted(grid[0], x)] = value
        figure.colorbar(axes.pcolormesh(*grid, table, shading="nearest"), label=math(plot["color"]["label"]))
        if "contour" in plot["map"]:
            lines = np.full(table.shape, np.nan)
            lines[np.searchsorted(grid[1], y), np.searchsorted(grid[0], x)] = values(folder, plot["map"]["contour"])
            axes.clabel(axes.contour(*grid, lines, colors="black", linewidths=0.6))
    names = plot.get("y", {}).get("names")
    for series in plot.get("series", []):
        x, y = values(folder, series["x"]), values(folder, series["y"])
        style = {"ms": 4, "ls": "-" if series["line"] in ("thin", "solid") else "", "mfc": None if series["filled"] else "white"}
        bars = (values(folder, series["high"]) - values(folder, series["low"])) / 2 if "low" in series else None
        axes.errorbar(x, y, yerr=None if names else bars, xerr=bars if names else None, marker="" if series["marker"] == "none" else "o",
                      label=math(series["label"]) or None, capsize=2, **style)
    if names:
        axes.set_yticks(range(1, len(names) + 1), names)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    path = folder / f"{description.stem}-redrawn.pdf"
    figure.savefig(path, bbox_inches="tight")
    plt.close(figure)


def draw(result):
    """Names of what was drawn in both ways."""
    if (result / "sweep.h5").exists():
        subprocess.run([PROGRAM, "render", result, "--format", "pdf", "--overwrite"], check=True)
        plots = sorted(path for path in (result / "figures").glob("*.json") if "panels" not in json.loads(path.read_text()))
        for path in plots:
            redraw_plot(path)
        return [path.stem for path in plots]
    subprocess.run([PROGRAM, "render", result, "--format", "pdf", "--overwrite",
                    *(word for name in NAMES for word in ("--figure", name))], check=True)
    subprocess.run([sys.executable, SOURCE / "docs/examples/redraw.py", result], check=True)
    return NAMES


def main():
    result, sheet = Path(sys.argv[1]), Path(sys.argv[2] if len(sys.argv) > 2 else "beside.png")
    names = draw(result)
    rows = []
    print(f"{'':28s}   kB   letters, pt   empty   told in grey")
    for name in names:
        pair = [result / "figures" / f"{name}{end}.pdf" for end in ("", "-redrawn")]
        drawn = [picture(pdf) for pdf in pair]
        rows.append([view for image in drawn for view in views(image)])
        for pdf, image in zip(pair, drawn):
            least, most = letters(pdf)
            told = told_in_grey(pdf.with_suffix(".json")) if pdf is pair[0] else ""
            print(f"{pdf.name:28s} {pdf.stat().st_size / 1e3:5.0f}   {least:.0f} to {most:.0f}        {empty_share(image):.2f}    {told}")
    width, height = max(i.width for row in rows for i in row), [max(i.height for i in row) for row in rows]
    page = Image.new("RGB", (6 * (width + 40), sum(height) + 40 * len(rows)), "white")
    for k, row in enumerate(rows):
        for side, image in enumerate(row):
            page.paste(image, (side * (width + 40), sum(height[:k]) + 40 * k))
    page.save(sheet)
    print(f"left ours, right matplotlib, each in colour, in grey and without green: {sheet}")


if __name__ == "__main__":
    main()
