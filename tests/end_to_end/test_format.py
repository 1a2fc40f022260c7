# SPDX-License-Identifier: GPL-2.0-or-later
"""The style that a machine can check: clang-format, columns, the licence line, and what the library never does (prints, exits,
allocates by itself, keeps state in a function). Lengths are a report: tests/reports/lengths.py."""
import difflib
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
COLUMNS = 100
CLANG_FORMAT = "14"                  # Debian 12's; another major version formats otherwise
MACHINE = re.compile(r"(?<![\w.])/(?:work|root|home|Users|media|mnt)/\w+")
OUTSIDE = re.compile(r'"(/(?!(?:proc|dev|tmp|usr|bin|etc)/)[\w.-]+/[^"]*)"')   # absolute paths in strings of C, but for these
LICENCE = "SPDX-License-Identifier: GPL-2.0-or-later"


def c_files(root):
    tops = ("src", "render", "tests")
    return sorted(f for top in tops for f in root.glob(f"{top}/**/*")
                  if f.suffix in (".c", ".h", ".cc"))


def faults(path):
    """What is wrong with one C file."""
    text = path.read_text()
    lines = text.splitlines()
    found = []
    if not lines or lines[0] != f"// {LICENCE}":
        found.append("the first line is not the SPDX line")
    for number, line in enumerate(lines, 1):
        if len(line) > COLUMNS:
            found.append(f"line {number} has {len(line)} columns, at most {COLUMNS}")
    return found


# What no file of the library does, and the one place that may.
HABITS = [
    ("prints or ends the program",   # there: a forked child
     r"src/cli/|src/study/sweep/computing/pool\.c|src/base/child_process\.c",
     r"\b(printf|puts|putchar|perror|exit|_exit|abort)\(|\bfprintf\(\s*(stderr|stdout)"),
    ("changes what is the process's",
     r"src/cli/|src/study/sweep/computing/(pool|element)\.c|src/base/(child_process|decimal_point)\.c|src/io/mesh/mesh_file_module\.c",
     # there: processes and a thread of their own; what gmsh changes is put back
     r"\b(setlocale|uselocale|signal|sigaction|setenv|unsetenv|putenv|chdir|fchdir|umask|srand)\("),
    ("allocates by itself", r"src/base/(memory|system)\.c|src/cli/main\.c",   # main.c: before the library is there
     r"\b(malloc|calloc|realloc|aligned_alloc|strdup|strndup|asprintf)\("),
    # HDF5, libav, VTK and Cairo get what is open already; shut_in only names O_CREAT, to forbid it; the .geo's included
    # files and the mesh are opened for reading alone, in the child that gmsh reads in
    ("opens a file by itself", r"src/io/files/open_file\.c|src/base/shut_in\.c|src/io/mesh/(geo_script|mesh_file_module)\.c",
     r'(?<![>.])\b(fopen|freopen|creat|mkstemp|mkostemp|open|openat)\((?!"/dev/null"|"/proc/|[^;]*O_DIRECTORY)'
     r"|\b(avio_open2?|cairo_surface_write_to_png|cairo_(pdf|svg)_surface_create)\(|\bstd::[io]?fstream|\bO_CREAT\b"),
    ("keeps state in a function", None, r"(?m)^[ \t]+static (?!const )[^(]*?[;=]"),
]


def bad_habits(name, text):
    return [what for what, place, pattern in HABITS
            if re.search(pattern, text) and not (place and re.match(place, name))]


