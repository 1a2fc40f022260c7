# SPDX-License-Identifier: GPL-2.0-or-later
"""`amontons model1d` as its users call it: table, files, options, refusals."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy
from scipy.integrate import trapezoid

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
FIG1 = SOURCE / "validation" / "paper" / "fig1.yaml"
HEAVY = ["--set", "mesh.set.nx=4", "mesh.set.nz=4", "load.pressure=0.03", "time.until.U=0.012"]
PADS = SOURCE / "meshes" / "pads.geo"


def model1d(*words, settings=HEAVY):
    return subprocess.run([PROGRAM, "model1d", FIG1, *map(str, words), *settings],
                          capture_output=True, text=True, timeout=120)


def table(text):
    rows = [line.split() for line in text.split("\n\n")[0].splitlines()[1:]]
    return numpy.array([["nan" if word == "-" else word for word in row] for row in rows], float)


class Answers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-model1d-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.done = model1d("-o", cls.folder, "--points", 41)
        cls.report = json.loads((cls.folder / "model1d.json").read_text())

    def test_table_is_the_file(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        names = ["front", "U", "mu", "mu_line", "omega_re", "omega_im", "rate_re", "rate_im", None,
                 "front_seen", "mu_seen"]
        printed = table(self.done.stdout)
        self.assertEqual(printed.shape, (40, len(names)))
        with h5py.File(self.folder / "model1d.h5") as file:
            for name, column in zip(names, printed.T):
                if name:
                    numpy.testing.assert_allclose(column, file["points"][name][:], rtol=1e-3,
                                                  atol=1e-5)
                    self.assertTrue(file["points"][name].attrs["unit"])
        # Beyond the first sliding nothing is compared; before it the two agree.
        seen = numpy.isfinite(printed[:, 10])
        self.assertTrue(seen[:12].all() and not seen[20:].any())
        numpy.testing.assert_allclose(printed[seen, 10], printed[seen, 2], atol=1e-3)
        numpy.testing.assert_allclose(printed[seen, 9], printed[seen, 0], atol=2 / 40)

    def test_line_by_hand(self):
        front, line, growing = table(self.done.stdout)[:, [0, 3, 8]].T
        numpy.testing.assert_allclose(line, 0.1 + 0.28 * front, atol=1e-4)
        self.assertEqual(growing[0], 0)
        self.assertTrue((numpy.diff(growing) >= 0).all() and growing[-1] > 1)

    def test_report(self):
        theory, line = self.report["theory"], self.report["simulation"]
        self.assertEqual(self.report["status"], "done")
        self.assertEqual(self.report["scene"]["load"]["pressure"], 0.03)
        self.assertEqual(self.report["model"]["alpha"], 0.2)
        self.assertAlmostEqual(self.report["model"]["E_1"], 1 / (1 - 0.34 ** 2))
        self.assertIn(f"{theory['l_c_over_L']:.4f}", self.done.stdout)
        self.assertIn(f"{line['first_mu']:.4f}", self.done.stdout)
        self.assertAlmostEqual(theory["mu_M"], 0.1 + 0.28 * theory["l_c_over_L"])
        self.assertLess(theory["l_c_full_over_L"], theory["l_c_over_L"])
        self.assertAlmostEqual(line["first_mu"], theory["mu_M_at_V_full"], delta=0.01)
        counted = [peak["mu"] for peak in line["peaks"] if peak["counts"]]
        self.assertAlmostEqual(line["mu_M"], numpy.mean(counted))
        self.assertEqual(line["leading"], len(line["peaks"]))

    def test_profiles(self):
        """The adiabatic solution at rest carries mu_K P L, by the trapezium rule."""
        with h5py.File(self.folder / "model1d.h5") as file:
            x, rest, slipped = (file[f"profile/{name}"][:] for name in ("x", "u_0", "u_a"))
            fronts, rods, mus = (file[f"points/{name}"][:] for name in ("front", "U", "mu"))
        stiff, drive, load = self.report["model"]["E_2"], self.report["model"]["drive_height"], 0.03
        self.assertAlmostEqual(trapezoid(-stiff / drive * rest, x) / load, 0.1, places=5)
        for front, rod, mu, u in zip(fronts, rods, mus, slipped.T):
            self.assertAlmostEqual(trapezoid(stiff / drive * (rod - u), x) / load, mu, places=4)
            numpy.testing.assert_array_equal(u[x > front], rest[x > front])

    def test_steps(self):
        """history.h5 is that of a block: p = 2 P x/L, the cone, F_T = sum of tau at slow slip."""
        line = self.report["simulation"]
        with h5py.File(self.folder / "history.h5") as file:
            x, weight = file["nodes/x"][:], file["nodes/weight"][:]
            pressure, shear = file["interface/pressure"][:], file["interface/shear"][:]
            mu, rate = file["series/mu"][:], file["series/max_slip_rate"][:]
            self.assertEqual(len(mu), line["accepted"] + 1)
        self.assertEqual(len(x), 41)
        numpy.testing.assert_allclose(pressure[0, 1:-1], 0.06 * x[1:-1], rtol=1e-6)
        numpy.testing.assert_allclose(pressure, numpy.tile(pressure[0], (len(mu), 1)), rtol=1e-6)
        self.assertTrue((numpy.abs(shear) <= 0.38 * pressure * (1 + 1e-6)).all())
        slow = rate < 1e-5
        numpy.testing.assert_allclose((shear @ weight / 0.03)[slow][:20], mu[slow][:20], atol=1e-4)
        self.assertAlmostEqual(mu[0], 0.1, places=4)

    def test_render(self):
        done = subprocess.run([PROGRAM, "render", self.folder, "--figure", "slip-map"],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater((self.folder / "figures" / "slip-map.png").stat().st_size, 10000)

    def test_earlier_result(self):
        done = model1d("-o", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--overwrite", done.stderr)


class Options(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-model1d-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def test_theory_only(self):
        done = model1d("--theory", "--alpha", 0.4, "-o", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("Simulation", done.stdout)
        report = json.loads((self.folder / "model1d.json").read_text())
        self.assertEqual(report["model"]["alpha"], 0.4)
        self.assertNotIn("simulation", report)
        self.assertFalse((self.folder / "history.h5").exists())
        # kappa r = sqrt(E_1/E_2 alpha h H), twice alpha: sqrt 2
        self.assertAlmostEqual(report["theory"]["range_over_L"],
                               numpy.sqrt(2 / (1 - 0.34) * 0.4 * 0.25 * 0.5))

    def test_rod_height(self):
        done = model1d("--theory", "-o", self.folder, settings=[*HEAVY, "rod.height=0.1"])
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((self.folder / "model1d.json").read_text())
        self.assertAlmostEqual(report["theory"]["range_over_L"],
                               numpy.sqrt(2 / (1 - 0.34) * 0.2 * 0.1 * 0.5))

    def test_quiet(self):
        done = model1d("--quiet", "--theory")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_no_files(self):
        done = model1d("--theory")
        self.assertNotIn("Results in", done.stdout)

    def test_same_bits(self):
        words = ["--points", 21]
        first, second = model1d(*words), model1d(*words)
        self.assertEqual(first.stdout.rsplit("time taken", 1)[0],
                         second.stdout.rsplit("time taken", 1)[0])

    def test_misuse(self):
        for words, says in [(["--alpha", "0"], "--alpha 0"), (["--alpha", "x"], "--alpha x"),
                            (["--points", "2"], "3 to 2000"), (["--points", "8.5"], "--points 8.5"),
                            (["--points", "9", "--theory"], "--theory"),
                            (["-o", ""], "no name"), ([FIG1], "one scene")]:
            done = model1d(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(says, done.stderr)
            self.assertEqual(done.stdout, "")
        done = subprocess.run([PROGRAM, "model1d"], capture_output=True, text=True, timeout=20)
        self.assertEqual(done.returncode, 2)
        self.assertIn("needs a scene", done.stderr)

    def test_pads(self):
        done = model1d(settings=["--set", f"mesh={{file: {PADS}}}"])
        self.assertEqual(done.returncode, 2)
        self.assertIn("one contact along the whole block", done.stderr)

    def test_help(self):
        done = subprocess.run([PROGRAM, "model1d", "--help"], capture_output=True, text=True,
                              timeout=20)
        self.assertEqual(done.returncode, 0)
        for word in ("--alpha", "--points", "--theory", "SCENE"):
            self.assertIn(word, done.stdout)


if __name__ == "__main__":
    unittest.main()
