# SPDX-License-Identifier: GPL-2.0-or-later
"""A small scene in a folder of its own, run with settings, for tests of what drives the rod."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
EXAMPLES = SOURCE / "validation/drive"
sys.path.insert(0, str(EXAMPLES))
import rigid_block  # noqa: E402, F401

SCENE = """mesh: {{file: {source}/meshes/block.geo, set: {{nx: 8, nz: 4}}}}
material: {{poisson: 0.34}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-4}}
time: {{until: {{U: {until}}}}}
"""


class Driven(unittest.TestCase):
    UNTIL = None   # U at the end of the scene

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-drive-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        (cls.folder / "scene.yaml").write_text(SCENE.format(source=SOURCE, until=cls.UNTIL))

    def call(self, command, *settings, scene="scene.yaml", status=0, flags=()):
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, scene, *words, *flags], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr

    def run_scene(self, name, *settings, scene="scene.yaml", flags=()):
        folder = self.folder / name
        self.call("run", *settings, scene=scene, flags=("-q", "-o", folder, *flags))
        with h5py.File(folder / "history.h5") as file:
            return {key: item[()] for group in ("series", "events") for key, item in file[group].items()}
