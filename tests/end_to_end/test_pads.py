# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks on pads as a new user would try them: look at the mesh, run it, read what each pad did, look
at the stresses; designs that cannot be are refused with what is wrong and what is allowed."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from xml.etree import ElementTree

import h5py
import numpy as np
from scipy.integrate import trapezoid
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkProbeFilter
from vtkmodules.vtkFiltersSources import vtkLineSource
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

PROGRAM = os.path.join(os.environ["AMONTONS_BIN"], "amontons")
SOURCE = os.environ["AMONTONS_SOURCE"]
MESHES = os.path.join(SOURCE, "meshes")
ROD, TOP, PADS = (204, 56, 20), (26, 82, 168), ((13, 115, 77), (115, 158, 26))
PRESSURE, MU_STATIC, MU_KINETIC = 0.003, 0.38, 0.1

SCENE = """
title: A block on pads
mesh: {file: %s/pads.geo, set: {n: 4, total_height: 0.5, pad_height: 0.05, fill: 0.6, ends: open,
                                size_contact: 0.025, size_bulk: 0.05}}
material: {young: 1, poisson: 0.34, density: 1, eta1: 1, eta2: 1}
friction: {law: linear-weakening, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}
load: {pressure: 0.003}
rod: {velocity: 1e-5, height: 0.25, width: 0.05}
time: {until: {U: 0.009}}
output: {history: true, fields: {every_U: 4.5e-3}, figures: [slip-map]}
""" % MESHES


def amontons(*words):
    made = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=120)
    return made.returncode, made.stdout, made.stderr


def read_picture(path):
    """[height, width, 3] integers, first row at the top."""
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return values.reshape(height, width, 3)[::-1].astype(int)


def is_color(picture, color):
    return np.all(np.abs(picture - np.array(color)) <= 2, axis=-1)


def extents(picture, color, least=40):
    """[(left, right)] of the runs of this colour on the row that has most of it."""
    mask = is_color(picture, color)
    row = mask[mask.sum(axis=1).argmax()].astype(int)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], row, [0]])))
    return [(a, b) for a, b in zip(edges[::2], edges[1::2]) if b - a >= least]


