# SPDX-License-Identifier: GPL-2.0-or-later
"""The built program as its users call it: help, exit statuses, messages, progress, signals."""
import fcntl
import json
import math
import os
import pty
import re
import resource
import shutil
import signal
import struct
import subprocess
import tempfile
import termios
import time
import unittest
from pathlib import Path

from preload_fixture import preload
from sanitizer_fixture import runtime

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
FIG1 = SOURCE / "validation" / "paper" / "fig1.yaml"
COARSE = ["--set", "mesh.set.nx=10", "mesh.set.nz=10"]
PLAIN = ["--set", "output.fields=none", "--set", "output.figures=[]"]


def amontons(*words, cwd=None, **environment):
    return subprocess.run([PROGRAM, *map(str, words)], cwd=cwd, capture_output=True, text=True,
                          timeout=120, env={**os.environ, **environment})


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-cli-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def scene(self, text):
        path = self.folder / "scene.yaml"
        path.write_text(text)
        return path


class Help(unittest.TestCase):
    def test_version(self):
        done = amontons("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^amontons \d+\.\d+\.\d+( \([0-9a-f]{7,}(, changed)?\))?\n"
                                      r"built with gmsh 4\.\S+, HDF5 [12]\.\S+, VTK 9\.\S+, .*xxHash \S+\n"
                                      r"computes with OpenBLAS's \w+ kernels(, as OPENBLAS_CORETYPE asks; .*)?\n"
                                      rf"meshes and example scenes: {re.escape(str(SOURCE))}\n$")

    def test_kernels(self):
        """What OpenBLAS takes, whatever it is told by a name that does not exist; a choice stays."""
        said = {name: amontons("--version", OPENBLAS_CORETYPE=name).stdout.splitlines()[2]
                for name in ("none", "Prescott")}
        self.assertNotIn("Prescott", said["none"])
        self.assertRegex(said["Prescott"], r"Prescott kernels, as OPENBLAS_CORETYPE asks; this processor could run \w+$")

    def unknown(self, *words, **environment):
        """The program with an OpenBLAS that does not know the processor; its standard output."""
        plain = {name: value for name, value in os.environ.items() if name != "OPENBLAS_CORETYPE"}
        preloaded = preload(PROGRAM.parents[1] / "tests/unknown_processor.so")
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=60, env=plain | preloaded | environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_a_processor_that_openblas_does_not_know(self):
        """The program chooses kernels and executes itself, once; not against a choice, not for ever."""
        best = re.search(r"could run (\w+)$", amontons("--version", OPENBLAS_CORETYPE="Prescott").stdout, re.M)[1]
        self.assertIn(f"OpenBLAS's {best} kernels\n", self.unknown("--version"))
        self.assertIn("OpenBLAS's Nehalem kernels, as", self.unknown("--version", OPENBLAS_CORETYPE="Nehalem"))
        self.assertIn("OpenBLAS's Prescott kernels, as", self.unknown("--version", UNKNOWN_ALWAYS="yes"))
        self.assertIn(f"OpenBLAS's {best} kernels\n", self.unknown("--version", AMONTONS_AGAIN="1"))   # of another process

    def test_what_it_sets_is_not_inherited(self):
        """A job that it submits runs on another processor."""
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            for name in ("sbatch", "scancel", "squeue", "scontrol"):
                (folder / name).write_text(f"#!/bin/sh\nenv > {folder}/inherited\n[ $1 = --version ]\n")
                (folder / name).chmod(0o755)
            (folder / "study.yaml").write_text(f"scene: {FIG1}\nvary: {{load.pressure: [0.002, 0.006]}}\nrecord: [mu_max]\n")
            with self.assertRaises(AssertionError):   # it refuses the array
                self.unknown("sweep", folder / "study.yaml", "--slurm", "-o", folder / "points", PATH=f"{folder}:{os.environ['PATH']}",
                             OMP_NUM_THREADS="3")
            inherited = (folder / "inherited").read_text()
        for name in ("OPENBLAS_CORETYPE", "AMONTONS_AGAIN"):
            self.assertNotIn(name, inherited)
        self.assertIn("OMP_NUM_THREADS=3\n", inherited)

    def test_variables_of_openmp(self):
        """libgomp, which the program does not use, has nothing to say."""
        done = amontons("info", "keys", OMP_NUM_THREADS="0")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_main_help_names_every_command(self):
        for words in (["--help"], ["help"], ["-h"]):
            done = amontons(*words)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            for word in ("info keys", "Exit status", "amontons run "):
                self.assertIn(word, done.stdout)
            for source in (SOURCE / "src/cli").glob("cmd_*.c"):
                self.assertRegex(done.stdout, rf"(?m)^  {source.stem.removeprefix('cmd_')} ")

    def test_help_of_each_command(self):
        words = {"run": ["SCENE", "--output", "--set", "--overwrite", "--quiet", "Example",
                         "amontons run validation/paper/fig1.yaml"],
                 "static": ["SCENE", "--output", "--set", "amontons static "],
                 "render": ["RESULT", "--figure", "force, slip-map", "amontons render "],
                 "film": ["RESULT", "--output", ".webm", "--cycle", "amontons film "],
                 "sweep": ["STUDY", "--jobs", "--slurm", "vary", "Example", "amontons sweep "],
                 "info": ["FILE", ".msh", "keys", "amontons info meshes/pads.geo"]}
        for command, wanted in words.items():
            first, second = amontons(command, "--help"), amontons("help", command)
            self.assertEqual((first.returncode, first.stderr), (0, ""), command)
            self.assertEqual(first.stdout, second.stdout)
            for word in wanted:
                self.assertIn(word, re.sub(r"\s+", " ", first.stdout))
            self.assertLessEqual(max(map(len, first.stdout.splitlines())), 80)

    def test_every_figure_is_in_the_help(self):
        names = re.findall(r'X\(FIGURE_\w+, "([\w-]+)"', (SOURCE / "src/amontons_pictures.h").read_text())
        self.assertGreaterEqual(len(names), 3)
        shown = re.sub(r"\s+", " ", amontons("render", "--help").stdout)
        for name in names:
            self.assertIn(name, shown)

    def test_key_reference(self):
        done = amontons("info", "keys")
        self.assertEqual(done.returncode, 0)
        for key in ("material.young", "output.fields.every_U", "time.until.periodic"):
            self.assertIn(f"| `{key}` |", done.stdout)

    def test_full_output_device(self):
        with open("/dev/full", "w") as full:
            for words in (["--help"], ["info", "keys"]):
                done = subprocess.run([PROGRAM, *words], stdout=full, stderr=subprocess.PIPE)
                self.assertEqual(done.returncode, 1)
                self.assertIn(b"error: cannot write", done.stderr)


