# SPDX-License-Identifier: GPL-2.0-or-later
"""A block on a base: validation, the same answer reduced and not, from the cache, by steps of the mesh, in space with and
without matching nodes; the energy ledger and the block's moments close; a driven base; fields of both bodies; sentences for
what cannot be."""
import json
import os
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy

from cache_fixture import OwnCache
from validation_fixture import Report
from vtu_fixture import read_vtu

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
SCENE = f"""title: block on a base
mesh: {{file: {SOURCE}/meshes/base.geo, set: {{nx: 12, nz: 6}}}}
material: {{poisson: 0.34, eta2: 1}}
friction: {{law: linear-weakening, mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003, supports: [{{group: bottom, direction: both}}]}}
rod: {{velocity: 2e-4}}
time: {{until: {{U: 0.012}}}}
"""
SPACE = [f"mesh.file={SOURCE}/meshes/base3d.geo", "mesh.set={nx: 6, ny: 6, nz: 3}",
         "load.supports=[{group: bottom, direction: all}]", "time.until={U: 0.006}"]
RIGID = [f"mesh.file={SOURCE}/meshes/block.geo", "load.supports=[]"]


class Validated(Report):
    def test_bodies(self):
        text = self.run_groups("bodies")
        self.assertGreaterEqual(text.count("| pass |"), 10)
        self.assertGreaterEqual(text.count("| caught |"), 4)