class Pads(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="amontons_pads_")
        self.scene = os.path.join(self.folder, "pads.yaml")
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(SCENE)

    def tearDown(self):
        shutil.rmtree(self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_scene(self, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        code, out, err = amontons("run", self.scene, "-o", self.path("result"), "--quiet",
                                  "--overwrite", *words)
        self.assertEqual(code, 0, err)
        with open(self.path("result/run.json"), encoding="utf-8") as file:
            return json.load(file)

    # --- before anything is computed ------------------------------------------------------------

    def test_mesh_picture(self):
        """Pads, top and rod in their colours, where the parameters put them, to scale."""
        code, out, err = amontons("info", os.path.join(MESHES, "pads.geo"), "--set", "n=2", "--set",
                                  "fill=0.5", "--set", "ends=open", "--set", "total_height=0.5",
                                  "--picture", self.path("mesh.png"))
        self.assertEqual((code, err), (0, ""))
        self.assertIn("contact_2", out)
        picture = read_picture(self.path("mesh.png"))
        (left, right), = extents(picture, TOP)
        for k, start in enumerate((0.125, 0.625)):
            (a, b), = extents(picture, PADS[k])
            self.assertAlmostEqual((a - left) / (right - left), start, delta=0.01)
            self.assertAlmostEqual((b - a) / (right - left), 0.25, delta=0.01)
        rod = is_color(picture, ROD)
        column = rod[:, rod.sum(axis=0).argmax()]
        self.assertAlmostEqual(column.sum() / (right - left), 0.45, delta=0.02)

    def test_scene_picture(self):
        """A scene draws the mesh it will run, and the rod's strip where it pushes: twice as high up
        it lies that much higher."""
        strips = []
        for height in (0.2, 0.4):
            code, out, err = amontons("info", self.scene, "--set", "mesh.set.n=3", "--set",
                                      f"rod.height={height}", "--picture", self.path("mesh.png"), "--overwrite")
            self.assertEqual((code, err), (0, ""))
            self.assertIn("contact_3", out)
            self.assertNotIn("contact_4 ", out)
            picture = read_picture(self.path("mesh.png"))
            (left, right), = extents(picture, TOP)
            beside = is_color(picture, ROD)[:, left - 9]   # beyond the face's line
            rows = np.flatnonzero(beside)
            strips.append((rows[0] + rows[-1]) / 2 / (right - left))
        self.assertAlmostEqual(strips[0] - strips[1], 0.2, delta=0.01)

    def test_info_refuses(self):
        pads = os.path.join(MESHES, "pads.geo")
        for words, message in (
                ([pads, "--set", "pads=4"], "pads"),
                ([pads, "--set", "n"], "name=value"),
                ([pads, "--set", "n=3", "--picture", self.path("no/such/mesh.png")], "no/such"),
                ([self.folder, "--picture", self.path("mesh.png")], "result folder")):
            code, out, err = amontons("info", *words)
            self.assertNotEqual(code, 0, words)
            self.assertIn(message, err)
        self.assertFalse(os.path.exists(self.path("mesh.png")))

    # --- three designs by hand, one of them wrong -----------------------------------------------

    def check_balance(self, results, n):
        """Pads carry the load; at the peak they hold mu F_N; each between what friction allows."""
        pads = results["pads"]
        self.assertEqual([pad["name"] for pad in pads], [f"contact_{k + 1}" for k in range(n)])
        self.assertAlmostEqual(sum(pad["normal_force_start"] for pad in pads) / PRESSURE, 1, delta=1e-5)
        normal, shear = (np.array([pad[key] for pad in pads])
                         for key in ("normal_force_peak", "shear_peak"))
        self.assertAlmostEqual(normal.sum() / PRESSURE, 1, delta=1e-3)
        self.assertAlmostEqual(shear.sum() / PRESSURE, results["peaks"][-1]["mu"], delta=2e-3)
        self.assertTrue(np.all(shear <= MU_STATIC * normal * (1 + 1e-9)))
        self.assertEqual(sorted(pad["detachment_order"] for pad in pads)[0], 1)
        self.assertEqual(pads[0]["detachment_order"], 1, "the trailing pad goes first")

    def test_four_pads(self):
        run = self.run_scene()
        self.check_balance(run["results"], 4)
        picture = read_picture(self.path("result/figures/slip-map.png"))
        self.assertGreater(is_color(picture, (115, 117, 122)).sum(), 1000, "pads are marked")
        with h5py.File(self.path("result/history.h5")) as history:
            self.assertEqual(history.attrs["pads"].split("\n"), [f"contact_{k}" for k in (1, 2, 3, 4)])
            normal = history["pads/normal_force"][:]
            weight, pad = history["nodes/weight"][:], history["nodes/pad"][:]
            pressure = history["interface/pressure"][:]
            for k in range(4):
                summed = pressure[:, pad == k] @ weight[pad == k]
                np.testing.assert_allclose(normal[:, k], summed, atol=1e-6 * PRESSURE)
            slip = history["pads/slip"][:]
            self.assertTrue(np.all(slip[-1] > 0.5 * 0.009 / 2), "all pads have moved along")

    def stress_across(self, file, left, z):
        """(x, sigma_zz, sigma_xz) along a level cut through the pad that begins at x = left."""
        line, probe = vtkLineSource(), vtkProbeFilter()
        line.SetPoint1(left + 1e-6, z, 0)
        line.SetPoint2(left + 0.2 - 1e-6, z, 0)
        line.SetResolution(400)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(file)
        probe.SetInputConnection(line.GetOutputPort())
        probe.SetSourceConnection(reader.GetOutputPort())
        probe.Update()
        cut = probe.GetOutput()
        stress = vtk_to_numpy(cut.GetPointData().GetArray("stress_elastic"))
        return vtk_to_numpy(cut.GetPoints().GetData())[:, 0], stress[:, 1], stress[:, 2]

    def test_two_tall_pads_with_fillets(self):
        """Free mesh. Any level cut through a pad carries the load and the shear that the floor gives
        it, and its bending moment grows upwards by shear times height, into the root. Roots and edges
        are where stress is largest."""
        run = self.run_scene("mesh.set={n: 2, total_height: 0.5, pad_height: 0.15, fill: 0.4, ends: open, "
                             "fillet: 0.04, size_contact: 0.01, size_bulk: 0.05}")
        self.check_balance(run["results"], 2)
        frames = [(float(item.get("timestep")), item.get("file"))
                  for item in ElementTree.parse(self.path("result/fields.pvd")).iter("DataSet")]
        time, name = max(frame for frame in frames if frame[1].endswith(".vtu"))
        last = self.path("result/" + name)
        with h5py.File(self.path("result/history.h5")) as history:
            row = np.argmin(abs(history["series/time"][:] - time))
            normal, shear = history["pads/normal_force"][row], history["pads/shear"][row]
        self.assertGreater(shear.sum() / normal.sum(), 0.1)
        for k, left in enumerate((0.15, 0.65)):   # pads are 0.2 long
            moments = []
            for z in (0.03, 0.1):
                x, down, across = self.stress_across(last, left, z)
                self.assertAlmostEqual(-trapezoid(down, x) / normal[k], 1, delta=0.02)
                self.assertAlmostEqual(trapezoid(across, x) / shear[k], 1, delta=0.02)
                moments.append(trapezoid(down * (x - left - 0.1), x))
            self.assertAlmostEqual((moments[1] - moments[0]) / (0.07 * shear[k]), 1, delta=0.03)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(last)
        reader.Update()
        x, z = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())[:, :2].T
        mises = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("von_mises"))
        at = np.flatnonzero(z < 0.25)[mises[z < 0.25].argmax()]
        self.assertLess(min(abs(x[at] - side) for side in (0.15, 0.35, 0.65, 0.85)), 0.05)
        self.assertLess(mises[z > 0.45].max(), 0.7 * mises[at])

    def test_wrong_design(self):
        """What is wrong, and what is allowed; nothing is left behind."""
        for setting, message in (
                ("mesh.set.gap=0.2", "do not fit"),
                ("mesh.set.gap=-0.05", "gap must be above 0"),
                ("mesh.set.fillet=0.08", "fillet must be below pad_height = 0.05"),
                ("mesh.set={n: 4, fill: 0.9, pad_height: 0.1, fillet: 0.02}", "half a gap = 0.0166667"),
                ("mesh.set.size_contact=0.2", "half of the shortest pad, which is 0.15 long"),
                ("mesh.set={size_contact: 0.02, refine: 0.1}", "size_contact / refine must be at most half"),
                ("mesh.set.pads=4", "pads")):
            code, out, err = amontons("run", self.scene, "-o", self.path("result"), "--overwrite",
                                      "--set", setting)
            self.assertEqual(code, 2, setting)
            self.assertIn(message, err)
            self.assertFalse(os.path.exists(self.path("result/history.h5")))


if __name__ == "__main__":
    unittest.main()
