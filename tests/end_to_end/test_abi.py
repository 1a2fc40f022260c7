# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs that were compiled against libamontons.so go on working, or somebody says that they do not: its functions
and structs against libamontons.abi beside this file, by abidiff.

    /usr/bin/python3 tests/end_to_end/test_abi.py --record

writes that file anew: after a change that is meant. Once a version is released, any change but a new function needs a
new minor version in CMakeLists.txt (before 1.0; then a new major one), which gives the library another name.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")).resolve().parent
RECORD = Path(__file__).with_name("libamontons.abi")
CHANGED, BROKEN = 4, 8                           # bits of abidiff's exit status; broken: certainly incompatible


def run(*words, status=(0,)):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode not in status:
        raise AssertionError(f"{words}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def headers_of(source):
    """The library's; amontons_friction.h says what a plug-in defines."""
    return sorted(header for header in source.glob("amontons*.h") if header.name != "amontons_friction.h")


def library_of_headers(folder, headers):
    """A library with every function that the headers declare, empty, to be looked at only: what the real one has besides
    (its own structs) is nobody's business, and that it fits the headers its compiler has checked."""
    text = "".join(f'#include "{header.name}"\n' for header in headers)
    for header in headers:
        plain = re.sub(r"//[^\n]*", "", header.read_text())
        for declared in re.findall(r"(?m)^(\w[^\n;{}]*?\bamontons_\w+\([^;]*\));", plain):
            text += f"{declared}\n{{\n    __builtin_trap();\n}}\n"
    (folder / "library.c").write_text(text)
    run("cc", "-std=c17", "-g", "-fPIC", "-shared", "-nostdlib", f"-I{headers[0].parent}", f"-ffile-prefix-map={folder}/=",
        f"-ffile-prefix-map={headers[0].parent}/=", folder / "library.c", "-o", folder / "libamontons.so")
    return folder / "libamontons.so"


def describe(folder, source=SOURCE / "src"):
    """The ABI as abidw has it, with nothing of this machine."""
    output = folder / "now.abi"
    run("abidw", "--no-corpus-path", "--no-comp-dir-path", "--no-show-locs", "--out-file", output,
        library_of_headers(folder, headers_of(source)))
    return output


@unittest.skipUnless(shutil.which("abidiff"), "no abidiff here")
class Abi(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-abi-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def compare(self, now):
        # What FILE has inside is the C library's, and differs from version to version.
        known = self.folder / "known.ini"
        known.write_text("[suppress_type]\nname = _IO_FILE\n")
        done = run("abidiff", "--suppressions", known, RECORD, now, status=(0, 1, CHANGED, CHANGED | BROKEN))
        if "incompatible format version" in done.stdout + done.stderr:
            self.skipTest("the abidw here writes another format than the record's")
        self.assertNotEqual(done.returncode, 1, done.stdout + done.stderr)
        return done

    def test_is_the_recorded_one(self):
        done = self.compare(describe(self.folder))
        if done.returncode:
            self.fail(f"the ABI has changed:\n{done.stdout}\nIf that is meant: /usr/bin/python3 "
                      f"tests/end_to_end/test_abi.py --record (and see what it says on versions)")

    def test_all_functions_are_in_it(self):
        listing = run("nm", "-D", "--defined-only", BUILD / "bin/libamontons.so").stdout
        shown = {line.split()[-1] for line in listing.splitlines() if " amontons_" in line}
        self.assertEqual(shown, set(re.findall(r"elf-symbol name='(amontons_\w+)'", RECORD.read_text())))

    def test_sees_changes(self):
        """A field between others; an argument more; a function that is gone; an enumerator before others."""
        for name, old, new, status in (
                ("field", "    double t, U;", "    double before, t, U;", CHANGED),
                ("argument", "const char *amontons_version(void);", "const char *amontons_version(int32_t a);", CHANGED),
                ("function", "const char *amontons_libraries(void);", "", CHANGED | BROKEN),
                ("code", "X(ERROR_FILE, 1", "X(ERROR_NEW, 1, \"new\") X(ERROR_FILE, 1", CHANGED)):
            root = self.folder / name
            root.mkdir()
            for header in (SOURCE / "src").glob("amontons*.h"):
                (root / header.name).write_text(header.read_text().replace(old, new))
            with self.subTest(name):
                self.assertEqual(self.compare(describe(root, root)).returncode, status)


if __name__ == "__main__":
    if sys.argv[1:] == ["--record"]:
        with tempfile.TemporaryDirectory() as place:
            shutil.copy(describe(Path(place)), RECORD)
    else:
        unittest.main()
