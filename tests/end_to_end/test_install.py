# SPDX-License-Identifier: GPL-2.0-or-later
"""What `cmake --install` leaves works from wherever it is put, with no variable set: the program, the library for C
programs that are built outside of the tree, manual pages, completion. And it can be removed again."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")).resolve().parent
EXAMPLES = SOURCE / "packaging" / "examples"
SMALL = ["mesh.set.nx=8", "mesh.set.nz=8", "time.until={U: 0.004}", "output.fields=none", "output.figures=[]"]
PLAIN = {name: os.environ[name] for name in ("PATH", "LSAN_OPTIONS", "TMPDIR") if name in os.environ}
# What a library that is a guest never calls: it prints, ends or changes the process.
HOSTS_OWN = {"printf", "puts", "putchar", "perror", "exit", "abort", "setlocale", "sigaction", "stdout",
             "stderr", "setenv", "unsetenv", "putenv", "umask", "__printf_chk"}
# fprintf goes into a file that is the caller's: stdout and stderr are in the list.
# uselocale: for numbers, while it is called (base/decimal_point; test_format names the files that may call it).


def run(*words, check=True, **more):
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True,
                          env=dict(PLAIN, **more.pop("env", {})), **more)
    if check and done.returncode != 0:
        raise AssertionError(f"{words}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def commands(program):
    """Every command that the program lists."""
    return re.findall(r"(?m)^  ([a-z0-9]+)  .*", run(program, "--help").stdout)


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-installed-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        run("cmake", "--install", BUILD, "--prefix", "/opt/first", env={"DESTDIR": str(cls.folder / "stage")})
        cls.prefix = cls.folder / "moved elsewhere"
        shutil.copytree(cls.folder / "stage/opt/first", cls.prefix, symlinks=True)
        cls.program = cls.prefix / "bin" / "amontons"
        cls.home = {"HOME": str(cls.folder / "home")}
        cls.scene = cls.prefix / "share/amontons/validation/paper/fig1.yaml"

    def flags(self, name):
        return [word for pair in SMALL for word in (name, pair)]

    def test_program_finds_what_is_its_own(self):
        """Mesh, modules of all kinds, pictures; from a folder that has nothing to do with it."""
        version = run(self.program, "--version", cwd="/").stdout
        self.assertIn(f"scenes: {self.prefix}/share/amontons\n", version)
        result = self.folder / "result"
        run(self.program, "run", self.scene, *self.flags("--set"), "--set", "output.figures=[force]", "--set",
            "output.fields={every_U: 2e-3}", "-o", result, cwd="/", env=self.home)
        self.assertTrue((result / "figures/force.png").is_file())
        self.assertTrue((result / "fields.pvd").is_file())
        maps = run("ldd", self.prefix / "lib/amontons/amontons_commands.so").stdout
        self.assertIn(f"libamontons.so.0.3 => {self.prefix}/", re.sub(r"/lib/amontons/\.\./\.\./|/amontons/\.\./", "/", maps))

    def test_libraries_are_looked_for_in_named_folders(self):
        """Nothing that is built or installed looks into the folder it is called in: no empty entry in a run path, no
        relative one. All files at once: readelf is quick, its start is not."""
        files = [path for top in (BUILD, self.prefix) for path in sorted(top.rglob("*"))
                 if path.is_file() and not path.is_symlink() and "CMakeFiles" not in path.parts
                 and (path.suffix in ("", ".so") or ".so." in path.name) and path.read_bytes().startswith(b"\x7fELF")]
        self.assertGreater(len(files), 16)
        said = run("readelf", "--dynamic", *files).stdout
        checked = 0
        for part in said.split("\nFile: ")[1:]:
            for entries in re.findall(r"\(R(?:UN)?PATH\).*\[(.*)\]", part):
                checked += 1
                wrong = [entry for entry in entries.split(":") if not re.match(r"\$ORIGIN(/|$)|/", entry)]
                self.assertEqual(wrong, [], f"{part.splitlines()[0]}: {entries}")
        self.assertGreater(checked, 8)

    def test_libraries_of_the_working_folder_are_not_loaded(self):
        """A library that came with a stranger's scene, by the name of one that the program needs."""
        (self.folder / "theirs").mkdir()
        (self.folder / "seen.c").write_text('#include <stdio.h>\n'
                                            '__attribute__((constructor)) static void seen(void) { puts("loaded"); }\n')
        run("cc", "-shared", "-fPIC", self.folder / "seen.c", "-Wl,-soname,libxxhash.so.0",
            "-o", self.folder / "theirs/libxxhash.so.0")
        for program in (BUILD / "bin/amontons", self.program):
            self.assertNotIn("loaded", run(program, "--version", cwd=self.folder / "theirs").stdout, program)

    def test_library_shows_what_its_headers_declare(self):
        library = self.prefix / "lib/libamontons.so"
        listing = run("nm", "-D", "--defined-only", library).stdout
        shown = {line.split()[-1] for line in listing.splitlines()}
        declared = set()
        for header in (self.prefix / "include/amontons").glob("*.h"):
            if header.name != "amontons_friction.h":   # what a plug-in defines
                declared |= set(re.findall(r"\b(amontons_\w+)\(", header.read_text()))
        self.assertEqual({s for s in shown if not re.match(r"_|__gcov", s)}, declared)
        self.assertIn("SONAME               libamontons.so.0.3\n", run("objdump", "-p", library).stdout)

    def test_library_is_a_guest(self):
        if b"__gcov_" in (self.prefix / "lib/libamontons.so").read_bytes():
            self.skipTest("gcov's own code, which is linked in, writes and exits")
        for library in [self.prefix / "lib/libamontons.so", self.prefix / "lib/amontons/amontons_hdf5.so",
                        self.prefix / "lib/amontons/amontons_render.so", self.prefix / "lib/amontons/amontons_libav.so"]:
            listing = run("nm", "-D", "--undefined-only", library).stdout
            used = {line.split()[-1].split("@")[0] for line in listing.splitlines()}
            self.assertEqual(used & HOSTS_OWN, set(), library.name)

    def test_headers_stand_alone(self):
        headers = sorted(path.name for path in (self.prefix / "include/amontons").iterdir())
        self.assertIn("amontons.h", headers)
        for header in headers:
            for compiler in (["gcc", "-std=c11", "-x", "c"], ["g++", "-std=c++11", "-x", "c++"]):
                run(*compiler, "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I",
                    self.prefix / "include", "-", input=f"#include <amontons/{header}>\n#include <amontons/{header}>\n")

    def check_program(self, program):
        """It prints what `amontons run` finds at the three pressures."""
        said = run(program, self.scene, *SMALL, cwd="/", env=self.home).stdout
        found = re.findall(r"load.pressure=(\S+): largest F_T/F_N (\S+), (\d+) steps", said)
        self.assertEqual([pressure for pressure, *_ in found], ["0.002", "0.003", "0.006"])
        pressure, mu, steps = found[2]
        result = self.folder / "the same"
        run(self.program, "run", self.scene, *self.flags("--set"), "--set", f"load.pressure={pressure}", "-o", result,
            "--overwrite", env=self.home)
        report = json.loads((result / "run.json").read_text())
        self.assertAlmostEqual(report["results"]["mu_max"], float(mu), delta=1e-6)
        self.assertEqual(report["steps"]["accepted"], int(steps))
        self.assertGreater(float(found[0][1]), float(mu))   # mu falls with the load

    def test_program_by_pkg_config(self):
        """The page's own commands, of an installation in ~/.local."""
        page = (self.prefix / "share/doc/amontons/docs/library.md").read_text()
        lines = re.search(r"((?:    .*\n)+)    \./pressures ", page)[1]
        self.assertIn("pkg-config", lines)
        local = Path(self.home["HOME"], ".local")
        local.parent.mkdir(exist_ok=True)
        local.symlink_to(self.prefix)
        folder = self.folder / "by pkg-config"
        folder.mkdir()
        shutil.copy(EXAMPLES / "pressures.c", folder)
        run("bash", "-euc", lines.replace("cc ", "cc -Wall -Wextra -Werror "), cwd=folder, env=self.home)
        self.check_program(folder / "pressures")
        self.assertLess(len((EXAMPLES / "pressures.c").read_text().splitlines()), 40)

    def test_not_all_is_built(self):
        """One sentence, and no half of a prefix."""
        build, prefix = self.folder / "new build", self.folder / "new prefix"
        run("cmake", "-S", SOURCE, "-B", build)
        (build / "bin").mkdir(exist_ok=True)
        for missing, component in (("bin/amontons", []), ("_structs.py", []), ("_structs.py", ["--component", "dev"])):
            done = run("cmake", "--install", build, "--prefix", prefix, *component, check=False)
            self.assertNotEqual(done.returncode, 0)
            self.assertRegex(re.sub(r"\s+", " ", done.stderr),
                             rf"{missing} is not built, nothing is installed. First: cmake --build {build}")
            (build / "bin/amontons").touch()   # as where cmake --build was cut off
        self.assertFalse(prefix.exists())

    def test_program_by_find_package(self):
        build = self.folder / "by find_package"
        run("cmake", "-S", self.prefix / "share/doc/amontons/examples", "-B", build,
            f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", build)
        self.check_program(build / "pressures")

    def test_plugin(self):
        """The example of a friction law, built against the installed header alone, is a law of the program."""
        build = self.folder / "plugin"
        run("cmake", "-S", self.prefix / "share/doc/amontons/examples/friction", "-B", build,
            f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", build)
        law = (f"friction={{law: plugin, file: {build}/stribeck.so, mu_static: 0.38, mu_kinetic: 0.1, "
               "critical_velocity: 3.4e-4, parameters: [0.02, 1e-3], velocity_max: 0.01}")
        said = run(self.program, "info", self.scene, "--set", law, "--trust", env=self.home).stdout
        self.assertIn("plugin", said)

    def test_python_module(self):
        """Debian's python3 finds the library by the module's own place."""
        site = next(self.prefix.glob("lib/python3*/site-packages"))
        said = run("/usr/bin/python3", "-c", f"import sys; sys.path.insert(0, '{site}'); import amontons; "
                   "print(amontons.data_folder()); import ctypes; print(amontons._library.lib._name)", cwd="/").stdout
        self.assertEqual(said.split("\n")[:2], [f"{self.prefix}/share/amontons", f"{self.prefix}/lib/libamontons.so.0.3"])

    @unittest.skipUnless(shutil.which("help2man") and shutil.which("man"), "no help2man or no man here")
    def test_manual_pages(self):
        pages = self.prefix / "share/man/man1"
        names = {"amontons", *(f"amontons-{command}" for command in commands(self.program))}
        self.assertEqual({page.stem for page in pages.iterdir()}, names)
        for page in pages.iterdir():
            shown = run("man", "--warnings", "-l", page, env={"MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
            self.assertEqual(shown.stderr, "", page.name)
            self.assertIn("NAME", shown.stdout)
        shown = run("man", "-l", pages / "amontons-run.1").stdout
        self.assertIn("--overwrite", shown)
        self.assertNotIn(str(BUILD), shown)

    def completions(self, *words):
        """What bash would offer behind `amontons WORDS`."""
        script = self.prefix / "share/bash-completion/completions/amontons"
        line = " ".join(f"'{word}'" for word in words)
        return run("bash", "-c", f"source '{script}'; COMP_WORDS=({line}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
                   "_amontons; printf '%s\\n' \"${COMPREPLY[@]}\"", cwd=self.folder,
                   env={"PATH": f"{self.prefix}/bin:{PLAIN['PATH']}"}).stdout.split()

    def test_completion(self):
        self.assertEqual(self.completions("amontons", "st"), ["static", "stability"])
        self.assertEqual(self.completions("amontons", "run", "--over"), ["--overwrite"])
        self.assertEqual(self.completions("amontons", "run", "--set", "load.pre"), ["load.pressure="])
        self.assertEqual(self.completions("amontons", "run", "--set", "time.until.U"), ["time.until.U="])
        (self.folder / "mine.yaml").touch()
        (self.folder / "mine.txt").touch()
        self.assertEqual(self.completions("amontons", "run", "mi"), ["mine.yaml"])

    def test_uninstall(self):
        """Removes what was installed, and leaves what was not."""
        stage = {"DESTDIR": str(self.folder / "second")}
        run("cmake", "--install", BUILD, "--prefix", "/opt/first", env=stage)
        other = self.folder / "second/opt/first/share/amontons/of the user"
        other.touch()
        run("cmake", "--build", BUILD, "--target", "uninstall", env=stage)
        left = [path for path in (self.folder / "second").rglob("*") if not path.is_dir()]
        self.assertEqual(left, [other])
        self.assertFalse((self.folder / "second/opt/first/include/amontons").exists())


if __name__ == "__main__":
    unittest.main()
