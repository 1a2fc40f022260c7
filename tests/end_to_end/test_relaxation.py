# SPDX-License-Identifier: GPL-2.0-or-later
"""Branches of a generalised Maxwell solid: creep and a driven block in closed form, in plane stress and plane strain and
in space; the reduced block steps as the full one, also of two regions, and its basis serves other loads; explicit steps
have the same history; stresses in fields balance the load; a run that was cut off goes on to the same bits; what is wrong
is told with its place."""
import json
import os
import random
import re
import signal
import subprocess
import time
import unittest
from pathlib import Path

import h5py
import numpy

from cache_fixture import OwnCache
from vtu_fixture import read_vtu

SOURCE = Path(os.environ["AMONTONS_SOURCE"])
PROGRAM = Path(os.environ["AMONTONS_BIN"], "amontons")
YOUNG, POISSON, ETA, PRESSURE = 1.0, 0.34, 0.2, 0.003
BRANCHES = [(0.5, 0.4, 0.3), (3.0, 0.3, 0.0)]   # time, G, K
LIST = "[" + ", ".join(f"{{time: {t}, shear: {g}, bulk: {k}}}" for t, g, k in BRANCHES) + "]"
FREE = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1, height: 0.5, nx: 3, nz: 2}}}}
material: {{young: {YOUNG}, poisson: {POISSON}, density: 1e-9, eta1: {ETA}, eta2: {ETA}, relaxation: {LIST}}}
friction: {{law: coulomb, mu_static: 0}}
load: {{pressure: {PRESSURE}, supports: [{{group: rod, direction: x}}]}}
rod: {{kind: none}}
time: {{until: {{t: 4}}, step_max: 0.01, step_min: 0.01, tolerance: 1, energy_tolerance: 1}}
"""
# A block that stands on the middle of its lower side alone, so that a rod drives its whole face, corners too.
STOOL = "\n".join([
    *(f"Point({k + 1}) = {{{x}, {y}, 0, 0.25}};" for k, (x, y) in enumerate([(0, 0), (0.25, 0), (0.75, 0), (1, 0), (1, 0.5), (0, 0.5)])),
    *(f"Line({k}) = {{{k}, {k % 6 + 1}}};" for k in range(1, 7)), "Curve Loop(1) = {1, 2, 3, 4, 5, 6};", "Plane Surface(1) = {1};",
    'Physical Surface("body") = {1};', 'Physical Curve("contact") = {2};', 'Physical Curve("leading") = {4};', 'Physical Curve("top") = {5};',
    'Physical Curve("rod") = {6};', ""])
BLOCK = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/block.geo, set: {{length: 1, height: 0.5, nx: 20, nz: 10}}}}
material: {{poisson: 0.34, relaxation: [{{time: 0.5, shear: 0.2, bulk: 0.1}}, {{time: 40, shear: 0.15}}]}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 1e-5}}
time: {{until: {{U: 0.003}}}}
"""
PADS = f"""units: normalised
mesh: {{file: {SOURCE}/meshes/layers.geo, set: {{nx: 12, nz: 4, nz_layer: 3}}}}
material: {{poisson: 0.34}}
materials:
  layer: {{young: 0.1205654101995565, poisson: 0.4758869179600887, eta1: 0.1, eta2: 0.3, relaxation: [{{time: 2, shear: 0.05}}, {{time: 60, shear: 0.05}}]}}
friction: {{mu_static: 0.38, mu_kinetic: 0.1, critical_velocity: 3.4e-4}}
load: {{pressure: 0.003}}
rod: {{velocity: 2e-5}}
time: {{until: {{U: 0.004}}}}
"""


def moduli(s, plane):
    """Stress over strain at the rate s, of zz - xx and of zz + xx: 2 G and 2 k."""
    shear, bulk = YOUNG / (2 * (1 + POISSON)), YOUNG / (3 * (1 - 2 * POISSON))
    for time, g, k in BRANCHES:
        shear, bulk = shear + g * s * time / (1 + s * time), bulk + k * s * time / (1 + s * time)
    areal = 9 * bulk * shear / (3 * bulk + 4 * shear) if plane == "stress" else bulk + shear / 3
    return 2 * shear + s * ETA, 2 * areal + s * (ETA + 2 * ETA)


