#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What print needed, point by point, before (pictures that are kept, drawn by the program of commit 9ed9d3f2) and now.

    validation/pictures/before_after.py [-o FOLDER] [--program PROGRAM]      # computes the results, draws after/, lists all in README.md
    validation/pictures/before_after.py --before OLD/build/bin/amontons      # draws before/ too; times in pairs and sizes of files in README.md

Some five minutes of processor time for the results, which stay in FOLDER (default results/pictures) and are not computed again.
Pictures are as large as print shows them at 220 dots per inch. Times: processor time from a program's start to its end, median of
the ratios of --repeats pairs. Needs python3-pil, python3-h5py, poppler-utils, and chromium for the page.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path.append(str(SOURCE / "validation/benchmark"))
from pictures import processor_time   # noqa: E402

DPI, COLORS = 220, 128
MAP = "{x: load.pressure, y: mesh.set.length, color: mu_M, contours: l_c, name: map}"
BLOCK = SOURCE / "docs/examples/block.yaml"
FIELDS = "output.fields={every_U: 1e-3, at_events: true}"
SOFT = """title: A block on a soft layer
units: normalised
mesh: {file: %s/meshes/layers.geo, set: {layer: 0.1}}
materials: {layer: {young: 0.1}}
material: {young: 1, poisson: 0.34, density: 1, eta1: 1, eta2: 1}
friction: {mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}
load: {pressure: 0.006}
rod: {velocity: 1e-5, height: 0.1, width: 0.05}
time: {until: {U: 0.02}}
output: {figures: []}
""" % SOURCE
LARGE = """title: mu_M over pressure and length
scene: %s
keep: table
set: {mesh.set.nx: 16, mesh.set.nz: 8, mesh.set.height: = 0.5 * mesh.set.length, rod.height: = 0.5 * mesh.set.height,
      rod.width: = 0.1 * mesh.set.height, time.until.U: = 3 * load.pressure * mesh.set.length}
vary:
  mesh.set.length: {log: [0.25, 4], points: 60}
  load.pressure: {log: [1e-3, 2e-2], points: 60}
plot: {x: load.pressure, y: mesh.set.length, color: mu_M, contours: l_c}
""" % BLOCK
# Results: what makes each.
RESULTS = {
    "fig1": ("run", SOURCE / "validation/paper/fig1.yaml"),
    "slow": ("run", SOURCE / "validation/paper/fig1.yaml", "--set", "output.fields=film", "output.window={from_U: 0.0116, to_U: 0.0118}",
             "output.figures=[]"),
    "many": ("run", BLOCK, "--set", "time.until.U=0.5", "output.figures=[]"),
    "pads": ("run", SOURCE / "validation/pads/pads.yaml", "--set", "time.until.U=0.03", FIELDS),
    "soft": ("run", "soft.yaml", "--set", FIELDS),
    "soft-pads": ("run", SOURCE / "validation/pads/pads.yaml", "--set", "mesh.set.pad_height=0.025", "mesh.set.fill=0.4", "load.pressure=0.002",
                  "materials={pads: {young: 0.05}}", "time.until.U=0.01", "output.figures=[]", FIELDS),
    "map": ("sweep", SOURCE / "docs/examples/map.yaml", "-j", "2"),
    "large": ("sweep", "large.yaml", "-j", "2"),
    "start": ("run", SOURCE / "validation/paper/fig1.yaml", "--set", "mesh.set.nx=20", "mesh.set.nz=10", "time.until.U=0.006",
              "output.fields=none", "output.figures=[]"),
}


class Case:
    """A point: words, then how each program is called and what it leaves; `now`: options that the old one has not."""

    def __init__(self, name, point, words, made, now=(), before=()):
        self.name, self.point, self.words, self.made, self.now, self.before = name, point, words, made, now, before


def render(name, point, result, figure, *words, made=None, now=(), before=()):
    return Case(name, point, ("render", result, "--figure", figure, *words), f"{result}/figures/{made or figure}.png", now, before)


def plotted(name, point, result, plot):
    made = re.search(r"name: ([\w-]+)", plot)
    return Case(name, point, ("render", result, "--plot", plot), f"{result}/figures/{made[1]}.png")