class Misuse(InFolder):
    def assert_refused(self, words, *parts, status=2):
        done = amontons(*words, cwd=self.folder)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertEqual(done.stdout, "")
        for part in parts:
            self.assertIn(part, done.stderr)
        return done.stderr

    def test_words(self):
        self.assert_refused([], "amontons --help")
        self.assert_refused(["rum"], "unknown command `rum`; did you mean `run`?")
        self.assert_refused(["zzz"], "unknown command `zzz`", "amontons --help")
        self.assert_refused(["help", "inof"], "did you mean `info`?")
        self.assert_refused(["run"], "run needs a scene")
        self.assert_refused(["run", "a.yaml", "b.yaml"], "run takes one scene")
        self.assert_refused(["run", "--quite"], "run: unrecognized option '--quite'")
        self.assert_refused(["run", FIG1, "-o", ""], "-o: the folder has no name")
        self.assert_refused(["run", FIG1, "--set"], "requires an argument")
        self.assert_refused(["info"], "info needs a file")
        self.assert_refused(["info", "a", "b"], "info takes one file")
        self.assert_refused(["render"], "render needs a result folder")
        self.assert_refused(["render", "a", "b"], "render takes one result folder")

    def test_scenes(self):
        self.assert_refused(["run", "none.yaml"], "amontons: error: cannot read none.yaml")
        self.assert_refused(["run", self.folder], "is a folder")
        self.assert_refused(["run", FIG1, "--set", "load.pressure=much"],
                            "--set load.pressure", "found `much`", "a number >= 0")
        self.assert_refused(["run", FIG1, "--set", "load.pressur=1"], "did you mean `load.pressure`")
        bad = self.scene("title: x\nmaterial: {yung: 1}\n")
        shown = self.assert_refused(["run", bad], "unknown key; did you mean `material.young`?")
        self.assertIn(f"{bad}:2:12: ", shown)
        line, caret = shown.splitlines()[-2:]
        self.assertEqual(line[caret.index("^"):][:4], "yung")

    def test_what_the_mesh_contradicts(self):
        """Found after the scene was read: the same place, as line and key."""
        text = FIG1.read_text().replace("../../meshes", str(SOURCE / "meshes")) + "groups: {rod: rod}\n"
        for line, old, new, key in ((4, "block.geo", "blok.geo", "mesh.file"), (9, "height: 0.25", "height: 3", "rod.height"),
                                    (19, "rod: rod", "rod: stick", "groups.rod"), (19, "rod: rod", "top: lid", "groups.top"),
                                    (19, "rod: rod", "contact: sole", "groups.contact")):
            with self.subTest(key):
                path = self.scene(text.replace(old, new))
                self.assert_refused(["run", path, "-q", "--overwrite", *COARSE, *PLAIN], f"scene.yaml:{line}: {key}: ")
        self.assert_refused(["run", FIG1, "-q", *COARSE, *PLAIN, "groups.top=lid"], "fig1.yaml: groups.top, as set: ")

    def test_numbers_beyond_all_measure(self):
        """Sizes whose products are 0 or infinite: steps of such a size were halved for ever."""
        for setting in ("load.pressure=4.9e-324", "friction.critical_velocity=5e-324", "mesh.set.length=1e300"):
            self.assert_refused(["run", FIG1, "-q", *COARSE, *PLAIN, setting], "numbers of a size from 1e-60 to 1e+60")

    def test_result_folders_that_cannot_be(self):
        """Wrong input, not a disk that fails."""
        (self.folder / "file").write_text("x")
        self.assert_refused(["run", FIG1, "-o", "file"], "is a file, not a folder")
        self.assert_refused(["run", FIG1, "-o", "file/below"], "cannot make the folder")
        self.assert_refused(["run", FIG1, "-o", 300 * "x"], "too long")
        self.assert_refused(["stability", FIG1, "-o", "file"], "is a file, not a folder")
        self.assert_refused(["sweep", SOURCE / "validation/pads/designs.yaml", "-o", "file"], "is a file, not a folder")

    def test_a_geo_that_runs_commands(self):
        """Refused before gmsh sees it, however it is hidden; allowed with --trust."""
        block = (SOURCE / "meshes/block.geo").read_text()
        geo, inner = self.folder / "a.geo", self.folder / "inner.geo"
        scene = self.scene(FIG1.read_text().replace("../../meshes/block.geo", "a.geo"))
        touch = f'SystemCall "touch {self.folder}/ran";'
        inner.write_text(touch)
        process = f'Field[1] = ExternalProcess; Field[1].CommandLine = "touch {self.folder}/ran; cat"; Background Field = 1;'
        for text in (touch, f"s = '\"'; {touch} t = '\"';", f'NonBlocking{touch}', 'Include "inner.geo";',
                     'Merge "inner.geo";', 'Include Str("inner", ".geo");', process):
            with self.subTest(text):
                geo.write_text(block + text + "\n")
                for command in (["info", geo], ["static", scene],
                                ["run", scene, "-q", "--overwrite", *COARSE, *PLAIN]):
                    self.assert_refused(command, ".geo:", "--trust")
                self.assertFalse((self.folder / "ran").exists())
        for text in (f'Printf("x") > "{self.folder}/ran";', f'Print "{self.folder}/ran";', f'Save "{self.folder}/ran";',
                     f'General.LogFileName = "{self.folder}/ran";', f"// {touch}", "General.Terminal = 1;", "Exit;"):
            with self.subTest(text):
                geo.write_text(block + text + "\n")
                self.assertIn("1600 Q4", self.informed(geo))
                self.assertFalse((self.folder / "ran").exists())
        subprocess.run(["gmsh", "-2", SOURCE / "meshes/block.geo", "-o", self.folder / "a.msh"], capture_output=True, check=True)
        for options in ("a.geo.opt", "a.msh.opt"):      # gmsh would read them
            (self.folder / options).write_text(touch)
        geo.write_text(block)
        self.informed(geo)
        self.informed(self.folder / "a.msh")
        self.assertFalse((self.folder / "ran").exists())
        for options in ("a.geo.opt", "a.msh.opt"):
            (self.folder / options).unlink()
        mesh = self.folder / "a.msh"
        mesh.write_text(f"// \n{touch}\n/*\n$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$EndElements\n*/\n")
        self.assert_refused(["info", mesh], "does not begin with $MeshFormat")
        self.assertFalse((self.folder / "ran").exists())
        for name, text in (("evil.geo", touch), ("real.step", "ISO"), ("real.step.opt", touch)):
            (self.folder / name).write_text(text)
        geo.write_text(block + 'Merge "part.step";\n')
        for target in ("evil.geo", "real.step"):        # in one process, where no filter stops a command
            (self.folder / "part.step").symlink_to(target)
            amontons("info", geo, cwd=self.folder, AMONTONS_APART="")
            self.assertFalse((self.folder / "ran").exists(), target)
            (self.folder / "part.step").unlink()
        geo.write_text(block + touch + "\n")
        done = amontons("info", geo, "--trust", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "ran").exists())

    def informed(self, path, *words):
        """What info says of a mesh: the block, and nothing before it."""
        cache = self.folder / "cache"
        shutil.rmtree(cache, ignore_errors=True)    # so that gmsh reads it
        done = amontons("info", path, *words, cwd=self.folder, AMONTONS_CACHE=str(cache))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith("mesh "), done.stdout)
        return done.stdout

    def test_a_geo_that_meshes_itself(self):
        """Its own mesh is kept, with all that it did to it; options for writing a mesh count."""
        corners = "".join(f"Point({k}) = {{{x}, {y}, 0, 10}};\n" for k, (x, y) in enumerate(((0, 0), (100, 0), (100, 50), (0, 50)), 1))
        block = corners + """Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4};
            Plane Surface(1) = {1}; Physical Curve("contact") = {1}; Physical Curve("top") = {3}; Physical Curve("rod") = {4};
            Physical Surface("body") = {1};\n"""
        geo = self.folder / "a.geo"
        for text, wanted in (("", r"\b(\d+) T3\n  x from 0 to 100,"), ("Mesh 2; SetOrder 2;", r"\d+ T6\n"), ("Mesh 2; SetOrder 2; Exit;", r"\d+ T6\n"),
                             ("Mesh 2; RecombineMesh;", r"\d+ Q4\b"), ("Mesh.ScalingFactor = 0.001;", r"x from 0 to 0.1,"),
                             ("Mesh 1; Mesh.ScalingFactor = 0.001;", r"x from 0 to 0.1,"), ("Mesh.SaveAll = 1;", r"\d+ T3\n")):
            with self.subTest(text):
                geo.write_text(block + text + "\n")
                self.assertRegex(self.informed(geo), wanted)
        counts = {}
        for text in ("", "Mesh 2; RefineMesh;"):
            geo.write_text(block + text + "\n")
            counts[text] = int(re.search(r"(\d+) T3", self.informed(geo))[1])
        self.assertEqual(counts["Mesh 2; RefineMesh;"], 4 * counts[""])

    def test_what_gmsh_says(self):
        """An error after which there is a mesh is a warning; one in the script has its file and line."""
        geo, box = self.folder / "a.geo", "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, .6, .4};\n"
        groups = 'Physical Surface("contact") = {5}; Physical Surface("rod") = {1}; Physical Surface("top") = {6}; Physical Volume("b") = {1};\n'
        geo.write_text(box + groups + "Mesh.MeshSizeMax = .3;\nMesh.OptimizeNetgen = 1;\n")
        if "gmsh made it" in self.informed(geo):    # where its gmsh has no Netgen
            self.assertIn("Netgen", self.informed(geo))
        (self.folder / "b.geo").write_text("x = 1;\ny = nowhere(;\nnowhere = 2;\n")
        geo.write_text(box + 'Include "b.geo";\n' + groups)
        self.assert_refused(["info", geo], "b.geo:2: ", "syntax error")

    def test_files_of_no_known_kind(self):
        self.assert_refused(["info", "none"], "none: No such file")
        self.assert_refused(["info", self.folder], "not a result folder")
        (self.folder / "a.txt").write_text("x")
        self.assert_refused(["info", "a.txt"], "a mesh (.msh, .geo), a scene")
        self.assert_refused(["render", "none"], "cannot open the result none")
        self.assert_refused(["render", "a.txt"], "is a file, not a result folder")
        self.assert_refused(["render", self.folder], str(self.folder))

    def test_unreadable_scene(self):
        bad = self.scene("title: x\n")
        bad.chmod(0)
        # Root reads everything, unless it gives that right away.
        words = ["setpriv", "--bounding-set=-dac_override,-dac_read_search"] * (os.geteuid() == 0)
        done = subprocess.run([*words, PROGRAM, "run", bad], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("Permission denied", done.stderr)


class Info(unittest.TestCase):
    def test_scene(self):
        done = amontons("info", FIG1)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("Figure 1 of the paper", done.stdout)
        self.assertRegex(done.stdout, r"material.poisson +0.34\n")
        self.assertRegex(done.stdout, r"groups.top +top +\(default\)\n")

    def test_mesh(self):
        done = amontons("info", SOURCE / "meshes" / "block.geo")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        nodes, elements = map(int, re.search(r"(\d+) nodes, (\d+) elements", done.stdout).groups())
        cells = re.search(r"contact +curve +(\d+) edges +(\d+) nodes +length ([\d.]+)", done.stdout)
        along, contact_nodes, length = int(cells[1]), int(cells[2]), float(cells[3])
        self.assertEqual(contact_nodes, along + 1)
        self.assertEqual(nodes, (along + 1) * (elements // along + 1))   # a grid of Q4
        self.assertEqual(length, 1)
        for name in ("top", "rod", "body"):
            self.assertRegex(done.stdout, rf"\n +{name} ")


class OthersWords(InFolder):
    def test_nothing_that_a_terminal_obeys(self):
        """ESC and BEL in names of folders and files; by every command that says them."""
        folder = self.folder / "a\033[31m\007b"
        folder.mkdir()
        shutil.copyfile(FIG1, folder / "s.yaml")
        few = ["--set", f"mesh.file={SOURCE}/meshes/block.geo", "mesh.set.nx=6", "mesh.set.nz=6", "time.until.U=1e-4",
               "output.fields=none", "output.figures=[]"]
        (folder / "study.yaml").write_text(f"scene: s.yaml\nset: {{{', '.join(w.replace('=', ': ', 1) for w in few[1:])}}}\n"
                                           "vary: {load.pressure: [0.003]}\n")
        for words, status in ((["run", folder / "s.yaml", *few, "-o", folder / "r"], 0), (["info", folder / "r"], 0),
                              (["info", folder / "s.yaml", *few[:2]], 0), (["run", folder / "none"], 2), (["report", folder / "r"], 0),
                              (["run", folder / "s.yaml", *few, "-o", folder / "r"], 2), ([f"{folder}"], 2), (["render", folder], 2),
                              (["sweep", folder / "study.yaml", "-o", folder / "sweep"], 0)):
            done = amontons(*words, cwd=self.folder)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertIn(r"a\x1b[31m\x07b", done.stdout + done.stderr, words[0])
            self.assertNotRegex(done.stdout + done.stderr, "[\0-\x08\x0b-\x1f\x7f-\x9f]", words[0])

    def test_characters_that_cannot_be_shown(self):
        """Refused where they are read, not when a picture is drawn; also by a study and in the names of a mesh."""
        for text, place in (('title: "a\\uFFFEb"', "1:8: title: the character U+FFFE"), ("title: '\uffff'", "1:8: title: the character U+FFFF"),
                            ('groups:\n  contact: [a, "\\u0085"]', "2:16: contact: the character U+0085"),
                            ('title: "\\e[31m"', "1:8: title: the character U+001B"), ("title: \x9b31m", "1:8: title: the character U+009B")):
            done = amontons("run", self.scene(text), "-o", self.folder / "out")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"scene.yaml:{place}, which no page or picture can show", done.stderr)
        self.assertIn("--set title:1:7: the character U+FFFE", amontons("run", FIG1, "--set", "title=\ufffe").stderr)
        self.assertIn(":1:8: title: the character U+FDD0", amontons("sweep", self.scene("title: \ufdd0")).stderr)
        mesh = self.folder / "named.geo"
        mesh.write_text((SOURCE / "meshes/block.geo").read_text().replace('Physical Curve("contact")', 'Physical Curve("contact\a")'))
        self.assertIn("has the character U+0007", amontons("info", mesh).stderr)


class Run(InFolder):
    def test_result_and_closing_lines(self):
        done = amontons("run", FIG1, *COARSE, "output.fields=none", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = self.folder / "fig1-result"   # the default name
        run = json.loads((result / "run.json").read_text())
        self.assertEqual(run["status"], "done")
        self.assertEqual(run["scene"]["mesh"]["set"]["nx"], 10)
        self.assertTrue((result / run["scene"]["mesh"]["file"]).samefile(SOURCE / "meshes/block.geo"))
        shown = float(re.search(r"mu_M +([\d.]+)", done.stdout)[1])
        self.assertAlmostEqual(shown, run["results"]["mu_M"], delta=0.501 * 10**math.ceil(math.log10(run["results"]["mu_M_known_to"])))
        self.assertNotIn("+-", done.stdout)   # no error bar was asked for
        self.assertIn(f"on this mesh {run['results']['mu_M']:.4f}", done.stdout)
        accepted = int(re.search(r"steps +(\d+) accepted", done.stdout)[1])
        self.assertEqual(accepted, run["steps"]["accepted"])
        for name in ("force", "slip-map", "contact-density"):
            self.assertIn(f"figures/{name}.png", done.stdout)
            self.assertTrue((result / "figures" / f"{name}.png").is_file())
        self.assertNotIn("fields.pvd", done.stdout)
        tenths = [int(m) for m in re.findall(r"^ *(\d+) %  U ", done.stderr, re.M)]
        self.assertEqual(tenths, sorted(set(tenths)))
        self.assertGreaterEqual(len(tenths), 8)
        self.assertNotIn("\r", done.stderr)

        again = amontons("run", FIG1, *COARSE, cwd=self.folder)
        self.assertEqual(again.returncode, 2)
        self.assertIn("--overwrite", again.stderr)
        info = amontons("info", result)
        self.assertEqual((info.returncode, info.stderr), (0, ""))
        for name in ("mu_M", "mu_hold", "mu_max"):
            self.assertRegex(info.stdout, rf"\n  {name} +\S+, one mesh[^(]+ \(on this mesh {run['results'][name]:.6g}\b")

        picture = result / "figures" / "force.png"
        picture.unlink()
        drawn = amontons("render", result, "--figure", "force")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertTrue(picture.is_file())
        wrong = amontons("render", result, "--figure", "forces")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("force", wrong.stderr)

    def test_a_module_not_needed_is_not_opened(self):
        """A shape from the cache needs no gmsh, a run without history no HDF5."""
        scene = ["run", FIG1, "-o", "result", *COARSE, *PLAIN, "--set", "time.until.U=1e-5"]
        brief = [*scene, "--overwrite", "--set", "output.history=false"]
        cache = {"AMONTONS_CACHE": str(self.folder / "cache")}
        none = {**cache, "AMONTONS_MODULES": str(self.folder)}
        done = amontons(*brief, cwd=self.folder, **none)
        self.assertEqual(done.returncode, 1)
        self.assertIn("amontons_gmsh.so", done.stderr)
        self.assertEqual(amontons(*brief, cwd=self.folder, **cache).returncode, 0)
        done = amontons(*brief, cwd=self.folder, **none)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = amontons(*scene, "--overwrite", cwd=self.folder, **none)
        self.assertEqual(done.returncode, 1)
        self.assertIn("amontons_hdf5.so", done.stderr)

    def test_quiet(self):
        done = amontons("run", FIG1, *COARSE, *PLAIN, "time.until.U=1e-4", "--quiet", "-o",
                        self.folder / "a" / "b")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        self.assertTrue((self.folder / "a" / "b" / "run.json").is_file())
        done = amontons("run", FIG1, *COARSE, *PLAIN, "time.until.U=1e-4", "-q", "--overwrite",
                        "-o", self.folder / "a" / "b")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_signals_end_the_run_in_order(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            result = self.folder / number.name
            run = subprocess.Popen([PROGRAM, "run", FIG1, *COARSE, *PLAIN, "--set", "time.until.U=100", "--checkpoint",
                                    "0.02s", "-o", result], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            while not (result / "checkpoint.bin").exists() and run.poll() is None:   # it steps
                time.sleep(0.02)
            run.send_signal(number)
            _, shown = run.communicate(timeout=60)
            self.assertEqual(run.returncode, 1, shown)
            self.assertIn("amontons: error: ", shown)
            self.assertIn(str(result), shown)
            self.assertEqual(json.loads((result / "run.json").read_text())["status"], "failed")
            self.assertTrue((result / "history.h5").is_file())

    def test_first_signal_before_the_first_step(self):
        """A mesh of two million cells is not waited for; an earlier result is as it was."""
        result = self.folder / "result"
        done = amontons("run", FIG1, *COARSE, *PLAIN, "time.until.U=1e-4", "-q", "-o", result)
        self.assertEqual(done.returncode, 0, done.stderr)
        earlier = (result / "run.json").read_bytes()
        run = subprocess.Popen([PROGRAM, "run", FIG1, *PLAIN, "--set", "mesh.set.nx=1500", "mesh.set.nz=1500", "-o", result,
                                "--overwrite"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        caught = 0
        while not (caught >> (signal.SIGTERM - 1) & 1 and (result / "amontons.lock").exists()):   # the mesh is made
            status = Path(f"/proc/{run.pid}/status").read_text()
            caught = int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16)
        run.send_signal(signal.SIGTERM)
        _, shown = run.communicate(timeout=60)
        self.assertEqual(run.returncode, -signal.SIGTERM)
        self.assertIn("stopped before the first step; nothing was computed", shown)
        self.assertEqual((result / "run.json").read_bytes(), earlier)

    def limited(self, limit, result):
        words = f'ulimit {limit} && exec "$@"'
        return subprocess.run(["bash", "-c", words, "-", PROGRAM, "run", FIG1, *COARSE, *PLAIN, "time.until.U=5e-3", "-q",
                               "-o", self.folder / result], capture_output=True, text=True, timeout=60)

    def test_limits_of_the_shell(self):
        """ulimit: a sentence, no signal and no hang."""
        done = self.limited("-f 20", "file")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("File too large", done.stderr)
        done = self.limited("-s 100", "stack")
        self.assertEqual((done.returncode, "ulimit -s" in done.stderr), (1, True), done.stderr)

    @unittest.skipIf(runtime(PROGRAM), "a sanitizer maps terabytes, and ends in words of its own where it may not")
    def test_limit_of_memory(self):
        for room in (40000, 60000, 70000, 150000):   # OpenBLAS finds no room for its threads at the second
            done = self.limited(f"-v {room}", "room")
            self.assertIn(done.returncode, (1, 127))   # 127: the loader's
            self.assertRegex(done.stderr, "^amontons: error: only|error while loading shared libraries|allocat")

    @unittest.skipIf(runtime(PROGRAM), "a sanitizer starts processes of its own")
    def test_limit_of_processes(self):
        """Threads count as processes. No limit holds for root: a user without any process, who may not enter this clone."""
        self.folder.chmod(0o755)
        place = self.folder / "copies"
        for folder in ("meshes", "validation/paper"):
            shutil.copytree(SOURCE / folder, place / folder, ignore=shutil.ignore_patterns("*.png"))
        (place / "bin").mkdir()
        for file in [PROGRAM, *PROGRAM.parent.glob("*amontons*.so*")]:
            shutil.copy(file, place / "bin")
        (place / "results").mkdir()
        (place / "results").chmod(0o777)
        root = os.geteuid() == 0

        def limited(most, *words):
            return subprocess.run(
                [place / "bin" / "amontons", *words], capture_output=True, text=True, timeout=60, user=54321 if root else None,
                cwd=place / "results", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NPROC, (most, most)),
                env={"PATH": os.environ["PATH"], "AMONTONS_CACHE": "", "AMONTONS_MODULES": str(place / "bin")})

        self.assertEqual(limited(1, "--version").returncode, 0)   # it starts neither process nor thread
        words = ["run", str(place / "validation" / "paper" / "fig1.yaml"), *COARSE, "time.until.U=1e-3", "-q", "-o"]
        self.assertEqual(amontons(*words, place / "results" / "free").returncode, 0)
        free = (place / "results" / "free" / "figures" / "force.png").read_bytes()
        ended = {}
        for most in range(1, 7):
            done = limited(most, *words, f"at{most}")
            ended[most] = done.returncode
            if done.returncode == 0:
                self.assertEqual((place / "results" / f"at{most}" / "figures" / "force.png").read_bytes(), free)
            else:
                self.assertRegex(done.stderr, r"(?m)^amontons: error: .*(thread|process).*Resource temporarily unavailable")
        self.assertEqual(ended[1], 1)   # the block is reduced in two threads
        if root:
            self.assertEqual(ended[6], 0)

    def test_ignored_children(self):
        """Whoever starts it may ignore SIGCHLD: an sbatch that fails has failed all the same."""
        sbatch = self.folder / "sbatch"
        sbatch.write_text("#!/bin/sh\necho sbatch: error: invalid partition\n[ $1 = --version ]\n")
        for name in ("scancel", "squeue", "scontrol"):
            (self.folder / name).write_text("#!/bin/sh\n")
        for file in self.folder.iterdir():
            file.chmod(0o755)
        study = self.folder / "study.yaml"
        study.write_text(f"scene: {FIG1}\nvary: {{load.pressure: [0.002, 0.006]}}\nrecord: [mu_max]\n")
        done = subprocess.run([PROGRAM, "sweep", study, "--slurm", "-o", self.folder / "points"], capture_output=True, text=True,
                              timeout=60, env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"},
                              preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("sbatch refuses the array: sbatch: error: invalid partition", done.stderr)

    def test_standard_streams_that_are_closed(self):
        """The first file opened would get their numbers, and progress would be written into it."""
        result = self.folder / "result"
        command = [PROGRAM, "run", FIG1, *COARSE, *PLAIN, "time.until.U=1e-3", "-o", result]
        done = subprocess.run(["sh", "-c", 'exec "$@" <&- >&- 2>&-', "sh", *map(str, command)],
                              timeout=120)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(json.loads((result / "run.json").read_text())["status"], "done")
        written = (result / "history.h5").read_bytes()
        self.assertEqual(written[:8], b"\x89HDF\r\n\x1a\n")
        self.assertNotIn(b"amontons: ", written)

    def test_a_reader_of_progress_that_goes_away(self):
        result = self.folder / "result"
        run = subprocess.Popen([PROGRAM, "run", FIG1, *COARSE, *PLAIN, "time.until.U=2e-3", "-o", result],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        run.stderr.close()
        self.assertEqual(run.wait(timeout=120), 0)
        self.assertEqual(json.loads((result / "run.json").read_text())["status"], "done")

    def test_two_runs_into_one_folder(self):
        result = self.folder / "result"
        words = ["run", FIG1, *COARSE, *PLAIN, "--overwrite", "-o", result, "--set"]
        first = subprocess.Popen([PROGRAM, *words, "time.until.U=100"], stderr=subprocess.PIPE)
        limit = time.monotonic() + 60
        while not (result / "history.h5.part").exists() and time.monotonic() < limit:
            time.sleep(0.02)
        second = amontons(*words, "time.until.U=1e-4")
        first.terminate()
        first.communicate(timeout=60)
        self.assertEqual(second.returncode, 2)
        self.assertIn(f"another computation is writing its result there (process {first.pid} on ", second.stderr)
        self.assertEqual(json.loads((result / "run.json").read_text())["scene"]["time"]["until"]["U"], 100)

    def test_an_earlier_result_outlives_a_scene_that_is_wrong(self):
        result = self.folder / "result"
        words = ["run", FIG1, *COARSE, *PLAIN, "time.until.U=1e-4", "-q", "--overwrite", "-o", result]
        self.assertEqual(amontons(*words).returncode, 0)
        before = {f.name: f.read_bytes() for f in result.iterdir()}
        wrong = amontons(*words, "--set", "groups.top=rood")
        self.assertEqual(wrong.returncode, 2)
        self.assertEqual({f.name: f.read_bytes() for f in result.iterdir()}, before)

    def test_bar_on_a_terminal(self):
        for columns in (40, 80, 132):
            started = time.monotonic()
            shown = self.run_on_terminal(columns)
            elapsed = time.monotonic() - started
            self.assertNotIn("\n", shown)
            draws = [re.sub(r"\x1b\[K", "", part) for part in shown.split("\r")]
            self.assertGreater(len(draws), 1)
            self.assertLess(max(map(len, draws)), columns)
            self.assertEqual(draws[-1], "")   # nothing is left of it
            states = [d for d in draws if re.search(r"\d+ %  U [\d.e-]+", d)]
            self.assertTrue(states)
            self.assertLessEqual(len(states), 10 * elapsed + 1)
            self.assertEqual([d for d in draws if d.endswith("...")][-1], "relaxing ...")
            self.assertEqual([d for d in states if " 0 events" in d and "left" in d], [])   # nothing is known yet
            if columns >= 80:
                self.assertRegex(states[0], r"^\[[#.]+\] +\d+ %  U .* mu .* dt .* event")

    def test_progress_of_an_error_bar(self):
        """Runs behind it are named. When the last of them ends nobody knows; what is left of --within is known."""
        for words, left in (([], "none"), (["--within", "60s"], r"[01]:\d\d left$")):
            shown = self.run_on_terminal(80, "--to", "50%", *words)
            runs = re.findall(r"mesh [1234], run [12], +\d+ %  U [^\r\x1b]*", shown)
            named = {" ".join(line.split()[:4]) for line in runs}
            behind = {"mesh 1, run 1,", "mesh 1, run 2,", "mesh 2, run 1,", "mesh 3, run 1,", "mesh 4, run 1,"}
            self.assertLessEqual(named, behind)
            self.assertGreater(len(named), 2)      # the state is drawn ten times a second: a short run may pass unseen
            wrong = [line for line in runs if "left" in line] if left == "none" else \
                [line for line in runs if not re.search(left, line)]
            self.assertEqual(wrong, [])

    def run_on_terminal(self, columns, *words):
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        cells = ["--set", "mesh.set.nx=20", "mesh.set.nz=10"]   # enough for no warning after the bar
        run = subprocess.Popen([PROGRAM, "run", FIG1, *words, *cells, *PLAIN, "--overwrite",
                                "-o", self.folder / "bar"], stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        shown = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:   # the other side is closed
                break
            if not part:
                break
            shown += part
        os.close(ours)
        self.assertEqual(run.wait(timeout=60), 0)
        return shown.decode()


if __name__ == "__main__":
    unittest.main()
