# SPDX-License-Identifier: GPL-2.0-or-later
"""A slower kernel is seen, on a busy machine and on another one: what callgrind counts, layer by
layer of src, against instructions.json beside this file.

    python3 tests/reports/test_instructions.py --record

writes that file anew: after a change that costs or saves instructions on purpose; say in the commit
by how much and what for. Counts of one program repeat to some 1e-5: OpenBLAS is held to one kernel
and glibc to its plainest functions, so that neither counts nor roundings depend on the processor.
Another compiler counts differently: then the comparison is skipped, and CTest says so. So do other
versions of the libraries: then their row is left out. What costs less is said and passes."""
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin"))
RECORD = Path(__file__).with_name("instructions.json")
SCENE = SOURCE / "validation" / "paper" / "fig1.yaml"
ALLOWED = 0.07             # relative; 10 % must be seen
LEAST = 1_000_000          # rows below are start-up and text: not compared
COMMON = ["mesh.set.nx=20", "mesh.set.nz=20", "output.figures=[]", "output.fields=none"]
# The first fills the cache that the second reads.
RUNS = {"reduction": ["time.until.t=1"],
        "steps, reduced": ["time.until.U=0.0026"],
        "steps, full": ["time.until.t=20", "reduction.use=never"]}
PINNED = {"OPENBLAS_CORETYPE": "Nehalem", "OPENBLAS_NUM_THREADS": "1",
          "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-ERMS,-FSRM"}
ALGEBRA = re.compile(r"/(libopenblas\w*|libcholmod|libcamd|libcolamd|lib\w*blas|liblapack)[-.]")


def named(text, names):
    """The name in "(3) name", or the one that (3) stood for before: callgrind writes each once."""
    number, _, name = text.partition(" ")
    if name:
        names[number] = name
    return names.get(number, text)


def count_layers(path, bin_folder):
    """Instructions of one callgrind file: {layer of src: n, "libraries": n}, and their objects."""
    files, objects = {}, {}
    counts, used = Counter(), set()
    ours, algebra, layer, called = False, False, None, False
    for line in path.read_text().splitlines():
        key, _, value = line.partition("=")
        if key == "ob":
            found = named(value, objects)
            ours = found.startswith(f"{bin_folder}/")
            algebra = bool(ALGEBRA.search(found))
            if algebra:
                used.add(Path(found).name)
        elif key in ("fl", "fi", "fe"):
            part = re.search(r"/src/(\w+)/", named(value, files))
            layer = part[1] if part else "other"
        elif key == "cob":
            named(value, objects)
        elif key in ("cfi", "cfl"):
            named(value, files)
        elif key == "calls":
            called = True        # the next line is what the callee cost
        elif line[:1] in "0123456789+-*" and line:
            cost = line.split()
            if not called and len(cost) > 1 and ours:
                counts[layer] += int(cost[1])
            if not called and len(cost) > 1 and algebra:
                counts["libraries"] += int(cost[1])
            called = False
    return dict(counts), used


def compiler():
    """What the program says it was compiled with."""
    text = subprocess.run(["readelf", "-p", ".comment", BIN / "amontons"], capture_output=True,
                          text=True).stdout
    found = re.search(r"GCC: .*|clang version .*", text)
    return f"{found[0].strip() if found else 'unknown'}, {platform.machine()}"


def build_type():
    cache = BIN.parent / "CMakeCache.txt"
    found = re.search(r"^CMAKE_BUILD_TYPE:\w+=(.*)$", cache.read_text(), re.M)
    return found[1] if found else ""


def measure():
    """What instructions.json holds, of the program as it is now."""
    counts, libraries = {}, set()
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, AMONTONS_CACHE=f"{folder}/cache", **PINNED)
        for name, settings in RUNS.items():
            words = [BIN / "amontons", "run", SCENE, "-o", f"{folder}/result", "--overwrite",
                     "--quiet"]
            for setting in COMMON + settings:
                words += ["--set", setting]
            profile = Path(folder, "callgrind")
            subprocess.run(["valgrind", "--tool=callgrind", "--quiet",
                            f"--callgrind-out-file={profile}", *words],
                           env=environment, check=True)
            counts[name], used = count_layers(profile, BIN.resolve())
            libraries |= used
    return {"compiler": compiler(), "libraries": sorted(libraries), "counts": counts}


def compare(recorded, now):
    """Lines about each row that left its range: (those that cost more, those that cost less)."""
    more, less = [], []
    same_libraries = recorded["libraries"] == now["libraries"]
    for run, layers in recorded["counts"].items():
        for layer, before in layers.items():
            if before < LEAST or layer == "libraries" and not same_libraries:
                continue
            change = now["counts"][run].get(layer, 0) / before - 1
            if abs(change) > ALLOWED:
                (more if change > 0 else less).append(
                    f"{run}: {layer}: {now['counts'][run].get(layer, 0)} instructions, "
                    f"{before} recorded ({100 * change:+.1f} %)")
    return more, less


@unittest.skipUnless(shutil.which("valgrind") and shutil.which("readelf"), "no valgrind here")
class Instructions(unittest.TestCase):
    def test_no_layer_costs_more(self):
        recorded = json.loads(RECORD.read_text())
        if build_type() != "Release":
            self.skipTest("counts are those of the release preset")
        if recorded["compiler"] != compiler():
            self.skipTest(f"recorded with {recorded['compiler']}, this is {compiler()}")
        more, less = compare(recorded, measure())
        record = "record it: python3 tests/reports/test_instructions.py --record"
        if less:
            print("cheaper than recorded, else a later loss hides behind this gain:", record, *less, sep="\n")
        if more:
            self.fail("\n".join([*more, f"more than {100 * ALLOWED:g} % up. If that is meant, {record}"]))

    def test_a_slower_layer_is_seen(self):
        recorded = json.loads(RECORD.read_text())
        slower = json.loads(RECORD.read_text())
        self.assertEqual(compare(recorded, slower), ([], []))
        slower["counts"]["steps, reduced"]["stepping"] *= 1.1
        slower["counts"]["steps, full"]["fem"] *= 0.9
        more, less = compare(recorded, slower)
        self.assertEqual([line.split(":")[1] for line in more], [" stepping"])
        self.assertEqual([line.split(":")[1] for line in less], [" fem"])


if __name__ == "__main__":
    if sys.argv[1:] == ["--record"]:
        RECORD.write_text(json.dumps(measure(), indent=2) + "\n")
        print(RECORD.read_text(), end="")
    else:
        unittest.main()
