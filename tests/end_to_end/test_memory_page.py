# SPDX-License-Identifier: GPL-2.0-or-later
"""validation/memory: the page's numbers are those of its stored rows, its ten cases are those that were laid down, and rows
computed again on a coarse mesh agree."""
import os
import sys
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
FOLDER = SOURCE / "validation" / "memory"
sys.path[:0] = [str(FOLDER), str(SOURCE / "validation" / "benchmark")]
sys.dont_write_bytecode = True
import cases      # noqa: E402
import laws       # noqa: E402
import page       # noqa: E402
import question   # noqa: E402

STANDARD = "P 0.003, L 1, V 1e-05"


class MemoryPage(unittest.TestCase):
    def setUp(self):
        self.kept = question.Kept(FOLDER / "question.jsonl")

    def test_page_says_what_was_computed(self):
        text, _, _ = page.text(self.kept, cases.CASES.known(question.Kept(FOLDER / "cases.jsonl")))
        self.assertEqual(text, (FOLDER / "laws.md").read_text(encoding="utf-8"), "run validation/memory/question.py --page")

    def test_cases_are_those_laid_down(self):
        self.assertEqual(cases.CASES.digest(), (FOLDER / "cases.sha256").read_text(encoding="utf-8").strip())

    def test_rows_computed_again(self):
        """A mesh of 28 cells is within the bar of 3 % that was asked for, and the row's laws are those of now."""
        for law in laws.MAIN:
            row = self.kept.rows[f"{law}: {STANDARD}", "pressure"]
            point = question.Point("pressure", law)
            ended = question.run(laws.SCENE, point.settings(28), 60)
            with self.subTest(law):
                self.assertAlmostEqual(ended.report["results"]["mu_M"] / row["mu_M"], 1, delta=laws.TO)

    def test_match(self):
        """mu_S after a rest of 200 and mu_K at 10 v_c, of the laws that are said to be matched so; the page's lengths."""
        for name, law in laws.LAWS.items():
            if name.endswith(("creep", "rock")):
                continue
            self.assertAlmostEqual(laws.rested(law), laws.MU_STATIC, delta=2e-3, msg=name)
            self.assertAlmostEqual(laws.steady(law, laws.FAST), laws.MU_KINETIC, delta=6e-3, msg=name)
        lengths = [laws.length_of(laws.LAWS[name]) for name in ("rate-and-state", "slip-weakening", "rate-and-state, matched in creep")]
        self.assertLess(max(lengths) / min(lengths), 1.05)


if __name__ == "__main__":
    unittest.main()