CASES = (
    Case("film", "**Film**: at this moment of the sliding the block stood still, and gaped over a contact that had closed. `output: {fields: film}` "
         "stores a field for each frame", ("film", "--from", "U=0.01165", "--to", "U=0.01171", "--seconds", "4", "--fps", "5", "--size", "960x540", "-o", "frames/", "--quiet"),
         "frames/frame-0012.png", now=("slow",), before=("fig1",)),
    render("slip-map", "**Slip map**: a figure was named that nobody asked for, and the title of the scene was burnt in; stick was as grey as slow slip. In a PDF of two columns it had 169 dots per inch along U: now 600", "fig1", "slip-map"),
    render("many", "280 slidings were one dark band. The last twenty are shown, and the figure says so; `--pixels mean` shows all of them as a mean", "many", "slip-map"),
    render("many-mean", "All of them now, `--pixels mean --from U=0 --to U=0.5`", "many", "slip-map", now=("--pixels", "mean", "--from", "U=0", "--to", "U=0.5"), before=None),
    render("force", "**Force**: half of the panel was kept for the inset, mu_M stood away from its line, circles had no legend", "fig1", "force"),
    render("force-pads", "Without rapid precursors nothing is enlarged, and the figure is lower", "pads", "force"),
    render("force-wide", "Two columns wide (178 mm) it was 147 mm tall: now 113 with what it enlarges, or as `--height` says", "fig1", "force", "--width", "178"),
    render("pads-field", "**Fields**: outlines of soft pads crossed, and the block reached through the floor; deformation is magnified as far as no element folds",
           "soft-pads", "field"),
    render("soft-field", "The rod lay over the soft layer, the block floated over its floor", "soft", "field"),
    render("rod-field", "The singularity at the rod took more of the scale of colours: one percent of the area at each end is left out, or as `--limits` says", "fig1", "field", "--at", "U=0.0114"),
    plotted("map", "**Map**: lines of l_c in stairs; \"length\" without symbol and unit", "map", MAP),
    plotted("large", "Marks stood out from the colours of a large map (3600 runs): thin rings, a legend entry for what they say. l_c falls on nodes: of 16 cells lines stay rough", "large", MAP),
    plotted("curves", "**Sweep plots**: two meanings had one mark, colours differed alone", "map",
            "{x: = load.pressure * mesh.set.length, y: mu_M, series: mesh.set.length, log: x, name: collapse}"),
    Case("ranking", "Axis \"n\"; dashed lines in no legend", ("sweep", SOURCE / "docs/examples/pads.yaml", "-o", "ranked", "-j", "2", "--quiet"),
         "ranked/figures/ranking.png"),
    Case("mesh", "**Mesh picture**: regions were not shown", ("info", SOURCE / "meshes/layers.geo", "--picture", "mesh.png", "--overwrite"), "mesh.png"),
    Case("page", "**The page** of a run without mu_M told of peaks \"that count\", \"for mu_M\" (here 271 are written into a run.json)", ("report", "start", "--overwrite"), "start/report.html"),
)


def compute(program, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "soft.yaml").write_text(SOFT)
    (folder / "large.yaml").write_text(LARGE)
    for name, words in RESULTS.items():
        if not any((folder / name / left).exists() for left in ("run.json", "sweep.h5")):
            subprocess.run([program, *map(str, words), "-o", name, "--quiet"], cwd=folder, check=False)   # 1: points without mu_M
    run = json.loads((folder / "start/run.json").read_text())
    run["results"] |= {"mu_M": None, "mu_M_known_to": None, "mu_M_peaks": 271,
                       "mu_M_is": "none: what slidings of the whole block there were belong to the start or run-in"}
    (folder / "start/run.json").write_text(json.dumps(run, indent=2))


def page_picture(page, made):
    """The numbers of a page, as a browser shows them."""
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=760,800", f"--screenshot={made}",
                    f"file://{page}"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    picture = Image.open(made)
    picture.crop((0, 290, picture.width, picture.height)).save(made)


def keep(made, kept):
    """As large as in print."""
    picture = Image.open(made)
    dpi = picture.info.get("dpi", (DPI,))[0]
    picture = picture.convert("RGB")
    if dpi > 1.1 * DPI:
        picture = picture.resize((round(picture.width * DPI / dpi), round(picture.height * DPI / dpi)), Image.LANCZOS)
    picture.quantize(COLORS, kmeans=2, dither=Image.Dither.NONE).save(kept, optimize=True)


