# SPDX-License-Identifier: GPL-2.0-or-later
"""A block in space: what run.json and the recorders say, worked out again from the history, node by node."""
import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
SETTINGS = [f"mesh.file={SOURCE}/meshes/block3d.geo", "rod.height=0.1",
            "mesh.set={nx: 6, ny: 5, nz: 3, length: 0.5, breadth: 0.4, height: 0.25}", "time.until.U=0.006",
            "output.figures=[]", "output.fields=none"]
STICK = 1


class Space(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            words = [word for setting in SETTINGS for word in ("--set", setting)]
            done = subprocess.run([PROGRAM, "run", SOURCE / "validation/paper/fig1.yaml", *words, "-o", f"{folder}/run"],
                                  capture_output=True, text=True)
            if done.returncode:
                raise AssertionError(done.stderr)
            subprocess.run([PROGRAM, "render", "run", "--figure", "force"], check=True, capture_output=True, cwd=folder)
            with open(Path(folder, "run/figures/events.csv"), newline="") as file:
                cls.events = list(csv.DictReader(file))
            cls.results = json.loads(Path(folder, "run", "run.json").read_text())["results"]
            with h5py.File(Path(folder, "run", "history.h5")) as history:
                cls.attributes = dict(history.attrs)
                cls.arrays = {f"{group}/{name}": item[()] for group in history for name, item in history[group].items()}
                cls.units = {f"{group}/{name}": item.attrs["unit"] for group in history
                             for name, item in history[group].items()}
        cls.rapid = [event for event in cls.results["events"] if event["kind"] != "quasi-static"]

    def test_layout(self):
        """Vectors have a last axis; forces and areas are no longer per width."""
        steps, nodes = len(self.arrays["series/time"]), len(self.arrays["nodes/x"])
        for name in ("slip_rate", "slip", "shear"):
            self.assertEqual(self.arrays[f"interface/{name}"].shape, (steps, nodes, 2))
        self.assertEqual(self.arrays["interface/pressure"].shape, (steps, nodes))
        self.assertEqual(self.attributes["format"], 2)
        self.assertEqual([self.units[name] for name in ("series/rod_force", "nodes/weight", "nodes/y", "events/slipped")],
                         ["force", "length^2", "length", "length^2"])
        self.assertAlmostEqual(self.arrays["nodes/weight"].sum(), 0.5 * 0.4, 12)

    def test_what_is_drawn(self):
        """All that there is where all is drawn: without rapid slip no contact-plane; a plot takes no measurements."""
        with tempfile.TemporaryDirectory() as folder:
            def call(*words):
                return subprocess.run([PROGRAM, *words], capture_output=True, text=True, cwd=folder)
            words = [word for setting in (*SETTINGS[:2], "mesh.set={nx: 4, ny: 2, nz: 2, length: 0.5, breadth: 0.4, height: 0.25}", "time.until.U=1e-3",
                                          "output.figures=[]", "output.fields={every_U: 5e-4}") for word in ("--set", setting)]
            self.assertEqual(call("run", SOURCE / "validation/paper/fig1.yaml", *words, "-o", "run", "-q").returncode, 0)
            done = call("render", "run")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(sorted(path.name for path in Path(folder, "run/figures").iterdir()),
                             ["contact-density.png", "events.csv", "field.png", "force.csv", "force.png", "slip-map.csv",
                              "slip-map.png"])
            self.assertEqual(call("render", "run", "--figure", "precursors", "--figure", "front-speed").returncode, 0)
            done = call("render", "run", "--figure", "contact-plane")
            self.assertEqual(done.returncode, 2)
            self.assertIn("no rapid slip has been seen from start to end: say when, as --at U=", done.stderr)

    def test_work_and_torque_of_events(self):
        """Of the whole contact: by tau and slip along both axes, and by pressure and place."""
        weight, x, U = (self.arrays[name].astype(float) for name in ("nodes/weight", "nodes/x", "series/rod_displacement"))
        slip, shear, pressure = (self.arrays[f"interface/{name}"].astype(float) for name in ("slip", "shear", "pressure"))
        counted = [event for event in self.rapid if event["kind"] in ("bounded rapid", "leading rapid")]
        self.assertTrue(counted and len(counted) == len(self.events))
        for row, event in zip(self.events, counted):
            first, last = numpy.searchsorted(U, event["U_start"]) - 1, numpy.searchsorted(U, event["U_stop"], "right") - 1
            part = slice(first, last + 1)
            work = numpy.einsum("j,ijk,ijk", weight, (shear[part][1:] + shear[part][:-1]) / 2, numpy.diff(slip[part], axis=0))
            numpy.testing.assert_allclose(float(row["work of friction"]), work, rtol=1e-6)
            for name, step in ("before", first), ("after", last):
                numpy.testing.assert_allclose(float(row[f"torque {name}"]), pressure[step] @ (weight * (x - 0.25)), rtol=1e-6)

    def test_sums(self):
        """Pressure and shear are forces over weights; the rod's force is the shear of a block at rest."""
        weight = self.arrays["nodes/weight"]
        pressed = self.arrays["interface/pressure"] @ weight
        numpy.testing.assert_allclose(pressed, self.arrays["series/normal_force"], rtol=1e-6)
        shear = numpy.einsum("ijk,j->ik", self.arrays["interface/shear"], weight)
        numpy.testing.assert_allclose(shear[:, 0], self.arrays["pads/shear"], rtol=0, atol=1e-6 * pressed[0])
        self.assertLess(abs(shear[:, 1]).max(), 1e-6 * pressed[0])   # the block is its own mirror image across

    def test_speeds(self):
        speed = numpy.linalg.norm(self.arrays["interface/slip_rate"], axis=2).max(axis=1)
        numpy.testing.assert_allclose(speed, self.arrays["series/max_slip_rate"], rtol=1e-6, atol=1e-12)

    def test_friction_is_against_slip(self):
        """Where a node slips its shear is mu(|v|) p, along its slip rate."""
        rate, shear = self.arrays["interface/slip_rate"], self.arrays["interface/shear"]
        pressure = self.arrays["interface/pressure"]
        slips = (self.arrays["interface/status"] >= 2) & (numpy.linalg.norm(rate, axis=2) > 1e-9)
        speed = numpy.linalg.norm(rate, axis=2, keepdims=True)
        mu = 0.1 + 0.28 * numpy.maximum(1 - speed / self.attributes["critical_velocity"], 0)
        wanted = mu * pressure[..., None] * rate / numpy.where(speed > 0, speed, 1)
        self.assertGreater(slips.sum(), 1000)
        self.assertGreater(abs(rate[slips][:, 1]).max(), 1e-2 * abs(rate[slips][:, 0]).max())
        numpy.testing.assert_allclose(shear[slips], wanted[slips], rtol=0, atol=2e-5 * pressure.max())

    def test_line_and_front(self):
        """Six rows of nodes across: the line is the third or fourth; the front is where its first node sticks."""
        x, y, line = (self.arrays[f"nodes/{name}"] for name in ("x", "y", "line"))
        self.assertEqual(line.sum(), 7)
        self.assertEqual(len(set(numpy.round(y[line > 0], 9))), 1)
        self.assertAlmostEqual(abs(y[line > 0][0] - 0.2), 0.04, 9)
        for status, front in zip(self.arrays["interface/status"][:, line > 0], self.arrays["series/front"]):
            stuck = numpy.flatnonzero(status == STICK)
            last = stuck[0] - 1 if len(stuck) else 6
            self.assertEqual(front, x[line > 0][max(last, 0)])

    def test_events(self):
        """What slipped in each, and before it; the whole block slid where every node did."""
        t, weight = self.arrays["series/time"], self.arrays["nodes/weight"]
        status, area = self.arrays["interface/status"], weight.sum()
        self.assertGreater(len(self.rapid), 1)
        for event in self.rapid:
            first, last = (int(numpy.argmin(abs(t - event[key]))) for key in ("t_start", "t_stop"))
            slipped = (status[first:last + 1] != STICK).any(axis=0)
            before = status[first - 1] >= 2
            self.assertAlmostEqual(event["slipped_over_A"], weight[slipped].sum() / area, 9)
            self.assertAlmostEqual(event["slip_before_over_A"], weight[before].sum() / area, 9)
            self.assertAlmostEqual(event["slip_length"], weight[before].sum() / 0.4, 9)
            self.assertEqual(event["kind"] == "leading rapid", bool(slipped.all()))
        counted = [peak["A_c_over_A"] for peak in self.results["peaks"] if peak["counts"]]
        self.assertAlmostEqual(self.results["A_c_over_A"], numpy.mean(counted), 12)

    def test_turning(self):
        """A block that is its own mirror image goes straight."""
        turning = self.results["turning"]
        slip, weight = self.arrays["interface/slip"], self.arrays["nodes/weight"]
        mean = numpy.einsum("ijk,j->ik", slip, weight) / weight.sum()
        self.assertAlmostEqual(turning["way"], mean[:, 0].max(), 8)
        self.assertAlmostEqual(abs(turning["across"]), abs(slip[..., 1]).max(), 8)
        self.assertLess(abs(turning["angle"]) + abs(turning["drift"]), 1e-6 * turning["way"])


if __name__ == "__main__":
    unittest.main()
