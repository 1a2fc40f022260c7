# SPDX-License-Identifier: GPL-2.0-or-later
"""FreeFEM, stepping the same equations on the same mesh with the same fixed steps, sees the same
mu(t) through the first rapid slips; and the comparison notices other physics. The exponents of the
cost benchmark are those of known powers, and the promise is judged by what it says."""
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(os.environ["AMONTONS_SOURCE"], "validation", "benchmark")))
import figure  # noqa: E402
import growth  # noqa: E402
import peers  # noqa: E402
import promise  # noqa: E402
import promise_work  # noqa: E402

STEP, DURATION = 0.2, 140
FAST = ["rod.velocity=2e-5"]      # twice the paper's: the first slips come within DURATION


@unittest.skipUnless(shutil.which("FreeFem++") and shutil.which("gmsh"), "no FreeFEM here")
class SameEquations(unittest.TestCase):
    def test_freefem_sees_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder, "block.msh")
            curves = peers.make_mesh(mesh, 6, 1)
            ours = peers.amontons("ours", mesh, peers.FIXED + FAST, STEP, DURATION)
            theirs = {}
            for mu_static in (0.38, 0.37):
                peers.PHYSICS.update(speed=2e-5, muS=mu_static)
                theirs[mu_static] = peers.freefem(mesh, curves, 1, STEP, DURATION)
        self.assertEqual(len(theirs[0.38].time), round(DURATION / STEP))
        self.assertGreater(theirs[0.38].mu.max(), 0.25)
        self.assertLess(theirs[0.38].mu[-1], 0.9 * theirs[0.38].mu.max())   # it has slipped
        self.assertLess(theirs[0.38].differs(ours, DURATION), 1e-6)
        self.assertGreater(theirs[0.37].differs(ours, DURATION), 1e-4)


class Exponents(unittest.TestCase):
    def test_fit(self):
        x = [10, 20, 40, 80]
        self.assertAlmostEqual(figure.fitted_exponent(x, [7 * v**1.5 for v in x]), 1.5)
        # Only the upper half counts: the first values are start-up.
        x += [160, 320, 640]
        rows = growth.exponent_lines("n", x, {"s": [5, 5, 5, *(v**2 for v in x[3:])]}, {"s": "2"})
        self.assertEqual(rows, [["s", "n", "2.00", "2"]])


class Promise(unittest.TestCase):
    def test_cases_are_the_sequence(self):
        self.assertEqual([promise.halton(k, 2) for k in range(1, 6)],
                         [1 / 2, 1 / 4, 3 / 4, 1 / 8, 5 / 8])
        middle = promise.case(0)      # P L half way from 0.002 to 0.02, L a third
        self.assertAlmostEqual(middle.way / 12, 0.002 * 10**0.5, delta=1e-4)
        self.assertAlmostEqual(middle.mesh["length"], 0.4 * (2.5 / 0.4) ** (1 / 3), delta=1e-2)
        names = [promise.case(k).name for k in range(80)]
        self.assertEqual(len(set(names)), 80)
        self.assertEqual(names[1], "A, P = 0.00424, 5 pads, fill 0.36")

    def test_a_bar_is_judged(self):
        """Half a bar off holds, a bar and a half does not; 37 of 40 are too few, and one of four bars off is too much."""
        def judged(mu):
            return promise.answer_cells({"mu": mu, "bar": 0.02, "met": True, "nodes": [21, 41], "seconds": 1}, 0.3)
        cells, ratio = judged(0.31)
        self.assertAlmostEqual(ratio, 0.5)
        self.assertEqual(cells[0], "3.33")
        cells, ratio = judged(0.27)
        self.assertAlmostEqual(ratio, 1.5)
        self.assertEqual(cells[0], "-10.00 **no**")
        for ratios, kept in (([0.5] * 38 + [1.5] * 2, True), ([0.5] * 37 + [1.5] * 3, False), ([0.5] * 39 + [4], False)):
            self.assertEqual(promise.summary_of(0.01, "60s", ratios, 0, 40, [1] * 40)[1], kept)

    def test_a_reference_is_three_times_as_sure_as_a_bar(self):
        """Finer meshes only where the first ones err by more than a third of the shortest bar."""
        case = next(one for one in map(promise.case, range(80)) if one.is_block)
        with tempfile.TemporaryDirectory() as folder:
            kept = promise.Kept(Path(folder, "promise.jsonl"))
            for k, (cells, order, grade) in enumerate(promise.REFERENCES[True] + promise.FINER[True]):
                for factor in promise.WINDOW:
                    kept.obtain(case, f"reference {cells} order {order} grade {grade} at {factor}", lambda k=k: {"mu": 0.3 + 0.01 * (k == 1)})
            first = promise.reference(case, kept)
            self.assertAlmostEqual(first[0], 0.305)
            self.assertEqual(promise.sure_reference(case, kept, first, []), first)
            self.assertEqual(promise.sure_reference(case, kept, first, [0.2, 3.01 * first[1]]), first)
            self.assertAlmostEqual(promise.sure_reference(case, kept, first, [0.2, 2.99 * first[1]])[0], 0.302)

    def test_what_a_sure_mesh_costs(self):
        """Of errors 1 to 101 %, 19 of 20 stay below 96 %; costs are a mean and a median."""
        runs = [(k / 100, 1 if k < 101 else 102) for k in range(1, 102)]
        (name, sure, median, middle, mean), asked = promise_work.rows_of({40: runs}, {0.03: runs[:1]})
        self.assertEqual(name, "40 x 40 cells")
        self.assertAlmostEqual(sure, 0.96)
        self.assertAlmostEqual(median, 0.51)
        self.assertEqual((middle, mean), (1, 2))
        self.assertEqual(asked[0], "to 3 %")

    def test_what_was_computed_is_kept(self):
        case, asked = promise.case(0), []

        def compute():
            asked.append(1)
            return {"mu": 0.3}
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(2):
                kept = promise.Kept(Path(folder, "promise.jsonl"))
                self.assertEqual(kept.obtain(case, "to 0.01", compute)["mu"], 0.3)
        self.assertEqual(len(asked), 1)


if __name__ == "__main__":
    unittest.main()
