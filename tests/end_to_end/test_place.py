# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a block stands along x is of no account: the same block at x = 0, 100 and -0.37 has the same lengths."""
import json
import os
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy as np

from cache_fixture import OwnCache

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
PLACES = (0, 100, -0.37)
GEO = """
DefineConstant[begin = 0];
Point(1) = {begin, 0, 0}; Point(2) = {begin + 1, 0, 0}; Point(3) = {begin + 1, 0.5, 0}; Point(4) = {begin, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 21; Transfinite Curve{2, 4} = 13; Transfinite Surface{1}; Recombine Surface{1};
Physical Curve("contact") = {1}; Physical Curve("top") = {3}; Physical Curve("rod") = {4}; Physical Surface("block") = {1};
"""


class Place(OwnCache):
    def call(self, command, name, place, *words):
        (self.folder / "block.geo").write_text(GEO)
        scene = (SOURCE / "validation/paper/fig1.yaml").read_text()
        scene = scene.replace(next(line for line in scene.splitlines() if "block.geo" in line), "  file: block.geo")
        scene = scene.replace(next(line for line in scene.splitlines() if "  set:" in line), f"  set: {{begin: {place}}}")
        (self.folder / "scene.yaml").write_text(scene)
        out = self.folder / f"{name}{place}"
        done = subprocess.run([PROGRAM, command, self.folder / "scene.yaml", "-o", out, *words], capture_output=True,
                              text=True, timeout=120, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out, done.stdout

    def test_run(self):
        results, fronts, said = [], [], []
        for place in PLACES:
            out, text = self.call("run", "run", place, "--set", "output.fields=none", "time.until.U=0.006", "--quiet")
            results.append(json.loads((out / "run.json").read_text())["results"])
            with h5py.File(out / "history.h5") as file:
                self.assertAlmostEqual(file.attrs["trailing_end"], place, places=12)
                self.assertAlmostEqual(file.attrs["critical_length"], results[0]["l_c_over_L"], places=9)
                fronts.append(file["series/front"][:] - place)
        self.assertTrue(0.1 < results[0]["l_c_over_L"] <= 1)
        for other, front in zip(results[1:], fronts[1:]):
            for key in ("l_c_over_L", "l_sc_over_L"):
                self.assertAlmostEqual(other[key], results[0][key], places=9)
            for one, its in zip(results[0]["peaks"], other["peaks"]):
                self.assertAlmostEqual(one["l_c_growth_over_L"], its["l_c_growth_over_L"], places=9)
            np.testing.assert_allclose([front.min(), front.max()], [fronts[0].min(), fronts[0].max()], atol=1e-12)

    def test_stability(self):
        tables = []
        for place in PLACES:
            out, text = self.call("stability", "stable", place)
            found = json.loads((out / "stability.json").read_text())
            tables.append([found["results"]["l_sc_over_L"], found["results"]["l_c_over_L"],
                           *(point["l_over_L"] for point in found["points"])])
        self.assertTrue(0 < tables[0][0] < tables[0][1] <= 1)
        np.testing.assert_allclose(tables[1:], tables[:1] * 2, rtol=0, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
