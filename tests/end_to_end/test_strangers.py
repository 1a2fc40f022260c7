# SPDX-License-Identifier: GPL-2.0-or-later
"""The promise test of strangers: its problems are those that were drawn, the program takes a sample of them, and the judge
judges numbers made by hand."""
import collections
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(os.environ["AMONTONS_SOURCE"], "validation", "strangers")
sys.path.insert(0, str(FOLDER))
import judge  # noqa: E402
import problems  # noqa: E402
import strangers  # noqa: E402

DRAWN = ("fffbfe5e2246803ca7d418fa65e6a743635fc5625a227ff3825724059b537a14",      # those of before, and those that are new
         "e54ef806da7c589e390e1ddeb195b3d814f4fda3b8f2b54e15ae7dd6c2071626",
         "37ea1670f1b3e0927ceafe5f469c3509c24c6089abd083c37ff8d26a3d071b91",
         "b5a883e44f7a96892a84de5fdd5a968f8919ccd8e60fc9ad8aaaa2b00fca0776",
         "8e5abd98785977c836b4ecefe7130a7543f266f3388fa089911a8468f81107a9",
         "e73f2ed32cb6a618371a50bba19c855687212d884f7fa3a664296b393c24f0a1",
         "a5bba5faa2f3348b5c569e26c5a2fc2efa9baabd5434b43a5cba9b144687b203",
         "8fe1102d16db56459a43a83b3a5be7687da13d25a19ba21aba8595f6cb6dd155",
         "1bb9ca99e64436f3b019a6f30bb419d996f7aa347f32d5b253dfef5bed5b6523",
         "ae6d211ccde89346f8a021ce3da5b624e43e2e03a0fc61b8f2a27657c5f4bbf5")


def runs(values, answer="mu_hold", drift=0, late=0):
    """Rows of meshes 1, 2, ... times as fine, each with three values."""
    return [{"refine": k, "pressure": factor, answer: value, "drift": {answer: drift}, "late": {answer: late}, "program": {answer: None}}
            for k, some in enumerate(values, 1) for factor, value in zip(strangers.WINDOW, some)]


def asked(value, bar):
    return {"status": 0, "said": "", "mu_hold": value, "mu_hold_error": bar, "levels": [{"refine": 1.2}]}


class Problems(unittest.TestCase):
    def test_same_as_drawn(self):
        found = problems.problems()
        self.assertEqual(tuple(problems.digest(found[first:last]) for first, last in ((0, 200), (200, 300), (300, 400), (400, 500), (500, 600), (600, 700), (700, 750), (750, 800), (800, 850), (850, 950))),
                         DRAWN)

    def test_all_is_said(self):
        """Each kind of thing that a scene can say comes up in ten problems or more, among the tuning ones too."""
        found = problems.problems()
        self.assertEqual((len(found), sum(one.tuning for one in found), sum(one.whole for one in found)), (950, 850, 95))
        seen = collections.Counter(word for one in found for word in one.features)
        for word in ("T3", "T6", "Q4", "Q8", "Q9", "SI", "stress", "strain", "table", "formula", "bonded", "machine", "by pad", "along",
                     "linear-weakening", "exponential-weakening", "program of the rod", "program of the load", "ageing", "slip-weakening", "rate-and-state", "holds of the rod",
                     "ramp of the load", "space"):
            self.assertGreaterEqual(seen[word], 10, word)

    def test_program_takes_a_sample(self):
        with tempfile.TemporaryDirectory() as folder:
            for number in (*range(1, 601, 25), 115, *range(605, 950, 12)):      # 115: a profile that ends at the contact's end in five digits
                unknowns, said = strangers.size(problems.problem(number).write(Path(folder)))
                self.assertIsNotNone(unknowns, f"{number}: {said}")


