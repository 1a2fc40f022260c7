#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a result beside the same data drawn by matplotlib (docs/examples/redraw.py): one sheet to look at, and of each what can
be measured. Needs python3-matplotlib, python3-h5py, python3-pil and poppler.

    validation/pictures/beside.py RESULT [SHEET.png]

What was asked of them before any was drawn, and who judges it:

    1  letters of 7 to 9 pt at the printed size, sub- and superscripts 5    measured: sizes of fonts in the PDF, whole points
    2  no empty third          measured: largest empty rectangle over the page, of 48 x 48 parts
    3  prints in grey          lightness falls all along the bar (tests/end_to_end/test_render.py); marks differ in shape, by eye
    4  every mark in a legend, or named where it stands   by eye, on the sheet
    5  names of axes have symbol and unit               by eye
    6  no title that was not asked for                  by eye
    7  no larger in bytes than a journal takes (10 MB)  measured
"""
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

SOURCE = Path(__file__).resolve().parents[2]
PROGRAM = SOURCE / "build/bin/amontons"
NAMES = ("force", "slip-map", "contact-density")
PARTS, DPI = 48, 220


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


def main():
    result, sheet = Path(sys.argv[1]), Path(sys.argv[2] if len(sys.argv) > 2 else "beside.png")
    subprocess.run([PROGRAM, "render", result, "--format", "pdf", "--overwrite",
                    *(word for name in NAMES for word in ("--figure", name))], check=True)
    subprocess.run([sys.executable, SOURCE / "docs/examples/redraw.py", result], check=True)
    rows = []
    print(f"{'':28s}   kB   letters, pt   empty")
    for name in NAMES:
        pair = [result / "figures" / f"{name}{end}.pdf" for end in ("", "-redrawn")]
        rows.append([picture(pdf) for pdf in pair])
        for pdf, image in zip(pair, rows[-1]):
            least, most = letters(pdf)
            print(f"{pdf.name:28s} {pdf.stat().st_size / 1e3:5.0f}   {least:.0f} to {most:.0f}        {empty_share(image):.2f}")
    width, height = max(i.width for row in rows for i in row), [max(i.height for i in row) for row in rows]
    page = Image.new("RGB", (2 * width + 40, sum(height) + 40 * len(rows)), "white")
    for k, row in enumerate(rows):
        for side, image in enumerate(row):
            page.paste(image, (side * (width + 40), sum(height[:k]) + 40 * k))
    page.save(sheet)
    print(f"left ours, right matplotlib: {sheet}")


if __name__ == "__main__":
    main()
