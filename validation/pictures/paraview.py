#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""One frame of a result by `amontons render --figure field` and by ParaView from the same .vtu, with the same colours, range and
place on the picture: how far apart they are, and both in one PNG.

    validation/pictures/paraview.py RESULT [--of FIELD] [--at U=0.0117] [--pvbatch PROGRAM] [-o both.png]

It needs ParaView (Debian: paraview, python3-paraview, which do not go together with libvtk9-dev: unpack them elsewhere, or use
another machine, and name its pvbatch), python3-vtk9 or ParaView's own VTK, numpy and PIL. Not part of the tests.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

SOURCE = Path(__file__).resolve().parents[2]
FIELDS = {"von_mises": ("von_mises", 0), "stress_xx": ("stress", 0), "stress_zz": ("stress", 1), "stress_xz": ("stress", 2)}
INK = (20, 20, 26)
BESIDE, BELOW, ABOVE = (15, 5), 10, 13   # points that the figure keeps free round the block: left and right, below, above
WIDTH_POINTS = 86 / 25.4 * 72

PARAVIEW = """
from paraview.simple import *
reader = XMLUnstructuredGridReader(FileName=[{path!r}])
warped = WarpByVector(Input=reader)
warped.Vectors = ["POINTS", "displacement"]
warped.ScaleFactor = {factor}
moved = Transform(Input=warped)
moved.Transform.Translate = [{shift}, 0, 0]
view = CreateRenderView(ViewSize=[{width}, {height}])
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
shown = Show(moved, view)
shown.Representation = "Surface"
shown.Ambient, shown.Diffuse, shown.Specular, shown.InterpolateScalarsBeforeMapping = 1, 0, 0, 1
shown.NonlinearSubdivisionLevel = 4
colors = GetColorTransferFunction({name!r})
colors.ColorSpace = "RGB"
colors.RGBPoints = {points}
colors.VectorMode, colors.VectorComponent = "Component", {component}
shown.ColorArrayName = ["POINTS", {name!r}]
shown.LookupTable = colors
shown.SetScalarBarVisibility(view, False)
view.CameraParallelProjection = 1
view.CameraFocalPoint = [{x}, {z}, 0]
view.CameraPosition = [{x}, {z}, 10]
view.CameraViewUp = [0, 1, 0]
view.CameraParallelScale = {half}
SaveScreenshot({out!r}, view, ImageResolution=[{width}, {height}])
"""


def runs(mask):
    """Middles of the runs of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return [(first + last) / 2 for first, last in zip(edges[::2], edges[1::2])]


def nearest_file(result, at):
    """The .vtu at the stored time nearest to `at`, found by the program's own rule: that of the history."""
    import h5py
    found = re.findall(r'timestep="([^"]+)" part="0" name="bulk" file="([^"]+)"', (result / "fields.pvd").read_text())
    times = np.array([float(time) for time, _ in found])
    wanted = float(at[2:])
    if at.startswith("U="):
        with h5py.File(result / "history.h5") as history:
            times = np.interp(times, history["series/time"][:], history["series/rod_displacement"][:])
    return result / found[int(np.abs(times - wanted).argmin())][1]


def read_grid(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    points = reader.GetOutput().GetPointData()
    arrays = {points.GetArrayName(k): vtk_to_numpy(points.GetArray(k)) for k in range(points.GetNumberOfArrays())}
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData()), arrays


def handy(most):
    """The largest of 1, 2 and 5 times a power of ten that is not above."""
    power = 10 ** np.floor(np.log10(most))
    return max(step * power for step in (1, 2, 5) if step * power <= most * (1 + 1e-12))


