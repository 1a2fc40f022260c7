# SPDX-License-Identifier: GPL-2.0-or-later
"""Each of our headers compiles alone, without a warning, and its guard, named after its path, holds all of it. A header that is
the first include of one of our sources compiles alone wherever the project does; the others are compiled here."""
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


def headers(root):
    """(as included, path) of every header; render's are included from the top of the project."""
    found = [(str(path.relative_to(root / "src")), path) for path in root.glob("src/**/*.h")]
    found += [(str(path.relative_to(root)), path) for path in root.glob("render/**/*.h")]
    return sorted(found)


def tried_by_the_build(root):
    """Headers, as included, with which a source begins."""
    sources = [*root.glob("src/**/*.c"), *root.glob("render/**/*.c")]
    begins = (re.search(r'^#include (".*"|<.*>)$', path.read_text(), re.M) for path in sources)
    return {found[1].strip('"') for found in begins if found}


def is_guarded(include, text):
    """Nothing but comments stands outside of the guard."""
    guard = guard_of(include)
    begin = rf"(//[^\n]*\n|\n)*#ifndef {guard}\n#define {guard}\n"
    end = r"\n#endif(\s*//[^\n]*)?\n"
    return re.fullmatch(begin + r".*" + end, text, re.S) is not None


def compile_alone(root, include):
    """What the compiler says about a file that includes `include` twice and nothing else."""
    text = f'#include "{include}"\n#include "{include}"\n'
    done = subprocess.run([*COMPILE, f"-I{root / 'src'}", f"-I{root}", *HDF5_FLAGS], input=text,
                          text=True, capture_output=True)
    return done.stderr if done.returncode else ""


def guard_of(include):
    name = re.sub(r"\W", "_", include).upper()
    return name if name.startswith("AMONTONS_") else f"AMONTONS_{name}"


class Headers(unittest.TestCase):
    def test_compile_alone(self):
        names = [include for include, _ in headers(SOURCE)]
        self.assertIn("base/error.h", names)
        names = sorted(set(names) - tried_by_the_build(SOURCE))
        self.assertLess(len(names), 40)
        with ThreadPoolExecutor(2) as pool:
            for name, said in zip(names, pool.map(lambda n: compile_alone(SOURCE, n), names)):
                with self.subTest(name):
                    self.assertEqual(said, "")

    def test_guards(self):
        for include, path in headers(SOURCE):
            with self.subTest(include):
                self.assertTrue(is_guarded(include, path.read_text()))

    def test_sees_faults(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "src/io").mkdir(parents=True)
            (root / "src/io/lonely.h").write_text("int32_t count(void);\n")
            (root / "src/io/twice.h").write_text("struct Twice { int a; };\n")
            (root / "src/io/fine.h").write_text("#ifndef A\n#define A\nint fine(void);\n#endif\n")
            (root / "src/io/fine.c").write_text('// A comment.\n#include "io/fine.h"\n\n#include "io/lonely.h"\n')
            self.assertEqual(tried_by_the_build(root), {"io/fine.h"})
            self.assertTrue(is_guarded("io/a.h", "// A.\n#ifndef AMONTONS_IO_A_H\n#define AMONTONS_IO_A_H\nint a;\n#endif\n"))
            self.assertFalse(is_guarded("io/a.h", "#ifndef AMONTONS_IO_A_H\n#define AMONTONS_IO_A_H\n#endif\nint a;\n"))
            self.assertFalse(is_guarded("io/a.h", "#ifndef A\n#define A\nint a;\n#endif\n"))
            self.assertIn("int32_t", compile_alone(root, "io/lonely.h"))
            self.assertIn("redefinition", compile_alone(root, "io/twice.h"))
            self.assertEqual(compile_alone(root, "io/fine.h"), "")


if __name__ == "__main__":
    unittest.main()
