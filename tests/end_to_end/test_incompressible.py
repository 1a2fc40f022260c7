# SPDX-License-Identifier: GPL-2.0-or-later
"""A nearly incompressible layer: linear elements agree with fine ones of second order in the force that shears it and in
how far it is squeezed, also with free triangles; a material below the limit has its old stiffness; the reduced block and
explicit matrices step as the full ones; viscous volume alone makes it so, too. What `static` prints has units."""
import json
import os
import re
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy

from cache_fixture import OwnCache

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
SCENE = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/layers.geo, set: {{length: 1, height: 0.5, layer: 0.2, nx: 20, nz: 6, nz_layer: 4}}}}
material: {{young: 20, poisson: 0.3, plane: strain}}
materials: {{layer: {{young: 1, poisson: 0.4999}}}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.01, supports: [{{group: contact, direction: both}}]}}
rod: {{velocity: 2e-5, kind: bonded, height: 0.4, width: 0.1}}
time: {{until: {{U: 0.01}}}}
"""


class Incompressible(OwnCache):
    def call(self, command, *settings, flags=()):
        scene = self.folder / "scene.yaml"
        scene.write_text(SCENE)
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, scene, *flags, *words], capture_output=True, text=True, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def squeezed(self, shape, order, n, *settings):
        """Work of the pressure, and the force of a rod that stands 0.01 inside."""
        mesh = [f"mesh.set.{key}={value}" for key, value in
                (("shape", shape), ("order", order), ("nx", 5 * n), ("nz", 3 * n // 2), ("nz_layer", n))]
        work = re.search(r"work of the loads (\S+)", self.call("static", *mesh, *settings))
        force = re.search(r"rod +(\S+) on", self.call("static", *mesh, *settings, "rod.displacement=0.01", "load.pressure=1e-9"))
        return numpy.array([float(work[1]), float(force[1])])

    def test_against_second_order(self):
        exact = self.squeezed("quad", 2, 16)
        for shape, allowed in (("quad", 0.04), ("triangle", 0.06)):
            errors = [numpy.abs(self.squeezed(shape, 1, n) / exact - 1).max() for n in (4, 8)]
            self.assertLess(errors[0], allowed)        # as elements of their own: 0.6
            self.assertLess(errors[1], 0.5 * errors[0])

    def test_free_triangles(self):
        """Pressures of the contact, too: they were thrown about between 0 and three times the load."""
        block = ["mesh.file=" + str(SOURCE / "meshes/block.geo"), "materials={}", "material={poisson: 0.4999, plane: strain}",
                 "load.supports=[{group: top, direction: x}]", "rod.kind=none", "time.until={t: 1}"]
        pressures = {}
        for name, mesh in (("free", "{nx: 20, nz: 10, shape: triangle, layout: free}"), ("quads", "{nx: 20, nz: 10}")):
            self.call("static", *block, f"mesh.set={mesh}", flags=["-o", self.folder / name])
            with h5py.File(self.folder / name / "static.h5") as file:
                node = file["contact/node"][:]
                pressures[name] = file["nodes/reaction"][:].reshape(-1, 2)[node, 1] / file["contact/weight"][:]
        self.assertLess(numpy.abs(pressures["free"] / pressures["quads"] - 1)[1:-1].max(), 0.05)

    def test_runs(self):
        """A rubber sole of triangles: full and reduced block, and steps of a block whose eta2 alone resists area. Friction acts
        from t = 0 on: what it holds of a block that settles hangs on the steps in which it does."""
        free = ["start.friction=off", "load={pressure: 0.003}", "rod.kind=push", "rod.height=0.25", "mesh.set.shape=triangle", "material.young=1"]
        for name, layer in (("rubber", "{young: 0.2, poisson: 0.499, eta1: 0.5, eta2: 5}"), ("viscous", "{young: 0.2, poisson: 0.3, eta1: 0.1, eta2: 20}")):
            mu = []
            for use in ("never", "always"):
                folder = self.folder / f"{name}-{use}"
                self.call("run", *free, f"materials.layer={layer}", f"reduction.use={use}", flags=["-o", folder, "--quiet"])
                with h5py.File(folder / "history.h5") as file:
                    mu.append(numpy.interp(numpy.linspace(0.001, 0.01, 50), file["series/rod_displacement"][:], file["series/mu"][:]))
                self.assertLess(json.loads((folder / "run.json").read_text())["errors"]["equation"], 1e-9)
            self.assertLess(numpy.abs(mu[0] - mu[1]).mean(), 0.01 * mu[0].max())

    def test_units(self):
        out = self.call("static", "rod.displacement=0.001")
        self.assertRegex(out, r"load ratio +F_T/F_N -?\d")
        self.assertRegex(out, r"rod +-?\d\S* on \d+ nodes, resultant at z = \d")
        self.assertIn("those of the scene (normalised), per width", out)
        out = self.call("static", "units=si", "material={young: 20, poisson: 0.3, plane: strain, density: 1, eta1: 1, eta2: 1}",
                        "rod.displacement=0.001")
        force, floor = float(re.search(r"rod +(\S+) N/m on", out)[1]), float(re.search(r"F_z (\S+) N/m", out)[1])
        self.assertAlmostEqual(float(re.search(r"F_T/F_N (\S+),", out)[1]), force / floor, places=4)
        self.assertRegex(out, r"elastic \S+ J/m, .*loads \S+ J/m")
        self.assertRegex(self.call("static", "rod.kind=push", "rod.displacement=-0.01"), r"rod +0 on \d+ nodes\n")      # it has left


if __name__ == "__main__":
    unittest.main()
