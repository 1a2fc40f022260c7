# SPDX-License-Identifier: GPL-2.0-or-later
"""What `./amontons reproduce` computes by itself: the 1D theory in closed form, and the parts of a peak's load."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
PAPER = SOURCE / "validation" / "paper"
sys.path.insert(0, str(PAPER))
sys.dont_write_bytecode = True

import interface   # noqa: E402
import paper_report   # noqa: E402
import windows     # noqa: E402
import theory      # noqa: E402


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-reproduce-"))
        self.addCleanup(shutil.rmtree, self.folder)


class Theory(InFolder):
    def test_is_the_programs(self):
        """The critical length of the supplement's formula against `amontons model1d`, which finds roots of omega_0."""
        for scene, material, length, pressure in [("fig1", theory.A, 1, 0.003), ("fig1", theory.A, 1, 0.05),
                                                  ("set-b", theory.B, 0.04, 5.75e-5), ("set-b", theory.B, 0.04, 1e-3)]:
            with self.subTest(f"{scene} {pressure}"):
                done = subprocess.run([PROGRAM, "model1d", PAPER / f"{scene}.yaml", "--theory", "-o", self.folder / "out",
                                       "--overwrite", "--set", f"load.pressure={pressure}"], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                text = (self.folder / "out/model1d.json").read_text()
                found = json.loads(text)["theory"]
                self.assertAlmostEqual(material.critical_part(length, pressure) / found["l_c_over_L"], 1, places=6)
                self.assertAlmostEqual(material.mu(length, pressure) / found["mu_M"], 1, places=6)

    def test_inverse(self):
        for part in (0.01, 0.3, 1, 20):
            P = theory.B.pressure(0.04, part)
            self.assertAlmostEqual(theory.B.critical_part(0.04, P) / part, 1, places=9)


class Parts(InFolder):
    def write(self, shear):
        x = np.linspace(0, 2, 5)
        weight = np.array([0.25, 0.5, 0.5, 0.5, 0.25])
        rows = 6
        pressure = np.tile([1.0, 2, 3, 4, 5], (rows, 1))
        mu = np.array([0.3, 0.1, 0.2, 0.25, 0.3, 0.1])
        with h5py.File(self.folder / "history.h5", "w") as file:
            for name, value in [("series/rod_displacement", np.arange(rows)), ("series/mu", mu),
                                ("series/front", [2, 0, 0.5, 1, 1, 2]), ("nodes/x", x), ("nodes/weight", weight),
                                ("interface/pressure", pressure), ("interface/shear", shear),
                                ("events/kind", [2, 1, 2]), ("events/U_start", [0, 2.5, 4]), ("events/U_stop", [0.5, 2.6, 5]),
                                ("events/reach", [2, 1, 2])]:
                file[name] = value
            file.attrs.update(length=2, normal_force=6, pressure=3, mu_static=0.4, mu_kinetic=0.1)
        return weight, pressure

    def test_sum_is_the_distance_from_the_line(self):
        random = np.random.default_rng(3)
        weight, pressure = self.write(random.uniform(0, 2, (6, 5)))
        history = interface.History(self.folder)
        self.assertEqual(history.cycles(), [(1, 4)])
        parts = interface.peak_made_of(history)
        mu = (history.shear[4] * weight).sum() / (pressure[4] * weight).sum()
        total = sum(parts[key] for key in ("by_behind", "by_left", "by_carried", "by_load"))
        self.assertAlmostEqual(total, mu - (0.1 + 0.3 * 0.5), places=12)
        self.assertAlmostEqual(parts["f"], (0.25 * 1 + 0.5 * 2 + 0.5 * 3) / 6, places=12)

    def test_on_the_line(self):
        """mu_S behind, mu_K ahead: nothing is left over but the load not being uniform."""
        shear = np.tile(np.array([1.0, 2, 3, 4, 5]) * [0.4, 0.4, 0.4, 0.1, 0.1], (6, 1))
        self.write(shear)
        parts = interface.peak_made_of(interface.History(self.folder))
        for key in ("by_behind", "by_left", "by_carried"):
            self.assertAlmostEqual(parts[key], 0, places=12)
        self.assertAlmostEqual(parts["behind"], 0.4, places=12)
        self.assertAlmostEqual(parts["ahead"], 0.1, places=12)


class Studies(InFolder):
    def test_all_can_be_read(self):
        """Every study of the paper, with a mesh so coarse that all points fail at once or run in no time: none is wrong."""
        for study in sorted(PAPER.glob("*.yaml")):
            text = study.read_text()
            if "\nscene:" not in text:
                continue
            with self.subTest(study.name):
                done = subprocess.run([PROGRAM, "sweep", study, "-q", "-o", self.folder / study.stem, "--set",
                                       "groups.rod=nowhere"], capture_output=True, text=True, timeout=100)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("has no group 'nowhere'", done.stderr)

    def test_tables(self):
        self.assertEqual(paper_report.table(["a", "b"], [(1, float("nan")), ("x", 123456.0)]),
                         "| a | b |\n|---|---|\n| 1 | - |\n| x | 1.235e+05 |\n")
        self.assertEqual(windows.mu_of({"mu_M": float("nan"), "mu_max": 0.3}), 0.3)
        self.assertEqual(windows.mu_of({"mu_M": 0.2, "mu_max": 0.3}), 0.2)


if __name__ == "__main__":
    unittest.main()
