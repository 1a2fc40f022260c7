#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Other programs on the same mesh and the same equations: what a step costs, and an answer.

    validation/benchmark/peers.py [--quick] [-o FOLDER]

The paper's block (set A, L = 1, P = 0.003, relaxed without friction) on one gmsh mesh of triangles,
to U = 0.006, by amontons (its defaults; the full sparse path; fixed steps; explicit), FreeFEM
(dynamics.edp) and GetFEM (getfem_dynamics.py). The last two take fixed steps of the same scheme as
amontons' fixed ones: their mu(t) must be the same, else their time says nothing. The fixed step is
the longest of a ladder that has the second peak, the first that counts for mu_M, within 1 % of a
converged run on this mesh. Times are processor seconds of the whole process, on a shape that is not
cached; of runs that would take too long a stretch is measured and scaled by its steps, and the
table says so. Leaves peers.md, peers.yaml and peers.png in FOLDER (default results/peers). A peer
that is not installed is left out, and the report says what to install. --quick: 10x10 cells only.
Exit status 1: a peer's answer differs."""
import argparse
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy

from figure import draw_page
from measured_run import ROOT, commit, markdown_table, run

HERE = Path(__file__).resolve().parent
SCENE = ROOT / "validation/paper/fig1.yaml"
FREEFEM = ROOT / "validation/freefem"
V, T_END, T_STRETCH, T_SLOW = 1e-5, 600, 240, 2   # U = 0.006; past the first rapid slips; of waves
SECOND_PEAK = (300, 600)      # t between which the block slides for the second time
STEPS = (0.4, 0.2, 0.1, 0.05)
PEAK_WITHIN = 0.01
SAME_WITHIN = 1e-4            # of mu, absolute, up to T_STRETCH: another program, the same steps
FIXED = ["reduction.use=never", "time.tolerance=1", "time.certificate=false",
         "time.energy_tolerance=1"]
PHYSICS = {"speed": V, "pressure": 0.003, "muS": 0.38, "muK": 0.1, "vc": 3.4e-4}
MISSING = {"FreeFEM": "freefem++ libfreefem++", "GetFEM": "python3-getfem"}


@dataclass
class Answer:
    """What a program found and what it cost."""
    name: str
    time: numpy.ndarray
    mu: numpy.ndarray
    steps: int
    seconds: float     # processor time of the process, scaled to T_END
    per_step: float    # of the time loop, s
    step: float        # 0: chosen by error control
    scaled: bool

    def peak(self):
        late = (self.time > SECOND_PEAK[0]) & (self.time < SECOND_PEAK[1])
        return self.mu[late].max() if late.any() and not self.scaled else math.nan

    def differs(self, other, until):
        """Largest difference of mu up to a time both reached."""
        seen = self.time <= min(until, other.time[-1])
        there = numpy.interp(self.time[seen], other.time, other.mu)
        return numpy.abs(self.mu[seen] - there).max()


def make_mesh(path, cells, order):
    """The physical numbers of its curves, by name."""
    words = ["gmsh", "-2", "-v", "1", ROOT / "meshes/block.geo", "-format", "msh22", "-o", path,
             "-setstring", "shape", "triangle"]
    for key, value in {"nx": cells, "nz": cells, "length": 1, "height": 0.5, "order": order}.items():
        words += ["-setnumber", key, value]
    subprocess.run([str(word) for word in words], check=True)
    return dict((name, number) for number, name in
                re.findall(r'^1 (\d+) "(\w+)"', path.read_text(), re.M))


def amontons(name, mesh, settings, step=0, duration=T_END):
    """A run of the program; None: it ended early."""
    words = [f"mesh.file={mesh}", "mesh.set={}", "start.friction=off", "output.figures=[]",
             "output.fields=none", "rod.ends=nodes", "reduction.cache=false", f"time.until={{t: {duration}}}",
             *settings]
    if step:
        words += [f"time.step_max={step}", f"time.step_min={step}"]
    with tempfile.TemporaryDirectory() as folder:
        ended = run(SCENE, words, 3600, into=f"{folder}/result")
        if ended.status != 0:
            return None
        with h5py.File(f"{folder}/result/history.h5") as history:
            time, mu = history["series/time"][:], history["series/mu"][:]
    took, steps = ended.report["timing_s"], ended.report["steps"]["accepted"]
    loop = took["solve"] * ended.seconds / took["total"]   # as if always on a processor
    scale = T_END / duration
    return Answer(name, time, mu, round(steps * scale), ended.seconds + (scale - 1) * loop,
                  loop / steps, step or ended.report["step_sizes"][0]["dt"] *
                  ("time.scheme=explicit" in settings), scale > 1)


def peer(name, words, mesh, curves, step, duration, environment=None):
    """A run of another program, which prints "steps N seconds S"."""
    steps = round(duration / step)
    with tempfile.TemporaryDirectory() as folder:
        words = [*words, "-mesh", mesh, "-out", f"{folder}/mu.txt", "-dt", step, "-steps", steps]
        for key, value in {**curves, **PHYSICS}.items():
            words += [f"-{key}", value]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        ended = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                               env={**os.environ, **(environment or {})})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if ended.returncode:
            raise RuntimeError(f"{name}: {ended.stdout[-500:]}{ended.stderr[-500:]}")
        time, mu = numpy.loadtxt(f"{folder}/mu.txt", unpack=True)
    loop = float(re.search(r"seconds (\S+)", ended.stdout)[1])
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    scale = T_END / duration
    return Answer(name, time, mu, round(steps * scale), used + (scale - 1) * loop, loop / steps,
                  step, scale > 1)


def have_getfem():
    return subprocess.run([sys.executable, "-c", "import getfem"], capture_output=True).returncode == 0