def draw(case, program, folder, old):
    for made in ("frames", "ranked"):
        shutil.rmtree(folder / made, ignore_errors=True)
    words = [*map(str, case.words), *(case.before if old else case.now)]
    if words[0] == "render":
        words.append("--overwrite")
    subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    made = folder / case.made
    if made.suffix == ".html":
        page_picture(made, folder / "page.png")
        made = folder / "page.png"
    kept = HERE / ("before" if old else "after") / f"{case.name}.png"
    kept.parent.mkdir(exist_ok=True)
    keep(made, kept)


# What is timed: words after `render`, of a page; the file.
TIMED = (("force curve", ("fig1", "--figure", "force"), "force"), ("slip map", ("fig1", "--figure", "slip-map"), "slip-map"),
         ("contact density", ("fig1", "--figure", "contact-density"), "contact-density"),
         ("these three", ("fig1", *(word for name in ("force", "slip-map", "contact-density") for word in ("--figure", name))), None),
         ("slip map of 73 909 steps, 280 slidings", ("many", "--figure", "slip-map"), "slip-map"), ("field of 80 x 80 elements", ("fig1", "--figure", "field"), "field"),
         ("map of 56 runs with lines", ("map", "--plot", MAP), "map"), ("map of 3600 runs with lines", ("large", "--plot", MAP), "map"),
         ("seven curves", ("map", "--plot", "{x: load.pressure, y: mu_M, series: mesh.set.length, log: x, name: series}"), "series"))


def timed(programs, folder, words, repeats):
    """Least time of each in seconds, and the median of the ratios, now over before."""
    os.chdir(folder)
    pairs = [[processor_time([program, "render", *words, "--overwrite"]) for program in programs] for _ in range(repeats)]
    return [min(column) for column in zip(*pairs)], statistics.median(now / before for before, now in pairs)


def measured(options):
    """A table of times and sizes."""
    programs, lines = [options.before.resolve(), options.program.resolve()], []
    for name, words, file in TIMED:
        for ending in ("png", "pdf"):
            (before, now), ratio = timed(programs, options.output.resolve(), (*words, "--format", ending), options.repeats)
            sizes = []
            for program in programs if file else ():
                processor_time([program, "render", *words, "--format", ending, "--overwrite"])
                sizes.append(f"{Path(words[0], 'figures', f'{file}.{ending}').stat().st_size / 1e3:.0f}")
            lines.append(f"| {name}, {ending.upper()} | {before:.3f} | {now:.3f} | {ratio:.2f} | {' | '.join(sizes or [' ', ' '])} |")
            print(lines[-1], flush=True)
    return "\n".join(["| picture | before, s | now, s | now over before | before, kB | now, kB |", "|---|---|---|---|---|---|", *lines])


def write_page(table):
    """The part of README.md below its mark; without a new table the old one stays."""
    page = HERE / "README.md"
    head, mark, rest = page.read_text().partition("<!-- before_after.py -->\n")
    old = rest.partition("<!-- measured -->\n")[2]
    rows = [f"| {case.point} | {'' if case.before is None else f'![before](before/{case.name}.png)'} | ![now](after/{case.name}.png) |" for case in CASES]
    page.write_text(head + mark + "\n".join(["| found on real results | before | now |", "|---|---|---|", *rows])
                    + "\n\n<!-- measured -->\n" + (table + "\n" if table else old))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("-o", "--output", type=Path, default=SOURCE / "results/pictures")
    parser.add_argument("--program", type=Path, default=SOURCE / "build/bin/amontons")
    parser.add_argument("--before", type=Path)
    parser.add_argument("--only", nargs="*", help="these pictures, and no times")
    parser.add_argument("--repeats", type=int, default=7)
    options = parser.parse_args()
    compute(options.program.resolve(), options.output)
    for case in CASES:
        if options.only and case.name not in options.only:
            continue
        for program, old in ((options.before if case.before is not None else None, True), (options.program, False)):
            if program:
                draw(case, program.resolve(), options.output, old)
        print(case.name, flush=True)
    if not options.only:
        write_page(measured(options) if options.before else None)


if __name__ == "__main__":
    main()