class Judge(unittest.TestCase):
    def test_reading_of_a_run(self):
        """The second half alone; the lowest of drops that repeat, else their lowest decile; a drift between quarters."""
        peaks = [{"U": u, "mu": mu} for u, mu in ((1, 9), (4, 8), (6, 0.4), (7, 0.5), (8, 0.6), (9, 0.7))]
        report = {"results": {"peaks": peaks, "drops": {"period": 1, "list": peaks}, "mu_M_is": "peaks", "mu_steady": 0.3}}
        found = judge.reading(report, 10)
        self.assertAlmostEqual(found["mu_M"], 0.55)
        self.assertEqual(found["mu_hold"], 0.4)
        self.assertAlmostEqual(found["drift"]["mu_M"], 0.65 - 0.45)
        report["results"]["drops"]["period"] = 0
        self.assertAlmostEqual(judge.reading(report, 10)["mu_hold"], 0.43)
        self.assertIsNone(judge.reading(report, 16)["mu_M"])
        self.assertIsNone(judge.reading(report, 12)["mu_M"])       # three, but none in the last quarter
        report["results"] |= {"peaks": peaks[:2], "drops": {"period": 0, "list": []}, "mu_M_is": "steady sliding"}
        self.assertEqual(judge.reading(report, 10)["mu_M"], 0.3)
        self.assertIsNone(judge.reading(report, 7)["mu_M"])        # a peak in the second half: it did not slide steadily all along
        report["results"] |= {"drops": {"period": 0, "list": peaks[:1]}, "mu_M_is": "peaks"}        # it slid, and slides steadily since
        found = judge.reading(report, 10)
        self.assertEqual((found["mu_M"], found["mu_hold"]), (8, 9))
        report["results"]["mu_steady"] = None                      # it rests, and may slide again
        self.assertIsNone(judge.reading(report, 10)["mu_M"])

    def test_runs_that_are_too_short(self):
        """Two drops where three are asked for; a drift of which half is above a third of the bar; no bar, no drift that matters."""
        def rows(late, drift):
            return [{"late": {name: late for name in judge.ANSWERS}, "drift": {"mu_M": drift, "mu_hold": 0}}] * 3
        bars = {"mu_M_error": 0.03, "mu_hold_error": None}
        for late, drift, short in ((2, 0, True), (0, 0, False), (5, 0.019, False), (5, 0.021, True), (5, -0.021, True)):
            self.assertEqual(judge.too_short(bars, rows(late, drift)), short, (late, drift))
        self.assertFalse(judge.too_short({"mu_M_error": None, "mu_hold_error": None}, rows(5, 1)))

    def test_reference_of_meshes_that_scatter(self):
        truth = judge.reference(runs([[0.3, 0.31, 0.32], [0.32, 0.33, 0.34], [0.31, 0.31, 0.4], [0.31, 0.4, 0.5]]), "mu_hold")
        self.assertAlmostEqual(truth.value, 0.31)       # of 0.3, 0.32, 0.31, 0.31
        self.assertAlmostEqual(truth.own, math.sqrt(2e-4 / 3 / 4))
        drifting = judge.reference(runs([[0.3] * 3] * 3, drift=0.02), "mu_hold")
        self.assertAlmostEqual(drifting.own, 0.01)

    def test_reference_of_meshes_that_converge(self):
        """0.3 + 0.1 / refine: the finest two, half of the way to the limit; its own error is the other half."""
        truth = judge.reference(runs([[0.3 + 0.1 / k] * 3 for k in (1, 2, 3, 4)]), "mu_hold")
        way = 0.1 * (1 / 3 + 1 / 4) / 2
        self.assertAlmostEqual(truth.value, 0.3 + way / 2)
        self.assertAlmostEqual(truth.own, way / 2)

    def test_no_reference(self):
        self.assertIsNone(judge.reference(runs([[0.3] * 3] * 2), "mu_hold"))
        self.assertIsNone(judge.reference(runs([[0.3, 0.3, None]] * 3), "mu_hold"))
        self.assertIsNone(judge.reference(runs([[None] * 3] * 3), "mu_hold").value)
        self.assertIsNone(judge.reference(runs([[None] * 3] * 3, late=2), "mu_hold"))      # too few drops are not none

    def test_verdicts(self):
        truth, rough, none = judge.Reference(0.30, 0.001, 3, 1.2), judge.Reference(0.30, 0.01, 3, 1.2), judge.Reference(None)
        for value, bar, of, kind in ((0.305, 0.01, truth, "held"), (0.315, 0.01, truth, "broken"), (0.305, None, truth, "not known"),
                                     (None, None, truth, "not known"), (None, None, none, "held"), (0.3, 0.1, none, "broken"),
                                     (0.315, 0.01, rough, "no reference"), (0.36, 0.01, rough, "broken"), (0.3, 0.01, None, "no reference")):
            found = judge.verdict(1, "mu_hold", asked(value, bar), of)
            self.assertEqual(found.kind, kind, (value, bar, of))
        self.assertAlmostEqual(judge.verdict(1, "mu_hold", asked(0.315, 0.01), truth).ratio, 1.5)
        self.assertEqual(judge.verdict(1, "mu_hold", asked(0.3, 0.01) | {"status": 2}, truth).kind, "refused")
        finer = {"levels": [{"refine": 1}, {"refine": truth.finest + 0.1}]}
        self.assertEqual(judge.verdict(1, "mu_hold", asked(0.315, 0.01) | finer, truth).kind, "no reference")

    def test_acceptance(self):
        held = [judge.Verdict(k, "mu_M", "held", 0.1 + 0.04 * (k % 20)) for k in range(19)]
        self.assertEqual(judge.count(held + [judge.Verdict(20, "mu_M", "broken", 2.9)]).failed, [])
        for more, word in ((judge.Verdict(20, "mu_M", "broken", 3), "worst"), (judge.Verdict(20, "mu_M", "refused"), "refused")):
            self.assertIn(word, " ".join(judge.count([*held, more]).failed))
        few = [judge.Verdict(k, "mu_M", "broken", 1.5) for k in range(2)]
        self.assertIn("91 %", judge.count(held + few).failed[0])
        unknown = [judge.Verdict(k, "mu_M", "not known") for k in range(3)]
        self.assertIn("not known", judge.count(held + unknown).failed[0])
        self.assertIn("median", judge.count([judge.Verdict(1, "mu_M", "held", 0.1)]).failed[0])


class Command(unittest.TestCase):
    def test_one_problem(self):
        """Asked, referred to, gone on with (nothing is computed twice), and its scene as drawn; the judging part is not told."""
        with tempfile.TemporaryDirectory() as folder:
            def call(*words):
                return subprocess.run([FOLDER / "strangers.py", "-o", folder, "--limit", "0", *words], capture_output=True, text=True)
            first = call("--only", "877")
            kept = Path(folder, "877.json")
            data = json.loads(kept.read_text())
            self.assertEqual(data["asked"]["status"], 0, first.stderr)
            self.assertGreater(len(data["asked"]["levels"]), 2)
            self.assertIn("0 problems to compute", call("--only", "877").stdout)
            self.assertEqual(json.loads(kept.read_text()), data)
            table = Path(folder, "table.md").read_text()
            self.assertNotIn("| 877 |", table)
            self.assertIn("1 problems computed", table)
            call("--only", "877", "--table", "--show-judging")
            self.assertIn("| 877 |", Path(folder, "table.md").read_text())


if __name__ == "__main__":
    unittest.main()