def fixed_answer(mesh, converged):
    """amontons at the longest fixed step that is good enough."""
    for step in STEPS:
        found = amontons("amontons, fixed step", mesh, FIXED, step)
        if found and abs(found.peak() / converged.peak() - 1) <= PEAK_WITHIN:
            return found
    raise RuntimeError("no fixed step reaches the second peak")


def freefem(mesh, curves, order, step, duration):
    environment = {"FF_LOADPATH": "/usr/lib/freefem++",
                   "FF_INCLUDEPATH": f"{FREEFEM}/P{order};{FREEFEM}"}
    words = ["FreeFem++", "-nw", "-ne", "-v", "0", HERE / "dynamics.edp"]
    return peer(f"FreeFEM P{order}", words, mesh, curves, step, duration, environment)


def compare(cells, order, whole, missing):
    """All programs on one mesh: answers, and of the peers how far from amontons' own steps."""
    with tempfile.TemporaryDirectory() as folder:
        ours, linear = Path(folder, "ours.msh"), Path(folder, "linear.msh")
        curves = make_mesh(linear, cells, 1)
        make_mesh(ours, cells, order)
        duration = T_END if whole else T_STRETCH
        full = "reduction.use=never"
        converged = amontons("converged", ours, ["time.tolerance=1e-5", "time.wave_step=0.05", full])
        fixed = fixed_answer(ours, converged)
        answers = [amontons("amontons", ours, []),
                   amontons("amontons, full sparse path", ours, [full]), fixed]
        if "FreeFEM" not in missing:
            answers.append(freefem(linear, curves, order, fixed.step, duration))
        if "GetFEM" not in missing and order == 1:
            answers.append(peer("GetFEM P1", [sys.executable, HERE / "getfem_dynamics.py"], linear,
                                curves, fixed.step, duration))
        answers.append(amontons("amontons, explicit", ours, ["time.scheme=explicit"],
                                duration=T_END if whole else T_SLOW))
    return converged, fixed, answers


def rows_of(label, converged, fixed, answers):
    """Rows of the table, and names of peers whose answer differs."""
    first_slip = 226 if converged.time[-1] > 226 else converged.time[-1]
    rows, wrong = [], []
    default = answers[0].seconds
    for one in answers:
        is_peer = not one.name.startswith("amontons")
        same = one.differs(fixed, T_STRETCH) if is_peer else math.nan
        if is_peer and not same <= SAME_WITHIN:
            wrong.append(f"{one.name}, {label}: mu differs by {same:.1e}")
        peak = one.peak() / converged.peak() - 1
        rows.append([label, one.name, f"{one.step:.3g}" if one.step else "adaptive", one.steps,
                     f"{1e3 * one.per_step:.3g}", f"{same:.1e}" if is_peer else "",
                     f"{one.differs(converged, first_slip):.1e}",
                     "" if math.isnan(peak) else f"{100 * peak:+.2f} %",
                     f"{one.seconds:.3g}", "scaled" if one.scaled else "measured",
                     f"{one.seconds / default:.3g}"])
        print("  ".join(str(cell) for cell in rows[-1]), flush=True)
    return rows, wrong


HEAD = ["mesh", "program", "step", "steps", "ms a step", "mu: off amontons' same steps",
        "mu: off converged, before slip", "second peak", "cpu s to U = 0.006", "how", "ratio"]


FIGURES = {"peers": ("Other programs on the same mesh", "cells along the block", "processor time to ~{U} = 0.006 (s)",
                     lambda row: [(row[1], row[0].split("x")[-1], row[8])] if row[0].startswith("T3") else [])}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results/peers")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--draw", type=Path, help="the figure of this peers.md anew, from its table; nothing is computed")
    options = parser.parse_args()
    if options.draw:
        return draw_page(options.draw, FIGURES)
    options.output.mkdir(parents=True, exist_ok=True)
    missing = [name for name, there in (("FreeFEM", shutil.which("FreeFem++")),
                                        ("GetFEM", have_getfem())) if not there]
    for name in missing:
        print(f"{name} is left out: apt-get install {MISSING[name]}")
    meshes = [(10, 1, False)] if options.quick else [(10, 1, True), (20, 1, True),
                                                     (10, 2, False), (40, 1, False)]
    rows, wrong = [], []
    for cells, order, whole in meshes:
        converged, fixed, answers = compare(cells, order, whole, missing)
        more, differing = rows_of(f"T{3 * order} {cells}x{cells}", converged, fixed, answers)
        rows, wrong = rows + more, wrong + differing
    notes = [f"- {name} is left out: `apt-get install {MISSING[name]}`" for name in missing]
    notes += [f"- DIFFERENT: {line}" for line in wrong]
    text = (f"## Other programs on the same mesh\n\nversion {commit()}; set A, L = 1, P = 0.003, to "
            "U = 0.006, relaxed without friction. `mu: off amontons' same steps`: the largest "
            f"difference up to t = {T_STRETCH}, rapid slips included; at most {SAME_WITHIN:g} is "
            "allowed. `second peak`: the first that counts for mu_M, against a converged run on "
            "this mesh (tolerance 1e-5, a quarter of the wave step). GetFEM's brick knows no "
            "friction that falls with the slip rate: it is solved again with mu(v) until that "
            "stays. `ratio`: seconds over those of amontons' defaults.\n\n"
            + "\n".join(notes + [""]) + markdown_table(HEAD, rows)
            + "\n" + "\n![seconds against cells](peers.png)\n" * (len(meshes) > 1))
    (options.output / "peers.md").write_text(text)
    draw_page(options.output / "peers.md", FIGURES)
    print(f"{options.output}/peers.md")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
