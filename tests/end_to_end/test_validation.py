# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick part of the validation suite, with FreeFem++ really executed; and that the suite sees
what it should: a wrong row, a broken invariant, a missed mistake each make it fail."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "validation"))

from harness import Control, Row, Study, observed_order, relative   # noqa: E402
from report import write_report                                     # noqa: E402


class Suite(unittest.TestCase):
    def run_groups(self, *groups):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([SOURCE / "validation/run", "--quick", "-o", folder, *groups],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            text = (Path(folder) / "report.md").read_text()
            self.assertNotIn("FAIL", text)
            self.assertNotIn("MISSED", text)
            for picture in Path(folder).glob("*.png"):
                self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
            return text

    def test_freefem(self):
        text = self.run_groups("freefem")
        self.assertGreaterEqual(text.count("| pass |"), 40)
        self.assertGreaterEqual(text.count("| caught |"), 6)

    def test_exact(self):
        text = self.run_groups("bulk", "speeds", "statics", "instability", "growth", "impact",
                               "orders")
        self.assertGreaterEqual(text.count("| pass |"), 60)
        self.assertGreaterEqual(text.count("| caught |"), 9)


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
        self.assertIn("not checked", self.row(1e-4, seen=0.3).order_text)
        self.assertTrue(self.verdict(invariants=[("run", "energy", 1e-5, 1e-3)]))
        self.assertFalse(self.verdict(invariants=[("run", "energy", 1e-2, 1e-3)]))
        self.assertFalse(self.verdict(invariants=[("run", "energy", float("nan"), 1e-3)]))
        self.assertTrue(self.verdict(controls=[Control("group", "broken", self.row(1e-2))]))
        self.assertFalse(self.verdict(controls=[Control("group", "broken", self.row(1e-4))]))

    def test_measures(self):
        self.assertEqual(relative([1, 2.2], [1, 2]), 0.20000000000000018 / 2)
        self.assertAlmostEqual(observed_order([0.2, 0.1], [4e-2, 1e-2]), 2)


class Misuse(unittest.TestCase):
    def test_unknown_group(self):
        done = subprocess.run([SOURCE / "validation/run", "creeep"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("there are freefem, bulk", done.stderr)


if __name__ == "__main__":
    unittest.main()
