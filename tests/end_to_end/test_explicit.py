# SPDX-License-Identifier: GPL-2.0-or-later
"""The scene of the explicit reference, its first 30 time units: what a result says of explicit
steps, and that it is the implicit scheme's answer."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

SCENE = Path(os.environ["AMONTONS_SOURCE"], "validation", "benchmark", "explicit.yaml")
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
T_END, RECORDS = 30.0, 2000


def run(folder, scheme):
    """run.json and the history's time series."""
    subprocess.run([PROGRAM, "run", SCENE, "--set", f"time.until={{t: {T_END}}}", "--set",
                    f"time.scheme={scheme}", "-o", folder, "--quiet"], check=True)
    with h5py.File(Path(folder, "history.h5")) as history:
        series = {name: array[:] for name, array in history["series"].items()}
    return json.loads(Path(folder, "run.json").read_text()), series


class Explicit(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.result, cls.series = run(f"{cls.folder.name}/explicit", "explicit")
        _, cls.implicit = run(f"{cls.folder.name}/sdirk2", "sdirk2")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_steps(self):
        """One step size, the explicit step; all its steps counted; the mesh's own unknowns stepped."""
        self.assertEqual(self.result["status"], "done")
        (size,) = self.result["step_sizes"]
        accepted = self.result["steps"]["accepted"]
        self.assertEqual(size["accepted"], accepted)
        self.assertAlmostEqual(size["dt"] * accepted, T_END, places=9)
        self.assertEqual(self.result["model"]["reduced_dofs"], 2 * 21 * 21)
        # 2 dt C < 4 M, and C of one element alone has a rate of 4 (eta1 + eta2) / dx^2 at least.
        self.assertLess(size["dt"], 2 / (4 * 2 / 0.05**2))

    def test_records(self):
        """A row a recording interval."""
        self.assertEqual(len(self.series["time"]), RECORDS + 1)
        numpy.testing.assert_allclose(numpy.diff(self.series["time"]), T_END / RECORDS, rtol=1e-9)
        numpy.testing.assert_allclose(self.series["step_size"][1:], self.result["step_sizes"][0]["dt"])

    def test_answer(self):
        """mu on the ramp, at the implicit scheme's own steps; the start is a jump of velocity."""
        late = self.implicit["time"] > 5
        late &= self.implicit["time"] <= T_END
        found = numpy.interp(self.implicit["time"][late], self.series["time"], self.series["mu"])
        self.assertGreater(late.sum(), 3)
        numpy.testing.assert_allclose(found, self.implicit["mu"][late], rtol=1e-3)


if __name__ == "__main__":
    unittest.main()
