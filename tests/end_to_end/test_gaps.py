# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts that are not flat: a parabola as contact.radius, as a formula and as the mesh's own shape gives Hertz's
contact; a run comes to rest at the static state and, pushed slowly, slips at the rim first, explicit steps alike; a shape out of the cache is the one put in; what cannot be is refused with its place."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
NU, FORCE = 0.499, 2e-4     # P' of a pressure of 1e-4 on a length of 2
SCENE = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 2, height: 1, nx: 12, nz: 4}}}}
material: {{poisson: {NU}, plane: strain}}
friction: {{law: coulomb, mu_static: 0.5}}
load: {{pressure: 0.03}}
rod: {{velocity: 2e-4, kind: bonded, ends: nodes, height: 0.5, width: 0.9}}
start: {{friction: off}}
time: {{until: {{U: 8e-3}}}}
"""
STILL = ["friction.mu_static=0", "rod.kind=none", "load.supports=[{group: top, direction: x}]", "time.until={t: 1}"]
FINE = ["load.pressure=1e-4", "mesh.set={length: 2, height: 1, nx: 40, nz: 20, order: 2, grade_x: 0.02, grade_z: 40}"]
RADIUS = 10
HALF_WIDTH = (4 * FORCE * RADIUS * (1 - NU ** 2) / numpy.pi) ** 0.5
PARABOLA = "contact={radius: 10}"


def width_of(x, force):
    """Half-width of Hertz's pressure with this second moment."""
    middle = (x * force).sum() / force.sum()
    return 2 * (((x - middle) ** 2 * force).sum() / force.sum()) ** 0.5


class Gaps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-gaps-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.scene = cls.folder / "scene.yaml"
        cls.scene.write_text(SCENE)
        cls.environment = dict(os.environ, AMONTONS_CACHE=str(cls.folder / "cache"))

    def call(self, command, *settings, status=0, flags=()):
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, self.scene, *words, *flags], capture_output=True, text=True,
                              cwd=self.folder, env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def static(self, name, *settings):
        """x of the contact nodes, and their normal reactions."""
        self.call("static", *STILL, *settings, flags=("-o", self.folder / name))
        with h5py.File(self.folder / name / "static.h5") as file:
            nodes = file["contact/node"][:]
            return file["nodes/position"][:][nodes, 0], file["nodes/reaction"][:][nodes, 1]

    def run_scene(self, name, *settings):
        """(run.json, x, normal and tangential forces of every step)"""
        self.call("run", *settings, flags=("-q", "-o", self.folder / name))
        with h5py.File(self.folder / name / "history.h5") as file:
            weight = file["nodes/weight"][:]
            arrays = [file["nodes/x"][:], file["interface/pressure"][:] * weight, file["interface/shear"][:] * weight]
        return json.loads((self.folder / name / "run.json").read_text()), *arrays

    def test_hertz(self):
        """On a floor of the shape of a parabola, and with the parabola drawn in the mesh."""
        for name, setting in (("floor", PARABOLA), ("crown", "mesh.set.crown=0.05")):
            x, force = self.static(name, *FINE, setting)
            self.assertLess(abs(width_of(x, force) / HALF_WIDTH - 1), 3e-3, name)
            self.assertLess(numpy.abs(force[numpy.abs(x - 1) > 1.1 * HALF_WIDTH]).max(), 1e-6 * force.max())
        x, floor = self.static("coarse", PARABOLA)
        _, formula = self.static("formula", "contact={gap: (x - 1)^2 / 20}")
        numpy.testing.assert_allclose(formula, floor, rtol=0, atol=1e-9 * floor.max())
        self.assertGreater((floor < 1e-6 * floor.max()).sum(), 3)

    def test_slow_limit(self):
        """The run sets out from the static state; explicit steps come to the same forces."""
        x, wanted = self.static("rest", PARABOLA)
        _, places, pressing, _ = self.run_scene("rest_run", PARABOLA, *STILL)
        numpy.testing.assert_array_equal(x, places)
        numpy.testing.assert_allclose(pressing[-1], wanted, rtol=0, atol=2e-5 * wanted.max())
        _, _, pressing, shear = self.run_scene("run", PARABOLA)
        slipping = shear[-1] > 0.999 * 0.5 * pressing[-1]
        touching = numpy.flatnonzero(pressing[-1] > 0)
        self.assertTrue(slipping[touching[0]])     # of so wide a contact the rim at the rod first
        self.assertFalse(slipping[touching].all())
        brief = "time.until.t=0.05"
        implicit = self.run_scene("implicit", PARABOLA, brief, "time.step_max=0.005")[2]
        explicit = self.run_scene("explicit", PARABOLA, brief, "time.scheme=explicit")[2]
        numpy.testing.assert_allclose(explicit[-1], implicit[-1], rtol=0, atol=1e-4 * implicit.max())

    def test_shape_from_the_cache(self):
        report, x, first, _ = self.run_scene("first", "mesh.set.crown=0.05", "reduction.use=always")
        report, _, again, _ = self.run_scene("again", "mesh.set.crown=0.05", "reduction.use=always")
        self.assertTrue(report["model"]["from_cache"])
        numpy.testing.assert_array_equal(first, again)
        self.assertEqual(first[0][[0, -1]].tolist(), [0, 0])   # the ends of the crown hang free

    def test_refused(self):
        for command, setting, words in (
                ("run", "contact.gap=x - 1", ["contact.gap", "at x = 0 the gap is -1", ">= 0"]),
                ("run", "contact.gap=y", ["contact.gap", "y"]),
                ("run", "contact.gap=log(x)", ["contact.gap", "at x = 0"]),
                ("model1d", "contact.radius=3", ["contact.radius", "flat"])):
            said = self.call(command, setting, "friction={mu_static: 0.3, mu_kinetic: 0.1, critical_velocity: 1e-3}",
                             status=2, flags=("-o", self.folder / "no", "--overwrite"))
            for word in words:
                self.assertIn(word, said)


if __name__ == "__main__":
    unittest.main()
