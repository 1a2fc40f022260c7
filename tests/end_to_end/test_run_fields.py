# SPDX-License-Identifier: GPL-2.0-or-later
"""One run's fields, history and report against each other, read by VTK, h5py and json.

Stresses are judged by what they must add up to: the mean vertical stress of every level is that of
the load, von Mises that of the components.
"""
import json
import os
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import h5py
import numpy
import vtk
from scipy.integrate import trapezoid
from vtk.util.numpy_support import vtk_to_numpy

PROGRAM = os.path.join(os.environ["AMONTONS_BIN"], "amontons")
SCENE = os.path.join(os.environ["AMONTONS_SOURCE"], "validation", "paper", "fig1.yaml")
CELLS, PRESSURE, POISSON = 10, 0.003, 0.34
MU_STATIC, MU_KINETIC, CRITICAL = 0.38, 0.1, 3.4e-4


def arrays_of(path, reader):
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    points = grid.GetPointData()
    found = {points.GetArrayName(k): vtk_to_numpy(points.GetArray(k)).copy()
             for k in range(points.GetNumberOfArrays())}
    found["points"] = vtk_to_numpy(grid.GetPoints().GetData()).copy()
    found["cells"] = grid.GetNumberOfCells()
    found["time"] = grid.GetFieldData().GetArray("TimeValue").GetValue(0)
    return found


