# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction laws of one's own, through the commands: the built-in law as formula, as table and as plug-in is the
built-in law; a law that strengthens again is the same for implicit and explicit steps; what is no law is refused,
with file, line, key and velocity."""
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
PLUGIN = Path(os.environ["AMONTONS_BIN"]).resolve().parent / "tests" / "stribeck.so"
EXAMPLE = SOURCE / "validation/friction/strengthening.yaml"
NUMBERS = {"mu_static": 0.38, "mu_kinetic": 0.1, "critical_velocity": 3.4e-4}
SCENE = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/block.geo, set: {{nx: 8, nz: 6}}}}
material: {{poisson: 0.34}}
friction:
  FRICTION
load: {{pressure: 0.006}}
rod: {{velocity: 1e-5}}
time: {{until: {{U: 0.007}}}}
output: {{history: true}}
"""


def flow(**keys):
    return "\n  ".join(f"{key}: {value}" for key, value in keys.items())


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-laws-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)

    def call(self, command, *flags, status=0, name="scene", **keys):
        scene = self.folder / f"{name}.yaml"
        scene.write_text(SCENE.replace("FRICTION", flow(**keys)))
        done = subprocess.run([PROGRAM, command, scene, *flags], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def history(self, name, *flags, **keys):
        folder = self.folder / name
        self.call("run", "--quiet", "--overwrite", "-o", folder, *flags, name=name, **keys)
        with h5py.File(folder / "history.h5") as file:
            return {key: array[:] for key, array in file["series"].items()}

    def test_plugin_is_the_built_in_law(self):
        """To the last bit, through solver, certificate and recorders, and with stability."""
        known = self.history("known", law="exponential-weakening", **NUMBERS)
        own = self.history("plugin", "--trust", law="plugin", file=PLUGIN, **NUMBERS)
        for name, array in known.items():
            numpy.testing.assert_array_equal(own[name], array, name)
        for flags, law in (([], {"law": "exponential-weakening"}), (["--trust"], {"law": "plugin", "file": PLUGIN})):
            self.call("stability", "-q", "--from", "start", "-o", self.folder / f"path-{law['law']}", *flags, **law, **NUMBERS)
        with h5py.File(self.folder / "path-plugin/stability.h5") as own, \
                h5py.File(self.folder / "path-exponential-weakening/stability.h5") as built_in:
            arrays = {}
            built_in.visititems(lambda name, item: arrays.update({name: item[()]}) if hasattr(item, "shape") else None)
            for name, array in arrays.items():
                numpy.testing.assert_array_equal(own[name][()], array, name)
            self.assertGreater(len(arrays), 3)
        result = json.loads((self.folder / "plugin/run.json").read_text())
        self.assertEqual(result["scene"]["friction"]["law"], "plugin")

    def test_formula_is_the_built_in_law(self):
        """To rounding, up to the first sliding; after it rounding grows."""
        known = self.history("known", law="exponential-weakening", **NUMBERS)
        own = self.history("formula", law="formula", formula='"0.1 + 0.28 * exp(-v / 3.4e-4)"')
        peak = numpy.argmax(known["mu"])
        self.assertGreater(known["mu"][peak], 0.3)
        numpy.testing.assert_allclose(own["mu"][:peak], known["mu"][:peak], rtol=1e-9)
        numpy.testing.assert_allclose(own["time"][:peak], known["time"][:peak], rtol=1e-12)

    def test_scene_of_a_result_reads_again(self):
        """run.json's scene is a scene: the same table, the same law."""
        table = {"law": "table", "velocity": "[0, 2e-4, 1e-3, 0.01]", "mu": "[0.38, 0.2, 0.1, 0.15]"}
        self.history("table", **table, interpolation="linear")
        scene = json.loads((self.folder / "table/run.json").read_text())["scene"]
        self.assertEqual(scene["friction"]["mu"], [0.38, 0.2, 0.1, 0.15])
        again = self.folder / "table/again.yaml"
        again.write_text(json.dumps(scene))
        said = subprocess.run([PROGRAM, "info", again], capture_output=True, text=True).stdout
        self.assertIn("mu at rest 0.38, lowest mu 0.1, v_c 0.0002", said)

    def test_example_by_both_schemes(self):
        """The shipped scene of a law that strengthens again, coarse, with sliding at a shear that would never end
        under mu_kinetic: implicit and explicit steps come to the same slip and force."""
        found = []
        for scheme in ("sdirk2", "explicit"):
            folder = self.folder / scheme
            subprocess.run([PROGRAM, "run", EXAMPLE, "-q", "-o", folder, "--set", f"time.scheme={scheme}", "--set",
                            "mesh.set.nx=8", "--set", "mesh.set.nz=4", "--set", "time.until={t: 60}"], check=True)
            with h5py.File(folder / "history.h5") as file:
                series = {key: array[:] for key, array in file["series"].items()}
            found.append(series)
        times = numpy.linspace(5, 60, 100)
        implicit, explicit = (numpy.interp(times, s["time"], s["mu"]) for s in found)
        numpy.testing.assert_allclose(implicit, explicit, atol=0.01 * explicit.max())

    def test_above_rest_by_both_schemes(self):
        """The same of laws that rise to more than what holds at rest, one at once, one after a fall, and one that has none at
        rest and falls again; a table and formulas."""
        laws = {"rising": {"law": "table", "velocity": "[0, 2e-3, 1e-2]", "mu": "[0.2, 0.35, 0.6]"},
                "after a fall": {"law": "formula", "formula": '"0.15 + 0.2 * exp(-v / 3.4e-4) + 0.12 * log(1 + v / 1e-3)"'},
                "lubricated": {"law": "formula", "formula": '"0.9 * v / 1e-3 * exp(1 - v / 1e-3) + 0.3 * tanh(v / 1e-3)"'}}
        for name, law in laws.items():
            with self.subTest(name):
                found = [self.history(f"{name}-{scheme}", "--set", f"time.scheme={scheme}", "--set", "mesh.set.nz=4", "--set",
                                      "rod.velocity=1e-3", "--set", "time.until={t: 40}", **law)
                         for scheme in ("sdirk2", "explicit")]
                times = numpy.linspace(0.5, 40, 200)
                implicit, explicit = (numpy.interp(times, series["time"], series["mu"]) for series in found)
                self.assertGreater(explicit.max(), 0.25)
                numpy.testing.assert_allclose(implicit, explicit, atol=0.01 * explicit.max())

    def test_static_and_line(self):
        """Statics ask for mu at rest alone. The 1D model takes what weakens only, and refuses the rest by name."""
        falling = {"law": "formula", "formula": '"0.1 + 0.28 / (1 + v / 2e-4)"'}
        rising = {"law": "formula", "formula": '"0.1 + 0.28 * exp(-v / 2e-4) + 0.01 * log(1 + v / 0.001)"'}
        for law in (falling, rising):
            self.call("static", "--set", "rod.displacement=1e-3", "-q", **law)
        self.assertIn("l_sc", self.call("model1d", "--theory", **falling))
        said = self.call("model1d", "--theory", status=2, **rising)
        self.assertIn("friction.law: the 1D model's closed forms", said)

    def test_refusals(self):
        for words, flags, keys in (
                ("scene.yaml:6: friction.formula: at velocity ", [], {"law": "formula", "formula": '"0.4 - v"'}),
                ("scene.yaml:6: friction.formula: `w` is no number here", [], {"law": "formula", "formula": "0.4 - w"}),
                ("friction.mu: found `-0.1`", [],
                 {"law": "table", "velocity": "[0, 0.1]", "mu": "[0.3, 0.2, -0.1]"}),
                ("friction.velocity: missing", [], {"law": "table", "mu": "[0.3, 0.4]"}),
                ("scene.yaml:6:12: friction.formula: the law `linear-weakening` does not read it", [],
                 {"law": "linear-weakening", "formula": '"0.4"', **NUMBERS}),
                ("is a program that would be run: give --trust", [], {"law": "plugin", "file": PLUGIN, **NUMBERS}),
                ("none.so: No such file", ["--trust"], {"law": "plugin", "file": "none.so"})):
            with self.subTest(words):
                self.assertIn(words, self.call("info", *flags, status=2, **keys))


if __name__ == "__main__":
    unittest.main()
