# SPDX-License-Identifier: GPL-2.0-or-later
"""The lists that constants.py varies are complete: every number of solver, stepper, elements, reduction and
recorders stands in one of them, and where it says. Nothing is built here."""
import math
import os
import shutil
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "validation" / "benchmark"))
import constants  # noqa: E402
import constants_listed as listed  # noqa: E402


class Lists(unittest.TestCase):
    def test_lists_are_those_of_the_source(self):
        self.assertEqual(listed.faults(SOURCE), [])

    def test_what_is_missing_twice_or_new_is_noticed(self):
        constant = next(c for c in listed.CONSTANTS if c.file.endswith(".c") and c.name.isupper())
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SOURCE / "src", Path(folder, "src"))
            path = Path(folder, "src", constant.file)
            usual = path.read_text()
            cases = ((usual.replace(f"{constant.name} =", "RENAMED ="), "stands 0 times"),
                     (usual + f"static const double {constant.name} = 3;\n", "stands 2 times"),
                     (usual + "static const double NEW = 3;\n", "NEW of"),
                     (usual + "enum { ROOM, NEW = 3 };\n", "NEW of"))
            for text, said in cases:
                path.write_text(text)
                self.assertTrue(any(said in fault for fault in listed.faults(Path(folder))), said)

    def test_limits_are_in_no_list(self):
        limit = listed.Constant("NEW_LIMIT", "contact/contact_newton.c", "", "")
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SOURCE / "src", Path(folder, "src"))
            path = Path(folder, "src", limit.file)
            path.write_text(path.read_text() + "enum { NEW_LIMIT = 3 };\n")
            self.assertEqual(listed.faults(Path(folder)), [])
            with unittest.mock.patch.object(listed, "CONSTANTS", [*listed.CONSTANTS, limit]):
                self.assertTrue(any("NEW_LIMIT" in fault for fault in listed.faults(Path(folder))))

    def test_every_form_of_a_definition_is_found(self):
        text = ("static const double A = 3, B[] = {[C] = 2e-2, [D] = 1};   // E = 5\n"
                "static const int32_t F =\n    8;\nenum { G = 4, H, I = 1 << 3 };\n"
                "static const double *f(int J);\ntypedef enum K { L = 1 } K;\n"
                "    double l = 2; x = (T){.m = 7};\n"
                "extern const double N;\nconst double N = 9;\n    const double o = 2;\n")
        self.assertEqual(listed.defined(text), ["A", "B", "F", "N", "G", "I"])
        for name, value in (("A", "3"), ("[C]", "2e-2"), ("F", "8"), ("G", "4"), ("m", "7"),
                            ("N", "9")):
            (start, end), = listed.places(listed.Constant(name, "a.c", "", ""), text)
            self.assertEqual(text[start:end], value)

    def test_values_of_variants(self):
        for value, half, twice in (("30", "15", "60"), ("1", "1", "2"), ("0.5", "0.25", "1.0"),
                                   ("1e-12", "5e-13", "2e-12"), ("3", "2", "6")):
            self.assertEqual(constants.scaled(value, 0.5), half)
            self.assertEqual(constants.scaled(value, 2), twice)


class Verdicts(unittest.TestCase):
    SCENE = constants.Scene("a", "one", "none.yaml", (), 1)
    USUAL = [{"steps": 1000, "newton": 5000, "mu_M": 0.3, "mu_hold": None},
             {"steps": 1050, "newton": 5000, "mu_M": 0.3, "mu_hold": None}]

    def verdict(self, **now):
        found = {"a": {**self.USUAL[0], **now}}
        return constants.verdict([constants.effect_of(found, {"a": self.USUAL}, [self.SCENE])])

    def test_each(self):
        self.assertEqual(self.verdict(), "not noticed")
        self.assertEqual(self.verdict(steps=1055), "does not matter")   # copies differ by 5 %
        self.assertEqual(self.verdict(steps=1100), "**matters for cost**")
        self.assertEqual(self.verdict(newton=5049), "does not matter")
        self.assertEqual(self.verdict(newton=5100), "**matters for cost**")
        self.assertEqual(self.verdict(mu_M=0.3002), "does not matter")
        self.assertEqual(self.verdict(mu_M=0.3010), "**matters for mu**")
        self.assertEqual(self.verdict(mu_M=None), "**matters for mu**")
        self.assertEqual(self.verdict(failed="no end"), "**guards**")

    def test_the_largest_change_that_counts_is_shown(self):
        usual = {"a": self.USUAL, "b": [{"steps": 100}]}
        found = {"a": {**self.USUAL[0], "steps": 1040}, "b": {"steps": 102}}
        scenes = [self.SCENE, constants.Scene("b", "two", "none.yaml", ())]
        change, matters, letter = constants.effect_of(found, usual, scenes).costs
        self.assertTrue(matters and letter == "b" and math.isclose(change, 0.02))


if __name__ == "__main__":
    unittest.main()
