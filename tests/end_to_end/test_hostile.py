# SPDX-License-Identifier: GPL-2.0-or-later
"""Some rows of validation/hostile/tries.py; and that it notices what is wrong."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from sanitizer_fixture import runtime

FOLDER = Path(os.environ["AMONTONS_SOURCE"], "validation", "hostile")
sys.path.insert(0, str(FOLDER))
import cases  # noqa: E402
import tries  # noqa: E402


class Hostile(unittest.TestCase):
    def test_some_tries(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = subprocess.run([sys.executable, FOLDER / "tries.py", "--every", "71", "-j", "1", "-o", folder],
                                   capture_output=True, text=True)
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
            rows = Path(folder, "tries.csv").read_text().splitlines(keepends=True)
            self.assertGreater(len(rows), 15)
            Path(folder, "tries.csv").write_text("".join(rows[:-1]) + rows[-1][:20])     # as if cut off while it wrote
            again = subprocess.run([sys.executable, FOLDER / "tries.py", "--every", "71", "-j", "1", "-o", folder],
                                   capture_output=True, text=True)
            self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
            # The one that was cut off, and those that are named by the length of a run.json, which has times in it.
            self.assertRegex(again.stdout, rf"\b{len(rows) - 1} tries, [1-5] of them now")

    def test_some_faults(self):
        """Calls to the file system that fail."""
        with tempfile.TemporaryDirectory() as folder:
            ended = subprocess.run([sys.executable, FOLDER / "faults.py", "--only", "run", "--every", "601", "-j",
                                    "1", "-o", folder],
                                   capture_output=True, text=True)
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
            self.assertGreater(len(Path(folder, "faults.csv").read_text().splitlines()), 4)

    def test_full_disk(self):
        """A disk of some pages, which the history fills: what it was at its last flush can be read."""
        script = ('mount -t tmpfs -o size=$1k tmpfs disk || exit 77; "$2" run scene.yaml -o disk/out --quiet; '
                  'echo "run $?"; "$2" info disk/out; echo "info $?"')
        with tempfile.TemporaryDirectory() as folder:
            cases.put(Path(folder), {"scene.yaml": cases.SCENE.replace("0.0008", "0.003"), "disk/x": "",
                                     "block.geo": cases.ROOT / "meshes/block.geo"})
            ended = subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", "60", tries.PROGRAM],
                                   cwd=folder, capture_output=True, text=True)
        if ended.returncode == 77 or "unshare" in ended.stderr:
            self.skipTest("no file system may be mounted here")
        self.assertIn("run 1\n", ended.stdout)
        self.assertIn("No space left on device", ended.stderr)
        self.assertIn("info 0\n", ended.stdout, ended.stderr)

    @unittest.skipIf("tsan" in runtime(tries.PROGRAM), "with the thread sanitizer there is memory where gmsh looks")
    def test_mesh_that_crashes_gmsh(self):
        """gmsh 4.8 does not look whether a node's number is one that it has room for; 4.13 does."""
        mesh = cases.square().replace("\n8 5 9", "\n8 9223372036854775807 9")
        self.assertNotEqual(mesh, cases.square())
        with tempfile.TemporaryDirectory() as folder:
            cases.put(Path(folder), {"bad.msh": mesh})
            ended = subprocess.run([tries.PROGRAM, "info", "bad.msh"], cwd=folder, capture_output=True, text=True)
        self.assertEqual(ended.returncode, 2)
        self.assertRegex(ended.stderr, r"(?m)^amontons: error: bad.msh: gmsh (crashes while reading it \(.*\): the file is damaged, "
                                       r"or asks for what gmsh cannot make|failed while reading it: Unknown node \d+ in element 8)$")

    def test_faults_are_noticed(self):
        attempt = cases.Try("group", "name", [], {"mine": "mine"}, says="bad.msh", keeps=("mine",))
        sentence = "amontons: error: bad.msh: no"
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            found = lambda status, said, **more: list(tries.faults(
                cases.Try(**(attempt.__dict__ | more)), status, said, folder, None))
            cases.put(folder, attempt.files)
            self.assertEqual(found(2, sentence), [])
            self.assertEqual(found(0, ""), [])
            for wrong in (found(None, ""), found(-11, ""), found(139, sentence), found(2, ""),
                          found(2, "amontons: error: no"), found(1, ""), found(0, "", may=(2,)),
                          found(0, "", answer=True)):
                self.assertTrue(wrong)
            cases.put(folder, {"mine": "yours"})
            self.assertEqual(found(2, sentence), ["lost or changed mine"])


if __name__ == "__main__":
    unittest.main()
