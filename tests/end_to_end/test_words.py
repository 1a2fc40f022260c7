# SPDX-License-Identifier: GPL-2.0-or-later
"""Odd words on the command line, each refused with the option and what is allowed; what `static`, `cache` and `report`
print besides."""
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
        "reduction.cache=false"]

REFUSED = [
    (["-?"], None),
    (["-V"], None),
    (["help", "run"], None),
    (["run", "x.yaml", "--within", "5min"], "--within: needs --to"),
    (["run", "x.yaml", "--to", "1%", "--within", "5 days"], "--within: found `5 days`"),
    (["run", "x.yaml", "--to", "1%", "--within", "-5s"], "--within: found `-5s`"),
    (["run", "x.yaml", "--checkpoint", "soon"], "--checkpoint: found `soon`"),
    (["run", "x.yaml", "--extend", "mu=3"], "--extend: found `mu=3`; allowed: where the run is to end"),
    (["run", "x.yaml", *["--set", "rod.width=1"] * 199], "too many --set"),
    (["run", "x.yaml", *["--set", "rod.width=1"] * 201], "--set is given more than 200 times"),
    (["run", "x.yaml", "--extend", "t=1", "--overwrite"], "--overwrite"),
    (["info", "x.yaml", "--picture", ""], None),
    (["cache", "what"], "cache takes no argument, `what` is one"),
    (["render", "x", "--width", "10"], "--width 10: a number from 20"),
    (["render", "x", "--width", "wide"], "--width wide"),
    (["render", "x", "--dpi", "20"], "--dpi 20: a number from 50"),
    (["render", "x", "--dpi", ""], "--dpi : a number"),
    (["render", "x", "--dpi", "99999"], "--dpi 99999"),
    (["render", "p.yaml", "--figure", "force"], "--figure has no meaning for a plot or a sweep"),
    (["render", "x", "--plot", "{}"], "--plot has a meaning for the folder of a sweep alone"),
    (["render", "y" * 5000 + ".yaml"], "the path of the plot is too long"),
    (["film", "x", "--seconds", "0"], "--seconds 0: a number above 0"),
    (["film", "x", "--seconds", "long"], "--seconds long"),
    (["film", "x", "--seconds", "3x"], "--seconds 3x"),
    (["film", "x", "--seconds", "inf"], "--seconds inf"),
    (["film", "x", "--magnification", "-1"], "--magnification -1"),
    (["film", "x", "--fps", "0"], "--fps 0"),
    (["film", "x", "--size", "big"], "--size big: width and height"),
    (["film", "x", "--size", "100x"], "--size 100x"),
    (["film", "x", "--size", "100x50x2"], "--size 100x50x2"),
    (["film", "x", "--size", "0x50"], "--size 0x50"),
    (["film", "x", "--size", "50x-2"], "--size 50x-2"),
    (["film", "./"], "./"),
    (["film", "x/"], "x"),
    (["film", "a/../"], "a/.."),
    (["model1d", "x.yaml", "--alpha", ""], "--alpha : a number above 0 up to 10"),
    (["model1d", "x.yaml", "--alpha", "0.2b"], "--alpha 0.2b"),
    (["model1d", "x.yaml", "--alpha", "11"], "--alpha 11"),
    (["model1d", "x.yaml", "--alpha", "nan"], "--alpha nan"),
    (["model1d", "x.yaml", "--points", "9", "--theory"], "--points has no meaning with --theory"),
    (["stability", "x.yaml", "--from", "noon"], "--from"),
    (["report"], "report needs a result folder"),
    (["report", "x", "-o", ""], "-o: the file has no name"),
    (["report", *"x" * 201], "report takes 200 arguments at most"),
    (["report", "x///"], "x"),
    (["report", "x", "y"], "x"),
    (["sweep", "x.yaml", "-o", ""], "-o: the folder has no name"),
    (["sweep", "x.yaml", "-j", "0"], "-j 0: a whole number from 1"),
    (["sweep", "x.yaml", "-j", "2000"], "-j 2000"),
    (["sweep", "x.yaml", "--trust"], "x.yaml"),
    (["static", "x.yaml"], "cannot read x.yaml"),
    (["static", "x.yaml", "y.yaml"], "static takes one scene"),
]


