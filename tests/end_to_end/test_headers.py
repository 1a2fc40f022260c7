# SPDX-License-Identifier: GPL-2.0-or-later
"""Each of our headers compiles alone, twice in one file, without a warning, and its guard is named
after its path."""
import os
import re
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
COMPILE = ["cc", "-std=c17", "-D_GNU_SOURCE", "-Wall", "-Wextra", "-Wshadow", "-Wconversion",
           "-Wstrict-prototypes", "-Werror", "-fsyntax-only", "-x", "c", "-"]
HDF5_FLAGS = subprocess.run(["pkg-config", "--cflags", "hdf5-serial"], capture_output=True,
                            text=True).stdout.split()   # for io/hdf5/hdf5_library.h
CHOLMOD_FLAGS = ["-I/usr/include/suitesparse"]   # for algebra/sparse_analysis.h: it has no .pc file


def headers(root):
    """(as included, path) of every header; render's are included from the top of the project."""
    found = [(str(path.relative_to(root / "src")), path) for path in root.glob("src/**/*.h")]
    found += [(str(path.relative_to(root)), path) for path in root.glob("render/**/*.h")]
    return sorted(found)


def compile_alone(root, include):
    """What the compiler says about a file that includes `include` twice and nothing else."""
    text = f'#include "{include}"\n#include "{include}"\n'
    done = subprocess.run([*COMPILE, f"-I{root / 'src'}", f"-I{root}", *HDF5_FLAGS,
                           *CHOLMOD_FLAGS], input=text,
                          text=True, capture_output=True)
    return done.stderr if done.returncode else ""


def guard_of(include):
    name = re.sub(r"\W", "_", include).upper()
    return name if name.startswith("AMONTONS_") else f"AMONTONS_{name}"


class Headers(unittest.TestCase):
    def test_compile_alone(self):
        names = [include for include, _ in headers(SOURCE)]
        self.assertIn("base/error.h", names)
        with ThreadPoolExecutor(2) as pool:
            for name, said in zip(names, pool.map(lambda n: compile_alone(SOURCE, n), names)):
                with self.subTest(name):
                    self.assertEqual(said, "")

    def test_guards(self):
        for include, path in headers(SOURCE):
            with self.subTest(include):
                guard = guard_of(include)
                self.assertIn(f"#ifndef {guard}\n#define {guard}\n", path.read_text())

    def test_sees_faults(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "src/io").mkdir(parents=True)
            (root / "src/io/lonely.h").write_text("int32_t count(void);\n")
            (root / "src/io/twice.h").write_text("struct Twice { int a; };\n")
            (root / "src/io/fine.h").write_text("#ifndef A\n#define A\nint fine(void);\n#endif\n")
            self.assertIn("int32_t", compile_alone(root, "io/lonely.h"))
            self.assertIn("redefinition", compile_alone(root, "io/twice.h"))
            self.assertEqual(compile_alone(root, "io/fine.h"), "")


if __name__ == "__main__":
    unittest.main()
