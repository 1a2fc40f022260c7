# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene is three-dimensional because its mesh is. A block that cannot move in y stands as the plane-strain block of the same
section, force by force; one that is thin and free as the plane-stress block, to what the theory of plates leaves; implicit
steps find the peaks of explicit ones; each kind of element runs and balances; a rod over part of the breadth turns nothing
that is symmetric; what does not go in space yet is refused in a sentence."""
import json
import os
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy

from cache_fixture import OwnCache

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
SCENE = f"""mesh: {{file: {SOURCE}/meshes/block3d.geo, set: {{length: 0.5, breadth: 0.5, nx: 4, ny: 4, nz: 4}}}}
material: {{poisson: 0.34}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 2e-5}}
time: {{until: {{U: 0.004}}}}
"""
LIMIT = """material: {{poisson: 0.34, plane: {plane}}}
friction: {{law: coulomb, mu_static: 0.38}}
load: {{pressure: 0.003, supports: [{supports}]}}
rod: {{height: 0.21, width: 0.12, displacement: 1e-3}}
mesh: {{file: {meshes}/{file}, set: {{length: 1, height: 0.5, nx: 10, nz: 8{more}}}}}
"""


class Space(OwnCache):
    def call(self, command, *settings, scene=SCENE, fails=False):
        path, result = self.folder / "scene.yaml", self.folder / "result"
        path.write_text(scene)
        done = subprocess.run([PROGRAM, command, path, "-q", "-o", result, "--overwrite", "--set", *(settings or ["title=cube"])],
                              capture_output=True, text=True, env=self.environment)
        if fails:
            self.assertNotEqual(done.returncode, 0)
            return done.stderr
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((result / ("static.json" if command == "static" else "run.json")).read_text())

    def limit(self, file, *settings, plane="strain", supports="", more=""):
        results = self.call("static", *settings, scene=LIMIT.format(plane=plane, supports=supports, file=file, more=more,
                                                         meshes=SOURCE / "meshes"))["results"]
        with h5py.File(self.folder / "result/static.h5") as file:
            return results, file["nodes/position"][:], file["nodes/displacement"][:]

    def test_held_across_is_plane_strain(self):
        flat, places, wanted = self.limit("block.geo")
        held = "{group: left, direction: y}, {group: right, direction: y}"
        deep, positions, found = self.limit("block3d.geo", supports=held, more=", breadth: 0.3, ny: 1")
        for key in ("normal_force", "rod_force", "shear_force", "elastic_energy", "pressure_moment"):
            self.assertAlmostEqual(deep[key] / 0.3 / flat[key], 1, delta=1e-9, msg=key)
        for key in ("sticking", "slipping", "open"):
            self.assertEqual(deep[key], 2 * flat[key])
        where = {tuple(numpy.round(p, 9)): u for p, u in zip(places, wanted)}
        there = numpy.array([where[tuple(numpy.round(p[[0, 2]], 9))] for p in positions])
        self.assertLess(numpy.abs(found[:, [0, 2]] - there).max(), 1e-9 * numpy.abs(wanted).max())
        self.assertLess(numpy.abs(found[:, 1]).max(), 1e-12 * numpy.abs(wanted).max())

    def test_thin_is_plane_stress(self):
        free = {"supports": "{group: leading, direction: x}"}   # friction would hold y below
        errors = []
        for n in (1, 2, 4):   # a cell has one thickness at each node only: the more cells, the closer
            sizes = ["friction.mu_static=0", f"mesh.set.nx={10 * n}", f"mesh.set.nz={8 * n}"]
            flat, _, _ = self.limit("block.geo", *sizes, plane="stress", **free)
            thin, _, _ = self.limit("block3d.geo", *sizes, more=", breadth: 0.01, ny: 1", **free)
            errors.append(abs(thin["rod_force"] / 0.01 / flat["rod_force"] - 1))
        self.assertLess(errors[1], 0.6 * errors[0])
        self.assertLess(errors[2], 0.6 * errors[1])
        self.assertLess(errors[2], 2e-3)
        strain, _, _ = self.limit("block.geo", *sizes, **free)
        self.assertGreater(abs(strain["rod_force"] / flat["rod_force"] - 1), 2e-2)

    def peaks(self, *settings):
        run = self.call("run", *settings)
        self.assertEqual(run["status"], "done")
        errors = run["errors"]
        self.assertLess(errors["energy"], 3e-4)
        self.assertLess(errors["moment"], 1e-11)
        self.assertLess(errors["complementarity"], 1e-9)
        self.assertEqual(run["model"]["reduced_dofs"], run["model"]["full_dofs"])
        return numpy.array([peak["mu"] for peak in run["results"]["peaks"]])

    def test_against_explicit_steps(self):
        implicit, explicit = self.peaks(), self.peaks("time.scheme=explicit")
        self.assertEqual(len(implicit), len(explicit))
        self.assertGreaterEqual(len(implicit), 2)
        self.assertLess(numpy.abs(implicit / explicit - 1).max(), 3e-3)

    def test_elements(self):
        """The first peak is of slip that spreads from the rod's side: meshes as coarse as these agree in it to a few per cent."""
        hexahedra = self.peaks("time.until.U=0.0024")
        for shape, order, n in (("wedge", 1, 4), ("tet", 1, 4), ("tet", 2, 3), ("hex", 2, 2)):
            sizes = [f"mesh.set.{axis}={n}" for axis in ("nx", "ny", "nz")]
            other = self.peaks("time.until.U=0.0024", f"mesh.set.shape={shape}", f"mesh.set.order={order}", *sizes)
            self.assertAlmostEqual(other[0] / hexahedra[0], 1, delta=0.04, msg=f"{shape} of order {order}")

    def test_rods(self):
        """All of the face, a strip over all of its breadth and over a part of it: the force by its stiffness, no turning."""
        forces = {}
        for name, rod in (("all", ["rod.whole=true"]), ("strip", []), ("part", ["rod.breadth=0.2"])):
            said = self.call("static", *rod, "rod.displacement=1e-4")
            forces[name] = said["results"]["rod_force"]
            with h5py.File(self.folder / "result/static.h5") as file:
                place, moved = file["nodes/position"][:], file["nodes/displacement"][:]
            middle = numpy.abs(place[:, 1] - 0.25) < 1e-9
            self.assertLess(numpy.abs(moved[middle, 1]).max(), 1e-9 * numpy.abs(moved).max(), name)
        self.assertGreater(forces["all"], forces["strip"])
        self.assertGreater(forces["strip"], forces["part"])

    def test_formulas(self):
        """A factor 1 changes nothing; more friction at one side turns the block."""
        plain = self.call("static", "rod.displacement=2e-3")["results"]
        same = self.call("static", "rod.displacement=2e-3", "friction.along=1 + 0*x*y")["results"]
        self.assertEqual(plain["rod_force"], same["rod_force"])
        self.call("static", "rod.displacement=2e-3", "friction.along=2*y/0.5")
        with h5py.File(self.folder / "result/static.h5") as file:
            place, moved = file["nodes/position"][:], file["nodes/displacement"][:]
        ahead = place[:, 0] == 0.5
        left, right = (moved[ahead & (numpy.abs(place[:, 1] - y) < 1e-9), 0].mean() for y in (0, 0.5))
        self.assertGreater(left, right + 1e-6)

    def test_refused(self):
        for words, says in ((["accuracy.mu=1%"], "how the error of a block in space falls with its cells was not measured yet"),
                            (["reduction.use=always"], "blocks in space are stepped on the whole mesh"),
                            (["material.poisson=0.5"], "Poisson's ratios below 0.5"),
                            (["friction.along=z"], "is no number here: x and y alone"),
                            (["mesh.set.shape=tet", "material.poisson=0.49"], "TET4 lock"),
                            (["mesh={file: %s/meshes/block.geo}" % SOURCE, "rod.breadth=0.1"], "the mesh is in the plane: there is no y"),
                            (["mesh={file: %s/meshes/block.geo}" % SOURCE, "load.tractions=[{group: top, y: 1}]"], "there is no y")):
            self.assertIn(says, self.call("run", *words, fails=True))
        for command, says in (("stability", "the mesh is in space"), ("model1d", "is a mesh in space")):
            self.assertIn(says, self.call(command, fails=True))


if __name__ == "__main__":
    unittest.main()
