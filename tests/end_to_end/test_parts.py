# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts that a build may be without (fields, pictures, films, search), and libraries that cannot be loaded: whoever needs
one is told which, why, and by which package it comes. `tests/everything parts` builds the program without any of them."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build/bin"))
PARTS = ("VTU", "PICTURES", "FILM", "SEARCH")
SMALL = ["--set", "mesh.set={nx: 8, nz: 8}", "--set", "time.until={t: 2}", "--set", "output.fields=none",
         "--set", "output.figures=[]"]
FIG1 = SOURCE / "validation/paper/fig1.yaml"


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-parts-"))
        self.addCleanup(shutil.rmtree, self.folder)


class Configured(Folder):
    def configure(self, *options, status=0):
        build = self.folder / "build"
        done = subprocess.run(["cmake", "--preset", "release", "-S", SOURCE, "-B", build, "-DBUILD_TESTING=OFF", *options],
                              capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return re.sub(r"\s+", " ", done.stdout + done.stderr), (build / "build.ninja").read_text() if status == 0 else ""

    def test_without_any(self):
        """gmsh, HDF5 and what solves are all that is linked."""
        said, rules = self.configure(*(f"-DAMONTONS_WITH_{part}=OFF" for part in PARTS))
        self.assertIn("no pictures: AMONTONS_WITH_PICTURES is OFF", said)
        self.assertTrue("(without fields, pictures, films, search)" in rules)
        for library in ("vtk", "cairo", "fontconfig", "libpng", "libav", "libswscale", "dlib"):
            self.assertIsNone(re.search(rf"LINK_LIBRARIES = .*{library}", rules), library)
        self.assertIsNotNone(re.search(r"LINK_LIBRARIES = .*gmsh", rules))

    def test_not_found(self):
        """AUTO leaves out, ON asks."""
        hidden = "-DCMAKE_DISABLE_FIND_PACKAGE_VTK=ON"
        said, rules = self.configure(hidden)
        self.assertIn("no fields: not found are VTK 9.1 or later (libvtk9-dev)", said)
        self.assertTrue("(without fields)" in rules)
        said, _ = self.configure(hidden, "-DAMONTONS_WITH_VTU=ON", status=1)
        self.assertIn("AMONTONS_WITH_VTU is ON, but what it needs is not found: VTK 9.1 or later (libvtk9-dev)", said)
        said, _ = self.configure("-DAMONTONS_WITH_VTU=AUTO", "-DAMONTONS_WITH_PICTURES=OFF", "-DAMONTONS_WITH_FILM=ON", status=1)
        self.assertIn("AMONTONS_WITH_FILM is ON, but what it needs is not found: pictures", said)


class Told(Folder):
    """The program with some of its modules, or with libraries of the right name that are none."""

    def call(self, *words, status=1, **environment):
        done = subprocess.run([BIN / "amontons", *words], capture_output=True, text=True, cwd=self.folder,
                              env={**os.environ, **environment})
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stderr

    def test_each_command_names_the_package(self):
        modules = self.folder / "modules"
        modules.mkdir()
        for name in ("gmsh", "hdf5"):
            (modules / f"amontons_{name}.so").symlink_to(BIN / f"amontons_{name}.so")
        few = {"AMONTONS_MODULES": str(modules)}
        self.call("run", FIG1, *SMALL, "-o", "result", status=0, **few)
        run = ["run", FIG1, *SMALL, "-o", "other"]
        for words, part, package in (
                ([*run, "--set", "output.figures=[force]"], "pictures", "libcairo2-dev"),
                ([*run, "--set", "output.fields={every_U: 1}"], "fields", "libvtk9-dev"),
                (["render", "result"], "pictures", "libcairo2-dev"),
                (["film", "result"], "pictures", "libcairo2-dev"),
                (["report", "result"], "pictures", "libcairo2-dev"),
                (["info", SOURCE / "meshes/block.geo", "--picture", "mesh.png"], "pictures", "libcairo2-dev"),
                (["optimise", SOURCE / "docs/examples/best_pads.yaml", "-o", "best"], "optimise and fit", "libdlib-dev")):
            said = self.call(*words, **few)
            self.assertRegex(said, rf"{part}: this build of amontons is without \(there is no .*\): build it with "
                             rf".*{package}.* installed", words)
        self.assertFalse((self.folder / "other").exists())   # told before anything is computed
        (modules / "amontons_render.so").symlink_to(BIN / "amontons_render.so")
        self.assertIn("films: this build of amontons is without", self.call("film", "result", **few))

    def test_a_sweep_without_pictures(self):
        """The answer is all there; figures are left as descriptions that another build draws."""
        modules = self.folder / "modules"
        modules.mkdir()
        for name in ("gmsh", "hdf5"):
            (modules / f"amontons_{name}.so").symlink_to(BIN / f"amontons_{name}.so")
        study = self.folder / "study.yaml"
        study.write_text(f"scene: {FIG1}\nset: {{mesh.set.nx: 8, mesh.set.nz: 8, time.until: {{t: 2}}}}\n"
                         "vary: {load.pressure: [0.002, 0.003]}\n"
                         "plot: [{name: mu, x: load.pressure, y: mu_max}]\n")
        done = subprocess.run([BIN / "amontons", "sweep", study, "-o", "sweep"], capture_output=True, text=True, cwd=self.folder,
                              env={**os.environ, "AMONTONS_MODULES": str(modules)})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("The figures are not drawn", done.stdout + done.stderr)
        self.assertEqual([path.name for path in (self.folder / "sweep/figures").iterdir()], ["mu.json"])
        self.call("render", "sweep/figures/mu.json", status=0)
        self.assertTrue((self.folder / "sweep/figures/mu.png").is_file())

    def needed(self, module, library):
        """The name by which a module asks for a library."""
        said = subprocess.run(["readelf", "-d", BIN / f"amontons_{module}.so"], capture_output=True, text=True, check=True).stdout
        return re.search(rf"\(NEEDED\).*\[({library}[^\]]*)\]", said)[1]

    def test_a_library_that_cannot_be_loaded(self):
        """It is no fault of a file. Another one may be first in LD_LIBRARY_PATH: broken, or without what is called."""
        if b"libasan" in (BIN / "amontons").read_bytes() or b"libtsan" in (BIN / "amontons").read_bytes():
            self.skipTest("a sanitizer's runtime stands before the loader's order")
        self.call("run", FIG1, *SMALL, "-o", "result", status=0)
        mesh = SOURCE / "meshes/block.geo"
        film = ["film", "result", "-o", "film.mp4", "--seconds", "1"]
        for module, library, part, words in (
                ("gmsh", "libgmsh", "meshes", ["info", mesh]),
                ("hdf5", "libhdf5", "results", ["render", "result"]),
                ("vtk", "libvtkIOXML", "fields", ["run", FIG1, *SMALL, "--set", "output.fields={every_U: 1}", "-o", "other",
                                                  "--overwrite"]),
                ("render", "libcairo", "pictures", ["render", "result", "--overwrite"]),
                ("libav", "libavcodec", "films", film)):
            place = self.folder / module
            place.mkdir()
            file = place / self.needed(module, library)
            file.write_text("no library\n")
            said = self.call(*words, LD_LIBRARY_PATH=str(place))
            self.assertRegex(said, rf"{part}: a library that .*amontons_{module}.so needs cannot be loaded: {file}: ")
            self.assertIn(f"LD_LIBRARY_PATH first, which is {place}", said)
            self.assertNotIn("damaged", said)
            file.unlink()
            subprocess.run(["cc", "-shared", "-fPIC", "-x", "c", "/dev/null", f"-Wl,-soname,{file.name}", "-o", file], check=True)
            said = self.call(*words, LD_LIBRARY_PATH=str(place))
            self.assertRegex(said, rf"{part}: a library that .* needs cannot be loaded: .*(undefined symbol|not found)")


if __name__ == "__main__":
    unittest.main()
