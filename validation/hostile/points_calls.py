#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What once crashed or misled callers of the library, and those who start processes: each tried by a program of its own.

    validation/hostile/points_calls.py [--only NAME ...]

As points.py, which prints the table: a function takes an empty folder and yields (what was tried, what happened, good or not).
"""
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from point_table import main

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("AMONTONS_BIN", ROOT / "build/bin"), "amontons").resolve()
MODULE = PROGRAM.parents[1] / "python"
SCENE = ROOT / "validation/paper/fig1.yaml"
SMALL = {"mesh.set.nx": 8, "mesh.set.nz": 8, "time.until": {"U": 0.004}, "output.fields": None, "output.figures": []}
PATIENCE = 100     # seconds until a try counts as endless
PYTHON = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable   # Debian's, with numpy


def begin(words, folder, **more):
    return subprocess.Popen(list(map(str, words)), cwd=folder, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, **more)


def python(folder, script, interrupts=0):
    """(status, what it said) of a script that knows `amontons`, SCENE and SMALL; with Ctrl-C after its first line."""
    text = f"import sys; sys.path.insert(0, {str(MODULE)!r})\nimport amontons\nSCENE, SMALL = {str(SCENE)!r}, {SMALL!r}\n{script}"
    process = begin([PYTHON, "-c", text], folder)
    first = process.stdout.readline() if interrupts else ""
    for _ in range(interrupts):
        time.sleep(0.02)
        process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=PATIENCE)[0]
    return process.returncode, first + said


POINTS = {}


def point(function):
    POINTS[function.__name__] = function
    return function


def judged(tried, found, status, words):
    """Whether it ended so and said so."""
    return tried, (found[1].strip().splitlines() or ["nothing said"])[-1], found[0] == status and words in found[1]


def refused(folder, call, words):
    """An InputError that says `words`, and nothing is left in the folder."""
    found = python(folder, f"try:\n    {call}\nexcept amontons.InputError as error:\n    print(error)")
    tried, happened, good = judged(call, found, 0, words)
    return tried, happened, good and not list(folder.iterdir())


@point
def step_after_finish(folder):
    """1: a null ArrayFile, with a result folder."""
    script = ("one = amontons.Simulation(SCENE, SMALL, 'run')\none.advance()\none.finish()\n"
              "try:\n    one.advance()\nexcept amontons.InputError as error:\n    print(error)")
    yield judged("a step after finish, with a folder", python(folder, script), 0, "is finished")


@point
def second_interrupt(folder):
    """2: the library's thread went on over a scene that was destroyed."""
    script = ("import threading\nlarge = {**SMALL, 'mesh.set.nx': 200, 'mesh.set.nz': 200, 'reduction.use': 'always', "
              "'reduction.cache': False}\nthreading.Timer(0.3, print, ('begun',), {'flush': True}).start()\n"
              "try:\n    amontons.run(SCENE, large, 'run')\nexcept KeyboardInterrupt:\n    print(threading.active_count(), 'thread')")
    yield judged("Ctrl-C five times while it reduces", python(folder, script, interrupts=5), 0, "\n1 thread\n")


@point
def velocity_beyond_measure(folder):
    """3: accepted, U = -inf and mu 0."""
    yield refused(folder, "amontons.Simulation(SCENE, SMALL).set_rod_velocity(-1e308)", "rod velocity of -1e+308 is not possible")


@point
def zero_byte_in_a_path(folder):
    """3: cut, and written to."""
    yield refused(folder, "amontons.run(SCENE, SMALL, 'cut\\0off')", "zero byte")
    yield refused(folder, "amontons.Simulation(SCENE, SMALL).save('cut\\0off')", "zero byte")


def slurm(folder, **scripts):
    """PATH with these of Slurm's commands, each a script."""
    for name in ("sbatch", "squeue", "scancel", "scontrol"):
        file = folder / name
        file.write_text(f"#!/bin/sh\ncd {folder}\n{scripts.get(name, '')}\n")
        file.chmod(0o755)
    (folder / "study.yaml").write_text(f"scene: {SCENE}\nvary: {{load.pressure: [0.002, 0.006]}}\nrecord: [mu_max]\n")
    return {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}


def ignore_children():
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)


@point
def sbatch_that_fails(folder):
    """4: where SIGCHLD was ignored it counted as done, its words as the job."""
    paths = slurm(folder, sbatch="echo sbatch: error: invalid partition; [ $1 = --version ]")
    process = begin([PROGRAM, "sweep", "study.yaml", "--slurm", "-o", "points"], folder, env=paths, preexec_fn=ignore_children)
    said = process.communicate(timeout=PATIENCE)[0]
    yield judged("a sweep, SIGCHLD ignored", (process.returncode, said), 1, "sbatch refuses the array: sbatch: error: invalid partition")


@point
def host_that_ignores_its_children(folder):
    """4: the library in such a process."""
    slurm(folder, sbatch="echo sbatch: error: invalid partition; [ $1 = --version ]")
    script = (f"import os, signal\nsignal.signal(signal.SIGCHLD, signal.SIG_IGN)\nos.environ['PATH'] = {str(folder)!r} + ':/bin'\n"
              "try:\n    amontons.sweep('study.yaml', folder='points', slurm='')\nexcept amontons.LibraryError as error:\n    print(error)")
    yield judged("a sweep from Python, SIGCHLD ignored", python(folder, script), 0, "in a way that nobody can say")


@point
def squeue_that_fails(folder):
    """4: a cancelled sweep took it for an empty queue."""
    paths = slurm(folder, sbatch="echo 1", scancel=": >cancelled",
                  squeue="if [ -e cancelled ]; then echo . >>asked; case $(wc -l <asked) in 1 | 2) exit 1;; 3) echo 1;; esac\n"
                  "else echo '1 0 RUNNING None'; : >running; fi")
    process = begin([PROGRAM, "sweep", "study.yaml", "--slurm", "-o", "points"], folder, env=paths)
    limit = time.monotonic() + PATIENCE
    while not (folder / "running").exists() and time.monotonic() < limit:
        time.sleep(0.02)
    process.terminate()
    said = process.communicate(timeout=PATIENCE)[0]
    asked = (folder / "asked").read_text().count(".") if (folder / "asked").exists() else 0
    yield "a sweep is stopped, squeue fails twice", f"squeue was asked {asked} times; {said.splitlines()[-1:]}", asked == 4


@point
def stop_at_any_moment(folder):
    """4: between fork and read it did not reach the process that draws."""
    settings = [f"{key}={'none' if value is None else json.dumps(value)}" for key, value in SMALL.items()]
    subprocess.run([PROGRAM, "run", SCENE, "-q", "-o", folder / "run", "--set", *settings], check=True)
    late = []
    for _ in range(20):
        process = begin([PROGRAM, "film", "run", "-o", "film.mp4", "--seconds", "100"], folder)
        time.sleep(random.uniform(0, 0.1))
        sent = time.monotonic()
        process.terminate()
        try:
            process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
        late.append(time.monotonic() - sent)
    yield ("SIGTERM to a film, 20 times", f"ended after {max(late):.1f} s at most",
           max(late) < 10 and not (folder / "film.mp4").exists())


if __name__ == "__main__":
    sys.exit(main(POINTS))
