# SPDX-License-Identifier: GPL-2.0-or-later
"""What is kept of answers belongs to the sources that computed it: a build of others takes no row of a sweep, no checkpoint
and no basis of it. Such a build is a copy of this one with another hash in its library."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from cache_fixture import OwnCache

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin"))
BUILD, HEADER = BIN.parent, BIN.parent / "generated" / "computing_sources.h"
SMALL = {"mesh.set.nx": 8, "mesh.set.nz": 8, "time.until.U": 0.004, "output.fields": "none", "output.figures": "[]"}
STUDY = f"""
scene: {SOURCE}/validation/paper/fig1.yaml
set: {{mesh.set.nx: 8, mesh.set.nz: 8, time.until.U: 0.004}}
vary: {{load.pressure: [0.003, 0.006]}}
"""


def hash_in(header):
    return re.search('"([0-9a-f]{64})"', header.read_text())[1]


class OtherBuild(OwnCache):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.other = cls.folder / "bin"
        shutil.copytree(BIN, cls.other, symlinks=True, ignore=shutil.ignore_patterns("amontons_m*", "*chart"))
        library = (cls.other / "libamontons.so").resolve()   # that of an earlier version may lie beside it
        bytes_, word = library.read_bytes(), hash_in(HEADER).encode()
        assert bytes_.count(word) == 1
        library.write_bytes(bytes_.replace(word, word[::-1]))
        cls.environment |= {"AMONTONS_MODULES": ""}

    def call(self, folder, *words, status=0):
        done = subprocess.run([folder / "amontons", *words], capture_output=True, text=True, timeout=120, env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def test_rows_of_a_sweep(self):
        for keep in ("points", "table"):
            study, out = self.folder / f"{keep}.yaml", self.folder / keep
            study.write_text(STUDY + ("keep: table\n" if keep == "table" else ""))
            for folder, computed in ((BIN, 2), (BIN, 0), (self.other, 2), (self.other, 0), (BIN, 0)):
                self.assertIn(f"2 points: {computed} computed", self.call(folder, "sweep", study, "-o", out).stdout)

    def run_scene(self, folder, result, *words, status=0):
        values = [f"{key}={value}" for key, value in SMALL.items()]
        self.call(folder, "run", SOURCE / "validation/paper/fig1.yaml", "--set", *values, "-q", "-o", self.folder / result,
                  *words, status=status)
        return json.loads((self.folder / result / "run.json").read_text())

    def test_bases_and_checkpoints(self):
        made = self.run_scene(BIN, "first")
        again = self.run_scene(BIN, "second")
        others = self.run_scene(self.other, "third")
        self.assertEqual([run["model"]["from_cache"] for run in (made, again, others)], [False, True, False])
        self.assertEqual(made["sources"], again["sources"])
        self.assertNotEqual(made["sources"], others["sources"])
        files = {path: path.read_bytes() for path in (self.folder / "first").rglob("*") if path.is_file()}
        words = ["run", SOURCE / "validation/paper/fig1.yaml", "--set", *[f"{key}={value}" for key, value in SMALL.items()],
                 "-q", "-o", self.folder / "first", "--extend", "U=0.005"]
        refused = self.call(self.other, *words, status=2)
        self.assertIn("first/checkpoint.bin: it was saved by a build of other sources", refused.stderr)
        self.assertIn(others["sources"][:8], refused.stderr)
        self.assertEqual(files, {path: path.read_bytes() for path in files})
        self.call(BIN, *words)


class Hash(unittest.TestCase):
    """Which files are in it, and that it depends on nothing else."""

    def inputs(self):
        if not (BUILD / "build.ninja").exists():
            self.skipTest("built without ninja")
        told = subprocess.run(["ninja", "-C", BUILD, "-t", "query", "generated/computing_sources.h"], capture_output=True,
                              text=True, check=True).stdout
        inputs = (line.strip(" |") for line in told.split("outputs:")[0].splitlines())   # a path may have spaces
        return sorted(Path(path) for path in inputs if path.startswith(str(SOURCE / "src")))

    def hash(self, root, files, words):
        header = Path(tempfile.mkdtemp(dir=root)) / "header.h"
        subprocess.run(["cmake", "-D", f"SOURCE={root}", "-D", f"HEADER={header}", "-D", "FILES=" + ";".join(map(str, files)),
                        "-D", f"WORDS={words}", "-P", SOURCE / "packaging/computing_sources.cmake"], check=True)
        return hash_in(header)

    def test_what_computes_counts(self):
        inside = {str(path.relative_to(SOURCE / "src")) for path in self.inputs()}
        for path in ("algebra/sparse.c", "io/mesh/mesh_read.c", "fem/assembly.c", "friction/friction.h", "reduction/reduction.c", "stepping/sdirk.c",
                     "record/drops.c", "base/units.c", "model/model.c", "run/report.c", "CMakeLists.txt"):
            self.assertIn(path, inside)
        for path in (SOURCE / "src").rglob("*.[ch]"):
            name = str(path.relative_to(SOURCE / "src"))
            if name.startswith(("cli/", "page/", "study/", "io/text/html", "io/video", "run/info/", "run/result/pictures")):
                self.assertNotIn(name, inside)
            elif not name.startswith(("io/", "run/")):
                self.assertIn(name, inside)

    def test_bytes_and_names_alone(self):
        words = re.search(r"WORDS=(gmsh [0-9.]+)", (BUILD / "build.ninja").read_text())[1]
        with tempfile.TemporaryDirectory(prefix="amontons-sources-") as place:
            root = Path(place)
            copies = [root / path.relative_to(SOURCE) for path in self.inputs()]
            for copy in copies:
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(SOURCE / copy.relative_to(root), copy)
            built = hash_in(HEADER)
            self.assertEqual(self.hash(root, copies, words), built)
            self.assertEqual(self.hash(root, copies[::-1], words), built)
            self.assertNotEqual(self.hash(root, copies, words + "."), built)
            self.assertNotEqual(self.hash(root, copies[1:], words), built)
            copies[7].write_text(copies[7].read_text() + "\n")
            self.assertNotEqual(self.hash(root, copies, words), built)


if __name__ == "__main__":
    unittest.main()