class Words(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-words-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def call(self, *words, **environment):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                              timeout=120, env={**os.environ, **environment})

    def test_odd_words(self):
        for words, says in REFUSED:
            with self.subTest(words=" ".join(words)[:100]):
                done = self.call(*words)
                if says is None:
                    self.assertIn(done.returncode, (0, 2))
                    self.assertTrue(done.stdout or done.stderr)
                    continue
                self.assertIn(done.returncode, (1, 2))
                self.assertIn(says, done.stderr)
                self.assertTrue(done.stderr.startswith("amontons"), done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_element_of_an_array(self):
        for number in (None, "", "x", "-1", "3x", "99999999999"):
            done = self.call("sweep", "--element", "-o", "out", "study.yaml",
                             **({} if number is None else {"SLURM_ARRAY_TASK_ID": number}))
            self.assertEqual(done.returncode, 2)
            self.assertIn("--element is for jobs that `amontons sweep --slurm` submits", done.stderr)
        done = self.call("sweep", "--element", "-o", "out", "study.yaml", SLURM_ARRAY_TASK_ID="0")
        self.assertIn("cannot read study.yaml", done.stderr)

    def test_static(self):
        """With and without a rod, a title, a folder, words."""
        done = self.call("static", FIG1, *TINY, "--set", "title=''", "-o", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith("equilibrium\n"))
        self.assertRegex(done.stdout, r"  rod  +\S+ on 1 nodes, resultant at z = ")
        self.assertIn("  results        out\n", done.stdout)
        done = self.call("static", FIG1, *TINY, "--set", "rod={kind: none}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("  rod ", done.stdout)
        self.assertNotIn("results", done.stdout)
        self.assertEqual(self.call("static", FIG1, *TINY, "--quiet").stdout, "")

    def test_cache(self):
        cache = self.folder / "cache"
        cache.mkdir()
        for number in range(25):
            (cache / f"{number:032x}.basis").write_bytes(b"x" * 100)
        (cache / "mine.txt").write_text("stays")
        done = self.call("cache", AMONTONS_CACHE=str(cache))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("... and 5 more, unused for longer", done.stdout)
        self.assertEqual(self.call("cache", "--clean", AMONTONS_CACHE=str(cache)).returncode, 0)
        self.assertEqual([path.name for path in cache.iterdir()], ["mine.txt"])
        self.assertIn("there is no cache", self.call("cache", AMONTONS_CACHE="").stdout)
        home = self.call("cache", AMONTONS_CACHE="", HOME=str(self.folder), XDG_CACHE_HOME="")
        self.assertEqual(home.returncode, 0)
        blocked = self.folder / "blocked"
        blocked.write_text("no folder")
        self.assertEqual(self.call("cache", AMONTONS_CACHE=str(blocked)).returncode, 1)

    def test_where_the_cache_is(self):
        environment = {key: value for key, value in os.environ.items()
                       if key not in ("AMONTONS_CACHE", "XDG_CACHE_HOME", "HOME")}
        for more, says in (({"XDG_CACHE_HOME": "/x"}, "/x/amontons"), ({"HOME": "/h"}, "/h/.cache/amontons"),
                           ({"XDG_CACHE_HOME": "", "HOME": "/h"}, "/h/.cache/amontons"), ({"HOME": ""}, "there is no cache"),
                           ({}, "there is no cache"), ({"HOME": "/" + "h" * 5000}, "there is no cache")):
            done = subprocess.run([PROGRAM, "cache"], capture_output=True, text=True, env={**environment, **more})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(says, done.stdout)

    def test_comparison_has_a_name(self):
        for name in ("one", "two"):
            done = self.call("run", FIG1, *TINY, "--quiet", "-o", name)
            self.assertEqual(done.returncode, 0, done.stderr)
        done = self.call("report", "one/", "two")
        self.assertEqual((done.returncode, done.stdout), (0, "report written: comparison.html\n"), done.stderr)
        self.assertTrue((self.folder / "comparison.html").is_file())
        done = self.call("report", "one//")
        self.assertEqual(done.stdout, "report written: one/report.html\n")


if __name__ == "__main__":
    unittest.main()