class Bodies(OwnCache):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "scene.yaml").write_text(SCENE)

    def call(self, command, *settings, status=0, flags=()):
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, "scene.yaml", *words, *flags], capture_output=True, text=True,
                              cwd=self.folder, env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def compute(self, name, *settings):
        self.call("run", *settings, flags=("-q", "--overwrite", "-o", name))
        return json.loads((self.folder / name / "run.json").read_text())

    def test_answers_agree(self):
        """Reduced to a tolerance of 2e-2 and not: 0.5 %, as elsewhere. From the cache: the same bits."""
        reduced, whole = self.compute("reduced"), self.compute("whole", "reduction.use=never")
        self.assertLess(reduced["model"]["reduced_dofs"], whole["model"]["reduced_dofs"] / 3)
        for name in ("mu_M", "mu_hold"):
            self.assertAlmostEqual(reduced["results"][name] / whole["results"][name], 1, delta=5e-3)
        for report in (reduced, whole):
            self.assertLess(report["errors"]["moment"], 1e-11)
            self.assertLess(report["errors"]["energy"], 1e-3)
        again = self.compute("again")
        self.assertTrue(again["model"]["from_cache"])
        self.assertEqual(again["results"], reduced["results"])
        # A base as deep as the block changes mu_M by more than an answer is known to.
        rigid = self.compute("rigid", *RIGID)
        self.assertNotIn("base", rigid)
        self.assertGreater(abs(reduced["results"]["mu_M"] / rigid["results"]["mu_M"] - 1), 0.02)
        self.assertAlmostEqual(reduced["base"]["slip_over_contact"], 0.012, delta=0.003)
        self.assertEqual(reduced["base"]["dundurs_beta"], 0)

    def test_cache_tells_bases_apart(self):
        """The base's stiffness, and where its nodes lie, are part of the shape."""
        one = self.compute("one")
        other = self.compute("other", "materials={base: {young: 4}}")
        shifted = self.compute("shifted", "mesh.set.ratio=1.25")
        self.assertFalse(other["model"]["from_cache"] or shifted["model"]["from_cache"])
        self.assertFalse(shifted["base"]["matches"])
        self.assertGreater(abs(other["results"]["mu_M"] / one["results"]["mu_M"] - 1), 0.01)
        self.assertAlmostEqual(shifted["results"]["mu_M"] / one["results"]["mu_M"], 1, delta=0.03)

    def test_in_space(self):
        """Mirror halves, and steps of the whole mesh without matching nodes."""
        halves, whole = self.compute("halves", *SPACE), self.compute("space", *SPACE, "reduction.use=never")
        self.assertTrue(halves["model"]["by_halves"])
        for name in ("mu_M", "mu_hold"):
            self.assertAlmostEqual(halves["results"][name] / whole["results"][name], 1, delta=5e-3)
        self.assertLess(halves["errors"]["moment"], 1e-11)
        other = self.compute("other_cells", *SPACE, "mesh.set.ratio=0.67")
        self.assertFalse(other["base"]["matches"])
        self.assertAlmostEqual(other["results"]["mu_M"] / halves["results"]["mu_M"], 1, delta=0.03)

    def test_driven_base(self):
        """A base that is pulled along under a block that a wall holds: the rod's force is that of friction, and slip goes
        backwards."""
        report = self.compute("driven", "groups.rod=base_rear", "rod={velocity: 2e-4, kind: bonded, whole: true}",
                              "load.supports=[{group: bottom, direction: z}, {group: leading, direction: x}]")
        self.assertGreater(report["results"]["mu_M"], 0.1)
        self.assertLess(report["results"]["mu_M"], 0.38)
        with h5py.File(self.folder / "driven/history.h5") as file:
            slip = file["interface/slip"][-1]
        self.assertLess(slip.max(), 0)

    def test_fields_of_both_bodies(self):
        """What ParaView reads moves with the floor: the contact's nodes stay on it, pressed as they are."""
        self.compute("fields", "output.fields={every_U: 0.004}", "time.until={U: 0.004}")
        names = sorted((self.folder / "fields/fields").glob("bulk*.vtu"))
        points, arrays = read_vtu(names[-1])
        moved = arrays["displacement"]
        self.assertAlmostEqual(points[:, 1].min(), -0.5)
        level = numpy.abs(points[:, 1]) < 1e-9
        pairs = [(k, j) for k in numpy.flatnonzero(level) for j in numpy.flatnonzero(level)
                 if k < j and abs(points[k, 0] - points[j, 0]) < 1e-9]
        self.assertEqual(len(pairs), 13)
        for k, j in pairs:
            self.assertAlmostEqual(moved[k, 1], moved[j, 1], delta=1e-12)
        # The floor goes down by about the pressure over E times its depth.
        self.assertLess(moved[[j for _, j in pairs], 1].mean(), -0.0005)

    def test_cases_are_those_laid_down(self):
        folder = SOURCE / "validation/bodies"
        listed = subprocess.run([folder / "cases.py", "--list"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(listed.splitlines()[-1], (folder / "cases.sha256").read_text().strip())

    def test_pads_on_a_base(self):
        """Cells of the base are as those of the pads, graded ones too: nodes match; where they are asked not to, mu_M is near."""
        pads = [f"mesh.file={SOURCE}/meshes/pads.geo", "time.until.U=0.02"]
        mesh = "n: 2, total_height: 0.5, base_height: 0.25, size_contact: 0.05, size_bulk: 0.1, grade_contact: 4"
        found = {}
        for name, more in (("even", ""), ("apart", ", ratio: 1.3")):
            report = self.compute(f"pads_{name}", *pads, f"mesh.set={{{mesh}{more}}}")
            self.assertEqual(report["base"]["matches"], name == "even")
            self.assertLess(report["errors"]["moment"], 1e-11)
            self.assertEqual(sorted(pad["first"]["detachment_order"] for pad in report["results"]["pads"]), [1, 2])
            found[name] = report["results"]["mu_max"]
        self.assertAlmostEqual(found["apart"] / found["even"], 1, delta=0.03)   # what cells of 0.05 leave

    def test_said_of_a_base(self):
        said = self.call("run", "time.until.U=0.004", flags=("--overwrite", "-o", "said"))
        self.assertRegex(said, r"base +deforms; the block slid over it by 0\.\d+ % of the contact's length")
        info = subprocess.run([PROGRAM, "info", "said"], capture_output=True, text=True, cwd=self.folder, env=self.environment).stdout
        self.assertRegex(info, r"(?s)slip over base / L +\S+.*Dundurs' alpha +0\n +Dundurs' beta +0\n +rho c_S over block +1\n")

    def test_a_long_way_is_told(self):
        report = self.compute("far", "time.until={U: 0.06}", "rod.velocity=2e-3")
        self.assertTrue(any("far over its base" in text for text in report["warnings"]), report["warnings"])

    def test_refusals(self):
        for settings, said in ((["load.supports=[]"], "the base can move freely"),
                               (["load.supports=[{group: bottom, direction: z}]"], "the base can move freely"),
                               (["groups.floor=bottom"], "draw the block so that it stands on the base"),
                               (["groups.floor=nothing"], "call its upper side 'floor'"),
                               (["groups.floor=top"], "`top` is groups.top as well"),
                               (["groups.contact=floor", "groups.floor=floor"], "`floor` is groups.floor as well"),
                               (["mesh.set.ratio=0.75", "time.scheme=explicit"], "nodes lie under those of the contact")):
            told = self.call("run", *settings, status=2, flags=("-q", "--overwrite", "-o", "refused"))
            self.assertIn(said, told)

    def test_block_alone(self):
        """groups.body leaves the base out: the rigid floor's answer, of the same block."""
        alone = self.compute("alone", "groups.body=body", "load.supports=[]")
        rigid = self.compute("rigid_too", *RIGID)
        self.assertAlmostEqual(alone["results"]["mu_M"], rigid["results"]["mu_M"], delta=1e-4)

    def test_contact_called_floor(self):
        """A block whose own contact has the name that a base's floor has where nothing is given."""
        geo = (SOURCE / "meshes/block.geo").read_text().replace('Physical Curve("contact")', 'Physical Curve("floor")')
        (self.folder / "named.geo").write_text(geo)
        report = self.compute("named", f"mesh.file={self.folder}/named.geo", "groups.contact=floor", "load.supports=[]")
        self.assertNotIn("base", report)


if __name__ == "__main__":
    unittest.main()
