#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Steps a second from C, from Python's loop and from the command line, in pairs: the same scene, the same steps.

    validation/benchmark/callers.py [--cells 8 20 40 80] [--cold 80 160] [--repeats 25] [-o callers.md]

Processor time. A repeat steps the paper's Figure 1 by each caller in turn, C's loop in the same process as Python's; what Python adds is the median of its
differences to C in the same repeat, so that a machine that grows slower or faster does not decide. `a call` is
amontons_scene_read and amontons_run against amontons.run, of a run of few steps into the same folder. Last, whole processes that reduce
a block anew and end after the first step: the program has OpenMP and the allocator its own way, a host's are the host's. Exit status 1:
Python adds 2 us a step or more (on the first mesh), or 1 ms a call.
"""
import argparse
import ctypes
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measured_run import PROGRAM, ROOT, markdown_table

BUILD = PROGRAM.resolve().parents[1]
sys.path.insert(0, str(BUILD / "python"))
import amontons   # noqa: E402

SCENE = ROOT / "validation/paper/fig1.yaml"
STEP_MAX, CALL_MAX = 2.0, 1.0    # us, ms
QUIET = {"output.figures": [], "output.fields": None, "output.history": False}
HEAD = ["cells", "steps", "C", "Python, `for step in simulation`", "with `slip_rate.max()`", "command line",
        "Python adds, us a step", "with `slip_rate.max()`"]
COLD_HEAD = ["cells", "command line", "of this in the system", "C", "of this in the system", "Python", "of this in the system"]

C_CALLER = r"""
#include "amontons_simulation.h"

long loop(Simulation *simulation)
{
    Error err = {0};
    StepView view;
    bool finished = false;
    long steps = 0;
    double largest = 0;
    while (!finished && amontons_simulation_step(simulation, &view, &finished, &err)) {
        if (view.mu > largest) largest = view.mu;
        steps++;
    }
    return err.code || !(largest > 0) ? -1 : steps;
}

long call(const char *path, const char *folder, const char *const *settings, int count)
{
    Error err = {0};
    Scene *scene = NULL;
    RunOptions options = {.folder = folder, .overwrite = true};
    RunSummary summary;
    bool done = amontons_scene_read(path, settings, count, &scene, &err) &&
                amontons_run(scene, &options, &summary, &err);
    amontons_scene_destroy(scene);
    return done;
}