class Style(unittest.TestCase):
    def test_limits(self):
        files = c_files(SOURCE)
        self.assertGreater(len(files), 20)
        for path in files:
            with self.subTest(str(path.relative_to(SOURCE))):
                self.assertEqual(faults(path), [])

    def test_habits(self):
        for path in [f for f in c_files(SOURCE) if f.suffix != ".h"]:
            name = str(path.relative_to(SOURCE))
            if not name.startswith("tests/"):
                with self.subTest(name):
                    self.assertEqual(bad_habits(name, path.read_text()), [])

    def test_numbers_have_a_point(self):
        """Each public function that can fail, or that writes numbers, begins by that (base/decimal_point.h)."""
        headers = "".join(path.read_text() for path in (SOURCE / "src").glob("amontons*.h")
                          if path.name != "amontons_friction.h")
        wanted = {name for name, arguments in re.findall(r"(?m)^\w[\w ]*\*?(amontons_\w+)\(([^;]*)\);", headers)
                  if re.search(r"\bError \*err|\bFILE \*|\bchar text\[", arguments)}
        self.assertGreater(len(wanted), 25)
        for path in (SOURCE / "src").rglob("*.c"):
            wanted -= set(re.findall(r"(?m)^\w[\w ]*\*?(amontons_\w+)\([^;{]*\)\n\{\n    NUMBERS_HAVE_A_POINT;$", path.read_text()))
        self.assertEqual(wanted, set())

    def test_sees_bad_habits(self):
        for line, place, count in [
                ("    printf(\"%d\", a);", "src/run/a.c", 1), ("    exit(1);", "render/a.c", 1),
                ("    fprintf(stderr, \"x\");", "src/io/a.c", 1),
                ("    fprintf(out, \"x\");", "src/io/a.c", 0), ("    exit(1);", "src/cli/a.c", 0),
                ("    snprintf(a, 3, \"b\");", "src/io/a.c", 0),
                ("    double *a = malloc(8);", "src/fem/a.c", 1),
                ("    void *a = aligned_alloc(64, 64);", "src/base/memory.c", 0),
                ("    static int32_t calls = 0;", "src/io/a.c", 1),
                ("    static char buffer[9];", "src/io/a.c", 1),
                ("    static const double a[] = {1};", "src/io/a.c", 0),
                ('    file = fopen(path, "w");', "render/a.c", 1), ("    creat(path, 0666);", "src/io/a.c", 1),
                ("    std::ofstream out(path);", "src/io/a.cc", 1),
                ("    int file = open(path, O_RDWR | O_CREAT, 0666);", "src/io/files/open_file.c", 0),
                ("    open_to_write(path, OPEN_KEPT, why);", "src/io/a.c", 0),
                ("static Module *opened;", "src/base/module.c", 0)]:
            with self.subTest(line):
                self.assertEqual(len(bad_habits(place, f"int a;\n\n{line}\n")), count)

    def test_tests_stay_in_their_folder(self):
        """Where a test needs a folder that is not there, it is one that nobody can make: /proc/none."""
        for path in sorted((SOURCE / "tests").rglob("*.[ch]")):
            with self.subTest(str(path.relative_to(SOURCE))):
                self.assertEqual(OUTSIDE.findall(path.read_text()), [])
        self.assertEqual(OUTSIDE.findall('create("/nonexistent/run.json"); use("%s/run.json", "/tmp/a_XXXXXX");'),
                         ["/nonexistent/run.json"])

    def test_no_place_of_a_machine(self):
        """Nothing names a folder of the machine it was made on, published tables least of all."""
        checked = 0
        for folder, folders, names in os.walk(SOURCE):
            if Path(folder) == SOURCE:
                folders[:] = [f for f in folders if f != "results" and f[0] != "."
                              and not f.startswith("build")]
            for path in (Path(folder, name) for name in names):
                if path.suffix in (".png", ".gif", ".pyc", ".log", ".corpus") or path.name[0] == ".":
                    continue
                with self.subTest(str(path.relative_to(SOURCE))):
                    self.assertEqual(MACHINE.findall(path.read_text()), [])
                checked += 1
        self.assertGreater(checked, 200)
        self.assertTrue(MACHINE.search("error: /home/" + "someone/scene.yaml: no"))

    def test_licence_of_the_rest(self):
        """Scripts, build files and meshes name the licence in their first three lines."""
        names = [SOURCE / "amontons", SOURCE / ".ci/run"]
        for pattern in ("**/CMakeLists.txt", "**/*.py", "**/*.geo", "**/*.edp"):
            names += [f for f in SOURCE.glob(pattern) if "build" not in str(f.relative_to(SOURCE))]
        for path in names:
            with self.subTest(str(path.relative_to(SOURCE))):
                self.assertIn(LICENCE, "\n".join(path.read_text().splitlines()[:3]))

    def test_sees_faults(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bad.c"
            path.write_text(f"// {LICENCE}\n\nint fine(void);\n")
            self.assertEqual(faults(path), [])
            path.write_text("int a;\n//" + "-" * 99 + "\n")
            self.assertEqual(len(faults(path)), 2)


def comments_apart(text):
    """The lines with one space before a trailing comment: its column is the writer's choice."""
    return [re.sub(r"\s+//", " //", line) for line in text.splitlines()]


class ClangFormat(unittest.TestCase):
    def setUp(self):
        self.assertIsNotNone(shutil.which("clang-format"), "clang-format is not installed")
        version = subprocess.run(["clang-format", "--version"], capture_output=True, text=True)
        if f"version {CLANG_FORMAT}." not in version.stdout:
            self.skipTest(f"only version {CLANG_FORMAT} formats as the project does")

    def changes(self, root, files):
        """{file: what clang-format would change in it, comment columns aside}, of files of `root`."""
        with tempfile.TemporaryDirectory() as folder:   # one call for all: starting costs the most
            copies = [Path(folder) / path.relative_to(root) for path in files]
            for path, copy in zip(files, copies):
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, copy)
            shutil.copy(SOURCE / ".clang-format", folder)
            subprocess.run(["clang-format", "-i", *copies], check=True)
            found = {path: [line for line in difflib.unified_diff(
                comments_apart(path.read_text()), comments_apart(copy.read_text()), lineterm="", n=0)
                if not line.startswith(("---", "+++"))] for path, copy in zip(files, copies)}
        return {path: lines for path, lines in found.items() if lines}

    def test_sources(self):
        self.assertEqual(self.changes(SOURCE, c_files(SOURCE)), {})

    def test_sees_faults(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.c"
            path.write_text("int  f(void){return 0;}\n")
            self.assertEqual(list(self.changes(path.parent, [path])), [path])
            path.write_text("int a;        // aligned with\nint long_one; // this\n")
            self.assertEqual(self.changes(path.parent, [path]), {})


if __name__ == "__main__":
    unittest.main()
