# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages about results that lack something: a run without a history, in SI, without events; a sweep with failed points,
many values, without figures, arrays or a report."""
import json
import os
import pty
import re
import resource
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py

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

    def page(self, *names):
        done = self.call("report", *names, "-o", "page.html", "--overwrite")
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
        self.assertIn("There is no <i>μ</i><sub>M</sub>: the block as a whole did not slide in this run.", page)
        (self.folder / "run/history.h5").write_bytes(b"damaged")
        self.assertIn("history.h5", self.page("run"))

    def test_comparison_without_a_curve(self):
        """A run of one step and one whose history is damaged cost the page their own curves only."""
        for name in ("one", "two", "three", "four"):
            done = self.call("run", FIG1, *TINY, f"title={name}", "-o", name, "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "two/history.h5", "a") as history:
            for series in history["series"].values():
                series.resize(1, axis=0)
        (self.folder / "three/history.h5").write_bytes(b"damaged")
        page = self.page("one", "two", "three", "four")
        self.assertIn("two has no curve here: while reading the result in two: the history holds 1 step", page)
        self.assertIn("three has no curve here: while reading the result in three", page)
        self.assertEqual(re.findall(r"class='(curve\d)' d='M70\.0 [^']{60}", page), ["curve1", "curve2"])
        self.assertRegex(page, r"curve1' d='M2 6h30'/></svg> one</li><li>.*curve2' d='M2 6h30'/></svg> four</li></ul>")
        page = self.page("two", "three")
        self.assertIn("two has no curve here", page)
        self.assertNotIn("<svg class='chart'", page)

    def test_events_in_metres(self):
        """More of them than a page lists."""
        done = self.call("run", FIG1, *TINY, *SI, "time.until={U: 0.008}", "-o", "run", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.page("run")
        self.assertRegex(page, r"<tr class='kind\d'>")

    def test_numbers_by_hand(self):
        """Of two reports that are edited: errors of all sizes, states, scenes that differ."""
        done = self.call("run", FIG1, *TINY, "output.history=false", "-o", "one", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((self.folder / "one/run.json").read_text())
        for name, value, error, status in (("two", 0.25, 0.003, "done"), ("three", -12345.678, 5, "failed"),
                                           ("four", 3.0, 1e-12, "done"), ("five", None, 0.1, "running")):
            (self.folder / name).mkdir()
            report["status"] = status
            report["message"] = "no more"
            for mu in ("mu_M", "mu_hold"):
                report["results"] |= {mu: value, f"{mu}_error": error, f"{mu}_known_to": error,
                                      f"{mu}_error_parts": {"mesh": error, "branches": None, "drops": 0}}
            report["scene"]["rod"]["extra"] = [[1,   2], {"a b": "  c  "}, True]
            report["scene"]["load"].pop("supports", None)
            (self.folder / name / "run.json").write_text(json.dumps(report, indent=None if name == "two" else 3))
        self.assertIn("0.2500&nbsp;±&nbsp;0.0030", self.page("two"))
        self.assertIn("no more", self.page("three"))
        self.page("four")
        self.page("five")
        done = self.call("report", "one", "two", "three", "four", "five", "-o", "all.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.folder / "all.html").read_text()
        self.assertIn("three failed: its own report says why", page)
        self.assertIn("rod.extra", page)

    def test_bar_of_a_sweep(self):
        """On a terminal a last line with the progress of the whole."""
        (self.folder / "study.yaml").write_text(STUDY.replace("points: 16", "points: 2"))
        ours, its = pty.openpty()
        process = subprocess.Popen([PROGRAM, "sweep", "study.yaml", "-o", "few", "-j", "1"], cwd=self.folder, stderr=its,
                                   stdout=subprocess.DEVNULL)
        os.close(its)
        said = b""
        while True:
            try:
                more = os.read(ours, 4096)
            except OSError:
                break
            if not more:
                break
            said += more
        os.close(ours)
        self.assertEqual(process.wait(), 1)
        self.assertIn(b"4 of 4 points, 2 failed, 0:00 left", said)

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
        self.assertIn("<h1>many", self.page("many"))     # of the table alone, as `keep: table` leaves it
        table = self.folder / "many/sweep.csv"
        table.write_text("a,b\n1,2\n")
        done = self.call("report", "many")
        self.assertEqual(done.returncode, 2)
        self.assertIn("sweep.csv is no table of a sweep", done.stderr)

    def test_sweep_of_many_points(self):
        """100 000 points, keys of few values and of many: a page in a second or two of processor time (comparing each cell with all
        before it took minutes), small enough for a browser."""
        folder = self.folder / "great"
        folder.mkdir()
        rows = [(k // 50000, k % 1000) for k in range(100_000)]
        (folder / "sweep.csv").write_text("point,slow,fast,mu_M,status,message,warnings,run\n" + "".join(
            f"{k},{slow},{fast},0.3,done,,,r{k}\n" for k, (slow, fast) in enumerate(rows)))
        with h5py.File(folder / "sweep.h5", "w") as file:
            for key, values in zip(("slow", "fast"), zip(*rows)):
                file[f"scene/{key}"] = values
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        page = self.page("great")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertLess(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 5)
        self.assertIn("500 of 100000 points", page)
        self.assertIn(">slow</th><td>0, 1</td>", page)
        self.assertRegex(page, ">fast</th><td>0, 1, 2, [0-9, ]*13, …</td>")
        self.assertLess(len(page), 1e6)


if __name__ == "__main__":
    unittest.main()
