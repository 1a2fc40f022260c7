# SPDX-License-Identifier: GPL-2.0-or-later
"""What the README, docs/commands.md and docs/results.md tell a newcomer is so: the scene, the commands, the tables of arrays,
the lines of Python, the list of folders."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from fnmatch import fnmatch
from pathlib import Path

import h5py
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin")) / "amontons"
README = (SOURCE / "README.md").read_text()
RESULTS = (SOURCE / "docs/results.md").read_text()
COMMANDS = (SOURCE / "docs/commands.md").read_text()
SCENE = SOURCE / "validation/paper/fig1.yaml"
SCRIPTS = {   # words of the launcher that are no commands of the program
    "reproduce": [sys.executable, SOURCE / "validation/paper/reproduce.py"],
    "validate": [sys.executable, SOURCE / "validation/run"]}
LAUNCHER = set(re.findall(r"^(\w+)\)$", (SOURCE / "amontons").read_text(), re.M))   # its own words
SMALL = ["mesh.set.nx=12", "mesh.set.nz=12", "time.until.U=3e-3", "output.fields.every_U=1e-3",
         "output.figures=[]"]


def code_blocks(language, page=README):
    return re.findall(rf"```{language}\n(.*?)```", page, re.S)


def without_comments(text):
    lines = [re.sub(r"\s+#.*", "", line).rstrip() for line in text.splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


class Text(unittest.TestCase):
    def test_scene_is_the_shipped_one(self):
        self.assertEqual(without_comments(code_blocks("yaml")[0]),
                         without_comments(SCENE.read_text()))

    def test_names_all_folders_and_programs(self):
        ignored = [line.strip("/") for line in (SOURCE / ".gitignore").read_text().split()]
        entries = {entry.name for entry in SOURCE.iterdir()
                   if (entry.is_dir() or os.access(entry, os.X_OK)) and entry.name[0] != "."
                   and not any(fnmatch(entry.name, pattern) for pattern in ignored)}
        listed = re.search(r"## Layout\n\n((?:    .*\n)+)", README)[1]
        named = {line.split()[0].rstrip("/") for line in listed.splitlines()}
        self.assertEqual(named, entries)

    def test_pictures_and_files_exist(self):
        for page in (SOURCE / "README.md", *SOURCE.glob("docs/*.md"), *SOURCE.glob("validation/**/*.md")):
            for target in re.findall(r"\]\(([^)#\s]+)[)#]", page.read_text()):
                if "://" not in target:
                    self.assertTrue((page.parent / target).is_file(), f"{page}: {target}")

    def test_programs_can_be_called(self):
        for path in [SOURCE / "amontons", *SOURCE.glob("validation/**/*"), *SOURCE.glob("tests/**/*")]:
            if path.is_file():
                with open(path, "rb") as file:
                    called = file.read(2) == b"#!"
                self.assertTrue(not called or os.access(path, os.X_OK), path)
        told = 0
        for readme in SOURCE.glob("validation/**/README.md"):   # and what they say to call
            for program in re.findall(r"^    (validation/\S+)", readme.read_text(), re.M):
                self.assertTrue(os.access(SOURCE / program, os.X_OK), program)
                told += 1
        self.assertGreater(told, 0)

    def test_changelog_knows_the_version(self):
        version = re.search(r"VERSION (\d+\.\d+\.\d+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertIn(f"\n## {version}", (SOURCE / "CHANGELOG.md").read_text())
        self.assertIn(f"\nversion: {version}\n", (SOURCE / "CITATION.cff").read_text())
        self.assertIn(f'// "{version}"; static storage', (SOURCE / "src/amontons.h").read_text())
        series = version.rpartition(".")[0]
        self.assertIn(f"find_package(amontons {series} ", (SOURCE / "packaging/examples/CMakeLists.txt").read_text())


class Program(unittest.TestCase):
    def test_commands_exist(self):
        """Each command of the table answers --help, and knows the options the table gives it."""
        rows = re.findall(r"^\| `\./amontons (\w+)([^`]*)`", COMMANDS, re.M)
        self.assertGreaterEqual(len(rows), 3)
        for command, usage in rows:
            if command in LAUNCHER and command not in SCRIPTS:
                continue
            with self.subTest(command):
                told = SCRIPTS.get(command, [PROGRAM, command])
                done = subprocess.run([*told, "--help"], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                for option in re.findall(r"--?[a-z]+", usage):
                    self.assertRegex(done.stdout, rf"(?m)(?<!\w){option}\b")

    def test_table_has_every_command(self):
        """... that --help lists, and every word of the launcher."""
        said = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True).stdout
        commands = set(re.findall(r"^  (\w+)  ", said, re.M))
        self.assertGreaterEqual(commands, {"run", "static", "info"})
        rows = "".join(re.findall(r"^\| `\./amontons .*", COMMANDS, re.M))
        self.assertEqual(set(re.findall(r"`\./amontons (\w+)", rows)), commands | LAUNCHER)

    def test_exit_status_of_wrong_input(self):
        done = subprocess.run([PROGRAM, "run", "no-such-scene.yaml"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no-such-scene.yaml", done.stderr)


class Result(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.result = Path(cls.folder.name) / "results/fig1"
        cls.result.parent.mkdir()
        sets = [word for value in SMALL for word in ("--set", value)]
        done = subprocess.run([PROGRAM, "run", SCENE, "-o", cls.result, "--quiet", *sets],
                              capture_output=True, text=True)
        if done.returncode:
            raise AssertionError(done.stderr)

    def test_table_is_what_the_file_holds(self):
        """Arrays, their types, shapes and units, in both directions."""
        rows = re.findall(r"^\| `(\w+/\w+)` \| ([^|]+) \| (\w+) \| ([^|]+) \|", RESULTS, re.M)
        self.assertGreater(len(rows), 20)
        with h5py.File(self.result / "history.h5") as history:
            stored = {f"{group}/{name}": item for group in history
                      for name, item in history[group].items()}
            rows = [row for row in rows   # test_machine.py, test_space_results.py, test_memory.py, test_probes.py
                    if row[0] not in ("series/rod_way", "interface/state", "nodes/y", "nodes/line", "events/slipped",
                                      "faces/nodes", "faces/corners", "pads/shear_across", "pads/slip_across", "interface/contact_area")
                    and not row[0].startswith("probes/")]
            self.assertEqual(set(stored), {name for name, *_ in rows})
            sizes = {"steps": len(history["series/time"]), "nodes": len(history["nodes/x"]),
                     "pads": int(max(history["nodes/pad"][:])) + 1,
                     "peaks": len(history["peaks/U"]), "events": len(history["events/kind"])}
            for name, shape, kind, unit in rows:
                with self.subTest(name):
                    words = [word for word in shape.split(", ") if word != "pads" or sizes[word] > 1]
                    self.assertEqual(stored[name].shape, tuple(sizes[word] for word in words))
                    self.assertEqual(stored[name].dtype, kind)
                    held = stored[name].attrs["unit"]
                    self.assertEqual(held.decode() if isinstance(held, bytes) else held, unit)

    def test_attributes(self):
        block = re.search(r"\| attribute of the file .*?\n\n", RESULTS + "\n\n", re.S)[0]
        named = set(re.findall(r"^\| `(\w+)` \|", block, re.M))
        with h5py.File(self.result / "history.h5") as history:
            held = set(history.attrs)
        self.assertLessEqual(held, named)
        self.assertLessEqual(named - held, {"mu_macroscopic", "critical_length", "warnings", "format", "rod_breadth", "states", "state_unit", "thickness", "probes"})

    def test_table_of_fields(self):
        rows = re.findall(r"^\| `(\.vt[up])` \| ([^|]+) \|", RESULTS, re.M)
        for kind, reader in ((".vtu", vtkXMLUnstructuredGridReader()),
                             (".vtp", vtkXMLPolyDataReader())):
            named = [name for suffix, names in rows if suffix == kind
                     for name in re.findall(r"`(\w+)`", names)]
            reader.SetFileName(str(sorted(self.result.glob(f"fields/*{kind}"))[-1]))
            reader.Update()
            arrays = reader.GetOutput().GetPointData()
            stored = [arrays.GetArrayName(k) for k in range(arrays.GetNumberOfArrays())]
            self.assertEqual(sorted(named), sorted(stored))

    def test_files(self):
        """Every file of the page's table is there (figures were not asked for)."""
        block = re.search(r"\| file \| what it is \|\n(.*?)\n\n", RESULTS, re.S)[1]
        for pattern in re.findall(r"`([\w*./]+\.(?:\w+|\*))`", block):
            if not pattern.startswith("figures/"):
                self.assertTrue(list(self.result.glob(pattern)), pattern)

    def run_code(self, code):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              cwd=self.folder.name)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_python_lines(self):
        self.assertRegex(self.run_code(code_blocks("python")[0]),
                         r"^largest F_T/F_N 0\.\d+ at U = 0\.002")

    def test_python_lines_of_results(self):
        printed = self.run_code(code_blocks("python", RESULTS)[0])
        self.assertRegex(printed, r"^mu_M ")
        self.assertRegex(printed, r"(?m)^quasi-static   from U = 0\.\d+, reach 0\.\d+$")


if __name__ == "__main__":
    unittest.main()
