#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The same scene gives the same bits, whatever surrounds it: cache, output, folder, locale, time
zone, umask, threads, where memory lies, jobs of a sweep, a stop and --resume, with the kernels that OpenBLAS takes here and
with Prescott's, which round by alignment. Other kernels (kernels.py compares answers) and other optimisation may round
otherwise: within TOLERANCE.

    validation/hostile/same_bits.py [-o FOLDER] [--build FOLDER ...]

--build: build folders with other optimisation to compare with (build-sanitize: -O1, build-coverage:
-O0, or of `cmake -B FOLDER -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O3`). Prints a table and leaves same_bits.md in FOLDER (default results/hostile). Exit status 1:
something differs that should not.
"""
import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy

import cases
from cases import ROOT, STUDY
from tries import PROGRAM, SCRATCH

sys.path.append(str(ROOT / "tests/end_to_end"))
from preload_fixture import preload  # noqa: E402

# Largest difference of mu over the run, over the largest mu; the same number of steps is not asked.
TOLERANCE = 1e-6
SCENE = cases.SCENE.replace("U: 0.0008", "U: 0.006")   # with slidings, which multiply a difference
RUN = ["run", "scene.yaml", "-o", "out", "--quiet"]
LOCALES = {"de_DE.UTF-8": "de_DE", "tr_TR.UTF-8": "tr_TR"}
KERNELS = ["Prescott", "Nehalem", "Sandybridge", "Haswell", "Zen", "SkylakeX"]
# Where OpenBLAS does not know the processor the program chooses its kernels, a host does it by the variable.
KERNELS_TAKEN = re.search(r"OpenBLAS's (\w+) kernels", subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout)[1]
SHIFTED = ROOT / "build/tests/shifted_memory.so"   # built by ./amontons test


def digest(folder):
    """Of what must be the same: results and counts of run.json, every array of the history."""
    report = json.loads((folder / "run.json").read_text())
    kept = {key: report.get(key) for key in ("status", "results", "errors", "warnings")}
    kept["steps"] = {key: value for key, value in report["steps"].items() if "allocation" not in key}
    parts = {"run.json": hashlib.sha256(json.dumps(kept, sort_keys=True).encode()).hexdigest()}
    if (folder / "history.h5").exists():
        with h5py.File(folder / "history.h5") as file:
            file.visititems(lambda name, item: parts.update({name: hashlib.sha256(item[()].tobytes()).hexdigest()})
                            if isinstance(item, h5py.Dataset) else None)
    return parts


def series(folder):
    with h5py.File(folder / "history.h5") as file:
        return file["series/rod_displacement"][:], file["series/mu"][:]


class Place:
    """Folders with the scene, and runs in them."""
    def __init__(self, scratch, env=None):
        self.scratch, self.count, self.env = scratch, 0, env or {}
        self.cache = scratch / "cache"
        scratch.mkdir(exist_ok=True)

    def prepare(self):
        self.count += 1
        folder = self.scratch / f"run{self.count}"
        cases.put(folder, {"scene.yaml": SCENE, "study.yaml": STUDY, "block.geo": ROOT / "meshes/block.geo"})
        return folder

    def run(self, words=RUN, env=None, shell="", program=PROGRAM):
        folder = self.prepare()
        line = [str(program), *words]
        if shell:
            line = ["sh", "-c", shell, "sh", *line]
        ended = subprocess.run(line, cwd=folder, env=os.environ | {"AMONTONS_CACHE": ""} | self.env | (env or {}),
                               capture_output=True, text=True)
        if ended.returncode != 0:
            raise RuntimeError(f"{words} {env} {shell}: {ended.stderr}")
        return folder

    def run_python(self, env):
        """The same by the library, in a process that is not the program: with the kernels that the program takes by itself."""
        env = {"OPENBLAS_CORETYPE": KERNELS_TAKEN} | self.env | env
        words = ["-c", "import amontons; amontons.run('scene.yaml', folder='out')"]
        return self.run(words, env={"PYTHONPATH": str(PROGRAM.parents[1] / "python")} | env, program="/usr/bin/python3")


def resumed(place):
    """A run that was stopped by SIGTERM and gone on with, twice at least."""
    stops, pause = 0, 0.2
    while stops < 2 and pause > 1e-3:
        folder, stops, more = place.prepare(), 0, []
        while True:
            process = subprocess.Popen([str(PROGRAM), *RUN, *more], cwd=folder, env=os.environ | {"AMONTONS_CACHE": str(place.cache)},
                                       stderr=subprocess.DEVNULL)
            try:
                process.wait(pause)
            except subprocess.TimeoutExpired:
                process.terminate()
            if process.wait() == 0:
                break
            more = ["--resume"] if (folder / "out/checkpoint.bin").exists() else ["--overwrite"]
            stops += more == ["--resume"]
            pause *= 1.05 if more == ["--resume"] else 1.5   # before the first step nothing is kept
        pause /= 2
    return folder, stops


def locales(scratch):
    """{name: environment} of the locales that this system can make."""
    found = {}
    for name, source in LOCALES.items():
        made = subprocess.run(["localedef", "-i", source, "-f", "UTF-8", str(scratch / name)], capture_output=True)
        if (scratch / name).exists() or made.returncode == 0:
            found[name] = {"LOCPATH": str(scratch), "LC_ALL": name, "LANG": name}
    return found


def exact_cases(place):
    """(what, folder of the result) of all that must be the same bits."""
    yield "once more", place.run()
    yield "no history, no pictures", place.run(RUN + ["--set", "output.history=false"])
    yield "pictures", place.run(RUN + ["--set", "output.figures=[force, slip-map]"])
    folder, stops = resumed(place)
    yield f"stopped {stops} times, --resume", folder
    yield "not quiet", place.run(["run", "scene.yaml", "-o", "out"])
    yield "another current folder", place.run(shell='p="$1"; here="$PWD"; cd /; exec "$p" run "$here/scene.yaml" '
                                                    '-o "$here/out" --quiet')
    yield "mesh in this process", place.run(env={"AMONTONS_APART": ""})
    for name, env in locales(place.scratch).items():
        yield f"locale {name}", place.run(env=env)
    for zone in ("Pacific/Kiritimati", "America/St_Johns"):
        yield f"TZ {zone}", place.run(env={"TZ": zone})
    yield "umask 077", place.run(shell='umask 077; exec "$@"')
    for threads in ("1", "2", "7"):
        yield f"OPENBLAS_NUM_THREADS {threads}", place.run(env={"OPENBLAS_NUM_THREADS": threads})
    yield "no environment but the choice of kernels", place.run(
        shell='exec env -i AMONTONS_CACHE= ${OPENBLAS_CORETYPE:+OPENBLAS_CORETYPE="$OPENBLAS_CORETYPE"} "$@"')


def memory_cases(place):
    """The same of where memory lies, under whatever kernels are asked for by `place`."""
    for threads in ("1", "4"):
        yield f"OMP_NUM_THREADS {threads}", place.run(env={"OMP_NUM_THREADS": threads})
        yield f"library in Python, OMP_NUM_THREADS {threads}", place.run_python({"OMP_NUM_THREADS": threads})
    for shift in ("16", "32", "48"):
        yield f"malloc and stack {shift} bytes further", place.run(
            env={**preload(SHIFTED), "MEMORY_SHIFT": shift, "LONGER": "x" * int(shift)})
    for what in ("cold", "warm"):
        yield f"{what} cache", place.run(env={"AMONTONS_CACHE": str(place.cache)})
    others = {"AMONTONS_CACHE": str(place.scratch / "others")}
    place.run(RUN + ["--set", "load.pressure=0.005", "time.until.U=0.001", "reduction.use=always"], env=others)
    yield "cache that another run has left", place.run(env=others)


def sweep_cases(place):
    """(what, the table's text without times) of a sweep by one and by more jobs."""
    for jobs in ("1", "2", "5"):
        folder = place.run(["sweep", "study.yaml", "-o", "points", "-j", jobs, "--quiet"])
        reports = [json.loads(path.read_text()) for path in sorted(folder.glob("points/**/run.json"))]
        yield f"sweep -j {jobs}", json.dumps([[r["results"], r["errors"]] for r in reports], sort_keys=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/hostile")
    parser.add_argument("--build", nargs="*", default=[], type=Path, help="other build folders")
    options = parser.parse_args()
    rows, wrong = [], 0
    with tempfile.TemporaryDirectory(dir=SCRATCH) as scratch:
        place = Place(Path(scratch))
        reference = place.run()
        wanted, (way, mu) = digest(reference / "out"), series(reference / "out")
        for what, folder in exact_cases(place):
            found = digest(folder / "out")
            differ = [name for name in found if found[name] != wanted.get(name)]
            rows.append((what, "same bits" if not differ else "DIFFERS: " + ", ".join(differ)))
            wrong += bool(differ)
        for name in ("", "Prescott"):
            under = Place(Path(scratch) / f"under{name}", {"OPENBLAS_CORETYPE": name} if name else {})
            expected = digest(under.run() / "out")
            for what, folder in memory_cases(under):
                same = digest(folder / "out") == expected
                rows.append((f"{what}{', kernels of ' + name if name else ''}", "same bits" if same else "DIFFERS"))
                wrong += not same
        tables = dict(sweep_cases(place))
        for what, table in tables.items():
            same = table == tables["sweep -j 1"]
            rows.append((what, "same bits" if same else "DIFFERS"))
            wrong += not same
        others = [(f"OPENBLAS_CORETYPE {name}", {"OPENBLAS_CORETYPE": name}, PROGRAM) for name in KERNELS]
        others += [(f"{build}", {"AMONTONS_MODULES": str(build.resolve() / "bin"), "ASAN_OPTIONS": "detect_leaks=0"},
                    build.resolve() / "bin/amontons") for build in options.build]
        for what, env, program in others:
            folder = place.run(env=env, program=program)
            other_way, other = series(folder / "out")
            difference = float(numpy.max(numpy.abs(numpy.interp(way, other_way, other) - mu)) / numpy.max(mu))
            same = digest(folder / "out") == wanted
            rows.append((what, "same bits" if same else f"mu within {difference:.1g}"))
            wrong += difference > TOLERANCE
    text = "| what is different | result |\n|---|---|\n" + "\n".join(f"| {what} | {found} |" for what, found in rows)
    options.output.mkdir(parents=True, exist_ok=True)
    (options.output / "same_bits.md").write_text(text + "\n")
    print(f"{text}\n\n{len(rows)} rows, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
