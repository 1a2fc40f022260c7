# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks whose parts slide long before the whole does. By mu alone, each drop within 1 % of the last, they have a period at
once (the rule until 0.2): what came out then, and what comes out now, beside a run of hundreds of drops."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SCENES = Path(os.environ["AMONTONS_SOURCE"], "validation/run_in")
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")


def repeats(drops, tolerance):
    """By mu and the number of pads: the last 2 p + 1 drops, the first of all left out, agree at their place in a round."""
    last = len(drops) - 1
    for period in range(1, 9):
        pairs = [(drops[k], drops[last - (last - k) % period]) for k in range(max(last - 2 * period, 0), last)]
        if last > 2 * period and all(a["pads"] == b["pads"] and abs(a["mu"] - b["mu"]) <= tolerance * b["mu"] for a, b in pairs):
            return True
    return False


class RunIn(unittest.TestCase):
    def run_it(self, name, *settings):
        with tempfile.TemporaryDirectory() as folder:
            words = [word for setting in settings for word in ("--set", setting)]
            done = subprocess.run([PROGRAM, "run", SCENES / f"{name}.yaml", *words, "-o", f"{folder}/run"],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            return json.loads(Path(folder, "run", "run.json").read_text())["results"], done.stdout

    def check(self, name, tolerance, far):
        """What mu alone takes for a period within ten drops, and by how much it is off; the answer holds that of a long run.
        Which drops come is a matter of rounding: within 1 % the trailing part comes back so soon with some kernels only."""
        results, said = self.run_it(name, f"time.periodic_tolerance={tolerance}")
        long, _ = self.run_it(name, "time.until.periodic=false")
        drops = long["drops"]["list"]
        count = next(k for k in range(1, len(drops)) if repeats(drops[:k], tolerance))
        self.assertLess(count, 10)
        self.assertGreater(abs(drops[count - 1]["mu"] / long["mu_hold"] - 1), far)
        self.assertTrue(results["drops"]["enough"] and results["run_in"]["over"])
        self.assertLess(len(results["drops"]["list"]), len(drops) / 3)
        for answer in ("mu_M", "mu_hold"):
            self.assertLess(abs(results[answer] - long[answer]), results[f"{answer}_error"] + long[f"{answer}_error"], answer)
        self.assertNotIn("run-in", said)

    def test_trailing_part(self):
        self.check("low_rod", 0.015, 0.2)

    def test_two_pads_of_three(self):
        self.check("soft_pads", 0.01, 0.02)

    def test_ends_within_the_run_in(self):
        """No mu_hold before the last pad has slipped; how it goes on, and that it cannot go on for ever."""
        results, said = self.run_it("soft_pads", "time.until.U=1.95 mm")
        self.assertIsNone(results["mu_hold"])
        self.assertIsNone(results["mu_M"])
        run_in, drops = results["run_in"], results["drops"]["list"]
        self.assertEqual((run_in["over"], run_in["state"]), (False, "part of the contact has not slipped"))
        rise = (drops[-1]["mu"] - drops[-2]["mu"]) / drops[-1]["mu"]
        self.assertAlmostEqual(run_in["drift"], rise, delta=0.1 * rise)
        self.assertAlmostEqual(run_in["drops_left"], (0.62 / drops[-1]["mu"] - 1) / run_in["drift"], delta=1)
        self.assertRegex(said, r"mu_hold +none yet: run-in still going on \(part of the contact has not slipped, \+0\.3\d* % a "
                               r"drop, over after at most \d+ more\)")


if __name__ == "__main__":
    unittest.main()
