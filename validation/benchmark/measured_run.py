# SPDX-License-Identifier: GPL-2.0-or-later
"""One run of the built program, measured: how it ended, what it said, what it cost. Used by
stress.py, precision.py, peers.py and growth.py. Costs are processor time and counts, which a busy machine does not
change."""
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy
from scipy.integrate import trapezoid

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("AMONTONS_BIN", ROOT / "build/bin"), "amontons")
if not PROGRAM.exists():
    sys.exit(f"{PROGRAM} is not built: `./amontons run --help` builds it")


@dataclass
class Measured:
    """What is left of one run."""
    status: int            # exit status; below 0: ended by that signal
    timed_out: bool
    seconds: float         # processor time, user and system
    memory: float          # largest resident size, MB
    said: str              # standard error without progress lines; paths relative to the project
    report: dict           # run.json; empty: none was written
    late_mu: float         # mean of mu over the second half of the time; NaN: no history
    phases: dict           # name -> (wall seconds, count); empty: no run.json


def is_message(line):
    """Progress lines on standard error begin with a percentage; messages do not."""
    return line.startswith("amontons:") or line.startswith(" ") and "%" not in line[:6]


def phases_of(report):
    """Where the time went, from run.json."""
    if "timing_s" not in report:
        return {}
    clock, steps = report["timing_s"], report["steps"]
    return {"mesh": (clock["mesh"], report["model"]["elements"]), "assemble, reduce": (clock["reduce"], report["model"]["full_dofs"]),
            "levels of dt": (clock["levels"], steps["factorisations"]), "contact": (clock["contact"], steps["contact_iterations"]),
            "certificate": (clock["certificate"], steps["certificates"]), "bulk": (clock["bulk"], steps["solves"]),
            "total": (clock["total"], steps["accepted"])}


def late_mean(path):
    """Mean of mu over the second half of the history's time."""
    if not path.exists():
        return math.nan
    with h5py.File(path) as history:
        time, mu = history["series/time"][:], history["series/mu"][:]
    half = time[-1] / 2
    if not half > 0:
        return math.nan
    late = time > half   # steps may be long: the half begins within one
    at, value = [half, *time[late]], [numpy.interp(half, time, mu), *mu[late]]
    return float(trapezoid(value, at) / half)


def run(scene, settings, cpu_limit=60, into=None, words=(), cache=None):
    """Runs `scene` with `settings` ("key=value"), at most `cpu_limit` seconds of processor time.
    into: a folder that keeps the result; None: thrown away. words: more for the command line.
    cache: folder of the shape cache; None: the caller's."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(into or f"{scratch}/result")
        words = [PROGRAM, "run", scene, "-o", folder, "--quiet", "--overwrite", *words]
        for setting in settings:
            words += ["--set", setting]

        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (cpu_limit, cpu_limit + 5))

        with open(f"{scratch}/said", "w+") as said:
            process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL,
                                       stderr=said, stdin=subprocess.DEVNULL, preexec_fn=limit,
                                       env=os.environ | ({"AMONTONS_CACHE": str(cache)} if cache else {}))
            _, status, usage = os.wait4(process.pid, 0)
            said.seek(0)
            text = "\n".join(line for line in said.read().splitlines() if is_message(line))
            text = text.replace(f"{ROOT}/", "")
        status = os.waitstatus_to_exitcode(status)
        process.returncode = status
        written = folder / "run.json"
        report = json.loads(written.read_text()) if written.exists() else {}
        late = late_mean(folder / "history.h5")
        seconds = usage.ru_utime + usage.ru_stime
    return Measured(status, status == -signal.SIGXCPU, seconds,
                    usage.ru_maxrss / 1024, text, report, late, phases_of(report))


def git(*words):
    return subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True)


def commit():
    """Which program was measured: the last commit that changed it, so that keeping a report is no
    new version; the program's own version where git or the repository is missing."""
    program = ("--", "src", "render", "meshes")
    if shutil.which("git") and (ROOT / ".git").exists():
        found = git("log", "-1", "--format=%h", *program).stdout.strip()
        if found:
            return found + "-dirty" * (git("diff", "--quiet", "HEAD", *program).returncode == 1)
    said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout
    return said.partition("\n")[0]


def markdown_row(cells):
    return "| " + " | ".join(str(cell).replace("|", "/") for cell in cells) + " |"


def markdown_table(head, rows):
    return "\n".join([markdown_row(head), "|" + "---|" * len(head), *map(markdown_row, rows)])