def bar_range(values):
    """Ends of the colour bar: half a percent of the nodes left out at each end, then whole steps, at most six."""
    ordered = np.sort(values)
    out = int(0.005 * len(ordered))
    low, high = ordered[out], ordered[len(ordered) - 1 - out]
    least = (high - low) / 6
    power = 10 ** np.floor(np.log10(least))
    step = min(k * power for k in (1, 2, 5, 10) if k * power >= least * (1 - 1e-9))
    return np.floor(low / step + 1e-9) * step, np.ceil(high / step - 1e-9) * step


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("result", type=Path)
    parser.add_argument("--of", choices=FIELDS, default="von_mises")
    parser.add_argument("--at", default="U=0")
    parser.add_argument("--pvbatch", default="pvbatch")
    parser.add_argument("-o", "--output", type=Path, default=Path("both.png"))
    words = parser.parse_args()
    program = os.environ.get("AMONTONS_BIN", SOURCE / "build/bin") + "/amontons"
    subprocess.run([program, "render", words.result, "--overwrite", "--figure", "field", "--of", words.of, "--at", words.at],
                   check=True, stdout=subprocess.DEVNULL)
    ours = np.array(Image.open(words.result / f"figures/field-{words.of}.png").convert("RGB")).astype(int)
    path = nearest_file(words.result, words.at)
    position, arrays = read_grid(path)
    name, component = FIELDS[words.of]
    values = arrays[name] if arrays[name].ndim == 1 else arrays[name][:, component]

    # where our frame and our bar are
    ink = np.all(np.abs(ours - INK) <= 2, axis=-1)
    rows, columns = runs(ink.sum(axis=1) > 0.4 * ours.shape[1]), runs(ink.sum(axis=0) > 0.4 * ours.shape[0])
    top, bottom, left, right = (round(place) for place in (rows[0], rows[-1], columns[0], columns[1]))
    middle = round((columns[-2] + columns[-1]) / 2)
    bar = ours[top + 4:bottom - 3, middle][::-1] / 255
    low, high = bar_range(values)
    share = (bottom - np.arange(top + 4, bottom - 3)[::-1] - 0.5) / (bottom - top)
    points = [number for part, color in zip(low + share * (high - low), bar) for number in (part, *color)]

    # the same part of the plane for ParaView
    mean = arrays["displacement"][:, 0].mean()
    moved = arrays["displacement"] - [mean, 0, 0]
    factor = max(1, handy(0.05 * np.ptp(position, axis=0).max() / np.abs(moved).max()))
    place = position + factor * moved
    point = ours.shape[1] / WIDTH_POINTS
    scale = (right - left - sum(BESIDE) * point) / np.ptp(place[:, 0])
    x_low, z_low = place[:, 0].min() - BESIDE[0] * point / scale, place[:, 1].min() - BELOW * point / scale
    size = (right - left) / scale, (bottom - top) / scale
    with tempfile.TemporaryDirectory() as folder:
        script, out = Path(folder, "frame.py"), Path(folder, "frame.png")
        script.write_text(PARAVIEW.format(path=str(path.resolve()), factor=factor, shift=-factor * mean, width=right - left,
                                          height=bottom - top, name=name, points=points, component=component,
                                          x=x_low + size[0] / 2, z=z_low + size[1] / 2, half=size[1] / 2, out=str(out)))
        subprocess.run([words.pvbatch, "--force-offscreen-rendering", script], check=True)
        theirs = np.array(Image.open(out).convert("RGB")).astype(int)
    inside = ours[top:bottom, left:right]
    away = np.abs(inside - theirs).max(axis=-1)
    block = (theirs.min(axis=-1) < 250) & (np.abs(inside[..., None, :] - (bar * 255)[None, None, ::8]).sum(axis=-1).min(axis=-1) < 60)
    print(f"{path.name}, {words.of} from {low:.6g} to {high:.6g}, deformation x {factor:g}: {block.sum()} pixels of the block")
    print(f"colours differ by {np.median(away[block]):g} of 255 in the median, {np.percentile(away[block], 95):g} at 95 %, "
          f"{np.percentile(away[block], 99):g} at 99 % (contour lines and outline are ours alone)")
    gap = np.full((20, right - left, 3), 255)
    Image.fromarray(np.concatenate([inside, gap, theirs]).astype(np.uint8)).save(words.output)
    print(f"ours above, ParaView's below: {words.output}")
    return 0 if np.median(away[block]) <= 3 and np.percentile(away[block], 95) <= 8 else 1


if __name__ == "__main__":
    sys.exit(main())
