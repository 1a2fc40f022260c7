# SPDX-License-Identifier: GPL-2.0-or-later
"""Materials by region: a column of two layers against Laplace's transform, implicit and explicit; what is written
in many words but is one material gives the bits of one; a reduced block steps as the full one and its basis serves
other pressures, velocities and laws; what is wrong is told with its place."""
import json
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

import h5py
import numpy

from cache_fixture import OwnCache
from vtu_fixture import read_vtu

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "validation/exact"))
import layers                                                       # noqa: E402

SCENE = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/layers.geo, set: {{nx: 8, nz: 3, nz_layer: 2}}}}
material: {{poisson: 0.34}}
materials:
  layer: {{young: 0.2, poisson: 0.4, density: 0.8, eta1: 0.1, eta2: 0.3}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 2e-5}}
time: {{until: {{U: 0.006}}}}
"""


def mu_at(arrays, U):
    return numpy.interp(U, arrays["series/rod_displacement"], arrays["series/mu"])


class Regions(OwnCache):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = cls.folder / "scene.yaml"
        cls.scene.write_text(SCENE)

    def call(self, command, *settings, status=0, flags=(), scene=None):
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, scene or self.scene, *words, *flags], capture_output=True, text=True,
                              cwd=self.folder, env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def run_scene(self, name, *settings, scene=None):
        """(run.json, its arrays)"""
        folder, arrays = self.folder / name, {}
        self.call("run", *settings, flags=("-q", "-o", folder), scene=scene)
        with h5py.File(folder / "history.h5") as file:
            file.visititems(lambda key, item: arrays.update({key: item[()]}) if hasattr(item, "shape") else None)
        return json.loads((folder / "run.json").read_text()), arrays

    def test_column(self):
        """The error of 10 cells and of 20, second order, against a reference without time steps; explicit alike."""
        scene = SOURCE / "validation/exact/layers_column.yaml"
        for name, refine, most, more in (("coarse", 0.25, 1e-3, ["time.step_max=8e-3", "time.step_min=8e-3"]),
                                         ("fine", 0.5, 2.5e-4, ["time.step_max=4e-3", "time.step_min=4e-3"]),
                                         ("explicit", 0.5, 6e-4, ["time.scheme=explicit"])):
            self.call("run", f"mesh.set.refine={refine}", *more, flags=("-q", "-o", self.folder / name), scene=scene)
            entries = re.findall(r'timestep="([^"]+)"[^>]*file="(fields/bulk[^"]+)"',
                                 (self.folder / name / "fields.pvd").read_text())
            frames = []
            for time, file in entries:
                points, arrays = read_vtu(self.folder / name / file)
                frames.append((float(time), points, arrays["displacement"], None))
            self.assertGreater(len(frames), 5)
            self.assertLess(layers.column_error(frames), most, name)

    def test_one_material_in_many_words(self):
        """No region, regions that say what `material` says, and all said by regions of a default: the same bits."""
        whole = "{young: 0.5, poisson: 0.3, density: 1, eta1: 0.5, eta2: 0.5}"
        base = ["time.until.U=0.001", f"material={whole}"]
        plain = self.run_scene("plain", *base, "materials={}")[1]
        for name, setting in (("empty", "materials={layer: {}, body: {}}"), ("same", f"materials={{layer: {whole}}}")):
            for key, array in self.run_scene(name, *base, setting)[1].items():
                numpy.testing.assert_array_equal(array, plain[key], f"{name}: {key}")
        # Only what scales are measured with may tell the two apart: the mean of two alike.
        everywhere = self.run_scene("everywhere", "time.until.U=0.001", f"materials={{layer: {whole}, body: {whole}}}",
                                    "reduction.use=never")[1]
        numpy.testing.assert_allclose(mu_at(everywhere, 0.0009), mu_at(plain, 0.0009), rtol=2e-3)

    def test_reduced_and_cached(self):
        """Stick-slip on the reduced block is that on the mesh; units, P, V and law find the same basis."""
        report, reduced = self.run_scene("reduced", "reduction.use=always")
        full = self.run_scene("full", "reduction.use=never")[1]
        self.assertGreater(len(report["results"]["events"]), 0)
        places = numpy.linspace(0.0005, 0.0035, 11)
        numpy.testing.assert_allclose(mu_at(reduced, places), mu_at(full, places), rtol=3e-3, atol=1e-3)
        self.assertLess(abs(reduced["series/mu"].max() / full["series/mu"].max() - 1), 5e-3)
        for name, more in (("other", ["load.pressure=0.004", "rod.velocity=4e-5", "friction.mu_static=0.3"]),
                           ("units", ["material={poisson: 0.34, young: 3, density: 2, eta1: 5, eta2: 5}",
                                      "materials.layer={young: 0.6, poisson: 0.4, density: 1.6, eta1: 0.5, "
                                      "eta2: 1.5}"])):
            report, _ = self.run_scene(name, "time.until.U=0.0005", "reduction.use=always", *more)
            self.assertTrue(report["model"]["from_cache"], name)
        report, _ = self.run_scene("softer", "time.until.U=0.0005", "reduction.use=always", "materials.layer.young=0.1")
        self.assertFalse(report["model"]["from_cache"])
        self.assertEqual(report["scene"]["materials"]["layer"]["young"], 0.1)
        speeds = report["model"]["wave_speeds"]   # of the layer, which touches the floor
        self.assertAlmostEqual(speeds["shear"], (0.1 / (2 * 1.4) / 0.8) ** 0.5, 12)

    def test_stress_jumps(self):
        """In a pressed column without shear sigma_zz is -P on both sides; sigma_xx of held layers is nu sigma_zz of
        each, at the same place."""
        scene = self.folder / "column.yaml"
        scene.write_text(SCENE.replace("pressure: 0.003", "pressure: 0.003, supports: [{group: rod, direction: x}, "
                                       "{group: leading, direction: x}]").replace("velocity: 2e-5", "kind: none")
                         .replace("mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4",
                                  "law: coulomb, mu_static: 0").replace("U: 0.006", "t: 1"))
        self.call("static", flags=("-o", self.folder / "pressed"), scene=scene)
        points, arrays = read_vtu(self.folder / "pressed/static.vtu")
        at = numpy.abs(points[:, 1] - 0.1) < 1e-9
        self.assertEqual(at.sum(), 18)
        numpy.testing.assert_allclose(arrays["stress"][at, 1], -0.003, rtol=1e-10)
        found = sorted(set(numpy.round(arrays["stress"][at, 0] / -0.003, 9)))
        self.assertEqual(found, [0.34, 0.4])

    def test_refused(self):
        for command, setting, words in (
                ("run", "materials={sole: {young: 1}}", ["materials", "has no group 'sole'", "'layer' (surface)"]),
                ("run", "materials={top: {young: 1}}", ["'top' is a curve, wanted is a surface"]),
                ("run", "materials.layer.youngs=1", ["unknown key", "young, poisson, density"]),
                ("run", "material.plane=strain --set materials.layer.poisson=0.5", ["layer.poisson: 0.5"]),
                ("model1d", "rod.height=0.3", ["materials", "one material"])):
            said = self.call(command, *setting.split(" --set "), status=2,
                             flags=("-o", self.folder / "no", "--overwrite"))
            for word in words:
                self.assertIn(word, said)
            self.assertFalse((self.folder / "no/run.json").exists())   # nothing is in the way of the scene put right
        self.call("run", "time.until.U=1e-4", flags=("-q", "-o", self.folder / "no"))

    def test_rod_at_a_joint(self):
        """A strip that lies on both materials: the force goes over the joint without a jump, and is within 3 % of that of cells
        a quarter as long and whole nodes, where whole nodes on these cells are 5 % off. A run from the cache has its ends too."""
        def force(height, refine=1, ends="exact"):
            said = self.call("static", "mesh.set={nx: 20, nz: 10, nz_layer: 5, layer: 0.2}", "rod.width=0.07", "rod.displacement=1e-3",
                             f"rod.height={height}", f"mesh.set.refine={refine}", f"rod.ends={ends}")
            return float(re.search(r"rod +(\S+) on", said)[1])
        coarse, fine = force(0.2), force(0.2, 8, "nodes")
        self.assertLess(abs(coarse / fine - 1), 0.03)
        self.assertGreater(abs(force(0.2, ends="nodes") / fine - 1), 0.04)
        for height in (0.165, 0.235):     # an end passes the joint
            self.assertLess(abs(force(height - 1e-7) / force(height + 1e-7) - 1), 1e-4)
        self.assertLess(abs(force(0.18 - 1e-7) / force(0.18) - 1), 1e-4)     # a spring as stiff as none
        settings = ["rod.height=0.1", "rod.width=0.033", "time.until.U=1e-3", "reduction.use=always"]
        mu = []
        for name in ("joint made", "joint kept", "joint full"):
            use = "never" if name == "joint full" else "always"
            self.call("run", *settings, f"reduction.use={use}", flags=("-q", "-o", self.folder / name))
            with h5py.File(self.folder / name / "history.h5") as file:
                mu.append(numpy.interp(numpy.linspace(0, 1e-3, 20), file["series/rod_displacement"][:], file["series/mu"][:]))
        self.assertTrue(json.loads((self.folder / "joint kept/run.json").read_text())["model"]["from_cache"])
        numpy.testing.assert_array_equal(mu[0], mu[1])
        numpy.testing.assert_allclose(mu[1], mu[2], atol=0.01 * mu[2].max())

    def test_large_strains(self):
        """A soft layer is warned of by its name, with the shear that the displacements have; stiff ones are not; neither from the
        cache."""
        soft = ["materials.layer.young=0.05", "mesh.set={nx: 8, nz: 3, nz_layer: 4}", "time.until.U=0.03"]
        for name in ("strained", "strained again"):
            self.call("run", *soft, flags=("-q", "-o", self.folder / name))
            report = json.loads((self.folder / name / "run.json").read_text())
            (said,) = [words for words in report["warnings"] if words.startswith("strains are not small: ")]
            mu, shear = re.search(r"load ratio, (\S+), .* shear `layer` by (\S+) %", said).groups()
            self.assertAlmostEqual(float(mu), report["results"]["mu_max"], places=2)
        self.call("static", *soft[:2], "load.supports=[{group: contact, direction: both}]", "rod.kind=bonded", "rod.displacement=0.01",
                  flags=("-o", self.folder / "sheared"))
        with h5py.File(self.folder / "sheared/static.h5") as file:
            place, moved = (file[f"nodes/{key}"][:].reshape(-1, 2) for key in ("position", "displacement"))
            force = json.loads((self.folder / "sheared/static.json").read_text())["results"]["rod_force"]
        at = numpy.abs(place[:, 1] - 0.1) < 1e-9
        field = 100 * moved[at, 0].mean() / 0.1 / force * float(mu) * 0.003
        self.assertLess(abs(float(shear) / field - 1), 0.15)
        self.call("run", "time.until.U=1e-3", flags=("-q", "-o", self.folder / "small"))
        self.assertFalse([words for words in json.loads((self.folder / "small/run.json").read_text())["warnings"]
                          if "strains" in words])


if __name__ == "__main__":
    unittest.main()
