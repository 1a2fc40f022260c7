# SPDX-License-Identifier: GPL-2.0-or-later
"""Contacts that are not flat: a parabola as a formula and as the mesh's own shape gives Hertz's contact; a run comes to rest at the static state and, pushed slowly, slips at the rim first, explicit steps alike; a shape out of the cache is the one put in; what cannot be is refused with its place."""
import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy

from cache_fixture import OwnCache

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
PARABOLA = "contact={gap: (x - 1)^2 / 20}"


def width_of(x, force):
    """Half-width of Hertz's pressure with this second moment."""
    middle = (x * force).sum() / force.sum()
    return 2 * (((x - middle) ** 2 * force).sum() / force.sum()) ** 0.5


class Gaps(OwnCache):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = cls.folder / "scene.yaml"
        cls.scene.write_text(SCENE)

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
        _, floor = self.static("coarse", PARABOLA)
        self.assertGreater((floor < 1e-6 * floor.max()).sum(), 3)

    def test_slow_limit(self):
        """The run sets out from the static state; explicit steps come to the same forces."""
        x, wanted = self.static("rest", PARABOLA)
        _, places, pressing, _ = self.run_scene("rest_run", PARABOLA, *STILL)
        numpy.testing.assert_array_equal(x, places)
        numpy.testing.assert_allclose(pressing[-1], wanted, rtol=0, atol=2e-5 * wanted.max())
        # On 12 cells the far rim touches by a node that carries next to nothing and slips first.
        _, _, pressing, shear = self.run_scene("run", PARABOLA, "mesh.set={length: 2, height: 1, nx: 24, nz: 8}")
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

    def test_profile(self):
        """A file is the formula of its points, in any unit; what is kept of a run knows its content, not its name."""
        points = [0.3, 0.004, 0.9, 0, 1.1, 0, 1.9, 0.006]
        places = numpy.reshape([0, 0.01, *points, 2, 0.009], (-1, 2))
        listed = "points(x, " + ", ".join(f"{number:g}" for number in places.flat) + ")"
        (self.folder / "metre.csv").write_text("# plain\n" + "\n".join(f"{x:g},{gap:g}" for x, gap in places))
        (self.folder / "units.csv").write_text("\ufeffx (cm); gap [mm]\r\n\r\n" + "".join(
            f" {100 * x:g} ;\t{1000 * gap:g} \r\n" for x, gap in places))
        si = ["units=si", "material={poisson: 0.499, plane: strain, young: 1, density: 1, eta1: 1, eta2: 1}"]
        _, wanted = self.static("points", f"contact.gap={listed}")
        heads = ("x/mm, gap/um", "x_mm, gap_um", "x in mm, gap in um", "X mm, Gap um",
                 "x / mm, gap / µm", "x, gap\nmm, um", "# measured in a hurry\n# x_mm, gap_um")
        for k, head in enumerate(heads):
            (self.folder / f"head{k}.csv").write_text(f"{head}\n" + "".join(
                f"{1000 * x:g}, {1e6 * gap:g}\n" for x, gap in places))
        for name, more in (("metre", []), ("units", si), *((f"head{k}", si) for k in range(len(heads)))):
            _, force = self.static(name, f"contact.profile={name}.csv", *more)
            numpy.testing.assert_allclose(force, wanted, rtol=0, atol=1e-9 * wanted.max(), err_msg=name)
        brief = ["time.until.t=0.05", "time.scheme=explicit"]
        explicit = [self.run_scene(f"explicit-{name}", setting, *brief)[2:] for name, setting in
                    (("points", f"contact.gap={listed}"), ("file", "contact.profile=metre.csv"))]
        force = explicit[0][0].max()   # of shear, too: a relaxed start is known to a part of its largest force
        for one, other in zip(*explicit):   # of single precision in the history, where rounding may fall to either side
            numpy.testing.assert_allclose(one, other, rtol=0, atol=2 ** -23 * force)

        kept = self.folder / "kept.csv"
        shutil.copy(self.folder / "metre.csv", kept)
        words = ["contact.profile=kept.csv", "reduction.use=always"]
        before = self.run_scene("kept", *words, "time.until.U=1e-3")[2]
        study = self.folder / "study.yaml"
        study.write_text("scene: scene.yaml\nset: {contact.profile: kept.csv, time.until.U: 1e-3}\n"
                         "vary: {load.pressure: [0.03, 0.04]}\nrecord: [results.mu_max]\n")
        sweep = [PROGRAM, "sweep", study, "-q", "-j", "1", "-o", self.folder / "sweep"]
        tables = []
        for text in (None, None, "0 0.01\n1 0\n2 0.01"):
            if text:
                kept.write_text(text)
            subprocess.run(sweep, check=True, capture_output=True, cwd=self.folder, env=self.environment)
            points = sorted((self.folder / "sweep/points").iterdir())
            tables.append([len(points), (self.folder / "sweep/sweep.csv").read_text()])
        self.assertEqual(tables[0], tables[1])
        self.assertEqual([count for count, _ in tables], [2, 2, 4])
        self.assertNotEqual(tables[1][1], tables[2][1])
        said = self.call("run", *words, "time.until.U=2e-3", status=2, flags=("-q", "-o", self.folder / "kept", "--resume"))
        self.assertIn("another scene or mesh", said)
        after = self.run_scene("anew", *words, "time.until.U=1e-3")   # its basis is that of before
        fresh = self.run_scene("fresh", *words, "time.until.U=1e-3", "reduction.cache=false")
        self.assertTrue(after[0]["model"]["from_cache"])
        numpy.testing.assert_array_equal(after[2], fresh[2])
        self.assertFalse(numpy.array_equal(after[2][0], before[0]))

    def test_profile_refused(self):
        for text, words in (("0,0\n1,0\n0.5,0", [":3:1: ", "x = 0.5 comes after 1"]), ("0,0\n1,nan\n2,0", [":2:3: ", "`nan` is no number"]),
                            ("0,0\n\n2,-1", [":3:3: ", "at x = 2 the gap is -1"]), ("0,0\n1,0", ["goes from x = 0 to 1", "from 0 to 2"]),
                            ("x [mm], gap [um]\n0,0\n2000,0", [":1:1: x [mm] has a unit", "normalised"]),
                            ("0,0", ["has 1 point; two or more"]), ("0 0\n0 0 1\n", [":2: 3 cells, the first row has 2"]),
                            ("0 0 1 2\n", [":1: 4 columns without names"]),
                            ("place\n0 0\n", [":1: there is no column x"]), ("O.1, 0.2\n0, 0\n2, 0", [":1: there is no column x", "wanted: x and gap"]),
                            ("# \n  x,0,2\n0 0\n2 0", [":3: 1 cell, the first row has 3"]), ("position, depth\n0, 0\n2, 0", [":1: there is no column x"]),
                            ("x, way, gap\n0,0,0\n", [":1:4: way is no column"]), ("x, x, gap\n0,0,0\n", ["x stands twice, in column 1 and in column 2"]),
                            ("x\n0 0\n2 0", ["bad.csv:1: there is no column gap"]), ("x (mm, gap\n0, 0\n2, 0", [":1: there is no column x"]),
                            ("x_s, gap_s\n0, 0\n2, 0", [":1:1: x_s has a unit"]), ("x " + 99 * "y" + ", gap\n0, 0\n2, 0", [":1: there is no column x"]),
                            ("mm, um\n0,0\n2,0", [":1: there is no column x"]),
                            ("0,1e999\n2,0", [":1:3: ", "`1e999` is no number"])):
            (self.folder / "bad.csv").write_text(text)
            said = self.call("run", "contact.profile=bad.csv", status=2, flags=("-o", self.folder / "no", "--overwrite"))
            for word in ["contact.profile", "bad.csv", *words]:
                self.assertIn(word, said)
        said = self.call("info", "contact.profile=none.csv", status=2)
        self.assertIn("none.csv: No such file", said)
        (self.folder / "bad.csv").write_text("x [kg], gap\n0, 0\n2, 0\n")
        said = self.call("info", "contact.profile=bad.csv", "units=si", "material={young: 1, density: 1, eta1: 1, eta2: 1}",
                         "material.poisson=0.3", status=2)
        self.assertIn("`kg`, which is no unit of length; allowed: m, mm, um", said)

    def test_rounded_edge(self):
        """Drawn in the mesh it is what the same floor makes of it; the examples run."""
        peaks = []
        for name in ("rounded", "rounded_mesh"):
            self.scene = SOURCE / f"validation/friction/{name}.yaml"
            report, x, pressing, _ = self.run_scene(name, "mesh.set.nx=20", "mesh.set.nz=20", "time.until={U: 8e-3, slidings: 2}")
            peaks.append(numpy.array([[peak["U"], peak["mu"]] for peak in report["results"]["peaks"]]))
            self.assertEqual(pressing[:, 0].max(), 0)      # the edge never comes down
            self.assertLess((pressing[0] > 0).sum(), len(x))
        self.assertEqual(peaks[0].shape, (2, 2))
        numpy.testing.assert_allclose(*peaks, rtol=5e-3)
        self.scene = SOURCE / "validation/friction/measured.yaml"
        _, x, pressing, _ = self.run_scene("measured", "mesh.set.nx=20", "mesh.set.nz=10", "time.until.U=0.2 mm")
        self.assertTrue(pressing[-1][x > 0.1].any())
        self.assertEqual(pressing[:, x < 0.005].max(), 0)     # 45 um high

    def test_refused(self):
        for command, setting, words in (
                ("run", "contact.gap=x - 1", ["contact.gap", "at x = 0 the gap is -1", ">= 0"]),
                ("run", "contact.gap=y", ["contact.gap", "y"]),
                ("run", "contact.gap=log(x)", ["contact.gap", "at x = 0"]),
                ("model1d", "contact.gap=0.01*x", ["contact.gap", "flat"])):
            said = self.call(command, setting, "friction={mu_static: 0.3, mu_kinetic: 0.1, critical_velocity: 1e-3}",
                             status=2, flags=("-o", self.folder / "no", "--overwrite"))
            for word in words:
                self.assertIn(word, said)


if __name__ == "__main__":
    unittest.main()
