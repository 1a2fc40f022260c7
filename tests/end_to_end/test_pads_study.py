# SPDX-License-Identifier: GPL-2.0-or-later
"""What validation/pads/README.md says, on a few of its points computed now: the published table holds,
dividing the contact raises mu_M where it is said to, lowers it where it is said to, and stability,
which steps no instability in time, finds the same threshold at the same pad."""
import json
import os
import re
import subprocess
import tempfile
import unittest

PROGRAM = os.path.join(os.environ["AMONTONS_BIN"], "amontons")
STUDY = os.path.join(os.environ["AMONTONS_SOURCE"], "validation/pads")


def published(pressure):
    """mu_M of n = 1, 2, ... in the table of the number of pads."""
    with open(os.path.join(STUDY, "tables.md"), encoding="utf-8") as file:
        row = re.search(rf"^\| {pressure} \|.*$", file.read(), re.MULTILINE).group()
    return [float(cell) for cell in row.strip("| \n").split("|")[2:]]


class PadsStudy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="amontons_study_")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_program(self, command, pressure, pads, result):
        out = os.path.join(self.folder, f"{command}{pressure}-{pads}")
        more = ["output={history: false, figures: []}", "time.until.periodic=true"]
        settings = [f"load.pressure={pressure}", f"mesh.set.n={pads}",
                    f"time.until.U={10 * pressure}"] + (more if command == "run" else [])
        words = [word for setting in settings for word in ("--set", setting)]
        subprocess.run([PROGRAM, command, os.path.join(STUDY, "pads.yaml"), "-o", out, "--quiet", *words],
                       check=True, timeout=300)
        with open(os.path.join(out, result), encoding="utf-8") as file:
            return json.load(file)["results"]

    def test_pad_count(self):
        mu = {}
        for pressure, numbers in ((0.003, (2, 4)), (0.006, (2, 4, 8))):
            table = published(pressure)
            for n in numbers:
                found = self.run_program("run", pressure, n, "run.json")
                mu[pressure, n] = found["mu_M"]
                self.assertAlmostEqual(found["mu_M"] / table[n - 1], 1, delta=0.01)
        self.assertGreater(mu[0.006, 4], 1.05 * mu[0.006, 2])   # raised ...
        self.assertLess(mu[0.006, 8], 0.95 * mu[0.006, 4])   # ... and lowered again
        self.assertLess(mu[0.003, 4], 0.97 * mu[0.003, 2])   # lowered from the first division on

    def test_stability(self):
        run = self.run_program("run", 0.006, 11, "run.json")
        path = self.run_program("stability", 0.006, 11, "stability.json")
        self.assertAlmostEqual(path["mu_M"] / run["mu_first_pad"], 1, delta=0.03)
        self.assertGreater(run["mu_M"], 1.05 * path["mu_M"])   # the first fall is arrested at a gap
        slid = [event["pads"] for event in run["pad_slidings"]]
        self.assertIn(1, slid, "the trailing pad slides alone")
        self.assertIn(11, slid)

    def test_tall_pads_alternate(self):
        """Every second fall leaves the leading pad behind; the block slides at the higher branch."""
        run = None
        out = os.path.join(self.folder, "tall")
        subprocess.run([PROGRAM, "run", os.path.join(STUDY, "pads.yaml"), "-o", out, "--quiet", "--set",
                        "mesh.set.n=8", "--set", "mesh.set.pad_height=0.1", "--set",
                        "output={history: false, figures: []}"], check=True, timeout=300)
        with open(os.path.join(out, "run.json"), encoding="utf-8") as file:
            run = json.load(file)["results"]
        slid = [event["pads"] for event in run["pad_slidings"]][-8:]
        self.assertEqual(sorted(slid), [7] * 4 + [8] * 4)
        self.assertTrue(all(a != b for a, b in zip(slid, slid[1:])))
        falls = run["falls"]
        self.assertEqual((falls["period"], [branch["pads"] for branch in falls["branches"]]), (2, [7, 8]))
        low, high = (branch["mu"] for branch in falls["branches"])
        self.assertGreater(high, 1.1 * low)
        self.assertAlmostEqual(run["mu_trusted"] / low, 1, delta=0.01)
        self.assertAlmostEqual(run["mu_M"] / high, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()
