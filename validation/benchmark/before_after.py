#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Two builds of amontons on the same scenes: are the histories the same, bit by bit, and what do they cost?

    validation/benchmark/before_after.py [--no-instructions] BEFORE AFTER [CASE ...]

BEFORE and AFTER are folders with `amontons` and its modules (build/bin). Figure 1, set B on pads and the peers' scenes
run once by each, on the whole mesh and on the reduced one. Compared are all arrays that both histories have; of those
that differ the largest difference is told, over the largest value. Instructions are callgrind's, of a shorter run of the
same whose shape is in the cache, with the pinned libraries of tests/reports/test_instructions.py. Prints a table."""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/reports"))
FIG1, PADS = ROOT / "validation/paper/fig1.yaml", ROOT / "validation/pads/pads-b.yaml"
FULL = ["reduction.use=never"]
PEERS = ["start.friction=off", "rod.ends=nodes", "mesh.set={shape: triangle, nx: 40, nz: 40}", "time.until.U=0.006"]
FIXED = [*FULL, "time.tolerance=1", "time.certificate=false", "time.energy_tolerance=1", "time.step_max=0.2",
         "time.step_min=0.2", "time.until.U=0.001"]
# name: scene, settings, settings of the run that is counted
CASES = {
    "figure 1, reduced": (FIG1, [], ["time.until.U=0.004"]),
    "figure 1, whole mesh of 40 x 40": (FIG1, ["mesh.set.nx=40", "mesh.set.nz=40", *FULL, "time.until.U=0.006"],
                                        ["time.until.t=20"]),
    "set B on four pads, reduced": (PADS, [], ["time.until.U=2e-5"]),
    "set B on four pads, whole mesh": (PADS, [*FULL, "time.until.U=2e-5"], ["time.until.U=2e-6"]),
    "peers, defaults": (FIG1, PEERS, ["time.until.U=0.003"]),
    "peers, full sparse path": (FIG1, [*PEERS, *FULL], ["time.until.t=10"]),
    "peers, fixed steps": (FIG1, [*PEERS, *FIXED], ["time.until.t=10"]),
    "peers, explicit": (FIG1, [*PEERS, "time.scheme=explicit", "time.until={t: 5}"], ["time.until={t: 0.5}"]),
}
ALWAYS = ["output.fields=none", "output.figures=[]"]


def run(programs, scene, settings, folder, valgrind=()):
    from test_instructions import PINNED
    environment = dict(os.environ, AMONTONS_CACHE=str(folder.parent / "cache"), LD_LIBRARY_PATH=str(programs), **PINNED)
    words = [word for setting in [*ALWAYS, *settings] for word in ("--set", setting)]
    done = subprocess.run([*valgrind, programs / "amontons", "run", scene, *words, "-q", "--overwrite", "-o", folder],
                          env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{programs}: {done.stderr}")
    return done.stderr


def arrays(folder):
    found = {}
    with h5py.File(folder / "history.h5") as file:
        file.visititems(lambda key, item: found.update({key: item[()]}) if isinstance(item, h5py.Dataset) else None)
        found["mu_M"] = numpy.array(file.attrs.get("mu_macroscopic", numpy.nan))
    return found


def compare(before, after):
    """In words; rows of the histories."""
    if len(before["series/time"]) != len(after["series/time"]):
        return f"{len(before['series/time'])} and {len(after['series/time'])} steps"
    worst = 0
    for key in before.keys() & after.keys():
        one, other = (numpy.nan_to_num(found[key].astype(float)) for found in (before, after))
        if before[key].tobytes() != after[key].tobytes() and one.size and key != "series/energy_error":
            worst = max(worst, numpy.abs(one - other).max() / max(numpy.abs(one).max(), 1e-300))
    same = all(before[key].tobytes() == after[key].tobytes() for key in before.keys() & after.keys())
    return "the same bits" if same else f"up to {worst:.0e} apart"


def count(programs, scene, settings, folder):
    """Millions of instructions, the second time that the scene is run."""
    run(programs, scene, settings, folder)
    said = run(programs, scene, settings, folder,
               ("valgrind", "--tool=callgrind", f"--callgrind-out-file={folder.parent}/counted"))
    return int(re.search(r"Collected : (\d+)", said)[1]) / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("cases", nargs="*")
    parser.add_argument("--no-instructions", action="store_true")
    given = parser.parse_args()
    print("| scene | steps | history | mu_M | instructions, million |\n|---|---|---|---|---|")
    for name, (scene, settings, shorter) in CASES.items():
        if given.cases and name not in given.cases:
            continue
        with tempfile.TemporaryDirectory(prefix="amontons-before-") as place:
            folders = [Path(place, word, "result") for word in ("before", "after")]
            found, counted = [], ["", ""]
            for k, (programs, folder) in enumerate(zip((given.before, given.after), folders)):
                folder.parent.mkdir()
                run(programs.resolve(), scene, settings, folder)
                found.append(arrays(folder))
                if not given.no_instructions:
                    counted[k] = count(programs.resolve(), scene, [*settings, *shorter], folder)
        words = "" if given.no_instructions else f"{counted[0]:.0f}, {counted[1]:.0f}: {100 * (counted[1] / counted[0] - 1):+.1f} %"
        print(f"| {name} | {len(found[1]['series/time']) - 1} | {compare(*found)} | "
              f"{found[1]['mu_M']:.6f}, {found[1]['mu_M'] - found[0]['mu_M']:+.0e} | {words} |", flush=True)


if __name__ == "__main__":
    main()
