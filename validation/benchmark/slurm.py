#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A study through a Slurm of one node, this computer, started for it (Debian's slurm-wlm and munge) and ended after it.

    validation/benchmark/slurm.py validation/paper/plane.yaml -o results/plane-slurm [-j N]
    validation/benchmark/slurm.py --parts STUDY -o DIR -j N

Says how long it took, into how many elements it was cut, and how long each was at work. `--parts`: of a study with `keep: table`
that waits in the queue the first element is computed here, and its processor time told beside that of the sweep's own process:
before (planning, twenty points tried, shares and arrays written) and after (what the element left is gathered, the table written).
"""
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests" / "end_to_end"))
from slurm_fixture import Slurm   # noqa: E402

PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
QUEUE = ["squeue", "-h", "-r", "-t", "all", "-o", "%F_%K %T %M"]


def spent():
    """Processor time of the children that have ended, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def parts(slurm, words):
    folder = words[words.index("-o") + 1]
    call = [PROGRAM, "sweep", *words, "--quiet"]
    sweep = subprocess.Popen([*call, "--slurm=--hold"], env=slurm.environment)
    while not slurm.call("squeue", "-h").stdout.strip():
        time.sleep(0.5)
    points = len(open(f"{folder}/slurm/share-0.points").readlines())
    before = spent()
    subprocess.run(["sh", f"{folder}/slurm/array.sh"], env=os.environ | {"SLURM_ARRAY_TASK_ID": "0"}, check=True)
    print(f"an element of {points} points: {spent() - before:.2f} s, {1e3 * (spent() - before) / points:.2f} ms a point")
    before = spent()
    sweep.send_signal(signal.SIGINT)
    sweep.wait()
    print(f"the sweep's own process, to the queue and to the table: {spent() - before:.2f} s")
    before = spent()
    again = subprocess.Popen([*call, "--slurm=--hold"], env=slurm.environment)
    while not slurm.call("squeue", "-h").stdout.strip():
        time.sleep(0.5)
    again.send_signal(signal.SIGINT)
    again.wait()
    print(f"once more, with the element's points found: {spent() - before:.2f} s")
    return 0


def main():
    reason = Slurm.missing()
    if reason:
        sys.exit(reason)
    slurm = Slurm()
    try:
        reason = slurm.start()
        if reason:
            sys.exit(reason)
        if sys.argv[1:2] == ["--parts"]:
            return parts(slurm, sys.argv[2:])
        begin, seen = time.time(), {}
        sweep = subprocess.Popen([PROGRAM, "sweep", *sys.argv[1:], "--slurm", "--quiet"], env=slurm.environment)
        while sweep.poll() is None:
            time.sleep(1)
            for line in slurm.call(*QUEUE).stdout.split("\n"):
                if line:
                    seen[line.split()[0]] = line.split()[1:]
        print(f"status {sweep.returncode}, {time.time() - begin:.0f} s, {len(seen)} elements")
        for job, (state, spent) in sorted(seen.items())[:20]:
            print(f"  {job} {state} {spent}")
    finally:
        slurm.stop()
    return sweep.returncode


if __name__ == "__main__":
    sys.exit(main())
