# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs one of the files beside this for CTest, which is told (status 77: Skipped) when some test of
it was skipped, or all of them under this preset (left_out.txt): what checked nothing must not count as passed. Its runs share a cache of their own,
empty at the start: as a user's second run, they take meshes and reductions from the first. Temporary folders lie in memory:
a run calls fsync for each of its files, which a disk takes its time for."""
import functools
import importlib
import inspect
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SKIPPED = 77
IN_MEMORY = Path("/dev/shm")
ROOM = 2 << 30   # bytes that must be free in memory
PATIENCE = int(os.environ.get("AMONTONS_PATIENCE", "1"))   # of the preset


def left_out(name):
    """Why this preset does without it; None: it does not."""
    for line in (Path(__file__).parents[1] / "left_out.txt").read_text(encoding="utf-8").splitlines():
        presets, test, reason = (line.split(None, 2) + [""] * 3)[:3]
        if test == name and os.environ.get("AMONTONS_PRESET", "release") in presets.split(","):
            return reason
    return None


def wait_longer(name):
    """subprocess's limits, also those of run(), as often as the preset says."""
    own = getattr(subprocess.Popen, name)

    @functools.wraps(own)
    def patient(*words, **named):
        bound = inspect.signature(own).bind(*words, **named)
        if bound.arguments.get("timeout"):
            bound.arguments["timeout"] *= PATIENCE
        return own(*bound.args, **bound.kwargs)
    setattr(subprocess.Popen, name, patient)


if __name__ == "__main__":
    reason = left_out(sys.argv[1].removeprefix("test_"))
    if reason:
        print(f"left out: {reason}")
        sys.exit(SKIPPED)
    for name in ("communicate", "wait"):
        wait_longer(name)
    if "TMPDIR" not in os.environ and os.access(IN_MEMORY, os.W_OK) and shutil.disk_usage(IN_MEMORY).free > ROOM:
        os.environ["TMPDIR"] = str(IN_MEMORY)
    with tempfile.TemporaryDirectory(prefix="amontons-cache-") as cache:
        os.environ["AMONTONS_CACHE"] = cache
        module = importlib.import_module(sys.argv[1])
        outcome = unittest.main(module, argv=sys.argv[:1], exit=False).result
    for test, reason in outcome.skipped:
        print(f"skipped: {test}: {reason}")
    if not outcome.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if outcome.skipped or not outcome.testsRun else 0)