int main(int argc, char **argv)
{
    return !call(argv[1], argv[2], (const char *const *)argv + 3, argc - 3);
}
"""
PYTHON_CALLER = """
import sys
sys.path.insert(0, sys.argv[1])
import amontons
amontons.run(sys.argv[2], dict(word.split("=", 1) for word in sys.argv[4:]), sys.argv[3], overwrite=True)
"""


def words(settings):
    """As the command line has them."""
    plain = {None: "none", False: "false"}
    return [f"{key}={plain.get(value, value) if not isinstance(value, (list, dict)) else value}".replace("'", "")
            for key, value in settings.items()]


def compiled(folder):
    """The loop and the call in C, in this process: two processes differ by more than what is measured."""
    for name, kind in (("caller.so", ["-shared", "-fPIC"]), ("caller", [])):
        subprocess.run(["cc", "-O2", *kind, f"-I{ROOT / 'src'}", "-x", "c", "-", "-o", Path(folder, name),
                        f"-L{BUILD / 'bin'}", "-lamontons", f"-Wl,-rpath,{BUILD / 'bin'}"], input=C_CALLER, text=True, check=True)
    caller = ctypes.CDLL(str(Path(folder, "caller.so")))
    caller.loop.argtypes, caller.loop.restype = [ctypes.c_void_p], ctypes.c_long
    caller.call.restype = ctypes.c_long
    return caller


def in_c(simulation, caller):
    return caller.loop(simulation._handle)


def in_python(simulation, _):
    largest, steps = 0.0, 0
    for step in simulation:
        if step.mu > largest:
            largest = step.mu
        steps += 1
    return steps


def looking(simulation, _):
    largest, steps, slip_rate = 0.0, 0, simulation.slip_rate
    for _ in simulation:
        largest = max(largest, slip_rate.max())
        steps += 1
    return steps


def timed(loop, settings, caller):
    """Seconds of processor time in the loop of steps, and how many they were."""
    simulation = amontons.Simulation(SCENE, settings)
    begun = time.process_time()
    steps = loop(simulation, caller)
    return time.process_time() - begun, steps


def process_cost(command):
    """Seconds of processor time of a process: all, and of these in the system."""
    before = os.times()
    subprocess.run(list(map(str, command)), check=True)
    after = os.times()
    system = after.children_system - before.children_system
    return after.children_user - before.children_user + system, system


def command_line(settings, folder):
    """Processor time of a whole run, less that of one that ends after its first step."""
    def cost(more):
        return process_cost([PROGRAM, "run", SCENE, "-q", "--overwrite", "-o", f"{folder}/result", "--set",
                             *words({**settings, **more})])[0]
    return cost({}) - cost({"time.until": {"t": 1e-6}})


def cold_row(cells, repeats, folder):
    given = words({**QUIET, "mesh.set.nx": cells, "mesh.set.nz": cells, "reduction.use": "always", "reduction.cache": False,
                   "time.until": {"t": 1e-6}})
    result = f"{folder}/result"
    commands = {"command line": [PROGRAM, "run", SCENE, "-q", "--overwrite", "-o", result, "--set", *given],
                "C": [f"{folder}/caller", SCENE, result, *given],
                "Python": [sys.executable, "-c", PYTHON_CALLER, BUILD / "python", SCENE, result, *given]}
    costs = {name: [] for name in commands}
    for _ in range(repeats):
        for name, command in commands.items():
            costs[name].append(process_cost(command))
    return [f"{cells}x{cells}", *(f"{statistics.median(part):.2f} s" for cost in costs.values() for part in zip(*cost))]


def steps_row(caller, cells, repeats, folder):
    settings = {**QUIET, "mesh.set.nx": cells, "mesh.set.nz": cells}
    times = {in_c: [], in_python: [], looking: [], command_line: []}
    for _ in range(repeats):
        counted = set()
        for loop in (in_c, in_python, looking):
            seconds, steps = timed(loop, settings, caller)
            times[loop].append(seconds)
            counted.add(steps)
        if len(counted) != 1:
            sys.exit(f"the callers made {counted} steps")
        times[command_line].append(command_line(settings, folder))
    added = [1e6 * statistics.median(p - c for p, c in zip(times[loop], times[in_c])) / steps
             for loop in (in_python, looking)]
    rates = [f"{steps / statistics.median(seconds):.0f}" for seconds in times.values()]
    return [f"{cells}x{cells}", steps, *rates, *(f"{value:.2f}" for value in added)], added[0]


def call_cost(caller, repeats, folder):
    """Milliseconds of a call from C, and what Python adds: medians, of pairs."""
    settings = {**QUIET, "mesh.set.nx": 8, "mesh.set.nz": 8, "time.until": {"t": 1e-3}}
    given = [word.encode() for word in words(settings)]
    array = (ctypes.c_char_p * len(given))(*given)
    from_c, added = [], []
    for _ in range(10 * repeats):
        begun = time.process_time()
        if not caller.call(str(SCENE).encode(), f"{folder}/called".encode(), array, len(given)):
            sys.exit("the call from C failed")
        from_c.append(time.process_time() - begun)
        begun = time.process_time()
        amontons.run(SCENE, settings, f"{folder}/called", overwrite=True)
        added.append(time.process_time() - begun - from_c[-1])
    return 1e3 * statistics.median(from_c), 1e3 * statistics.median(added)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--cells", type=int, nargs="+", default=[8, 20, 40, 80])
    parser.add_argument("--cold", type=int, nargs="*", default=[80, 160])
    parser.add_argument("--repeats", type=int, default=25)
    parser.add_argument("-o", "--output", type=Path, help="a Markdown file for the tables")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["AMONTONS_CACHE"] = f"{folder}/cache"
        caller = compiled(folder)
        measured = [steps_row(caller, cells, options.repeats, folder) for cells in options.cells]
        from_c, added = call_cost(caller, options.repeats, folder)
        cold = [cold_row(cells, options.repeats, folder) for cells in options.cold]
    text = "## Steps a second, by caller\n\n" + markdown_table(HEAD, [row for row, _ in measured])
    text += ("\n\nWhat Python adds does not depend on the mesh: read it off the first row. Where steps are long it is\n"
             "less than two of them differ by. A call that does next to nothing (8 x 8 cells, into a folder) takes\n"
             f"{from_c:.2f} ms from C; Python adds {added:.2f} ms.\n\n"
             f"A process that reduces a block anew, to its first step, processor time:\n\n{markdown_table(COLD_HEAD, cold)}\n\n"
             "Of Python 0.1 s are its own start. libgomp calls the kernel for each of CHOLMOD's regions, three or so in each step of a factor; up to version 0.2 the\n"
             "program did without that, and kept memory between points. Since then its times are those of C.\n")
    print(text)
    if options.output:
        options.output.write_text(text)
    # What Python adds to a step does not depend on the mesh: it is seen best where steps are shortest.
    if measured[0][1] >= STEP_MAX or added >= CALL_MAX:
        sys.exit("Python adds too much")


if __name__ == "__main__":
    main()
