#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What once crashed or misled callers of the library, and those who start processes: each tried by a program of its own.

    validation/hostile/points_calls.py [NAME ...]

POINTS is the table: a name, and a function that is given an empty folder and returns what is wrong, "" where nothing is.
Exit status 1: something is."""
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

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


def expect(found, status, words):
    """"" where it ended so and said so."""
    return "" if found[0] == status and words in found[1] else f"status {found[0]}: {found[1][-300:]}"


def refused(folder, call, words):
    """An InputError that says `words`, and nothing is left in the folder."""
    found = python(folder, f"try:\n    {call}\nexcept amontons.InputError as error:\n    print(error)")
    left = [path.name for path in folder.iterdir()]
    return expect(found, 0, words) or (f"left: {left}" if left else "")


def step_after_finish(folder):
    """1: a null ArrayFile, with a result folder."""
    return expect(python(folder, "one = amontons.Simulation(SCENE, SMALL, 'run')\none.advance()\none.finish()\n"
                         "try:\n    one.advance()\nexcept amontons.InputError as error:\n    print(error)"), 0, "is finished")


def second_interrupt(folder):
    """2: the library's thread went on over a scene that was destroyed."""
    script = ("import threading\nlarge = {**SMALL, 'mesh.set.nx': 200, 'mesh.set.nz': 200, 'reduction.use': 'always', "
              "'reduction.cache': False}\nthreading.Timer(0.3, print, ('begun',), {'flush': True}).start()\n"
              "try:\n    amontons.run(SCENE, large, 'run')\nexcept KeyboardInterrupt:\n    print(threading.active_count(), 'thread')")
    return expect(python(folder, script, interrupts=5), 0, "\n1 thread\n")


def velocity_beyond_measure(folder):
    """3: accepted, U = -inf and mu 0."""
    return refused(folder, "amontons.Simulation(SCENE, SMALL).set_rod_velocity(-1e308)", "rod velocity of -1e+308 is not possible")


def zero_byte_in_a_path(folder):
    """3: cut, and written to."""
    return (refused(folder, "amontons.run(SCENE, SMALL, 'cut\\0off')", "zero byte") or
            refused(folder, "amontons.Simulation(SCENE, SMALL).save('cut\\0off')", "zero byte"))


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


def sbatch_that_fails(folder):
    """4: where SIGCHLD was ignored it counted as done, its words as the job."""
    paths = slurm(folder, sbatch="echo sbatch: error: invalid partition; [ $1 = --version ]")
    process = begin([PROGRAM, "sweep", "study.yaml", "--slurm", "-o", "points"], folder, env=paths, preexec_fn=ignore_children)
    said = process.communicate(timeout=PATIENCE)[0]
    return expect((process.returncode, said), 1, "sbatch refuses the array: sbatch: error: invalid partition")


def host_that_ignores_its_children(folder):
    """4: the library in such a process."""
    slurm(folder, sbatch="echo sbatch: error: invalid partition; [ $1 = --version ]")
    script = (f"import os, signal\nsignal.signal(signal.SIGCHLD, signal.SIG_IGN)\nos.environ['PATH'] = {str(folder)!r} + ':/bin'\n"
              "try:\n    amontons.sweep('study.yaml', folder='points', slurm='')\nexcept amontons.LibraryError as error:\n    print(error)")
    return expect(python(folder, script), 0, "in a way that nobody can say")


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
    return "" if asked == 4 else f"squeue was asked {asked} times: {said[-300:]}"


def stop_at_any_moment(folder):
    """4: between fork and read it did not reach the process that draws."""
    settings = [f"{key}={'none' if value is None else json.dumps(value)}" for key, value in SMALL.items()]
    subprocess.run([PROGRAM, "run", SCENE, "-q", "-o", folder / "run", "--set", *settings], check=True)
    for _ in range(20):
        process = begin([PROGRAM, "film", "run", "-o", "film.mp4", "--seconds", "100"], folder)
        pause = random.uniform(0, 0.1)
        time.sleep(pause)
        process.terminate()
        try:
            process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return f"a film went on after SIGTERM at {pause:.4f} s"
        if (folder / "film.mp4").exists():
            return "a film that was stopped is there"
    return ""


POINTS = [(function.__name__, function) for function in (
    step_after_finish, second_interrupt, velocity_beyond_measure, zero_byte_in_a_path, sbatch_that_fails,
    host_that_ignores_its_children, squeue_that_fails, stop_at_any_moment)]


def main():
    wrong = 0
    for name, point in POINTS:
        if len(sys.argv) > 1 and name not in sys.argv[1:]:
            continue
        with tempfile.TemporaryDirectory() as folder:
            fault = point(Path(folder))
        print(f"{name:32} {fault or 'well'}", flush=True)
        wrong += bool(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
