# SPDX-License-Identifier: GPL-2.0-or-later
"""A block on five pads: what run.json says of its events, worked out again from the history, node by node."""
import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

SCENE = Path(os.environ["AMONTONS_SOURCE"], "validation", "pads", "pads.yaml")
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
SETTINGS = ["mesh.set.n=5", "mesh.set.size_contact=0.02", "load.pressure=0.003", "time.until.U=0.03", "output.figures=[]"]
STICK, STATIONS = 1, 21


class Pads(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            words = [word for setting in SETTINGS for word in ("--set", setting)]
            done = subprocess.run([PROGRAM, "run", SCENE, *words, "-o", f"{folder}/run"], capture_output=True, text=True)
            if done.returncode:
                raise AssertionError(done.stderr)
            cls.printed, cls.warned = done.stdout, done.stderr
            subprocess.run([PROGRAM, "render", f"{folder}/run", "--figure", "pads", "--cycle", "first"], check=True, capture_output=True)
            with open(Path(folder, "run", "figures", "pads.csv"), newline="") as file:
                cls.courses = list(csv.DictReader(file))
            cls.report = json.loads(Path(folder, "run", "run.json").read_text())
            with h5py.File(Path(folder, "run", "history.h5")) as history:
                cls.x, cls.weight, cls.pad = (history["nodes"][name][:] for name in ("x", "weight", "pad"))
                cls.status = history["interface/status"][:]
                cls.rate = numpy.abs(history["interface/slip_rate"][:])
                cls.t, cls.front = history["series/time"][:], history["series/front"][:]
                cls.shear = history["interface/shear"][:] * cls.weight
                cls.pad_shear = history["pads/shear"][:]
                cls.fast = 2 * history.attrs["rod_velocity"]
                cls.attributes = set(history.attrs)
        cls.results = cls.report["results"]
        cls.rapid = [event for event in cls.results["events"] if event["kind"] != "quasi-static"]
        cls.names = [pad["name"] for pad in cls.results["pads"]]

    def steps(self, event):
        """The rows of an event's first and last step."""
        return (int(numpy.argmin(numpy.abs(self.t - event[key]))) for key in ("t_start", "t_stop"))

    def cells(self, slips):
        """Half a cell on either side of a node that has a neighbour on its pad."""
        joined = self.pad[1:] == self.pad[:-1]
        return 0.5 * (numpy.append(joined, False)[slips].sum() + numpy.append(False, joined)[slips].sum())

    def test_which_lets_go_first(self):
        """The table of the first and of the last cycle is what the run saw of them, which looked at each step while it went on."""
        cycles = [[row for row in self.courses if row["cycle"] == number] for number in dict.fromkeys(row["cycle"] for row in self.courses)]
        self.assertEqual(len(cycles), sum(event["kind"] == "leading rapid" for event in self.rapid))
        for rows, said in ((cycles[0], [pad["first"] for pad in self.results["pads"]]), (cycles[-1], self.results["pads"])):
            self.assertEqual([row["pad"] for row in rows], self.names)
            for row, pad in zip(rows, said):
                self.assertEqual(int(row["order"]), pad["detachment_order"])
                numpy.testing.assert_allclose([float(row["U first slip"]), float(row["U let go"])], [pad["U_first_slip"], pad["U_detached"]],
                                              rtol=1e-8)

    def test_the_run_has_what_is_tested(self):
        self.assertGreater(len(self.rapid), 5)
        self.assertGreater(len({event["slip_pad"] for event in self.rapid}), 1)

    def test_slip_before_it_turned_fast(self):
        """On the pad of the fastest node; status 2 and 3 slip."""
        for event in self.rapid:
            first, _ = self.steps(event)
            pad = self.pad[self.rate[first].argmax()]
            slips = (self.status[first - 1] >= 2) & (self.pad == pad)
            self.assertEqual(event["slip_pad"], self.names[pad])
            self.assertAlmostEqual(event["slip_length"], self.weight[slips].sum(), places=12)
            self.assertEqual(event["slip_cells"], self.cells(slips))

    def test_reach(self):
        """Pads on which slip was fast, each from its trailing end on."""
        for event in self.rapid:
            first, last = self.steps(event)
            slipped = (self.status[first:last + 1] != STICK).any(axis=0)
            fast = (self.rate[first:last + 1] > self.fast).any(axis=0)
            reached = [self.x[0]]
            for p in range(len(self.names)):
                on = self.pad == p
                if fast[on].any():
                    reached += list(self.x[on][numpy.logical_and.accumulate(slipped[on])])
            self.assertAlmostEqual(event["reach"], max(reached), places=12)

    def test_fronts_along_contact_only(self):
        """Stations are evenly spaced; those in gaps have no time, and no speed leads from pad to pad."""
        stations = numpy.linspace(self.x[0], self.x[-1], STATIONS)
        places = [next((p["name"] for p in self.results["pads"] if p["x_from"] - 1e-9 <= x <= p["x_to"] + 1e-9), None)
                  for x in stations]
        self.assertTrue(None in places and len(set(places)) == len(self.names) + 1)
        seen = 0
        for event in self.rapid:
            times, speeds = event["front_times"], event["front_speeds"]
            for k, place in enumerate(places):
                if place is None:
                    self.assertIsNone(times[k])
            for k, speed in enumerate(speeds):
                if speed is None:
                    continue
                self.assertTrue(places[k] is not None and places[k] == places[k + 1])
                self.assertAlmostEqual(speed * (times[k + 1] - times[k]) / (stations[1] - stations[0]), 1, places=9)
                seen += 1
        self.assertGreater(seen, 10)

    def test_resolution(self):
        """The fewest cells of the load drops that count; what is printed and warned of."""
        drops = self.results["drops"]
        counted = [event for event in self.rapid if any(
            event["U_stop"] >= drop["U"] and event["U_start"] - drop["U"] < 2e-3 for drop in drops["list"][-drops["counted"]:])]
        self.assertIn(self.results["slip_cells"], {event["slip_cells"] for event in counted})
        self.assertLess(self.results["slip_cells"], 8)
        cells, pad = self.results["slip_cells"], self.results["slip_pad"]
        self.assertIn(f"{cells:.3g} cells of the contact slipped where slow slip turned fast, on {pad}", self.printed)
        (warning,) = self.report["warnings"]
        self.assertIn(f'only {cells:.3g} cells of pad "{pad}" slipped', warning)
        self.assertIn("halve mesh.set.size_contact", warning)
        self.assertIn(warning, self.warned)

    def test_what_has_no_meaning_on_pads(self):
        """A front across gaps is no length; l_c is that of the pad."""
        self.assertIsNone(self.results["l_sc_over_L"])
        self.assertNotIn("critical_length", self.attributes)
        lengths = {event["slip_length"] for event in self.rapid if event["kind"] == "leading rapid"}
        for peak in self.results["peaks"]:
            self.assertIsNone(peak["l_c_growth_over_L"])
            self.assertIn(peak["l_c_over_L"] * self.report["model"]["length"], lengths)

    def test_sums_over_pads(self):
        for p in range(len(self.names)):
            numpy.testing.assert_allclose(self.pad_shear[:, p], self.shear[:, self.pad == p].sum(axis=1), rtol=1e-4, atol=1e-9)


if __name__ == "__main__":
    unittest.main()
