# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes in the laboratory's quantities: newtons, thickness, machines in N/m, measured friction and moduli; the newcomer's
scene of the cookbook."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")) / "amontons"
SOLE = SOURCE / "docs/examples/sole.yaml"
PMMA = SOURCE / "docs/examples/pmma.yaml"
COARSE = ["mesh.set.nx=12", "mesh.set.nz=8", "output.figures=[]"]


class Quantities(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons-quantities-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def call(self, *words, status=0):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, cwd=self.folder, timeout=300,
                              env=os.environ | {"AMONTONS_CACHE": str(self.folder / "cache")})
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def run_scene(self, scene, *settings, name="out"):
        said = self.call("run", scene, "-o", name, *(["--set", *settings] if settings else [])).stdout
        return json.loads((self.folder / name / "run.json").read_text()), said

    def test_newtons_are_pascals_times_area(self):
        """A force and a machine of the whole block are the pressure and the stiffness per width that somebody divides by hand,
        to the bit; results are in newtons; run.json is read again as the same scene."""
        until = "time.until={U: 0.4 mm}"
        whole, said = self.run_scene(PMMA, *COARSE, until, "thickness=6 mm", "load={force: 2.004 kN}", "rod.stiffness=6e7 N/m", name="whole")
        by_hand, plain = self.run_scene(PMMA, *COARSE, until, "rod.stiffness=1e10 Pa", name="by-hand")
        self.assertEqual(whole["results"]["mu_max"], by_hand["results"]["mu_max"])
        self.assertEqual(whole["model"]["pressure"], 1.67e6)
        self.assertAlmostEqual(whole["results"]["F_N"], 2004, delta=1e-9)
        self.assertAlmostEqual(whole["results"]["F_T_max"], 2004 * whole["results"]["mu_max"], delta=1e-9)
        self.assertNotIn("F_N", by_hand["results"])
        self.assertIn("forces          F_N 2004,", said)
        self.assertNotIn("forces", plain)
        self.assertEqual(whole["scene"]["rod"]["stiffness"], "60000000 N/m")
        scene = whole["scene"]
        scene["mesh"]["file"] = str(SOURCE / "meshes/block.geo")
        (self.folder / "again.yaml").write_text(json.dumps(scene))
        again, _ = self.run_scene("again.yaml", name="again")
        self.assertEqual(again["results"]["mu_max"], whole["results"]["mu_max"])

    def test_space_knows_its_areas(self):
        block = f"units: si\nmesh: {{file: {SOURCE}/meshes/block3d.geo, set: {{length: 0.1, breadth: 0.02, height: 0.05, nx: 4, ny: 2, nz: 3}}}}\n" \
            "material: {young: 3 GPa, poisson: 0.4, density: 1190, eta1: 91 MPa s, eta2: 91 MPa s}\n" \
            "friction: {mu_static: 0.5, mu_kinetic: 0.3, critical_velocity: 1 mm/s}\nload: {force: 2 kN}\n" \
            "rod: {velocity: 0.1 mm/s, stiffness: 1e7 N/m}\ntime: {until: {U: 0.1 mm}}\n"
        (self.folder / "space.yaml").write_text(block)
        whole, _ = self.run_scene("space.yaml")
        by_hand, _ = self.run_scene("space.yaml", "load={pressure: 1 MPa}", "rod.stiffness=5e8", name="by-hand")
        self.assertAlmostEqual(whole["results"]["mu_max"], by_hand["results"]["mu_max"], delta=1e-9)
        self.assertAlmostEqual(whole["results"]["F_N"], 2000, delta=1e-6)
        self.assertIn("leave it out", self.call("run", "space.yaml", "-o", "no", "--set", "thickness=1 mm", status=2).stderr)

    def test_law_of_the_pressure(self):
        """mu of p, of a force in newtons: the law is looked at with the pressure that the force makes."""
        law = "friction={law: formula, formula: '(0.05 + 0.05 * exp(-v / 5e-3)) * log(max(p, 5e3) / 4e3)', velocity_max: 1}"
        both = (*COARSE, "time.until={U: 0.2 mm}", law)
        by_hand, _ = self.run_scene(PMMA, *both, name="by-hand")
        whole, _ = self.run_scene(PMMA, *both, "thickness=6 mm", "load={force: 2.004 kN}", name="whole")
        self.assertAlmostEqual(whole["results"]["mu_max"], by_hand["results"]["mu_max"], delta=1e-12)
        settings = ["--set", law, "thickness=6 mm", "load={force: 2.004 kN}"]
        self.assertIn("depends on the pressure", self.call("info", PMMA, *settings).stdout)
        self.assertIn("load.force=none", self.call("info", PMMA, "--picture", "friction.png", *settings, status=2).stderr)

    def test_tractions_in_newtons(self):
        both = (*COARSE, "time.until={U: 0.2 mm}")
        by_hand, _ = self.run_scene(PMMA, *both, "load.tractions=[{group: top, x: 10 kPa, z: -0.1 MPa}]", name="by-hand")
        newtons = "load.tractions=[{group: top, x: 12 N, z: -120 N}]"
        whole, _ = self.run_scene(PMMA, *both, "thickness=6 mm", newtons, name="whole")
        self.assertAlmostEqual(whole["results"]["mu_max"], by_hand["results"]["mu_max"], delta=1e-12)
        self.assertEqual(whole["scene"]["load"]["tractions"][0]["x"], "12 N")
        self.assertIn("`thickness`", self.call("run", PMMA, "-o", "no", "--set", newtons, status=2).stderr)

    def test_what_is_missing(self):
        told = self.call("run", PMMA, "-o", "no", "--set", "load={force: 6 kN}", status=2).stderr
        self.assertIn("load.force", told)
        self.assertIn("`thickness`", told)
        told = self.call("run", PMMA, "-o", "no", "--set", "load.pressure=6 kN", status=2).stderr
        self.assertIn("divide it by an area", told)

    def test_newcomer(self):
        """Fifteen lines, nothing divided by hand, and pictures of what was measured."""
        self.assertLessEqual(len(SOLE.read_text().splitlines()), 15)
        report, said = self.run_scene(SOLE, "mesh.set.nx=16", "mesh.set.nz=3", "mesh.set.nz_layer=4", "time.until.U=2 mm")
        self.assertAlmostEqual(report["results"]["F_N"], 50, delta=1e-9)
        self.assertAlmostEqual(report["model"]["pressure"], 50 / (0.02 * 0.015), delta=1e-6)
        self.assertTrue(0.5 < report["results"]["mu_max"] < 1.28)
        self.assertIn("F_N 50, ", said)
        layer = report["scene"]["materials"]["layer"]
        self.assertTrue(2.7e6 < layer["young"] < 3.1e6 and 5 <= len(layer["relaxation"]) <= 12)
        self.assertEqual({branch["bulk"] for branch in layer["relaxation"]}, {0})
        for picture in ("friction.png", "sole-material.svg", "mesh.png"):
            told = self.call("info", SOLE, "--picture", picture).stdout
            self.assertGreater((self.folder / picture).stat().st_size, 5000)
        self.assertIn("at rest mu is 1.05, its first value", told)
        self.assertIn("Moduli of", told)
        drawn = (self.folder / "sole-material.svg").read_text()
        self.assertIn("</svg>", drawn)
        self.assertIn("no material of the scene comes from a table", self.call("info", PMMA, "--picture", "material.png", status=2).stderr)


if __name__ == "__main__":
    unittest.main()
