# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs one of the files beside this for CTest, which is told (status 77: Skipped) when some test of
it was skipped: what checked nothing must not count as passed. Its runs share a cache of their own,
empty at the start: as a user's second run, they take meshes and reductions from the first."""
import importlib
import os
import sys
import tempfile
import unittest

SKIPPED = 77

if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="amontons-cache-") as cache:
        os.environ["AMONTONS_CACHE"] = cache
        module = importlib.import_module(sys.argv[1])
        outcome = unittest.main(module, argv=sys.argv[:1], exit=False).result
    for test, reason in outcome.skipped:
        print(f"skipped: {test}: {reason}")
    if not outcome.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if outcome.skipped or not outcome.testsRun else 0)