class RunFields(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="amontons_run_")
        cls.folder = os.path.join(cls.place.name, "result")
        settings = ["mesh.set.nx=%d" % CELLS, "mesh.set.nz=%d" % CELLS, "time.until={U: 0.0055}",
                    "output.fields={every_U: 1e-3, at_events: true}", "output.figures=[]",
                    "reduction.cache=false"]
        command = [PROGRAM, "run", SCENE, "-o", cls.folder, "--quiet"]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with h5py.File(os.path.join(cls.folder, "history.h5")) as history:
            cls.series = {group + "/" + name: history[group][name][:].astype(float)
                          for group in ("series", "interface", "nodes", "peaks", "events")
                          for name in history[group]}
            cls.mu_macroscopic = float(history.attrs["mu_macroscopic"])
        with open(os.path.join(cls.folder, "run.json"), encoding="utf-8") as report:
            cls.report = json.load(report)
        cls.frames = []
        entries = xml.etree.ElementTree.parse(os.path.join(cls.folder, "fields.pvd"))
        for entry in entries.iter("DataSet"):
            reader = (vtk.vtkXMLUnstructuredGridReader() if entry.get("file").endswith("vtu")
                      else vtk.vtkXMLPolyDataReader())
            cls.frames.append((float(entry.get("timestep")), entry.get("file"),
                               arrays_of(os.path.join(cls.folder, entry.get("file")), reader)))

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def near(self, found, wanted, tolerance):
        if numpy.size(wanted) == 0:
            return
        scale = numpy.max(numpy.abs(wanted))
        self.assertLessEqual(numpy.max(numpy.abs(found - wanted)), tolerance * scale)

    def row_at(self, time):
        row = int(numpy.argmin(numpy.abs(self.series["series/time"] - time)))
        self.assertAlmostEqual(self.series["series/time"][row], time, delta=1e-9)
        return row

    def bulk(self):
        return [(time, frame) for time, name, frame in self.frames if name.endswith("vtu")]

    def test_frames_are_where_they_were_asked_for(self):
        times = [time for time, name, _ in self.frames if name.endswith("vtu")]
        self.assertEqual(times, [time for time, name, _ in self.frames if name.endswith("vtp")])
        self.assertEqual(times, sorted(set(times)))
        self.assertEqual(times[0], 0)
        for time, _, frame in self.frames:
            self.assertEqual(frame["time"], time)
        all_times = self.series["series/time"]
        for wanted in numpy.arange(1e-3, 5.4e-3, 1e-3) / 1e-5:   # the first step at or after it
            self.assertIn(all_times[all_times >= wanted - 1e-9][0], times)
        rapid = self.series["events/kind"] > 0
        for name in ("events/t_start", "events/t_stop"):
            for time in self.series[name][rapid]:
                if time < all_times[-1]:
                    self.assertIn(time, times)

    def test_interface_is_the_historys(self):
        for time, name, frame in self.frames:
            if not name.endswith("vtp"):
                continue
            row = self.row_at(time)
            self.near(frame["points"][:, 0], self.series["nodes/x"], 1e-15)
            self.assertEqual(frame["cells"], CELLS)
            self.near(frame["pressure"], self.series["interface/pressure"][row], 1e-6)
            self.near(frame["shear"] + 1e-30, self.series["interface/shear"][row] + 1e-30, 1e-6)
            self.near(frame["slip_rate"] + 1e-9,
                      self.series["interface/slip_rate"][row] + 1e-9, 1e-6)
            speed = numpy.abs(frame["slip_rate"])
            touching = frame["pressure"] > 0
            self.near(frame["contact_density"][touching],
                      numpy.maximum(0, 1 - speed / CRITICAL)[touching], 1e-12)
            # Coulomb's law from the stored arrays alone: the friction there is opposes slip.
            limit = (MU_KINETIC + (MU_STATIC - MU_KINETIC) * frame["contact_density"])
            limit *= frame["pressure"]
            self.assertTrue(numpy.all(numpy.abs(frame["shear"]) <= limit * (1 + 1e-9) + 1e-15))
            slips = speed > 1e-12
            self.near(frame["shear"][slips] + 1e-15,
                      (limit * numpy.sign(frame["slip_rate"]))[slips] + 1e-15, 1e-7)

    def test_bulk_meets_the_interface(self):
        for (time, bulk), (_, _, line) in zip(self.bulk(), self.frames[1::2]):
            bottom = numpy.flatnonzero(bulk["points"][:, 1] == 0)
            bottom = bottom[numpy.argsort(bulk["points"][bottom, 0])]
            self.near(bulk["displacement"][bottom, 0], line["displacement_x"], 1e-12)
            self.near(bulk["displacement"][bottom, 1] + 1, line["gap"] + 1, 1e-12)
            row = self.row_at(time)
            self.near(bulk["velocity"][bottom, 0] + 1e-9,
                      self.series["interface/slip_rate"][row] + 1e-9, 1e-6)
            self.assertEqual(bulk["cells"], CELLS * CELLS)

    def test_stresses(self):
        for time, bulk in self.bulk():
            xx, zz, xz = bulk["stress"].T
            self.near(bulk["von_mises"], numpy.sqrt(xx**2 - xx * zz + zz**2 + 3 * xz**2), 1e-9)
        # At rest the load goes through every level: mean of s_zz over x, by the trapezoid rule.
        start = self.frames[0][2]
        self.near(start["stress"], start["stress_elastic"], 1e-6)
        for level in numpy.unique(numpy.round(start["points"][:, 1], 9)):
            on = numpy.flatnonzero(numpy.abs(start["points"][:, 1] - level) < 1e-9)
            on = on[numpy.argsort(start["points"][on, 0])]
            mean = trapezoid(start["stress"][on, 1], start["points"][on, 0])
            self.assertAlmostEqual(mean / -PRESSURE, 1, delta=0.02)

    def test_report_agrees(self):
        report, series = self.report, self.series
        self.assertEqual(report["status"], "done")
        self.assertEqual(len(series["series/time"]), report["steps"]["accepted"] + 1)
        self.assertEqual(sum(size["accepted"] for size in report["step_sizes"]),
                         report["steps"]["accepted"])
        self.assertEqual(report["model"]["contact_nodes"], CELLS + 1)
        self.assertEqual(report["model"]["full_dofs"], 2 * (CELLS + 1) ** 2)
        results = report["results"]
        self.near(numpy.array([peak["U"] for peak in results["peaks"]]), series["peaks/U"], 1e-15)
        self.near(numpy.array([peak["mu"] for peak in results["peaks"]]), series["peaks/mu"], 1e-15)
        self.assertAlmostEqual(results["mu_M"], self.mu_macroscopic, delta=1e-15)
        self.assertEqual(len(results["events"]), len(series["events/kind"]))
        for peak in results["peaks"]:   # a peak is a maximum of the curve
            row = int(numpy.argmin(numpy.abs(series["series/rod_displacement"] - peak["U"])))
            self.assertEqual(series["series/mu"][row], peak["mu"])
        self.assertLess(report["errors"]["moment"], 1e-10)
        # F_N L/2 + F_T z_rod is the moment of the pressure, in frames without motion.
        x, weight = series["nodes/x"], series["nodes/weight"]
        pressure = series["interface/pressure"]
        self.near(pressure[0] @ (weight * x), PRESSURE / 2, 1e-5)
        quiet = numpy.flatnonzero(series["series/max_slip_rate"] < 2e-5)[-1]
        rod = 0.25 * series["series/rod_force"][quiet]
        self.near(pressure[quiet] @ (weight * x), PRESSURE / 2 + rod, 1e-2)
        self.near(pressure @ weight, series["series/normal_force"], 1e-5)


if __name__ == "__main__":
    unittest.main()
