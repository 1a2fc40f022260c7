# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction by contact curve and along it: laws that say the same everywhere give the bits of one law; where they
differ, every slipping node of the history has the coefficient of its own place; both schemes, statics and
stability; what is wrong is told with its place."""
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
SCENE = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/pads.geo, set: {{n: 3, cells_pad: 4, cells_gap: 2}}}}
material: {{poisson: 0.34}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.006}}
rod: {{velocity: 1e-5}}
time: {{until: {{U: 0.006}}}}
"""
DIFFERENT = ("friction.contacts=[{group: contact_2, mu_static: 0.3, mu_kinetic: 0.05}, "
             "{group: contact_3, law: coulomb, mu_static: 0.4, along: '0.5'}]")


def coefficient(pad, speed):
    """mu of DIFFERENT, written out."""
    falls = numpy.maximum(0, 1 - speed / 3.4e-4)
    return (0.1 + 0.28 * falls, 0.05 + 0.25 * falls, 0.2 + 0 * speed)[pad]


class Contacts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons-contacts-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.scene = cls.folder / "scene.yaml"
        cls.scene.write_text(SCENE)

    def call(self, command, *settings, status=0, flags=()):
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, self.scene, *words, *flags], capture_output=True, text=True,
                              cwd=self.folder)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def run_scene(self, name, *settings):
        folder = self.folder / name
        self.call("run", *settings, flags=("-q", "-o", folder))
        with h5py.File(folder / "history.h5") as file:
            arrays = {}
            file.visititems(lambda key, item: arrays.update({key: item[()]}) if hasattr(item, "shape") else None)
        return arrays

    def test_one_law_in_many_words(self):
        """Given for each curve, or times 1 along x: the same bits."""
        plain = self.run_scene("plain")
        for name, setting in (("curve", "friction.contacts=[{group: contact_2, mu_static: 0.38}]"),
                              ("along", "friction.along=points(x, 0, 1, 1, 1)")):
            for key, array in self.run_scene(name, setting).items():
                numpy.testing.assert_array_equal(array, plain[key], f"{name}: {key}")

    def check_nodes(self, arrays, tolerance):
        """Shear over pressure of nodes that slip is mu of their own curve at their own slip rate."""
        pad, slipping = arrays["nodes/pad"], 0
        for k in range(3):
            shear, pressure, rate = (arrays[f"interface/{name}"][1:, pad == k]
                                     for name in ("shear", "pressure", "slip_rate"))
            moves = (numpy.abs(rate) > 1e-9) & (pressure > 1e-6)
            wanted = numpy.sign(rate) * coefficient(k, numpy.abs(rate))
            error = numpy.abs(shear - wanted * pressure)[moves] / pressure.max()
            self.assertLess(error.max(), tolerance, k)
            slipping += moves.sum(axis=0).min() > 0
            self.assertLess((numpy.abs(shear) - coefficient(k, 0) * pressure).max(), 1e-9)
        return slipping

    def test_each_node_has_its_own(self):
        arrays = self.run_scene("different", DIFFERENT)
        self.assertEqual(self.check_nodes(arrays, 1e-6), 3)
        scene = json.loads((self.folder / "different/run.json").read_text())["scene"]
        self.assertEqual(scene["friction"]["contacts"][1],
                         {"group": "contact_3", "law": "coulomb", "mu_static": 0.4, "along": "0.5"})

    def test_middle_that_is_lubricated(self):
        """No node carries more than its factor allows, by both schemes, which agree."""
        found, times = [], numpy.linspace(5, 50, 50)
        for scheme in ("sdirk2", "explicit"):
            arrays = self.run_scene(scheme, f"mesh={{file: {SOURCE}/meshes/block.geo, set: {{nx: 10, nz: 4}}}}",
                                    "friction.along=points(x, 0.4, 1, 0.45, 0.3, 0.55, 0.3, 0.6, 1)",
                                    f"time={{scheme: {scheme}, until: {{t: 50}}}}")
            factor = numpy.interp(arrays["nodes/x"], [0.4, 0.45, 0.55, 0.6], [1, 0.3, 0.3, 1])
            self.assertLess(factor.min(), 0.5)
            shear, pressure = (arrays[f"interface/{name}"] for name in ("shear", "pressure"))
            self.assertLess((numpy.abs(shear) - 0.38 * factor * pressure).max(), 1e-9)
            found.append(numpy.interp(times, arrays["series/time"], arrays["series/mu"]))
        numpy.testing.assert_allclose(*found, atol=0.01 * found[1].max())

    def test_feet_of_one_curve(self):
        """Two feet are two pads, drawn as one curve group or as two; friction is given by foot, or for both at once."""
        drawn = (SOURCE / "docs/examples/arch.geo").read_text()
        joined = drawn.replace('Physical Curve("contact_1") = {1};', 'Physical Curve("contact") = {1, 3};').replace(
            'Physical Curve("contact_2") = {3};', "")
        self.assertNotEqual(joined, drawn)
        found = {}
        for name, text, rough in (("two", drawn, "contact_2"), ("one", joined, "contact/2"), ("both", joined, "contact")):
            (self.folder / f"{name}.geo").write_text(text)
            arrays = self.run_scene(name, f"mesh={{file: {self.folder}/{name}.geo, set: {{refine: 0.5}}}}", "time.until.U=0.008",
                                    f"friction.contacts=[{{group: {rough}, mu_static: 0.5}}]")
            results = json.loads((self.folder / name / "run.json").read_text())["results"]
            found[name] = arrays, results["slip_length"], [pad["name"] for pad in results["pads"]]
        self.assertEqual(found["two"][0].keys(), found["one"][0].keys())
        for key, array in found["two"][0].items():
            numpy.testing.assert_array_equal(array, found["one"][0][key], key)
        self.assertEqual(found["two"][1], found["one"][1])
        self.assertEqual((found["two"][2], found["one"][2]), (["contact_1", "contact_2"], ["contact/1", "contact/2"]))
        for name, rough in (("one", [False, True]), ("both", [True, True])):
            arrays = found[name][0]
            most = [(arrays["interface/shear"] - 0.381 * arrays["interface/pressure"])[:, arrays["nodes/pad"] == k].max() for k in (0, 1)]
            self.assertEqual([one > 0 for one in most], rough, name)   # mu_static is 0.38 elsewhere

    def test_jumps_between_nodes(self):
        """Coarse meshes come near to what 80 to 300 cells give, 0.2195 to 0.2207, wherever their nodes lie beside the jumps."""
        for cells in (20, 28):
            folder = self.folder / f"ends-{cells}"
            words = [f"mesh.set.nx={cells}", f"mesh.set.nz={cells}", "output={history: false, figures: []}", "time.until.U=0.025"]
            subprocess.run([PROGRAM, "run", SOURCE / "validation/friction/ends.yaml", "-q", "-o", folder, "--set", *words], check=True,
                           capture_output=True)
            mu = json.loads((folder / "run.json").read_text())["results"]["mu_M"]
            self.assertTrue(0.2196 < mu < 0.2235, f"{cells} cells: {mu}")   # by the factor at nodes 0.2173 and 0.2183

    def test_other_commands(self):
        self.call("stability", DIFFERENT, flags=("-q", "--from", "start", "-o", self.folder / "path"))
        self.call("static", DIFFERENT, "rod.displacement=2e-3", flags=("-q", "-o", self.folder / "static"))
        with h5py.File(self.folder / "static/static.h5") as file:
            self.assertIsNotNone(file)
        self.assertIn("has one law along its line", self.call("model1d", DIFFERENT, status=2, flags=["--theory"]))

    def test_refusals(self):
        for words, setting in (
                ("`nope` is no contact group", "friction.contacts=[{group: nope, mu_static: 0.2}]"),
                ("unknown key `mu_statc`", "friction.contacts=[{group: contact_1, mu_statc: 0.2}]"),
                ("contact_1: mu_kinetic: 0.1 is more than mu_static (0.05)",
                 "friction.contacts=[{group: contact_1, mu_static: 0.05}]"),
                ("needs its `group`", "friction.contacts=[{mu_static: 0.2}]"),
                ("the group `contact_1` is named twice: by item 1 and by item 3", "friction.contacts=[{group: contact_1, "
                 "mu_static: 0.2}, {group: contact_2, mu_static: 0.3}, {group: contact_1, mu_static: 0.4}]"),
                ("a table is for the whole contact", "friction.contacts=[{group: contact_1, law: table}]"),
                ("at velocity", "friction.contacts=[{group: contact_1, law: formula, formula: '0.3 - v'}]"),
                ("friction.along, as set: at x = ", "friction.along=x - 2"),
                ("`y` is no number here", "friction.along=y")):
            with self.subTest(words):
                self.assertIn(words, self.call("run", setting, status=2, flags=["-q", "--overwrite", "-o", self.folder / "refused"]))


if __name__ == "__main__":
    unittest.main()
