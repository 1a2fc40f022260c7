# SPDX-License-Identifier: GPL-2.0-or-later
"""The validation suite sees what it should: a wrong row, a broken invariant, a missed mistake each
make it fail; and its closed forms are right."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "validation"))

from exact import bulk, instability, stick_slip                      # noqa: E402
from harness import (ELEMENTS, PROGRAMS, Control, Row, Study, mesh_set, observed_order,   # noqa: E402
                     relative, schemes)
from report import write_report                                     # noqa: E402


class Verdicts(unittest.TestCase):
    def verdict(self, **what):
        study = Study()
        study.rows = what.get("rows", [])
        study.invariants = what.get("invariants", [])
        study.controls = what.get("controls", [])
        with tempfile.TemporaryDirectory() as folder, open(os.devnull, "w") as nothing:
            shown, sys.stdout = sys.stdout, nothing
            try:
                return write_report(study, Path(folder), "a test")
            finally:
                sys.stdout = shown

    def row(self, error, **order):
        return Row("group", "case", "quantity", 1.0, 1.0 + error, error, 1e-3, **order)

    def test_each_kind_of_failure_counts(self):
        self.assertTrue(self.verdict(rows=[self.row(1e-4)]))
        self.assertFalse(self.verdict(rows=[self.row(1e-4), self.row(1e-2)]))
        self.assertFalse(self.verdict(rows=[self.row(float("nan"))]))
        self.assertTrue(self.verdict(rows=[self.row(1e-4, seen=1.9, least=1.8)]))
        self.assertFalse(self.verdict(rows=[self.row(1e-4, seen=1.7, least=1.8)]))
        self.assertFalse(self.verdict(rows=[self.row(1e-4, seen=float("nan"), least=1.8)]))
        with self.assertRaises(AssertionError):   # an order that is shown must be required
            self.row(1e-4, seen=0.3)
        self.assertTrue(self.verdict(invariants=[("run", "energy", 1e-5, 1e-3)]))
        self.assertFalse(self.verdict(invariants=[("run", "energy", 1e-2, 1e-3)]))
        self.assertFalse(self.verdict(invariants=[("run", "energy", float("nan"), 1e-3)]))

    def test_a_mistake_counts_as_caught_by_what_it_breaks(self):
        good, bad = self.row(1e-4), self.row(1e-2)

        def verdict(mistake, rows=(good,), invariants=(), refused=""):
            control = Control("group", mistake, "broken", list(rows), list(invariants), refused)
            return self.verdict(controls=[control])
        self.assertFalse(verdict("viscous-sign"))
        self.assertTrue(verdict("viscous-sign", rows=[good, bad]))
        self.assertTrue(verdict("viscous-sign", invariants=[("run", "energy", 1e-2, 1e-3)]))
        self.assertTrue(verdict("viscous-sign", refused="exit status 1"))
        self.assertTrue(verdict("none"))
        self.assertFalse(verdict("none", rows=[bad]))

    def test_measures(self):
        self.assertEqual(relative([1, 2.2], [1, 2]), 0.20000000000000018 / 2)
        self.assertAlmostEqual(observed_order([0.2, 0.1], [4e-2, 1e-2]), 2)


class References(unittest.TestCase):
    """The closed forms that rows are compared with, each found in another way."""

    def test_stick_slip(self):
        """Against the classical Runge-Kutta method, stopped and started by hand."""
        def force(t, u, v):
            fall = (stick_slip.MU_S - stick_slip.MU_K) * min(v / stick_slip.V_C, 1)
            return (stick_slip.STIFFNESS * (stick_slip.SPEED * t - u) +
                    stick_slip.DAMPING * (stick_slip.SPEED - v) -
                    stick_slip.PRESSURE * (stick_slip.MU_S - fall)) / stick_slip.MASS
        step, u, v, seen = 1e-3, 0.0, 0.0, []
        times = np.arange(0, 20, step)
        for t in times:
            seen.append(u)
            if v <= 0 and force(t, u, 0) <= 0:
                v = 0.0
                continue
            a1 = force(t, u, v)
            a2 = force(t + step / 2, u + step / 2 * v, v + step / 2 * a1)
            a3 = force(t + step / 2, u + step / 2 * v + step**2 / 4 * a1, v + step / 2 * a2)
            a4 = force(t + step, u + step * v + step**2 / 2 * a2, v + step * a3)
            u += step * v + step**2 / 6 * (a1 + a2 + a3)
            v += step / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        exact, events = stick_slip.slip(times)
        self.assertEqual(events, 4)
        self.assertLess(relative(seen, exact), 2e-4)   # a start of slip falls between two steps

    def test_columns(self):
        """What is cut into many cells is the continuous column, at order 2."""
        exact = instability.exact_root(0.75, 0.05)
        errors = [abs(instability.discrete_root(0.75, n) - exact) for n in (256, 512)]
        self.assertAlmostEqual(observed_order([2, 1], errors), 2, places=2)
        z = np.linspace(0, 1, 11)
        smooth, cut = (bulk.column_exact(z, 1.3, 1.0, 0.2, cells=n) for n in (None, 400))
        self.assertLess(relative(cut, smooth), 1e-4)

    def test_exponents(self):
        t = np.arange(0, 6, 0.05)
        v = 2e-3 * np.exp(0.3 * t) * np.cos(1.1 * t) + np.exp(-2 * t) + 0.1
        found = instability.exponents(t, v, 4)
        self.assertAlmostEqual(found[0].real, 0.3, places=6)
        self.assertAlmostEqual(abs(found[0].imag), 1.1, places=6)

    def test_words(self):
        self.assertEqual(mesh_set("Q8", nx=3), "{shape: quad, order: 2, incomplete: 1, nx: 3}")
        self.assertEqual(len(ELEMENTS), 5)
        self.assertEqual(schemes()[:2], ["sdirk2", "explicit"])


class Misuse(unittest.TestCase):
    def test_unknown_mistake(self):
        """A control that makes no mistake would seem to be missed, or worse."""
        for name in ("viscous-sine", ""):
            done = subprocess.run([PROGRAMS / "amontons_mistaken", "run",
                                   SOURCE / "validation/exact/creep.yaml", "--set", "output.history=false"],
                                  capture_output=True, text=True,
                                  env=dict(os.environ, AMONTONS_MISTAKE=name))
            self.assertEqual(done.returncode, 3)
            self.assertIn("there is no such mistake", done.stderr)

    def test_unknown_group(self):
        done = subprocess.run([SOURCE / "validation/run", "creeep"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("there are freefem, bulk", done.stderr)


if __name__ == "__main__":
    unittest.main()