def step_response(t, modulus):
    """Of 1/s over the modulus, by Talbot's contour (Abate and Valko 2004)."""
    count = 40
    angle = (numpy.arange(1, count) * numpy.pi / count)[:, None]
    cot = numpy.cos(angle) / numpy.sin(angle)
    s = 2 * count / (5 * t) * angle * (cot + 1j)
    weight = 1 + 1j * (angle + (angle * cot - 1) * cot)
    first = numpy.exp(2 * count / 5) / 2 / (2 * count / (5 * t)) / modulus(2 * count / (5 * t) + 0j)
    rest = numpy.exp(s * t) * weight / s / modulus(s)
    return (2 / (5 * t) * (first + rest.sum(axis=0))).real


class Relaxation(OwnCache):
    def call(self, scene, command, *settings, status=0, flags=()):
        path = self.folder / "scene.yaml"
        path.write_text(scene)
        words = [word for setting in settings for word in ("--set", setting)]
        done = subprocess.run([PROGRAM, command, path, *words, *flags], capture_output=True, text=True, cwd=self.folder,
                              env=self.environment)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout + done.stderr

    def run_scene(self, scene, name, *settings, flags=()):
        """(run.json, arrays of the history)"""
        folder, arrays = self.folder / name, {}
        self.call(scene, "run", *settings, flags=("-q", "-o", folder, *flags))
        if (folder / "history.h5").exists():
            with h5py.File(folder / "history.h5") as file:
                file.visititems(lambda key, item: arrays.update({key: item[()]}) if hasattr(item, "shape") else None)
        return json.loads((folder / "run.json").read_text()), arrays

    def frames(self, name, first=0):
        """Times, eps_zz and eps_xx of a block that is strained evenly, and stresses, from frame `first` on."""
        listed = re.findall(r'timestep="([^"]+)".*?file="(fields/bulk[^"]+)"', (self.folder / name / "fields.pvd").read_text())
        made = []
        for t, file in listed[first:]:
            points, arrays = read_vtu(self.folder / name / file)
            u, (x, z, _) = arrays["displacement"], points.argmax(axis=0)
            made.append((float(t), u[z, 1] / points[z, 1], u[x, 0] / points[x, 0], arrays["stress"]))
        return made

    def test_creep(self):
        """A pressure put on at once: strains of the whole block, and stresses that balance it at every time."""
        for plane in ("stress", "strain"):
            self.run_scene(FREE, plane, f"material.plane={plane}", "start.state=undeformed",
                           "output.fields={every_t: 0.5}")
            seen = self.frames(plane, 1)
            self.assertGreater(len(seen), 6)
            for t, zz, xx, stress in seen:
                shear, areal = (step_response(t, lambda s, k=k: moduli(s, plane)[k])[0] for k in (0, 1))
                exact = -PRESSURE * numpy.array([areal + shear, areal - shear]) / 2
                numpy.testing.assert_allclose([zz, xx], exact, atol=1e-4 * PRESSURE)
                numpy.testing.assert_allclose(stress, numpy.tile([0, -PRESSURE, 0], (len(stress), 1)), atol=1e-5 * PRESSURE)

    def test_relaxation(self):
        """A block that is shortened along x in no time to speak of and held so: its force is the short-time one at first and relaxes."""
        strain, soon = 1e-3, 0.05
        rod = f"{{kind: push, whole: true, velocity: {strain / soon}, program: {{t: [0, {soon}, {soon}], factor: [1, 1, 0]}}}}"
        (self.folder / "stool.geo").write_text(STOOL)
        for plane in ("stress", "strain"):
            _, seen = self.run_scene(FREE, f"held-{plane}", "mesh={file: stool.geo}", f"rod={rod}", "load.supports=[{group: leading, direction: x}]",
                                     f"material.plane={plane}", "time.step_max=1e-3", "time.step_min=1e-3")
            t, at = seen["series/time"], numpy.array([0.1, 0.3, 1, 3.9])

            def inverse(s):
                shear, areal = (k / 2 for k in moduli(s, plane))
                return s * (shear + areal) / (4 * shear * areal)
            exact = numpy.array([(step_response(x, inverse)[0] - step_response(x - soon, inverse)[0]) / soon for x in at])
            ours = numpy.interp(at, t, seen["series/mu"]) * PRESSURE / (strain * 0.5)
            numpy.testing.assert_allclose(ours, exact, rtol=1e-3)
            self.assertGreater(exact[0] / exact[-1], 1.05)

    def test_driven(self):
        """Storage and loss modulus of shear and area read back from a load that swings, far from its start."""
        period, swing, points = 6.0, 0.4, 63
        at = numpy.arange(points + 1)
        t = ", ".join(f"{x:.12g}" for x in at * period / points)
        factor = ", ".join(f"{x:.12g}" for x in 1 + swing * numpy.sin(2 * numpy.pi * at / points))
        folder = "driven"
        self.run_scene(FREE, folder, f"load.program={{t: [{t}], factor: [{factor}], repeat: true}}",
                       f"time.until.t={14 * period}", f"time.step_max={period / 1000}", f"time.step_min={period / 1000}",
                       f"output.fields={{every_t: {period / 20}}}")
        seen = numpy.array([frame[:3] for frame in self.frames(folder, 12 * 20)])
        swings = numpy.exp(2j * numpy.pi * seen[:, 0] / period)
        basis = numpy.column_stack([numpy.ones(len(seen)), swings.real, swings.imag])
        fitted = numpy.linalg.lstsq(basis, seen[:, 1:], rcond=None)[0]
        zz, xx = fitted[1] - 1j * fitted[2]
        load = -PRESSURE * swing * -1j * numpy.sinc(1 / points)**2   # of the polygon that the program is
        shear, areal = load / (zz - xx), load / (zz + xx)
        for measured, exact in zip((shear, areal), moduli(2j * numpy.pi / period, "stress")):
            self.assertLess(abs(measured.real / exact.real - 1), 1e-4)
            self.assertLess(abs(measured.imag / exact.imag - 1), 1e-4)

    def test_energies(self):
        """A pressure put on at once: its work is that of creep, and run.json says which branch stores and dissipates it."""
        here = ["material.plane=strain", "start.state=undeformed"]
        made, _ = self.run_scene(FREE, "energy", *here)
        energy, branches = made["energy"], made["energy"]["branches"]
        shear, areal = (step_response(4, lambda s, k=k: moduli(s, "strain")[k])[0] for k in (0, 1))
        work = PRESSURE**2 * (areal + shear) / 2 * 0.5   # pressure times shortening times area
        self.assertAlmostEqual(energy["load_work"] / work, 1, delta=1e-3)
        self.assertAlmostEqual((energy["elastic"] + energy["viscous"]) / work, 1, delta=2e-3)
        self.assertEqual([branch["time"] for branch in branches], [time for time, _, _ in BRANCHES])
        self.assertLess(sum(branch["dissipated"] for branch in branches), energy["viscous"])
        self.assertLess(sum(branch["stored"] for branch in branches), energy["elastic"])
        explicit, _ = self.run_scene(FREE, "energy-explicit", *here, "time.scheme=explicit", "material.density=1e-4")
        for ours, theirs in zip(branches, explicit["energy"]["branches"]):
            self.assertGreater(ours["stored"], 0)
            self.assertAlmostEqual(ours["dissipated"] / theirs["dissipated"], 1, delta=1e-2)

    def test_reduced(self):
        """Both ways of stepping, of one material and of two, before slip has taken branches of its own."""
        for name, scene in (("block", BLOCK), ("pads", PADS)):
            full, whole = self.run_scene(scene, name + "-full", "reduction.use=never")
            made, small = self.run_scene(scene, name + "-made", "reduction.use=always")
            self.assertLess(made["model"]["reduced_dofs"], full["model"]["full_dofs"])
            self.assertLess(max(made["errors"]["energy"], full["errors"]["energy"]), 1e-3)
            at = numpy.linspace(0, 0.3, 50) * whole["series/rod_displacement"][-1]
            left, right = (numpy.interp(at, x["series/rod_displacement"], x["series/mu"]) for x in (whole, small))
            self.assertLess(numpy.abs(left - right).max(), 2e-3)
            self.assertLess(abs(made["results"]["mu_max"] / full["results"]["mu_max"] - 1), 2e-2)

    def test_cached(self):
        """The basis serves other loads and velocities, and not another branch."""
        first, _ = self.run_scene(BLOCK, "first", "time.until.U=1e-4")
        other, _ = self.run_scene(BLOCK, "other", "time.until.U=1e-4", "load.pressure=0.004", "rod.velocity=2e-5")
        again, _ = self.run_scene(BLOCK, "again", "time.until.U=1e-4", "material.relaxation=[{time: 1, shear: 0.2}]")
        self.assertTrue(other["model"]["from_cache"])
        self.assertFalse(again["model"]["from_cache"])

    def test_explicit(self):
        """Explicit steps of the same branches on the same mesh."""
        here = ["reduction.use=never", "mesh.set.nx=8", "mesh.set.nz=4", "time.until.U=8e-4", "rod.velocity=1e-4",
                "friction.critical_velocity=3e-3", "time.accuracy=fine"]
        _, implicit = self.run_scene(BLOCK, "implicit", *here)
        made, explicit = self.run_scene(BLOCK, "explicit", *here, "time.scheme=explicit")
        at = numpy.linspace(0, 8e-4, 40)
        left, right = (numpy.interp(at, x["series/rod_displacement"], x["series/mu"]) for x in (implicit, explicit))
        self.assertGreater(left.max(), 0.05)
        self.assertLess(numpy.abs(left - right).max(), 2e-3 * left.max())

    def test_space(self):
        """In space the same block, held across, is the one in plane strain."""
        scene = BLOCK.replace("block.geo, set: {length: 1, height: 0.5, nx: 20, nz: 10}",
                              "block3d.geo, set: {length: 1, height: 0.5, breadth: 0.1, nx: 8, ny: 1, nz: 4}")
        plane = BLOCK.replace("nx: 20, nz: 10", "nx: 8, nz: 4")
        here = ["time.until.U=5e-4"]
        _, wide = self.run_scene(plane, "plane", *here, "material.plane=strain")
        _, space = self.run_scene(scene, "space", *here, "load.supports=[{group: left, direction: y}, "
                                                         "{group: right, direction: y}]")
        at = numpy.linspace(0, 5e-4, 40)
        left, right = (numpy.interp(at, x["series/rod_displacement"], x["series/mu"]) for x in (wide, space))
        self.assertLess(numpy.abs(left - right).max(), 2e-3 * left.max())

    def test_stability(self):
        """Branches that are so fast that they are viscosity move l_c as that viscosity does."""
        fast = "material.relaxation=[{time: 0.01, shear: 25, bulk: 66.6666666667}]"
        like = ["material.relaxation=[]", "material.eta1=1.5", "material.eta2=1.5"]
        made = []
        for settings in ([fast], like):
            self.call(BLOCK, "stability", *settings, "material.plane=strain",
                      flags=("-q", "--from", "start", "--overwrite", "-o", self.folder / "stability"))
            made.append(json.loads((self.folder / "stability" / "stability.json").read_text()))
            (self.folder / "stability" / "stability.json").unlink()
        for key in ("l_sc_over_L", "l_c_over_L"):
            self.assertLess(abs(made[0]["results"][key] - made[1]["results"][key]), 1e-2)

    def test_folded(self):
        """What relaxes faster than waves within an element is a viscosity, and said to be one."""
        here = ["material.plane=strain", "time.until.U=6e-4"]
        fast, left = self.run_scene(BLOCK, "fast", *here,
                                    "material.relaxation=[{time: 1e-6, shear: 2e5, bulk: 3e5}, {time: 2, shear: 0.2}]")
        _, right = self.run_scene(BLOCK, "viscous", *here, "material.relaxation=[{time: 2, shear: 0.2}]",
                                  "material.eta1=1.4", f"material.eta2={1 + 0.3 - 0.4 / 3:.17g}")
        self.assertIn("are taken as a viscosity", str(fast["warnings"]))
        numpy.testing.assert_allclose(left["series/mu"], right["series/mu"], rtol=1e-6, atol=1e-9)

    def test_resume(self):
        """A run that is extended goes on with the stretches of its branches."""
        _, once = self.run_scene(BLOCK, "once", "time.until.U=6e-4")
        self.run_scene(BLOCK, "twice", "time.until.U=3e-4")
        made, twice = self.run_scene(BLOCK, "twice", "time.until.U=3e-4", flags=("--extend", "U=6e-4"))
        self.assertLess(made["errors"]["energy"], 1e-3)
        at = numpy.linspace(3e-4, 6e-4, 30)
        left, right = (numpy.interp(at, x["series/rod_displacement"], x["series/mu"]) for x in (once, twice))
        self.assertLess(numpy.abs(left - right).max(), 2e-3 * left.max())

    def test_killed(self):
        """A run that is killed after some checkpoint and resumed ends with the bits of one that was not, energies of branches,
        too."""
        end = "time.until.U=0.04"
        whole, arrays = self.run_scene(BLOCK, "not-killed", end)
        process = subprocess.Popen([PROGRAM, "run", self.folder / "scene.yaml", "--set", end, "-q", "--checkpoint", "0.02s", "-o",
                                    self.folder / "killed"], cwd=self.folder, env=self.environment)
        while process.poll() is None and not (self.folder / "killed" / "checkpoint.bin").exists():
            time.sleep(0.002)
        time.sleep(random.uniform(0, 0.3 * whole["timing_s"]["total"]))
        process.kill()
        process.wait()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        made, resumed = self.run_scene(BLOCK, "killed", end, flags=("--resume",))
        self.assertEqual((made["resumed"], made["energy"], made["results"]), (1, whole["energy"], whole["results"]))
        self.assertEqual(sorted(arrays), sorted(resumed))
        for key, values in arrays.items():
            numpy.testing.assert_array_equal(values, resumed[key], key)

    def test_sweep(self):
        """A branch's modulus and time vary in a study."""
        (self.folder / "scene.yaml").write_text(BLOCK)
        study = self.folder / "study.yaml"
        study.write_text("scene: scene.yaml\nset: {time.until.U: 2e-3}\nvary:\n  material.relaxation.0.shear: [0.1, 0.4]\n"
                         "  material.relaxation.1.time: [20, 40]\nrecord: [mu_max]\n")
        subprocess.run([PROGRAM, "sweep", study, "-q", "-o", self.folder / "sweep"], check=True, cwd=self.folder, env=self.environment)
        lines = (self.folder / "sweep" / "sweep.csv").read_text().splitlines()
        self.assertIn("material.relaxation.0.shear", lines[0])
        mu = [line.split(",")[lines[0].split(",").index("mu_max")] for line in lines[1:]]
        self.assertEqual(len(set(mu)), 4)
        one, _ = self.run_scene(BLOCK, "one", "time.until.U=2e-3", "material.relaxation.0.shear=0.1", "material.relaxation.1.time=20")
        self.assertAlmostEqual(float(mu[0]), one["results"]["mu_max"], delta=1e-9)

    def test_parts(self):
        """A number of one branch is set alone, and by a formula in the file or behind --set; so are those of a region."""
        formulas = BLOCK.replace("shear: 0.2, bulk: 0.1", "shear: = 0.2 * material.young, bulk: = material.relaxation.0.shear / 2")
        made = []
        for scene, settings in ((BLOCK, ()), (formulas, ()), (formulas, ("material.relaxation.0.shear=0.4", "material.relaxation.0.shear=0.2")),
                                (BLOCK, ("material.relaxation.1.shear== 0.75 * material.relaxation.0.shear",)),
                                (BLOCK.replace("shear: 0.2,", "shear: 0.1,"), ("material.relaxation.0.shear=0.2",))):
            made.append(self.run_scene(scene, f"part{len(made)}", "time.until.U=1e-5", *settings)[0]["scene"]["material"]["relaxation"])
        for other in made[1:]:
            self.assertEqual(other, made[0])
        region, _ = self.run_scene(PADS, "region", "time.until.U=1e-5", "materials.layer.relaxation.1.shear=0.04")
        self.assertEqual([branch["shear"] for branch in region["scene"]["materials"]["layer"]["relaxation"]], [0.05, 0.04])
        for setting, words in (("material.relaxation.2.shear=1", "there is no such branch"),
                               ("material.relaxation.0.young=1", "unknown key `young`; allowed: time, shear, bulk"),
                               ("material.relaxation.0.time=40", "stands twice"),
                               ("material.relaxation.1.shear=0", "not both 0")):
            self.assertIn(words, self.call(BLOCK, "run", setting, status=2, flags=("--dry-run",)))

    def test_cases_are_those_laid_down(self):
        folder = SOURCE / "validation/rubber"
        listed = subprocess.run([folder / "cases.py", "--list"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(listed.splitlines()[-1], (folder / "cases.sha256").read_text().strip())

    def test_refused(self):
        for setting, words in (
                ("material.relaxation=[{shear: 1}]", "a branch needs its `time`"),
                ("material.relaxation=[{time: 1}]", "needs `shear` or `bulk` above 0"),
                ("material.relaxation=[{time: 1, shear: 1}, {time: 1, bulk: 1}]", "stands twice"),
                ("material.relaxation=[{time: 1, prony: 1}]", "unknown key `prony`; allowed: time, shear, bulk"),
                ("material.relaxation=[{time: -1, shear: 1}]", "a number > 0"),
                ("material.relaxation=3", "a list of at most 20 maps"),
                ("material.poisson=0.5", "branches need less than 0.5"),
                ("material.young_short=0.5", "young: = E0 - 2*(1 + nu)*(g1 + g2)"),
                ("materials={layer: {young_short: 3}}", "young: = E0 - 2*(1 + nu)*(g1 + g2)")):
            said = self.call(BLOCK, "run", setting, status=2, flags=("--dry-run",))
            self.assertIn(words, said)

    def test_said(self):
        """No viscosity is warned of; springs, too. A scene as run.json has it is a scene."""
        made, _ = self.run_scene(BLOCK, "long", "time.until.U=1e-4")
        self.call(json.dumps(made["scene"]), "run", flags=("--dry-run",))
        said = self.call(BLOCK, "run", "material.eta1=0", "material.eta2=0", "time.until.U=1e-6",
                         flags=("-o", self.folder / "elastic"))
        self.assertIn("give eta1 beside them", said)
        slow, _ = self.run_scene(BLOCK, "slow", "time.until.U=1e-5", "material.relaxation=[{time: 1e9, shear: 0.2}]")
        self.assertIn("they are springs in it, which gave way while the block settled", str(slow["warnings"]))
        steel = BLOCK.replace("normalised", "si").replace("material: {", "material: {young: 1 MPa, density: 1e3, eta1: 3e6, eta2: 0, ")
        thick, _ = self.run_scene(steel, "thick", "time.until.U=1e-6", "load.pressure=3e3", "rod.velocity=1e-4",
                                  "material.relaxation=[]")
        self.assertIn("no wave runs in the block: eta1 of material is", str(thick["warnings"]))


if __name__ == "__main__":
    unittest.main()
