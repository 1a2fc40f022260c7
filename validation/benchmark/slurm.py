#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A study through a Slurm of one node, this computer, started for it (Debian's slurm-wlm and munge) and ended after it.

    validation/benchmark/slurm.py validation/paper/plane.yaml -o results/plane-slurm [-j N]

Says how long it took, into how many elements it was cut, and how long each was at work.
"""
import os
import subprocess
import sys
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests" / "end_to_end"))
from slurm_fixture import Slurm   # noqa: E402

PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
QUEUE = ["squeue", "-h", "-r", "-t", "all", "-o", "%F_%K %T %M"]


def main():
    reason = Slurm.missing()
    if reason:
        sys.exit(reason)
    slurm = Slurm()
    try:
        reason = slurm.start()
        if reason:
            sys.exit(reason)
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
