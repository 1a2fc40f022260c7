# SPDX-License-Identifier: GPL-2.0-or-later
"""A folder for the tests of a class, and in it a cache of their own, empty at first."""
import os
import shutil
import tempfile
import unittest
from pathlib import Path


class OwnCache(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix=f"amontons-{cls.__name__.lower()}-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.environment = {**os.environ, "AMONTONS_CACHE": str(cls.folder / "cache")}
