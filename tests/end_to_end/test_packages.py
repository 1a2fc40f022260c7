# SPDX-License-Identifier: GPL-2.0-or-later
"""The Debian packages that cpack makes: no errors for lintian, what they depend on, what is in which, and a program that
runs out of what they unpack. packaging/try_packages.sh installs them into a bare Debian, which needs root and a mirror."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")).resolve().parent
# lintian asks where files were packed: not in /tmp, which it takes for a mistake.
PLACE = BUILD / "tests"


def run(*words, check=True, **more):
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True, **more)
    if check and done.returncode != 0:
        raise AssertionError(f"{words}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


@unittest.skipUnless(shutil.which("dpkg-shlibdeps"), "no dpkg-dev here")
class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="packages-", dir=PLACE))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder)
        cls.packages = {path.name.split("_")[0]: path for path in cls.folder.glob("*.deb")}

    def test_names(self):
        self.assertEqual(set(self.packages), {"amontons", "libamontons-dev", "python3-amontons"})

    def depends(self, package):
        return re.findall(r"[\w.+-]+(?= \(| ?[,|]|\n|$)", run("dpkg-deb", "-f", self.packages[package], "Depends"))

    def package_of(self, library):
        """The Debian package of that library which files in BUILD/bin are linked with."""
        linked = run("objdump", "-p", *(path for path in (BUILD / "bin").iterdir() if path.is_file()))
        name = re.search(rf"NEEDED +(lib{library}[-.\w]*\.so[.\d]*)", linked)[1]
        return re.match(r"[\w.+-]+", run("dpkg", "-S", f"*/{name}"))[0]

    def test_depend_on_what_they_need(self):
        needed = self.depends("amontons")
        for library in ("gmsh", "vtkIOXML", "hdf5_serial", "cairo", "avcodec", "avformat", "swscale", "cholmod"):
            self.assertIn(self.package_of(library), needed)
        self.assertIn("fonts-dejavu-core", needed)
        self.assertIn("libosmesa6", needed)    # or, what also draws:
        self.assertIn("libegl1", needed)
        self.assertFalse([name for name in needed if name.endswith("-dev")])
        self.assertEqual(self.depends("libamontons-dev"), ["amontons"])
        self.assertIn("python3-h5py", self.depends("python3-amontons"))

    def test_maintainer(self):
        """What CMake was told stands in all packages, and signs their changelogs."""
        told = re.search(r"AMONTONS_MAINTAINER:STRING=(.*)", (BUILD / "CMakeCache.txt").read_text())[1]
        for name, package in self.packages.items():
            self.assertEqual(run("dpkg-deb", "-f", package, "Maintainer").strip(), told, name)

    @unittest.skipUnless(shutil.which("lintian"), "no lintian here")
    def test_lintian(self):
        said = run("lintian", "--fail-on", "none", *self.packages.values())
        self.assertEqual([line for line in said.splitlines() if line.startswith("E:")], [])

    def test_unpacked(self):
        """Every package has its licence; the program runs, the module imports; nothing names the build folder."""
        root = self.folder / "root"
        for name, package in self.packages.items():
            run("dpkg-deb", "-x", package, root)
            self.assertTrue((root / "usr/share/doc" / name / "copyright").is_file(), name)
        files = [path for path in root.rglob("*") if path.is_file()]
        self.assertGreater(len(files), 50)
        self.assertEqual([path.name for path in files if str(BUILD).encode() in path.read_bytes()], [])
        advice = next(path for path in files if path.name == "amontons.pc").read_text()
        self.assertIn("-lamontons", advice)
        self.assertNotIn("rpath", advice)   # the loader looks there by itself
        environment = {"PATH": os.environ["PATH"], "LD_LIBRARY_PATH": str(root / "usr/lib"), "HOME": str(self.folder)}
        said = run(root / "usr/bin/amontons", "--version", env=environment)
        self.assertIn(f"scenes: {root}/usr/share/amontons\n", said)
        scene = root / "usr/share/amontons/validation/paper/fig1.yaml"
        run(root / "usr/bin/amontons", "run", scene, "--set", "mesh.set.nx=8", "--set", "mesh.set.nz=8", "--set",
            "time.until={t: 5}", "-q", "-o", self.folder / "result", env=environment)
        self.assertTrue((self.folder / "result/figures/force.png").is_file())
        said = run("/usr/bin/python3", "-c", "import amontons; print(amontons.data_folder())",
                   env=dict(environment, PYTHONPATH=str(root / "usr/lib/python3/dist-packages")))
        self.assertEqual(said, f"{root}/usr/share/amontons\n")
        self.assertTrue((root / "usr/share/man/man1/amontons-run.1.gz").is_file())
        self.assertNotIn("RUNPATH", run("objdump", "-p", root / "usr/bin/amontons"))


if __name__ == "__main__":
    unittest.main()
