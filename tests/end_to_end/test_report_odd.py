# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages about results that lack something: a run without a history, in SI, without events; a sweep with failed points,
many values, without figures, arrays or a report."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
FIG1 = SOURCE / "validation/paper/fig1.yaml"
TINY = ["--set", "mesh.set.nx=6", "mesh.set.nz=4", "time.until={t: 1}", "output.fields=none", "output.figures=[]",
        "reduction.cache=false", "rod.height=0", "rod.width=0"]
SI = ["units=si", "material={young: 1 Pa, poisson: 0.34, density: 1, eta1: 1, eta2: 1}"]
STUDY = f"""scene: {FIG1}
title: Many
set: {{mesh.set.nx: 6, mesh.set.nz: 4, rod.height: 0, rod.width: 0, time.until.t: 1, reduction.cache: false}}
vary:
  load.pressure: {{linear: [1e-3, 1.6e-2], points: 16}}
  groups.rod: [rod, roof]
"""


class Odd(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-odd-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def call(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=120)

    def page(self, name):
        done = self.call("report", name, "-o", "page.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "page.html").read_text()

    def test_without_history(self):
        done = self.call("run", FIG1, *TINY, "output.history=false", *SI, "title=''", "-o", "run", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.page("run")
        self.assertNotIn("id='events'", page)
        self.assertIn("SI", page)
        self.assertNotIn("<img", page)

    def test_without_events(self):
        done = self.call("run", FIG1, *TINY, *SI, "-o", "run", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.page("run")
        self.assertIn("<img", page)
        self.assertIn("\u202fm", page)      # U in metres
        (self.folder / "run/run.gif").write_bytes(b"GIF89a")
        self.assertIn("image/gif", self.page("run"))
        (self.folder / "run/history.h5").write_bytes(b"damaged")
        self.assertIn("history.h5", self.page("run"))

    def test_sweep(self):
        (self.folder / "study.yaml").write_text(STUDY)
        done = self.call("sweep", "study.yaml", "-o", "many", "-j", "1", "--quiet")
        self.assertEqual(done.returncode, 1)
        self.assertIn("16 of 32 points failed", done.stderr)
        self.assertIn("... and more, in many/sweep.csv", done.stderr)
        page = self.page("many")
        self.assertIn("Many", page)
        self.assertIn("…", page)            # not all sixteen pressures
        self.assertNotIn("id='ranking'", page)
        (self.folder / "many/sweep.h5").unlink()
        page = self.page("many")
        self.assertIn("<h1>many", page)     # the folder's name
        shutil.rmtree(self.folder / "many/points")
        done = self.call("report", "many")
        self.assertEqual(done.returncode, 2)
        self.assertIn("not the result of a run or a sweep", done.stderr)
        table = self.folder / "many/sweep.csv"
        table.write_text("a,b\n1,2\n")
        done = self.call("report", "many")
        self.assertEqual(done.returncode, 2)
        self.assertIn("sweep.csv is no table of a sweep", done.stderr)


if __name__ == "__main__":
    unittest.main()
